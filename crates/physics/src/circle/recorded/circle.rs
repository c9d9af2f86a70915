//! One turn of a recorded circle.

use std::f64::consts::TAU;
use std::ops::Range;

use super::cut::{PathRun, runs};
use super::drift::drift;
use super::error::RecordedError;
use super::fit::FittedCircle;
use super::limits::{LIKE, MIN_POINTS, MOST_MM, WIDEST_GAP_DEG};
use super::search::search;
use super::trace::RecordedTrace;
use crate::circle::geometry::Direction;
use crate::circle::geometry::quality;
use crate::circle::geometry::{Gap, Gatherer, Quality, RadialProfile};
use crate::circle::geometry::{least_squares, zone_about};

/// Rounds in which the turn is fitted and cut again.
const ROUNDS: usize = 3;

/// Millimetres in a metre.
const MM_PER_M: f64 = 1000.0;

/// A circle that was recorded, in either direction.
#[derive(Debug, Clone)]
pub struct RecordedCircle {
    /// The direction of travel, found from the points.
    pub direction: Direction,
    /// The centre of the least-squares circle.
    pub centre_mm: [f64; 2],
    /// Radius.
    pub radius_mm: f64,
    /// Number of points of the evaluated turn.
    pub points: usize,
    /// Duration of the turn, if the times are known.
    pub turn_s: Option<f64>,
    /// The longest time between two points of all its turns, if the times are known.
    pub widest_step_s: Option<f64>,
    /// The rest of the recording.
    pub left_out: LeftOut,
    pub(crate) profile: RadialProfile,
    /// The points of each whole turn about its own centre, in m.
    pub(super) turns_m: Vec<Vec<[f64; 2]>>,
}

/// The rest of a recording without the evaluated turn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LeftOut {
    /// Rows that repeat the one before them, of the whole recording.
    pub repeated: usize,
    /// Points before the path along the circle in this direction: the approach, standstill, the
    /// other direction.
    pub before: usize,
    /// Points after that path.
    pub after: usize,
    /// The angle of the whole path along the circle in this direction.
    pub along_deg: f64,
}

impl RecordedCircle {
    /// Returns the circles of a recording, one for each direction in which it has a full turn. If there is more than a
    /// turn, the one next to the middle is evaluated; what begins or ends at rest is left out.
    ///
    /// F and D are against the commanded radius `commanded_mm`; G, H and the glitches do not
    /// depend on it.
    ///
    /// # Errors
    /// The points do not make a full circle.
    pub fn find(
        trace: &RecordedTrace,
        commanded_mm: Option<f64>,
    ) -> Result<Vec<Self>, RecordedError> {
        let different = trace.without_repeats();
        let points = &different.points_mm;
        let fit = search(points);
        if points.len() < MIN_POINTS && points.len() > 1 {
            return Err(RecordedError::TooFew(points.len()));
        }
        let fit = fit?;
        let runs = runs(&fit, &different);
        let mut found = Vec::new();
        let repeated = trace.points_mm.len() - points.len();
        for direction in Direction::ALL {
            let full = runs
                .iter()
                .filter(|run| run.direction == direction && run.is_full());
            let turns = full.filter_map(|run| Some((run, run.turn(&fit, points)?)));
            let longest =
                turns.max_by(|(one, _), (other, _)| one.covered().total_cmp(&other.covered()));
            if let Some((run, turn)) = longest {
                found.push(Self::of(&different, run, turn, commanded_mm)?.with_repeats(repeated));
            }
        }
        if found.is_empty() {
            return Err(refusal(&fit, points, &runs));
        }
        Ok(found)
    }

    /// Returns the circle of a run from one turn on it.
    fn of(
        trace: &RecordedTrace,
        run: &PathRun,
        mut turn: Range<usize>,
        commanded_mm: Option<f64>,
    ) -> Result<Self, RecordedError> {
        let points = &trace.points_mm;
        let mut fit = FittedCircle::of(&points[turn.clone()])?;
        for _ in 0..ROUNDS {
            turn = run.turn(&fit, points).unwrap_or(turn);
            fit = FittedCircle::of(&points[turn.clone()])?;
        }
        if turn.len() < MIN_POINTS {
            return Err(RecordedError::TooFew(turn.len()));
        }
        if let Some(commanded_mm) = commanded_mm
            && !LIKE.contains(&(fit.radius / commanded_mm))
        {
            return Err(RecordedError::Radius {
                commanded_mm,
                found_mm: fit.radius,
            });
        }
        let drift = drift((run, &run.steady_around(&turn)), &fit, points);
        let still = |turn: &Range<usize>| match &drift {
            Some(drift) => drift.removed(&points[turn.clone()], run.angles_of(turn)),
            None => points[turn.clone()].to_vec(),
        };
        let turned = still(&turn);
        if drift.is_some() {
            fit = FittedCircle::of(&turned)?;
        }
        // A turn may be too short a time for the feed (R16.10).
        let steady = run.steady_around(&turn);
        let duration_s = trace.duration_s(steady.start, steady.end - 1);
        let turn_s = duration_s.map(|duration| duration * TAU / run.between(&steady));
        let widest_step_s = trace.widest_step_s(&run.steady_points());
        let commanded = commanded_mm.unwrap_or(fit.radius) / MM_PER_M;
        let about = |centre: [f64; 2]| {
            let mut gatherer = Gatherer::new(commanded, WIDEST_GAP_DEG);
            for [x, y] in &turned {
                gatherer.take((x - centre[0]) / MM_PER_M, (y - centre[1]) / MM_PER_M);
            }
            let gaps = |gap: Gap| RecordedError::Gaps(gap.missing);
            gatherer.finish(turn_s).map_err(gaps)
        };
        // Each angle weighs the same, however many points it has.
        let ([x, y], _) = least_squares(&about(fit.centre)?);
        let centre = [fit.centre[0] + MM_PER_M * x, fit.centre[1] + MM_PER_M * y];
        let profile = about(centre)?;
        let ([x, y], larger) = least_squares(&profile);
        let deviation_mm = zone_about(&[&profile], [x, y]) * MM_PER_M;
        let radius_mm = (commanded + larger) * MM_PER_M;
        if deviation_mm > MOST_MM {
            return Err(RecordedError::NotRound {
                deviation_mm,
                radius_mm,
                centre_mm: centre,
            });
        }
        let turns_m = run.turns().into_iter().map(|turn| centred(still(&turn)));
        Ok(Self {
            direction: run.direction,
            turns_m: turns_m.collect::<Result<_, _>>()?,
            centre_mm: centre,
            radius_mm,
            points: turn.len(),
            turn_s,
            widest_step_s,
            left_out: LeftOut {
                repeated: 0,
                before: run.points.start,
                after: points.len() - run.points.end,
                along_deg: run.covered().to_degrees(),
            },
            profile: profile
                .at(centre.map(|mm| mm / MM_PER_M))
                .with_quality(Quality {
                    drift,
                    ..quality(&turned, centre)
                }),
        })
    }

    fn with_repeats(mut self, repeated: usize) -> Self {
        self.left_out.repeated = repeated;
        self
    }

    /// Sets the feed in mm/min at which the circle was driven.
    pub(super) fn driven_at(mut self, feed: f64) -> Result<Self, RecordedError> {
        if let Some(found) = self.feed_mm_per_min()
            && !LIKE.contains(&(found / feed))
        {
            let commanded = feed;
            return Err(RecordedError::Feed { commanded, found });
        }
        let turn_s = TAU * self.radius_mm / (feed / 60.0);
        self.turn_s = Some(turn_s);
        self.profile = self.profile.in_time(turn_s);
        Ok(self)
    }

    /// Returns the feed in mm/min, if the times are known.
    pub fn feed_mm_per_min(&self) -> Option<f64> {
        Some(TAU * self.radius_mm / self.turn_s? * 60.0)
    }
}

/// Points in mm about their own centre, in m.
fn centred(mut points: Vec<[f64; 2]>) -> Result<Vec<[f64; 2]>, RecordedError> {
    let FittedCircle { centre, .. } = FittedCircle::of(&points)?;
    for point in &mut points {
        *point = [0, 1].map(|at| (point[at] - centre[at]) / MM_PER_M);
    }
    Ok(points)
}

/// Returns the reason why no direction has a full turn.
fn refusal(fit: &FittedCircle, points: &[[f64; 2]], runs: &[PathRun]) -> RecordedError {
    let longest = runs
        .iter()
        .max_by(|one, other| one.covered().total_cmp(&other.covered()));
    if let Some(run) = longest
        && run.is_full()
    {
        return RecordedError::Gaps(run.missing_deg());
    }
    // Points all around, but not on the circle: an ellipse, a square.
    if fit.goes_round(points)
        && let Ok(all) = FittedCircle::of(points)
        && let Some(refusal) = all.not_round(points)
    {
        return refusal;
    }
    RecordedError::NotATurn {
        covered_deg: longest.map_or(0.0, PathRun::covered).to_degrees(),
        radius_mm: fit.radius,
        centre_mm: fit.centre,
    }
}

impl FittedCircle {
    /// Refuses points around the circle that deviate too far from a circle.
    fn not_round(&self, points: &[[f64; 2]]) -> Option<RecordedError> {
        let outside = points.iter().map(|&point| self.outside(point));
        let [inner, outer] = outside.fold([f64::MAX, f64::MIN], |[inner, outer], it| {
            [inner.min(it), outer.max(it)]
        });
        let is_around = inner > -0.5 * self.radius && outer < 0.5 * self.radius;
        (is_around && outer - inner > MOST_MM).then_some(RecordedError::NotRound {
            deviation_mm: outer - inner,
            radius_mm: self.radius,
            centre_mm: self.centre,
        })
    }
}
