//! Properties of a machine that a simulation leaves out.

use frictcomp_physics::simulation::DriveParameters;

use super::table::differences;

/// Returns what the simulation of these drives leaves out, the rows `simulation` of the table of differences.
/// This includes backlash if no drive has any.
pub fn not_modelled<'a>(
    drives: impl IntoIterator<Item = &'a DriveParameters>,
) -> Vec<&'static str> {
    let has_backlash = drives.into_iter().any(|it| it.backlash_m > 0.0);
    let rows = differences().iter().filter(|it| it.kind == "simulation");
    rows.map(|it| it.what.as_str())
        .filter(|&what| !(has_backlash && what == "backlash"))
        .collect()
}

/// Returns the line that names it.
pub(crate) fn not_modelled_line(what: &[&str]) -> String {
    format!("not modelled: {}", what.join(", "))
}
