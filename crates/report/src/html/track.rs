//! The states of one kind on one axis over the blocks of a program, in bounded memory.

use super::ways::{StateOnWays, WaysIndex};
use crate::svg::{BandState, StartUpRelation};
use frictcomp::comp::{AxisIndex, Kind, State};

/// Beginning of a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SpanStart {
    /// The file, by its number in the report.
    pub(super) file: usize,
    /// The line, from 1.
    pub(super) line: u32,
    /// The block number.
    pub(super) number: Option<i64>,
}

/// A state from one executed block on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StateSpan {
    /// The executed block after which the state holds, 0 at program start.
    pub(super) from: u64,
    /// The state that the band shows.
    pub(super) state: BandState,
    /// Possible states if ways differ.
    pub(super) ways: Option<WaysIndex>,
    /// The block that caused it; `None` at program start.
    pub(super) spot: Option<SpanStart>,
}

/// The states of one kind on one axis.
#[derive(Debug, Clone)]
pub(super) struct StateTrack {
    pub(super) axis: AxisIndex,
    pub(super) kind: Kind,
    /// The state after a start of the control.
    pub(super) start_up: State,
    pub(super) stretches: Vec<StateSpan>,
    /// The current state.
    pub(super) now: StateOnWays,
    /// Length below which stretches have been joined.
    grain: u64,
}

/// Number of stretches that are kept apart.
const MAX_STRETCHES: usize = 2048;

impl StateTrack {
    /// Returns a track that begins with a state.
    pub(super) fn new(axis: AxisIndex, kind: Kind, now: StateOnWays, start_up: State) -> Self {
        Self {
            axis,
            kind,
            start_up,
            stretches: vec![StateSpan {
                from: 0,
                state: BandState::One(now.state),
                ways: now.ways,
                spot: None,
            }],
            now,
            grain: 1,
        }
    }

    /// Takes the state after a block.
    pub(super) fn push(&mut self, seq: u64, now: StateOnWays, spot: SpanStart) {
        if now == self.now {
            return;
        }
        self.now = now;
        self.stretches.push(StateSpan {
            from: seq,
            state: BandState::One(now.state),
            ways: now.ways,
            spot: Some(spot),
        });
        while self.stretches.len() > MAX_STRETCHES {
            self.coarsen(seq);
            if self.stretches.len() > MAX_STRETCHES / 2 {
                self.grain = self.grain.saturating_mul(2);
            }
        }
    }

    /// Returns whether it has a state other than that the kind does not exist here.
    pub(super) fn is_configured(&self) -> bool {
        let absent = BandState::One(State::Unconfigured);
        self.stretches.iter().any(|stretch| stretch.state != absent)
    }

    /// Compares a state of this kind on this axis with the start-up state.
    pub(super) fn relation(&self, state: BandState) -> StartUpRelation {
        match state {
            BandState::One(state) => StartUpRelation::of(state, self.start_up),
            BandState::Changing => StartUpRelation::StartUp,
        }
    }

    /// Joins neighbours that are shorter than the grain into one stretch of changes.
    fn coarsen(&mut self, now: u64) {
        let all = std::mem::take(&mut self.stretches);
        let ends = all.iter().skip(1).map(|next| next.from).chain([now]);
        let ends: Vec<u64> = ends.collect();
        for (stretch, end) in all.iter().zip(ends) {
            let short = end.saturating_sub(stretch.from) < self.grain;
            match self.stretches.last_mut() {
                Some(last)
                    if short
                        && last.state == BandState::Changing
                        && end.saturating_sub(last.from) <= self.grain.saturating_mul(64) => {}
                _ => self.stretches.push(StateSpan {
                    state: if short {
                        BandState::Changing
                    } else {
                        stretch.state
                    },
                    ways: stretch.ways.filter(|_| !short),
                    ..*stretch
                }),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPOT: SpanStart = SpanStart {
        file: 0,
        line: 1,
        number: None,
    };

    fn track(blocks: u64) -> StateTrack {
        let found = |state| StateOnWays { state, ways: None };
        let now = found(State::Active);
        let mut track = StateTrack::new(AxisIndex::new(0), Kind::Frict, now, State::Active);
        for seq in 1..=blocks {
            let state = if seq % 2 == 0 {
                State::Active
            } else {
                State::Inactive
            };
            track.push(seq, found(state), SPOT);
        }
        track
    }

    #[test]
    fn few_changes_are_kept_exactly() {
        let track = track(100);
        assert_eq!(track.stretches.len(), 101);
        assert_eq!(track.stretches[7].from, 7);
        assert_eq!(track.stretches[7].state, BandState::One(State::Inactive));
    }

    #[test]
    fn many_changes_stay_bounded() {
        let track = track(300_000);
        assert!(track.stretches.len() <= MAX_STRETCHES);
        assert!(
            track
                .stretches
                .is_sorted_by(|one, other| one.from < other.from)
        );
        assert_eq!(track.stretches[0].from, 0);
    }
}
