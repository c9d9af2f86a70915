//! The result of a tuning as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use super::strings::to_pretty;
use super::visible::visible_line;
use crate::circle::{Candidate, FeedResult, Tuned};

/// A tuned plant.
#[derive(Debug, Clone)]
pub struct TuneReport {
    /// The name of the plant.
    pub plant: String,
    /// The name of the friction model.
    pub model: &'static str,
    /// The diameter of the circles.
    pub diameter_mm: f64,
    /// The reading of the documents, in words.
    pub reading: String,
    /// What was found.
    pub tuned: Tuned,
}

/// The parameters and the glitches before and after, for people.
pub fn render_text(reports: &[TuneReport]) -> String {
    let mut out = String::new();
    for (at, report) in reports.iter().enumerate() {
        if at > 0 {
            out.push('\n');
        }
        let Candidate {
            position_delay,
            reversal_lookahead,
            delay_cycles,
            scaling_factor,
        } = report.tuned.candidate;
        let _ = writeln!(
            out,
            "plant {}, friction {}, diameter {} mm, {} sets of parameters tried\nreading: {}",
            visible_line(&report.plant),
            report.model,
            report.diameter_mm,
            report.tuned.trials,
            report.reading
        );
        let _ = writeln!(
            out,
            "position_delay {position_delay}, reversal_lookahead {reversal_lookahead}, \
             delay_cycles {delay_cycles}, scaling_factor {scaling_factor}\n"
        );
        let _ = writeln!(
            out,
            "feed mm/min   glitch \u{b5}m  off      on   friction -20 %   friction +20 %"
        );
        for row in &report.tuned.feeds {
            let _ = writeln!(
                out,
                "{:>11}{:>16.3}{:>8.3}{:>17.3}{:>17.3}",
                row.feed_mm_per_min,
                row.glitch_off_um,
                row.glitch_on_um,
                row.glitch_friction_minus20_um,
                row.glitch_friction_plus20_um
            );
        }
    }
    out
}

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    #[serde(flatten)]
    first: PlantRecord<'a>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    compared: Vec<PlantRecord<'a>>,
}

#[derive(Serialize)]
struct PlantRecord<'a> {
    plant: &'a str,
    model: &'static str,
    diameter_mm: f64,
    reading: &'a str,
    trials: usize,
    parameters: Candidate,
    feeds: Vec<FeedResult>,
    glitch_max: f64,
}

impl<'a> PlantRecord<'a> {
    fn of(report: &'a TuneReport) -> Self {
        let round = |value: f64| (value * 1e6).round() / 1e6;
        let feeds = report.tuned.feeds.iter().map(|row| FeedResult {
            feed_mm_per_min: row.feed_mm_per_min,
            glitch_off_um: round(row.glitch_off_um),
            glitch_on_um: round(row.glitch_on_um),
            glitch_friction_minus20_um: round(row.glitch_friction_minus20_um),
            glitch_friction_plus20_um: round(row.glitch_friction_plus20_um),
        });
        let feeds: Vec<_> = feeds.collect();
        Self {
            plant: &report.plant,
            model: report.model,
            diameter_mm: report.diameter_mm,
            reading: &report.reading,
            trials: report.tuned.trials,
            parameters: report.tuned.candidate,
            glitch_max: feeds.iter().map(|row| row.glitch_on_um).fold(0.0, f64::max),
            feeds,
        }
    }
}

/// The same for machines; glitches in µm, feeds in mm/min. The first plant stands at the top, the
/// others under `compared`.
pub fn render_json(reports: &[TuneReport]) -> String {
    let Some((first, others)) = reports.split_first() else {
        return String::new();
    };
    let document = Document {
        schema: 1,
        first: PlantRecord::of(first),
        compared: others.iter().map(PlantRecord::of).collect(),
    };
    let mut text = to_pretty(&document);
    text.push('\n');
    text
}
