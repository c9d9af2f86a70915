//! The motions of measuring programs.

use std::f64::consts::TAU;

use super::error::PlanError;
use super::program::{Measurement, MeasuringProgram, PlanStep, Turning};
use super::request::MeasuredAxis;
use super::signature::Signature;

/// Standstill between two motions in s.
const PAUSE_S: f64 = 0.2;

/// The radius that is used if it fits, in mm.
const RADIUS: f64 = 100.0;

/// The programs of axes in their rooms.
pub(super) struct RoomPrograms<'a> {
    pub(super) rooms: &'a [Room<'a>],
    /// The radius of the circles; `None` for one axis alone.
    pub(super) radius: Option<f64>,
}

impl RoomPrograms<'_> {
    /// Creates a program of constant speeds up and then down, each back and forth.
    pub(super) fn friction(
        &self,
        axis: usize,
        speeds: Vec<f64>,
    ) -> Result<MeasuringProgram, PlanError> {
        let room = &self.rooms[axis];
        let mut made = AxisMotions::at(room.low);
        let up = speeds.iter().copied();
        for speed in up.chain(speeds.iter().rev().copied()) {
            let way = room.way_at(speed)?;
            made.steps
                .push(PlanStep::Note(format!("{speed:.3} {}/s", room.axis.unit())));
            for to in [room.low + way, room.low] {
                made.line(axis, to, speed * 60.0, room);
            }
        }
        let mut start: Vec<f64> = self.rooms.iter().map(Room::middle).collect();
        start[axis] = room.low;
        let file = format!("friction-{}.nc", room.axis.name);
        Ok(made.program(file, Measurement::Friction { axis, speeds }, start))
    }

    /// Strokes at each feed, without a pause at their ends.
    pub(super) fn strokes(
        &self,
        axis: usize,
        feeds: &[f64],
    ) -> Result<MeasuringProgram, PlanError> {
        const STROKES: usize = 4;
        let room = &self.rooms[axis];
        let mut made = AxisMotions::at(room.low);
        for &feed in feeds {
            let way = room.way_at(feed / 60.0)?;
            made.steps
                .push(PlanStep::Note(format!("{feed} {}/min", room.axis.unit())));
            for _ in 0..STROKES {
                for to in [room.low + way, room.low] {
                    made.move_to(axis, to, feed, room);
                }
            }
            made.dwell(1.0);
        }
        let file = format!("strokes-{}.nc", room.axis.name);
        let feeds = feeds.to_vec();
        Ok(made.program(file, Measurement::Strokes { axis, feeds }, vec![room.low]))
    }

    /// Returns half a turn to speed up, two turns, half a turn to slow down, in each direction.
    pub(super) fn circles(&self, feed: f64) -> MeasuringProgram {
        const REST_S: f64 = 1.0;
        let radius = self.radius.unwrap_or(RADIUS);
        let centre: Vec<f64> = self.rooms.iter().map(Room::middle).collect();
        let [x, y] = [0, 1].map(|at| centre.get(at).copied().unwrap_or_default());
        let mut made = AxisMotions::at(x + radius);
        let (right, left) = ([x + radius, y], [x - radius, y]);
        for turning in [Turning::Ccw, Turning::Cw] {
            made.steps.push(PlanStep::Note(turning.words().to_owned()));
            for (to, from_right, turns) in [
                (left, true, 0.5),
                (left, false, 1.0),
                (left, false, 1.0),
                (right, false, 0.5),
            ] {
                let centre = [if from_right { -radius } else { radius }, 0.0];
                made.steps.push(PlanStep::Arc {
                    turning,
                    to,
                    centre,
                    feed,
                });
                made.time_s += turns * TAU * radius / (feed / 60.0);
            }
            made.dwell(REST_S);
        }
        let file = format!("circle-{feed}.nc");
        made.program(
            file,
            Measurement::Circles { feed, radius },
            vec![x + radius, y],
        )
    }
}

impl Turning {
    fn words(self) -> &'static str {
        match self {
            Self::Ccw => "counter-clockwise",
            Self::Cw => "clockwise",
        }
    }
}

/// Motions of one axis, one after another.
struct AxisMotions {
    steps: Vec<PlanStep>,
    place: f64,
    time_s: f64,
}

impl AxisMotions {
    fn at(place: f64) -> Self {
        Self {
            steps: Vec::new(),
            place,
            time_s: 0.0,
        }
    }

    /// Adds a motion and the pause after it.
    fn line(&mut self, axis: usize, to: f64, feed: f64, room: &Room<'_>) {
        self.move_to(axis, to, feed, room);
        self.dwell(PAUSE_S);
    }

    fn move_to(&mut self, axis: usize, to: f64, feed: f64, room: &Room<'_>) {
        let speed = feed / 60.0;
        self.time_s += (to - self.place).abs() / speed + room.axis.dynamics.time_to(speed);
        self.place = to;
        self.steps.push(PlanStep::Line { axis, to, feed });
    }

    fn dwell(&mut self, seconds: f64) {
        self.time_s += seconds;
        self.steps.push(PlanStep::Dwell(seconds));
    }

    fn program(self, file: String, role: Measurement, start: Vec<f64>) -> MeasuringProgram {
        MeasuringProgram {
            number: 0,
            file,
            role,
            time_s: self.time_s,
            steps: self.steps,
            start,
        }
    }
}

impl MeasuringProgram {
    /// Returns the axis of its signature.
    pub fn signed_axis(&self) -> usize {
        match self.role {
            Measurement::Friction { axis, .. } | Measurement::Strokes { axis, .. } => axis,
            Measurement::Circles { .. } => 0,
        }
    }

    /// Returns the feed of its circles in mm/min.
    pub fn feed(&self) -> Option<f64> {
        match self.role {
            Measurement::Circles { feed, .. } => Some(feed),
            Measurement::Friction { .. } | Measurement::Strokes { .. } => None,
        }
    }

    /// Returns its time in s at 100 % override after the strokes of its signature.
    pub fn time_after_signature_s(&self) -> f64 {
        let strokes = Signature::new(self.number).map(Signature::strokes);
        let ways = strokes.into_iter().flatten();
        let strokes_s: f64 = ways.map(|way| 2.0 * stroke_s(way)).sum();
        self.time_s - Signature::DWELL_S - strokes_s
    }

    /// Returns the feeds at which it shows reversals, in mm/min or °/min.
    pub fn reversal_feeds(&self) -> &[f64] {
        match &self.role {
            Measurement::Circles { feed, .. } => std::slice::from_ref(feed),
            Measurement::Strokes { feeds, .. } => feeds,
            Measurement::Friction { .. } => &[],
        }
    }

    /// Prepends the signature of a number, and puts the number into the file name.
    pub(super) fn begin_with(&mut self, number: u16) {
        let Some(signature) = Signature::new(number) else {
            return;
        };
        let axis = self.signed_axis();
        let place = self.start.get(axis).copied().unwrap_or_default();
        // Circles begin at the upper end of their travel, runs at the lower one.
        let inwards = if matches!(self.role, Measurement::Circles { .. }) {
            -1.0
        } else {
            1.0
        };
        let mut steps = vec![
            PlanStep::Note(format!("signature {number}")),
            PlanStep::Dwell(Signature::DWELL_S),
        ];
        for way in signature.strokes() {
            for to in [place + inwards * way, place] {
                steps.push(PlanStep::Line {
                    axis,
                    to,
                    feed: Signature::FEED,
                });
                steps.push(PlanStep::Dwell(PAUSE_S));
                self.time_s += stroke_s(way);
            }
        }
        steps.push(PlanStep::Dwell(Signature::DWELL_S));
        self.time_s += 2.0 * Signature::DWELL_S;
        steps.append(&mut self.steps);
        self.steps = steps;
        self.number = number;
        self.file = format!("{number:02}-{}", self.file);
    }
}

/// Returns the time of a stroke of a signature, with the pause after it.
fn stroke_s(way: f64) -> f64 {
    way / (Signature::FEED / 60.0) + PAUSE_S
}

/// Returns the radius of the circles, at which each axis can follow each feed.
pub(super) fn circle_radius(
    rooms: [&Room<'_>; 2],
    feeds: &[f64],
    wanted: Option<f64>,
) -> Result<f64, PlanError> {
    let [first, second] = rooms;
    let tight = if first.extent() <= second.extent() {
        first
    } else {
        second
    };
    let largest = tight.extent() / 2.0;
    let radius = wanted.unwrap_or(RADIUS.min(largest.floor()));
    if !(radius > Signature::REACH && radius <= largest) {
        return Err(PlanError::Radius {
            radius,
            axis: tight.axis.name.clone(),
            needed: 2.0 * radius,
            room: tight.extent(),
        });
    }
    for room in rooms {
        for &feed in feeds {
            let speed = feed / 60.0;
            let dynamics = room.axis.dynamics;
            let pairs = [
                (
                    "mm/s²",
                    SPARE * speed * speed / radius,
                    dynamics.acceleration_per_s2,
                ),
                (
                    "mm/s³",
                    SPARE * speed.powi(3) / radius.powi(2),
                    dynamics.jerk_per_s3,
                ),
            ];
            let beyond = pairs.into_iter().find(|(_, needed, limit)| needed > limit);
            if let Some((quantity, needed, limit)) = beyond {
                return Err(PlanError::TooTight {
                    feed,
                    radius,
                    axis: room.axis.name.clone(),
                    quantity,
                    needed,
                    limit,
                });
            }
        }
    }
    Ok(radius)
}

/// The part of the travel at each end that stays free.
const FREE_END: f64 = 0.05;

/// The factor by which the travel to accelerate is longer than computed.
pub(super) const SPARE: f64 = 1.1;

/// Desired seconds at constant speed.
const STEADY_S: f64 = 2.0;

/// Minimum seconds at constant speed.
const LEAST_STEADY_S: f64 = 0.5;

/// The inner part of the travel of an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room<'a> {
    pub(super) axis: &'a MeasuredAxis,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl<'a> Room<'a> {
    pub(super) fn of(axis: &'a MeasuredAxis) -> Result<Self, PlanError> {
        let travel = axis.travel;
        let extent = travel.high - travel.low;
        if !(extent.is_finite() && extent > 0.0) {
            return Err(PlanError::FreeTravel(axis.name.clone()));
        }
        Ok(Self {
            axis,
            low: travel.low + FREE_END * extent,
            high: travel.high - FREE_END * extent,
        })
    }

    pub(super) fn extent(&self) -> f64 {
        self.high - self.low
    }

    pub(super) fn middle(&self) -> f64 {
        f64::midpoint(self.low, self.high)
    }

    /// Refuses a feed that the axis does not reach.
    pub(super) fn reaches(&self, feed: f64) -> Result<(), PlanError> {
        let limit = self.axis.dynamics.velocity_per_s * 60.0;
        if feed <= limit {
            return Ok(());
        }
        Err(PlanError::TooFast {
            axis: self.axis.name.clone(),
            feed,
            limit,
            unit: self.axis.unit(),
        })
    }

    /// Returns the travel of a run at a speed, with its ramps: two seconds, or a pitch if that is longer; less if the
    /// travel of the axis ends.
    ///
    /// # Errors
    /// Half a second at that speed does not fit.
    pub(super) fn way_at(&self, speed: f64) -> Result<f64, PlanError> {
        let ramp = SPARE * self.axis.dynamics.way_to(speed);
        let least = speed * LEAST_STEADY_S + 2.0 * ramp;
        if least > self.extent() {
            return Err(PlanError::NoRoom {
                axis: self.axis.name.clone(),
                feed: speed * 60.0,
                needed: least,
                ramp,
                steady: speed * LEAST_STEADY_S,
                room: self.extent(),
                unit: self.axis.unit(),
            });
        }
        let steady = (speed * STEADY_S).max(self.axis.pitch.unwrap_or(0.0));
        Ok((steady + 2.0 * ramp).min(self.extent()))
    }
}
