//! The gain from tuning, over the acceleration at a reversal.

use crate::results::tune::{TuneReport, title};
use crate::svg::{ChartAxis, CurveLooks, Drawn, LineChart, Panel, Series};
use crate::wording::last_part;
use frictcomp_physics::circle::FeedResult;

/// Returns the glitch before and after tuning over v²/R, on which it depends, and its change with less and more
/// friction (R5.25); two panels per plant, since the rest is small compared with the original glitch.
pub fn tuning(reports: &[TuneReport]) -> LineChart {
    let told: Vec<String> = reports.iter().map(describe).collect();
    LineChart {
        title: title(reports),
        description: format!(
            "The largest glitch without and with compensation, in \u{b5}m at accelerations v\u{b2}/R \
             in mm/s\u{b2}. {}",
            told.join(" ")
        ),
        x: ChartAxis::logarithmic(
            "acceleration v\u{b2}/R at the reversal in mm/s\u{b2}, logarithmic",
        ),
        panels: reports
            .iter()
            .flat_map(|report| panels(report, reports.len()))
            .collect(),
        looks: CurveLooks::OnAndOff,
        ..LineChart::default()
    }
}

fn describe(report: &TuneReport) -> String {
    let feeds = report.tuned.feeds.iter();
    let feeds: Vec<String> = feeds
        .map(|it| {
            format!(
                "{:.1} and {:.1} at {:.2}",
                it.glitch_off_um, it.glitch_on_um, it.acceleration_mm_per_s2
            )
        })
        .collect();
    format!("Plant {}: {}.", report.plant, feeds.join("; "))
}

fn panels(report: &TuneReport, plants: usize) -> [Panel; 2] {
    let mut feeds: Vec<&FeedResult> = report.tuned.feeds.iter().collect();
    let by = |it: &FeedResult| it.acceleration_mm_per_s2;
    feeds.sort_by(|one, other| by(one).total_cmp(&by(other)));
    let series = |name: &str, value: fn(&FeedResult) -> f64| Series {
        name: name.to_owned(),
        points: feeds.iter().map(|it| [by(it), value(it)]).collect(),
        drawn: Drawn::Marked,
    };
    let off = series("without compensation", |it| it.glitch_off_um);
    let pairs = Series {
        name: "before and after".to_owned(),
        points: feeds.iter().flat_map(|it| pair(it)).collect(),
        drawn: Drawn::Held,
    };
    let on = || series("tuned", |it| it.glitch_on_um);
    let panel = |quantity: &str, series: Vec<Series>| Panel {
        y: ChartAxis::linear(match plants {
            1 => quantity.to_owned(),
            _ => format!("plant {}: {quantity}", last_part(&report.plant)),
        })
        .from_zero(),
        series,
        ..Panel::default()
    };
    // Without points, so that the others look as above.
    let unseen = Series {
        points: Vec::new(),
        ..off.clone()
    };
    [
        panel(
            "largest glitch in \u{b5}m, peak to peak: before and after",
            vec![on(), off, pairs],
        ),
        panel(
            "the same after tuning, with less and more friction",
            vec![
                on(),
                unseen,
                series("tuned, friction \u{2212}20 %", |it| {
                    it.glitch_friction_minus20_um
                }),
                series("tuned, friction +20 %", |it| it.glitch_friction_plus20_um),
            ],
        ),
    ]
}

/// Returns the glitches without compensation and with it.
fn pair(it: &FeedResult) -> [[f64; 2]; 3] {
    let at = it.acceleration_mm_per_s2;
    [[at, it.glitch_off_um], [at, it.glitch_on_um], [f64::NAN; 2]]
}
