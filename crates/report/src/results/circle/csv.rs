//! The radial deviations as CSV.

use crate::wording::rounded;
use std::fmt::Write as _;

use super::subject::CircleReport;
use frictcomp_physics::circle::UM_PER_M;

/// Rows of the CSV per turn: one every 0.1°.
const ROWS: usize = 3600;

/// The radial deviations: a row every 0.1° for each path.
pub fn render_csv(report: &CircleReport) -> String {
    let mut out = String::from("compensation,direction,angle_deg,deviation_um\n");
    for side in &report.sides {
        for (direction, profile) in side.side.paths.iter() {
            let deviations = profile.deviations_m();
            for (row, deviation) in deviations
                .iter()
                .step_by(deviations.len() / ROWS)
                .enumerate()
            {
                #[allow(clippy::cast_precision_loss)] // at most 3600
                let angle = row as f64 / 10.0;
                let deviation = rounded(deviation * UM_PER_M);
                let _ = writeln!(out, "{},{direction},{angle},{deviation}", side.name);
            }
        }
    }
    out
}
