//! Step from the rounds of an axis to the list of the next one.

use super::bounds::{Steps, VARIABLES};
use super::progress::LearningProgress;
use super::round::{LearnedCircle, LearnedRound};
use crate::circle::figures::Waveform;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleError};
use crate::circle::simulated::Method;
use crate::circle::tune::reversal::AxisAlone;
use crate::circle::tune::{CmaEs, POINTS};
use crate::circle::tune::{Heights, Ranges, Simulations};
use crate::current::Reading;
use crate::simulation::{DriveParameters, FrictionModel};
use frictcomp::lists::{FrictionList, Points};

/// Contacts that are tried against the recordings: from a quarter to four times as stiff.
const CONTACTS: i32 = 8;

/// Number of contacts from one to another twice as stiff.
const PER_OCTAVE: f64 = 4.0;

/// The first step of the search, as a part of the largest.
const STEP: f64 = 0.3;

/// Maximum number of generations of the search.
const MOST: usize = 80;

/// Generations without a gain after which the search ends.
const IDLE: usize = 20;

/// Smallest gain that counts, as a part.
const GAIN: f64 = 0.002;

/// Cost of the largest step, as a part of the glitch: a smaller gain is not worthwhile.
const CHANGE: f64 = 0.1;

/// An axis that learns, and the reference plant that gives the direction (R16.4).
#[derive(Debug, Clone)]
pub struct Learner {
    /// The axis.
    pub axis: PlaneAxis,
    /// Drive in the reference plant.
    pub drive: DriveParameters,
    /// Friction model.
    pub model: FrictionModel,
    /// Reading of the documents.
    pub reading: Reading,
    /// The ranges in which the parameters are searched.
    pub ranges: Ranges,
    /// Form of the points of the lists.
    pub points: Points,
    /// The measured friction as a value list, and the greatest part of it that a list may add (R16.9).
    pub friction: (FrictionList, f64),
}

/// The list of the next round.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Proposal {
    /// The list.
    pub list: FrictionList,
    /// The largest glitch in µm that is predicted with it.
    pub predicted_um: f64,
    /// Stiffness of the contact that fits all rounds, as a multiple of that of the reference plant.
    pub contact: f64,
}

/// The best round, and the simulation of its list.
struct BestRound<'a> {
    circles: &'a [LearnedCircle],
    /// The mean of both recordings on each circle.
    recorded: Vec<Vec<Waveform>>,
    /// The simulated one with the list of the best round.
    simulated: Vec<Waveform>,
    /// Circles at feeds between the recorded ones.
    between: Vec<Between>,
}

/// A circle at a feed between two recorded ones.
struct Between {
    circle: Circle,
    /// The mean amount by which the glitches in µm at each reversal were recorded higher than simulated on its two
    /// neighbours.
    missed_um: Vec<f64>,
}

impl Between {
    /// Returns the circles between those of a round, which are sorted with the slowest first.
    fn all(
        circles: &[LearnedCircle],
        recorded: &[Vec<Waveform>],
        simulated: &[Waveform],
    ) -> Vec<Self> {
        let missed = recorded.iter().zip(simulated).map(|(recorded, simulated)| {
            let simulated = simulated.height_um();
            let each = recorded.iter().map(|it| it.height_um() - simulated);
            each.collect()
        });
        let missed: Vec<Vec<f64>> = missed.collect();
        let pairs = circles.windows(2).zip(missed.windows(2));
        pairs
            .map(|(circles, missed)| {
                let [slow, fast] = [0, 1].map(|at: usize| circles[at].circle);
                let feed = (slow.feed_mm_per_min * fast.feed_mm_per_min).sqrt();
                Self {
                    circle: Circle {
                        feed_mm_per_min: feed,
                        ..slow
                    },
                    missed_um: missed[0]
                        .iter()
                        .zip(&missed[1])
                        .map(|(slow, fast)| f64::midpoint(*slow, *fast))
                        .collect(),
                }
            })
            .collect()
    }
}

impl Learner {
    /// Returns the maximum number of simulations of a proposal.
    pub fn expected_trials(rounds: usize) -> usize {
        let contacts = usize::try_from(2 * CONTACTS + 1).unwrap_or_default();
        contacts * rounds + MOST * POINTS
    }

    /// Returns the next list after rounds; `None` if there are no rounds.
    ///
    /// # Errors
    /// A circle that cannot be simulated.
    pub fn propose(
        &self,
        rounds: &[LearnedRound],
        simulations: &dyn Simulations,
    ) -> Result<Option<Proposal>, CircleError> {
        let progress = LearningProgress::of(rounds);
        let Some(best) = rounds.get(progress.best) else {
            return Ok(None);
        };
        let contact = self.fitted_contact(rounds, simulations)?;
        let drive = self.drive.with_contact(contact);
        let recorded: Vec<Vec<Waveform>> =
            best.circles.iter().map(|it| it.recorded.mean()).collect();
        let simulated = self.all_simulated(&drive, best)?;
        let start = BestRound {
            circles: &best.circles,
            between: Between::all(&best.circles, &recorded, &simulated),
            recorded,
            simulated,
        };
        let (friction, most) = &self.friction;
        let steps = Steps::new(
            &best.list,
            (friction, *most),
            (&self.ranges, self.points),
            progress.step,
        );
        let (point, predicted_um) = self.search(&steps, &drive, (&start, simulations))?;
        Ok(Some(Proposal {
            list: steps.list(&point),
            predicted_um,
            contact,
        }))
    }

    /// Returns the stiffness of the contact with which the plant is closest to all recordings, as a multiple.
    fn fitted_contact(
        &self,
        rounds: &[LearnedRound],
        simulations: &dyn Simulations,
    ) -> Result<f64, CircleError> {
        let factors: Vec<f64> = (-CONTACTS..=CONTACTS)
            .map(|it| (f64::from(it) / PER_OCTAVE).exp2())
            .collect();
        let errors = simulations.make(factors.len() * rounds.len(), &|at| {
            let (factor, round) = (factors[at / rounds.len()], &rounds[at % rounds.len()]);
            let drive = self.drive.with_contact(factor);
            let simulated = self.all_simulated(&drive, round)?;
            let each = round.circles.iter().zip(&simulated);
            Ok(each.map(|(circle, it)| misfit(circle, it)).collect())
        })?;
        let sum = |of_factor: &[Vec<f64>]| of_factor.iter().flatten().sum::<f64>();
        let sums = errors.chunks(rounds.len()).map(sum);
        let best = factors.iter().zip(sums);
        let best = best.min_by(|one, other| one.1.total_cmp(&other.1));
        Ok(best.map_or(1.0, |(factor, _)| *factor))
    }

    /// Returns the simulated deviation with the list of a round on each of its circles.
    fn all_simulated(
        &self,
        drive: &DriveParameters,
        round: &LearnedRound,
    ) -> Result<Vec<Waveform>, CircleError> {
        let list = Method::from(round.list.clone());
        let each = round.circles.iter();
        each.map(|it| self.simulated(drive, it.circle, &list))
            .collect()
    }

    /// Returns the simulated deviation at a reversal, less the straight line through its ends.
    fn simulated(
        &self,
        drive: &DriveParameters,
        circle: Circle,
        list: &Method,
    ) -> Result<Waveform, CircleError> {
        let alone = AxisAlone {
            axis: self.axis,
            drive,
            model: self.model,
            reading: self.reading,
            phase: 0.0,
        };
        let deviations = alone.deviations(circle, Some(list))?;
        Ok(Waveform::sampled(&deviations).levelled())
    }

    /// Returns the point of the search whose list is predicted to leave least, with the largest predicted glitch in µm.
    fn search(
        &self,
        steps: &Steps,
        drive: &DriveParameters,
        (start, simulations): (&BestRound<'_>, &dyn Simulations),
    ) -> Result<(Vec<f64>, f64), CircleError> {
        let mut search = CmaEs::new(vec![0.0; VARIABLES], STEP, 0);
        let mut best: Option<(f64, Vec<f64>, f64)> = None;
        let mut idle = 0;
        for _ in 0..MOST {
            let points = search.ask();
            let heights = simulations.make(points.len(), &|at| {
                let list = Method::from(steps.list(&points[at]));
                Ok(self.predicted(drive, start, &list)?.0)
            })?;
            let heights: Vec<Heights> = heights.into_iter().map(Heights).collect();
            let cost = |(point, heights): (&Vec<f64>, &Heights)| {
                let dear = 1.0 + Steps::excess(point) + CHANGE * Steps::length(point);
                heights.smooth_um() * dear
            };
            let costs: Vec<f64> = points.iter().zip(&heights).map(cost).collect();
            idle += 1;
            for ((point, heights), &cost) in points.iter().zip(&heights).zip(&costs) {
                let before = best.as_ref().map_or(f64::INFINITY, |it| it.0);
                if cost < before * (1.0 - GAIN) {
                    idle = 0;
                }
                if cost < before {
                    // Only the recorded circles can show whether the prediction is correct.
                    let recorded = start.recorded.iter().map(Vec::len).sum();
                    let recorded: &[f64] = &heights.0[..recorded];
                    best = Some((
                        cost,
                        point.clone(),
                        recorded.iter().copied().fold(0.0, f64::max),
                    ));
                }
            }
            if idle >= IDLE {
                break;
            }
            search.tell(&costs);
        }
        let found = best.map(|(_, point, predicted_um)| (point, predicted_um));
        Ok(found.unwrap_or_else(|| (vec![0.0; VARIABLES], f64::INFINITY)))
    }

    /// Returns the predicted heights with a list at each reversal of each circle: the recorded ones with the best list,
    /// plus the difference of the plant between both lists. Those between the recorded feeds follow.
    fn predicted(
        &self,
        drive: &DriveParameters,
        start: &BestRound<'_>,
        list: &Method,
    ) -> Result<Heights, CircleError> {
        let mut heights = Vec::new();
        let each = start
            .circles
            .iter()
            .zip(&start.recorded)
            .zip(&start.simulated);
        for ((circle, recorded), before) in each {
            let change = self.simulated(drive, circle.circle, list)?.less(before);
            heights.extend(recorded.iter().map(|it| it.changed(&change).height_um()));
        }
        for between in &start.between {
            let height = self.simulated(drive, between.circle, list)?.height_um();
            heights.extend(between.missed_um.iter().map(|missed| height + missed));
        }
        Ok(Heights(heights))
    }
}

/// Returns the mean square in µm² by which a simulated deviation misses the recorded ones.
fn misfit(circle: &LearnedCircle, simulated: &Waveform) -> f64 {
    let recorded = circle.recorded.mean();
    let missed = recorded.iter().map(|recorded| {
        let recorded = recorded.within(simulated).levelled();
        recorded.less(&simulated.within(&recorded)).power()
    });
    missed.sum()
}
