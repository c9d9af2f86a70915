//! A drive from the reversals of its axis.

use super::extent::Extent;
use super::observed::DriveFit;
use super::squares::ModelSetting;
use super::unknowns::{
    CONTACT, DAMPING, DELAY, FRICTION, LOST, SHARE_OFF, SHARE_ON, SPEED_GAIN, Unknowns,
};
use crate::circle::geometry::CircleError;
use crate::circle::tune::XorShift;
use crate::simulation::{DriveParameters, FrictionModel};

/// Contacts that are tried first: from an eighth to eight times as stiff, each twice as stiff as the one before.
const CONTACTS: std::ops::RangeInclusive<i32> = -3..=3;

/// Selections of the reversals.
const SELECTIONS: usize = 400;

/// The part of them beyond each end of a 95 % range.
const BEYOND: usize = SELECTIONS / 40;

/// The best accuracy of the delay, in s (R16.3).
const DELAY_S: f64 = 0.5e-3;

/// The best accuracy of the friction, as a part: that of the shape of the measured curve.
const SHAPE: f64 = 0.02;

/// Shares of a list, by which the drive explains the circles best (R16.13).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SharesOn {
    /// Share in the circles with the list on: 1 if all of it was on.
    pub on: Extent,
    /// Share in the circles off: 0 if nothing was on.
    pub off: Extent,
}

/// Shares with the number of simulations that they took.
struct SolvedShares {
    found: SharesOn,
    simulations: usize,
}

/// The unknowns of the shares.
const SHARES: [usize; 2] = [SHARE_ON, SHARE_OFF];

/// The best accuracy of a share: friction is that of constant speeds within 10 % (R16.13).
const OF_SHARE: f64 = 0.1;

/// The drive that fits the reversals, with the accuracy of its parameters.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FittedDrive {
    /// The drive.
    pub drive: DriveParameters,
    /// Stiffness of the contact in N/m.
    pub contact: Extent,
    /// Kp in N·s/m.
    pub speed_gain: Extent,
    /// Coulomb friction in N.
    pub coulomb: Extent,
    /// Damping of the contact in N·s/m.
    pub damping: Extent,
    /// Time constant of the current loop, which includes delays of the loop, in s.
    pub delay_s: Extent,
    /// Travel in m by which the load lags behind the motor after a reversal: backlash, or a drive train that winds up.
    pub lost_m: Extent,
    /// The shares of the lists that were on, where that was asked.
    pub shares: Option<SharesOn>,
    /// The root mean square of the recorded deviations that is left, in µm.
    pub left_um: f64,
    /// Number of reversals.
    pub reversals: usize,
    /// Number of simulated reversals.
    pub simulations: usize,
}

impl DriveFit {
    /// Fits the drive (R16.3).
    ///
    /// # Errors
    /// A circle that cannot be simulated, or a drive that is unstable on it.
    pub fn fit(&self) -> Result<FittedDrive, CircleError> {
        let free = ModelSetting {
            model: FrictionModel::Lugre,
            held: &SHARES,
        };
        let (first, mut simulations) = self.first(free.model)?;
        let best = self.solve(free, first)?;
        let slipping = ModelSetting {
            model: FrictionModel::Gms,
            held: &SHARES,
        };
        let damped = ModelSetting {
            model: FrictionModel::Lugre,
            held: &[DAMPING, SHARE_ON, SHARE_OFF],
        };
        let twice = best.unknowns.0[DAMPING] + std::f64::consts::LN_2;
        let others = [
            self.solve(slipping, best.unknowns)?,
            self.solve(damped, best.unknowns.with(DAMPING, twice))?,
        ];
        simulations += best.simulations + others.iter().map(|it| it.simulations).sum::<usize>();
        let shares = self.shares(best.unknowns)?;
        simulations += shares.as_ref().map_or(0, |it| it.simulations);
        let mut random = XorShift::new(0);
        let again = (0..SELECTIONS).filter_map(|_| best.again(&mut random));
        let again: Vec<Unknowns> = again.collect();
        let extent = |unknown: usize, of: &dyn Fn(&DriveParameters) -> f64| {
            let mut values: Vec<f64> = again.iter().map(|it| it.0[unknown]).collect();
            values.sort_by(f64::total_cmp);
            let inner = values.len().saturating_sub(2 * BEYOND);
            let mut ends = values.iter().skip(BEYOND).take(inner);
            let ends = [ends.clone().next(), ends.next_back()]
                .into_iter()
                .flatten();
            let refits = others.iter().map(|it| it.unknowns.0[unknown]);
            let at = |value: f64| of(&best.unknowns.with(unknown, value).of(&self.drive));
            let all = ends.copied().chain(refits).map(at);
            Extent {
                at_bound: best.unknowns.is_at_bound(unknown),
                ..Extent::over(of(&best.unknowns.of(&self.drive)), all)
            }
        };
        let coulomb = extent(FRICTION, &|it| it.friction.coulomb_n);
        Ok(FittedDrive {
            drive: best.unknowns.of(&self.drive),
            contact: extent(CONTACT, &|it| it.friction.stiffness_n_per_m),
            speed_gain: extent(SPEED_GAIN, &|it| it.speed_gain_n_s_per_m),
            coulomb: coulomb.widened(SHAPE * coulomb.value),
            damping: extent(DAMPING, &|it| it.friction.damping_n_s_per_m),
            delay_s: extent(DELAY, &|it| it.current_time_s).widened(DELAY_S),
            lost_m: extent(LOST, &|it| it.backlash_m),
            shares: shares.map(|it| it.found),
            left_um: best.power.sqrt(),
            reversals: self.circles.iter().map(|it| it.reversals.len()).sum(),
            simulations,
        })
    }

    /// Returns the shares of the lists, each with everything else free except the other one and the friction: more of
    /// all lists cannot be told from more friction and stiffer loops. `None` if no circle is doubted.
    fn shares(&self, best: Unknowns) -> Result<Option<SolvedShares>, CircleError> {
        /// A list of which hardly anything was on, less 1.
        const HARDLY: f64 = -0.8;
        const HALF: f64 = 0.5;
        if !self.circles.iter().any(|it| it.is_doubted) {
            return Ok(None);
        }
        let first = self.first(FrictionModel::Lugre)?.0;
        let best = best.with(FRICTION, 0.0);
        let hardly_on = [best, first.with(SHARE_ON, HARDLY)];
        let half_off = [best, best.with(SHARE_OFF, HALF)];
        let (on, of_on) = self.share((SHARE_ON, 1.0), &[SHARE_OFF, FRICTION], hardly_on)?;
        let (off, of_off) = self.share((SHARE_OFF, 0.0), &[SHARE_ON, FRICTION], half_off)?;
        Ok(Some(SolvedShares {
            found: SharesOn { on, off },
            simulations: of_on + of_off,
        }))
    }

    /// Returns the range of a share, which is an unknown and what is added to it, and the number of simulations; the
    /// better one of two starts counts.
    fn share(
        &self,
        (unknown, whole): (usize, f64),
        held: &'static [usize],
        starts: [Unknowns; 2],
    ) -> Result<(Extent, usize), CircleError> {
        let setting = ModelSetting {
            model: FrictionModel::Lugre,
            held,
        };
        let [one, other] = starts.map(|it| self.solve(setting, it));
        let (one, other) = (one?, other?);
        let simulations = one.simulations + other.simulations;
        let solved = if one.power <= other.power { one } else { other };
        let mut random = XorShift::new(1);
        let again = (0..SELECTIONS).filter_map(|_| solved.again(&mut random));
        let mut values: Vec<f64> = again.map(|it| whole + it.0[unknown]).collect();
        values.sort_by(f64::total_cmp);
        let inner = values.len().saturating_sub(2 * BEYOND);
        let ends = values.into_iter().skip(BEYOND).take(inner);
        let extent = Extent::over(whole + solved.unknowns.0[unknown], ends).widened(OF_SHARE);
        Ok((extent, simulations))
    }

    /// Returns the contact from which the search starts, and the number of simulations needed.
    fn first(&self, model: FrictionModel) -> Result<(Unknowns, usize), CircleError> {
        let mut best = (f64::INFINITY, Unknowns::none());
        let mut simulations = 0;
        for octave in CONTACTS {
            let at = Unknowns::none().with(CONTACT, f64::from(octave) * std::f64::consts::LN_2);
            let power = self.power(model, at)?;
            simulations += self.circles.len();
            if power < best.0 {
                best = (power, at);
            }
        }
        Ok((best.1, simulations))
    }
}
