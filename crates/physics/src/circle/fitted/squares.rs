//! Least squares over the reversals of an axis.

use super::observed::DriveFit;
use super::unknowns::{BEFORE, STEPS, UNKNOWNS, Unknowns};
use crate::circle::figures::Waveform;
use crate::circle::geometry::CircleError;
use crate::circle::tune::XorShift;
use crate::circle::tune::reversal::AxisAlone;
use crate::linear::Normal;
use crate::simulation::FrictionModel;

/// Samples of a waveform that count as one: each is a mean over as many.
const ALIKE: f64 = 5.0;

/// The smallest deviation that is expected to remain, in µm.
const LEAST_UM: f64 = 0.05;

/// Maximum number of steps.
const MOST_STEPS: usize = 15;

/// Least relative gain of a step in the squares; a smaller one ends the search.
const GAIN: f64 = 1e-3;

/// Weight of the measured diagonal that keeps the first steps short, and its factor after a step.
const DAMPED: f64 = 1e-2;
const LESS: f64 = 0.2;
const MORE: f64 = 10.0;

/// Number of trials to shorten a step.
const SHORTENED: usize = 4;

/// A friction model, and the unknowns that are not searched.
#[derive(Debug, Clone, Copy)]
pub(super) struct ModelSetting {
    pub(super) model: FrictionModel,
    pub(super) held: &'static [usize],
}

/// The best unknowns of a setting.
#[derive(Debug, Clone)]
pub(super) struct SolvedUnknowns {
    pub(super) unknowns: Unknowns,
    /// The mean square in µm² that is left.
    pub(super) power: f64,
    /// The equations of each reversal at the best unknowns.
    reversals: Vec<Normal<UNKNOWNS>>,
    held: &'static [usize],
    pub(super) simulations: usize,
}

/// The rest of each reversal.
struct Left {
    of_each: Vec<Vec<f64>>,
    squares: f64,
    samples: f64,
}

impl Left {
    fn power(&self) -> f64 {
        (self.squares / self.samples.max(1.0)).max(LEAST_UM * LEAST_UM)
    }
}

impl DriveFit {
    /// Returns the best unknowns of a setting, starting from given ones.
    pub(super) fn solve(
        &self,
        setting: ModelSetting,
        first: Unknowns,
    ) -> Result<SolvedUnknowns, CircleError> {
        let mut simulations = self.circles.len();
        let mut at = first;
        let mut left = self.left(setting.model, at)?;
        let mut damped = DAMPED;
        let mut reversals = Vec::new();
        for _ in 0..MOST_STEPS {
            reversals = self.equations(setting, at, &left)?;
            simulations += (UNKNOWNS - setting.held.len()) * self.circles.len();
            let before = cost(&left, at, left.power());
            let mut gain = 0.0;
            for _ in 0..SHORTENED {
                let Some(step) = step(&reversals, at, (left.power(), damped), setting.held) else {
                    break;
                };
                let next = at.moved(step);
                simulations += self.circles.len();
                // An unstable drive is not better.
                let found = self.left(setting.model, next).ok();
                let after = found
                    .as_ref()
                    .map_or(f64::INFINITY, |it| cost(it, next, left.power()));
                if let Some(found) = found.filter(|_| after < before) {
                    gain = (before - after) / before;
                    (at, left) = (next, found);
                    damped *= LESS;
                    break;
                }
                damped *= MORE;
            }
            if gain < GAIN {
                break;
            }
        }
        Ok(SolvedUnknowns {
            unknowns: at,
            power: left.power(),
            reversals,
            held: setting.held,
            simulations,
        })
    }

    /// Returns the mean square in µm² that unknowns leave.
    pub(super) fn power(&self, model: FrictionModel, at: Unknowns) -> Result<f64, CircleError> {
        Ok(self.left(model, at)?.power())
    }

    /// Returns the simulated deviation on each circle.
    fn simulated(&self, model: FrictionModel, at: Unknowns) -> Result<Vec<Waveform>, CircleError> {
        let drive = at.of(&self.drive);
        let alone = AxisAlone {
            axis: self.axis,
            drive: &drive,
            model,
            reading: self.reading,
            phase: 0.0,
        };
        let each = self.circles.iter().map(|it| {
            let list = at.list(it).map(Into::into);
            let deviations = alone.deviations(it.circle, list.as_ref())?;
            Ok(Waveform::sampled(&deviations))
        });
        each.collect()
    }

    fn left(&self, model: FrictionModel, at: Unknowns) -> Result<Left, CircleError> {
        let simulated = self.simulated(model, at)?;
        let each = self.circles.iter().zip(&simulated);
        let of_each = each.flat_map(|(circle, simulated)| {
            let recorded = circle.reversals.iter();
            recorded.map(|it| straight(&it.within(simulated).less(simulated)))
        });
        let of_each: Vec<Vec<f64>> = of_each.collect();
        let squares = of_each.iter().flatten().map(|it| it * it).sum();
        #[allow(clippy::cast_precision_loss)] // far below 2^52 samples
        let samples = of_each.iter().map(Vec::len).sum::<usize>() as f64;
        Ok(Left {
            of_each,
            squares,
            samples,
        })
    }

    /// Returns the equations of each reversal: the effect of each unknown on the rest there.
    fn equations(
        &self,
        setting: ModelSetting,
        at: Unknowns,
        left: &Left,
    ) -> Result<Vec<Normal<UNKNOWNS>>, CircleError> {
        let mut changed = Vec::new();
        for (unknown, step) in STEPS.into_iter().enumerate() {
            let is_held = setting.held.contains(&unknown);
            let moved = at.with(unknown, at.0[unknown] + step);
            changed.push(
                (!is_held)
                    .then(|| self.left(setting.model, moved))
                    .transpose()?,
            );
        }
        let each = left.of_each.iter().enumerate();
        let equations = each.map(|(reversal, left)| {
            let mut normal = Normal::new();
            for (sample, &value) in left.iter().enumerate() {
                let row = std::array::from_fn(|unknown| {
                    changed[unknown].as_ref().map_or(0.0, |it| {
                        (value - it.of_each[reversal][sample]) / STEPS[unknown]
                    })
                });
                normal.add(row, value);
            }
            normal
        });
        Ok(equations.collect())
    }
}

/// Returns the squares relative to the expected ones, with those of the unknowns.
fn cost(left: &Left, at: Unknowns, power: f64) -> f64 {
    let each = at.0.iter().zip(BEFORE);
    let before: f64 = each.map(|(it, deviation)| (it / deviation).powi(2)).sum();
    left.squares / power / ALIKE + before
}

/// Returns the step to the least squares of a selection of reversals; unknowns are drawn to their expected values.
fn step(
    reversals: &[Normal<UNKNOWNS>],
    at: Unknowns,
    (power, damped): (f64, f64),
    held: &[usize],
) -> Option<[f64; UNKNOWNS]> {
    let each = reversals.iter().map(|it| (it, 1.0));
    solution(each, (at, [0.0; UNKNOWNS]), (power, damped), held)
}

fn solution<'a>(
    reversals: impl Iterator<Item = (&'a Normal<UNKNOWNS>, f64)>,
    (at, expected): (Unknowns, [f64; UNKNOWNS]),
    (power, damped): (f64, f64),
    held: &[usize],
) -> Option<[f64; UNKNOWNS]> {
    let mut all = Normal::new();
    for (reversal, times) in reversals {
        all.add_times(reversal, times / power / ALIKE);
    }
    for unknown in 0..UNKNOWNS {
        let unit = |factor: f64| {
            let mut row = [0.0; UNKNOWNS];
            row[unknown] = factor;
            row
        };
        let weight = 1.0 / BEFORE[unknown];
        all.add(unit(weight), weight * (expected[unknown] - at.0[unknown]));
        if held.contains(&unknown) {
            all.add(unit(1e6), 0.0);
        } else {
            all.add(unit(damped.sqrt() * all.scale(unknown)), 0.0);
        }
    }
    all.solve()
}

impl SolvedUnknowns {
    /// Returns the unknowns of another selection of as many reversals, by the equations at the best ones.
    pub(super) fn again(&self, random: &mut XorShift) -> Option<Unknowns> {
        let mut times = vec![0.0; self.reversals.len()];
        for _ in 0..times.len() {
            times[random.below(self.reversals.len())] += 1.0;
        }
        let expected = BEFORE.map(|it| it * random.normal());
        let each = self.reversals.iter().zip(times);
        let step = solution(
            each,
            (self.unknowns, expected),
            (self.power, 0.0),
            self.held,
        )?;
        Some(self.unknowns.moved(step))
    }
}

/// Returns the values of a waveform less the straight line that fits them best.
fn straight(waveform: &Waveform) -> Vec<f64> {
    let mut line = Normal::new();
    for (time, value) in waveform.samples() {
        line.add([1.0, time], value);
    }
    let [offset, slope] = line.solve().unwrap_or_default();
    let each = waveform.samples();
    each.map(|(time, value)| value - offset - slope * time)
        .collect()
}
