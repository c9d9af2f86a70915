//! The states of friction compensation over the executed blocks of a program, as bars.

use std::collections::BTreeMap;

use arrow_array::cast::AsArray;
use arrow_array::types::{Int8Type, Int32Type, Int64Type, UInt32Type, UInt64Type};
use arrow_array::{Array, RecordBatch};
use frictcomp::comp::{Kind, State};
use frictcomp_report::svg::{Band, BandChart, BandRow, BandState, ChartAxis, StartUpRelation};

use super::PyProgramRun;
use super::rows::state_name;
use crate::arrow::ArrowTable;
use crate::messages::PickledWord;
use crate::states::STATES;

/// The maximum number of bars of an axis that are kept separate.
const MOST_BARS: usize = 5000;

/// The bars of a program.
pub(super) struct Bars<'a> {
    pub(super) run: &'a PyProgramRun,
    pub(super) axes: &'a [String],
    /// The states after a start of the control.
    pub(super) start_up: &'a BTreeMap<String, PickledWord>,
}

impl Bars<'_> {
    /// The bars of all axes, with the table of the session.
    pub(super) fn chart(&self, table: &ArrowTable) -> BandChart {
        let rows = self.axes.iter().map(|axis| self.row(axis, table));
        let rows: Vec<BandRow> = rows.collect();
        let PyProgramRun {
            file, by, blocks, ..
        } = self.run;
        let end = match by {
            Some(by) => format!("ended by {by}"),
            None => "did not end".to_owned(),
        };
        let states = rows.iter().map(described).collect::<Vec<_>>();
        BandChart {
            title: format!("{file}: {blocks} executed blocks, {end}"),
            description: match states.as_slice() {
                [] => "No axis occurred.".to_owned(),
                states => states.join(" "),
            },
            x: ChartAxis::linear("executed block"),
            steps: Some((0.0, place(*blocks))),
            rows,
        }
    }

    fn row(&self, axis: &str, table: &ArrowTable) -> BandRow {
        let start_up = state(self.start_up.get(axis));
        let start = self.run.start.get(axis);
        let mut row = AxisBars {
            axis,
            start_up,
            bands: Vec::new(),
        };
        if let Some(start) = start {
            row.extend(0, state(Some(start)), || "at program start".to_owned());
        }
        for batch in &table.batches {
            row.extend_over(batch, self.run.program);
        }
        BandRow {
            label: axis.to_owned(),
            bands: row.bands,
        }
    }
}

/// The bars of an axis so far.
struct AxisBars<'a> {
    axis: &'a str,
    start_up: State,
    bands: Vec<Band>,
}

impl AxisBars<'_> {
    /// Adds the blocks of a program in a batch.
    fn extend_over(&mut self, batch: &RecordBatch, program: u32) {
        let column = state_name(self.axis, Kind::Frict);
        let Some(states) = batch.column_by_name(&column) else {
            return;
        };
        let states = states.as_dictionary::<Int8Type>();
        let words = states.values().as_string::<i32>();
        let programs = batch["program"].as_primitive::<UInt32Type>().values();
        let seqs = batch["seq"].as_primitive::<UInt64Type>();
        let begin = programs.partition_point(|it| *it < program);
        let end = programs.partition_point(|it| *it <= program);
        for at in begin..end {
            let word = states.key(at).map_or("", |key| words.value(key));
            let seq = seqs.value(at);
            self.extend(seq, known(word), || told(batch, at, seq));
        }
    }

    /// The state after a block.
    fn extend(&mut self, seq: u64, state: State, place_in_words: impl FnOnce() -> String) {
        let (from, to) = (place(seq) - 0.5, place(seq) + 0.5);
        let is_full = self.bands.len() >= MOST_BARS;
        match self.bands.last_mut() {
            Some(last) if last.state == BandState::One(state) => last.to = to,
            Some(last) if is_full => {
                last.state = BandState::Changing;
                last.relation = StartUpRelation::StartUp;
                last.to = to;
            }
            _ => self.bands.push(Band {
                from,
                to,
                state: BandState::One(state),
                relation: StartUpRelation::of(state, self.start_up),
                title: format!("{} {} {}", self.axis, state.as_str(), place_in_words()),
                href: None,
            }),
        }
    }
}

/// "from N45, part.nc:5, executed block 4"
fn told(batch: &RecordBatch, at: usize, seq: u64) -> String {
    let numbers = batch["n"].as_primitive::<Int64Type>();
    let number = numbers
        .is_valid(at)
        .then(|| format!("N{}, ", numbers.value(at)));
    let number = number.unwrap_or_default();
    let files = batch["file"].as_dictionary::<Int32Type>();
    let names = files.values().as_string::<i32>();
    let file = files.key(at).map_or("", |key| names.value(key));
    let line = batch["line"].as_primitive::<UInt32Type>().value(at);
    format!("from {number}{file}:{line}, executed block {seq}")
}

/// The states of a row in words, at most the first few.
fn described(row: &BandRow) -> String {
    const TOLD: usize = 6;
    let words = row.bands.iter().map(|band| band.state.as_str());
    let words = words.take(TOLD).collect::<Vec<_>>().join(", then ");
    let more = match row.bands.len().saturating_sub(TOLD) {
        0 => String::new(),
        more => format!(" and {more} more states"),
    };
    format!("{}: {words}{more}.", row.label)
}

fn state(word: Option<&PickledWord>) -> State {
    word.map_or(State::Unknown, |word| known(word))
}

fn known(word: &str) -> State {
    let mut states = STATES.into_iter();
    states
        .find(|it| it.as_str() == word)
        .unwrap_or(State::Unknown)
}

/// A block as a place on the axis; beyond 2^52 neighbours fall together.
#[allow(clippy::cast_precision_loss)]
fn place(block: u64) -> f64 {
    block as f64
}
