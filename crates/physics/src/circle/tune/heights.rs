//! The remaining glitch of a value list on the circles for which it is tuned.

/// The glitch in µm on each circle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Heights(pub(in crate::circle) Vec<f64>);

/// The exponent of the norm that approximates the largest glitch if a search needs a smooth value.
const SMOOTH: i32 = 16;

impl Heights {
    /// Returns a list that has lost before every circle was driven.
    pub(super) fn lost() -> Self {
        Self(vec![f64::INFINITY])
    }

    /// Returns the largest.
    pub(crate) fn worst_um(&self) -> f64 {
        self.0.iter().copied().fold(0.0, f64::max)
    }

    /// Returns the mean.
    pub(crate) fn mean_um(&self) -> f64 {
        #[allow(clippy::cast_precision_loss)] // a few circles
        let count = self.0.len().max(1) as f64;
        self.0.iter().sum::<f64>() / count
    }

    /// Returns a value between both that is close to the largest and decreases with each of them.
    pub(crate) fn smooth_um(&self) -> f64 {
        let worst = self.worst_um();
        if !worst.is_finite() || worst <= 0.0 {
            return worst;
        }
        let parts = Self(self.0.iter().map(|it| (it / worst).powi(SMOOTH)).collect());
        worst * parts.mean_um().powf(1.0 / f64::from(SMOOTH))
    }
}
