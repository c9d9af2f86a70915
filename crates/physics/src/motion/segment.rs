//! One piece of the path: the positions of the axes after a distance, their slopes and their bends.

use std::f64::consts::{PI, TAU};
use std::sync::Arc as Shared;

use super::curve::SplineSpan;
use super::limits::AxisLimits;
use super::profile::{Bounds, RampForm};
use super::share::Share;
use super::trace::Cause;
use frictcomp::interpreter::{BlockEnd, CircularArc, SAME_PLACE};
use frictcomp::lists::SlopeProfile;

/// Share of the acceleration for the circle itself: the rest speeds up and slows down.
const CIRCLE_ACCELERATION: f64 = 0.9;
/// Share of the jerk for the circle itself.
const CIRCLE_JERK: f64 = 0.7;
/// Share of the jerk for the change of path velocity on a circle, across the path.
const CROSS_JERK: f64 = 0.5;

/// Slope below which it is due to the rounding of a sine.
const NO_SLOPE: f64 = 1e-12;

/// A piece of the path.
#[derive(Debug, Clone)]
pub(super) struct PathSegment {
    from: Box<[f64]>,
    to: Box<[f64]>,
    shape: SegmentShape,
    /// The distance along the path that the feed refers to, in mm or degrees.
    pub(super) length: f64,
    /// The highest path velocity that the program sets.
    pub(super) feed: f64,
    pub(super) end: BlockEnd,
    /// The profile of the acceleration, if the program selects one.
    pub(super) slope: Option<SlopeProfile>,
    /// The highest path velocity at its end.
    pub(super) end_velocity: f64,
    pub(super) cause: Shared<Cause>,
}

/// Shape of a segment.
#[derive(Debug, Clone)]
enum SegmentShape {
    Line,
    Arc(PlaneArc),
    Curve(Box<SplineSpan>),
}

/// An arc in the plane of two axes.
#[derive(Debug, Clone, Copy)]
struct PlaneArc {
    axes: [usize; 2],
    centre: [f64; 2],
    radius: f64,
    /// The angle at which it starts, against the first axis.
    start: f64,
    /// The angle that it runs through, positive against the clock.
    sweep: f64,
}

/// The line or the circle of a plane on which a segment lies.
#[derive(Debug, Clone, Copy)]
pub(super) enum SegmentOutline {
    Line {
        through: [f64; 2],
        direction: [f64; 2],
    },
    Circle {
        centre: [f64; 2],
        radius: f64,
    },
}

/// Ends of a segment, by axis, and the axes that the feed refers to.
pub(super) struct Ends<'a> {
    pub(super) from: Box<[f64]>,
    pub(super) to: Box<[f64]>,
    /// Whether each axis is a main axis (X Y Z, PM/207471243).
    pub(super) main: &'a [bool],
}

impl PathSegment {
    /// Returns a straight segment; `None` if nothing moves.
    pub(super) fn line(ends: Ends<'_>, cause: Shared<Cause>) -> Option<Self> {
        let way = |main: bool| {
            let axes = ends.from.iter().zip(&ends.to).zip(ends.main);
            axes.filter(|(_, is_main)| **is_main == main)
                .map(|((from, to), _)| to - from)
                .fold(0.0, f64::hypot)
        };
        // Axes other than the main ones follow; if they move alone, the feed is theirs.
        let (main, beside) = (way(true), way(false));
        let length = if main > SAME_PLACE || beside == 0.0 {
            main
        } else {
            beside
        };
        if length == 0.0 {
            return None;
        }
        Some(Self::new(ends, SegmentShape::Line, length, cause))
    }

    /// Returns an arc or a helix.
    ///
    /// # Errors
    /// The ends and the centre do not make an arc.
    pub(super) fn arc(
        ends: Ends<'_>,
        arc: &CircularArc,
        cause: Shared<Cause>,
    ) -> Result<Self, &'static str> {
        let axes = arc.axes.map(frictcomp::comp::AxisIndex::get);
        let circle = PlaneArc::new(axes, &ends.from, &ends.to, arc)?;
        let depth = (0..ends.from.len())
            .filter(|axis| ends.main[*axis] && !axes.contains(axis))
            .map(|axis| ends.to[axis] - ends.from[axis])
            .fold(0.0, f64::hypot);
        let length = (circle.radius * circle.sweep).hypot(depth);
        Ok(Self::new(ends, SegmentShape::Arc(circle), length, cause))
    }

    /// Returns the block along another line: from one place to another, straight.
    pub(super) fn moved(&self, from: &[f64], to: &[f64], main: &[bool]) -> Option<Self> {
        let ends = Ends {
            from: from.into(),
            to: to.into(),
            main,
        };
        let line = Self::line(ends, Shared::clone(&self.cause))?;
        Some(line.paced_as(self))
    }

    /// Returns the block along the span of a B-spline with these control points.
    pub(super) fn curved(&self, points: [&[f64]; 4], main: &[bool]) -> Option<Self> {
        let curve = SplineSpan::new(points, main)?;
        let place = |along| {
            let still = points[1];
            (0..still.len())
                .map(|axis| curve.position(axis, along).unwrap_or(still[axis]))
                .collect()
        };
        let ends = Ends {
            from: place(curve.after(0.0)),
            to: place(curve.after(curve.length())),
            main,
        };
        let length = curve.length();
        let shape = SegmentShape::Curve(Box::new(curve));
        Some(Self::new(ends, shape, length, Shared::clone(&self.cause)).paced_as(self))
    }

    fn paced_as(self, block: &Self) -> Self {
        Self {
            feed: block.feed,
            end: block.end,
            slope: block.slope,
            end_velocity: block.end_velocity,
            ..self
        }
    }

    /// Returns the block at a distance to the left of its direction in a plane, to the right if it is negative.
    ///
    /// # Errors
    /// It has no such path.
    pub(super) fn beside(&self, plane: [usize; 2], left: f64) -> Result<Self, &'static str> {
        let mut beside = self.clone();
        let mut aside = |place: fn(&mut Self) -> &mut Box<[f64]>, distance: f64| {
            let [along, across] = self.direction(plane, distance);
            place(&mut beside)[plane[0]] -= left * across;
            place(&mut beside)[plane[1]] += left * along;
        };
        aside(|it| &mut it.from, 0.0);
        aside(|it| &mut it.to, self.length);
        match &mut beside.shape {
            SegmentShape::Line => {}
            SegmentShape::Arc(circle) if circle.axes == plane => {
                let depth = (self.length.powi(2) - (circle.radius * circle.sweep).powi(2)).max(0.0);
                circle.radius -= left * circle.sweep.signum();
                if circle.radius < SAME_PLACE {
                    return Err("the arc is not larger than the tool");
                }
                beside.length = (circle.radius * circle.sweep).hypot(depth.sqrt());
            }
            _ => return Err("the arc is not in the plane of the tool radius compensation"),
        }
        Ok(beside)
    }

    /// Returns the arc from the end of this block to a place of the plane.
    pub(super) fn around(&self, arc: &CircularArc, end: [f64; 2], main: &[bool]) -> Option<Self> {
        let mut to = self.to.clone();
        for (axis, end) in arc.axes.iter().zip(end) {
            to[axis.get()] = end;
        }
        let ends = Ends {
            from: self.to.clone(),
            to,
            main,
        };
        let mut around = Self::arc(ends, arc, Shared::clone(&self.cause)).ok()?;
        (around.feed, around.slope) = (self.feed, self.slope);
        Some(around)
    }

    /// Returns the direction in a plane after a distance, as a unit; 0 if it does not move there.
    pub(super) fn direction(&self, plane: [usize; 2], distance: f64) -> [f64; 2] {
        let slope = plane.map(|axis| self.slope(axis, distance));
        let length = slope[0].hypot(slope[1]);
        slope.map(|slope| if length > 0.0 { slope / length } else { 0.0 })
    }

    /// Returns the line or the circle of a plane on which it lies.
    pub(super) fn outline(&self, plane: [usize; 2]) -> SegmentOutline {
        match self.circle() {
            Some(circle) => SegmentOutline::Circle {
                centre: circle.centre,
                radius: circle.radius,
            },
            None => SegmentOutline::Line {
                through: plane.map(|axis| self.from[axis]),
                direction: self.direction(plane, 0.0),
            },
        }
    }

    /// Returns the part of its length at a place of a plane on its outline; below 0 before its start, above 1 beyond
    /// its end.
    pub(super) fn part_at(&self, axes: [usize; 2], place: [f64; 2]) -> f64 {
        let Some(circle) = self.circle() else {
            let way = axes.map(|axis| self.to[axis] - self.from[axis]);
            let gone = [0, 1].map(|at| place[at] - self.from[axes[at]]);
            return (gone[0] * way[0] + gone[1] * way[1]) / (way[0] * way[0] + way[1] * way[1]);
        };
        let angle = (place[1] - circle.centre[1]).atan2(place[0] - circle.centre[0]);
        let middle = circle.start + circle.sweep / 2.0;
        // The nearest turn to the middle of the arc.
        let off = (angle - middle + PI).rem_euclid(TAU) - PI;
        0.5 + off / circle.sweep
    }

    /// Returns the part of the block between two parts of its length, with these ends in a plane.
    pub(super) fn between(
        &self,
        parts: [f64; 2],
        (axes, places): ([usize; 2], [[f64; 2]; 2]),
    ) -> Self {
        let mut cut = self.clone();
        let share = parts[1] - parts[0];
        let ends = [&mut cut.from, &mut cut.to];
        for ((end, part), place) in ends.into_iter().zip(parts).zip(places) {
            for axis in 0..self.from.len() {
                end[axis] = self.from[axis] + (self.to[axis] - self.from[axis]) * part;
            }
            (end[axes[0]], end[axes[1]]) = (place[0], place[1]);
        }
        if let SegmentShape::Arc(circle) = &mut cut.shape {
            circle.start += circle.sweep * parts[0];
            circle.sweep *= share;
        }
        cut.length *= share;
        cut
    }

    /// Returns whether it is straight.
    pub(super) fn is_straight(&self) -> bool {
        matches!(self.shape, SegmentShape::Line)
    }

    /// Returns the arc, if it is one.
    fn circle(&self) -> Option<&PlaneArc> {
        match &self.shape {
            SegmentShape::Arc(circle) => Some(circle),
            _ => None,
        }
    }

    fn new(ends: Ends<'_>, shape: SegmentShape, length: f64, cause: Shared<Cause>) -> Self {
        Self {
            from: ends.from,
            to: ends.to,
            shape,
            length,
            feed: f64::INFINITY,
            end: BlockEnd::Through,
            slope: None,
            end_velocity: f64::INFINITY,
            cause,
        }
    }

    /// Returns the path velocity at which one axis moves at its limit and none beyond it.
    pub(super) fn fastest(&self, limits: &[AxisLimits]) -> f64 {
        let open = Self {
            feed: f64::INFINITY,
            ..self.clone()
        };
        open.bounds(limits, Share::Whole).velocity
    }

    /// Returns the positions of the axes at its start.
    pub(super) fn starts(&self) -> &[f64] {
        &self.from
    }

    /// Returns the positions of the axes at its end.
    pub(super) fn ends(&self) -> &[f64] {
        &self.to
    }

    /// Returns the number of axes.
    pub(super) fn axes(&self) -> usize {
        self.from.len()
    }

    /// Returns the position of an axis after a distance along the segment, and its slope there.
    pub(super) fn place(&self, axis: usize, distance: f64) -> [f64; 2] {
        if let SegmentShape::Curve(curve) = &self.shape
            && distance > 0.0
            && distance < self.length
        {
            let along = curve.after(distance);
            let [slope, _] = curve.shape(axis, along);
            let position = curve.position(axis, along).unwrap_or(self.from[axis]);
            return [position, slope];
        }
        [self.position(axis, distance), self.slope(axis, distance)]
    }

    /// Returns the position of an axis after a distance along the segment; exact at both ends.
    pub(super) fn position(&self, axis: usize, distance: f64) -> f64 {
        if distance <= 0.0 {
            return self.from[axis];
        }
        if distance >= self.length {
            return self.to[axis];
        }
        if let SegmentShape::Curve(curve) = &self.shape {
            let along = curve.after(distance);
            return curve.position(axis, along).unwrap_or(self.from[axis]);
        }
        let part = distance / self.length;
        match self.circle() {
            Some(circle) if circle.axes.contains(&axis) => {
                let (along, across) = circle.direction(part);
                let (centre, share) = if axis == circle.axes[0] {
                    (circle.centre[0], along)
                } else {
                    (circle.centre[1], across)
                };
                centre + circle.radius * share
            }
            _ => self.from[axis] + (self.to[axis] - self.from[axis]) * part,
        }
    }

    /// Returns the change of the position of an axis with the distance, `dx/ds`, after a distance.
    pub(super) fn slope(&self, axis: usize, distance: f64) -> f64 {
        let slope = match &self.shape {
            SegmentShape::Curve(curve) => curve.shape(axis, curve.after(distance))[0],
            SegmentShape::Arc(circle) if circle.axes.contains(&axis) => {
                let (along, across) = circle.direction(distance / self.length);
                let turn = circle.radius * circle.sweep / self.length;
                if axis == circle.axes[0] {
                    -across * turn
                } else {
                    along * turn
                }
            }
            _ => (self.to[axis] - self.from[axis]) / self.length,
        };
        if slope.abs() < NO_SLOPE { 0.0 } else { slope }
    }

    /// Returns the change of the slope of an axis with the distance, `d²x/ds²`.
    pub(super) fn bend(&self, axis: usize, distance: f64) -> f64 {
        match &self.shape {
            SegmentShape::Curve(curve) => curve.shape(axis, curve.after(distance))[1],
            SegmentShape::Arc(circle) if circle.axes.contains(&axis) => {
                let (along, across) = circle.direction(distance / self.length);
                let turn = circle.sweep / self.length;
                let share = if axis == circle.axes[0] {
                    along
                } else {
                    across
                };
                -share * circle.radius * turn * turn
            }
            _ => 0.0,
        }
    }

    /// Returns the limits along this segment from those of the axes (R5.2, R5.3). Along a circle
    /// position, acceleration and jerk of the plane's axes are those of `r(φ)`: `v²/r` and `3va/r`
    /// across the path, `a` and `j - v³/r²` along it.
    pub(super) fn bounds(&self, limits: &[AxisLimits], share: Share) -> Bounds {
        let mut bounds = Bounds {
            velocity: self.feed,
            acceleration: f64::INFINITY,
            jerk: f64::INFINITY,
            curve_jerk: f64::INFINITY,
            ramps: RampForm::default(),
        };
        if let SegmentShape::Curve(curve) = &self.shape {
            curve.restrict(&mut bounds, (limits, share));
            return bounds;
        }
        for (axis, limits) in limits.iter().enumerate() {
            let straight = self
                .circle()
                .is_none_or(|circle| !circle.axes.contains(&axis));
            let slope = ((self.to[axis] - self.from[axis]) / self.length).abs();
            if straight && slope > 0.0 {
                let limits = share.of(limits);
                bounds.velocity = bounds.velocity.min(limits.velocity / slope);
                bounds.acceleration = bounds.acceleration.min(limits.acceleration / slope);
                bounds.jerk = bounds.jerk.min(limits.jerk / slope);
            }
        }
        if let Some(circle) = self.circle() {
            let [one, two] = circle.axes.map(|axis| share.of(&limits[axis]));
            let plane = Bounds {
                velocity: one.velocity.min(two.velocity),
                acceleration: one.acceleration.min(two.acceleration),
                jerk: one.jerk.min(two.jerk),
                curve_jerk: one.curve_jerk.min(two.curve_jerk),
                ramps: RampForm::default(),
            };
            circle.restrict(&mut bounds, plane, self.length);
        }
        bounds
    }
}

impl PlaneArc {
    fn new(
        axes: [usize; 2],
        from: &[f64],
        to: &[f64],
        arc: &CircularArc,
    ) -> Result<Self, &'static str> {
        let places = [from, to].map(|places| axes.map(|axis| places[axis]));
        let shape = arc.between(places)?;
        Ok(Self {
            axes,
            centre: shape.centre,
            radius: shape.radius,
            start: shape.start,
            sweep: shape.sweep,
        })
    }

    /// Returns the cosine and the sine of the angle after a part of the arc.
    fn direction(&self, part: f64) -> (f64, f64) {
        let (sine, cosine) = (self.start + self.sweep * part).sin_cos();
        (cosine, sine)
    }

    /// Applies the limits of the axes of the plane along the path.
    fn restrict(&self, bounds: &mut Bounds, plane: Bounds, length: f64) {
        // The part of the path velocity that lies in the plane; all of it without a helix.
        let flat = self.radius * self.sweep.abs() / length;
        let radius = self.radius;
        let velocity = (bounds.velocity * flat)
            .min(plane.velocity)
            .min((CIRCLE_ACCELERATION * plane.acceleration * radius).sqrt())
            .min((CIRCLE_JERK * plane.curve_jerk * radius * radius).cbrt());
        let across = velocity * velocity / radius;
        let acceleration = (plane.acceleration * plane.acceleration - across * across)
            .sqrt()
            .min(CROSS_JERK * plane.jerk * radius / (3.0 * velocity));
        let jerk = plane.jerk * (1.0 - CROSS_JERK * CROSS_JERK).sqrt()
            - velocity.powi(3) / (radius * radius);
        let jerk = jerk.max(plane.jerk * (1.0 - CIRCLE_JERK) / 2.0);
        bounds.velocity = velocity / flat;
        bounds.acceleration = bounds.acceleration.min(acceleration / flat);
        bounds.jerk = bounds.jerk.min(jerk / flat);
    }
}
