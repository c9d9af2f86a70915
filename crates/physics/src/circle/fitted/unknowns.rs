//! The unknowns of a drive, in the form of the search.

use super::observed::ObservedCircle;
use crate::simulation::DriveParameters;
use frictcomp::lists::FrictionList;

/// The number of unknowns.
pub(super) const UNKNOWNS: usize = 8;

/// Unknowns relative to those of the first drive: the logarithms of the factors on the stiffness of the contact, on
/// Kp, on the friction and on the damping of the contact, the additional delay in ms, the share of the list that was
/// on less 1, the share of it that was on in the circles off, and the additional lost motion in µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unknowns(pub(super) [f64; UNKNOWNS]);

pub(super) const CONTACT: usize = 0;
pub(super) const SPEED_GAIN: usize = 1;
pub(super) const FRICTION: usize = 2;
pub(super) const DELAY: usize = 3;
pub(super) const DAMPING: usize = 4;
pub(super) const SHARE_ON: usize = 5;
pub(super) const SHARE_OFF: usize = 6;
/// Index of the travel by which the load lags behind the motor after a reversal: backlash, or a drive train that winds
/// up.
pub(super) const LOST: usize = 7;

/// Standard deviation of each unknown before a circle is evaluated; that of the friction is what
/// `identify` leaves (R16.3).
pub(super) const BEFORE: [f64; UNKNOWNS] = [2.0, 0.5, 0.05, 0.7, 0.7, 1.0, 1.0, 3.0];

/// Steps by which the effect of an unknown is measured.
pub(super) const STEPS: [f64; UNKNOWNS] = [0.05, 0.03, 0.02, 0.1, 0.1, 0.05, 0.05, 0.3];

/// Greatest change of an unknown in one step.
const MOST: [f64; UNKNOWNS] = [0.7, 0.3, 0.1, 0.7, 0.7, 0.3, 0.3, 3.0];

/// Greatest distance from the first drive.
const BOUNDS: [f64; UNKNOWNS] = [3.0, 1.2, 0.2, 5.0, 1.4, 1.5, 1.5, 30.0];

/// Least additional lost motion: none is negative.
const LEAST_LOST: f64 = 0.0;

/// The part of that distance beyond which an unknown is at its bound.
const NEXT_TO: f64 = 0.99;

/// The shortest delay in s.
const LEAST_DELAY_S: f64 = 1e-4;

impl Unknowns {
    /// Returns the unknowns of the first drive.
    pub(super) fn none() -> Self {
        Self([0.0; UNKNOWNS])
    }

    /// Replaces the value of an unknown.
    pub(super) fn with(mut self, at: usize, value: f64) -> Self {
        self.0[at] = value;
        self
    }

    /// Returns the unknowns after a step, within the bounds.
    pub(super) fn moved(self, step: [f64; UNKNOWNS]) -> Self {
        Self(std::array::from_fn(|at| {
            let step = step[at].clamp(-MOST[at], MOST[at]);
            let least = if at == LOST { LEAST_LOST } else { -BOUNDS[at] };
            (self.0[at] + step).clamp(least, BOUNDS[at])
        }))
    }

    /// Returns whether an unknown is at the end of its search range, or next to it.
    pub(super) fn is_at_bound(self, at: usize) -> bool {
        self.0[at].abs() > NEXT_TO * BOUNDS[at]
    }

    /// Returns the list that is on in a circle, with its share.
    pub(super) fn list(self, circle: &ObservedCircle) -> Option<FrictionList> {
        let scaled = |list: &FrictionList, share: f64| {
            let mut list = list.clone();
            list.table.iter_mut().for_each(|it| it.output *= share);
            list
        };
        match (&circle.list, &circle.may_be_on) {
            (Some(list), _) if circle.is_doubted => Some(scaled(list, 1.0 + self.0[SHARE_ON])),
            (Some(list), _) => Some(list.clone()),
            (None, Some(list)) if self.0[SHARE_OFF] != 0.0 => Some(scaled(list, self.0[SHARE_OFF])),
            (None, _) => None,
        }
    }

    /// Returns the drive.
    pub(super) fn of(self, first: &DriveParameters) -> DriveParameters {
        let factor = |at: usize| self.0[at].exp();
        let mut drive = first.with_contact(factor(CONTACT));
        drive.speed_gain_n_s_per_m *= factor(SPEED_GAIN);
        drive.friction = drive.friction.scaled(factor(FRICTION));
        drive.friction.damping_n_s_per_m *= factor(DAMPING);
        drive.backlash_m += self.0[LOST] * 1e-6;
        drive.current_time_s = (first.current_time_s + self.0[DELAY] * 1e-3).max(LEAST_DELAY_S);
        drive
    }
}
