//! The timeline for people: a column per axis, changes that are visible at a glance, diagnostics
//! under their block, and what is left to do after program end.

mod columns;
mod line;
mod summary;

pub use summary::headline;

use std::io::Write;
use std::ops::ControlFlow;

use frictcomp::comp::{Change, Kind, State};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{End, Record, Row, Sink, StateView};

use super::output::{Gathered, Output};
use super::view::{Blocks, View};
use crate::wording::{Detail, Look, grouped, leading, listed, render, visible_line, wrap};
use columns::AxisColumns;
use line::{BOLD, DIM, GUTTER, MARK, Paragraph, TextLine};

/// Width below which diagnostics are indented less.
const NARROW: usize = 60;

/// The treatment of blocks that change nothing and have no message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Runs {
    /// Several of them in a row become one line with their count.
    #[default]
    Folded,
    /// A line for each block.
    Full,
}

/// The appearance of the timeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TextOptions {
    /// The shown blocks and kinds.
    pub view: View,
    /// The treatment of blocks without a change.
    pub runs: Runs,
    /// Colours and width.
    pub look: Look,
    /// The extent of messages.
    pub messages: MessageExtent,
}

/// Extent to which a message is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum MessageExtent {
    /// Words, its place and its advice.
    #[default]
    Words,
    /// Code, place and axis, so that better words change nothing that was agreed (R18.30).
    Code,
}

impl TextOptions {
    /// Sets [`view`](Self::view).
    pub fn with_view(mut self, view: View) -> Self {
        self.view = view;
        self
    }

    /// Sets [`runs`](Self::runs).
    pub fn with_runs(mut self, runs: Runs) -> Self {
        self.runs = runs;
        self
    }

    /// Sets [`messages`](Self::messages).
    pub fn with_messages(mut self, messages: MessageExtent) -> Self {
        self.messages = messages;
        self
    }

    /// Sets [`look`](Self::look).
    pub fn with_look(mut self, look: Look) -> Self {
        self.look = look;
        self
    }
}

/// Blocks without a change that wait for their count.
#[derive(Debug, Default)]
struct Quiet {
    count: u64,
    /// The line of the first, for a run of one.
    first: Vec<u8>,
    /// The file of the first.
    file: String,
}

/// Writes the timeline for people.
#[derive(Debug)]
pub struct Text<W> {
    output: Output<W>,
    options: TextOptions,
    columns: AxisColumns,
    version: Option<u64>,
    quiet: Quiet,
    /// The head of a program, which waits for its first event.
    opening: Vec<u8>,
    /// The file of the last printed block.
    file: String,
    /// The end of the last program.
    ended: Option<EndedBy>,
    /// The possible states as last printed.
    possible: Vec<String>,
}

/// The possible states that are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Saying {
    /// States that were not printed before.
    New,
    All,
}

impl<W: Write> Text<W> {
    /// Returns a timeline as text. The columns show friction compensation, so its changes are always shown.
    pub fn new(writer: W, mut options: TextOptions) -> Self {
        options.view.kinds.insert(Kind::Frict);
        Self {
            output: Output::new(writer),
            options,
            columns: AxisColumns::default(),
            version: None,
            quiet: Quiet::default(),
            opening: Vec::new(),
            file: String::new(),
            ended: None,
            possible: Vec::new(),
        }
    }

    fn line(&mut self) -> TextLine<'_> {
        TextLine::new(&mut self.output.bytes, self.options.look.paint)
    }

    fn program(&mut self, file: &str, name: Option<&str>, state: StateView<'_>) {
        let begin = self.output.bytes.len();
        let mut line = self.line();
        line.styled(BOLD, &leading(file));
        if let Some(name) = name {
            line.plain("  %");
            line.plain(name);
        }
        line.end();
        self.line().end();
        self.version = Some(state.version);
        self.columns = AxisColumns::new(state, self.options.look.width);
        self.header();
        self.state_line("at start", state);
        file.clone_into(&mut self.file);
        if self.options.runs == Runs::Folded && self.options.look.detail == Detail::Brief {
            self.opening = self.output.bytes.split_off(begin);
        }
    }

    /// Writes a program in which nothing changes and of which nothing is said as one line. `false` if it is none.
    fn is_folded(&mut self, end: &End<'_>) -> bool {
        let is_event = !end.changes.is_empty()
            || !end.notes.is_empty()
            || !end.repeated.is_empty()
            || !end.state.possible.is_empty()
            || matches!(end.by, EndedBy::Error | EndedBy::Budget);
        if self.opening.is_empty() || is_event {
            return false;
        }
        self.opening.clear();
        let blocks = match std::mem::take(&mut self.quiet.count) {
            0 => "no change".to_owned(),
            1 => "1 block without a change".to_owned(),
            count => format!("{} blocks without a change", grouped(count)),
        };
        let mut text = format!("{}: {blocks}", self.file);
        let states = [
            State::Active,
            State::Ineffective,
            State::Inactive,
            State::Unknown,
            State::Unconfigured,
        ];
        let mut separator = "; ";
        for state in states {
            let axes = end.state.axes();
            let axes = axes.filter(|(axis, _)| end.state.state(*axis, Kind::Frict) == state);
            let names: Vec<&str> = axes.map(|(_, name)| name).collect();
            if let Some(names) = listed(&names) {
                text.extend([separator, &names, " ", state.as_str()]);
                separator = ", ";
            }
        }
        let line = Paragraph::new(anstyle::Style::new(), &text);
        line.write(&mut self.output.bytes, self.options.look);
        true
    }

    /// Writes the text above everything else.
    fn remark(&mut self, remark: &str) {
        for part in wrap(remark, self.options.look.width, 0).lines() {
            let mut line = self.line();
            line.plain(part);
            line.end();
        }
        self.line().end();
    }

    fn header(&mut self) {
        let mut line = TextLine::new(&mut self.output.bytes, self.options.look.paint);
        line.plain("  ");
        line.styled(BOLD, "line");
        line.go_to(GUTTER);
        line.styled(BOLD, "block");
        self.columns.names(&mut line);
        line.end();
        if let Some(legend) = self.columns.legend() {
            let legend = Paragraph::new(DIM, legend).indented(2);
            legend.write(&mut self.output.bytes, self.options.look);
        }
    }

    /// Writes a line that is not a block, with the states.
    fn state_line(&mut self, label: &str, state: StateView<'_>) {
        let mut line = TextLine::new(&mut self.output.bytes, self.options.look.paint);
        line.go_to(GUTTER);
        line.styled(DIM, label);
        self.columns.states(&mut line, state, &[]);
        line.end();
    }

    fn block(&mut self, row: &Row<'_>) {
        let grown = self.take_version(row.state);
        let eventful = self.options.view.is_eventful(row);
        if !eventful && !grown && self.options.runs == Runs::Folded {
            if self.options.view.blocks == Blocks::All {
                self.wait(row);
            }
            return;
        }
        self.release();
        if grown {
            self.columns = AxisColumns::new(row.state, self.options.look.width);
            self.header();
        }
        if !eventful && self.options.view.blocks == Blocks::Changed {
            return;
        }
        if row.file != self.file {
            self.announce(row.file);
        }
        self.columns.block(
            TextLine::new(&mut self.output.bytes, self.options.look.paint),
            row,
        );
        self.other_kinds(row.changes, row.state);
        for diagnostic in row.diagnostics {
            self.diagnostic(diagnostic);
        }
    }

    /// Takes over the version of the state; returns whether there are more axes than before.
    fn take_version(&mut self, state: StateView<'_>) -> bool {
        if self.version == Some(state.version) {
            return false;
        }
        self.version = Some(state.version);
        state.axes().count() != self.columns.len()
    }

    /// Counts a block without a change.
    fn wait(&mut self, row: &Row<'_>) {
        self.quiet.count += 1;
        if self.quiet.count > 1 {
            return;
        }
        row.file.clone_into(&mut self.quiet.file);
        self.quiet.first.clear();
        let line = TextLine::new(&mut self.quiet.first, self.options.look.paint);
        self.columns.block(line, row);
    }

    /// Writes the run of blocks without a change that ends here.
    fn release(&mut self) {
        self.output.bytes.append(&mut self.opening);
        match std::mem::take(&mut self.quiet.count) {
            0 => {}
            1 => {
                let file = std::mem::take(&mut self.quiet.file);
                if file != self.file {
                    self.announce(&file);
                }
                self.quiet.file = file;
                self.output.bytes.extend_from_slice(&self.quiet.first);
            }
            count => {
                let mut line = self.line();
                line.go_to(GUTTER - 2);
                let count = grouped(count);
                line.styled(DIM, &format!("… {count} blocks without a change"));
                line.end();
            }
        }
    }

    /// Announces that the next blocks are in another file.
    fn announce(&mut self, file: &str) {
        file.clone_into(&mut self.file);
        let mut line = self.line();
        line.go_to(GUTTER - 2);
        line.styled(DIM, &format!("─ {file}"));
        line.end();
    }

    fn other_kinds(&mut self, changes: &[Change], state: StateView<'_>) {
        for change in changes {
            if change.kind == Kind::Frict || !self.options.view.kinds.contains(change.kind) {
                continue;
            }
            let mut line = TextLine::new(&mut self.output.bytes, self.options.look.paint);
            line.go_to(GUTTER);
            line.styled(
                BOLD,
                &format!(
                    "{MARK} {} {}: {} → {}",
                    state.name(change.axis),
                    change.kind.as_str(),
                    change.from.as_str(),
                    change.to.as_str(),
                ),
            );
            line.end();
        }
    }

    /// Prints the states that are possible because ways differ (R14.2).
    fn possible(&mut self, state: StateView<'_>, saying: Saying) {
        if state.possible.is_empty() {
            return self.possible.clear();
        }
        let kinds = self.options.view.kinds;
        let shown = state.possible.iter().filter(|it| kinds.contains(it.kind));
        let shown: Vec<String> = shown
            .map(|it| {
                let kind = match it.kind {
                    Kind::Frict => String::new(),
                    kind => format!(" {kind}"),
                };
                let states = it.in_words(&self.file);
                format!("{MARK} {}{kind}: {states}", state.name(it.axis))
            })
            .collect();
        let said = std::mem::take(&mut self.possible);
        let look = self.options.look;
        let indent = if look.width < NARROW { 2 } else { GUTTER };
        for text in &shown {
            if saying == Saying::All || !said.contains(text) {
                self.release();
                let line = Paragraph::new(BOLD, text).indented(indent);
                line.write(&mut self.output.bytes, look);
            }
        }
        self.possible = shown;
    }

    fn diagnostic(&mut self, diagnostic: &Diagnostic) {
        let whole = self.options.look.width;
        let indent = if whole < NARROW { 2 } else { GUTTER };
        let look = Look {
            width: whole.saturating_sub(indent),
            ..self.options.look
        };
        let text = match self.options.messages {
            MessageExtent::Words => render(diagnostic, look),
            MessageExtent::Code => self.agreed(diagnostic),
        };
        for shown in text.lines() {
            if !shown.is_empty() {
                self.output
                    .bytes
                    .extend_from_slice(&[b' '; GUTTER][..indent]);
                self.output.bytes.extend_from_slice(shown.as_bytes());
            }
            self.output.bytes.push(b'\n');
        }
    }

    /// Returns the code of a message, its place and its axis.
    fn agreed(&self, diagnostic: &Diagnostic) -> String {
        let (place, start) = (&diagnostic.place, diagnostic.place.start());
        let mut text = format!("{} {} at ", diagnostic.severity, diagnostic.code);
        if *place.file != *self.file {
            text.push_str(&visible_line(&place.file));
            text.push(':');
        }
        text.extend([&start.line.to_string(), ":", &start.column.to_string()]);
        if let Some(axis) = &diagnostic.axis {
            text.push_str(", axis ");
            text.push_str(&visible_line(axis));
        }
        text
    }

    fn end(&mut self, end: &End<'_>) {
        self.ended = Some(end.by);
        let grown = self.take_version(end.state);
        if !grown && self.is_folded(end) {
            return;
        }
        self.release();
        let label = match end.by {
            EndedBy::M30 => "end by M30",
            EndedBy::M02 => "end by M02",
            EndedBy::EndOfFile => "end of the file",
            EndedBy::Error => "stopped by the error",
            EndedBy::Budget => "stopped by a budget",
        };
        if grown {
            self.columns = AxisColumns::new(end.state, self.options.look.width);
            self.header();
        }
        self.state_line(label, end.state);
        self.other_kinds(end.changes, end.state);
        self.possible(end.state, Saying::All);
        for note in end.notes {
            self.diagnostic(&note.diagnostic);
        }
        for repeat in end.repeated {
            let (code, times) = (repeat.code, grouped(repeat.times));
            let text = format!(
                "{code} at {}:{} occurred {times} times",
                repeat.file, repeat.line
            );
            let look = self.options.look;
            let indent = if look.width < NARROW { 2 } else { GUTTER };
            let repeated = Paragraph::new(anstyle::Style::new(), &text).indented(indent);
            repeated.write(&mut self.output.bytes, look);
        }
        self.line().end();
    }
}

impl<W: Write> Sink for Text<W> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match *record {
            Record::Session { remark, .. } => {
                if let Some(remark) = remark {
                    self.remark(remark);
                }
            }
            Record::Machine(diagnostic) => {
                let text = match self.options.messages {
                    MessageExtent::Words => render(diagnostic, self.options.look),
                    MessageExtent::Code => self.agreed(diagnostic),
                };
                self.output.bytes.extend_from_slice(text.as_bytes());
                self.output.bytes.push(b'\n');
            }
            Record::Program {
                file, name, state, ..
            } => self.program(file, name, state),
            Record::Block(ref row) => self.block(row),
            Record::Join(ref join) => self.possible(join.state, Saying::New),
            Record::End(ref end) => {
                self.end(end);
                return self.output.flush();
            }
            Record::Summary(_) if self.options.messages == MessageExtent::Code => {}
            Record::Summary(summary) => {
                let look = self.options.look;
                summary::append(&mut self.output.bytes, summary, self.ended, look);
                return self.output.flush();
            }
        }
        self.output.settle()
    }

    fn takes_quiet(&mut self) -> bool {
        if self.options.runs != Runs::Folded {
            return true;
        }
        match self.options.view.blocks {
            Blocks::Changed => false,
            Blocks::All if self.quiet.count == 0 => true,
            Blocks::All => {
                self.quiet.count += 1;
                false
            }
        }
    }
}

impl<W: Write> Gathered for Text<W> {
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
