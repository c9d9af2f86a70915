//! A session with small budgets, so that an input costs milliseconds.

use frictcomp::interpreter::{Limits, Options, StopPolicy};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::syntax::SkipLevels;
use frictcomp::text::TextLines;
use frictcomp::timeline::Sink;

use crate::{Files, MAIN};

/// Every policy for errors.
pub const POLICIES: [StopPolicy; 3] = [
    StopPolicy::FirstError,
    StopPolicy::KeepGoing,
    StopPolicy::CheckAll,
];

/// Returns a machine with two axes that may be switched, and others that may not.
pub fn machine() -> Machine {
    Machine::enabled(["X", "Y"])
}

/// Programs and their options.
#[derive(Debug, Clone, Copy)]
pub struct Bench<'a> {
    pub files: Files<'a>,
    pub stop: StopPolicy,
}

impl Bench<'_> {
    pub fn options(self) -> SessionOptions {
        let limits = Limits::default()
            .with_blocks(100)
            .with_work(50_000)
            .with_values(1000)
            .with_calls(5)
            .with_nesting(8)
            .with_macros(4);
        let options = Options::default()
            .with_stop(self.stop)
            .with_skip(SkipLevels::NONE.with(1))
            .with_limits(limits);
        SessionOptions::from(options)
    }

    /// Runs the whole text from memory.
    pub fn whole(mut self, session: &mut Session, sink: &mut dyn Sink) {
        let program = Program::Whole(self.files.source());
        let _ = session.program(MAIN, program, &mut self.files, sink);
    }

    /// Runs the text line by line.
    pub fn streamed(mut self, session: &mut Session, sink: &mut dyn Sink) {
        let mut lines = TextLines::new(self.files.main);
        let _ = session.program(MAIN, Program::Lines(&mut lines), &mut self.files, sink);
    }

    /// Begins a session, runs the text in it, and finishes it.
    pub fn session(self, session: &mut Session, sink: &mut dyn Sink) {
        let _ = session.begin(&[], sink);
        self.whole(session, sink);
        self.streamed(session, sink);
        let _ = session.finish(sink);
    }
}
