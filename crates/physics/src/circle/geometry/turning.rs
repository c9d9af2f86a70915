//! The direction of a point of a circle.

/// Cosine and sine of an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CosineSine {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
}

impl CosineSine {
    /// Returns the sine and the cosine of an angle in radians.
    pub(crate) fn of(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }
}
