//! The two questions that most hosts ask, each in one call. For more, such as several programs in one
//! session or a saved state, use [`Session`] itself.

use std::ops::ControlFlow;

use crate::interpreter::{Finder, NoFiles, StopPolicy};
use crate::machine::Machine;
use crate::session::{Findings, Program, Session, SessionOptions};
use crate::text::SourceFile;
use crate::timeline::Sink;

/// Runs a program from the start of the control, passes its records to `sink`, and returns the session with the state
/// that the program leaves.
///
/// ```
/// use frictcomp::comp::Kind;
/// use frictcomp::machine::Machine;
/// use frictcomp::session::Findings;
/// use frictcomp::text::SourceFile;
///
/// let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
/// let mut findings = Findings::default();
/// let session = frictcomp::run(program, Machine::enabled(["X"]), &mut findings);
/// let state = session.state();
/// let (x, _) = state.axes().next().expect("the only axis");
/// assert_eq!(state.state(x, Kind::Frict).as_str(), "inactive");
/// ```
pub fn run(program: SourceFile, machine: Machine, sink: &mut dyn Sink) -> Session {
    let session = Session::new(machine, SessionOptions::default());
    run_in(session, program, &mut NoFiles, sink)
}

/// Runs a program from the start of the control and returns every message about it once, in text order. A failing
/// command is passed over, so that the rest of the program is checked.
///
/// ```
/// use frictcomp::machine::Machine;
/// use frictcomp::interpreter::NoFiles;
/// use frictcomp::session::SessionOptions;
/// use frictcomp::text::SourceFile;
///
/// let program = SourceFile::new("a.nc", "N10 Y[COMP ON FRICT]\nN20 M30\n");
/// let (machine, options) = (Machine::enabled(["X"]), SessionOptions::default());
/// let findings = frictcomp::check(program, machine, options, &mut NoFiles);
/// let codes: Vec<&str> = findings.diagnostics().map(|said| said.code.as_str()).collect();
/// assert_eq!(codes, ["P-ERR-70495"]);
/// ```
pub fn check(
    program: SourceFile,
    machine: Machine,
    options: SessionOptions,
    finder: &mut dyn Finder,
) -> Findings {
    let mut findings = Findings::default();
    let run = options.run.with_stop(StopPolicy::CheckAll);
    let options = options.with_run(run);
    let session = Session::new(machine, options);
    run_in(session, program, finder, &mut findings);
    findings
}

/// Runs one program in a session, from the session record to the summary.
fn run_in(
    mut session: Session,
    program: SourceFile,
    finder: &mut dyn Finder,
    sink: &mut dyn Sink,
) -> Session {
    let name = program.name().clone();
    let mut flow = session.begin(&[], sink);
    if flow.is_continue() {
        flow = match session.program(&name, Program::Whole(program), finder, sink) {
            ControlFlow::Continue(_) => ControlFlow::Continue(()),
            ControlFlow::Break(()) => ControlFlow::Break(()),
        };
    }
    if flow.is_continue() {
        let _ = session.finish(sink);
    }
    session
}
