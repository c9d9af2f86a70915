//! The channels of a trace over time.

use crate::results::trace::TraceReport;
use crate::svg::{ChartAxis, Drawn, LineChart, Panel, Series};

/// Maximum number of drawn channels.
const MOST: usize = 12;

/// Returns every channel in a separate panel, over its own times; over the row if the file has none.
pub fn channels(report: &TraceReport<'_>) -> LineChart {
    let recording = report.recording;
    let panels: Vec<Panel> = recording
        .kept()
        .take(MOST)
        .map(|index| {
            let channel = &recording.channels()[index.get()];
            let values = recording.values(index);
            let times = recording.times_s(index);
            let counted = (0_u32..).map(f64::from);
            let points = match times {
                Some(times) => times
                    .iter()
                    .copied()
                    .zip(values)
                    .map(|(x, y)| [x, *y])
                    .collect(),
                None => counted.zip(values).map(|(x, y)| [x, *y]).collect(),
            };
            Panel {
                y: ChartAxis::linear(match &channel.unit {
                    Some(unit) => format!("{} in {unit}", channel.name),
                    None => channel.name.clone(),
                }),
                series: vec![Series {
                    name: channel.name.clone(),
                    points,
                    drawn: Drawn::Line,
                }],
                ..Panel::default()
            }
        })
        .collect();
    let is_timed = recording
        .kept()
        .any(|index| recording.times_s(index).is_some());
    let left_off = recording.channels().len().saturating_sub(MOST);
    let more = match left_off {
        0 => String::new(),
        more => format!(" {more} more are not drawn."),
    };
    LineChart {
        title: report.title(),
        description: format!("{} recorded channels over time.{more}", panels.len()),
        x: ChartAxis::linear(if is_timed { "time in s" } else { "row" }),
        panels,
        ..LineChart::default()
    }
}
