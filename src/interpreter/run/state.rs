//! Everything that a run depends on, as data that is saved and resumed.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::control::ControlState;
use super::mentioned::MentionedUnknowns;
use super::path::{AskedCondition, EndedPath, Last, Path, RunTrack};
use super::step::ControlStep;
use crate::comp::Compensation;
use crate::interpreter::coordinates::modal::Modal;
use crate::interpreter::values::reads::Reads;
use crate::interpreter::values::work_budget::WorkBudget;
use crate::interpreter::ways::found_states::FoundStates;
use crate::interpreter::ways::question::Condition;
use crate::interpreter::ways::set::WaySet;
use crate::machine::{Axis, AxisSet, Machine, Origin};
use crate::readings::QuestionSet;

/// Number of different words of a program that are reported once.
const MAX_ONCE: usize = 1000;

/// The path that is executed, with what all paths of the run have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RunState {
    /// RunState of the control.
    pub(crate) control: ControlState,
    /// The way to it.
    pub(crate) track: RunTrack,
    /// The ways that have ended.
    pub(crate) ended: Vec<EndedPath>,
    /// The conditions that ways name, by their numbers.
    pub(crate) conditions: Vec<Condition>,
    /// Those of the program that read no value, and so have one answer on all ways.
    pub(crate) asked: Vec<AskedCondition>,
    /// Executed blocks of the program.
    pub(crate) seq: u64,
    /// Executed blocks of the session.
    pub(crate) blocks: u64,
    pub(crate) work: WorkBudget,
    /// Words and commands that were passed over.
    pub(crate) opaque: BTreeMap<String, u64>,
    /// The words of the program that were reported, once each (R2.94).
    pub(crate) once: BTreeSet<String>,
    /// The axes that occurred.
    pub(crate) occurred: Vec<bool>,
    /// Whether a loop is compared with an earlier pass, so that what is read matters.
    pub(crate) watching: bool,
    pub(crate) reads: RefCell<Reads>,
    /// The last executed block of the main program.
    pub(crate) last: Option<Last>,
    /// First step of a paused run when it continues.
    pub(crate) parked: Option<ControlStep>,
    /// The unknown values that messages were about.
    pub(crate) mentioned: MentionedUnknowns,
    /// The open questions whose readings results depend on (R15.3).
    pub(crate) rests_on: QuestionSet,
}

impl RunState {
    /// The state before the first program.
    pub(super) fn at_start(machine: &Machine, compensation: Compensation) -> Self {
        let configured = machine.axis_set == AxisSet::Configured;
        let occurred = |axis: &Axis| configured || axis.frict_comp_origin != Origin::Default;
        let modal = Modal::at_start(machine.axes.len(), &machine.channel);
        Self {
            control: ControlState::new(compensation, modal),
            track: RunTrack::default(),
            ended: Vec::new(),
            conditions: Vec::new(),
            asked: Vec::new(),
            seq: 0,
            blocks: 0,
            work: WorkBudget::default(),
            opaque: BTreeMap::new(),
            once: BTreeSet::new(),
            occurred: machine.axes.iter().map(occurred).collect(),
            watching: false,
            reads: RefCell::default(),
            last: None,
            parked: None,
            mentioned: MentionedUnknowns::default(),
            rests_on: QuestionSet::default(),
        }
    }

    /// The states of the control here and where paths have ended.
    pub(crate) fn controls_mut(&mut self) -> impl Iterator<Item = &mut ControlState> {
        let ended = self.ended.iter_mut().map(|ended| &mut ended.path.control);
        std::iter::once(&mut self.control).chain(ended)
    }

    /// The states that the program found, where it is now.
    pub(crate) fn found_states(&self) -> FoundStates<'_> {
        FoundStates {
            history: &self.control.history,
            reach: &self.track.reach,
            conditions: &self.conditions,
        }
    }

    /// The run goes on only on some of the ways that lead here.
    pub(crate) fn go_on_with(&mut self, ways: WaySet) {
        self.track.reach = ways;
        let control = &mut self.control;
        control
            .history
            .narrow(&self.track.reach, &mut control.compensation);
    }

    /// Takes the way that was being executed.
    pub(crate) fn leave_path(&mut self) -> Path {
        Path {
            control: self.control.clone(),
            track: std::mem::take(&mut self.track),
            parted: self.seq,
        }
    }

    /// Whether a word that is reported once occurs for the first time in the program.
    pub(crate) fn is_new_word(&mut self, word: &str) -> bool {
        let words = &mut self.once;
        words.len() < MAX_ONCE && words.insert(word.to_owned())
    }
}
