//! The result of a recorded measuring program, and the reasons against using it (R16.2, R16.9).

use serde::{Deserialize, Serialize};

use super::actual::{FollowedPosition, averaged_samples};
use super::compared::{AtFeed, ON_FEED};
use super::following::COARSEST_S;
use super::switched::CompensationShown;
use crate::identify::{Fit, Identified, Track, along, count};
use frictcomp::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};
use frictcomp_physics::circle::{
    Crossing, Direction, Figures, MeasuredGlitch, PathFigures, PlaneAxis, RecordedCircle,
    Recording, recorded_height_um,
};
use frictcomp_physics::current::VELOCITY_UNITS_PER_MM_PER_S;

/// Part by which friction of the same program may differ in two recordings, and at the start and the end of one.
const STEADY: f64 = 0.1;

/// Greatest difference between the directions, beyond a constant weight, as a share of the
/// friction.
const EVEN: f64 = 0.2;

/// The ratios of the recorded to the planned speeds scatter by less than this part if only an override
/// differs.
const ONE_RATIO: f64 = 0.05;

/// The greatest additive current as a part of the measured friction.
pub const MOST_CURRENT: f64 = 1.3;

/// A scaling factor with which the outputs have their nominal values.
const UNSCALED: i16 = 1000;

/// The friction of an axis in a recorded program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FrictionFound {
    /// Name of the axis.
    pub axis: String,
    /// Speed in mm/s or °/s, friction and its standard error, slowest first.
    pub speeds: Vec<[f64; 3]>,
    /// Torque that is the same in both directions.
    pub offset: f64,
    /// The recorded speeds as a part of the planned ones.
    pub override_part: Option<f64>,
    /// The curve through them, if one fits.
    pub fit: Option<Fit>,
    /// The points of a value list: µm/s or 0.001°/s, drive units.
    pub table: Vec<[f64; 2]>,
    /// Remarks.
    pub notes: Vec<String>,
    /// Reasons why no list is made of it.
    pub against: Vec<String>,
}

impl FrictionFound {
    /// Judges the friction identified in the recording of a program with these speeds in mm/s or °/s.
    pub fn of(axis: &str, found: &Identified, planned: &[f64]) -> Self {
        let mut notes: Vec<String> = found
            .findings
            .iter()
            .map(|it| format!("{}: {}", it.code, it.message))
            .collect();
        let mut against = Vec::new();
        let override_part = override_of(found, planned);
        match override_part {
            None => against.push("its speeds are not those of the program".to_owned()),
            Some(part) if (part - 1.0).abs() > ON_FEED => {
                against.push(format!(
                    "it was driven at {:.1} % of the planned speeds",
                    part * 100.0
                ));
            }
            Some(_) => {}
        }
        if let Some(drift) = found.drift.filter(|it| it.part.abs() > STEADY) {
            against.push(format!(
                "friction changed by {:+.1} % while it was recorded: repeat it warm",
                drift.part * 100.0
            ));
        }
        against.extend(uneven(found));
        let least = found
            .pairs
            .iter()
            .map(|it| it.friction.abs())
            .fold(f64::INFINITY, f64::min);
        if found.offset.abs() > EVEN * least {
            notes.push(format!(
                "the offset of {:.1} is {:.0} % of the friction: weight, or friction that differs between the \
                 directions, which one list cannot compensate; it is not part of the list",
                found.offset,
                found.offset.abs() / least * 100.0
            ));
        }
        Self {
            axis: axis.to_owned(),
            speeds: found
                .pairs
                .iter()
                .map(|it| [it.speed, it.friction, it.error])
                .collect(),
            offset: found.offset,
            override_part,
            fit: found.fit,
            table: found
                .points
                .iter()
                .map(|it| [it.input, it.output])
                .collect(),
            notes,
            against,
        }
    }

    /// Checks that a recording, from its strokes on, is as long as its program in s, `None` if its strokes are
    /// not in it, and that it has a sample every ms.
    pub fn check_length(&mut self, track: &Track, planned_s: Option<f64>) {
        const WHOLE: f64 = 0.97;
        const FINE_S: f64 = 0.0015;
        const MISSING: f64 = 1.6;
        let steps = track.times_s.windows(2).map(|it| it[1] - it[0]);
        let gaps: Vec<f64> = steps.filter(|it| *it > MISSING * track.step_s).collect();
        if let Some(widest_s) = gaps.iter().copied().reduce(f64::max) {
            self.notes.push(format!(
                "rows are missing in it at {} places, {:.0} ms at most",
                gaps.len(),
                widest_s * 1000.0
            ));
        }
        if track.step_s > FINE_S {
            self.notes.push(format!(
                "a sample every {:.1} ms; every ms was asked for",
                track.step_s * 1000.0
            ));
        }
        let recorded_s = count(track.times_s.len()) * track.step_s;
        let Some((part, planned_s)) = self.override_part.zip(planned_s) else {
            return;
        };
        let planned_s = planned_s / part;
        if recorded_s < WHOLE * planned_s {
            self.against.push(format!(
                "{:.0} s of the program are missing: after the strokes it takes {planned_s:.0} s. The recording ends \
                 early, or has gaps",
                planned_s - recorded_s
            ));
        }
    }

    /// Returns the largest difference in friction between two recordings of one program, as a part of the first; `None`
    /// if they have no common speed.
    pub fn apart_from(&self, other: &Self) -> Option<f64> {
        let pairs = self
            .speeds
            .iter()
            .flat_map(|one| other.speeds.iter().map(move |it| (one, it)));
        let common = pairs.filter(|(one, it)| (one[0] - it[0]).abs() <= ONE_RATIO * one[0]);
        common
            .map(|(one, it)| ((it[1] - one[1]) / one[1]).abs())
            .max_by(f64::total_cmp)
    }

    /// Judges whether one list fits all motors of a gantry, of which this is the mean (R16.8).
    pub fn share(&mut self, motors: &[Self]) {
        let Some((first, others)) = motors.split_first() else {
            return;
        };
        for motor in motors {
            let reasons = motor.against.iter().filter(|it| !self.against.contains(it));
            let named: Vec<String> = reasons.map(|it| format!("{}: {it}", motor.axis)).collect();
            self.against.extend(named);
        }
        for other in others {
            let pair = format!("the motors of {} and {}", first.axis, other.axis);
            match first.apart_from(other) {
                None => self.against.push(format!("{pair} have no speed in common")),
                Some(part) if part > EVEN => self.against.push(format!(
                    "{pair} differ by {:.0} % of the friction: one list fits neither",
                    part * 100.0
                )),
                Some(part) => self.notes.push(format!(
                    "{pair} differ by at most {:.0} % of the friction; both motors get the list of the mean friction",
                    part * 100.0
                )),
            }
        }
    }

    /// Returns the recorded speed in mm/s or °/s at which a list adds most of the friction, and the ratio to the
    /// friction there; `None` without friction.
    pub fn strongest(&self, list: &FrictionList) -> Option<(f64, f64)> {
        let points: Vec<[f64; 2]> = list.table.iter().map(|it| [it.input, it.output]).collect();
        let scale = f64::from(list.scaling_factor) / 1000.0;
        let part = |&[speed, friction, _]: &[f64; 3]| {
            let added = along(&points, speed * VELOCITY_UNITS_PER_MM_PER_S) * scale;
            (speed, (added / friction).abs())
        };
        let parts = self.speeds.iter().map(part);
        parts.max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Returns the value list with the friction at its points and everything else as the control assumes it.
    pub fn list(&self) -> FrictionList {
        let points = self.table.iter();
        let points = points.map(|&[input, output]| TablePoint { input, output });
        FrictionList {
            position_delay: 0,
            reversal_lookahead: 0,
            scaling_factor: UNSCALED,
            delay_cycles: 0,
            max_points: DEFAULT_MAX_POINTS,
            table: points.collect(),
        }
    }

    /// Returns the list with no output above the greatest part of the friction that may be added.
    #[must_use]
    pub fn bounded(&self, list: &FrictionList) -> FrictionList {
        let scale = f64::from(list.scaling_factor) / f64::from(UNSCALED);
        let bounded = list.table.iter().map(|point| {
            let most = MOST_CURRENT * along(&self.table, point.input).abs() / scale;
            TablePoint {
                input: point.input,
                output: point.output.min(most.floor()),
            }
        });
        FrictionList {
            table: bounded.collect(),
            ..list.clone()
        }
    }

    /// Returns whether two recordings of one program show the same friction.
    pub fn is_steady_with(&self, other: &Self) -> bool {
        self.apart_from(other).is_some_and(|part| part <= STEADY)
    }
}

/// Directions that differ beyond a constant offset, at one speed or as a part of the friction at all of them.
fn uneven(found: &Identified) -> Option<String> {
    let beyond = found.pairs.iter().filter_map(|pair| {
        let apart = (pair.offset? - found.offset).abs() / pair.friction.abs();
        Some((pair.speed, apart))
    });
    let beyond = beyond.max_by(|one, other| one.1.total_cmp(&other.1));
    if let Some((speed, part)) = beyond.filter(|it| it.1 > EVEN) {
        return Some(format!(
            "at {speed:.3} /s the directions differ by {:.0} % of the friction beyond a constant offset: one list fits \
             neither",
            part * 100.0
        ));
    }
    let part = growing_offset(found)?.abs();
    (part > EVEN).then(|| {
        format!(
            "the directions differ by {:.0} % of the friction, and by more where there is more friction, so that the \
             weight of the axis is not the cause: one list fits neither",
            part * 100.0
        )
    })
}

/// Returns the part of the friction by which the offset grows with it; `None` if friction differs too little over the
/// speeds, or the offset too much from a line, to determine it.
fn growing_offset(found: &Identified) -> Option<f64> {
    const TIMES: f64 = 3.0;
    /// Variation of friction over the speeds, as a part of its mean, from which the speeds differ.
    const DIFFERS: f64 = 0.25;
    let pairs = found.pairs.iter();
    let points: Vec<[f64; 2]> = pairs
        .filter_map(|it| Some([it.friction, it.offset?]))
        .collect();
    let number = count(points.len());
    let mean = |at: usize| points.iter().map(|it| it[at]).sum::<f64>() / number;
    let means = [mean(0), mean(1)];
    let product = |one: usize, other: usize| {
        let each = points.iter();
        each.map(|it| (it[one] - means[one]) * (it[other] - means[other]))
            .sum::<f64>()
    };
    let [wide, slope] = [product(0, 0), product(0, 1) / product(0, 0)];
    let left = product(1, 1) - slope * product(0, 1);
    let error = (left.max(0.0) / (number - 2.0) / wide).sqrt();
    let differs = (wide / number).sqrt() > DIFFERS / 2.0 * means[0].abs();
    (differs && slope.abs() > TIMES * error).then_some(slope)
}

/// Returns the recorded speeds as a part of the planned ones, the part next to 1 that explains them; `None` if there is
/// none. An axis may miss speeds, as the fastest where its torque is clipped, but has none that was not planned.
fn override_of(found: &Identified, planned: &[f64]) -> Option<f64> {
    let fastest = found.pairs.last()?.speed;
    let explains = |part: &f64| {
        let is_planned = |speed: f64| {
            let mut wanted = planned.iter().map(|it| it * part);
            wanted.any(|it| (it - speed).abs() <= ONE_RATIO * it)
        };
        found.pairs.iter().all(|it| is_planned(it.speed))
    };
    let parts = planned.iter().map(|it| fastest / it).filter(explains);
    let part = parts.min_by(|one, other| one.ln().abs().total_cmp(&other.ln().abs()))?;
    (found.pairs.len() * 2 >= planned.len()).then_some(part)
}

/// The circles of a recorded program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CirclesFound {
    /// The planned feed in mm/min.
    pub feed: f64,
    /// The recorded feed in mm/min; `None` without times.
    pub measured_feed: Option<f64>,
    /// v²/R in mm/s² as recorded, otherwise as planned.
    pub acceleration: f64,
    /// The mean centre of both directions.
    pub centre_mm: [f64; 2],
    /// The glitches of each recorded direction.
    pub glitches: Vec<DirectionGlitches>,
    /// The largest of them, in µm.
    pub worst_um: f64,
    /// Evidence on the compensation, besides the path.
    pub compensation: CompensationShown,
    /// The time in s over which the positions are averages, by the distances from the centre, if they are.
    pub averaged_s: Option<f64>,
    /// Relation of the actual position of each axis to the commanded one, where that was recorded.
    pub followed: Box<[Option<FollowedPosition>; 2]>,
    /// The figures of ISO 230-4.
    pub iso: IsoFigures,
    /// The glitch of each axis in µm for comparison with predictions, without noise, with its standard error.
    pub heights_um: Option<[(f64, f64); 2]>,
    /// Remarks.
    pub notes: Vec<String>,
    /// Reasons why nothing is concluded from it.
    pub against: Vec<String>,
}

impl CirclesFound {
    /// Judges the recording of circles with a planned feed in mm/min and radius in mm.
    pub fn of(recording: &Recording, feed: f64, radius: f64) -> Self {
        let feeds = recording
            .circles
            .iter()
            .filter_map(RecordedCircle::feed_mm_per_min);
        let measured_feed = feeds.reduce(f64::midpoint);
        let speed = measured_feed.unwrap_or(feed) / 60.0;
        let glitches = recording.circles.iter().filter_map(DirectionGlitches::of);
        let glitches: Vec<DirectionGlitches> = glitches.collect();
        let mut notes = Vec::new();
        let mut against = Vec::new();
        let averaged_s = recording.circles.iter().find_map(averaged_over);
        match measured_feed {
            Some(measured) if (measured / feed - 1.0).abs() > ON_FEED => notes.push(format!(
                "driven at {measured:.0} mm/min in place of {feed:.0}: {:.2} mm/s² count",
                speed * speed / radius
            )),
            Some(_) => {}
            None => against.push("it has no times, so its feed is not known".to_owned()),
        }
        if recording.circles.len() < 2 {
            against.push("one direction is missing".to_owned());
        }
        against.extend(begins_otherwise(&recording.circles));
        against.extend(recording.circles.iter().find_map(coarse));
        against.extend(recording.circles.iter().find_map(gap));
        against.extend(too_round(recording));
        against.extend(recording.circles.iter().filter_map(cut_short));
        against.extend(driven_otherwise(&recording.circles));
        notes.extend(recording.circles.iter().find_map(missing_row));
        notes.extend(glitches.iter().filter_map(DirectionGlitches::turns_differ));
        notes.extend(glitches.iter().filter_map(DirectionGlitches::noise));
        if glitches.len() < recording.circles.len() {
            against
                .push("it is too fast and small for a glitch to be told from the next".to_owned());
        }
        let height = |axis| recorded_height_um(axis, &recording.circles);
        let heights = height(PlaneAxis::X).zip(height(PlaneAxis::Y));
        Self {
            compensation: CompensationShown::default(),
            followed: Box::default(),
            averaged_s,
            iso: IsoFigures::of(&recording.side.figures),
            heights_um: heights.map(|(x, y)| [x, y]),
            feed,
            measured_feed,
            acceleration: speed * speed / radius,
            centre_mm: centre_of(&recording.circles),
            worst_um: glitches
                .iter()
                .map(|it| it.largest().1.um)
                .fold(0.0, f64::max),
            glitches,
            notes,
            against,
        }
    }

    /// Returns the glitch at the feed that was driven; `None` if that is not known.
    pub(super) fn at_feed(&self) -> Option<AtFeed> {
        let of = |it: &DirectionGlitches| {
            let mut directions = Direction::ALL.into_iter();
            let direction = directions.find(|one| one.as_str() == it.direction);
            [0, 1].map(|axis| ((axis, direction), it.of_axis(axis)))
        };
        self.measured_feed.map(|driven| AtFeed {
            feed: self.feed,
            driven,
            glitches: self.glitches.iter().flat_map(of).collect(),
        })
    }

    /// Returns the deviation from the planned feed as a part of it; 0 within 2 %, infinite if it is not known.
    pub fn beside(&self) -> f64 {
        self.at_feed().map_or(f64::INFINITY, |it| it.beside())
    }

    /// Returns whether other circles of the same plan were driven at the same feed.
    pub fn is_driven_as(&self, other: &Self) -> bool {
        let feeds = self.at_feed().zip(other.at_feed());
        feeds.is_some_and(|(one, other)| one.is_driven_as(&other))
    }
}

/// The glitches of a direction of travel over all turns (R16.10).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct DirectionGlitches {
    /// The direction of travel.
    pub direction: String,
    /// The glitches at X+, Y+, X-, Y- of the axes of the plan.
    pub crossings: [MeasuredGlitch; 4],
}

impl DirectionGlitches {
    fn of(circle: &RecordedCircle) -> Option<Self> {
        Some(Self {
            direction: circle.direction.as_str().to_owned(),
            crossings: circle.glitches()?,
        })
    }

    /// Returns the larger glitch of an axis, by its place in the plan, at its two crossings.
    pub fn of_axis(&self, axis: usize) -> MeasuredGlitch {
        self.crossings[axis % 2].larger(self.crossings[axis % 2 + 2])
    }

    /// Returns the largest glitch, with its crossing.
    fn largest(&self) -> (Crossing, MeasuredGlitch) {
        let each = Crossing::ALL.into_iter().zip(self.crossings);
        let largest = each.max_by(|one, other| one.1.um.total_cmp(&other.1.um));
        largest.unwrap_or((Crossing::XPlus, self.crossings[0]))
    }

    /// States by how much turns of one circle differ, if they differ by more than their errors (R16.11).
    fn turns_differ(&self) -> Option<String> {
        let each = Crossing::ALL.into_iter().zip(self.crossings);
        let most = each.max_by(|one, other| one.1.spread_um.total_cmp(&other.1.spread_um));
        let (crossing, it) = most.filter(|it| it.1.spread_um > 0.0)?;
        Some(format!(
            "turns {} differ by {:.1} µm at {crossing}: the largest of {}, {:.1} µm, counts; their median is {:.1} µm",
            self.direction, it.spread_um, it.turns, it.um, it.median_um
        ))
    }

    /// States how much of the largest glitch was noise, if it was much.
    fn noise(&self) -> Option<String> {
        const MUCH: f64 = 0.1;
        let (crossing, it) = self.largest();
        (it.noise_um > MUCH * it.um).then(|| {
            format!(
                "at {crossing} {} {:.1} µm of noise are taken off the glitch: {:.1} µm are left, ± {:.1} µm",
                self.direction, it.noise_um, it.um, it.error_um
            )
        })
    }
}

/// Figures of ISO 230-4 in µm, if a recording has them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct IsoFigures {
    /// Circular deviation G of the counter-clockwise path about the centre of the minimum zone.
    pub g_ccw: Option<f64>,
    /// Figure of the clockwise path.
    pub g_cw: Option<f64>,
    /// Bidirectional circular deviation G(b).
    pub g_b: Option<f64>,
    /// Circular hysteresis H.
    pub h: Option<f64>,
}

impl IsoFigures {
    fn of(figures: &Figures) -> Self {
        let deviation = |path: &Option<PathFigures>| path.as_ref().map(|it| it.g_mz_um);
        Self {
            g_ccw: deviation(&figures.ccw),
            g_cw: deviation(&figures.cw),
            g_b: figures.g_b_um,
            h: figures.h_um,
        }
    }
}

/// Returns a recording whose circles run in the opposite direction to those of the programs.
fn begins_otherwise(circles: &[RecordedCircle]) -> Option<String> {
    let begin = |direction: Direction| {
        let mut circles = circles.iter();
        let circle = circles.find(|it| it.direction == direction);
        circle.map(|it| it.left_out.before)
    };
    let is_otherwise = begin(Direction::Cw)? < begin(Direction::Ccw)?;
    is_otherwise.then(|| {
        "it begins clockwise and its program counter-clockwise: the columns of two axes are exchanged, or an axis \
         counts the other way"
            .to_owned()
    })
}

/// Returns the time in s over which each position is an average, if its noise shows one (R16.14).
fn averaged_over(circle: &RecordedCircle) -> Option<f64> {
    let step_s = circle.turn_s? / count(circle.points);
    averaged_samples(&circle.radii_mm()).map(|it| count(it) * step_s)
}

/// Points that are too far apart in time to show a reversal.
pub(super) fn coarse(circle: &RecordedCircle) -> Option<String> {
    let step_s = circle.turn_s? / count(circle.points);
    (step_s > COARSEST_S).then(|| {
        format!(
            "a sample every {:.1} ms does not show what a reversal does; record every ms",
            step_s * 1000.0
        )
    })
}

/// Samples that are missing in a turn: a reversal may be among them.
fn gap(circle: &RecordedCircle) -> Option<String> {
    const STEPS: f64 = 5.0;
    let step_s = circle.turn_s? / count(circle.points);
    let widest_s = circle.widest_step_s.filter(|it| *it > STEPS * step_s)?;
    Some(format!(
        "{:.0} ms without a sample in a turn {}: what a reversal does may be missing",
        widest_s * 1000.0,
        circle.direction
    ))
}

/// Returns a sample that is missing in a turn, too few for a reversal to be among them (R16.18).
fn missing_row(circle: &RecordedCircle) -> Option<String> {
    const STEPS: f64 = 1.6;
    let step_s = circle.turn_s? / count(circle.points);
    let widest_s = circle.widest_step_s.filter(|it| *it > STEPS * step_s)?;
    Some(format!(
        "rows are missing in it: {:.1} ms without a sample in a turn {}",
        widest_s * 1000.0,
        circle.direction
    ))
}

/// Paths that deviate less from a circle than those of any machine.
fn too_round(recording: &Recording) -> Option<String> {
    const LEAST_UM: f64 = 0.3;
    let figures = [&recording.side.figures.ccw, &recording.side.figures.cw];
    let rounds = figures.into_iter().flatten().map(|it| it.g_mz_um);
    let least_um = rounds.min_by(f64::total_cmp)?;
    (least_um < LEAST_UM).then(|| {
        format!(
            "it deviates from a circle by {least_um:.1} µm: its positions are commanded ones, not actual ones"
        )
    })
}

/// Directions at different feeds, which have no common v²/R.
fn driven_otherwise(circles: &[RecordedCircle]) -> Option<String> {
    let feeds = circles.iter().filter_map(RecordedCircle::feed_mm_per_min);
    let (slowest, fastest) = feeds.fold((f64::INFINITY, 0.0_f64), |(low, high), it| {
        (low.min(it), high.max(it))
    });
    (fastest > slowest * (1.0 + ON_FEED)).then(|| {
        format!(
            "one direction was driven at {slowest:.0} mm/min and the other at {fastest:.0}: the override was turned"
        )
    })
}

/// Returns a direction with less recorded than its program drives: three turns with the halves before and after.
fn cut_short(circle: &RecordedCircle) -> Option<String> {
    const DRIVEN: f64 = 3.0;
    const NEARLY: f64 = 0.9;
    let turns = circle.left_out.along_deg / 360.0;
    (turns < NEARLY * DRIVEN).then(|| {
        format!(
            "{turns:.1} of {DRIVEN:.0} turns {} are in it: it begins late or ends early",
            circle.direction
        )
    })
}

fn centre_of(circles: &[RecordedCircle]) -> [f64; 2] {
    let mean = |at: usize| {
        let places = circles.iter().map(|it| it.centre_mm[at]);
        places.sum::<f64>() / count(circles.len().max(1))
    };
    [mean(0), mean(1)]
}
