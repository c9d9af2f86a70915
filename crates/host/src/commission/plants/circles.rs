//! The usable recorded circles of a plan.

use frictcomp_recordings::commission::{
    CirclesFound, Measurement, Plan, PlanFile, RecordingOutcome, RecordingResult, ValueListUsed,
};

/// A recorded circle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Driven<'a> {
    pub(super) result: &'a RecordingResult,
    pub(super) circles: &'a CirclesFound,
    pub(super) plan: &'a Plan,
    /// The planned radius in mm.
    pub(super) radius: f64,
}

/// The recorded circles of a round.
#[derive(Debug, Clone)]
pub(super) struct RoundCircles<'a> {
    /// The number of the round and of its plan.
    pub(super) number: usize,
    pub(super) plan: &'a PlanFile,
    pub(super) circles: Vec<Driven<'a>>,
}

impl<'a> RoundCircles<'a> {
    /// Returns the list of each axis, in the order of the plan.
    pub(super) fn lists(&self) -> [Option<&'a ValueListUsed>; 2] {
        [0, 1].map(|at| {
            let name = &self.plan.plan.axes.get(at)?.name;
            self.plan.lists.iter().find(|it| it.axis == *name)
        })
    }

    /// Returns the SHA-256 of the list of each axis.
    pub(super) fn shas(&self) -> [Option<&'a str>; 2] {
        self.lists().map(|it| it.map(|it| it.sha256.as_str()))
    }
}

/// Returns the usable circles of a plan; of several recordings of a program the one closest to its feed counts, of
/// those within 2 % the last one.
pub(super) fn driven_in<'a>(plan: &'a PlanFile, results: &'a [RecordingResult]) -> Vec<Driven<'a>> {
    let programs = plan.plan.programs.iter();
    let each = programs.filter_map(|program| {
        let Measurement::Circles { radius, .. } = program.role else {
            return None;
        };
        let recorded = results.iter().rev();
        let used = recorded.filter(|it| it.program == Some(program.number) && it.found.is_used());
        let circles = used.filter_map(|result| match &result.found {
            RecordingOutcome::Circles(circles) if circles.heights_um.is_some() => {
                Some((result, circles))
            }
            _ => None,
        });
        let (result, circles) =
            circles.min_by(|one, other| one.1.beside().total_cmp(&other.1.beside()))?;
        Some(Driven {
            result,
            circles,
            plan: &plan.plan,
            radius,
        })
    });
    each.collect()
}

/// Whether a feed equals one of others.
pub(super) fn has(feeds: &[f64], feed: f64) -> bool {
    feeds.iter().any(|it| it.total_cmp(&feed).is_eq())
}

/// Returns the feeds that were driven alike off and in a round, slowest first.
pub(super) fn common_feeds(off: &[Driven<'_>], round: &RoundCircles<'_>) -> Vec<f64> {
    let is_on = |off: &CirclesFound| {
        let mut on = round.circles.iter();
        on.any(|it| it.circles.is_driven_as(off))
    };
    let off = off.iter().map(|it| it.circles);
    let mut feeds: Vec<f64> = off.filter(|it| is_on(it)).map(|it| it.feed).collect();
    feeds.sort_by(f64::total_cmp);
    feeds
}
