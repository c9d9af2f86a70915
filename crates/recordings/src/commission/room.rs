//! The part of a travel that programs use.

use super::error::PlanError;
use super::request::MeasuredAxis;

/// The part of the travel at each end that stays free.
const FREE_END: f64 = 0.05;

/// The factor by which the travel to accelerate is longer than computed.
pub(super) const SPARE: f64 = 1.1;

/// Desired seconds at constant speed.
const STEADY_S: f64 = 2.0;

/// Minimum seconds at constant speed.
const LEAST_STEADY_S: f64 = 0.5;

/// The inner part of the travel of an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room<'a> {
    pub(super) axis: &'a MeasuredAxis,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl<'a> Room<'a> {
    pub(super) fn of(axis: &'a MeasuredAxis) -> Result<Self, PlanError> {
        let travel = axis.travel;
        let extent = travel.high - travel.low;
        if !(extent.is_finite() && extent > 0.0) {
            return Err(PlanError::FreeTravel(axis.name.clone()));
        }
        Ok(Self {
            axis,
            low: travel.low + FREE_END * extent,
            high: travel.high - FREE_END * extent,
        })
    }

    pub(super) fn extent(&self) -> f64 {
        self.high - self.low
    }

    pub(super) fn middle(&self) -> f64 {
        f64::midpoint(self.low, self.high)
    }

    /// Refuses a feed that the axis does not reach.
    pub(super) fn reaches(&self, feed: f64) -> Result<(), PlanError> {
        let limit = self.axis.dynamics.velocity_per_s * 60.0;
        if feed <= limit {
            return Ok(());
        }
        Err(PlanError::TooFast {
            axis: self.axis.name.clone(),
            feed,
            limit,
            unit: self.axis.unit(),
        })
    }

    /// The travel of a run at a speed, with its ramps: two seconds, or a pitch if that is longer; less if the
    /// travel of the axis ends.
    ///
    /// # Errors
    /// Half a second at that speed does not fit.
    pub(super) fn way_at(&self, speed: f64) -> Result<f64, PlanError> {
        let ramp = SPARE * self.axis.dynamics.way_to(speed);
        let least = speed * LEAST_STEADY_S + 2.0 * ramp;
        if least > self.extent() {
            return Err(PlanError::NoRoom {
                axis: self.axis.name.clone(),
                feed: speed * 60.0,
                needed: least,
                ramp,
                steady: speed * LEAST_STEADY_S,
                room: self.extent(),
                unit: self.axis.unit(),
            });
        }
        let steady = (speed * STEADY_S).max(self.axis.pitch.unwrap_or(0.0));
        Ok((steady + 2.0 * ramp).min(self.extent()))
    }
}
