//! The direction of a point of a circle.

/// Cosine and sine of an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CosineSine {
    pub(super) cos: f64,
    pub(super) sin: f64,
}

impl CosineSine {
    /// Returns the sine and the cosine of an angle in radians.
    pub(super) fn of(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }
}
