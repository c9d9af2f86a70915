//! The path away from its crossings, where no peak disturbs it: the shape of the rest shows its cause
//! (R5.24).
//!
//! A centre that is off shifts the path by its first harmonic; axes whose gains, scales or angle
//! are wrong make an ellipse, the second harmonic. An axis with backlash lags by half of it
//! against its direction of motion, so that the path steps where the axis turns round. All of
//! this is fitted at once to the quiet part of the whole turn.

use crate::circle::evidence::{TailPlace, Tails};
use crate::circle::geometry::CosineSine;
use crate::circle::geometry::CrossingWindow;
use crate::circle::geometry::Direction;
use crate::circle::geometry::{Crossing, PlaneAxis};
use crate::circle::geometry::{ProfilePoint, RadialProfile, UM_PER_M};
use crate::linear::Normal;

/// The undisturbed path, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct QuietPath {
    direction: Direction,
    mean: f64,
    /// Shift of the centre, in X and Y.
    shift: [f64; 2],
    /// The amplitude of the ellipse along the axes and at 45°.
    pub(crate) ellipse: [f64; 2],
    /// Steps of the path outwards at the crossings of X and Y.
    pub(crate) steps: [f64; 2],
}

/// Side of a crossing: before or after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Beside {
    Before,
    After,
}

impl QuietPath {
    /// Fits the path between the windows of a profile, less tails of its peaks; `None` if they do not determine it.
    pub(crate) fn of(
        profile: &RadialProfile,
        direction: Direction,
        (window, tails): (CrossingWindow, Tails),
    ) -> Option<Self> {
        let turn_s = profile.turn_s().unwrap_or_default();
        let places = Crossing::ALL
            .into_iter()
            .flat_map(|crossing| profile.fixed(crossing, direction, window.quiet()));
        let mut normal = Normal::<7>::new();
        for (_, point) in places {
            let ProfilePoint {
                cos,
                sin,
                deviation,
            } = point;
            let [along, across] = second_harmonic(point);
            let [x, y] = PlaneAxis::ALL.map(|axis| lag(axis, point, direction));
            let angle = CosineSine { cos, sin };
            let place = TailPlace {
                angle,
                direction,
                turn_s,
            };
            let deviation = deviation - tails.at(place) / UM_PER_M;
            normal.add([1.0, cos, sin, along, across, x, y], deviation);
        }
        let [mean, shift_x, shift_y, along, across, step_x, step_y] = normal.solve()?;
        Some(Self {
            direction,
            mean,
            shift: [shift_x, shift_y],
            ellipse: [along, across],
            steps: [step_x, step_y],
        })
    }

    /// Returns the path without any step in the direction of a point.
    pub(crate) fn smooth(&self, point: ProfilePoint) -> f64 {
        let [along, across] = second_harmonic(point);
        self.mean
            + self.shift[0] * point.cos
            + self.shift[1] * point.sin
            + self.ellipse[0] * along
            + self.ellipse[1] * across
    }

    /// Returns the path on one side of a crossing, continued beyond it, in the direction of a point.
    pub(crate) fn level(&self, crossing: Crossing, beside: Beside, point: ProfilePoint) -> f64 {
        let side = match beside {
            Beside::Before => -1.0,
            Beside::After => 1.0,
        };
        let [x, y] = self.steps;
        let steps = match crossing.axis() {
            PlaneAxis::X => {
                0.5 * side * x * point.cos.abs() + y * lag(PlaneAxis::Y, point, self.direction)
            }
            PlaneAxis::Y => {
                0.5 * side * y * point.sin.abs() + x * lag(PlaneAxis::X, point, self.direction)
            }
        };
        self.smooth(point) + steps
    }
}

/// Returns the second harmonic in the direction of a point: along the axes, and at 45°.
fn second_harmonic(ProfilePoint { cos, sin, .. }: ProfilePoint) -> [f64; 2] {
    [cos * cos - sin * sin, 2.0 * cos * sin]
}

/// Returns the displacement of the path outwards by an axis with a backlash of 1: half of it
/// against the direction of the axis.
fn lag(axis: PlaneAxis, ProfilePoint { cos, sin, .. }: ProfilePoint, direction: Direction) -> f64 {
    let turning = direction.sign();
    match axis {
        PlaneAxis::X => 0.5 * turning * sin.signum() * cos,
        PlaneAxis::Y => -0.5 * turning * cos.signum() * sin,
    }
}
