//! The value list with the smallest glitch on a simulated machine.

use std::sync::Arc;

use frictcomp::lists::{ListHead, Points};
use frictcomp_host::{Watch, tune};
use frictcomp_physics::circle::{Circle, Ranges, Shaping, Task, TuningAim};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::FrictionModel;
use frictcomp_recordings::value_lists::render_tuned;
use frictcomp_report::results::tune::{TuneReport, document};
use serde::{Deserialize, Serialize};

use crate::circle::preset;
use crate::drawn_report::DrawnReport;
use crate::refusal::Refusal;
use crate::run::json;
use crate::watched::Page;

/// The maximum number of circles that are tuned at once.
const MOST_CIRCLES: usize = 8;

/// Settings of a tuning.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TuneSettings {
    radius_mm: f64,
    feeds_mm_per_min: Vec<f64>,
    /// The drives: `stiff`, `mid`, `soft`.
    plant: String,
}

#[derive(Serialize)]
struct TuningAnswer<'a> {
    #[serde(flatten)]
    drawn: DrawnReport<'a>,
    /// The value list of the drives.
    list: String,
}

/// Returns the list, its figures and the glitch over the feed.
pub(crate) fn answer(settings: &TuneSettings) -> Result<Vec<u8>, Refusal> {
    let report = tuned(settings)?;
    // Both drives of an example are equal, and so are their lists.
    let [axis, _] = &report.tuned.axes;
    Ok(json(&TuningAnswer {
        drawn: DrawnReport::from(&document(std::slice::from_ref(&report))),
        list: render_tuned(report.list_of(axis), None, &ListHead::default()),
    }))
}

fn tuned(settings: &TuneSettings) -> Result<TuneReport, Refusal> {
    let feeds = &settings.feeds_mm_per_min;
    if feeds.is_empty() || feeds.len() > MOST_CIRCLES {
        let message = format!("{} feeds were given", feeds.len());
        return Err(Refusal::new(message).with_help(format!("give from 1 to {MOST_CIRCLES}")));
    }
    let circles = feeds.iter().map(|&feed_mm_per_min| Circle {
        radius_mm: settings.radius_mm,
        feed_mm_per_min,
        ..Circle::default()
    });
    let task = Task {
        plant: preset(&settings.plant)?.plant(),
        model: FrictionModel::default(),
        circles: circles.collect(),
        ranges: Ranges::default(),
        reading: Reading::default(),
        points: Points::of_build(None),
        shaping: Shaping::Allowed,
        aim: TuningAim::Plant,
    };
    let watch = Watch::by(Arc::new(Page));
    let tuned = tune(&task, &watch)
        .map_err(|error| Refusal::new(error.to_string()).with_help(error.help()))?;
    Ok(TuneReport::new(&task, tuned))
}
