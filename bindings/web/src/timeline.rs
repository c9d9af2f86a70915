//! The parts of a run that the page shows: blocks, messages, the end.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::lists::AxisType;
use frictcomp::machine::AxisSet;
use frictcomp::timeline::{AxisSummary, Record, Sink};
use frictcomp_report::{Headline, headline};

use crate::rows::ExecutedRows;
use crate::watched::show_progress;

/// The maximum number of messages that are kept; more are only counted.
const MOST_MESSAGES: usize = 10_000;

/// Blocks between two progress reports.
const STEP: u64 = 1 << 15;

/// A message, and the number of the block that it follows; 0 before the first.
#[derive(Debug)]
pub(crate) struct PlacedMessage {
    pub(crate) after: u64,
    pub(crate) diagnostic: Diagnostic,
}

/// One axis of the machine.
#[derive(Debug)]
pub(crate) struct TimelineAxis {
    pub(crate) name: String,
    pub(crate) axis_type: AxisType,
    pub(crate) start_up: State,
    pub(crate) listed: bool,
}

/// The part of a run that the page shows.
#[derive(Debug, Default)]
pub(crate) struct Timeline {
    pub(crate) axes: Vec<TimelineAxis>,
    pub(crate) axes_as_they_occur: bool,
    pub(crate) remark: Option<String>,
    pub(crate) name: Option<String>,
    pub(crate) rows: ExecutedRows,
    /// Messages by the blocks that they follow.
    pub(crate) said: Vec<PlacedMessage>,
    pub(crate) left_out: u64,
    pub(crate) ended_by: Option<EndedBy>,
    pub(crate) counts: BTreeMap<Severity, u64>,
    pub(crate) opaque: BTreeMap<String, u64>,
    pub(crate) summaries: Vec<AxisSummary>,
    /// The verdict on the run, if something is left to be said.
    pub(crate) headline: Option<Headline>,
}

impl Timeline {
    fn say(&mut self, after: u64, diagnostic: &Diagnostic) {
        if self.said.len() >= MOST_MESSAGES {
            self.left_out += 1;
            return;
        }
        self.said.push(PlacedMessage {
            after,
            diagnostic: diagnostic.clone(),
        });
    }
}

impl Sink for Timeline {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match *record {
            Record::Session { state, remark } => {
                let start_up = state.machine.compensation();
                let axes = state.machine.axes.iter().zip(state.listed).enumerate();
                self.axes = axes
                    .map(|(at, (axis, listed))| TimelineAxis {
                        name: axis.name.clone(),
                        axis_type: axis.axis_type,
                        start_up: start_up.state(AxisIndex::new(at), Kind::Frict),
                        listed: *listed,
                    })
                    .collect();
                self.axes_as_they_occur = state.machine.axis_set == AxisSet::AsTheyOccur;
                self.remark = remark.map(str::to_owned);
            }
            Record::Machine(diagnostic) => self.say(0, diagnostic),
            Record::Program { name, state, .. } => {
                self.name = name.map(str::to_owned);
                self.rows.see(state);
            }
            Record::Block(ref row) => {
                self.rows.push(row);
                for diagnostic in row.diagnostics {
                    self.say(self.rows.blocks, diagnostic);
                }
                if self.rows.blocks.is_multiple_of(STEP) {
                    let blocks = u32::try_from(self.rows.blocks).unwrap_or(u32::MAX);
                    let line = if row.level.is_none() { row.line } else { 0 };
                    show_progress(blocks, line);
                }
            }
            Record::Join(ref join) => self.rows.see(join.state),
            Record::End(ref end) => {
                for note in end.notes {
                    self.say(note.seq, &note.diagnostic);
                }
                self.rows.see(end.state);
                self.said.sort_by_key(|said| said.after);
                self.ended_by = Some(end.by);
            }
            Record::Summary(summary) => {
                self.counts.clone_from(&summary.counts);
                self.opaque.clone_from(summary.opaque);
                self.summaries.clone_from(&summary.axes);
                self.headline = headline(summary, self.ended_by);
                for axis in &summary.axes {
                    self.axes[axis.axis.get()].listed = true;
                }
            }
        }
        ControlFlow::Continue(())
    }
}
