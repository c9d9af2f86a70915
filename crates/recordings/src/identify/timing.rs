//! Action of the additive current of a list during a recording, and its timing: early or late (R6.22).
//!
//! The total of the torque is friction, whatever supplies it, and the build-up of the loops looks like a
//! lag: only the following error shows the effect of the list. The output of the loops is linear in the
//! following error, its derivative and its integral; the rest of the torque was added.

use serde::{Serialize, Serializer};

use super::share::{Share, Signals};
use super::statistics::{count, samples_in};
use super::track::AxisSamples;

/// Share below which a list did not act (R6.22).
const NOT_ACTING: f64 = 0.2;

/// Share from which a list acted, up to the same distance above 1.
const ACTING: f64 = 0.8;

/// Seconds after a reversal over which the following error is examined …
const AFTER_S: f64 = 0.15;

/// … and before it.
const BEFORE_S: f64 = 0.05;

/// Size in mm below which following errors at reversals do not count.
const NOTICEABLE: f64 = 0.0003;

/// Number of standard errors that is significant.
const SIGNIFICANT: f64 = 3.0;

/// Part of the current of a list that is in a torque, and the interval of three standard errors around
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ActingShare {
    /// The part itself, 1 if all of the current is there.
    #[serde(serialize_with = "in_hundredths")]
    pub share: f64,
    /// The lower end of the interval.
    #[serde(serialize_with = "in_hundredths")]
    pub low: f64,
    /// The upper end of the interval.
    #[serde(serialize_with = "in_hundredths")]
    pub high: f64,
}

/// Timing of a value list in a recording.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "state")]
#[non_exhaustive]
pub enum Timing {
    /// No evidence: no following error was recorded, or fewer than two reversals.
    Open,
    /// The list did not act, or its current is not in the torque.
    Off(ActingShare),
    /// Another list acted: the interval excludes both this list and no list.
    Other(ActingShare),
    /// The interval is too wide to decide between them.
    Unclear(ActingShare),
    /// The list acted.
    On {
        /// Part of the list's current that is in the torque.
        #[serde(flatten)]
        share: ActingShare,
        /// First swing of the following error after a reversal in µm: positive if the axis lags, negative if it
        /// leads.
        swing_um: f64,
        /// Standard error of the swing over the reversals.
        error_um: f64,
        /// Number of examined reversals.
        reversals: usize,
    },
}

impl From<Share> for ActingShare {
    fn from(share: Share) -> Self {
        Self {
            share: share.value,
            low: share.value - SIGNIFICANT * share.error,
            high: share.value + SIGNIFICANT * share.error,
        }
    }
}

#[allow(clippy::trivially_copy_pass_by_ref)] // as serde wants it
fn in_hundredths<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64((value * 100.0).round() / 100.0)
}

impl ActingShare {
    fn is_off(&self) -> bool {
        self.high < NOT_ACTING && self.low > -NOT_ACTING
    }

    fn is_on(&self) -> bool {
        self.low > ACTING && self.high < 2.0 - ACTING
    }

    /// Returns whether the share is neither that of this list nor none, by an interval no wider than that of a list
    /// that acted.
    fn is_other(&self) -> bool {
        let excludes = |value: f64| !(self.low..=self.high).contains(&value);
        excludes(0.0) && excludes(1.0) && self.high - self.low < 2.0 * (1.0 - ACTING)
    }

    /// Returns the part with its interval, for a sentence.
    fn words(&self) -> String {
        let Self { share, low, high } = self;
        format!("{share:.2} of its current is in the torque, between {low:.2} and {high:.2}")
    }
}

impl Timing {
    /// Returns the sentence about it.
    pub fn sentence(&self) -> String {
        match self {
            Self::Open => "whether the list acted, and its timing, are open: that takes the following error at two \
                           reversals or more"
                .to_owned(),
            Self::Off(share) => format!(
                "compensation was off or is not in this torque, so the timing of the list is open: {}",
                share.words()
            ),
            Self::Other(share) => format!(
                "another list acted, or this one with another scale, so its timing is open: {}",
                share.words()
            ),
            Self::Unclear(share) => format!(
                "it is not clear whether this list acted, so its timing is open: {}",
                share.words()
            ),
            Self::On {
                share,
                swing_um,
                error_um,
                reversals,
            } => {
                let state = self.early_or_late().unwrap_or("neither early nor late");
                format!(
                    "the list acted ({}) and is {state}: following error of {swing_um:.2} µm, ± {error_um:.2}, at \
                     {reversals} reversals",
                    share.words()
                )
            }
        }
    }

    /// Returns `early` or `late`, if the following error shows it.
    pub fn early_or_late(&self) -> Option<&'static str> {
        let Self::On {
            swing_um, error_um, ..
        } = self
        else {
            return None;
        };
        let least = (SIGNIFICANT * error_um).max(NOTICEABLE * UM);
        (swing_um.abs() > least).then_some(if *swing_um > 0.0 { "late" } else { "early" })
    }
}

/// µm per mm.
const UM: f64 = 1000.0;

/// A recording with the current that a list adds.
pub(super) struct FollowedRecording<'a> {
    pub(super) samples: &'a AxisSamples,
    /// Commanded less actual position in mm.
    pub(super) errors: &'a [f64],
    /// The current of the list at each sample.
    pub(super) predicted: &'a [f64],
    pub(super) velocities: &'a [f64],
    pub(super) accelerations: &'a [f64],
    /// Samples at which the axis reverses without standstill.
    pub(super) turns: &'a [usize],
    /// The direction of each sample.
    pub(super) signs: &'a [f64],
    /// Samples in a CNC cycle.
    pub(super) cycle: f64,
}

impl FollowedRecording<'_> {
    /// Returns the verdict on the timing.
    pub(super) fn timing(&self) -> Timing {
        if self.turns.is_empty() {
            return Timing::Open;
        }
        let signals = Signals {
            torques: &self.samples.torques,
            errors: self.errors,
            currents: self.predicted,
            motion: [self.velocities, self.accelerations, &self.samples.positions],
            signs: self.signs,
            turns: self.turns,
            step_s: self.samples.step_s,
            cycle: self.cycle,
        };
        let Some(share) = signals.share().map(ActingShare::from) else {
            return Timing::Open;
        };
        if share.is_off() {
            Timing::Off(share)
        } else if share.is_on() {
            self.swing(share)
        } else if share.is_other() {
            Timing::Other(share)
        } else {
            Timing::Unclear(share)
        }
    }

    /// Returns the first swing of the following error at the reversals.
    fn swing(&self, share: ActingShare) -> Timing {
        let [before, after] = [BEFORE_S, AFTER_S].map(|it| samples_in(it, self.samples.step_s));
        let swing = |&turn: &usize| {
            let level = self.errors.get(turn.checked_sub(before)?..turn)?;
            let level = level.iter().sum::<f64>() / count(before);
            let path = self.errors.get(turn..turn + after)?;
            let signed = path.iter().map(|it| (it - level) * self.signs[turn]);
            let most = signed.clone().map(f64::abs).fold(0.0, f64::max);
            // The first extreme that is not small.
            signed.into_iter().find(|it| it.abs() > 0.5 * most)
        };
        let swings: Vec<f64> = self.turns.iter().filter_map(swing).collect();
        let all = count(swings.len());
        if swings.len() < 2 {
            return Timing::Open;
        }
        let mean = swings.iter().sum::<f64>() / all;
        let squares: f64 = swings.iter().map(|it| (it - mean) * (it - mean)).sum();
        Timing::On {
            share,
            swing_um: mean * UM,
            error_um: (squares / (all - 1.0) / all).sqrt() * UM,
            reversals: swings.len(),
        }
    }
}
