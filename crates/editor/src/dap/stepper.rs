//! The run of a program in single blocks.
//!
//! An interpreter reports a block after executing it; a debugger stops before a block. So the stepper
//! keeps a copy of the run from some blocks ago: when a block shows that the run should have stopped
//! before it, the copy is run up to that block.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use super::breakpoints::Breakpoints;
use frictcomp::comp::Kind;
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::interpreter::{
    Branches, Ended, EndedBy, Event, Executed, Interpreter, NoteKind, Notes, Observer, Options,
    WayCondition,
};
use frictcomp::machine::{Machine, Setting};
use frictcomp::syntax::axis_uses;
use frictcomp::text::SourceFile;
use frictcomp_host::{
    FileRegistry, HostError, Input, LoadedMachine, MachineOptions, Machines, Naming, ProgramFinder,
    read_text,
};

/// Blocks that are executed between two copies, and between two checks for a request of the client.
const STRIDE: u64 = 10_000;

/// A block of a call, or the one that comes next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct BlockOfCall {
    pub(super) file: Arc<str>,
    /// Line of the block, from 1.
    pub(super) line: u32,
    pub(super) text: String,
}

/// Position of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum RunPosition {
    /// Position before a block; the last site is that block, those before it the calls that led there.
    Before(Vec<BlockOfCall>),
    /// The program has ended.
    Ended(EndedBy),
}

/// Target of the next part of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RunTarget {
    /// The next block.
    Block,
    /// The next block of this call depth, or of one above.
    Depth(usize),
    /// The next breakpoint.
    Breakpoint,
}

/// Reason why the run has stopped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Halt {
    /// Goal of the run reached.
    Arrived,
    /// The line has a breakpoint; the description of the stop.
    Breakpoint(String),
    /// The block before changed states; the changes in words.
    Changed(String),
    /// The next block reads values that only the machine knows.
    Unknown(BTreeSet<String>),
    /// An error of the control.
    Error(String),
    /// The client has a request.
    Interrupted,
    /// The program has ended.
    Ended(EndedBy),
}

/// State of the run at the next stop.
#[derive(Debug, Clone, Default)]
struct Trail {
    /// The last executed block of each call depth.
    sites: Vec<BlockOfCall>,
    /// Cause of the end of the program.
    ended: Option<EndedBy>,
}

impl Trail {
    fn pass(&mut self, block: &Executed<'_>) {
        self.sites.truncate(depth(block));
        self.sites.push(site(block));
    }
}

/// Text that a run has for its user.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum OutputText {
    /// A message about the program.
    Message(Box<Diagnostic>),
    /// The text of a log point.
    Log {
        file: Arc<str>,
        line: u32,
        text: String,
    },
}

/// Reason for the end of a stride before its last block.
enum Stop {
    /// Stop before the block that has just been executed.
    Before(Halt),
    /// Stop before that block, if the breakpoints on its line stop there; otherwise for another reason.
    AtBreakpoint {
        file: Arc<str>,
        line: u32,
        otherwise: Option<Halt>,
    },
    /// Stop after that block.
    After(Halt),
}

/// Listens to some blocks of the run.
struct Stride<'a> {
    reach: RunTarget,
    breakpoints: &'a mut Breakpoints,
    asked: &'a BTreeSet<String>,
    machine: &'a Machine,
    trail: &'a mut Trail,
    said: Vec<OutputText>,
    blocks: u64,
    /// Whether the next block is one that the run need not stop before.
    first: bool,
    stop: Option<Stop>,
}

impl Stride<'_> {
    /// Returns why the run should have stopped before a block.
    fn before(&mut self, block: &Executed<'_>) -> Option<Stop> {
        let halt = self.halt_before(block);
        let is_error = matches!(halt, Some(Halt::Error(_)));
        if is_error || !self.breakpoints.is_on(block) {
            return halt.map(Stop::Before);
        }
        Some(Stop::AtBreakpoint {
            file: Arc::clone(block.file),
            line: block.line,
            otherwise: halt,
        })
    }

    /// Returns why, apart from the breakpoints on its line, the run should have stopped before a block.
    fn halt_before(&mut self, block: &Executed<'_>) -> Option<Halt> {
        if block.stopped {
            let error = block
                .diagnostics
                .iter()
                .find(|said| said.severity == Severity::Error);
            return Some(Halt::Error(error.map(in_words).unwrap_or_default()));
        }
        if self.breakpoints.stops_at_unknown() {
            let mut unknown = unknown_names(block);
            unknown.retain(|name| !self.asked.contains(name));
            if !unknown.is_empty() {
                return Some(Halt::Unknown(unknown));
            }
        }
        let has_arrived = match self.reach {
            RunTarget::Block => true,
            RunTarget::Depth(limit) => depth(block) <= limit,
            RunTarget::Breakpoint => false,
        };
        has_arrived.then_some(Halt::Arrived)
    }

    /// Returns the changes of states by a block, if they stop the run.
    fn changes(&self, block: &Executed<'_>) -> Option<Halt> {
        let name = |axis| self.machine.axis(axis).name.as_str();
        let made = block
            .changes
            .iter()
            .filter(|change| change.kind == Kind::Frict);
        let made = made.map(|change| {
            let words = format!(
                "{}: {} \u{2192} {}",
                name(change.axis),
                change.from,
                change.to
            );
            (name(change.axis), words)
        });
        let doubted = block
            .doubted
            .iter()
            .filter(|(_, kinds)| kinds.contains(Kind::Frict));
        let doubted = doubted.map(|&(axis, _)| (name(axis), format!("{}: unknown", name(axis))));
        let watched: Vec<String> = made
            .chain(doubted)
            .filter(|(axis, _)| self.breakpoints.watches(axis))
            .map(|(_, words)| words)
            .collect();
        (!watched.is_empty()).then(|| Halt::Changed(watched.join(", ")))
    }
}

impl Observer for Stride<'_> {
    fn event(&mut self, event: Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Started { .. } | Event::Joined(_) => {}
            Event::Ended(ended) => {
                self.trail.ended = Some(ended.by);
                self.said.extend(messages(ended.diagnostics));
            }
            Event::Executed(block) => {
                self.blocks += 1;
                if !std::mem::take(&mut self.first)
                    && let Some(stop) = self.before(&block)
                {
                    self.stop = Some(stop);
                    return ControlFlow::Break(());
                }
                self.said.extend(messages(block.diagnostics));
                self.trail.pass(&block);
                self.stop = self.changes(&block).map(Stop::After);
                if self.stop.is_some() || self.blocks == STRIDE {
                    return ControlFlow::Break(());
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// Motion of the run to another block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Moved {
    Yes,
    No,
}

/// The run of a program.
pub(super) struct Stepper {
    machine: Arc<Machine>,
    /// The axes that the program names.
    used: BTreeSet<String>,
    finder: ProgramFinder,
    /// The run before the block that is shown.
    here: Interpreter,
    /// The same run in the program that this block belongs to.
    settled: Interpreter,
    /// Whether the client was informed that the run has stopped before that block.
    is_shown: bool,
    trail: Trail,
    position: RunPosition,
    /// Values that the shown block reads and only the machine knows.
    wanted: BTreeSet<String>,
    /// The answers to its condition, where only the machine knows which holds.
    answers: Vec<WayCondition>,
    /// The values that the run has stopped at already.
    asked: BTreeSet<String>,
    /// Messages of blocks executed since the last report to the client.
    said: Vec<OutputText>,
}

impl Stepper {
    /// Returns the run of a program on the machine of its folder, before its first block.
    ///
    /// # Errors
    /// The program or its configuration cannot be read.
    pub(super) fn new(program: &Path, settings: &[(String, Setting)]) -> Result<Self, HostError> {
        let mut machines = Machines::new(MachineOptions::default(), &FileRegistry::default());
        let input = Input::new(program);
        let loaded = machines.for_folder(input.folder())?;
        let LoadedMachine {
            machine,
            search_path,
            disk,
            ..
        } = &*loaded;
        let text = read_text(program)?;
        let used = axis_uses(&text).into_keys().collect();
        let source = SourceFile::new(input.name(Naming::AsGiven), text);
        let machine = Arc::new(machine.clone());
        let options = Options::default()
            .with_notes(Notes::Taken)
            .with_branches(Branches::OneFollowed);
        let mut here = Interpreter::new(Arc::clone(&machine), machine.compensation(), options);
        for (name, setting) in loaded.settings.iter().chain(settings) {
            here.set(name, setting);
        }
        let mut finder = ProgramFinder::new(&input, search_path, Naming::AsGiven, disk);
        let mut said = Vec::new();
        let mut trail = Trail::default();
        let _ = here.program(source, &mut finder, &mut |event: Event<'_>| {
            if let Event::Ended(ended) = event {
                trail.ended = Some(ended.by);
                said.extend(messages(ended.diagnostics));
            }
            ControlFlow::Break(())
        });
        let mut stepper = Self {
            machine,
            used,
            finder,
            settled: here.clone(),
            here,
            is_shown: false,
            trail,
            position: RunPosition::Before(Vec::new()),
            wanted: BTreeSet::new(),
            answers: Vec::new(),
            asked: BTreeSet::new(),
            said,
        };
        stepper.look_ahead();
        Ok(stepper)
    }

    /// Returns the position of the run.
    pub(super) fn position(&self) -> &RunPosition {
        &self.position
    }

    /// Returns the call depth of the shown block.
    pub(super) fn depth(&self) -> usize {
        match &self.position {
            RunPosition::Before(sites) => sites.len().saturating_sub(1),
            RunPosition::Ended(_) => 0,
        }
    }

    /// Returns the interpreter before the block that is shown.
    pub(super) fn interpreter(&self) -> &Interpreter {
        &self.settled
    }

    /// Returns whether the machine or the program has an axis of this name.
    pub(super) fn has_axis(&self, name: &str) -> bool {
        self.machine.find(name).is_some() || self.used.contains(name)
    }

    /// Notes that the client knows of the stop before this block: the run does not stop there again.
    pub(super) fn show(&mut self) {
        self.is_shown = true;
    }

    /// Returns the names of the values that the shown block reads and only the machine knows.
    pub(super) fn wanted(&self) -> &BTreeSet<String> {
        &self.wanted
    }

    /// Returns the answers to the condition of the shown block, in words; none where there is nothing to choose.
    pub(super) fn answers(&self) -> impl Iterator<Item = String> {
        let file = match &self.position {
            RunPosition::Before(sites) => sites.last().map(|site| &*site.file),
            RunPosition::Ended(_) => None,
        };
        let file = file.unwrap_or_default();
        self.answers.iter().map(move |it| it.in_words(file))
    }

    /// Chooses an answer to the condition of the shown block, by its index. A later condition on the
    /// same value is a separate choice. Returns whether the run has moved to another block, because the
    /// shown one is skipped.
    ///
    /// # Errors
    /// There is no such answer; the reason in words.
    pub(super) fn choose(&mut self, place: usize) -> Result<Moved, String> {
        if place >= self.answers.len() {
            return Err("the block has no such side to choose".to_owned());
        }
        for name in &self.wanted {
            self.asked.remove(name);
        }
        let before = self.position.clone();
        self.here.choose(place);
        self.look_ahead();
        Ok(if self.position == before {
            Moved::No
        } else {
            Moved::Yes
        })
    }

    /// Sets a value that only the machine knows, from the shown block on.
    pub(super) fn set(&mut self, name: &str, setting: &Setting) {
        self.here.set(name, setting);
        self.look_ahead();
    }

    /// Takes the messages since the last call.
    pub(super) fn take_said(&mut self) -> Vec<OutputText> {
        std::mem::take(&mut self.said)
    }

    /// Continues the run. `interrupted` is called every now and then.
    pub(super) fn go(
        &mut self,
        reach: RunTarget,
        breakpoints: &mut Breakpoints,
        interrupted: &mut dyn FnMut() -> bool,
    ) -> Halt {
        let mut first = std::mem::take(&mut self.is_shown);
        let halt = loop {
            if let Some(by) = self.trail.ended {
                break Halt::Ended(by);
            }
            let anchor = self.here.clone();
            let trail = self.trail.clone();
            let mut stride = Stride {
                reach,
                breakpoints,
                asked: &self.asked,
                machine: &self.machine,
                trail: &mut self.trail,
                said: Vec::new(),
                blocks: 0,
                first: std::mem::take(&mut first),
                stop: None,
            };
            let _ = self.here.go_on(&mut self.finder, &mut stride);
            let Stride {
                blocks,
                stop,
                mut said,
                ..
            } = stride;
            self.said.append(&mut said);
            match stop {
                Some(Stop::Before(halt)) => {
                    self.trail = trail;
                    self.return_to(anchor, blocks - 1);
                    break halt;
                }
                Some(Stop::AtBreakpoint {
                    file,
                    line,
                    otherwise,
                }) => {
                    self.trail = trail;
                    self.return_to(anchor, blocks - 1);
                    let met = breakpoints.meet((&file, line), &self.here);
                    self.said
                        .extend(met.logged.into_iter().map(|text| OutputText::Log {
                            file: Arc::clone(&file),
                            line,
                            text,
                        }));
                    if let Some(halt) = met.stop.map(Halt::Breakpoint).or(otherwise) {
                        break halt;
                    }
                    first = true;
                }
                Some(Stop::After(halt)) => break halt,
                None => {}
            }
            if interrupted() {
                break Halt::Interrupted;
            }
        };
        if let Halt::Unknown(names) = &halt {
            self.asked.extend(names.iter().cloned());
        }
        self.look_ahead();
        halt
    }

    /// Goes back to a copy of the run and executes a number of blocks.
    fn return_to(&mut self, anchor: Interpreter, blocks: u64) {
        self.here = anchor;
        let mut left = blocks;
        while left > 0 {
            let trail = &mut self.trail;
            let _ = self.here.go_on(&mut self.finder, &mut |event: Event<'_>| {
                if let Event::Executed(block) = event {
                    trail.pass(&block);
                    left -= 1;
                }
                if left == 0 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
        }
    }

    /// Finds the next block by executing it in a copy of the run.
    fn look_ahead(&mut self) {
        self.settled = self.here.settled();
        self.wanted.clear();
        self.answers.clear();
        if let Some(by) = self.trail.ended {
            self.position = RunPosition::Ended(by);
            return;
        }
        let mut copy = self.here.clone();
        let (mut sites, mut ended, mut wanted) = (self.trail.sites.clone(), None, BTreeSet::new());
        let _ = copy.go_on(&mut self.finder, &mut |event: Event<'_>| {
            match event {
                Event::Executed(block) => {
                    sites.truncate(depth(&block));
                    sites.push(site(&block));
                    wanted = unknown_names(&block);
                }
                Event::Ended(Ended { by, .. }) => ended = Some(by),
                Event::Started { .. } | Event::Joined(_) => return ControlFlow::Continue(()),
            }
            ControlFlow::Break(())
        });
        self.wanted = wanted;
        self.answers = copy.offered().to_vec();
        self.position = match ended {
            // The rest of the program has no block: it ends without a further stop.
            Some(by) => {
                self.finish();
                RunPosition::Ended(by)
            }
            None => RunPosition::Before(sites),
        };
    }

    fn finish(&mut self) {
        let (trail, said) = (&mut self.trail, &mut self.said);
        let _ = self.here.go_on(&mut self.finder, &mut |event: Event<'_>| {
            if let Event::Ended(ended) = event {
                trail.ended = Some(ended.by);
                said.extend(messages(ended.diagnostics));
            }
            ControlFlow::Continue(())
        });
    }
}

/// Returns the call depth of a block; 0 in the main program.
fn depth(block: &Executed<'_>) -> usize {
    block
        .level
        .and_then(|level| usize::try_from(level).ok())
        .unwrap_or(0)
}

fn site(block: &Executed<'_>) -> BlockOfCall {
    BlockOfCall {
        file: Arc::clone(block.file),
        line: block.line,
        text: block.text.to_owned(),
    }
}

/// Returns the names of the values that a block reads and only the machine knows.
pub(super) fn unknown_names(block: &Executed<'_>) -> BTreeSet<String> {
    let notes = block.notes.iter();
    let unknown = notes.filter(|note| note.kind == NoteKind::Unknown);
    unknown.map(|note| note.name.clone()).collect()
}

fn messages(said: &[Diagnostic]) -> impl Iterator<Item = OutputText> {
    said.iter()
        .cloned()
        .map(|said| OutputText::Message(Box::new(said)))
}

/// Returns a message in one line: `P-ERR-70495: ...`.
pub(super) fn in_words(said: &Diagnostic) -> String {
    format!("{}[{}]: {}", said.severity, said.code, said.message)
}
