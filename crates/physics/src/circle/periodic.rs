//! An error that repeats along an axis: that of its screw or its encoder (R5.28).

use std::f64::consts::TAU;

use super::crossing::PlaneAxis;
use super::series::Series;
use super::shapes::{Joint, Shapes};
use super::turning::Turning;

/// Pitches in mm.
const PITCHES: [f64; 2] = [1.0, 40.0];

/// A screw turns at least so often in a radius.
const LEAST_TURNS: f64 = 0.5;

/// A screw that turns less often in a radius looks like other shapes.
const ALIKE_TURNS: f64 = 3.0;

/// Frequencies on either side of the best one among which the pitch is sharpened.
const FINE: i32 = 15;

/// A screw of an axis with a pitch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Screw {
    pub(super) axis: PlaneAxis,
    /// Turns in a mm.
    pub(super) frequency: f64,
}

impl Screw {
    /// What a cosine and a sine of the screw make of the radial deviation.
    pub(super) fn columns(&self, angle: Turning, radius_mm: f64) -> [f64; 2] {
        let along = match self.axis {
            PlaneAxis::X => angle.cos,
            PlaneAxis::Y => angle.sin,
        };
        let (sin, cos) = (TAU * self.frequency * radius_mm * along).sin_cos();
        [along * cos, along * sin]
    }

    /// The mean square of paths that it explains by itself.
    fn explains(&self, left: &[Series]) -> f64 {
        let (mut squares, mut products, mut count) = ([0.0; 3], [0.0; 2], 0.0);
        for one in left {
            for (angle, value) in one.steps() {
                let [c, s] = self.columns(angle, one.radius_mm);
                squares = [squares[0] + c * c, squares[1] + c * s, squares[2] + s * s];
                products = [products[0] + c * value, products[1] + s * value];
                count += 1.0;
            }
        }
        let joint = Joint::new(squares, squares, products);
        joint.map_or(0.0, |it| it.explains / f64::max(count, 1.0))
    }
}

/// An error that repeats along an axis.
pub(super) struct Periodic {
    pub(super) screw: Screw,
    pub(super) joint: Joint,
}

impl Periodic {
    /// The amplitude in µm.
    pub(super) fn amplitude_um(&self) -> f64 {
        self.joint.parts[0].hypot(self.joint.parts[1])
    }

    /// The mean square that it explains.
    pub(super) fn explains(&self) -> f64 {
        self.joint.explains
    }

    /// The error in µm at a place of the path.
    pub(super) fn at(&self, angle: Turning, radius_mm: f64) -> f64 {
        let [cos, sin] = self.screw.columns(angle, radius_mm);
        self.joint.parts[0] * cos + self.joint.parts[1] * sin
    }

    /// The error of any pitch that explains most of what shapes leave, beside them.
    pub(super) fn search(shapes: &Shapes) -> Option<Self> {
        let radius_mm = shapes.left.first()?.radius_mm;
        let [from, to] = [1.0 / PITCHES[1], 1.0 / PITCHES[0]];
        let step = 1.0 / (6.0 * radius_mm);
        let of = |screw: Screw| {
            let joint = shapes.joint(&screw)?;
            Some(Self { screw, joint })
        };
        let mut best: Option<(Screw, f64)> = None;
        for axis in PlaneAxis::ALL {
            let mut frequency = from.max(LEAST_TURNS / radius_mm);
            while frequency <= to {
                let screw = Screw { axis, frequency };
                let explains = if frequency * radius_mm < ALIKE_TURNS {
                    of(screw).map_or(0.0, |it| it.explains())
                } else {
                    screw.explains(&shapes.left)
                };
                if best.is_none_or(|(_, most)| explains > most) {
                    best = Some((screw, explains));
                }
                frequency += step;
            }
        }
        let (best, _) = best?;
        // Between the frequencies that were tried.
        let near = (-FINE..=FINE).filter_map(|at| {
            let frequency = best.frequency + f64::from(at) / f64::from(FINE) * step;
            of(Screw { frequency, ..best })
        });
        near.max_by(|one, other| one.explains().total_cmp(&other.explains()))
    }
}
