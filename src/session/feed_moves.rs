//! Counts the feed moves that axes make without friction compensation (R13.12).

use crate::comp::{AxisIndex, Kind, State};
use crate::interpreter::PositionFrame;
use crate::interpreter::{Certainty, Executed, PathForm};
use crate::timeline::FeedMoves;

/// An axis whose friction compensation is not active.
struct Watched {
    axis: AxisIndex,
    state: State,
    /// Position after the last block, in machine coordinates.
    stood: Option<f64>,
}

/// Counts feed moves, axis by axis.
pub(super) struct FeedMoveCounter {
    counts: Vec<FeedMoves>,
    watched: Vec<Watched>,
    /// The axes that the last block certainly moved so.
    moved: Vec<AxisIndex>,
    /// The version of the states that [`watched`](Self::watched) applies to.
    version: Option<u64>,
}

impl FeedMoveCounter {
    /// No move yet, of a number of axes.
    pub(super) fn new(axes: usize) -> Self {
        Self {
            counts: vec![FeedMoves::default(); axes],
            watched: Vec::new(),
            moved: Vec::new(),
            version: None,
        }
    }

    /// The moves of an axis.
    pub(super) fn of(&self, axis: AxisIndex) -> FeedMoves {
        self.counts[axis.get()]
    }

    /// The axes that the last block moved at feed without friction compensation.
    pub(super) fn moved(&self) -> &[AxisIndex] {
        &self.moved
    }

    /// Looks at an executed block. Where friction compensation is active on every axis, that is one
    /// comparison.
    #[inline]
    pub(super) fn block(&mut self, executed: &Executed<'_>) {
        if self.version != Some(executed.version) {
            self.version = Some(executed.version);
            self.watch(executed);
        }
        self.moved.clear();
        if !self.watched.is_empty() {
            self.count(executed);
        }
    }

    /// The commands of a block act before its motion (R1.9), so its own motion counts, too.
    #[inline(never)]
    fn watch(&mut self, executed: &Executed<'_>) {
        let before = std::mem::take(&mut self.watched);
        for axis in (0..self.counts.len()).map(AxisIndex::new) {
            let state = executed.compensation.state(axis, Kind::Frict);
            if matches!(state, State::Active | State::Unconfigured) {
                continue;
            }
            let known = before.iter().find(|watched| watched.axis == axis);
            self.watched.push(Watched {
                axis,
                state,
                stood: known.and_then(|watched| watched.stood),
            });
        }
    }

    fn count(&mut self, executed: &Executed<'_>) {
        for watched in &mut self.watched {
            let position = executed.modal.position(watched.axis);
            let now = position
                .value
                .filter(|_| position.frame == PositionFrame::Machine);
            let stood = std::mem::replace(&mut watched.stood, now);
            let counts = &mut self.counts[watched.axis.get()];
            match pace(executed, watched.axis) {
                None => {}
                Some(Certainty::Certain)
                    if watched.state != State::Unknown && executed.branch.is_none() =>
                {
                    let is_plain = executed.also_moved.is_empty() && executed.word_motion.is_none();
                    let travel = match executed.modal.functions.motion {
                        1 => stood.zip(now).map(|(from, to)| (to - from).abs()),
                        _ => travel_on_arc(executed, watched.axis),
                    };
                    let travel = travel.filter(|_| is_plain);
                    if !travel.is_some_and(FeedMoves::is_standstill) {
                        counts.add(watched.state, travel);
                        self.moved.push(watched.axis);
                    }
                }
                Some(_) => counts.unknown += 1,
            }
        }
    }
}

/// The travel of an axis along the arc or helix of a block, forth and back (R11.31); its length does not
/// depend on where the origin is.
fn travel_on_arc(executed: &Executed<'_>, axis: AxisIndex) -> Option<f64> {
    let way = executed.moves.arcs()[0]?;
    let PathForm::Arc(arc) = &way.form else {
        return None;
    };
    let ends = |axis: AxisIndex| Some([way.from[axis.get()]?, way.to[axis.get()]?]);
    let Some(place) = arc.axes.iter().position(|it| *it == axis) else {
        return ends(axis).map(|[from, to]| (to - from).abs());
    };
    let [one, two] = [ends(arc.axes[0])?, ends(arc.axes[1])?];
    let shape = arc.between([0, 1].map(|end| [one[end], two[end]])).ok()?;
    Some(shape.travel()[place])
}

/// Whether a block moves an axis other than in rapid motion; `None` where it does not.
fn pace(executed: &Executed<'_>, axis: AxisIndex) -> Option<Certainty> {
    let motions = executed.motions().filter(|moved| moved.axis == axis);
    // `Certain` comes first.
    motions.filter_map(|moved| executed.feeds(&moved)).min()
}
