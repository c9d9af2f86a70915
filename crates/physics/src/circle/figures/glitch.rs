//! The shape of a path at its crossings, and the part that remains (R5.22, R5.24).

use serde::Serialize;

use super::quiet::{Beside, QuietPath};
use crate::circle::evidence::{ShapeTerm, Term};
use crate::circle::evidence::{TailPlace, Tails};
use crate::circle::geometry::CosineSine;
use crate::circle::geometry::CrossingWindow;
use crate::circle::geometry::Direction;
use crate::circle::geometry::{Crossing, PlaneAxis};
use crate::circle::geometry::{ProfilePoint, RadialProfile, UM_PER_M};
use crate::linear::Normal;

/// The glitch at one crossing (R5.22).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Glitch {
    /// The crossing.
    pub crossing: Crossing,
    /// Peak to peak within the window, less a straight line through both sides.
    #[serde(rename = "height")]
    pub height_um: f64,
    /// Height of the bulge beyond the band between the paths before and after the crossing,
    /// outwards; at least 0.
    #[serde(rename = "outward")]
    pub outward_um: f64,
    /// Depth of the bulge inwards; at most 0.
    #[serde(rename = "inward")]
    pub inward_um: f64,
    /// The first of both.
    pub first: Bulge,
}

impl Glitch {
    /// Returns the glitch less the bulge of noise alone.
    pub(crate) fn less(&self, bulge_um: f64) -> Self {
        Self {
            outward_um: (self.outward_um - bulge_um).max(0.0),
            inward_um: (self.inward_um + bulge_um).min(0.0),
            ..*self
        }
    }
}

/// The direction of a deviation from the undisturbed path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Bulge {
    /// Deviation away from the centre.
    Outward,
    /// Towards the centre.
    Inward,
}

/// Shape of the path where an axis reverses (R5.24).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AxisShape {
    /// Permanent step of the path outwards: the backlash of the axis, negative if it is
    /// over-compensated.
    #[serde(rename = "step")]
    pub step_um: f64,
    /// The largest deviation that decays; positive is outwards.
    #[serde(rename = "peak")]
    pub peak_um: f64,
    /// Whether the peak has decayed early enough to show the permanent step.
    pub is_settled: bool,
}

/// Shape of a path at its crossings, and the ellipse that remains without it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PathShape {
    /// Width of the window after a crossing.
    pub window_deg: f64,
    /// The glitches, counter-clockwise from X+.
    pub glitches: [Glitch; 4],
    /// Shapes of X and Y.
    pub axes: [AxisShape; 2],
    /// The amplitude of the ellipse along the axes, and at 45°.
    #[serde(rename = "ellipse")]
    pub ellipse_um: [f64; 2],
}

/// Part of the step below which the rest of a peak counts as decayed. Real backlash leaves less than a tenth; friction
/// that falls steeply with the speed bends the path far beyond the crossing and leaves more than a fifth of the
/// apparent step.
const SETTLED: f64 = 0.15;

impl PathShape {
    /// Returns the shape of a path whose peaks have these tails; `None` if its windows reach the next crossings.
    pub(crate) fn of(profile: &RadialProfile, direction: Direction, tails: Tails) -> Option<Self> {
        let seen = Seen::of(profile, direction, tails)?;
        let quiet = seen.without_tails;
        let glitches = Crossing::ALL.map(|crossing| seen.glitch(crossing));
        let [x, y] = quiet.steps;
        let axes = [(PlaneAxis::X, x), (PlaneAxis::Y, y)].map(|(axis, step)| {
            let of_axis = glitches.iter().filter(|it| it.crossing.axis() == axis);
            let peaks = of_axis.flat_map(|it| [it.outward_um, it.inward_um]);
            AxisShape {
                step_um: step * UM_PER_M,
                peak_um: peaks.fold(
                    0.0,
                    |most: f64, peak| {
                        if peak.abs() > most.abs() { peak } else { most }
                    },
                ),
                is_settled: seen.rest(axis) <= SETTLED * step.abs(),
            }
        });
        Some(Self {
            window_deg: seen.window.degrees(),
            glitches,
            axes,
            ellipse_um: quiet.ellipse.map(|amplitude| amplitude * UM_PER_M),
        })
    }

    /// Takes the steps and ellipses of a recording from the terms that its findings rest on, so that
    /// figures and findings agree.
    pub(crate) fn take_terms(&mut self, direction: Direction, terms: &[Term]) {
        let of = |shape: ShapeTerm| {
            let term = terms.iter().find(|it| it.shape == shape);
            term.map(|it| it.size_um)
        };
        for (shape, axis) in self.axes.iter_mut().zip(PlaneAxis::ALL) {
            shape.step_um = of(ShapeTerm::Backlash(axis)).unwrap_or(shape.step_um);
        }
        // From the short to the long axis an ellipse is twice its amplitude.
        if let Some(scale) = of(ShapeTerm::Scale) {
            self.ellipse_um[0] = scale / 2.0;
        }
        if let (Some(angle), Some(gain)) = (of(ShapeTerm::Squareness), of(ShapeTerm::Gain)) {
            self.ellipse_um[1] = f64::midpoint(angle, direction.sign() * gain);
        }
    }

    /// Returns the shape of an axis.
    pub fn axis(&self, axis: PlaneAxis) -> &AxisShape {
        let [x, y] = &self.axes;
        match axis {
            PlaneAxis::X => x,
            PlaneAxis::Y => y,
        }
    }
}

/// Returns the path at the four crossings less the undisturbed path and the straight line through both sides (R5.22):
/// the distance from the crossing in fixed angles, and the deviation in m. `None` if the windows reach the next
/// crossings.
pub(crate) fn straightened(
    profile: &RadialProfile,
    direction: Direction,
) -> Option<[Vec<(f64, f64)>; 4]> {
    let seen = Seen::of(profile, direction, Tails::default())?;
    Some(Crossing::ALL.map(|crossing| seen.straightened(crossing)))
}

/// A path with what is known of it.
struct Seen<'a> {
    profile: &'a RadialProfile,
    direction: Direction,
    window: CrossingWindow,
    quiet: QuietPath,
    tails: Tails,
    /// The undisturbed path without the tails.
    without_tails: QuietPath,
}

impl<'a> Seen<'a> {
    fn of(profile: &'a RadialProfile, direction: Direction, tails: Tails) -> Option<Self> {
        let window = CrossingWindow::of(profile.turn_s())?;
        let quiet = |tails| QuietPath::of(profile, direction, (window, tails));
        Some(Self {
            profile,
            direction,
            window,
            quiet: quiet(Tails::default())?,
            tails,
            without_tails: quiet(tails)?,
        })
    }

    /// Returns the deviation at a point in m, less the tail of an axis.
    fn less_tail(&self, axis: PlaneAxis, point: ProfilePoint) -> f64 {
        let ProfilePoint {
            cos,
            sin,
            deviation,
        } = point;
        let place = TailPlace {
            angle: CosineSine { cos, sin },
            direction: self.direction,
            turn_s: self.profile.turn_s().unwrap_or_default(),
        };
        deviation - self.tails.of(axis, place) / UM_PER_M
    }

    /// Returns the path in the window of a crossing less the undisturbed path and the line through both sides: the
    /// distance from the crossing in fixed angles, and the deviation in m.
    fn straightened(&self, crossing: Crossing) -> Vec<(f64, f64)> {
        let line = self.line(crossing);
        let fixed = self
            .profile
            .fixed(crossing, self.direction, self.window.inside());
        let straight = |(way, point): (f64, ProfilePoint)| {
            let level = self.quiet.smooth(point) + line[0] + line[1] * way;
            (way, point.deviation - level)
        };
        fixed.map(straight).collect()
    }

    fn glitch(&self, crossing: Crossing) -> Glitch {
        let line = self.line(crossing);
        let offset = self.offset(crossing);
        let mut height = Extremes::default();
        let mut bulge = Extremes::default();
        let ways = self.window.inside();
        for (way, point) in self.profile.every(crossing, self.direction, ways) {
            let straight = line[0] + line[1] * way;
            height.take(way, point.deviation - self.quiet.smooth(point) - straight);
            let level = |beside| self.without_tails.level(crossing, beside, point) + offset;
            let levels = [level(Beside::Before), level(Beside::After)];
            let [low, high] = [levels[0].min(levels[1]), levels[0].max(levels[1])];
            // The peak of the axis itself stays whole.
            let deviation = self.less_tail(crossing.axis().other(), point);
            bulge.take(
                way,
                (deviation - high).max(0.0) + (deviation - low).min(0.0),
            );
        }
        Glitch {
            crossing,
            height_um: (height.most.1 - height.least.1) * UM_PER_M,
            outward_um: bulge.most.1.max(0.0) * UM_PER_M,
            inward_um: bulge.least.1.min(0.0) * UM_PER_M,
            first: if bulge.least.0 < bulge.most.0 {
                Bulge::Inward
            } else {
                Bulge::Outward
            },
        }
    }

    /// Returns the straight line through both sides of a crossing: at the crossing, and for each fixed angle.
    fn line(&self, crossing: Crossing) -> [f64; 2] {
        let mut normal = Normal::<2>::new();
        for ways in [CrossingWindow::before(), self.window.after()] {
            for (way, point) in self.profile.fixed(crossing, self.direction, ways) {
                normal.add([1.0, way], point.deviation - self.quiet.smooth(point));
            }
        }
        normal.solve().unwrap_or_default()
    }

    /// Returns the rest of the peaks of an axis half-way to the place of the step.
    fn rest(&self, axis: PlaneAxis) -> f64 {
        let crossings = Crossing::ALL.into_iter().filter(|it| it.axis() == axis);
        let rests = crossings.map(|crossing| {
            let offset = self.offset(crossing);
            let ways = self.window.decaying();
            let mut mean = Normal::<1>::new();
            for (_, point) in self.profile.fixed(crossing, self.direction, ways) {
                let level = self.without_tails.level(crossing, Beside::After, point) + offset;
                mean.add([1.0], self.less_tail(axis, point) - level);
            }
            mean.solve().map_or(0.0, |[mean]| mean.abs())
        });
        rests.fold(0.0, f64::max)
    }

    /// Returns the distance of the path before a crossing from the undisturbed one: its higher
    /// harmonics. After the crossing the peak may not have decayed yet.
    fn offset(&self, crossing: Crossing) -> f64 {
        let mut mean = Normal::<1>::new();
        let ways = CrossingWindow::before();
        for (_, point) in self.profile.fixed(crossing, self.direction, ways) {
            let level = self.without_tails.level(crossing, Beside::Before, point);
            let other = crossing.axis().other();
            mean.add([1.0], self.less_tail(other, point) - level);
        }
        mean.solve().map_or(0.0, |[mean]| mean)
    }
}

/// The least and the largest value with their distances from the crossing.
struct Extremes {
    most: (f64, f64),
    least: (f64, f64),
}

impl Default for Extremes {
    fn default() -> Self {
        Self {
            most: (0.0, f64::NEG_INFINITY),
            least: (0.0, f64::INFINITY),
        }
    }
}

impl Extremes {
    fn take(&mut self, way: f64, value: f64) {
        if value > self.most.1 {
            self.most = (way, value);
        }
        if value < self.least.1 {
            self.least = (way, value);
        }
    }
}
