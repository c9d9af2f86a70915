//! Feed moves without friction compensation in a session (R13.12).

use serde::Serialize;

use crate::comp::State;

/// The feed moves of an axis while its friction compensation was not active (R13.12). Rapid motion
/// does not count, nor does an axis without P-AXIS-00522 = 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct FeedMoves {
    /// Number of moves while it was inactive.
    pub off: u64,
    /// Number of moves while it was selected without effect.
    pub ineffective: u64,
    /// Number of moves for which it is unknown whether compensation was active, whether they are made, or whether they
    /// are rapid.
    pub unknown: u64,
    /// The longest travel of the axis without compensation, in mm or degrees, forth and back along an arc, among the
    /// moves of known length.
    pub longest: Option<f64>,
    /// Number of moves without compensation whose length is unknown: those whose start or end is unknown, and lines
    /// whose start or end is not a machine position.
    pub unmeasured: u64,
}

impl FeedMoves {
    /// Returns the number of moves made without compensation.
    pub fn without(&self) -> u64 {
        self.off + self.ineffective
    }

    /// Whether there are no such moves.
    pub fn is_empty(&self) -> bool {
        self.without() == 0 && self.unknown == 0
    }

    /// Adds the moves of another session.
    pub fn append(&mut self, other: &Self) {
        self.off += other.off;
        self.ineffective += other.ineffective;
        self.unknown += other.unknown;
        self.unmeasured += other.unmeasured;
        self.see(other.longest);
    }

    /// Whether a length is zero once it is rounded to a nanometre.
    pub(crate) fn is_standstill(length: f64) -> bool {
        length * 1e6 < 0.5
    }

    /// Adds a move in a state without compensation.
    pub(crate) fn add(&mut self, state: State, length: Option<f64>) {
        match state {
            State::Ineffective => self.ineffective += 1,
            _ => self.off += 1,
        }
        self.unmeasured += u64::from(length.is_none());
        self.see(length);
    }

    fn see(&mut self, length: Option<f64>) {
        let longer = length.filter(|length| self.longest.is_none_or(|longest| *length > longest));
        let longer = longer.map(|length| (length * 1e6).round() / 1e6);
        self.longest = longer.or(self.longest);
    }
}
