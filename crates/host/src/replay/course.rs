//! The states of friction compensation in the dry run, block by block.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::conditions::Condition;
use crate::disk::{Input, Naming};
use crate::error::HostError;
use crate::machines::{LoadedMachine, switched_axes};
use crate::run::{Programs, RunContext, expect_axes, run_programs};
use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::{EndedBy, PositionFrame};
use frictcomp::readings::{Basis, Question};
use frictcomp::session::{Session, SessionOptions};
use frictcomp::syntax::ast::{Address, Block, Item, Word};
use frictcomp::syntax::parse_block;
use frictcomp::timeline::{Record, Row, StateView};
use frictcomp_recordings::replay::RecordedAxis;

/// Largest number of executed blocks; they are kept until the recording is compared with them.
const MAX_STEPS: usize = 4_000_000;

/// The dry run of all programs, block by block.
#[derive(Default)]
pub(super) struct Course {
    pub(super) steps: Vec<CourseStep>,
    pub(super) axes: Vec<AxisCourse>,
    /// The conditions that only the machine can decide.
    pub(super) conditions: BTreeSet<Condition>,
    /// Reason why the run does not reach the end of the programs.
    pub(super) stopped: Option<String>,
    /// The file of the last step.
    file: Option<Arc<str>>,
    /// The version of the state examined last.
    version: Option<u64>,
}

/// An executed block.
pub(super) struct CourseStep {
    pub(super) program: u32,
    pub(super) file: Arc<str>,
    pub(super) line: u32,
    pub(super) number: Option<i64>,
    /// The rules of the open questions on which its effect depends.
    pub(super) rests_on: Vec<&'static str>,
}

/// The course of the states of an axis.
pub(super) struct AxisCourse {
    pub(super) name: String,
    /// Whether friction compensation is initially active; `None` where it is unknown.
    pub(super) start: Option<bool>,
    pub(super) switches: Vec<AxisSwitch>,
    /// Position in mm or degrees of the machine.
    position: Option<f64>,
}

/// A change of the state of an axis.
pub(super) struct AxisSwitch {
    /// The position of its step.
    pub(super) at: usize,
    /// Whether friction compensation is active from then on; `None` where it is unknown.
    pub(super) to: Option<bool>,
    /// Positions of the axis before and after the block, where they are known.
    pub(super) positions: Option<[f64; 2]>,
    /// Value on which an unknown state depends.
    pub(super) unknown: Option<String>,
}

impl Course {
    /// Runs the programs one after the other.
    pub(super) fn of(
        inputs: &[Input],
        loaded: &LoadedMachine,
        mut options: SessionOptions,
    ) -> Result<Self, HostError> {
        if !loaded.machine.is_described() {
            options.switched = switched_axes(inputs);
        }
        let mut session = Session::new(loaded.machine.clone(), options);
        expect_axes(&mut session, loaded, inputs);
        let said: Vec<Diagnostic> = loaded.errors().cloned().collect();
        let programs = Programs {
            inputs,
            said: &said,
        };
        let mut course = Self::default();
        let context = RunContext::new(loaded, Naming::AsGiven);
        let mut sink = |record: &Record<'_>| course.take(record, loaded);
        let played = run_programs(&mut session, programs, &context, &mut sink)?;
        if played.flow.is_break() {
            course.stopped = Some(format!("it has more than {MAX_STEPS} blocks"));
        } else if played.unrun > 0 && course.stopped.is_none() {
            course.stopped = Some(format!("{} of the programs did not run", played.unrun));
        }
        Ok(course)
    }

    /// Returns the axes that the programs switch and that were not recorded.
    pub(super) fn switched_beside(&self, recorded: &[RecordedAxis]) -> Vec<String> {
        let switched = self.axes.iter().filter(|axis| !axis.switches.is_empty());
        let beside = switched.filter(|axis| recorded.iter().all(|it| it.name != axis.name));
        beside.map(|axis| axis.name.clone()).collect()
    }

    fn take(&mut self, record: &Record<'_>, loaded: &LoadedMachine) -> ControlFlow<()> {
        match record {
            Record::Session { state, .. } | Record::Program { state, .. } => self.look(*state, ""),
            Record::Join(join) => self.look(join.state, join.file),
            Record::End(end) => self.look(end.state, ""),
            Record::Block(row) => self.block(row, loaded),
            _ => {}
        }
        let errors = record.diagnostics().map(|it| it.diagnostic());
        if let Some(error) = errors.filter(|it| it.severity == Severity::Error).last() {
            let place = &error.place;
            let line = place.start().line;
            let at = format!("{}:{line}", place.file);
            self.stopped
                .get_or_insert(format!("{} at {at}", error.code));
        }
        if let Record::End(end) = record
            && !matches!(end.by, EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile)
        {
            self.stopped
                .get_or_insert(format!("program {} ends by {}", end.program, end.by));
        }
        if self.steps.len() < MAX_STEPS {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    }

    fn block(&mut self, row: &Row<'_>, loaded: &LoadedMachine) {
        let file = match &self.file {
            Some(file) if **file == *row.file => Arc::clone(file),
            _ => Arc::from(row.file),
        };
        self.file = Some(Arc::clone(&file));
        self.steps.push(CourseStep {
            program: row.program,
            file,
            line: row.line,
            number: row.number,
            rests_on: rests_on(row, loaded),
        });
        match row.branch {
            None => self.look(row.state, row.file),
            Some(ways) => {
                let conditions = ways.iter().flatten().filter_map(Condition::of);
                self.conditions.extend(conditions);
                self.branch(row);
            }
        }
        self.stand(row);
    }

    /// Notes the positions of the axes after a block.
    fn stand(&mut self, row: &Row<'_>) {
        let last = self.steps.len().saturating_sub(1);
        for (axis, name) in row.state.axes() {
            let Some(course) = self.axes.iter_mut().find(|it| it.name == name) else {
                continue;
            };
            let position = row.modal.position(axis);
            let is_of_machine = position.frame == PositionFrame::Machine;
            let now = position.value.filter(|_| is_of_machine);
            let before = std::mem::replace(&mut course.position, now);
            if let Some(switch) = course.switches.last_mut().filter(|it| it.at == last) {
                switch.positions = before.zip(now).map(|(before, now)| [before, now]);
            }
        }
    }

    /// Marks the changes of a block on one of several ways as unknown.
    fn branch(&mut self, row: &Row<'_>) {
        let at = self.steps.len().saturating_sub(1);
        for change in row.changes.iter().filter(|it| it.kind == Kind::Frict) {
            let name = row.state.name(change.axis);
            if let Some(course) = self.axes.iter_mut().find(|it| it.name == name) {
                course.switches.push(AxisSwitch {
                    at,
                    to: None,
                    positions: None,
                    unknown: row.branch_in_words(),
                });
            }
        }
    }

    /// Notes what changed.
    fn look(&mut self, state: StateView<'_>, file: &str) {
        if self.version.replace(state.version) == Some(state.version) {
            return;
        }
        let at = self.steps.len().saturating_sub(1);
        for (axis, name) in state.axes() {
            let now = is_active(state, axis);
            let Some(course) = self.axes.iter_mut().find(|it| it.name == name) else {
                self.axes.push(AxisCourse {
                    name: name.to_owned(),
                    start: now,
                    switches: Vec::new(),
                    position: None,
                });
                continue;
            };
            let last = course.switches.last().map_or(course.start, |it| it.to);
            if last != now {
                let possible = state.possible_of(axis, Kind::Frict);
                course.switches.push(AxisSwitch {
                    at,
                    to: now,
                    positions: None,
                    unknown: possible.map(|it| it.in_words(file)),
                });
            }
        }
    }
}

fn is_active(state: StateView<'_>, axis: AxisIndex) -> Option<bool> {
    match state.state(axis, Kind::Frict) {
        State::Unknown => None,
        other => Some(other == State::Active),
    }
}

/// Returns the rules of the open questions on which a block depends and which no control has answered.
fn rests_on(row: &Row<'_>, loaded: &LoadedMachine) -> Vec<&'static str> {
    let block = parse_block(row.text);
    let is_comp = |item: &&Item| matches!(item, Item::Comp(_) | Item::BadCommand(_));
    let commands = block.items.iter().filter(is_comp).count();
    let rests = |question: Question| {
        let is_basis = |item: &Item| matches!(item, Item::Hash(it) if it.basis() == Some(question));
        block.items.iter().any(is_basis)
    };
    let asked = [
        (Question::WithMotion, commands > 0 && moves(&block)),
        (Question::OrderInBlock, commands > 1),
        (
            Question::LowerCase,
            block.faults.iter().any(|it| it.code == Code::Fc404),
        ),
        (Question::SkipLevel, block.skip.is_some()),
        (Question::MachineData, rests(Question::MachineData)),
        (Question::AxisExchange, rests(Question::AxisExchange)),
    ];
    let open = asked
        .into_iter()
        .filter(|(question, depends)| *depends && is_open(*question, loaded));
    open.map(|(question, _)| question.facts().rule).collect()
}

/// Returns whether a block holds words that may move an axis.
fn moves(block: &Block) -> bool {
    let is_axis = |word: &Word| match word.address {
        Address::Letter(letter) => b"XYZABCUVW".contains(&letter),
        Address::Name(_) | Address::Main(b'X'..=b'Z') => true,
        _ => false,
    };
    let items = block.items.iter().filter_map(|item| match item {
        Item::Word(word) => Some(word),
        _ => None,
    });
    block.words.iter().chain(items).any(is_axis)
}

/// Returns whether no control of this build has answered a question.
pub(super) fn is_open(question: Question, loaded: &LoadedMachine) -> bool {
    let machine = &loaded.machine;
    !matches!(
        machine.readings.basis(question, machine.build),
        Basis::Confirmed(_)
    )
}
