//! The radial deviations as CSV.

use serde_json::json;

use super::subject::CircleReport;
use crate::wording::push_row;
use frictcomp_physics::circle::UM_PER_M;

/// Rows of the CSV per turn: one every 0.1°.
const ROWS: usize = 3600;

/// Returns the radial deviations: a row every 0.1° for each path.
pub fn render_csv(report: &CircleReport) -> String {
    let mut out = Vec::from("compensation,direction,angle_deg,deviation_um\n");
    for side in &report.sides {
        for (direction, profile) in side.side.paths.iter() {
            let deviations = profile.deviations_m();
            let deviations = deviations.iter().step_by(deviations.len() / ROWS);
            for (row, deviation) in deviations.enumerate() {
                #[allow(clippy::cast_precision_loss)] // at most 3600
                let angle = row as f64 / 10.0;
                let deviation_um = deviation * UM_PER_M;
                push_row(
                    &mut out,
                    &[
                        json!(side.name),
                        json!(direction),
                        json!(angle),
                        json!(deviation_um),
                    ],
                );
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}
