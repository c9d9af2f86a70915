//! The shape of an arc between two places.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::motion::{Arc, Centre, Turn};

/// Places closer than this, in mm or degrees, are one: the ends of a full circle, and the end of a
/// motion and the start of the next.
pub const SAME_PLACE: f64 = 1e-6;

/// The part of the radius by which the centre of an arc may miss the places that its ends allow; it is
/// moved then, as G165 does (PM/206551563).
const CENTRE_TOLERANCE: f64 = 0.05;

/// The part of the square of the radius by which rounding may have made the radius too small for the ends.
const RADIUS_TOLERANCE: f64 = 1e-3;

/// An arc in its plane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ArcShape {
    /// The centre.
    pub centre: [f64; 2],
    /// The radius.
    pub radius: f64,
    /// The angle at which it starts, against the first axis.
    pub start: f64,
    /// The angle that it runs through, positive against the clock.
    pub sweep: f64,
}

impl ArcShape {
    /// Returns the travel of both axes of the plane along the arc, forth and back, in the unit of the radius:
    /// four radii each on a full circle.
    pub fn travel(&self) -> [f64; 2] {
        let ends = [self.start, self.start + self.sweep];
        let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        // The first axis turns back at 0 and 180°, the second at 90° and 270°.
        [(0.0, f64::cos as fn(f64) -> f64), (FRAC_PI_2, f64::sin)].map(|(first, place)| {
            let mut turn = first + ((low - first) / PI).ceil() * PI;
            let (mut at, mut travel) = (low, 0.0);
            while turn < high {
                travel += (place(turn) - place(at)).abs();
                at = turn;
                turn += PI;
            }
            self.radius * (travel + (place(high) - place(at)).abs())
        })
    }
}

impl Arc {
    /// The arc from one place of its plane to another.
    ///
    /// # Errors
    /// The reason why the ends and the centre make no arc.
    pub fn between(&self, places: [[f64; 2]; 2]) -> Result<ArcShape, &'static str> {
        let [start, end] = places;
        let chord = [end[0] - start[0], end[1] - start[1]];
        let distance = chord[0].hypot(chord[1]);
        let full = distance < SAME_PLACE;
        let middle = [
            f64::midpoint(start[0], end[0]),
            f64::midpoint(start[1], end[1]),
        ];
        let centre = match self.centre {
            Centre::Point(centre) if full => centre,
            Centre::Point(centre) => {
                // The nearest point that has the same distance to both ends.
                let offset = [centre[0] - middle[0], centre[1] - middle[1]];
                let astray = (offset[0] * chord[0] + offset[1] * chord[1]) / distance;
                let given = (centre[0] - start[0]).hypot(centre[1] - start[1]);
                if astray.abs() > CENTRE_TOLERANCE * given {
                    return Err("the centre of the circle does not fit its ends");
                }
                [
                    centre[0] - astray * chord[0] / distance,
                    centre[1] - astray * chord[1] / distance,
                ]
            }
            Centre::Radius(_) if full => return Err("`R` cannot describe a full circle"),
            Centre::Radius(radius) => {
                let height = radius * radius - distance * distance / 4.0;
                // A radius that rounding made too small gives half a circle.
                if height < -RADIUS_TOLERANCE * radius * radius {
                    return Err("the radius is less than half the distance between the ends");
                }
                let height = height.max(0.0).sqrt() * radius.signum();
                // The short arc against the clock has its centre on the left.
                let side = match self.turn {
                    Turn::Clockwise => -height,
                    Turn::CounterClockwise => height,
                };
                [
                    middle[0] - side * chord[1] / distance,
                    middle[1] + side * chord[0] / distance,
                ]
            }
        };
        let angle = |point: [f64; 2]| (point[1] - centre[1]).atan2(point[0] - centre[0]);
        let radius = (start[0] - centre[0]).hypot(start[1] - centre[1]);
        if radius < SAME_PLACE || !radius.is_finite() {
            return Err("the circle has no radius");
        }
        let turned = (angle(end) - angle(start)).rem_euclid(TAU);
        let sweep = match self.turn {
            _ if full => TAU,
            Turn::CounterClockwise => turned,
            Turn::Clockwise => TAU - turned,
        };
        Ok(ArcShape {
            centre,
            radius,
            start: angle(start),
            sweep: match self.turn {
                Turn::CounterClockwise => sweep,
                Turn::Clockwise => -sweep,
            },
        })
    }
}
