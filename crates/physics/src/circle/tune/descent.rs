//! The search for the shape of a value list (R5.25, R5.37).
//!
//! The deviation at a reversal depends smoothly on the outputs and times of a list. The search simulates how the
//! deviation on each circle changes with each of them, takes the list that would level the largest heights if
//! the changes were linear, and repeats that from there. Each round also tries other times. Half of the circles show
//! in which valley to search, and the search ends with whole numbers.

use std::collections::BTreeSet;

use super::candidate::Candidate;
use super::check::{Deviating, PLACES};
use super::minimax::{FreeValues, LinearCurve, LinearModel, LinearValue};
use super::reversal::{AxisAlone, cycles_of_window, phase_at};
use super::shape::{ALLOWED, BEND, BOUND, FREE, ListShape, ShapedLists};
use super::task::Task;
use super::tuned::{Reserve, Simulations};
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleError};
use crate::circle::simulated::Method;
use crate::simulation::DriveParameters;
use frictcomp::lists::{FrictionList, Points};

/// Rounds on half of the circles, and on all of them.
const TRIAL: usize = 3;
const MOST: usize = 8;

/// Rounds after circles were added: more of them gain less than they cost.
const AGAIN: usize = 1;

/// Rounds of whole numbers.
const WHOLE: usize = 4;

/// Times that circles are added on which the list found leaves more.
const EXCHANGES: usize = 2;

/// Accelerations between which such circles are sought, and the excess that counts.
const BETWEEN: usize = 61;
const EXCESS: f64 = 1.003;

/// Reversals that are added at once.
const ADDED: usize = 3;

/// Smallest gain of a round that counts, as a share.
const GAIN: f64 = 0.003;

/// The largest step of an output, as a part of the curve.
const OUTPUT_STEP: f64 = 0.2;

/// The step of an output whose effect is simulated.
const PROBE: f64 = 0.02;

/// Part of the largest step that each round tries in addition.
const PART: f64 = 0.3;

/// The smallest part of the largest step.
const LEAST_REACH: f64 = 0.02;

/// Largest change of `delay_cycles` in a round, in cycles, and change of `position_delay` downwards, in 0.1 µm.
const DELAY_STEP: i16 = 6;
const DISTANCE_STEP: i32 = 2;

/// Number of other times whose most promising step a round simulates.
const PROMISING: usize = 2;

/// Part of the height of a curve by which a step may change a value.
const WIDE: f64 = 0.7;

/// Lists that are simulated side by side.
const LANES: usize = 4;

/// Seconds between the points of a curve.
const SAMPLE_S: f64 = 0.003;

/// A change of the velocity in a CNC cycle at a reversal above which a search looks at both ends of the cycle, in
/// mm/s.
const FAST_MM_PER_S: f64 = 0.03;

/// Significance of a reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    /// Reversal that counts with its height.
    Counted,
    /// Reversal that counts more if the glitch on the plant itself exceeds what a robust list may cost.
    Limited(f64),
    /// Reversal beyond the range.
    Beyond(Reserve),
}

/// A reversal that a list is judged by.
#[derive(Debug, Clone)]
struct JudgedReversal {
    circle: Circle,
    drive: DriveParameters,
    place: f64,
    role: Role,
}

/// A shape that was simulated.
#[derive(Debug, Clone)]
struct DrivenShape {
    shape: ListShape,
    /// The extremes of each cycle at each reversal.
    extremes: Vec<Vec<[f64; 2]>>,
    /// Weight of each reversal.
    weights: Vec<f64>,
    /// The largest weighted height.
    worst_um: f64,
}

/// A search for the shape of the list of an axis.
pub(super) struct Descent<'a> {
    task: &'a Task,
    axis: PlaneAxis,
    simulations: &'a dyn Simulations,
    shapes: ShapedLists,
    reversals: Vec<JudgedReversal>,
    trials: usize,
}

impl<'a> Descent<'a> {
    /// Usual number of simulations of a search.
    pub(super) const USUAL_SIMULATIONS: usize = 2500;

    pub(super) fn new(task: &'a Task, axis: PlaneAxis, simulations: &'a dyn Simulations) -> Self {
        Self {
            task,
            axis,
            simulations,
            shapes: ShapedLists::new(task.drive(axis), task.points),
            reversals: Vec::new(),
            trials: 0,
        }
    }

    /// Judges lists on circles; for a robust list on machines that deviate, too, and with at most
    /// `limit_um` on the plant.
    pub(super) fn judge(&mut self, circles: &[Circle], limit_um: Option<f64>) {
        let mut circles = circles.to_vec();
        let by = |circle: &Circle| circle.acceleration_mm_per_s2();
        circles.sort_by(|one, other| by(one).total_cmp(&by(other)));
        for circle in &circles {
            let change = circle.acceleration_mm_per_s2() * circle.cycle_time_s;
            let places: &[f64] = if change > FAST_MM_PER_S {
                &[PLACES[0], PLACES[3]]
            } else {
                &[PLACES[1]]
            };
            for &place in places {
                self.add(*circle, place, limit_um);
            }
        }
    }

    fn add(&mut self, circle: Circle, place: f64, limit_um: Option<f64>) {
        let drive = self.task.drive(self.axis);
        let machines: &[Deviating] = match limit_um {
            Some(_) => &Deviating::ALL,
            None => &[Deviating::Nothing],
        };
        for &deviating in machines {
            let role = match limit_um {
                Some(limit_um) if deviating == Deviating::Nothing => Role::Limited(limit_um),
                _ => Role::Counted,
            };
            self.reversals.push(JudgedReversal {
                circle,
                drive: deviating.of(drive),
                place,
                role,
            });
        }
    }

    /// Judges lists beyond the range, too.
    pub(super) fn keep(&mut self, reserve: Reserve) {
        self.reversals.push(JudgedReversal {
            circle: reserve.circle,
            drive: self.task.drive(self.axis).clone(),
            place: PLACES[0],
            role: Role::Beyond(reserve),
        });
    }

    /// Returns the number of lists that were tried.
    pub(super) fn trials(&self) -> usize {
        self.trials
    }

    /// Returns the best list, sought from the times that are best without a shape.
    pub(super) fn best(
        &mut self,
        start: Candidate,
        limit_um: Option<f64>,
    ) -> Result<FrictionList, CircleError> {
        // Half of the circles show in which valley to search.
        let all = self.reversals.clone();
        self.reversals = all.iter().step_by(2).cloned().collect();
        let first = self.drive(ShapedLists::plain(start))?;
        let best = self.descend(first, TRIAL)?;
        self.reversals = all;
        let best = self.drive(best.shape)?;
        let mut best = self.descend(best, MOST)?;
        for _ in 0..EXCHANGES {
            if !self.exchange(&best, limit_um)?.1 {
                break;
            }
            best = self.drive(best.shape)?;
            best = self.descend(best, AGAIN)?;
        }
        // Rounding to whole numbers may increase the glitch at another reversal.
        let mut written: Option<(f64, ListShape)> = None;
        for _ in 0..EXCHANGES {
            let whole = self.whole(&best)?;
            let (largest, is_missed) = self.exchange(&whole, limit_um)?;
            if written.is_none_or(|(least, _)| largest < least) {
                written = Some((largest, whole.shape));
            }
            if !is_missed {
                break;
            }
            best = self.drive(best.shape)?;
            best = self.descend(best, 1)?;
        }
        let (_, best) = written.expect("from the first time on");
        Ok(self.shapes.written(&best))
    }

    /// Adds the reversals between the circles at which a list leaves more than at those: the peaks over the range.
    /// Returns the largest height, and whether there are any.
    fn exchange(
        &mut self,
        best: &DrivenShape,
        limit_um: Option<f64>,
    ) -> Result<(f64, bool), CircleError> {
        let circles = self.task.over_the_range(BETWEEN);
        let list = Method::from(self.shapes.exact(&best.shape));
        let drive = self.task.drive(self.axis);
        let places = [PLACES[0], PLACES[3]];
        let heights = self
            .simulations
            .make(circles.len() * places.len(), &|number| {
                let circle = circles[number / places.len()];
                let alone = self.alone(drive, (places[number % places.len()], &circle));
                Ok(vec![alone.glitch_um(circle, Some(&list))?])
            })?;
        let heights = heights.concat();
        let at =
            |circle: usize| heights[circle * places.len()].max(heights[circle * places.len() + 1]);
        let is_peak = |circle: &usize| {
            let beside = circle.saturating_sub(1)..=(circle + 1).min(circles.len() - 1);
            at(*circle) > EXCESS * best.worst_um
                && beside.into_iter().all(|it| at(it) <= at(*circle))
        };
        let mut peaks: Vec<usize> = (0..circles.len()).filter(is_peak).collect();
        peaks.sort_by(|&one, &other| at(other).total_cmp(&at(one)));
        peaks.truncate(ADDED);
        for &peak in &peaks {
            let is_later = heights[2 * peak] < heights[2 * peak + 1];
            self.add(circles[peak], places[usize::from(is_later)], limit_um);
        }
        let largest = heights.into_iter().fold(best.worst_um, f64::max);
        Ok((largest, !peaks.is_empty()))
    }

    fn alone<'b>(
        &'b self,
        drive: &'b DriveParameters,
        (place, circle): (f64, &Circle),
    ) -> AxisAlone<'b> {
        AxisAlone {
            axis: self.axis,
            drive,
            model: self.task.model,
            reading: self.task.reading,
            phase: phase_at(place, self.axis, circle),
        }
    }

    fn drive(&mut self, shape: ListShape) -> Result<DrivenShape, CircleError> {
        let driven = self.drive_all(&[shape])?;
        Ok(driven.into_iter().next().expect("as many as shapes"))
    }

    fn drive_all(&mut self, shapes: &[ListShape]) -> Result<Vec<DrivenShape>, CircleError> {
        self.trials += shapes.len();
        let lists: Vec<Method> = shapes
            .iter()
            .map(|it| Method::from(self.shapes.exact(it)))
            .collect();
        let lanes: Vec<&[Method]> = lists.chunks(LANES).collect();
        let count = self.reversals.len();
        let driven = self.simulations.make(lanes.len() * count, &|at| {
            let reversal = &self.reversals[at % count];
            let alone = self.alone(&reversal.drive, (reversal.place, &reversal.circle));
            let lists = lanes[at / count];
            let extremes = if let [list] = lists {
                alone.extremes(reversal.circle, Some(list))?
            } else {
                // Lists that are missing in the last lanes are the first once more.
                let lists = std::array::from_fn(|lane| lists.get(lane).unwrap_or(&lists[0]));
                let each: [_; LANES] = alone.extremes_of_each(reversal.circle, lists)?;
                each.concat()
            };
            Ok(extremes.into_flattened())
        })?;
        let judged = |(number, shape): (usize, &ListShape)| {
            let of_reversal = |reversal: usize| {
                let values = &driven[number / LANES * count + reversal];
                let (pairs, _) = values.as_chunks::<2>();
                let circle = &self.reversals[reversal].circle;
                let cycles = cycles_of_window(circle, self.axis);
                pairs[number % LANES * cycles..][..cycles].to_vec()
            };
            self.judged(*shape, (0..count).map(of_reversal).collect())
        };
        Ok(shapes.iter().enumerate().map(judged).collect())
    }

    /// Returns a shape with the extremes at each reversal.
    fn judged(&self, shape: ListShape, extremes: Vec<Vec<[f64; 2]>>) -> DrivenShape {
        let heights: Vec<f64> = extremes.iter().map(|it| height(it)).collect();
        let inside = self.reversals.iter().zip(&heights);
        let inside = inside.filter(|(it, _)| !matches!(it.role, Role::Beyond(_)));
        let worst = inside.map(|it| *it.1).fold(0.0, f64::max);
        let weights: Vec<f64> = self
            .reversals
            .iter()
            .map(|it| match it.role {
                Role::Counted => 1.0,
                Role::Limited(limit_um) => (worst / limit_um).max(1.0),
                Role::Beyond(reserve) => reserve.weight(worst),
            })
            .collect();
        let weighted = heights
            .iter()
            .zip(&weights)
            .map(|(height, weight)| height * weight);
        DrivenShape {
            shape,
            worst_um: weighted.fold(0.0, f64::max),
            extremes,
            weights,
        }
    }

    /// Improves a shape until nothing is gained.
    fn descend(&mut self, start: DrivenShape, rounds: usize) -> Result<DrivenShape, CircleError> {
        let mut best = start;
        let mut reach = 1.0;
        let mut later = DELAY_STEP;
        for _ in 0..rounds {
            let before = best.worst_um;
            let times = best.shape.times;
            let (probes, others) = self.around(&best, later)?;
            let next = self.steps(&best, (&probes, &others), reach)?;
            let wide = next[0];
            let driven = self.drive_all(&next)?;
            let chosen = driven
                .into_iter()
                .min_by(|one, other| one.worst_um.total_cmp(&other.worst_um))
                .filter(|it| it.worst_um < best.worst_um);
            let Some(chosen) = chosen else {
                reach *= PART * PART;
                later = (later / 3).max(1);
                if reach < LEAST_REACH {
                    break;
                }
                continue;
            };
            best = chosen;
            if best.shape.times == times {
                later = (later / 2).max(1);
                let is_wide = best.shape == wide;
                reach = f64::min(1.0, reach * if is_wide { 2.0 } else { PART });
            }
            if best.worst_um > before * (1.0 - GAIN) {
                if later == 1 {
                    break;
                }
                later = 1;
            }
        }
        Ok(best)
    }

    /// Simulates the shapes around one: with each output changed, and with other times.
    fn around(
        &mut self,
        best: &DrivenShape,
        later: i16,
    ) -> Result<(Vec<DrivenShape>, Vec<DrivenShape>), CircleError> {
        let mut shapes = probes(&best.shape).to_vec();
        let others = self.other_times(&best.shape.times, later);
        shapes.extend(others.into_iter().map(|times| ListShape {
            times,
            ..best.shape
        }));
        let mut probes = self.drive_all(&shapes)?;
        let others = probes.split_off(FREE);
        Ok((probes, others))
    }

    /// Times around others within their ranges.
    fn other_times(&self, times: &Candidate, later: i16) -> BTreeSet<Candidate> {
        let ranges = &self.task.ranges;
        let mut others = BTreeSet::new();
        for delay in [-later, -1, 1, later] {
            let delay_cycles = times.delay_cycles.saturating_add(delay);
            others.insert(Candidate {
                delay_cycles: delay_cycles
                    .clamp(*ranges.delay_cycles.start(), *ranges.delay_cycles.end()),
                ..*times
            });
        }
        for lookahead in [-1, 1] {
            let reversal_lookahead = times.reversal_lookahead.saturating_add_signed(lookahead);
            others.insert(Candidate {
                reversal_lookahead: reversal_lookahead.clamp(
                    *ranges.reversal_lookahead.start(),
                    *ranges.reversal_lookahead.end(),
                ),
                ..*times
            });
        }
        for distance in [-DISTANCE_STEP, 1] {
            let position_delay = times.position_delay.saturating_add(distance);
            others.insert(Candidate {
                position_delay: position_delay
                    .clamp(*ranges.position_delay.start(), *ranges.position_delay.end()),
                ..*times
            });
        }
        others.remove(times);
        others
    }

    /// Returns the shapes to try next: two steps with the same times, the larger one first, and those with other times
    /// that promise most.
    fn steps(
        &self,
        best: &DrivenShape,
        (probes, others): (&[DrivenShape], &[DrivenShape]),
        reach: f64,
    ) -> Result<Vec<ListShape>, CircleError> {
        let from = |number: usize| others.get(number).unwrap_or(best);
        let slopes = self.linear(best, probes);
        // Pieces of work: each of the others, and the best itself with both steps.
        let found = self.simulations.make(others.len() + 2, &|number| {
            let from = from(number);
            let part = if number > others.len() { PART } else { 1.0 };
            let mut model = LinearModel {
                curves: self.based_on(from, &slopes),
                limits: limits(&from.shape, reach * part),
            };
            model.prune(WIDE);
            let point = model.minimum();
            let mut values = vec![model.worst(&point)];
            values.extend(point);
            Ok(values)
        })?;
        let shape = |number: usize| {
            let mut next = from(number).shape;
            let changes = found[number].iter().skip(1);
            for (factor, change) in next.factors.iter_mut().zip(changes) {
                *factor += change;
            }
            next
        };
        let mut promising: Vec<usize> = (0..others.len()).collect();
        promising.sort_by(|&one, &other| found[one][0].total_cmp(&found[other][0]));
        promising.truncate(PROMISING);
        let numbers = [others.len(), others.len() + 1]
            .into_iter()
            .chain(promising);
        Ok(numbers.map(shape).collect())
    }

    /// Returns the linear change of the curves at each reversal with each output.
    fn linear(&self, best: &DrivenShape, probes: &[DrivenShape]) -> Vec<LinearCurve> {
        let curve = |(number, reversal): (usize, &JudgedReversal)| {
            let weight = best.weights[number];
            let base = &best.extremes[number];
            let side = |of: usize, sign: f64| {
                let value = |cycle: usize| LinearValue {
                    base: sign * weight * base[cycle][of],
                    slopes: std::array::from_fn(|at| {
                        let moved = probes[at].extremes[number][cycle][of] - base[cycle][of];
                        sign * weight * moved / PROBE
                    }),
                };
                sampled(base.len(), &reversal.circle).map(value).collect()
            };
            LinearCurve {
                sides: [side(1, 1.0), side(0, -1.0)],
            }
        };
        self.reversals.iter().enumerate().map(curve).collect()
    }

    /// Returns the curves of a shape that change as those of another do.
    fn based_on(&self, from: &DrivenShape, slopes: &[LinearCurve]) -> Vec<LinearCurve> {
        let mut curves = slopes.to_vec();
        for (number, (curve, reversal)) in curves.iter_mut().zip(&self.reversals).enumerate() {
            let base = &from.extremes[number];
            let [upper, lower] = &mut curve.sides;
            let cycles = sampled(base.len(), &reversal.circle);
            for ((upper, lower), cycle) in upper.iter_mut().zip(lower).zip(cycles) {
                upper.base = from.weights[number] * base[cycle][1];
                lower.base = -from.weights[number] * base[cycle][0];
            }
        }
        curves
    }

    /// Returns the best shape around one whose outputs are written without a loss.
    fn whole(&mut self, exact: &DrivenShape) -> Result<DrivenShape, CircleError> {
        let nearest = self.shapes.rounded(&exact.shape);
        if self.task.points == Points::Real {
            return self.drive(nearest);
        }
        let model = self.pruned(exact)?;
        let starts = [nearest.factors, self.dive(&exact.shape, &model)];
        let from = |start: [f64; FREE]| ListShape {
            factors: self.whole_step(start, (&exact.shape.factors, &model)),
            ..exact.shape
        };
        let driven = self.drive_all(&starts.map(from))?;
        let better = driven.into_iter().min_by(|one, other| {
            let [one, other] = [one, other].map(|it| self.cost(&it.shape.factors, it.worst_um));
            one.total_cmp(&other)
        });
        let mut best = better.expect("two of them");
        for _ in 0..WHOLE {
            let model = self.pruned(&best)?;
            let factors = best.shape.factors;
            let next = ListShape {
                factors: self.whole_step(factors, (&factors, &model)),
                ..best.shape
            };
            if next == best.shape {
                break;
            }
            let next = self.drive(next)?;
            if self.cost(&next.shape.factors, next.worst_um)
                >= self.cost(&best.shape.factors, best.worst_um)
            {
                break;
            }
            best = next;
        }
        Ok(best)
    }

    /// Returns the model around a shape for changes by a few units.
    fn pruned(&mut self, shape: &DrivenShape) -> Result<LinearModel, CircleError> {
        /// Part of a height by which a few units may change a value.
        const NEAR: f64 = 0.3;
        let probes = self.drive_all(&probes(&shape.shape))?;
        let mut model = LinearModel {
            curves: self.linear(shape, &probes),
            limits: limits(&shape.shape, 1.0),
        };
        model.prune(NEAR);
        Ok(model)
    }

    /// Returns a height, larger if outputs bend too much.
    fn cost(&self, factors: &[f64; FREE], worst_um: f64) -> f64 {
        /// Weight of bends that are too large.
        const DEAR: f64 = 10.0;
        let excess = (self.shapes.bend(factors) - BEND).max(0.0);
        worst_um * (1.0 + DEAR * excess)
    }

    /// Factors of whole outputs: the output that is closest to a whole number becomes that or the other one
    /// beside it, whichever leaves less once the others have followed, and so on.
    fn dive(&self, shape: &ListShape, model: &LinearModel) -> [f64; FREE] {
        let mut model = model.clone();
        let mut change = model.minimum();
        let mut free: Vec<usize> = (0..FREE).collect();
        let mut factors = shape.factors;
        while !free.is_empty() {
            let units = |at: usize| (1.0 + shape.factors[at] + change[at]) / self.shapes.unit(at);
            let far = |at: &usize| (units(*at) - units(*at).round()).abs();
            let closest = (0..free.len())
                .min_by(|&one, &other| far(&free[one]).total_cmp(&far(&free[other])));
            let at = free.swap_remove(closest.expect("not empty"));
            let tried = [units(at).floor(), units(at).ceil()].map(|units| {
                let factor = units * self.shapes.unit(at) - 1.0;
                let mut model = model.clone();
                model.fix(at, factor - shape.factors[at]);
                let point = model.minimum();
                (model.worst(&point), (factor, model, point))
            });
            let better = tried
                .into_iter()
                .min_by(|one, other| one.0.total_cmp(&other.0));
            let (factor, fixed, point) = better.expect("two of them").1;
            factors[at] = factor;
            model = fixed;
            change = point;
        }
        factors
    }

    /// Returns the factors around some that are best by a model of others, one or two outputs after another changed by
    /// a unit.
    fn whole_step(
        &self,
        start: [f64; FREE],
        (origin, model): (&[f64; FREE], &LinearModel),
    ) -> [f64; FREE] {
        const CHANGES: [[f64; 2]; 6] = [
            [1.0, 0.0],
            [-1.0, 0.0],
            [1.0, 1.0],
            [1.0, -1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
        ];
        let cost = |factors: [f64; FREE]| {
            let change = std::array::from_fn(|at| factors[at] - origin[at]);
            self.cost(&factors, model.worst(&change))
        };
        let mut best = start;
        let mut least = cost(best);
        loop {
            let mut next = None;
            for one in 0..FREE {
                for other in one + 1..FREE {
                    for [first, second] in CHANGES {
                        let mut tried = best;
                        tried[one] += first * self.shapes.unit(one);
                        tried[other] += second * self.shapes.unit(other);
                        let cost = cost(tried);
                        if cost < least * (1.0 - 1e-6) {
                            least = cost;
                            next = Some(tried);
                        }
                    }
                }
            }
            match next {
                Some(next) => best = next,
                None => return best,
            }
        }
    }
}

/// Returns the shapes with each output changed.
fn probes(shape: &ListShape) -> [ListShape; FREE] {
    std::array::from_fn(|at| {
        let mut probe = *shape;
        probe.factors[at] += PROBE;
        probe
    })
}

/// Returns the limits of a step from a shape.
fn limits(shape: &ListShape, reach: f64) -> Vec<LinearValue> {
    /// A limit that is reached leaves this much.
    const LEAST: f64 = 1e-4;
    let mut limits = Vec::new();
    let mut limit = |slopes: FreeValues, room: f64| {
        limits.push(LinearValue {
            base: -room.max(LEAST),
            slopes,
        });
    };
    let factor = |at: usize| shape.factors.get(at).copied().unwrap_or_default();
    for at in 0..FREE {
        let step = reach * OUTPUT_STEP;
        let mut slopes = [0.0; FREE];
        slopes[at] = 1.0;
        limit(slopes, step.min(BOUND - factor(at)));
        limit(slopes.map(|it| -it), step.min(BOUND + factor(at)));
    }
    for at in 1..=FREE {
        let mut slopes = [0.0; FREE];
        for (place, weight) in [(at - 1, 1.0), (at, -2.0), (at + 1, 1.0)] {
            if place < FREE {
                slopes[place] = weight;
            }
        }
        let bend = factor(at - 1) - 2.0 * factor(at) + factor(at + 1);
        limit(slopes, ALLOWED - bend);
        limit(slopes.map(|it| -it), ALLOWED + bend);
    }
    limits
}

/// Returns the cycles of a window at which a curve is sampled.
fn sampled(cycles: usize, circle: &Circle) -> impl Iterator<Item = usize> + use<> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few cycles
    let stride = (SAMPLE_S / circle.cycle_time_s).round() as usize;
    (0..cycles).step_by(stride.max(1))
}

fn height(extremes: &[[f64; 2]]) -> f64 {
    let least = extremes.iter().map(|it| it[0]).fold(f64::MAX, f64::min);
    let most = extremes.iter().map(|it| it[1]).fold(f64::MIN, f64::max);
    most - least
}
