//! Executes programs block by block: flow, expressions, modal state, COMP commands.
//!
//! It opens no file and prints nothing. A host hands it texts and a [`Finder`] for called
//! programs, and listens with an [`Observer`]. Everything that a run depends on is data, so it
//! can be stopped, saved and resumed at any block of a program that is held in memory.

#![allow(
    clippy::unnecessary_box_returns,
    reason = "faults travel boxed in results; what makes one boxes it"
)]

mod at;
mod block;
mod budget;
mod call;
mod carried;
mod chain;
mod comp;
mod coupling;
mod endless;
mod evaluate;
mod event;
mod expression;
mod finder;
mod flow;
mod functions;
mod hash;
mod implicit;
mod memory;
mod modal;
mod motion;
mod program;
mod region;
mod sequence;
mod snapshot;
mod stream;
mod unknown;
mod value;
mod words;

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::ControlFlow;
use std::rc::Rc;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use budget::Limits;
pub use carried::{ArrayShape, Carried};
pub use event::{
    AxisWord, Ended, EndedBy, Event, Executed, Note, NoteKind, Notes, Observer, Outcome,
};
pub use finder::{Finder, NoFiles, NoProgram};
pub use modal::{AxisPosition, Frame as PositionFrame, Group, Modal};
pub use motion::{
    Arc as CircularArc, BlockEnd, Centre, Form, Motion, Motions, PathFeed, Travel, Turn,
};
pub use snapshot::{ResumeError, Snapshot};
pub use value::Value;

use crate::codes::Code;
use crate::compensation::{Change, Compensation};
use crate::diagnostic::{Collected, Diagnostic, Place, Severity};
use crate::machine::{AxisIndex, AxisSet, Machine, Setting};
use crate::source::{SourceFile, Span};
use crate::syntax::ast::{Block, Call, CallForm, Repetition};
use crate::syntax::{Comments, FastPath, Fault, Remark};
use at::{At, Shown};
use call::Found;
use coupling::Couplings;
use endless::{Loop, Reads};
use memory::Memory;
use program::{EntryIndex, Index};
use sequence::{Destination, Passage, Sought};
use unknown::{Journal, Regions, Scan};

/// What happens at an error of the control (R9.20).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StopPolicy {
    /// The first error stops the program and the session, as on the control.
    #[default]
    FirstError,
    /// The failing command is treated as if it were not there.
    KeepGoing,
    /// As `KeepGoing`; blocks that are never executed are checked for their syntax too.
    CheckAll,
}

/// How programs are run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// What happens at an error.
    pub stop: StopPolicy,
    /// The levels of blocks that are skipped, bit 1 for `/` and `/1`, up to bit 10 (R2.3).
    pub skip: u16,
    /// Budgets.
    pub limits: Limits,
    /// Whether plain blocks are parsed by hand.
    pub fast_path: FastPath,
    /// Whether notes are taken.
    pub notes: Notes,
    /// Whether blocks say what they move.
    pub motions: Motions,
}

/// How a run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outlook {
    /// The program ended.
    Ended(EndedBy),
    /// The observer stopped it; it can be resumed.
    Paused,
}

/// One level of the call stack: where a program or subprogram stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Frame {
    /// The file, by its position among the files of the run.
    unit: usize,
    section: usize,
    /// The next block.
    next: EntryIndex,
    /// The call depth; 0 is the main program.
    level: u32,
    /// Own parameters of the call.
    own: BTreeMap<u32, Value>,
    /// Set between `$IF` or `$SWITCH` and the branch that is looked for.
    seeking: Option<Seeking>,
    /// Where it was called.
    called_from: Option<Place>,
    /// What the end of a cycle brings back.
    restores: Option<Box<modal::Saved>>,
    /// Programs that are called before the next block, the first one last.
    waiting: Vec<Request>,
    /// The blocks that are executed, where that is not the whole program.
    passage: Option<Passage>,
}

/// What the next branch statement has to decide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Seeking {
    /// A true condition.
    Condition,
    /// A case with this value.
    Case(Value),
}

/// Everything that a run depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct State {
    compensation: Compensation,
    memory: Memory,
    modal: Modal,
    frames: Vec<Frame>,
    /// Executed blocks of the program.
    seq: u64,
    /// Executed blocks of the session.
    blocks: u64,
    /// Work of the session.
    spent: Cell<u64>,
    /// Work beyond what the executed blocks bring with them.
    level: Cell<u64>,
    /// Words and commands that were passed over.
    opaque: BTreeMap<String, u64>,
    /// The axes that occurred.
    occurred: Vec<bool>,
    couplings: Couplings,
    /// The cycle that is repeated after blocks.
    repeated: Option<Repeated>,
    /// The loops that came round, the outermost first.
    loops: Vec<Loop>,
    /// Whether a loop is compared with an earlier pass, so that what is read matters.
    watching: bool,
    reads: RefCell<Reads>,
    /// The called files of which it was said what is wrong with them.
    refused: BTreeSet<usize>,
    /// Set while the configured end program runs.
    ending: Option<EndedBy>,
    /// The last executed block of the main program.
    last: Option<Last>,
    /// What a paused run does first when it goes on.
    parked: Option<Step>,
    /// What `#FILE NAME` says that a word calls, until the program ends.
    named: BTreeMap<String, Value>,
    /// G functions and positions before a contour description, inside it.
    described: Option<Box<Modal>>,
}

/// The last executed block, in case that the program ends without M30.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Last {
    file: Arc<str>,
    line: u32,
    text: String,
}

/// A modal cycle (R2.13).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Repeated {
    call: RepeatedCall,
    own: BTreeMap<u32, Value>,
    after_motion_only: bool,
}

/// What a modal cycle calls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum RepeatedCall {
    /// A program that is at hand.
    Program(Found),
    /// The same, or nothing: nobody knows whether the cycle is in force.
    Perhaps(Found),
    /// A program that is on the machine only, by its name.
    External(String),
}

/// A file of the run.
struct Unit {
    index: Index,
    /// Blocks that were executed more than once, parsed.
    kept: Vec<Option<Rc<Parsed>>>,
    /// Blocks below this one were executed before.
    high: EntryIndex,
    /// Which blocks were executed, where that is asked for.
    executed: Vec<bool>,
    /// Control blocks of which nobody knows offline which branch is taken.
    undecided: BTreeSet<EntryIndex>,
}

/// A parsed block with its text and its place.
struct Parsed {
    block: Block,
    file: Arc<str>,
    line: u32,
    text: String,
    comments: Comments,
    remark: Option<Remark>,
}

/// How many parsed blocks a run keeps.
const MAX_KEPT: usize = 100_000;

/// Runs programs on a machine.
///
/// ```
/// use std::ops::ControlFlow;
/// use frictcomp::interpreter::{Event, Interpreter, NoFiles, Options};
/// use frictcomp::{compensation::Compensation, machine::Machine, source::SourceFile};
///
/// let machine = Machine::enabled(["X"]);
/// let comp = Compensation::at_startup(&machine);
/// let mut run = Interpreter::new(machine, comp, Options::default());
/// let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
/// let mut changes = 0;
/// run.program(program, &mut NoFiles, &mut |event: Event<'_>| {
///     if let Event::Executed(block) = event {
///         changes += block.changes.len();
///     }
///     ControlFlow::Continue(())
/// });
/// assert_eq!(changes, 1);
/// ```
pub struct Interpreter {
    machine: Arc<Machine>,
    options: Options,
    /// The axes with one-letter names.
    letters: [Option<AxisIndex>; 26],
    /// The axes with longer names.
    names: BTreeMap<String, AxisIndex>,
    /// Whether any axis requires a compensation (P-AXIS-00465).
    any_required: bool,
    units: Vec<Unit>,
    /// The blocks of sections by their numbers, where those were asked for.
    numbers: HashMap<(usize, usize), HashMap<i64, EntryIndex>>,
    /// Where a main program that is read line by line goes on.
    sought: Option<Sought>,
    /// Which file a call by name from a file meant.
    found: BTreeMap<(String, String), usize>,
    /// Which calls found none, and why.
    missing: BTreeMap<(String, String), NoProgram>,
    /// The files of the run by name.
    unit_names: HashMap<Arc<str>, usize>,
    /// Calls in regions that may or may not be executed.
    pending: Vec<Scan>,
    regions: Regions,
    journal: Journal,
    kept: usize,
    /// Bytes of the programs in memory.
    held_text: u64,
    /// Names that were compared with those of calls that found nothing.
    compared: usize,
    state: State,
    version: u64,
    work: Work,
}

/// Buffers that are used again for each block.
#[derive(Default)]
struct Work {
    block: Block,
    outcomes: Vec<Outcome>,
    changes: Vec<Change>,
    /// Its axis words.
    moved: Vec<AxisWord>,
    /// The axes that have a word, and those that may have another, a bit each.
    seen: u64,
    again: u64,
    diagnostics: Vec<Diagnostic>,
    /// How many messages about the block are not said, and where the first of them belongs.
    unsaid: Option<(Span, u64)>,
    stack: Vec<Result<Value, Box<Fault>>>,
    /// I, J, K, R and the like, where the block has any.
    geometry: Option<motion::Geometry>,
    /// Whether the block is G04 or `#TIME`.
    dwells: bool,
    /// What the block moves, where motions are taken.
    motion: Option<Motion>,
    notes: RefCell<Vec<Note>>,
    /// Whether a text of the block had no meaning that is known here; what hangs on it is not said
    /// again (R2.71).
    unread: Cell<bool>,
    /// Macros that the block has expanded.
    expansions: Cell<u32>,
    /// The budget that ended the run.
    over: Option<Diagnostic>,
    /// Whether an axis occurred for the first time.
    new_axes: bool,
    /// Whether a value was written.
    wrote: bool,
}

impl Work {
    fn clear(&mut self) {
        self.outcomes.clear();
        self.changes.clear();
        self.moved.clear();
        self.seen = 0;
        self.again = 0;
        self.diagnostics.clear();
        self.geometry = None;
        self.dwells = false;
        self.motion = None;
        self.notes.get_mut().clear();
        self.unread.set(false);
        self.expansions.set(0);
        self.new_axes = false;
    }
}

/// What the control does after a block, where that is not the next one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Step {
    /// The program was announced and has not begun.
    Begin,
    /// To a block of the same program.
    Jump(EntryIndex),
    /// Programs, one after the other.
    Call(Vec<Request>),
    /// M17, M29.
    Return,
    /// The same with a place to return to.
    ReturnTo(Destination),
    End(EndedBy),
}

/// Why the next block is not the one that follows.
enum Departure {
    /// The observer wants to stop.
    Paused,
    Step(Step),
}

/// A program to call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Request {
    found: Found,
    passage: Option<Passage>,
    own: BTreeMap<u32, Value>,
    form: CallForm,
    called_from: Place,
}

impl Interpreter {
    /// An interpreter for a machine whose compensation is in a given state.
    pub fn new(
        machine: impl Into<Arc<Machine>>,
        compensation: Compensation,
        options: Options,
    ) -> Self {
        let machine = machine.into();
        let axes = machine.axes.len();
        let configured = machine.axis_set == AxisSet::Configured;
        let occurred = machine
            .axes
            .iter()
            .map(|axis| configured || axis.frict_comp_origin != crate::machine::Origin::Default)
            .collect();
        let state = State {
            compensation,
            memory: Memory::default(),
            modal: Modal::new(axes),
            frames: Vec::new(),
            seq: 0,
            blocks: 0,
            spent: Cell::new(0),
            level: Cell::new(0),
            opaque: BTreeMap::new(),
            occurred,
            couplings: Couplings::default(),
            repeated: None,
            loops: Vec::new(),
            watching: false,
            reads: RefCell::default(),
            refused: BTreeSet::new(),
            ending: None,
            last: None,
            parked: None,
            named: BTreeMap::new(),
            described: None,
        };
        let mut interpreter = Self::with_state(machine, options, state);
        interpreter.define_machine_macros();
        interpreter
    }

    fn with_state(machine: Arc<Machine>, options: Options, state: State) -> Self {
        let mut letters = [None; 26];
        let mut names = BTreeMap::new();
        for (position, axis) in machine.axes.iter().enumerate() {
            let index = AxisIndex::new(position);
            match axis.name.as_bytes() {
                [letter @ b'A'..=b'Z'] => letters[usize::from(letter - b'A')] = Some(index),
                _ => {
                    names.insert(axis.name.clone(), index);
                }
            }
        }
        Self {
            any_required: machine.axes.iter().any(|axis| !axis.required.is_empty()),
            machine,
            options,
            letters,
            names,
            units: Vec::new(),
            numbers: HashMap::new(),
            sought: None,
            found: BTreeMap::new(),
            missing: BTreeMap::new(),
            unit_names: HashMap::new(),
            pending: Vec::new(),
            regions: Regions::new(),
            journal: Journal::default(),
            kept: 0,
            held_text: 0,
            compared: 0,
            state,
            version: 0,
            work: Work::default(),
        }
    }

    /// Gives a variable the value that only the machine knows (R2.36).
    pub fn set(&mut self, name: &str, setting: &Setting) {
        self.state.memory.give(name, setting.into());
        self.journal.begin_anew();
    }

    /// The machine.
    pub fn machine(&self) -> &Arc<Machine> {
        &self.machine
    }

    /// The compensation state of the moment.
    pub fn compensation(&self) -> &Compensation {
        &self.state.compensation
    }

    /// The axes that occurred so far, by position; every axis of a configured machine.
    pub fn occurred(&self) -> &[bool] {
        &self.state.occurred
    }

    /// Takes an axis for one that occurred.
    pub fn expect_axis(&mut self, axis: AxisIndex) {
        self.state.occurred[axis.get()] = true;
        self.version += 1;
    }

    /// Rises whenever the compensation state or the axes that occurred change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The executed blocks of the session.
    pub fn blocks(&self) -> u64 {
        self.state.blocks
    }

    /// What was passed over, by word.
    pub fn opaque(&self) -> &BTreeMap<String, u64> {
        &self.state.opaque
    }

    /// Where an axis stands after the last block: the programmed coordinate in mm or degrees.
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        self.state.modal.position(axis)
    }

    /// The G functions in force.
    pub fn modal(&self) -> &Modal {
        &self.state.modal
    }

    /// The `V.S.` variables, which outlive programs (R2.34).
    pub fn shared_variables(&self) -> BTreeMap<String, Value> {
        self.state.memory.shared()
    }

    /// Takes over the compensation state of an earlier session.
    pub fn set_compensation(&mut self, compensation: Compensation) {
        self.state.compensation = compensation;
        self.version += 1;
    }

    /// Runs a main program whose text is in memory.
    pub fn program(
        &mut self,
        source: SourceFile,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Outlook {
        self.start();
        self.whole(source, finder, observer)
    }

    /// Announces and runs a program whose text is in memory, in a state that is prepared.
    fn whole(
        &mut self,
        source: SourceFile,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Outlook {
        let index = Index::new(source, self.options.limits.nesting);
        let main = index.main();
        let name = main.and_then(|main| index.sections[main].name.clone());
        self.units.clear();
        self.numbers.clear();
        self.sought = None;
        self.unit_names.clear();
        self.hold(index);
        if self.announce(name.as_deref(), observer).is_break() {
            self.state.parked = Some(Step::Begin);
            return Outlook::Paused;
        }
        self.begin(main, finder, observer)
    }

    /// Runs the program that was announced, from the start of a section on.
    fn begin(
        &mut self,
        main: Option<usize>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Outlook {
        if self.is_refused() {
            return self.refuse(observer);
        }
        if let Some(section) = main {
            self.enter(0, section);
        }
        let main = Arc::clone(self.units[0].index.source.name());
        if let Err(missing) = self.start_program(&main, finder) {
            return self.ended(EndedBy::Error, one(*missing), observer);
        }
        let outlook = self.run(finder, observer);
        self.close(outlook, observer)
    }

    /// Whether what is wrong with the main program keeps it from running.
    fn is_refused(&self) -> bool {
        !self.refused().is_empty() && self.options.stop == StopPolicy::FirstError
    }

    /// Ends a program that does not run.
    fn refuse(&mut self, observer: &mut dyn Observer) -> Outlook {
        let refused = self.refused();
        self.ended(ended_by(&refused.said), refused, observer)
    }

    /// What keeps the main program from running at all.
    fn refused(&self) -> Collected {
        let main = self.units.first();
        main.map_or(Collected::default(), |unit| unit.index.refused.clone())
    }

    /// Goes on with a run that an observer stopped.
    pub fn go_on(&mut self, finder: &mut dyn Finder, observer: &mut dyn Observer) -> Outlook {
        let outlook = match self.state.parked.take() {
            Some(Step::Begin) => {
                let main = self.units[0].index.main();
                return self.begin(main, finder, observer);
            }
            Some(step) => match self.follow(step) {
                ControlFlow::Break(by) => Outlook::Ended(by),
                ControlFlow::Continue(()) => self.run(finder, observer),
            },
            None => self.run(finder, observer),
        };
        self.close(outlook, observer)
    }

    /// Prepares the state for a program start.
    fn start(&mut self) {
        self.state.modal = self.state.modal.next_program();
        self.state.memory.start_program(self.machine.parameters);
        self.state.frames.clear();
        self.state.seq = 0;
        self.state.repeated = None;
        self.state.loops.clear();
        self.state.watching = false;
        self.state.refused.clear();
        self.state.ending = None;
        self.state.last = None;
        self.state.parked = None;
        self.state.named.clear();
        self.state.described = None;
        self.units.clear();
        self.found.clear();
        self.missing.clear();
        self.unit_names.clear();
        self.compared = 0;
        self.pending.clear();
        self.regions.clear();
        self.journal.begin_anew();
        self.kept = 0;
        self.held_text = 0;
    }

    /// Takes a file into the run; returns its number.
    fn hold(&mut self, index: Index) -> usize {
        let bytes = u64::try_from(index.source.text().len()).unwrap_or(u64::MAX);
        self.held_text = self.held_text.saturating_add(bytes);
        let unit = self.units.len();
        let name = index.source.name().clone();
        self.unit_names.entry(name).or_insert(unit);
        self.units.push(Unit::new(index));
        unit
    }

    fn announce(&mut self, name: Option<&str>, observer: &mut dyn Observer) -> ControlFlow<()> {
        observer.event(Event::Started {
            name,
            compensation: &self.state.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        })
    }

    fn enter(&mut self, unit: usize, section: usize) {
        let next = self.units[unit].index.sections[section].start;
        self.state.frames.push(Frame {
            unit,
            section,
            next,
            level: 0,
            own: BTreeMap::new(),
            seeking: None,
            called_from: None,
            restores: None,
            waiting: Vec::new(),
            passage: None,
        });
    }

    /// Ends a program whose text is in memory.
    fn close(&mut self, outlook: Outlook, observer: &mut dyn Observer) -> Outlook {
        let Outlook::Ended(by) = outlook else {
            return outlook;
        };
        let mut notes = self.refused();
        notes.extend(self.work.over.take());
        if by == EndedBy::EndOfFile && !self.state.frames.is_empty() {
            notes.extend(self.missing_end());
        }
        if self.options.stop == StopPolicy::CheckAll {
            self.check_all_unexecuted(&mut notes);
        }
        self.ended(by, notes, observer)
    }

    /// FC310 at the last executed block; a program without any block needs no M30 (R2.8).
    fn missing_end(&self) -> Option<Diagnostic> {
        let last = self.state.last.as_ref()?;
        let place = Place {
            file: last.file.clone(),
            text: last.text.as_str().into(),
            first_line: last.line,
            span: Span::new(0, last.text.len()),
        };
        let message = "the program ends here without M30 or M02";
        Some(Diagnostic::new(Code::Fc310, place, message).with_help("end it with `M30`"))
    }

    fn ended(&mut self, by: EndedBy, notes: Collected, observer: &mut dyn Observer) -> Outlook {
        let changes = self.state.compensation.program_end();
        if !changes.is_empty() {
            self.version += 1;
        }
        self.state.frames.clear();
        self.release_couplings();
        // The observer wants no more, or it does not: the program has ended either way.
        let _ = observer.event(Event::Ended(Ended {
            seq: self.state.seq,
            by,
            changes: &changes,
            diagnostics: &notes.said,
            unsaid: &notes.unsaid,
            compensation: &self.state.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        }));
        Outlook::Ended(by)
    }

    fn is_skipped(&self, block: &Block) -> bool {
        block
            .skip
            .is_some_and(|level| self.options.skip & (1 << level.min(15)) != 0)
    }

    fn check_unexecuted(
        file: &Arc<str>,
        (line, text): (u32, &str),
        block: &Block,
        notes: &mut Collected,
    ) {
        let shown = Shown::default();
        let at = At {
            file,
            text,
            line,
            comments: Comments::Possible,
            remark: None,
            level: 0,
            called_from: None,
            macro_depth: 0,
            used: None,
            shown: &shown,
        };
        notes.extend(
            block
                .faults
                .iter()
                .map(|fault| at.diagnostic(fault.clone())),
        );
    }
}

impl Unit {
    fn new(index: Index) -> Self {
        Self {
            kept: Vec::new(),
            high: 0,
            executed: vec![false; index.entries.len()],
            undecided: BTreeSet::new(),
            index,
        }
    }
}

/// A single message.
fn one(diagnostic: Diagnostic) -> Collected {
    let mut notes = Collected::default();
    notes.push(diagnostic);
    notes
}

/// Whether a diagnostic stops the control.
fn stops(diagnostic: &Diagnostic) -> bool {
    diagnostic.code.severity() == Severity::Error
}

/// What a call repeats after.
fn after_motion_only(call: &Call) -> Option<bool> {
    match call.repetition {
        Repetition::Once => None,
        Repetition::AfterMotion => Some(true),
        Repetition::AfterBlock => Some(false),
    }
}

/// What ends a program that one of these diagnostics keeps from going on.
fn ended_by(said: &[Diagnostic]) -> EndedBy {
    let bound = |diagnostic: &Diagnostic| diagnostic.code.is_budget();
    match said.iter().find(|diagnostic| stops(diagnostic)) {
        Some(diagnostic) if bound(diagnostic) => EndedBy::Budget,
        _ => EndedBy::Error,
    }
}
