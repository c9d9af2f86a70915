//! One row per block, and one where ways meet (R14.2), for spreadsheets (R9.15), quoted according to RFC 4180.

use std::io::Write;
use std::ops::ControlFlow;

use frictcomp::comp::{AxisIndex, Change, Kind};
use frictcomp::interpreter::PositionFrame;
use frictcomp::timeline::{End, Join, Record, Row, Sink, StateView};

use super::output::{Gathered, Output};
use super::view::View;
use crate::wording::{KeptText, integer, push_field, visible_line};

/// Last column of a row that is not a block.
const JOIN: &[u8] = b"join";

/// The last row, which stays open in the output: it also takes the codes of messages at program end.
#[derive(Debug, Default)]
struct Held {
    codes: String,
    /// The field of the last column.
    branch: Vec<u8>,
    /// Whether the row is written even without another message about it.
    wanted: bool,
}

/// Writes one row per block.
#[derive(Debug)]
pub struct Csv<W> {
    output: Output<W>,
    view: View,
    held: Held,
    /// The field `file`.
    file: KeptText<String>,
    /// The fields of the axes for a version of their states.
    states: KeptText<u64>,
    changes: String,
    positions: Positions,
    /// The fields `file` and `line` of the last row, if it belongs to some ways only.
    place: Vec<u8>,
}

/// Columns for the axis positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Positions {
    /// A column `X_pos` for each axis, in mm or degrees, empty where the position is not known, and
    /// a column `frame` that says whether positions are those of the `machine` or as `programmed`.
    Shown,
    /// No such columns.
    #[default]
    Hidden,
}

impl<W: Write> Csv<W> {
    /// Returns a timeline of comma-separated values.
    pub fn new(writer: W, view: View) -> Self {
        Self {
            output: Output::new(writer),
            view,
            held: Held::default(),
            file: KeptText::default(),
            states: KeptText::default(),
            changes: String::new(),
            positions: Positions::Hidden,
            place: Vec::new(),
        }
    }

    /// Switches the columns of positions on or off.
    pub fn with_positions(self, positions: Positions) -> Self {
        Self { positions, ..self }
    }

    /// Writes the columns: every axis of the machine, whether it occurred or not.
    fn header(&mut self, state: StateView<'_>) {
        let out = &mut self.output.bytes;
        out.extend_from_slice(b"program,seq,file,line,n,text,");
        for axis in &state.machine.axes {
            push_field(out, &axis.name);
            out.push(b',');
        }
        if self.positions == Positions::Shown {
            for axis in &state.machine.axes {
                push_field(out, &axis.name);
                out.extend_from_slice(b"_pos,");
            }
            out.extend_from_slice(b"frame,");
        }
        out.extend_from_slice(b"changes,codes,branch\n");
    }

    fn block(&mut self, row: &Row<'_>) {
        self.release();
        self.held.wanted = self.view.shows(row);
        let out = self.output.open_bytes();
        integer(out, row.program);
        out.push(b',');
        integer(out, row.seq);
        out.push(b',');
        out.extend_from_slice(self.file.of(row.file, |out| append_file(out, row.file)));
        integer(out, row.line);
        out.push(b',');
        if let Some(number) = row.number {
            integer(out, number);
        }
        out.push(b',');
        push_field(out, row.text);
        out.push(b',');
        out.extend_from_slice(
            self.states
                .of(&row.state.version, |out| append_states(out, row.state)),
        );
        if self.positions == Positions::Shown {
            append_positions(out, row);
        }
        if !row.changes.is_empty() {
            self.changes.clear();
            for change in row.changes {
                if self.view.kinds.contains(change.kind) {
                    join(&mut self.changes, |list| {
                        push_change(list, *change, row.state);
                    });
                }
            }
            push_field(out, &self.changes);
        }
        out.push(b',');
        for diagnostic in row.diagnostics {
            join(&mut self.held.codes, |list| {
                list.push_str(diagnostic.code.as_str());
            });
        }
        self.place.clear();
        if let Some(words) = row.branch_in_words() {
            push_field(&mut self.held.branch, &words);
            append_place(&mut self.place, row.file, row.line);
        }
    }

    fn join(&mut self, join: &Join<'_>) {
        self.place.clear();
        append_place(&mut self.place, join.file, join.line);
        self.joined(join.program, join.seq, join.state);
    }

    /// Holds the states possible on all ways as a separate row: the row before it may belong to some ways
    /// only.
    fn joined(&mut self, program: u32, seq: u64, state: StateView<'_>) {
        self.release();
        self.held.wanted = true;
        let out = self.output.open_bytes();
        integer(out, program);
        out.push(b',');
        integer(out, seq);
        out.push(b',');
        out.append(&mut self.place);
        // It has neither a number nor a text, nor positions, nor changes.
        out.extend_from_slice(b",,,");
        out.extend_from_slice(
            self.states
                .of(&state.version, |out| append_states(out, state)),
        );
        if self.positions == Positions::Shown {
            let columns = state.machine.axes.len() + 1;
            out.extend(std::iter::repeat_n(b',', columns));
        }
        out.push(b',');
        self.held.branch.extend_from_slice(JOIN);
    }

    fn end(&mut self, end: &End<'_>) {
        if !self.place.is_empty() {
            self.joined(end.program, end.seq, end.state);
        }
        for note in end.notes {
            join(&mut self.held.codes, |list| {
                list.push_str(note.diagnostic.code.as_str());
            });
            self.held.wanted = true;
        }
        self.release();
    }

    /// Ends the row that is open, or takes it back.
    fn release(&mut self) {
        if let Some(start) = self.output.open.take() {
            let out = &mut self.output.bytes;
            if self.held.wanted {
                if !self.held.codes.is_empty() {
                    push_field(out, &self.held.codes);
                }
                out.push(b',');
                out.extend_from_slice(&self.held.branch);
                out.push(b'\n');
            } else {
                out.truncate(start);
            }
        }
        self.held.codes.clear();
        self.held.branch.clear();
        self.held.wanted = false;
    }
}

impl<W: Write> Sink for Csv<W> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Session { state, .. } => self.header(*state),
            Record::Block(row) => self.block(row),
            Record::Join(join) => self.join(join),
            Record::End(end) => {
                self.end(end);
                return self.output.flush();
            }
            Record::Machine(_) | Record::Program { .. } | Record::Summary(_) => {}
        }
        self.output.settle()
    }
}

impl<W: Write> Gathered for Csv<W> {
    type Writer = W;

    fn output(&self) -> &Output<W> {
        &self.output
    }

    fn output_mut(&mut self) -> &mut Output<W> {
        &mut self.output
    }

    fn close(&mut self) {
        self.release();
    }
}

fn append_file(out: &mut Vec<u8>, file: &str) {
    push_field(out, &visible_line(file));
    out.push(b',');
}

fn append_place(out: &mut Vec<u8>, file: &str, line: u32) {
    append_file(out, file);
    integer(out, line);
}

fn append_states(out: &mut Vec<u8>, state: StateView<'_>) {
    for (index, _) in state.machine.axes.iter().enumerate() {
        let word = state.state(AxisIndex::new(index), Kind::Frict).as_str();
        out.extend_from_slice(word.as_bytes());
        out.push(b',');
    }
}

fn append_positions(out: &mut Vec<u8>, row: &Row<'_>) {
    let axes = row.state.machine.axes.iter().enumerate();
    let mut frame = PositionFrame::Machine;
    for (index, _) in axes {
        let position = row.modal.position(AxisIndex::new(index));
        if let Some(value) = position.value {
            // Rounded to a nanometre, so that sums of decimals look as they were programmed.
            let rounded = (value * 1e6).round() / 1e6;
            out.extend_from_slice(rounded.to_string().as_bytes());
        }
        out.push(b',');
        frame = position.frame;
    }
    out.extend_from_slice(match frame {
        PositionFrame::Machine => b"machine,",
        _ => b"programmed,",
    });
}

/// Appends an item to a list with `;` between its items.
fn join(list: &mut String, append: impl FnOnce(&mut String)) {
    if !list.is_empty() {
        list.push(';');
    }
    append(list);
}

fn push_change(list: &mut String, change: Change, state: StateView<'_>) {
    list.push_str(state.name(change.axis));
    list.push(':');
    list.push_str(change.kind.as_str());
    list.push(':');
    list.push_str(change.from.as_str());
    list.push('>');
    list.push_str(change.to.as_str());
}
