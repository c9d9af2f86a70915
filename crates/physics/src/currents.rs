//! The computation of currents that most hosts need, in one call.

use std::ops::ControlFlow;

use frictcomp::interpreter::{Motions, NoFiles, Options};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;

use crate::current::{CurrentCycle, CurrentOptions, FollowError, ProgramCurrents, axes_to_follow};

/// Runs a program from the start of the control and passes the additive currents of some axes to
/// `sink`, CNC cycle by CNC cycle, until it breaks.
///
/// # Errors
/// The machine has no axis of a name, or no value list for it.
pub fn currents(
    program: SourceFile,
    machine: Machine,
    axes: &[String],
    sink: impl FnMut(&CurrentCycle<'_>) -> ControlFlow<()>,
) -> Result<(), FollowError> {
    let followed = axes_to_follow(axes, &machine)?;
    let options = CurrentOptions::default();
    let mut currents = ProgramCurrents::new(&machine, &followed, options, sink);
    let options = SessionOptions::from(Options::default().with_motions(Motions::Taken));
    let mut session = Session::new(machine, options);
    let name = program.name().clone();
    if session.begin(&[], &mut currents).is_continue() {
        let _ = session.program(&name, Program::Whole(program), &mut NoFiles, &mut currents);
    }
    currents.finish();
    Ok(())
}
