//! Tuning from the task to its result.

use serde::Serialize;

use super::candidate::Candidate;
use super::check::{CHECKED, Deviating, RemainingGlitch};
use super::descent::Descent;
use super::heights::Heights;
use super::search::Search;
use super::space::{Lists, Space, Stictions};
use super::task::TuningAim;
use super::task::{Shaping, Task, Variant};
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleError};
use crate::circle::simulated::Method;
use crate::stiction::StictionParameters;
use frictcomp::lists::FrictionList;

/// The largest glitches on one circle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct FeedResult {
    /// The feed.
    #[serde(rename = "feed")]
    pub feed_mm_per_min: f64,
    /// The radius.
    #[serde(rename = "radius")]
    pub radius_mm: f64,
    /// The acceleration v²/R at a reversal, on which the glitch depends.
    #[serde(rename = "acceleration")]
    pub acceleration_mm_per_s2: f64,
    /// Glitch without compensation.
    #[serde(rename = "glitch_off")]
    pub glitch_off_um: f64,
    /// Glitch with compensation.
    #[serde(rename = "glitch_on")]
    pub glitch_on_um: f64,
    /// Glitch with compensation, and 20 % less friction of the machine than in the list.
    #[serde(rename = "glitch_friction_minus20")]
    pub glitch_friction_minus20_um: f64,
    /// Glitch with compensation, and 20 % more friction of the machine than in the list.
    #[serde(rename = "glitch_friction_plus20")]
    pub glitch_friction_plus20_um: f64,
}

impl FeedResult {
    /// Returns whether compensation makes it worse.
    pub fn is_worse(&self) -> bool {
        self.glitch_on_um > self.glitch_off_um
    }
}

/// Result for an axis.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TunedAxis {
    /// The best compensation: a value list in its written form, or stiction compensation; none for an
    /// axis without it if the other axis has it.
    pub compensation: Option<Method>,
    /// Whether the points of the list below 1 mm/s have a separate shape.
    pub is_shaped: bool,
}

impl TunedAxis {
    /// Returns the value list, if there is one.
    pub fn list(&self) -> Option<&FrictionList> {
        self.compensation.as_ref()?.list()
    }

    /// Returns the parameters of stiction compensation, if it is that.
    pub fn stiction(&self) -> Option<&StictionParameters> {
        self.compensation.as_ref()?.stiction()
    }
}

/// A robust list compared with one for the plant alone: the largest glitch over the range, on the plant and on
/// machines that deviate from it (R5.29).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Robust {
    /// Whether the robust list gains 5 % or more and costs at most a quarter on the plant; otherwise the other list is
    /// kept.
    pub is_taken: bool,
    /// The list for the plant alone.
    #[serde(rename = "glitch_plain")]
    pub plain_um: f64,
    /// The robust one.
    #[serde(rename = "glitch_robust")]
    pub robust_um: f64,
}

/// The result of a tuning.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Tuned {
    /// X and Y; both are the same if their drives are equal.
    pub axes: [TunedAxis; 2],
    /// Remaining glitches on each circle.
    pub feeds: Vec<FeedResult>,
    /// Remaining glitches at accelerations over the whole range (R5.29).
    pub check: Vec<RemainingGlitch>,
    /// Result of the search for a robust list, if it was requested.
    pub robust: Option<Robust>,
    /// Number of lists, or sets of parameters, tried.
    pub trials: usize,
}

impl Tuned {
    /// Returns whether stiction compensation was tuned.
    pub fn is_stiction(&self) -> bool {
        self.axes.iter().any(|axis| axis.stiction().is_some())
    }

    /// Returns the largest glitch with compensation, on the circles and over their whole range.
    pub fn worst_um(&self) -> f64 {
        let circles = self.feeds.iter().map(|it| it.glitch_on_um);
        circles.fold(worst(&self.check, |it| it.glitch_on_um), f64::max)
    }

    /// Returns the range of v²/R in mm/s² for which the lists were tuned.
    pub fn accelerations(&self) -> [f64; 2] {
        let all = self.feeds.iter().map(|it| it.acceleration_mm_per_s2);
        all.fold([f64::INFINITY, 0.0], |[least, most], it| {
            [least.min(it), most.max(it)]
        })
    }
}

/// Independent simulations: their number, and a function that makes one of them.
pub trait Simulations: Send + Sync {
    /// Makes all of them, in any order, and returns the values of each in the original order.
    ///
    /// # Errors
    /// A circle that cannot be simulated.
    fn make(
        &self,
        count: usize,
        simulation: &(dyn Fn(usize) -> Result<Vec<f64>, CircleError> + Sync),
    ) -> Result<Vec<Vec<f64>>, CircleError>;
}

/// Simulations one after the other.
#[derive(Debug, Clone, Copy)]
struct InOrder;

impl Simulations for InOrder {
    fn make(
        &self,
        count: usize,
        simulation: &(dyn Fn(usize) -> Result<Vec<f64>, CircleError> + Sync),
    ) -> Result<Vec<Vec<f64>>, CircleError> {
        (0..count).map(simulation).collect()
    }
}

/// Tunes without threads, one trial after the other.
///
/// # Errors
/// A circle that cannot be simulated, or has no glitch.
pub fn tune(task: &Task) -> Result<Tuned, CircleError> {
    tune_with(task, &InOrder)
}

/// Part of the largest glitch that a shape may leave to be taken.
const WORTH_IT: f64 = 0.95;

/// A robust list is taken if it leaves at most this part of what the other leaves on machines that
/// deviate (R5.29) …
const WORTH_ROBUST: f64 = 0.95;

/// … and at most this factor more on the plant.
const ROBUST_COSTS: f64 = 1.25;

/// Tunes with any maker of simulations; the result is the same.
///
/// # Errors
/// A circle that cannot be simulated, or has no glitch.
pub fn tune_with(task: &Task, simulations: &dyn Simulations) -> Result<Tuned, CircleError> {
    task.check()?;
    let mut tuning = Tuning {
        task,
        simulations,
        searched: task.searched(),
        limit_um: None,
    };
    let mut trials = 0;
    let mut found = tuning.found(&mut trials)?;
    let mut robust = None;
    if task.aim == TuningAim::Robust {
        let limit_um = ROBUST_COSTS * worst(&found.check, |it| it.glitch_on_um);
        tuning.limit_um = Some(limit_um);
        let other = tuning.found(&mut trials)?;
        let [before, after] =
            [&found, &other].map(|it| worst(&it.check, RemainingGlitch::robust_um));
        let is_taken =
            after <= WORTH_ROBUST * before && worst(&other.check, |it| it.glitch_on_um) <= limit_um;
        robust = Some(Robust {
            is_taken,
            plain_um: before,
            robust_um: after,
        });
        if is_taken {
            found = other;
        }
    }
    let glitches = tuning.wholes(&found.axes, &Variant::ALL)?;
    let feeds = task.circles.iter().zip(glitches);
    let feeds = feeds.map(|(circle, glitches)| FeedResult {
        feed_mm_per_min: circle.feed_mm_per_min,
        radius_mm: circle.radius_mm,
        acceleration_mm_per_s2: circle.acceleration_mm_per_s2(),
        glitch_off_um: glitches[0],
        glitch_on_um: glitches[1],
        glitch_friction_minus20_um: glitches[2],
        glitch_friction_plus20_um: glitches[3],
    });
    Ok(Tuned {
        feeds: feeds.collect(),
        axes: found.axes,
        check: found.check,
        robust,
        trials,
    })
}

fn worst(check: &[RemainingGlitch], of: impl Fn(&RemainingGlitch) -> f64) -> f64 {
    check.iter().map(of).fold(0.0, f64::max)
}

/// Lists, and their remaining glitches over the range.
struct TunedLists {
    axes: [TunedAxis; 2],
    check: Vec<RemainingGlitch>,
}

/// A list that without a shape removes most of the glitch beyond the tuned range must
/// do so with a shape, too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reserve {
    /// A circle beyond the range.
    pub(super) circle: Circle,
    /// Remaining glitch of the unshaped list there, in µm.
    left_um: f64,
}

/// Part of a glitch that may be left if most of it is removed.
const MOSTLY: f64 = 0.2;

/// Permitted factor of the glitch beyond the range to that within it.
const MORE: f64 = 1.5;

impl Reserve {
    fn of(task: &Task, axes: &[PlaneAxis], plain: &Method) -> Result<Option<Self>, CircleError> {
        let Some(circle) = task.beyond() else {
            return Ok(None);
        };
        let off_um = task.glitch_um(axes, circle, None)?;
        let left_um = task.glitch_um(axes, circle, Some(plain))?;
        let holds = left_um <= MOSTLY * off_um;
        Ok(holds.then_some(Self { circle, left_um }))
    }

    /// Returns the weight of a glitch beyond the range for a list that leaves `worst_um` within it: with too much left
    /// there, it counts as more than that.
    pub(super) fn weight(&self, worst_um: f64) -> f64 {
        worst_um / self.left_um.max(MORE * worst_um)
    }
}

impl Task {
    /// Returns the approximate number of simulations of a tuning: a search ends when nothing improves.
    pub fn expected_trials(&self) -> usize {
        /// Usual number of lists in the search for the parameters of a list.
        const PARAMETERS: usize = 400;
        let shapes = match self.shaping {
            Shaping::Allowed => Descent::USUAL_SIMULATIONS,
            Shaping::None => 0,
        };
        let searches = match self.aim {
            TuningAim::Plant => 1,
            TuningAim::Robust => 2,
        };
        let check = CHECKED * Self::reversals_of_a_check();
        searches * self.groups().len() * (PARAMETERS + shapes + 2 * check)
    }
}

/// A task, and the maker of its simulations.
struct Tuning<'a> {
    task: &'a Task,
    simulations: &'a dyn Simulations,
    /// The circles of a search.
    searched: Vec<Circle>,
    /// Greatest glitch of a robust list on the plant; without it only the plant counts.
    limit_um: Option<f64>,
}

impl Tuning<'_> {
    /// Returns the best lists, checked over the whole range: with a shape if that leaves less.
    fn found(&self, trials: &mut usize) -> Result<TunedLists, CircleError> {
        let task = self.task;
        let mut found: Vec<(PlaneAxis, TunedAxis, Option<TunedAxis>)> = Vec::new();
        let [of_x, of_y] = Method::of_plant(&task.plant);
        for axes in task.groups() {
            let Some(&first) = axes.first() else { continue };
            let own = match first {
                PlaneAxis::X => &of_x,
                PlaneAxis::Y => &of_y,
            };
            let (plain, shaped) = match own {
                Some(Method::Current(_)) => self.list(&axes, trials)?,
                Some(Method::Stiction(stiction)) => (self.stiction(&axes, stiction, trials)?, None),
                None => (TunedAxis::default(), None),
            };
            let each = axes.iter();
            found.extend(each.map(|&axis| (axis, plain.clone(), shaped.clone())));
        }
        let of = |axis: PlaneAxis, shaping: Shaping| {
            let mut found = found.iter().filter(|(of, ..)| *of == axis);
            let (_, plain, shaped) = found.next().expect("every axis is in a group");
            match shaping {
                Shaping::Allowed => shaped.as_ref().unwrap_or(plain).clone(),
                Shaping::None => plain.clone(),
            }
        };
        let both = |shaping| PlaneAxis::ALL.map(|axis| of(axis, shaping));
        let checked = |axes: [TunedAxis; 2]| {
            let check = self.check(&axes)?;
            Ok(TunedLists { axes, check })
        };
        let plain = checked(both(Shaping::None))?;
        let shaped = both(Shaping::Allowed);
        if shaped == plain.axes {
            return Ok(plain);
        }
        let shaped = checked(shaped)?;
        let left = |found: &TunedLists| {
            worst(&found.check, |it| match self.limit_um {
                None => it.glitch_on_um,
                Some(_) => it.robust_um(),
            })
        };
        let is_worth_it = left(&shaped) <= WORTH_IT * left(&plain);
        Ok(if is_worth_it { shaped } else { plain })
    }

    /// Checks the remaining glitches of lists over the whole range.
    fn check(&self, axes: &[TunedAxis; 2]) -> Result<Vec<RemainingGlitch>, CircleError> {
        let task = self.task;
        let circles = task.checked();
        let is_same = task.plant.x == task.plant.y && axes[0] == axes[1];
        let looked_at = &PlaneAxis::ALL[..if is_same { 1 } else { 2 }];
        let reversals = Task::reversals_of_a_check();
        let count = looked_at.len() * circles.len() * reversals;
        let glitches = self.simulations.make(count, &|at| {
            let (row, reversal) = (at / reversals, at % reversals);
            let plane_axis = looked_at[row / circles.len()];
            let compensation = match plane_axis {
                PlaneAxis::X => &axes[0],
                PlaneAxis::Y => &axes[1],
            };
            let circle = circles[row % circles.len()];
            let compensation = compensation.compensation.as_ref();
            let glitch = task.check_reversal(plane_axis, (circle, reversal), compensation)?;
            Ok(vec![glitch])
        })?;
        let glitches = glitches.concat();
        let rows: Vec<RemainingGlitch> = glitches
            .chunks(reversals)
            .enumerate()
            .map(|(at, glitches)| Task::row(circles[at % circles.len()], glitches))
            .collect();
        let (of_first, of_second) = rows.split_at(circles.len());
        Ok(of_first
            .iter()
            .enumerate()
            .map(|(at, row)| of_second.get(at).map_or(*row, |other| row.or(*other)))
            .collect())
    }

    /// Returns the remaining glitches of a compensation on each circle of the search; one that
    /// reaches `bound_um` has lost.
    fn heights(
        &self,
        axes: &[PlaneAxis],
        compensation: &Method,
        (order, bound_um): (&[usize], f64),
    ) -> Result<Heights, CircleError> {
        let Some(limit_um) = self.limit_um else {
            let circles = (&self.searched[..], order, bound_um);
            return self.task.heights(axes, compensation, circles);
        };
        let of = |circle: &Circle| {
            let glitches = Deviating::ALL.map(|deviating| {
                self.task
                    .deviating_um(axes[0], (*circle, deviating), compensation)
            });
            let mut most: f64 = 0.0;
            let mut plant = 0.0;
            for (glitch, deviating) in glitches.into_iter().zip(Deviating::ALL) {
                let glitch = glitch?;
                most = most.max(glitch);
                if deviating == Deviating::Nothing {
                    plant = glitch;
                }
            }
            // A list that costs too much on the plant is not a gain elsewhere.
            Ok(most * (plant / limit_um).max(1.0).powi(2))
        };
        let heights: Result<Vec<f64>, CircleError> = self.searched.iter().map(of).collect();
        Ok(Heights(heights?))
    }
    /// Returns the best value list of axes whose table is their friction curve, and the best with a shape.
    fn list(
        &self,
        axes: &[PlaneAxis],
        trials: &mut usize,
    ) -> Result<(TunedAxis, Option<TunedAxis>), CircleError> {
        let task = self.task;
        let drive = task.drive(axes[0]);
        let of = |candidate: Candidate| Method::from(candidate.list(drive, task.points));
        let search = self.search(axes, Lists(task.ranges.clone()), &of)?;
        *trials += search.trials();
        let candidate = search.result();
        let plain = TunedAxis {
            compensation: Some(of(candidate)),
            is_shaped: false,
        };
        let shaped = match task.shaping {
            Shaping::Allowed => Some(self.shape(axes, candidate, trials)?),
            Shaping::None => None,
        };
        Ok((plain, shaped))
    }

    /// Returns the best MP1511 and MP1512 of axes whose other parameters are given (R8.6).
    fn stiction(
        &self,
        axes: &[PlaneAxis],
        given: &StictionParameters,
        trials: &mut usize,
    ) -> Result<TunedAxis, CircleError> {
        let of = |(factor, limit): (u32, u32)| {
            Method::from(StictionParameters {
                mp1511_us: f64::from(factor),
                mp1512: f64::from(limit),
                ..*given
            })
        };
        let search = self.search(axes, Stictions(self.task.ranges.clone()), &of)?;
        *trials += search.trials();
        Ok(TunedAxis {
            compensation: Some(of(search.result())),
            is_shaped: false,
        })
    }

    /// Returns the search for the parameters of axes in a space, each candidate of which is a compensation.
    fn search<S: Space>(
        &self,
        axes: &[PlaneAxis],
        space: S,
        of: &(dyn Fn(S::Candidate) -> Method + Sync),
    ) -> Result<Search<S>, CircleError>
    where
        S::Candidate: Sync,
    {
        let mut search = Search::new(space);
        while let Some(trials) = search.next_trials() {
            let bound = search.bound();
            let order = self.order(search.best_heights());
            let heights = self.simulations.make(trials.len(), &|at| {
                let heights = self.heights(axes, &of(trials[at]), (&order, bound))?;
                Ok(heights.0)
            })?;
            let heights: Vec<Heights> = heights.into_iter().map(Heights).collect();
            search.take(&trials, &heights);
        }
        Ok(search)
    }

    /// Returns the order in which circles are simulated: first those on which the best candidate leaves most, since
    /// another one loses there soonest; without one the fastest, which is the shortest simulation.
    fn order(&self, best: Option<&Heights>) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.searched.len()).collect();
        let rank = |at: usize| match best {
            Some(best) => best.0[at],
            None => self.searched[at].feed_mm_per_min,
        };
        order.sort_by(|&one, &other| rank(other).total_cmp(&rank(one)));
        order
    }

    /// Returns the best shape of the points below 1 mm/s.
    fn shape(
        &self,
        axes: &[PlaneAxis],
        start: Candidate,
        trials: &mut usize,
    ) -> Result<TunedAxis, CircleError> {
        let task = self.task;
        let plain = start.list(task.drive(axes[0]), task.points).into();
        let mut descent = Descent::new(task, axes[0], self.simulations);
        descent.judge(&self.searched, self.limit_um);
        if let Some(reserve) = Reserve::of(task, axes, &plain)? {
            descent.keep(reserve);
        }
        let list = descent.best(start, self.limit_um)?;
        *trials += descent.trials();
        Ok(TunedAxis {
            compensation: Some(list.into()),
            is_shaped: true,
        })
    }

    /// Returns the glitches of whole circles with the result: for each circle one per variant.
    fn wholes(
        &self,
        axes: &[TunedAxis; 2],
        variants: &[Variant],
    ) -> Result<Vec<Vec<f64>>, CircleError> {
        let compensation = axes.each_ref().map(|axis| axis.compensation.clone());
        let circles = &self.task.circles;
        let glitches = self
            .simulations
            .make(circles.len() * variants.len(), &|at| {
                let (circle, variant) = (at / variants.len(), at % variants.len());
                let glitch =
                    self.task
                        .whole_um(circles[circle], &compensation, variants[variant])?;
                Ok(vec![glitch])
            })?;
        let values = glitches.concat();
        Ok(values
            .chunks(variants.len().max(1))
            .map(<[f64]>::to_vec)
            .collect())
    }
}
