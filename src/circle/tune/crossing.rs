//! One reversal by itself: what the search looks at in place of whole circles.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::direction::Direction;
use super::super::profile::UM_PER_M;
use super::super::reference::{Circle, CircleError, Stretch};
use super::super::simulate::simulate;
use super::super::test::CircularTest;
use crate::current::Switched;

/// The axis that reverses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
}

impl Axis {
    pub(super) const ALL: [Self; 2] = [Self::X, Self::Y];

    /// The commanded angle of one of its reversals in the turn that a whole run evaluates, which
    /// begins half a turn after X+.
    fn reversal(self) -> f64 {
        match self {
            Self::X => 2.0 * PI,
            Self::Y => 3.0 * FRAC_PI_2,
        }
    }
}

/// Half the window of the glitch (R5.22), in radians.
const WINDOW: f64 = 8.0 * PI / 180.0;

/// So long before the window, at least, the drives begin, in s.
const SETTLING: f64 = 0.15;

/// The window is not looked at farther from the reversal than this, in s: by then the loops have
/// settled.
const BEFORE: f64 = 0.05;

/// The same after the reversal, where the peak decays.
const AFTER: f64 = 0.5;

/// The glitch in µm at one reversal of an axis, peak to peak within ±8°. The cycles are those of a
/// whole run, so that the reversal falls at the same place within its cycle.
pub(super) fn height(test: &CircularTest, axis: Axis) -> Result<f64, CircleError> {
    let circle = &test.circle;
    circle.check()?;
    let window = Window::of(circle, axis);
    let quarter = circle.cycles(FRAC_PI_2);
    // A quarter of a turn earlier the axis was in the middle of its way: the additive current has
    // long built up when the drives begin.
    let first = window.begin.saturating_sub(quarter);
    let turning = circle.angular_velocity() * circle.cycle_time_s;
    let stretch = Stretch {
        start: count(first) * turning,
        length: count(window.end - first) * turning,
        lead: window.begin - first,
        direction: Direction::Ccw,
    };
    let [mut most, mut least] = [f64::MIN, f64::MAX];
    simulate(test, Switched::On, stretch, |cycle, x, y| {
        if (window.from..window.end).contains(&(first + cycle)) {
            let radius = x.hypot(y);
            most = most.max(radius);
            least = least.min(radius);
        }
    })?;
    Ok((most - least) * UM_PER_M)
}

/// CNC cycles of a whole run around a reversal.
struct Window {
    /// Where the drives begin.
    begin: usize,
    /// Where the glitch is looked for.
    from: usize,
    /// Where both end.
    end: usize,
}

impl Window {
    fn of(circle: &Circle, axis: Axis) -> Self {
        let turning = circle.angular_velocity();
        let cycle = |time: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // in a checked run
            let cycle = (time / circle.cycle_time_s).floor() as usize;
            cycle
        };
        let reversal = axis.reversal() / turning;
        let window = WINDOW / turning;
        let before = window.min(BEFORE.max(0.1 * window));
        Self {
            begin: cycle((reversal - before - SETTLING).max(0.0)),
            from: cycle(reversal - before),
            end: cycle(reversal + window.min(AFTER)),
        }
    }
}

fn count(cycles: usize) -> f64 {
    #[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
    let count = cycles as f64;
    count
}
