//! One controller session: programs that run one after the other on one machine.
//!
//! Each program starts with the state that the one before it leaves.

mod findings;
mod recorder;
mod saved;
mod totals;

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

pub use findings::Causes;
pub use findings::undescribed;
pub use findings::{Findings, ProposedFixes, SafeFixes, allow_here};
pub use saved::{STATE_SCHEMA, SavedAway, SavedAxis, SavedState, StateError};

use crate::comp::{AxisIndex, Compensation, Kind};
use crate::diagnostic::{Diagnostic, Levels, MAX_MESSAGES, Severity, Wording};
use crate::interpreter::{EndedBy, Finder, Interpreter, NoteKind, Options, RunOutcome, Value};
pub use crate::lint::Maker;
use crate::lint::{LeftAwayNotice, Linter, SessionStates};
use crate::machine::{AxisSet, Machine, Parameterisation, Setting};
use crate::syntax::VariableName;
use crate::text::{LineSource, Place, SourceFile};
use crate::timeline::{AxisSummary, Record, Sink, StateView, Summary};
use findings::MessageDedup;
use recorder::{NoteBook, Recorder};
use saved::{fingerprint, storable};
use totals::SessionTotals;

/// Options of a session.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SessionOptions {
    /// Options of its programs.
    pub run: Options,
    /// The user's severities.
    pub levels: Levels,
    /// Values of variables that only the machine knows.
    pub settings: Vec<(String, Setting)>,
    /// Positions of axes before the first program, by their names, in mm or degrees.
    pub start: Vec<(String, f64)>,
    /// The axes that a look ahead found the programs to switch, proposed where no machine is
    /// described (R1.37).
    pub switched: Vec<String>,
    /// Wording of advice; `None` for the general words.
    pub wording: Option<Wording>,
}

impl SessionOptions {
    /// Sets [`run`](Self::run).
    pub fn with_run(mut self, run: Options) -> Self {
        self.run = run;
        self
    }

    /// Sets [`levels`](Self::levels).
    pub fn with_levels(mut self, levels: Levels) -> Self {
        self.levels = levels;
        self
    }

    /// Sets [`settings`](Self::settings).
    pub fn with_settings(mut self, settings: Vec<(String, Setting)>) -> Self {
        self.settings = settings;
        self
    }

    /// Sets [`start`](Self::start).
    pub fn with_start(mut self, start: Vec<(String, f64)>) -> Self {
        self.start = start;
        self
    }

    /// Sets [`switched`](Self::switched).
    pub fn with_switched(mut self, switched: Vec<String>) -> Self {
        self.switched = switched;
        self
    }

    /// Sets [`wording`](Self::wording).
    pub fn with_wording(mut self, wording: Option<Wording>) -> Self {
        self.wording = wording;
        self
    }
}

impl From<Options> for SessionOptions {
    /// Options of a session whose programs run with these options.
    fn from(run: Options) -> Self {
        Self::default().with_run(run)
    }
}

/// The text of a program.
#[non_exhaustive]
pub enum Program<'a> {
    /// Lines, one after another. After the first block that can be reached again the rest
    /// is taken into memory; what keeps that rest from running is found only there, see
    /// [`crate::syntax::FlowScan`].
    Lines(&'a mut dyn LineSource),
    /// The whole text. What keeps it from running is found before its first block.
    Whole(SourceFile),
}

impl Program<'_> {
    /// Returns the beginning of the text that is available so far.
    fn head(&mut self) -> &str {
        match self {
            Self::Lines(lines) => lines.ahead(),
            Self::Whole(source) => source.text(),
        }
    }
}

/// One controller session.
///
/// ```
/// use std::ops::ControlFlow;
/// use frictcomp::machine::Machine;
/// use frictcomp::interpreter::NoFiles;
/// use frictcomp::session::{Program, Session, SessionOptions};
/// use frictcomp::text::SourceFile;
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
    states: SessionStates,
    /// The variables that the user gave.
    given: BTreeMap<VariableName, Value>,
    remark: Option<String>,
    wording: Option<Wording>,
    programs: u32,
    stopped: bool,
    totals: SessionTotals,
    notes: NoteBook,
}

impl Session {
    /// Returns a session right after the start of the control.
    pub fn new(machine: Machine, options: SessionOptions) -> Self {
        let machine = Arc::new(machine);
        let compensation = machine.compensation();
        let mut interpreter =
            Interpreter::new(Arc::clone(&machine), compensation.clone(), options.run);
        let mut given = BTreeMap::new();
        for (name, setting) in &options.settings {
            interpreter.set(name, setting);
            given.insert(VariableName::read(name), setting.into());
        }
        for (name, position) in &options.start {
            interpreter.place(name, *position);
        }
        interpreter.here.havoc_start();
        let start = interpreter.compensation().clone();
        Self {
            remark: undescribed(&machine, &options.switched)
                .map(|advice| advice.in_words(options.wording)),
            wording: options.wording,
            interpreter,
            levels: options.levels,
            states: SessionStates::new(compensation),
            given,
            start,
            programs: 0,
            stopped: false,
            totals: SessionTotals::of(&machine),
            machine,
            notes: NoteBook::default(),
        }
    }

    /// Continues where another session ended. Also returns the control's messages about lists that
    /// changed since (P-ERR-110641).
    ///
    /// # Errors
    /// A state of another schema or machine.
    pub fn resume(
        mut machine: Machine,
        options: SessionOptions,
        saved: SavedState,
    ) -> Result<(Self, Vec<Diagnostic>), StateError> {
        saved.check(&machine)?;
        let mut said = Vec::new();
        for axis in &mut machine.axes {
            let Some(saved) = saved.axes.iter().find(|saved| saved.axis == axis.name) else {
                continue;
            };
            if let Some(diagnostic) = axis.check_max_points(saved.max_points) {
                said.push(diagnostic);
                axis.max_points = saved.max_points;
                axis.friction = match &saved.friction {
                    Some(list) => Parameterisation::Accepted(list.clone()),
                    None => Parameterisation::Missing,
                };
            }
        }
        let start = options.start.clone();
        let mut session = Self::new(machine, options);
        for axis in &saved.axes {
            session.restore(axis, &saved);
        }
        for (name, position) in &start {
            session.interpreter.place(name, *position);
        }
        session.interpreter.set_compensation(session.start.clone());
        session.interpreter.take_over(saved.into_carried());
        Ok((session, said))
    }

    fn restore(&mut self, saved: &SavedAxis, state: &SavedState) {
        let Some(axis) = self.machine.find(&saved.axis) else {
            return;
        };
        if !state.is_assumed_anew(self.machine.axis(axis), &self.machine) {
            self.start.restore(axis, saved.selected, saved.unknown);
            let rewritten = saved.rewritten.unwrap_or_default();
            self.start.restore_rewritten(axis, rewritten);
            self.states.inherit(axis);
        }
        for away in &saved.away {
            if let Some(maker) = &away.by {
                self.states.restore(axis, away.kind, maker.clone());
            }
            if away.allowed {
                self.states
                    .set_notice(axis, away.kind, LeftAwayNotice::Silenced);
            }
        }
        if saved.occurred || saved.position.is_some() {
            self.interpreter.place_axis(axis, saved.position);
        }
    }

    /// Returns the current state.
    pub fn state(&self) -> StateView<'_> {
        StateView {
            machine: &self.machine,
            compensation: self.interpreter.compensation(),
            possible: self.interpreter.possible(),
            listed: self.interpreter.occurred(),
            version: self.interpreter.version(),
        }
    }

    /// Returns the values that the programs needed from the machine, or the words passed over: names with their places,
    /// sorted, each once, 20 000 of them at most. Empty unless [`Options::notes`](crate::interpreter::Options::notes)
    /// asks for them.
    pub fn notes(&self, kind: NoteKind) -> impl Iterator<Item = (&str, &Place)> {
        self.notes
            .notes
            .iter()
            .filter(move |((of, ..), _)| *of == kind)
            .map(|((_, name, ..), place)| (name.as_str(), place))
    }

    /// Returns the number of occurrences that [`Self::notes`] leaves out because there are too many.
    pub fn notes_left_out(&self) -> u64 {
        self.notes.more
    }

    /// Returns the interpreter, for positions and modal state.
    pub fn interpreter(&self) -> &Interpreter {
        &self.interpreter
    }

    /// Lists axes from the start that are known to occur, where no machine is described (R9.74).
    pub fn expect_axes<'a>(&mut self, names: impl IntoIterator<Item = &'a str>) {
        for name in names {
            if let Some(axis) = self.machine.find(name) {
                self.interpreter.expect_axis(axis);
            }
        }
    }

    /// Records what the session starts with, and the control's messages about its lists.
    pub fn begin(&mut self, lists: &[Diagnostic], sink: &mut dyn Sink) -> ControlFlow<()> {
        sink.record(&Record::Session {
            state: self.state(),
            remark: self.remark.as_deref(),
        })?;
        for diagnostic in lists {
            self.totals.count(diagnostic);
            let mut diagnostic = diagnostic.clone();
            diagnostic.reword(self.wording);
            sink.record(&Record::Machine(&diagnostic))?;
        }
        ControlFlow::Continue(())
    }

    /// Runs one program. `Break` when the sink stops.
    pub fn program(
        &mut self,
        file: &str,
        mut program: Program<'_>,
        finder: &mut dyn Finder,
        sink: &mut dyn Sink,
    ) -> ControlFlow<(), EndedBy> {
        self.programs += 1;
        let foreign = findings::look(file, program.head());
        let most = foreign
            .as_ref()
            .map_or(MAX_MESSAGES, |_| findings::MAX_SAID);
        let machine = Arc::clone(&self.machine);
        let mut recorder = Recorder {
            machine: &machine,
            levels: &self.levels,
            wording: self.wording,
            linter: Linter::new(&machine, &mut self.states, file),
            totals: &mut self.totals,
            notes: &mut self.notes,
            sink,
            program: self.programs,
            file,
            said: Vec::new(),
            before: MessageDedup::at_most(most),
            foreign,
            allows: HashMap::new(),
            here: Vec::new(),
            broken: false,
            doubtful: false,
            version: 0,
        };
        let outcome = match program {
            Program::Lines(lines) => self.interpreter.stream(file, lines, finder, &mut recorder),
            Program::Whole(source) => self.interpreter.program(source, finder, &mut recorder),
        };
        match outcome {
            RunOutcome::Ended(by) if !recorder.broken => {
                self.stopped |= matches!(by, EndedBy::Error | EndedBy::Budget);
                ControlFlow::Continue(by)
            }
            _ => ControlFlow::Break(()),
        }
    }

    /// Resets the channel between two programs (R1.28).
    pub fn reset(&mut self) {
        self.interpreter.reset();
        self.stopped = false;
    }

    /// Restarts the control between two programs (R1.29).
    pub fn restart(&mut self) {
        self.interpreter.here.restart();
        self.stopped = false;
    }

    /// Returns whether an error stopped the session, so that no further program may run (R9.20).
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// Returns the number of diagnostics by severity.
    pub fn counts(&self) -> &BTreeMap<Severity, u64> {
        &self.totals.counts
    }

    /// Returns the configured kinds of each axis that were not known at a program's end or where the axis moved
    /// (R2.98), and friction compensation that a program switches on an axis that nothing describes (R18.2).
    pub fn unknown(&self) -> impl Iterator<Item = (&str, Kind)> {
        let unknown = self.totals.unknown.iter();
        unknown.map(|(axis, kind)| (self.machine.axis(*axis).name.as_str(), *kind))
    }

    /// Records the summary.
    pub fn finish(&mut self, sink: &mut dyn Sink) -> ControlFlow<()> {
        let state = self.state();
        let axes = state.axes().map(|(axis, _)| AxisSummary {
            others_away: Kind::ALL
                .into_iter()
                .filter(|kind| *kind != Kind::Frict)
                .filter(|kind| state.state(axis, *kind) != self.states.start_up(axis, *kind))
                .collect(),
            axis,
            start: self.start.state(axis, Kind::Frict),
            end: state.state(axis, Kind::Frict),
            start_up: self.states.start_up(axis, Kind::Frict),
            told: self.states.notice(axis, Kind::Frict) != LeftAwayNotice::No,
            changed_by: self.totals.changed_by[axis.get()].clone(),
            changes: self.totals.changes[axis.get()],
            feed_moves: self.totals.feed_moves.of(axis),
            is_undescribed: self.totals.undescribed.contains_key(&axis),
            is_rewritten: state.compensation.rewritten(axis).contains(Kind::Frict),
        });
        sink.record(&Record::Summary(&Summary {
            programs: self.programs,
            blocks: self.totals.blocks,
            counts: self.totals.counts.clone(),
            opaque: self.interpreter.opaque(),
            axes: axes.collect(),
            assumed: self.totals.assumed.clone(),
            silenced: &self.totals.silenced,
            rests_on: self.totals.rests_on.union(self.interpreter.rests_on()),
            state,
        }))
    }

    /// Returns the state in which the next session begins.
    pub fn save(&self) -> SavedState {
        let axes = (0..self.machine.axes.len()).map(AxisIndex::new);
        let mut carried = self.interpreter.carried();
        // Values from the user are given again; values written by programs are not.
        carried.variables.retain(|name, value| {
            let name = VariableName::read(name);
            let given = self.given.get(&name);
            self.interpreter.here.only_programs_write(&name) || given != Some(value)
        });
        SavedState {
            schema: STATE_SCHEMA,
            machine: fingerprint(&self.machine),
            axes: axes.map(|axis| self.save_axis(axis)).collect(),
            variables: carried.variables.into_iter().map(storable).collect(),
            arrays: carried.arrays,
            parameters: carried.parameters,
            macros: carried.macros,
            lost_macros: carried.lost_macros,
            couplings: carried.couplings,
            lost_couplings: carried.lost_couplings,
            ways: carried.ways,
            lost: carried.lost,
            lost_parameters: carried.lost_parameters,
        }
    }

    fn save_axis(&self, index: AxisIndex) -> SavedAxis {
        let compensation = self.interpreter.compensation();
        let axis = self.machine.axis(index);
        let away =
            |kind: &Kind| compensation.state(index, *kind) != self.states.start_up(index, *kind);
        let position = self.interpreter.position(index).value;
        SavedAxis {
            axis: axis.name.clone(),
            selected: compensation.selected(index),
            unknown: compensation.unknown(index),
            rewritten: Some(compensation.rewritten(index)).filter(|it| !it.is_empty()),
            max_points: axis.max_points,
            friction: match &axis.friction {
                Parameterisation::Accepted(list) => Some(list.clone()),
                _ => None,
            },
            away: Kind::ALL
                .into_iter()
                .filter(away)
                .map(|kind| SavedAway {
                    kind,
                    by: self.states.maker(index, kind).cloned(),
                    allowed: self.states.notice(index, kind) == LeftAwayNotice::Silenced,
                })
                .collect(),
            occurred: self.machine.axis_set == AxisSet::AsTheyOccur
                && self.interpreter.occurred()[index.get()],
            position: position.filter(|position| position.is_finite()),
        }
    }
}
