//! One turn of an actual path as radial deviations over the angle.
//!
//! The path is kept in two forms, both of bounded size. At [`ANGLES`] fixed angles it holds the
//! deviation of a straight line between the two neighbouring points: nothing is averaged or
//! filtered. And of the points in each sector between two such angles the outermost
//! and the innermost are kept as they are, so that no extreme of the path is lost.

use std::f64::consts::TAU;
use std::fmt;
use std::ops::RangeInclusive;

use super::crossing::Crossing;
use super::direction::Direction;
use super::drift::CircleDrift;

/// Micrometres in a metre.
pub const UM_PER_M: f64 = 1e6;

/// Fixed angles of a turn, every 0.01°.
pub const ANGLES: usize = 36_000;

/// Fixed angles per degree.
pub(crate) const PER_DEGREE: i32 = 100;

const _: () = assert!(
    ANGLES == 360 * PER_DEGREE.unsigned_abs() as usize,
    "every 0.01°"
);

/// A point of the path: its direction, and its radial deviation in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ProfilePoint {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    pub(crate) deviation: f64,
}

/// Bridges every gap, in degrees.
const WHOLE_TURN: f64 = 360.0;

/// Gathers the points of one turn.
#[derive(Debug, Clone)]
pub(crate) struct Gatherer {
    radius: f64,
    fixed: Vec<f64>,
    outer: Vec<Option<ProfilePoint>>,
    inner: Vec<Option<ProfilePoint>>,
    last: Option<SectorPlace>,
    /// Maximum number of sectors between two points that are bridged.
    widest: f64,
}

/// A place on the path: the angle in sectors, and the sector.
#[derive(Debug, Clone, Copy)]
struct SectorPlace {
    angle: f64,
    sector: usize,
    deviation: f64,
}

/// Noise and resolution of recorded samples, in µm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Quality {
    /// Standard deviation of the noise of single samples.
    pub(crate) noise_um: f64,
    /// Smallest step of the positions.
    pub(crate) step_um: f64,
    /// Samples of a turn.
    pub(crate) samples: usize,
    /// The shift from turn to turn, if there are several turns.
    pub(crate) drift: Option<CircleDrift>,
}

/// The radial deviations of one turn.
#[derive(Clone)]
pub struct RadialProfile {
    radius: f64,
    fixed: Vec<f64>,
    outer: Vec<Option<ProfilePoint>>,
    inner: Vec<Option<ProfilePoint>>,
    /// Duration of the turn in s, if it is known.
    turn_s: Option<f64>,
    /// Centre of the angles and deviations, in m.
    origin: [f64; 2],
    /// Quality of recorded points.
    quality: Option<Quality>,
}

/// A path that does not close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gap {
    /// Degrees of the turn without a point.
    pub(crate) missing: f64,
}

impl Gatherer {
    /// Creates the profile of a path around the origin, with deviations against `radius` in m. A gap of more than
    /// `widest` degrees between two points is not bridged.
    pub(crate) fn new(radius: f64, widest: f64) -> Self {
        Self {
            radius,
            widest: widest * f64::from(PER_DEGREE),
            fixed: vec![f64::NAN; ANGLES],
            outer: vec![None; ANGLES],
            inner: vec![None; ANGLES],
            last: None,
        }
    }

    /// Takes the next point of the path in m.
    #[inline]
    pub(crate) fn take(&mut self, x: f64, y: f64) {
        let place = self.keep(x, y);
        if let Some(last) = self.last
            && last.sector != place.sector
        {
            self.fill(last, place);
        }
        self.last = Some(place);
    }

    /// Keeps a point in m if it is the outermost or the innermost of its sector, and returns its
    /// place.
    #[inline]
    fn keep(&mut self, x: f64, y: f64) -> SectorPlace {
        let distance = (x * x + y * y).sqrt();
        let deviation = distance - self.radius;
        let angle = y.atan2(x);
        let positive = if angle < 0.0 { angle + TAU } else { angle };
        #[allow(clippy::cast_precision_loss)] // 36000
        let angle = positive * (ANGLES as f64 / TAU);
        let sector = index(angle);
        let point = || ProfilePoint {
            cos: x / distance,
            sin: y / distance,
            deviation,
        };
        let outer = &mut self.outer[sector];
        if outer.is_none_or(|outer| deviation > outer.deviation) {
            *outer = Some(point());
        }
        let inner = &mut self.inner[sector];
        if inner.is_none_or(|inner| deviation < inner.deviation) {
            *inner = Some(point());
        }
        SectorPlace {
            angle,
            sector,
            deviation,
        }
    }

    /// Interpolates at the fixed angles between two points of different sectors, the short way
    /// round.
    #[inline]
    fn fill(&mut self, from: SectorPlace, to: SectorPlace) {
        #[allow(clippy::cast_precision_loss)] // 36000
        let turn = ANGLES as f64;
        let mut way = to.angle - from.angle;
        if way > turn / 2.0 {
            way -= turn;
        } else if way < -turn / 2.0 {
            way += turn;
        }
        if way == 0.0 || way.abs() > self.widest {
            return;
        }
        let (low, high) = if way < 0.0 {
            (from.angle + way, from.angle)
        } else {
            (from.angle, from.angle + way)
        };
        let mut at = low.ceil();
        while at <= high {
            let part = (at - from.angle) / way;
            let deviation = from.deviation + part * (to.deviation - from.deviation);
            self.fixed[index(at.rem_euclid(turn))] = deviation;
            at += 1.0;
        }
    }

    /// Returns the turn, if it has no gap; small ones, where its ends meet, are bridged. `turn_s` is its
    /// duration in seconds.
    pub(crate) fn finish(mut self, turn_s: Option<f64>) -> Result<RadialProfile, Gap> {
        let missing = |from: usize| {
            let rest = (1..=ANGLES).map(|step| (from + step) % ANGLES);
            rest.take_while(|&at| self.fixed[at].is_nan()).count()
        };
        let Some(start) = self.fixed.iter().position(|it| !it.is_nan()) else {
            return Err(Gap { missing: 360.0 });
        };
        let mut gaps = Vec::new();
        let mut at = start;
        while at < start + ANGLES {
            let length = missing(at % ANGLES);
            if length > 0 {
                gaps.push((at % ANGLES, length));
            }
            at += length + 1;
        }
        #[allow(clippy::cast_precision_loss)] // at most 36000
        let degrees = |angles: usize| angles as f64 / f64::from(PER_DEGREE);
        let longest = gaps.iter().map(|gap| gap.1).max().unwrap_or_default();
        #[allow(clippy::cast_precision_loss)] // at most 36000
        if longest as f64 > self.widest {
            let missing = degrees(gaps.iter().map(|gap| gap.1).sum());
            return Err(Gap { missing });
        }
        for (from, length) in gaps {
            let (first, last) = (self.fixed[from], self.fixed[(from + length + 1) % ANGLES]);
            for step in 1..=length {
                #[allow(clippy::cast_precision_loss)] // at most 36000
                let part = step as f64 / (length + 1) as f64;
                self.fixed[(from + step) % ANGLES] = first + part * (last - first);
            }
        }
        Ok(RadialProfile {
            radius: self.radius,
            fixed: self.fixed,
            outer: self.outer,
            inner: self.inner,
            turn_s,
            origin: [0.0; 2],
            quality: None,
        })
    }
}

/// Returns the number of the fixed angle that is a number of fixed angles after a crossing.
fn sector(crossing: Crossing, direction: Direction, way: i32) -> usize {
    let turn = 360 * PER_DEGREE;
    let way = match direction {
        Direction::Ccw => way,
        Direction::Cw => -way,
    };
    let at = i32::from(crossing.angle_deg()) * PER_DEGREE + way;
    usize::try_from(at.rem_euclid(turn)).expect("it is not negative")
}

/// Returns the sector of an angle in sectors.
fn index(angle: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 36000
    let index = angle as usize;
    index.min(ANGLES - 1)
}

impl fmt::Debug for RadialProfile {
    /// Formats the radius only; 36 000 deviations are of no use.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RadialProfile")
            .field("radius", &self.radius)
            .finish_non_exhaustive()
    }
}

impl RadialProfile {
    /// Returns the radius from which the deviations are counted.
    pub fn radius_m(&self) -> f64 {
        self.radius
    }

    /// Returns the deviation at each of the [`ANGLES`] fixed angles, from X+ counter-clockwise; positive is outwards.
    pub fn deviations_m(&self) -> &[f64] {
        &self.fixed
    }

    /// Returns the outermost point of each sector that has one.
    pub(crate) fn outer(&self) -> impl Iterator<Item = &ProfilePoint> {
        self.outer.iter().flatten()
    }

    /// Returns the innermost point of each sector that has one.
    pub(crate) fn inner(&self) -> impl Iterator<Item = &ProfilePoint> {
        self.inner.iter().flatten()
    }

    /// Sets the duration of a turn in seconds.
    pub(crate) fn in_time(self, turn_s: f64) -> Self {
        Self {
            turn_s: Some(turn_s),
            ..self
        }
    }

    /// Sets the centre of the path, in m.
    pub(crate) fn at(self, origin: [f64; 2]) -> Self {
        Self { origin, ..self }
    }

    /// Sets the quality of the recorded points.
    pub(crate) fn with_quality(self, quality: Quality) -> Self {
        Self {
            quality: Some(quality),
            ..self
        }
    }

    /// Returns the quality of recorded points.
    pub(crate) fn quality(&self) -> Option<Quality> {
        self.quality
    }

    /// Returns the centre of the angles and deviations, in m.
    pub(crate) fn origin(&self) -> [f64; 2] {
        self.origin
    }

    /// Returns the duration of the turn in s, if it is known.
    pub(crate) fn turn_s(&self) -> Option<f64> {
        self.turn_s
    }

    /// Returns the path at the fixed angles around a crossing, each with its number from there in the direction of
    /// travel.
    pub(crate) fn fixed(
        &self,
        crossing: Crossing,
        direction: Direction,
        ways: RangeInclusive<i32>,
    ) -> impl Iterator<Item = (f64, ProfilePoint)> {
        ways.map(move |way| {
            let at = sector(crossing, direction, way);
            (f64::from(way), self.at_fixed(at))
        })
    }

    /// Returns the path around a crossing with the outermost and the innermost point between each two fixed angles.
    pub(crate) fn every(
        &self,
        crossing: Crossing,
        direction: Direction,
        ways: RangeInclusive<i32>,
    ) -> impl Iterator<Item = (f64, ProfilePoint)> {
        let last = *ways.end();
        ways.flat_map(move |way| {
            let at = sector(crossing, direction, way);
            let between = match direction {
                Direction::Ccw => at,
                Direction::Cw => (at + ANGLES - 1) % ANGLES,
            };
            let between = if way < last {
                [self.outer[between], self.inner[between]]
            } else {
                [None, None]
            };
            let points = [Some(self.at_fixed(at)), between[0], between[1]];
            points
                .into_iter()
                .flatten()
                .map(move |point| (f64::from(way), point))
        })
    }

    /// Returns the path at the fixed angle with a number.
    fn at_fixed(&self, number: usize) -> ProfilePoint {
        #[allow(clippy::cast_precision_loss)] // 36000
        let (sin, cos) = (number as f64 / ANGLES as f64 * TAU).sin_cos();
        ProfilePoint {
            cos,
            sin,
            deviation: self.fixed[number],
        }
    }

    /// Returns the path as seen from another centre, in m.
    pub(crate) fn about(&self, centre: [f64; 2]) -> Self {
        let [x, y] = [0, 1].map(|axis| centre[axis] - self.origin[axis]);
        let mut seen = Gatherer::new(self.radius, WHOLE_TURN);
        let place = |point: ProfilePoint| {
            let distance = self.radius + point.deviation;
            (distance * point.cos - x, distance * point.sin - y)
        };
        for number in (0..ANGLES).chain([0]) {
            let (x, y) = place(self.at_fixed(number));
            seen.take(x, y);
        }
        for &point in self.outer().chain(self.inner()) {
            let (x, y) = place(point);
            seen.keep(x, y);
        }
        let seen = seen.finish(self.turn_s);
        seen.map_or_else(|_| self.clone(), |seen| seen.at(centre))
    }

    /// Returns the angle in radians and the deviation in m at `count` angles evenly over the turn, each with the
    /// largest deviation from zero of its part of the turn kept: for pictures.
    pub fn outline(&self, count: usize) -> Vec<(f64, f64)> {
        let count = count.clamp(1, ANGLES);
        let part = ANGLES.div_ceil(count);
        let parts = self.fixed.chunks(part).enumerate();
        let strongest = parts.filter_map(|(number, chunk)| {
            let (offset, deviation) = chunk
                .iter()
                .enumerate()
                .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
            #[allow(clippy::cast_precision_loss)] // at most 36000
            let angle = (number * part + offset) as f64 / ANGLES as f64 * TAU;
            Some((angle, *deviation))
        });
        strongest.collect()
    }
}
