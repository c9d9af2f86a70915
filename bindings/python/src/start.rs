//! Where axes stand at first.

use frictcomp_host::LoadedMachine;

use crate::failure::Failure;

/// The places that were given, of axes of the machine, in mm or degrees.
pub(crate) fn positions(
    given: &[(String, f64)],
    loaded: &LoadedMachine,
) -> Result<Vec<(String, f64)>, Failure> {
    for (name, position) in given {
        if loaded.machine.find(name).is_none() || !position.is_finite() {
            return Err(
                Failure::new(format!("axis `{name}` cannot start at {position}"))
                    .with_help("give axes of the machine with positions in mm or degrees"),
            );
        }
    }
    Ok(given.to_vec())
}
