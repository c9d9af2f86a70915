//! One turn of an actual path as radial deviations over the angle.
//!
//! The path is kept in two forms, both of bounded size. At [`ANGLES`] fixed angles it holds the
//! deviation of a straight line between the two neighbouring points: nothing is averaged or
//! filtered. And of the points in each sector between two such angles the outermost
//! and the innermost are kept as they are, so that no extreme of the path is lost.

use std::f64::consts::TAU;
use std::fmt;

/// Micrometres in a metre.
pub const UM_PER_M: f64 = 1e6;

/// Fixed angles of a turn, every 0.01°.
pub const ANGLES: usize = 36_000;

/// Fixed angles in a degree.
pub(super) const PER_DEGREE: usize = ANGLES / 360;

/// A point of the path: the direction in which it lies, and its radial deviation in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub(super) cos: f64,
    pub(super) sin: f64,
    pub(super) deviation: f64,
}

/// Gathers the points of one turn.
#[derive(Debug, Clone)]
pub(super) struct Gatherer {
    radius: f64,
    at: Vec<f64>,
    outer: Vec<Option<Point>>,
    inner: Vec<Option<Point>>,
    last: Option<Place>,
    /// Sectors between two points that are bridged at most.
    widest: f64,
}

/// A place on the path: the angle in sectors, and the sector.
#[derive(Debug, Clone, Copy)]
struct Place {
    angle: f64,
    sector: usize,
    deviation: f64,
}

/// The radial deviations of one turn.
#[derive(Clone)]
pub struct RadialProfile {
    radius: f64,
    at: Vec<f64>,
    outer: Vec<Option<Point>>,
    inner: Vec<Option<Point>>,
}

/// A path that does not close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gap {
    /// Degrees of the turn without a point.
    pub(super) missing: f64,
}

impl Gatherer {
    /// For a path around the origin, deviations against `radius` in m. A gap of more than `widest`
    /// degrees between two points is not bridged.
    pub(super) fn new(radius: f64, widest: f64) -> Self {
        #[allow(clippy::cast_precision_loss)] // 100
        let widest = widest * PER_DEGREE as f64;
        Self {
            radius,
            widest,
            at: vec![f64::NAN; ANGLES],
            outer: vec![None; ANGLES],
            inner: vec![None; ANGLES],
            last: None,
        }
    }

    /// Takes the next point of the path in m.
    #[inline]
    pub(super) fn take(&mut self, x: f64, y: f64) {
        let distance = (x * x + y * y).sqrt();
        let deviation = distance - self.radius;
        let angle = y.atan2(x);
        let positive = if angle < 0.0 { angle + TAU } else { angle };
        #[allow(clippy::cast_precision_loss)] // 36000
        let angle = positive * (ANGLES as f64 / TAU);
        let sector = index(angle);
        let place = Place {
            angle,
            sector,
            deviation,
        };
        if let Some(last) = self.last
            && last.sector != sector
        {
            self.fill(last, place);
        }
        self.last = Some(place);
        let point = || Point {
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
    }

    /// Interpolates at the fixed angles between two points of different sectors, the short way
    /// round.
    #[inline]
    fn fill(&mut self, from: Place, to: Place) {
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
            self.at[index(at.rem_euclid(turn))] = deviation;
            at += 1.0;
        }
    }

    /// The turn, if it has no gap; small ones, where its ends meet, are bridged.
    pub(super) fn finish(mut self) -> Result<RadialProfile, Gap> {
        let missing = |from: usize| {
            let rest = (1..=ANGLES).map(|step| (from + step) % ANGLES);
            rest.take_while(|&at| self.at[at].is_nan()).count()
        };
        let Some(start) = self.at.iter().position(|it| !it.is_nan()) else {
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
        let degrees = |angles: usize| angles as f64 / PER_DEGREE as f64;
        let longest = gaps.iter().map(|gap| gap.1).max().unwrap_or_default();
        #[allow(clippy::cast_precision_loss)] // at most 36000
        if longest as f64 > self.widest {
            let missing = degrees(gaps.iter().map(|gap| gap.1).sum());
            return Err(Gap { missing });
        }
        for (from, length) in gaps {
            let (first, last) = (self.at[from], self.at[(from + length + 1) % ANGLES]);
            for step in 1..=length {
                #[allow(clippy::cast_precision_loss)] // at most 36000
                let part = step as f64 / (length + 1) as f64;
                self.at[(from + step) % ANGLES] = first + part * (last - first);
            }
        }
        Ok(RadialProfile {
            radius: self.radius,
            at: self.at,
            outer: self.outer,
            inner: self.inner,
        })
    }
}

/// The sector of an angle in sectors.
fn index(angle: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 36000
    let index = angle as usize;
    index.min(ANGLES - 1)
}

impl fmt::Debug for RadialProfile {
    /// The radius; 36 000 deviations are of no use to anybody.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RadialProfile")
            .field("radius", &self.radius)
            .finish_non_exhaustive()
    }
}

impl RadialProfile {
    /// The radius from which the deviations are counted.
    pub fn radius_m(&self) -> f64 {
        self.radius
    }

    /// The deviation at each of the [`ANGLES`] fixed angles, from X+ counter-clockwise; positive is
    /// outwards.
    pub fn deviations_m(&self) -> &[f64] {
        &self.at
    }

    /// The outermost point of each sector that has one.
    pub(super) fn outer(&self) -> impl Iterator<Item = &Point> {
        self.outer.iter().flatten()
    }

    /// The innermost point of each sector that has one.
    pub(super) fn inner(&self) -> impl Iterator<Item = &Point> {
        self.inner.iter().flatten()
    }

    /// The largest and the smallest deviation in m not farther than `width` fixed angles from the
    /// one with the number `at`: of the points as they are, and of the fixed angles.
    pub(super) fn within(&self, at: usize, width: usize) -> [f64; 2] {
        let [mut most, mut least] = [f64::MIN, f64::MAX];
        for way in 0..=2 * width {
            let index = (at + ANGLES + way - width) % ANGLES;
            most = most.max(self.at[index]);
            least = least.min(self.at[index]);
            // The sector after the last angle is outside.
            if way < 2 * width {
                most = self.outer[index].map_or(most, |point| most.max(point.deviation));
                least = self.inner[index].map_or(least, |point| least.min(point.deviation));
            }
        }
        [most, least]
    }

    /// The angle in radians and the deviation in m at `count` angles evenly over the turn, each
    /// with the largest deviation from zero of its part of the turn kept: for pictures.
    pub fn outline(&self, count: usize) -> Vec<(f64, f64)> {
        let count = count.clamp(1, ANGLES);
        let part = ANGLES.div_ceil(count);
        let parts = self.at.chunks(part).enumerate();
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
