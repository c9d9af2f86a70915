//! One controller session: programs that run one after the other on one machine.
//!
//! The state that one program leaves is the state that the next one starts with.

mod desk;
mod said;
mod saved;

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

pub use saved::{SavedAxis, SavedState, StateError};

use crate::compensation::Compensation;
use crate::diagnostic::{Diagnostic, Levels, Place, Severity};
use crate::interpreter::{Event, Interpreter, Options, Outlook};
pub use crate::interpreter::{
    Finder, Limits, Motions, NoFiles, NoProgram, NoteKind, Notes, StopPolicy,
};
use crate::lint::Linter;
use crate::machine::{AxisIndex, Machine, Parameterisation, Setting};
use crate::source::{LineSource, SourceFile};
use crate::syntax::Kind;
use crate::timeline::{AxisSummary, EndedBy, Record, Sink, StateView, Summary};
use desk::{Desk, NoteBook, Tally};
use said::Said;
use saved::{difference, fingerprint};

/// How a session runs.
#[derive(Debug, Clone, Default)]
pub struct SessionOptions {
    /// What happens at an error.
    pub stop: StopPolicy,
    /// The levels of blocks that are skipped, bit 1 for `/` and `/1`, up to bit 10 (R2.3).
    pub skip: u16,
    /// Budgets.
    pub limits: Limits,
    /// The user's severities.
    pub levels: Levels,
    /// Values of variables that only the machine knows.
    pub settings: Vec<(String, Setting)>,
    /// Whether notes are taken, for [`Session::notes`].
    pub notes: Notes,
    /// Whether rows say what their block moves.
    pub motions: Motions,
}

/// The text of a program.
pub enum Program<'a> {
    /// Lines that come one after another. Behind the first block that can be reached again the rest
    /// is taken into memory; what keeps that rest from running is found only there, see
    /// [`crate::source::FlowScan`].
    Lines(&'a mut dyn LineSource),
    /// The whole text. What keeps it from running is found before its first block.
    Whole(SourceFile),
}

/// One controller session.
///
/// ```
/// use std::ops::ControlFlow;
/// use frictcomp::machine::Machine;
/// use frictcomp::session::{NoFiles, Program, Session, SessionOptions};
/// use frictcomp::source::SourceFile;
/// use frictcomp::timeline::{Record, Sink};
///
/// struct Count(usize);
/// impl Sink for Count {
///     fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
///         if let Record::Block(row) = record {
///             self.0 += row.changes.len();
///         }
///         ControlFlow::Continue(())
///     }
/// }
///
/// let mut session = Session::new(Machine::enabled(["X"]), SessionOptions::default());
/// let mut count = Count(0);
/// let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
/// let _ = session.program("a.nc", Program::Whole(program), &mut NoFiles, &mut count);
/// assert_eq!(count.0, 1);
/// ```
pub struct Session {
    machine: Arc<Machine>,
    interpreter: Interpreter,
    levels: Levels,
    /// The state that the session began with.
    start: Compensation,
    programs: u32,
    stopped: bool,
    tally: Tally,
    notes: NoteBook,
}

impl Session {
    /// A session right after the start of the control.
    pub fn new(machine: Machine, options: SessionOptions) -> Self {
        let machine = Arc::new(machine);
        let compensation = Compensation::at_startup(&machine);
        let run = Options {
            stop: options.stop,
            skip: options.skip,
            limits: options.limits,
            notes: options.notes,
            motions: options.motions,
            ..Options::default()
        };
        let mut interpreter = Interpreter::new(Arc::clone(&machine), compensation.clone(), run);
        for (name, setting) in &options.settings {
            interpreter.set(name, setting);
        }
        let axes = machine.axes.len();
        Self {
            machine,
            interpreter,
            levels: options.levels,
            start: compensation,
            programs: 0,
            stopped: false,
            tally: Tally {
                blocks: 0,
                counts: BTreeMap::new(),
                changed_by: vec![Vec::new(); axes],
                changes: vec![0; axes],
            },
            notes: NoteBook::new(),
        }
    }

    /// A session that goes on where another one ended. Returns also what the control says about
    /// lists that changed since (P-ERR-110641).
    ///
    /// # Errors
    /// A state of another schema or machine.
    pub fn resume(
        mut machine: Machine,
        options: SessionOptions,
        saved: SavedState,
    ) -> Result<(Self, Vec<Diagnostic>), StateError> {
        if saved.schema != 1 {
            return Err(StateError::Schema {
                found: saved.schema,
            });
        }
        let here = fingerprint(&machine);
        if let Some(difference) = difference(&saved.machine, &here) {
            return Err(StateError::OtherMachine { difference });
        }
        let mut said = Vec::new();
        for (axis, saved) in machine.axes.iter_mut().zip(&saved.axes) {
            if let Some(diagnostic) = axis.check_max_points(saved.max_points) {
                said.push(diagnostic);
                axis.max_points = saved.max_points;
                axis.friction = match &saved.friction {
                    Some(list) => Parameterisation::Accepted(list.clone()),
                    None => Parameterisation::Missing,
                };
            }
        }
        let mut session = Self::new(machine, options);
        let mut compensation = session.start.clone();
        for (position, axis) in saved.axes.iter().enumerate().take(compensation.len()) {
            compensation.restore(AxisIndex::new(position), axis.selected, axis.unknown);
        }
        session.interpreter.set_compensation(compensation.clone());
        session.start = compensation;
        for (name, value) in saved.variables {
            session.interpreter.set_shared(&name, value);
        }
        Ok((session, said))
    }

    /// The state of the moment.
    pub fn state(&self) -> StateView<'_> {
        StateView {
            machine: &self.machine,
            compensation: self.interpreter.compensation(),
            listed: self.interpreter.occurred(),
            version: self.interpreter.version(),
        }
    }

    /// What the programs needed from the machine, or what was passed over: names with their places,
    /// sorted, each once, 100 000 of them at most. Empty unless [`SessionOptions::notes`] asks for them.
    pub fn notes(&self, kind: NoteKind) -> impl Iterator<Item = (&str, &Place)> {
        self.notes
            .iter()
            .filter(move |((of, ..), _)| *of == kind)
            .map(|((_, name, ..), place)| (name.as_str(), place))
    }

    /// The interpreter, for positions and modal state.
    pub fn interpreter(&self) -> &Interpreter {
        &self.interpreter
    }

    /// Says what the session starts with, and what the control says about its lists.
    pub fn begin(&mut self, lists: &[Diagnostic], sink: &mut dyn Sink) -> ControlFlow<()> {
        sink.record(&Record::Session {
            state: self.state(),
        })?;
        for diagnostic in lists {
            self.tally.count(diagnostic);
            sink.record(&Record::Machine(diagnostic))?;
        }
        ControlFlow::Continue(())
    }

    /// Runs one program. `Break` when the sink wants no more.
    pub fn program(
        &mut self,
        file: &str,
        program: Program<'_>,
        finder: &mut dyn Finder,
        sink: &mut dyn Sink,
    ) -> ControlFlow<(), EndedBy> {
        self.programs += 1;
        let machine = Arc::clone(&self.machine);
        let mut desk = Desk {
            machine: &machine,
            levels: &self.levels,
            linter: Linter::new(&machine, self.interpreter.compensation(), &self.start),
            tally: &mut self.tally,
            notes: &mut self.notes,
            sink,
            program: self.programs,
            file,
            said: Vec::new(),
            before: Said::default(),
            allows: HashMap::new(),
            here: Vec::new(),
            broken: false,
        };
        let mut listen = |event: Event<'_>| desk.event(event);
        let outlook = match program {
            Program::Lines(lines) => self.interpreter.stream(file, lines, finder, &mut listen),
            Program::Whole(source) => self.interpreter.program(source, finder, &mut listen),
        };
        match outlook {
            Outlook::Ended(by) if !desk.broken => {
                self.stopped |= matches!(by, EndedBy::Error | EndedBy::Budget);
                ControlFlow::Continue(by)
            }
            _ => ControlFlow::Break(()),
        }
    }

    /// Whether an error stopped the session, so that no further program may run (R9.20).
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// How many diagnostics were said at each severity.
    pub fn counts(&self) -> &BTreeMap<Severity, u64> {
        &self.tally.counts
    }

    /// Says the summary.
    pub fn finish(&mut self, sink: &mut dyn Sink) -> ControlFlow<()> {
        let state = self.state();
        let axes = state.axes().map(|(axis, _)| AxisSummary {
            axis,
            start: self.start.state(axis, Kind::Frict),
            end: state.state(axis, Kind::Frict),
            changed_by: self.tally.changed_by[axis.get()].clone(),
            changes: self.tally.changes[axis.get()],
        });
        sink.record(&Record::Summary(&Summary {
            programs: self.programs,
            blocks: self.tally.blocks,
            counts: self.tally.counts.clone(),
            opaque: self.interpreter.opaque(),
            axes: axes.collect(),
            state,
        }))
    }

    /// What the next session starts with.
    pub fn save(&self) -> SavedState {
        let compensation = self.interpreter.compensation();
        let axes = self
            .machine
            .axes
            .iter()
            .enumerate()
            .map(|(position, axis)| {
                let index = AxisIndex::new(position);
                SavedAxis {
                    axis: axis.name.clone(),
                    selected: compensation.selected(index),
                    unknown: compensation.unknown(index),
                    max_points: axis.max_points,
                    friction: match &axis.friction {
                        Parameterisation::Accepted(list) => Some(list.clone()),
                        _ => None,
                    },
                }
            });
        SavedState {
            schema: 1,
            machine: fingerprint(&self.machine),
            axes: axes.collect(),
            variables: self.interpreter.shared_variables(),
        }
    }
}
