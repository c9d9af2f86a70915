//! The bound on the parsing steps of a block (R12.16). It applies to the whole process, so the test has its own
//! process.

use std::num::NonZeroUsize;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::interpreter::{NoFiles, Options, StopPolicy};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::{diagnostic::Code, session::Findings};

#[test]
fn a_block_that_takes_too_many_steps_is_not_understood_and_may_do_anything() {
    // R12.16 R2.70
    pest::set_call_limit(NonZeroUsize::new(2_000));
    let long = format!("P1=1{}", "+1".repeat(500));
    let text = format!("X[COMP ON FRICT]\n{long}\nG1 X1 F100\nM30\n");
    let options = Options::default().with_stop(StopPolicy::CheckAll);
    let mut session = Session::new(Machine::enabled(["X"]), SessionOptions::from(options));
    let mut findings = Findings::default();
    let source = SourceFile::new("a.nc", text);
    let program = Program::Whole(source);
    let flow = session.program("a.nc", program, &mut NoFiles, &mut findings);
    assert!(flow.is_continue());
    let said: Vec<_> = findings
        .diagnostics()
        .map(|said| (said.code, said.place.first_line))
        .collect();
    assert!(said.contains(&(Code::Fc913, 2)), "{said:?}");
    let state = session.state().state(AxisIndex::new(0), Kind::Frict);
    assert_eq!(state, State::Unknown);
}
