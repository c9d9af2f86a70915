//! The machine parameters that compensate stiction on one axis.

use serde::Serialize;

use super::guideline::{Guideline, not_kept};

/// Stiction compensation of one axis, as set on the control.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StictionParameters {
    /// MP1511, the factor; 0 switches the compensation off.
    pub mp1511_us: f64,
    /// MP1512, the limit of the change of the servo lag in counting steps.
    pub mp1512: f64,
    /// GP, the grating period of the encoder.
    pub gp_um: f64,
    /// `t_C`, the control loop cycle.
    pub tc_us: f64,
    /// MP1513, the feed up to which stiction is compensated; without it at every feed.
    pub mp1513_m_per_min: Option<f64>,
}

impl Default for StictionParameters {
    /// Returns parameters without compensation: MP1511 is 0. The limit is the largest whole number within its
    /// guideline, cycle and grating period are those of the worked case.
    fn default() -> Self {
        Self {
            mp1511_us: 0.0,
            mp1512: 49.0,
            gp_um: 20.0,
            tc_us: 3000.0,
            mp1513_m_per_min: None,
        }
    }
}

impl StictionParameters {
    /// Returns `Δs_a,limit` in µm (R8.1).
    pub fn limit_um(&self) -> f64 {
        self.mp1512 * self.gp_um / 256.0
    }

    /// Returns whether stiction is compensated at a commanded feed (R8.2). It also requires feed precontrol, which only
    /// the drive has.
    pub fn acts_at(&self, feed_m_per_min: f64) -> bool {
        self.mp1513_m_per_min
            .is_none_or(|most| feed_m_per_min <= most)
    }

    /// Returns the guidelines of the manual that are not kept (R8.3).
    pub fn guidelines(&self) -> Vec<Guideline> {
        not_kept(Some(self.mp1511_us), Some(self.mp1512))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_feed_of_mp1513_is_the_last_at_which_it_acts() {
        // R8.1 R8.2 R8.3
        let worked = StictionParameters {
            mp1511_us: 8000.0,
            mp1512: 50.0,
            mp1513_m_per_min: Some(1.0),
            ..StictionParameters::default()
        };
        assert!((worked.limit_um() - 3.906_25).abs() < 1e-12);
        assert!(worked.acts_at(1.0) && worked.acts_at(0.1) && !worked.acts_at(1.001));
        assert_eq!(worked.guidelines(), [Guideline::Mp1512]);
        let unset = StictionParameters::default();
        assert!(unset.acts_at(30.0));
        assert_eq!(unset.guidelines(), [Guideline::Mp1511]);
    }
}
