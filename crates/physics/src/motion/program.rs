//! The commanded trace of the programs of a session.

use std::ops::ControlFlow;

use super::planner::{PlannerOptions, TrajectoryPlanner};
use super::rounding::Transitions;
use super::trace::TraceSink;
use frictcomp::comp::AxisIndex;
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::machine::Machine;
use frictcomp::timeline::{Record, Sink};

/// Makes the commanded trace of some axes from the records of a session, which must include the motions
/// of blocks ([`Motions::Taken`](frictcomp::interpreter::Motions::Taken)).
///
/// ```
/// use std::ops::ControlFlow;
/// use std::sync::Arc;
///
/// use frictcomp::machine::Machine;
/// use frictcomp_physics::motion::{Cause, PlannerOptions, ProgramTrace, Sample, TraceSink};
/// use frictcomp::interpreter::{Motions, NoFiles, Options};
/// use frictcomp::session::{Program, Session, SessionOptions};
/// use frictcomp::text::SourceFile;
///
/// /// The highest velocity of the path, and the line where it is reached.
/// #[derive(Default)]
/// struct Fastest(f64, u32);
///
/// impl TraceSink for Fastest {
///     fn begin(&mut self, _time_s: f64, _cause: &Arc<Cause>) -> ControlFlow<()> {
///         ControlFlow::Continue(())
///     }
///
///     fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
///         if sample.path_velocity > self.0 {
///             *self = Self(sample.path_velocity, sample.cause.line);
///         }
///         ControlFlow::Continue(())
///     }
/// }
///
/// let machine = Machine::enabled(["X"]);
/// let followed = [machine.find("X").expect("the axis")];
/// let mut trace = ProgramTrace::new(
///     &machine,
///     &followed,
///     PlannerOptions::default(),
///     Fastest::default(),
/// );
/// let options = SessionOptions::from(Options::default().with_motions(Motions::Taken))
///     .with_start(vec![("X".to_owned(), 0.0)]);
/// let mut session = Session::new(machine, options);
/// let program = SourceFile::new("a.nc", "G01 X1 F600\nX40 F1200\nM30\n");
/// let _ = session.program("a.nc", Program::Whole(program), &mut NoFiles, &mut trace);
/// trace.finish();
/// assert_eq!((trace.sink().0.round(), trace.sink().1), (20.0, 2));
/// ```
pub struct ProgramTrace<S> {
    planner: TrajectoryPlanner,
    sink: S,
    errors: Vec<Diagnostic>,
    /// Messages on stretches that only the machine decides.
    undecided: Vec<Diagnostic>,
    is_cut_short: bool,
    over: ControlFlow<()>,
}

impl<S: TraceSink> ProgramTrace<S> {
    /// Returns the trace of some axes of a machine, before the first program.
    pub fn new(
        machine: &Machine,
        followed: &[AxisIndex],
        options: PlannerOptions,
        sink: S,
    ) -> Self {
        Self {
            planner: TrajectoryPlanner::new(machine, followed, options),
            sink,
            errors: Vec::new(),
            undecided: Vec::new(),
            is_cut_short: false,
            over: ControlFlow::Continue(()),
        }
    }

    /// Notes stretches that only the machine decides, each once; an `allow` comment does not decide them.
    fn note_undecided(&mut self, reported: &[Diagnostic]) {
        for said in reported.iter().filter(|said| is_undecided(said)) {
            let is_known =
                |known: &Diagnostic| known.code == said.code && known.place == said.place;
            if self.undecided.len() < MAX_UNDECIDED && !self.undecided.iter().any(is_known) {
                self.undecided.push(said.clone());
            }
        }
    }

    /// Ends the session: the rest of the trace is given out. `Break` if the sink took no more.
    pub fn finish(&mut self) -> ControlFlow<()> {
        if self.over.is_continue() {
            self.over = self.planner.finish(&mut self.sink);
        }
        std::mem::replace(&mut self.over, ControlFlow::Break(()))
    }

    /// Returns the errors that the session reported and why it stopped a program, then the messages about the trace.
    pub fn diagnostics(&self) -> (&[Diagnostic], &[Diagnostic]) {
        (&self.errors, self.planner.diagnostics())
    }

    /// Returns the first messages on stretches that only the machine decides, which are not driven (R14.8).
    pub fn undecided(&self) -> &[Diagnostic] {
        &self.undecided
    }

    /// Returns whether a budget stopped a program, as an endless loop does (FC910): the rest is not known.
    pub fn is_cut_short(&self) -> bool {
        self.is_cut_short
    }

    /// Returns the treatment of the transitions between feed moves.
    pub fn transitions(&self) -> Transitions {
        self.planner.transitions()
    }

    /// Returns the number of motions that the trace leaves out.
    pub fn left_out(&self) -> u64 {
        self.planner.left_out()
    }

    /// Returns the number of those that are not known to be rapid moves.
    pub fn left_out_feed(&self) -> u64 {
        self.planner.left_out_feed()
    }

    /// Returns the places of the first of these, as `part.nc:8`.
    pub fn left_out_feed_at(&self) -> &[String] {
        self.planner.left_out_feed_at()
    }

    /// Returns the receiver of the trace.
    pub fn sink_ref(&self) -> &S {
        &self.sink
    }

    /// Returns the receiver of the trace.
    pub fn sink(&mut self) -> &mut S {
        &mut self.sink
    }

    /// Ends the trace where it is, and returns its receiver.
    pub fn into_sink(self) -> S {
        self.sink
    }
}

/// Most stretches that are named.
const MAX_UNDECIDED: usize = 10;

/// Returns whether a message is about blocks that only the machine decides.
fn is_undecided(said: &Diagnostic) -> bool {
    matches!(said.code, Code::Fc901 | Code::Fc902 | Code::Fc908)
}

impl<S: TraceSink> Sink for ProgramTrace<S> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        let error = |said: &&Diagnostic| said.severity == Severity::Error;
        match *record {
            Record::Machine(said) => self.errors.extend(Some(said).filter(error).cloned()),
            Record::Block(ref row) => {
                self.errors
                    .extend(row.diagnostics.iter().filter(error).cloned());
                self.note_undecided(row.reported);
                self.over = self.planner.block(row, &mut self.sink);
            }
            Record::End(ref end) => {
                let notes = end.notes.iter().map(|note| &note.diagnostic);
                for said in notes.clone() {
                    self.note_undecided(std::slice::from_ref(said));
                }
                let notes = notes.filter(|said| error(said) || said.code.is_budget());
                self.errors.extend(notes.cloned());
                self.is_cut_short |= end.by == EndedBy::Budget;
            }
            _ => {}
        }
        self.over
    }
}
