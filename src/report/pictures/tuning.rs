//! What tuning is worth, over the feed.

use crate::circle::FeedResult;
use crate::report::svg::{ChartAxis, Drawn, LineChart, Panel, Series};
use crate::report::tune::TuneReport;

/// The glitch over the feed before and after tuning, with its sensitivity to the friction (R5.25);
/// one panel a plant.
pub fn tuning(reports: &[TuneReport]) -> LineChart {
    let told: Vec<String> = reports.iter().map(describe).collect();
    LineChart {
        title: match reports {
            [one] => format!("Glitch before and after tuning, plant {}", one.plant),
            _ => "Glitch before and after tuning".to_owned(),
        },
        description: format!(
            "The largest glitch without and with compensation, in µm at feeds in mm/min. {}",
            told.join(" ")
        ),
        x: ChartAxis::logarithmic("feed in mm/min"),
        bands: Vec::new(),
        panels: reports
            .iter()
            .map(|report| panel(report, reports.len()))
            .collect(),
    }
}

fn describe(report: &TuneReport) -> String {
    let feeds = report.tuned.feeds.iter();
    let feeds: Vec<String> = feeds
        .map(|it| {
            format!(
                "{:.1} and {:.1} at {}",
                it.glitch_off_um, it.glitch_on_um, it.feed_mm_per_min
            )
        })
        .collect();
    format!("Plant {}: {}.", report.plant, feeds.join("; "))
}

fn panel(report: &TuneReport, panels: usize) -> Panel {
    let mut feeds: Vec<&FeedResult> = report.tuned.feeds.iter().collect();
    feeds.sort_by(|one, other| one.feed_mm_per_min.total_cmp(&other.feed_mm_per_min));
    let series = |name: &str, value: fn(&FeedResult) -> f64| Series {
        name: name.to_owned(),
        points: feeds
            .iter()
            .map(|it| [it.feed_mm_per_min, value(it)])
            .collect(),
        drawn: Drawn::Marked,
    };
    let quantity = "largest glitch in µm, peak to peak";
    Panel {
        y: ChartAxis::linear(match panels {
            1 => quantity.to_owned(),
            _ => format!("plant {}: {quantity}", report.plant),
        }),
        series: vec![
            series("without compensation", |it| it.glitch_off_um),
            series("tuned", |it| it.glitch_on_um),
            series("tuned, friction \u{2212}20 %", |it| {
                it.glitch_friction_minus20_um
            }),
            series("tuned, friction +20 %", |it| it.glitch_friction_plus20_um),
        ],
    }
}
