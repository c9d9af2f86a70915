//! The parameters of the friction of an axis with their errors, and how they change (R16.6).

use super::curve::fit;
use super::identified::Identified;
use super::statistics::count;

/// The least error of a speed, as a part of the friction.
const LEAST_ERROR: f64 = 0.002;

/// Combined standard errors beyond which a difference is a change …
const ERRORS: f64 = 3.0;

/// … if it also exceeds this part.
const PART: f64 = 0.05;

frictcomp::words! {
    /// A parameter of the friction.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum FrictionParameter {
        /// Friction without the speed, Fc.
        Coulomb = "Fc",
        /// Friction just after breaking loose, Fs.
        Breakaway = "Fs",
        /// Increase of friction with the speed, fv.
        Viscous = "fv",
        /// Torque that is the same in both directions.
        Offset = "offset",
    }
}

/// A value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Level {
    /// The value, in drive units or drive units per mm/s.
    pub value: f64,
    /// The standard error in the same unit.
    pub error: f64,
}

/// The parameters of one recording, in the order of [`FrictionParameter::ALL`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionLevels([Level; 4]);

impl FrictionLevels {
    /// Returns the parameters of an identified friction; `None` if its curve does not have them.
    ///
    /// Each speed is moved by its error, and the effects on a parameter are added in squares.
    pub fn of(found: &Identified) -> Option<Self> {
        let best = found.used_fit()?;
        let values = [best.coulomb, best.breakaway, best.viscous];
        let mut squares = [0.0; 3];
        for at in 0..found.pairs.len() {
            let mut pairs = found.pairs.clone();
            let pair = &mut pairs[at];
            pair.friction += pair.error.hypot(LEAST_ERROR * pair.friction);
            let moved = fit(&pairs)?;
            let moved = [moved.coulomb, moved.breakaway, moved.viscous];
            for ((square, value), moved) in squares.iter_mut().zip(values).zip(moved) {
                *square += (moved - value).powi(2);
            }
        }
        let unexplained = best.chi_square.max(1.0).sqrt();
        let level = |at: usize| Level {
            value: values[at],
            error: squares[at].sqrt() * unexplained,
        };
        let offset = Level {
            value: found.offset,
            error: offset_error(found),
        };
        Some(Self([level(0), level(1), level(2), offset]))
    }

    /// Returns the value of a parameter.
    pub fn get(&self, parameter: FrictionParameter) -> Level {
        let [coulomb, breakaway, viscous, offset] = self.0;
        match parameter {
            FrictionParameter::Coulomb => coulomb,
            FrictionParameter::Breakaway => breakaway,
            FrictionParameter::Viscous => viscous,
            FrictionParameter::Offset => offset,
        }
    }
}

/// Returns the standard error of the median of the offsets: from their scatter, or from the torque if that is more.
fn offset_error(found: &Identified) -> f64 {
    const OF_MEDIAN: f64 = 1.2533;
    let offsets: Vec<f64> = found.pairs.iter().filter_map(|it| it.offset).collect();
    let number = count(offsets.len().max(1));
    let mean = offsets.iter().sum::<f64>() / number;
    let scatter: f64 = offsets.iter().map(|it| (it - mean).powi(2)).sum();
    let noise: f64 = found.pairs.iter().map(|it| it.error * it.error).sum();
    OF_MEDIAN * (scatter.max(noise) / number / number).sqrt()
}

/// A parameter that changed between two recordings, which are given by their indices.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FrictionChange {
    /// The parameter.
    pub parameter: FrictionParameter,
    /// The recording it is compared with.
    pub from: usize,
    /// The first recording in which it differs.
    pub to: usize,
    /// The part by which it differs: of its value, for the offset of Fc.
    pub part: f64,
    /// The difference in combined standard errors.
    pub errors: f64,
}

/// Returns the changes over recordings in the order of their dates. Each parameter is compared with the first
/// recording, and after a change with the one in which it changed, so that a slow drift is found as well as a step.
pub fn friction_changes(levels: &[FrictionLevels]) -> Vec<FrictionChange> {
    let mut changes = Vec::new();
    for parameter in FrictionParameter::ALL {
        let mut from = 0;
        for (to, after) in levels.iter().enumerate().skip(1) {
            let [before, now] = [levels[from].get(parameter), after.get(parameter)];
            let whole = match parameter {
                FrictionParameter::Offset => levels[from].get(FrictionParameter::Coulomb).value,
                _ => before.value,
            };
            let part = (now.value - before.value) / whole.abs().max(f64::MIN_POSITIVE);
            let errors = (now.value - before.value).abs()
                / before.error.hypot(now.error).max(f64::MIN_POSITIVE);
            if errors > ERRORS && part.abs() > PART {
                changes.push(FrictionChange {
                    parameter,
                    from,
                    to,
                    part,
                    errors,
                });
                from = to;
            }
        }
    }
    changes.sort_by_key(|it| it.to);
    changes
}

/// The friction of an axis on some dates.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TrendReport {
    /// The axis, if it is named.
    pub axis: Option<String>,
    /// The unit of the friction.
    pub unit: String,
    /// The recordings in the order of their dates.
    pub dates: Vec<DatedFriction>,
    /// The changes between them.
    pub changes: Vec<FrictionChange>,
    /// Files that give no friction, each with its reason.
    pub left_out: Vec<(String, String)>,
}

/// The friction of one recording.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct DatedFriction {
    /// The date, `2026-03-01`.
    pub date: String,
    /// The days since 1970-01-01.
    pub day: f64,
    /// Name of the file.
    pub file: String,
    /// The parameters.
    pub levels: FrictionLevels,
}
