//! Readings of open questions between programs, and what confirms them.

use frictcomp::comp::{AxisIndex, CncBuild, Kind, State};
use frictcomp::machine::Machine;
use frictcomp::readings::{Basis, Question};
use frictcomp::session::Session;

use crate::support::{Bench, MACHINE};

/// Returns the state of X after a program that switches it off, something between, and an empty program.
fn state_after(reading: &str, between: fn(&mut Session)) -> State {
    let bench = Bench::on(&format!("{MACHINE}[reading]\n{reading}\n"));
    let mut session = bench.session();
    bench.run_in(&mut session, &["X[COMP OFF FRICT]\nM30"]);
    between(&mut session);
    bench.run_in(&mut session, &["M30"]);
    session.state().state(AxisIndex::new(0), Kind::Frict)
}

#[test]
fn a_reset_and_a_restart_follow_their_readings() {
    // R1.28 R1.29 R15.2
    let reset = |reading| state_after(reading, Session::reset);
    assert_eq!(reset(""), State::Inactive);
    assert_eq!(reset("\"R1.28\" = \"kept\""), State::Inactive);
    assert_eq!(reset("\"R1.28\" = \"start-up\""), State::Active);
    let restart = |reading| state_after(reading, Session::restart);
    assert_eq!(restart(""), State::Active);
    assert_eq!(restart("\"R1.29\" = \"kept\""), State::Inactive);
}

#[test]
fn block_search_is_a_question() {
    // R2.96: the dry run begins at the first block; the effect of a block search is one of the questions.
    let facts = Question::BlockSearch.facts();
    assert_eq!((facts.rule, facts.assumed_name()), ("R2.96", "unknown"));
}

#[test]
fn a_confirmation_applies_to_its_build() {
    // R15.2
    let text = "[reading]\n\"R1.28\" = \"start-up\"\n[confirmed]\n\
        \"R1.28\" = { build = \"V3.1.3081.5\", date = \"2026-01-31\" }\n";
    let readings = Machine::from_toml(text).expect("a configuration").readings;
    let build: CncBuild = "3.1.3081.5".parse().expect("a build");
    let standing = readings.basis(Question::Reset, Some(build));
    assert!(matches!(standing, Basis::Confirmed(it) if it.date == "2026-01-31"));
    assert_eq!(readings.basis(Question::Reset, None), Basis::Selected);
    assert_eq!(readings.basis(Question::Restart, None), Basis::Assumed);
}
