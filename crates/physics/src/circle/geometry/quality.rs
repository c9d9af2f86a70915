//! Noise and resolution of recorded points.

use super::profile::{Quality, UM_PER_M};

/// Returns the noise of single samples from their third differences, and the smallest step of the coordinates, for
/// points in mm around a centre.
pub(crate) fn quality(points: &[[f64; 2]], centre: [f64; 2]) -> Quality {
    /// Factor from the median of deviations to a standard deviation.
    const NORMAL: f64 = 1.4826;
    const UM_PER_MM: f64 = UM_PER_M / 1000.0;
    let radii: Vec<f64> = points
        .iter()
        .map(|[x, y]| (x - centre[0]).hypot(y - centre[1]) * UM_PER_MM)
        .collect();
    let mut thirds: Vec<f64> = radii
        .windows(4)
        .map(|it| (it[3] - 3.0 * it[2] + 3.0 * it[1] - it[0]).abs())
        .collect();
    let middle = thirds.len() / 2;
    let median = if thirds.is_empty() {
        0.0
    } else {
        *thirds.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let moves = points
        .windows(2)
        .flat_map(|pair| [0, 1].map(|axis| (pair[1][axis] - pair[0][axis]).abs() * UM_PER_MM));
    let step = moves.filter(|it| *it > 1e-4).fold(f64::INFINITY, f64::min);
    Quality {
        // The squares of 1, 3, 3, 1 add up to 20.
        noise_um: NORMAL * median / 20.0_f64.sqrt(),
        step_um: if step.is_finite() { step } else { 0.0 },
        samples: points.len(),
        drift: None,
    }
}
