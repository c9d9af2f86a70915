//! The records of chapter 9.2 as JSON objects, one after another in one buffer.

use frictcomp::comp::{Change, Kind, KindSet};
use frictcomp::diagnostic::{Diagnostic, Fix, Severity};
use frictcomp::timeline::{
    End, Join, Possible, Record, Repeat, Row, SCHEMA, StateView, Summary, TOOL,
};

use super::assumptions::ReadingsInForce;
use super::strings::{integer, optional, separated, string};
use super::view::View;

/// Text before and after an object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) before: &'static [u8],
    pub(super) after: &'static [u8],
}

/// The program and block to which a diagnostic belongs.
#[derive(Debug, Clone, Copy)]
struct Place {
    program: u32,
    seq: u64,
}

/// Appends records; keeps the bytes of the last state, since most blocks change nothing.
#[derive(Debug)]
pub(super) struct Encoder {
    view: View,
    frame: Frame,
    state: Vec<u8>,
    version: Option<u64>,
}

impl Encoder {
    pub(super) fn new(view: View, frame: Frame) -> Self {
        Self {
            view,
            frame,
            state: Vec::new(),
            version: None,
        }
    }

    /// Appends the objects of a record, each in its frame.
    pub(super) fn append(&mut self, out: &mut Vec<u8>, record: &Record<'_>) {
        match *record {
            Record::Session { state, remark } => {
                self.open(out, "session");
                out.extend_from_slice(b",\"schema\":");
                integer(out, SCHEMA);
                out.extend_from_slice(b",\"tool\":");
                string(out, TOOL);
                out.extend_from_slice(b",\"axes\":[");
                separated(out, state.axes(), |out, (_, name)| string(out, name));
                out.push(b']');
                if let Some(remark) = remark {
                    out.extend_from_slice(b",\"remark\":");
                    string(out, remark);
                }
                self.close(out, state);
            }
            Record::Machine(diagnostic) => self.diagnostic(out, diagnostic, None),
            Record::Program {
                program,
                file,
                name,
                state,
            } => {
                self.open(out, "program");
                out.extend_from_slice(b",\"program\":");
                integer(out, program);
                out.extend_from_slice(b",\"file\":");
                string(out, file);
                out.extend_from_slice(b",\"name\":");
                optional(out, name);
                self.close(out, state);
            }
            Record::Block(ref row) => self.block(out, row),
            Record::Join(ref join) => self.join(out, join),
            Record::End(ref end) => self.end(out, end),
            Record::Summary(summary) => self.summary(out, summary),
        }
    }

    fn block(&mut self, out: &mut Vec<u8>, row: &Row<'_>) {
        if !self.view.shows(row) {
            return;
        }
        self.open(out, "block");
        out.extend_from_slice(b",\"program\":");
        integer(out, row.program);
        out.extend_from_slice(b",\"seq\":");
        integer(out, row.seq);
        out.extend_from_slice(b",\"file\":");
        string(out, row.file);
        out.extend_from_slice(b",\"line\":");
        integer(out, row.line);
        out.extend_from_slice(b",\"n\":");
        match row.number {
            Some(number) => integer(out, number),
            None => out.extend_from_slice(b"null"),
        }
        if let Some(level) = row.level {
            out.extend_from_slice(b",\"level\":");
            integer(out, level);
        }
        out.extend_from_slice(b",\"text\":");
        string(out, row.text);
        if let Some(branch) = row.branch {
            out.extend_from_slice(b",\"branch\":");
            let _ = serde_json::to_writer(&mut *out, branch);
        }
        self.changes(out, row.changes, row.state);
        self.close(out, row.state);
        let place = Place {
            program: row.program,
            seq: row.seq,
        };
        for diagnostic in row.diagnostics {
            self.diagnostic(out, diagnostic, Some(place));
        }
    }

    fn join(&mut self, out: &mut Vec<u8>, join: &Join<'_>) {
        self.open(out, "join");
        out.extend_from_slice(b",\"program\":");
        integer(out, join.program);
        out.extend_from_slice(b",\"seq\":");
        integer(out, join.seq);
        out.extend_from_slice(b",\"file\":");
        string(out, join.file);
        out.extend_from_slice(b",\"line\":");
        integer(out, join.line);
        self.close(out, join.state);
    }

    fn end(&mut self, out: &mut Vec<u8>, end: &End<'_>) {
        for note in end.notes {
            let place = Place {
                program: end.program,
                seq: note.seq,
            };
            self.diagnostic(out, &note.diagnostic, Some(place));
        }
        self.open(out, "end");
        out.extend_from_slice(b",\"program\":");
        integer(out, end.program);
        out.extend_from_slice(b",\"seq\":");
        integer(out, end.seq);
        out.extend_from_slice(b",\"by\":");
        string(out, end.by.as_str());
        // Program end never changes friction compensation (R1.27); kinds with manual activation
        // fall off, and their reader asked for them with `--kinds`.
        if end
            .changes
            .iter()
            .any(|change| self.view.kinds.contains(change.kind))
        {
            self.changes(out, end.changes, end.state);
        }
        if !end.repeated.is_empty() {
            repeats(out, end.repeated);
        }
        self.close(out, end.state);
    }

    fn summary(&mut self, out: &mut Vec<u8>, summary: &Summary<'_>) {
        self.open(out, "summary");
        out.extend_from_slice(b",\"programs\":");
        integer(out, summary.programs);
        out.extend_from_slice(b",\"blocks\":");
        integer(out, summary.blocks);
        out.extend_from_slice(b",\"errors\":");
        integer(out, summary.count(Severity::Error));
        out.extend_from_slice(b",\"warnings\":");
        integer(out, summary.count(Severity::Warning));
        out.extend_from_slice(b",\"opaque\":{");
        separated(out, summary.opaque, |out, (word, count)| {
            string(out, word);
            out.push(b':');
            integer(out, *count);
        });
        out.push(b'}');
        if summary.uncompensated().next().is_some() {
            uncompensated(out, summary);
        }
        let rests_on = ReadingsInForce::of(summary.rests_on, summary.state.machine);
        append_rests_on(out, &rests_on);
        self.close(out, summary.state);
    }

    fn diagnostic(&self, out: &mut Vec<u8>, diagnostic: &Diagnostic, place: Option<Place>) {
        self.open(out, "diagnostic");
        if let Some(place) = place {
            out.extend_from_slice(b",\"program\":");
            integer(out, place.program);
            out.extend_from_slice(b",\"seq\":");
            integer(out, place.seq);
        }
        append_diagnostic(out, diagnostic);
        out.push(b'}');
        out.extend_from_slice(self.frame.after);
    }

    fn changes(&self, out: &mut Vec<u8>, changes: &[Change], state: StateView<'_>) {
        out.extend_from_slice(b",\"changes\":[");
        let selected = changes
            .iter()
            .filter(|change| self.view.kinds.contains(change.kind));
        separated(out, selected, |out, change| {
            out.extend_from_slice(b"{\"axis\":");
            string(out, state.name(change.axis));
            out.extend_from_slice(b",\"kind\":");
            string(out, change.kind.as_str());
            out.extend_from_slice(b",\"from\":");
            string(out, change.from.as_str());
            out.extend_from_slice(b",\"to\":");
            string(out, change.to.as_str());
            out.push(b'}');
        });
        out.push(b']');
    }

    fn open(&self, out: &mut Vec<u8>, record: &str) {
        out.extend_from_slice(self.frame.before);
        out.extend_from_slice(b"{\"record\":\"");
        out.extend_from_slice(record.as_bytes());
        out.push(b'"');
    }

    /// Appends the state and ends the object.
    fn close(&mut self, out: &mut Vec<u8>, state: StateView<'_>) {
        if self.version != Some(state.version) {
            self.version = Some(state.version);
            self.state.clear();
            append_state(&mut self.state, state, self.view);
        }
        out.extend_from_slice(&self.state);
        out.push(b'}');
        out.extend_from_slice(self.frame.after);
    }
}

/// Appends the keys of a diagnostic from `code` on.
pub(super) fn append_diagnostic(out: &mut Vec<u8>, diagnostic: &Diagnostic) {
    let (start, end) = (diagnostic.place.start(), diagnostic.place.end());
    out.extend_from_slice(b",\"code\":");
    string(out, diagnostic.code.as_str());
    out.extend_from_slice(b",\"severity\":");
    string(out, diagnostic.severity.as_str());
    out.extend_from_slice(b",\"file\":");
    string(out, &diagnostic.place.file);
    out.extend_from_slice(b",\"line\":");
    integer(out, start.line);
    out.extend_from_slice(b",\"column\":");
    integer(out, start.column);
    out.extend_from_slice(b",\"end_line\":");
    integer(out, end.line);
    out.extend_from_slice(b",\"end_column\":");
    integer(out, end.column);
    out.extend_from_slice(b",\"axis\":");
    optional(out, diagnostic.axis.as_deref());
    out.extend_from_slice(b",\"message\":");
    string(out, &diagnostic.message);
    out.extend_from_slice(b",\"help\":[");
    separated(out, &diagnostic.advice, |out, advice| {
        string(out, &advice.to_string());
    });
    out.push(b']');
    if !diagnostic.ends.is_empty() {
        out.extend_from_slice(b",\"ends\":[");
        separated(out, &diagnostic.ends, |out, end| {
            out.extend_from_slice(b"{\"file\":");
            string(out, &end.file);
            out.extend_from_slice(b",\"line\":");
            integer(out, end.start().line);
            out.push(b'}');
        });
        out.push(b']');
    }
    if !diagnostic.fixes.is_empty() {
        out.extend_from_slice(b",\"fixes\":[");
        separated(out, &diagnostic.fixes, append_fix);
        out.push(b']');
    }
    let reached_from = &diagnostic.reached_from;
    if !reached_from.is_empty() {
        out.extend_from_slice(b",\"reached_from\":[");
        separated(out, reached_from.programs(), |out, file| string(out, file));
        out.push(b']');
    }
    if let Some(count) = reached_from.count_beyond_names() {
        out.extend_from_slice(b",\"reached_from_count\":");
        integer(out, count);
    }
}

fn append_fix(out: &mut Vec<u8>, fix: &Fix) {
    let (start, end) = (fix.place.start(), fix.place.end());
    out.extend_from_slice(b"{\"file\":");
    string(out, &fix.place.file);
    for (key, number) in [
        (&b"line"[..], start.line),
        (b"column", start.column),
        (b"end_line", end.line),
        (b"end_column", end.column),
    ] {
        out.extend_from_slice(b",\"");
        out.extend_from_slice(key);
        out.extend_from_slice(b"\":");
        integer(out, number);
    }
    out.extend_from_slice(b",\"text\":");
    string(out, &fix.text);
    out.extend_from_slice(b",\"safety\":");
    string(out, fix.safety.as_str());
    out.push(b'}');
}

/// Appends `friction`, and `compensation` when other kinds are selected (R9.12).
fn append_state(out: &mut Vec<u8>, state: StateView<'_>, view: View) {
    out.extend_from_slice(b",\"friction\":{");
    separated(out, state.axes(), |out, (axis, name)| {
        string(out, name);
        out.push(b':');
        string(out, state.state(axis, Kind::Frict).as_str());
    });
    out.push(b'}');
    let possible = Possible::of(state, view.kinds);
    if view.kinds == KindSet::of(Kind::Frict) {
        return append_possible(out, possible);
    }
    out.extend_from_slice(b",\"compensation\":{");
    separated(out, state.axes(), |out, (axis, name)| {
        string(out, name);
        out.extend_from_slice(b":{");
        separated(out, view.kinds.iter(), |out, kind| {
            string(out, kind.as_str());
            out.push(b':');
            string(out, state.state(axis, kind).as_str());
        });
        out.push(b'}');
    });
    out.push(b'}');
    append_possible(out, possible);
}

/// Appends `possible` where a state is unknown because ways differ (R14.2).
fn append_possible(out: &mut Vec<u8>, possible: Possible<'_>) {
    if !possible.is_empty() {
        out.extend_from_slice(b",\"possible\":");
        let _ = serde_json::to_writer(out, &possible);
    }
}

/// Appends `rests_on` where results rest on readings of open questions (R15.3).
pub(crate) fn append_rests_on(out: &mut Vec<u8>, rests_on: &ReadingsInForce) {
    if !rests_on.is_empty() {
        out.extend_from_slice(b",\"rests_on\":");
        // Memory takes every byte, and the readings are texts.
        let _ = serde_json::to_writer(out, rests_on);
    }
}

/// Axis → feed moves while it was not active (R13.12).
fn uncompensated(out: &mut Vec<u8>, summary: &Summary<'_>) {
    out.extend_from_slice(b",\"uncompensated\":{");
    separated(out, summary.uncompensated(), |out, axis| {
        string(out, summary.state.name(axis.axis));
        out.push(b':');
        // Memory takes every byte, and the counts are numbers.
        let _ = serde_json::to_writer(out, &axis.feed_moves);
    });
    out.push(b'}');
}

/// Writes the number of repetitions of each remark that was made only once for its place.
fn repeats(out: &mut Vec<u8>, repeated: &[Repeat]) {
    out.extend_from_slice(b",\"repeated\":[");
    for (at, repeat) in repeated.iter().enumerate() {
        if at > 0 {
            out.push(b',');
        }
        out.extend_from_slice(b"{\"code\":");
        string(out, repeat.code.as_str());
        out.extend_from_slice(b",\"file\":");
        string(out, &repeat.file);
        out.extend_from_slice(b",\"line\":");
        integer(out, repeat.line);
        out.extend_from_slice(b",\"column\":");
        integer(out, repeat.start.column);
        out.extend_from_slice(b",\"times\":");
        integer(out, repeat.times);
        out.push(b'}');
    }
    out.push(b']');
}
