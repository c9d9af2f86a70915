//! What tuning is worth, over the feed.

use crate::report::svg::{Axis, Drawn, LineChart, Panel, Series};

/// The glitch at the reversals of a circle at one feed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedGlitches {
    /// The feed in mm/min.
    pub feed: f64,
    /// Peak to peak in µm without compensation.
    pub off: f64,
    /// Peak to peak in µm with the tuned value list.
    pub on: f64,
    /// The same, with 20 % less friction than the list was tuned for.
    pub friction_minus20: f64,
    /// The same, with 20 % more.
    pub friction_plus20: f64,
}

/// The glitch over the feed before and after tuning, with its sensitivity to the friction (R5.25).
pub fn tuning(title: &str, feeds: &[FeedGlitches]) -> LineChart {
    let series = |name: &str, value: fn(&FeedGlitches) -> f64| Series {
        name: name.to_owned(),
        points: feeds.iter().map(|it| [it.feed, value(it)]).collect(),
        drawn: Drawn::Marked,
    };
    let told: Vec<String> = feeds
        .iter()
        .map(|it| format!("{:.1} and {:.1} at {}", it.off, it.on, it.feed))
        .collect();
    LineChart {
        title: title.to_owned(),
        description: format!(
            "The largest glitch in \u{b5}m without and with compensation at feeds in mm/min: {}.",
            told.join("; ")
        ),
        x: Axis::logarithmic("feed in mm/min"),
        bands: Vec::new(),
        panels: vec![Panel {
            y: Axis::linear("largest glitch in \u{b5}m, peak to peak"),
            series: vec![
                series("without compensation", |it| it.off),
                series("tuned", |it| it.on),
                series("tuned, friction \u{2212}20 %", |it| it.friction_minus20),
                series("tuned, friction +20 %", |it| it.friction_plus20),
            ],
        }],
    }
}
