//! Runs programs given as text and shows what happened, in a few words per line.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;

use frictcomp::comp::{AxisIndex, Kind};
use frictcomp::interpreter::{Branches, Event, Interpreter, Options, PositionFrame, Value};
use frictcomp::interpreter::{Limits, StopPolicy};
use frictcomp::machine::{Configuration, ListFiles, Machine, NoList, Setting};
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::{SourceFile, TextLines};
use frictcomp::timeline::{Record, Sink, StateView};

/// X and Y configured with a value list, Z not configured, B configured without a list.
pub(crate) const MACHINE: &str = r#"
[[axis]]
name = "X"
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = "Y"
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = "Z"
frict_comp = false
[[axis]]
name = "B"
type = "R"
frict_comp = true
"#;

/// The way in which programs are passed to a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SourceMode {
    Whole,
    LineByLine,
}

/// A session to set up and run.
pub(crate) struct Bench {
    pub(crate) machine: Machine,
    pub(crate) options: SessionOptions,
    pub(crate) files: BTreeMap<String, String>,
    handed: SourceMode,
    after_error: AfterStop,
}

/// Action after a program that an error ends.
pub(crate) enum AfterStop {
    Nothing,
    /// A reset of the channel, and the next program.
    Reset,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self::on(MACHINE)
    }

    pub(crate) fn on(toml: &str) -> Self {
        Self::configured(toml, BTreeMap::new())
    }

    /// Runs on the machine of a configuration and the lists that it names.
    pub(crate) fn configured(toml: &str, files: BTreeMap<String, String>) -> Self {
        let file = SourceFile::new("frictcomp.toml", toml);
        let found = Configuration::from_toml(file, &mut Lists(&files)).expect("a machine");
        let options = SessionOptions::default()
            .with_levels(found.levels)
            .with_settings(found.settings)
            .with_wording(Some(frictcomp_report::command_line));
        Self {
            machine: found.machine,
            options,
            files,
            handed: SourceMode::Whole,
            after_error: AfterStop::Nothing,
        }
    }

    /// Runs on a machine without a description.
    pub(crate) fn undescribed() -> Self {
        Self {
            machine: Machine::unconfigured(),
            ..Self::new()
        }
    }

    pub(crate) fn handed(mut self, handed: SourceMode) -> Self {
        self.handed = handed;
        self
    }

    /// Raises events on one way only (R14.8).
    pub(crate) fn passing_branches(mut self) -> Self {
        self.options.run.branches = Branches::OneFollowed;
        self
    }

    pub(crate) fn reset_after_error(mut self) -> Self {
        self.after_error = AfterStop::Reset;
        self
    }

    pub(crate) fn keep_going(mut self) -> Self {
        self.options.run.stop = StopPolicy::KeepGoing;
        self
    }

    pub(crate) fn check_all(mut self) -> Self {
        self.options.run.stop = StopPolicy::CheckAll;
        self
    }

    pub(crate) fn skip(mut self, levels: &str) -> Self {
        self.options.run.skip = levels.parse().ok();
        self
    }

    pub(crate) fn build(mut self, build: &str) -> Self {
        self.machine.build = build.parse().ok();
        self
    }

    pub(crate) fn limits(mut self, limits: Limits) -> Self {
        self.options.run.limits = limits;
        self
    }

    pub(crate) fn set(mut self, name: &str, value: f64) -> Self {
        let setting = (name.to_owned(), Setting::Number(value));
        self.options.settings.push(setting);
        self
    }

    pub(crate) fn file(mut self, name: &str, text: &str) -> Self {
        self.files.insert(name.to_owned(), text.to_owned());
        self
    }

    pub(crate) fn set_text(mut self, name: &str, value: &str) -> Self {
        let setting = (name.to_owned(), Setting::Text(value.to_owned()));
        self.options.settings.push(setting);
        self
    }

    /// Returns the value of each expression, or the message about it.
    pub(crate) fn values(&self, preparation: &str, expressions: &[&str]) -> String {
        let mut lines = String::new();
        for expression in expressions {
            let mut session = self.session();
            let program = format!("{preparation}\nV.S.R = {expression}\nM30");
            let transcript = self.run_in(&mut session, &[&program]);
            let value = session.interpreter().shared_variables().remove("V.S.R");
            let said = transcript
                .lines()
                .find_map(|line| line.strip_prefix("    "))
                .unwrap_or("nothing");
            let shown = match value {
                Some(Value::Number(number)) => format!("{}", (number * 1e9).round() / 1e9),
                Some(Value::Text(text)) => format!("{text:?}"),
                Some(Value::Unknown(cause)) => format!("unknown: {cause}"),
                None => said.to_owned(),
            };
            writeln!(lines, "{expression} -> {shown}").expect("text");
        }
        lines
    }

    /// Returns the messages about a program, with advice and labels.
    pub(crate) fn said(&self, program: &str) -> String {
        struct Said(String);
        impl Sink for Said {
            fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
                let (mut said, mut noted) = (Vec::new(), Vec::new());
                match record {
                    Record::Block(row) => said.extend(row.diagnostics),
                    Record::End(end) => noted.extend(end.notes.iter().map(|note| &note.diagnostic)),
                    _ => {}
                }
                for diagnostic in said.into_iter().chain(noted) {
                    let place = diagnostic.place.start();
                    writeln!(self.0, "{} {place} {}", diagnostic.code, diagnostic.message)
                        .expect("text");
                    for help in diagnostic.help() {
                        writeln!(self.0, "  help: {help}").expect("text");
                    }
                    for label in &diagnostic.labels {
                        writeln!(self.0, "  {}: {}", label.place.start(), label.text)
                            .expect("text");
                    }
                }
                ControlFlow::Continue(())
            }
        }
        let mut said = Said(String::new());
        let handed = (&[program][..], SourceMode::Whole);
        self.run_into(&mut self.session(), handed, &mut said);
        said.0
    }

    /// Returns the axis positions after each block.
    pub(crate) fn positions(&self, program: &str) -> String {
        let compensation = self.machine.compensation();
        let machine = std::sync::Arc::new(self.machine.clone());
        let options = Options::default().with_branches(self.options.run.branches);
        let mut run = Interpreter::new(machine.clone(), compensation, options);
        for (name, setting) in &self.options.settings {
            run.set(name, setting);
        }
        let mut lines = String::new();
        let files = self.files.clone();
        let mut find = move |name: &str, _: &str| {
            let text = files.get(name)?;
            Some(SourceFile::new(name, text.as_str()))
        };
        let source = SourceFile::new("a.nc", program);
        run.program(source, &mut find, &mut |event: Event<'_>| {
            if let Event::Executed(block) = event {
                write!(lines, "{}", block.text.lines().next().unwrap_or_default()).expect("text");
                for (at, axis) in machine.axes.iter().enumerate() {
                    let position = block.modal.position(AxisIndex::new(at));
                    let value = position
                        .value
                        .map_or("?".to_owned(), |value| value.to_string());
                    let mark = match position.frame {
                        PositionFrame::Machine => "",
                        _ => "*",
                    };
                    write!(lines, " {}:{value}{mark}", axis.name).expect("text");
                }
                lines.push('\n');
            }
            ControlFlow::Continue(())
        });
        lines
    }

    pub(crate) fn session(&self) -> Session {
        Session::new(self.machine.clone(), self.options.clone())
    }

    /// Runs programs in one session and shows the records.
    pub(crate) fn run(&self, programs: &[&str]) -> String {
        let mut session = self.session();
        self.run_in(&mut session, programs)
    }

    pub(crate) fn run_in(&self, session: &mut Session, programs: &[&str]) -> String {
        let mut transcript = Transcript {
            text: String::new(),
        };
        self.run_into(session, (programs, self.handed), &mut transcript);
        transcript.text
    }

    /// Runs programs one after another in one session.
    pub(crate) fn run_into(
        &self,
        session: &mut Session,
        (programs, handed): (&[&str], SourceMode),
        sink: &mut dyn Sink,
    ) {
        let _ = session.begin(&[], sink);
        for (at, text) in programs.iter().enumerate() {
            if session.is_stopped() && self.options.run.stop == StopPolicy::FirstError {
                match self.after_error {
                    AfterStop::Nothing => break,
                    AfterStop::Reset => session.reset(),
                }
            }
            let name = format!(
                "{}.nc",
                char::from(b'a' + u8::try_from(at).expect("few programs"))
            );
            let mut lines = TextLines::new(text);
            let program = match handed {
                SourceMode::Whole => Program::Whole(SourceFile::new(name.as_str(), *text)),
                SourceMode::LineByLine => Program::Lines(&mut lines),
            };
            let files = self.files.clone();
            let mut find = move |name: &str, _: &str| {
                let text = files.get(name)?;
                Some(SourceFile::new(name, text.as_str()))
            };
            let _ = session.program(&name, program, &mut find, sink);
        }
        let _ = session.finish(sink);
    }
}

/// Lists by their paths, in which `..` leads to the folder above, before those of `programs/machines`.
pub(crate) struct Lists<'a>(pub(crate) &'a BTreeMap<String, String>);

impl ListFiles for Lists<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let mut folders: Vec<&str> = Vec::new();
        for part in path.split('/') {
            if part == ".." && folders.last().is_some_and(|it| *it != "..") {
                folders.pop();
            } else {
                folders.push(part);
            }
        }
        let text = self.0.get(path).or_else(|| self.0.get(&folders.join("/")));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/programs/machines");
        let on_disk = || std::fs::read_to_string(Path::new(folder).join(path)).ok();
        let text = text.cloned().or_else(on_disk).ok_or(NoList::Missing)?;
        Ok(SourceFile::new(path, text))
    }
}

struct Transcript {
    text: String,
}

impl Transcript {
    fn states(view: StateView<'_>) -> String {
        let states = view.axes().map(|(axis, name)| {
            let state = view.state(axis, Kind::Frict);
            format!("{name}:{}", state.as_str())
        });
        states.collect::<Vec<_>>().join(" ")
    }

    fn diagnostic(&mut self, diagnostic: &frictcomp::diagnostic::Diagnostic) {
        let place = &diagnostic.place;
        let file = if place.file.len() > 4 {
            format!(" in {}", place.file)
        } else {
            String::new()
        };
        let (start, end) = (place.start(), place.end());
        let end = if end.line == start.line {
            end.column.to_string()
        } else {
            end.to_string()
        };
        writeln!(self.text, "    {} {start}-{end}{file}", diagnostic.code).expect("text");
    }
}

impl Sink for Transcript {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Session { state, .. } => {
                let states = Self::states(*state);
                writeln!(self.text, "start {states}").expect("text");
            }
            Record::Machine(diagnostic) => self.diagnostic(diagnostic),
            Record::Program { file, name, .. } => {
                writeln!(self.text, "{file} {}", name.unwrap_or("-")).expect("text");
            }
            Record::Block(row) => {
                let number = row
                    .number
                    .map_or("-".to_owned(), |number| format!("N{number}"));
                let level = row
                    .level
                    .map_or(String::new(), |level| format!(" level {level}"));
                write!(self.text, "  {} line {} {number}{level}", row.seq, row.line).expect("text");
                for change in row.changes {
                    if change.kind == Kind::Frict {
                        let axis = row.state.name(change.axis);
                        let (from, to) = (change.from.as_str(), change.to.as_str());
                        write!(self.text, " {axis}:{from}>{to}").expect("text");
                    }
                }
                self.text.push('\n');
                for diagnostic in row.diagnostics {
                    self.diagnostic(diagnostic);
                }
            }
            Record::End(end) => {
                for note in end.notes {
                    self.diagnostic(&note.diagnostic);
                }
                for repeat in end.repeated {
                    writeln!(
                        self.text,
                        "    {} line {} {} times",
                        repeat.code, repeat.line, repeat.times
                    )
                    .expect("text");
                }
                let states = Self::states(end.state);
                writeln!(self.text, "  end {} {} {states}", end.seq, end.by.as_str())
                    .expect("text");
            }
            Record::Join(_) => {}
            Record::Summary(summary) => {
                if !summary.opaque.is_empty() {
                    writeln!(self.text, "opaque {:?}", summary.opaque).expect("text");
                }
            }
        }
        ControlFlow::Continue(())
    }
}
