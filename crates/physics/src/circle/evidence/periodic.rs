//! An error that repeats along an axis: that of its screw or its encoder (R5.28).

use std::f64::consts::TAU;

use super::series::AngleSeries;
use crate::circle::geometry::PlaneAxis;

use crate::circle::geometry::CosineSine;

/// A screw of an axis with a pitch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Screw {
    pub(crate) axis: PlaneAxis,
    /// Turns per mm.
    pub(crate) frequency: f64,
}

impl Screw {
    /// Returns the effects of a cosine and a sine of the screw on the radial deviation.
    pub(crate) fn columns(&self, angle: CosineSine, radius_mm: f64) -> [f64; 2] {
        let along = match self.axis {
            PlaneAxis::X => angle.cos,
            PlaneAxis::Y => angle.sin,
        };
        let (sin, cos) = (TAU * self.frequency * radius_mm * along).sin_cos();
        [along * cos, along * sin]
    }

    /// Returns the mean square of paths that it alone explains.
    pub(crate) fn explains(&self, left: &[AngleSeries]) -> f64 {
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
pub(crate) struct Periodic {
    pub(crate) screw: Screw,
    pub(crate) joint: Joint,
}

impl Periodic {
    /// Returns the mean square that it explains.
    pub(crate) fn explains(&self) -> f64 {
        self.joint.explains
    }
}

/// Two columns in addition to the shapes.
pub(crate) struct Joint {
    /// Mean square that they explain.
    pub(crate) explains: f64,
}

impl Joint {
    /// Returns the fit of two columns with their own part of the squares, and all of their squares.
    pub(crate) fn new(own: [f64; 3], squares: [f64; 3], products: [f64; 2]) -> Option<Self> {
        /// Columns with a smaller part of their own are shapes.
        const LEAST_OWN: f64 = 1e-6;
        let determinant = own[0] * own[2] - own[1] * own[1];
        let is_firm = determinant > LEAST_OWN * squares[0] * squares[2];
        let inverse = [own[2], -own[1], own[0]].map(|it| it / determinant);
        let parts = [
            inverse[0] * products[0] + inverse[1] * products[1],
            inverse[1] * products[0] + inverse[2] * products[1],
        ];
        is_firm.then_some(Self {
            explains: parts[0] * products[0] + parts[1] * products[1],
        })
    }
}
