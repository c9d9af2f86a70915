//! Takes the records of a session.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use frictcomp::comp::Kind;
use frictcomp::interpreter::PossibleState;
use frictcomp::session::SavedState;
use frictcomp::timeline::{Record, Sink, StateView};
use serde::{Deserialize, Serialize};

use super::PyProgramRun;
use super::rows::{BlockRows, ShownColumns};
use crate::arrow::ArrowTable;
use crate::json::JsonText;
use crate::messages::{GivenMessages, PickledWord, PyMessage};
use crate::state::PyState;
use crate::work::Stop;

/// The results of a session other than its blocks and its messages.
#[derive(Serialize, Deserialize)]
pub(crate) struct RecordedSession {
    pub(crate) axes: Vec<String>,
    pub(crate) programs: Vec<PyProgramRun>,
    pub(crate) friction: BTreeMap<String, PickledWord>,
    /// Friction compensation at the start of the control, by axis.
    pub(crate) start_up: BTreeMap<String, PickledWord>,
    /// The possible states where ways differ, by axis.
    pub(crate) possible: JsonText,
    pub(crate) opaque: BTreeMap<String, u64>,
    pub(crate) is_assumed: bool,
    pub(crate) state: PyState,
    pub(crate) unrun: usize,
}

/// Records a session until it ends or is stopped.
pub(crate) struct Recorder {
    rows: BlockRows,
    programs: Vec<PyProgramRun>,
    said: GivenMessages,
    opaque: BTreeMap<String, u64>,
    start_up: BTreeMap<String, PickledWord>,
    is_assumed: bool,
    stop: Stop,
}

impl Recorder {
    /// Creates an empty recorder.
    pub(crate) fn new(shown: ShownColumns, stop: &Stop) -> Self {
        Self {
            rows: BlockRows::new(shown),
            programs: Vec::new(),
            said: GivenMessages::default(),
            opaque: BTreeMap::new(),
            start_up: BTreeMap::new(),
            is_assumed: false,
            stop: stop.clone(),
        }
    }

    /// Returns what was recorded, with the state at the end and the number of programs that did not run.
    pub(crate) fn finish(
        self,
        end: StateView<'_>,
        state: SavedState,
        unrun: usize,
    ) -> (RecordedSession, ArrowTable, GivenMessages) {
        let recorded = RecordedSession {
            axes: end.axes().map(|(_, name)| name.to_owned()).collect(),
            friction: friction(end),
            start_up: self.start_up,
            possible: possible(end),
            programs: self.programs,
            opaque: self.opaque,
            is_assumed: self.is_assumed,
            state: PyState::new(state),
            unrun,
        };
        (recorded, self.rows.into_table(end), self.said)
    }

    fn messages(&mut self, record: &Record<'_>) {
        let (program, seq) = match record {
            Record::Block(row) => (row.program, row.seq),
            Record::End(end) => {
                for note in end.notes {
                    self.rows.push_code(note.diagnostic.code.as_str());
                    let message = PyMessage::of_block(&note.diagnostic, end.program, note.seq);
                    self.said.messages.push(message);
                }
                return;
            }
            _ => return,
        };
        for said in record.diagnostics() {
            let said = said.diagnostic();
            self.said
                .messages
                .push(PyMessage::of_block(said, program, seq));
        }
    }
}

impl Sink for Recorder {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Session { remark, .. } => self.said.remark = remark.map(str::to_owned),
            Record::Machine(said) => self.said.messages.push(PyMessage::of(said)),
            Record::Program {
                program,
                file,
                name,
                state,
            } => self.programs.push(PyProgramRun {
                program: *program,
                file: (*file).to_owned(),
                name: name.map(str::to_owned),
                by: None,
                blocks: 0,
                start: friction(*state),
                end: BTreeMap::new(),
                possible: possible(*state),
            }),
            Record::Block(row) => {
                self.rows.push(row);
                if !row.diagnostics.is_empty() {
                    self.messages(record);
                }
            }
            // It is not a block; what follows has the state that the ways left.
            Record::Join(_) => {}
            Record::End(end) => {
                self.messages(record);
                self.rows.end();
                if let Some(run) = self.programs.last_mut() {
                    run.by = Some(end.by.as_str().into());
                    run.blocks = end.seq;
                    run.end = friction(end.state);
                    run.possible = possible(end.state);
                }
            }
            Record::Summary(summary) => {
                self.said.count_all(&summary.counts);
                self.opaque = summary.opaque.clone();
                let axes = summary.axes.iter().map(|axis| {
                    let name = summary.state.name(axis.axis);
                    (name.to_owned(), axis.start_up.as_str().into())
                });
                self.start_up = axes.collect();
                self.is_assumed = !summary.assumed.is_empty();
            }
        }
        self.stop.flow()
    }
}

/// Friction compensation of each listed axis.
fn friction(state: StateView<'_>) -> BTreeMap<String, PickledWord> {
    let axes = state.axes();
    axes.map(|(axis, name)| {
        let word = state.state(axis, Kind::Frict).as_str();
        (name.to_owned(), word.into())
    })
    .collect()
}

/// The possible states of friction compensation where ways differ, by axis (R14.2).
fn possible(state: StateView<'_>) -> JsonText {
    let axes = state.axes().filter_map(|(axis, name)| {
        let mut split = state.possible.iter();
        let found = split.find(|it| it.axis == axis && it.kind == Kind::Frict)?;
        Some((name, found.states.as_slice()))
    });
    let axes: BTreeMap<&str, &[PossibleState]> = axes.collect();
    JsonText(serde_json::to_string(&axes).expect("names and texts are JSON"))
}
