//! The digest of a session, kept during the run for the report after it.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

use super::track::{SpanStart, StateTrack};
use super::ways::{Ways, WaysIndex};
use crate::results::lists::selector_origin;
use crate::svg::StartUpRelation;
use frictcomp::comp::{AxisIndex, Change, CncBuild, Kind, KindSet, State};
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::lists::AxisType;
use frictcomp::machine::{AcceptedList, AxisSet, Parameterisation};
use frictcomp::readings::Readings;
use frictcomp::text::{Place, Position};
use frictcomp::timeline::{AxisSummary, End, Join, Record, Row, Sink, StateView, Summary};

/// Number of characters shown of a source line.
pub(super) const LINE_ROOM: usize = 400;

/// Lines whose runs are counted, in all files together.
const MAX_COUNTED_LINES: usize = 1_000_000;

/// Lines that are shown with their changes, in all files together.
const MAX_EVENT_LINES: usize = 4000;

/// Messages that are kept, each once per place.
const MAX_MESSAGES: usize = 2000;

/// Different changes that are kept of a line.
const MAX_CHANGES: usize = 24;

/// Programs that have a separate chart.
const MAX_PROGRAMS: usize = 200;

/// Course of a session in bounded memory: a [`Sink`] for its records.
#[derive(Debug, Default)]
pub struct RunDigest {
    kinds: KindSet,
    pub(super) axes: Vec<AxisDigest>,
    pub(super) axis_set: AxisSet,
    /// Readings of the open questions, and the build.
    pub(super) readings: (Readings, Option<CncBuild>),
    /// Remark that no machine is described (R1.37).
    pub(super) remark: Option<String>,
    /// The lines that assume friction compensation of axes, in words (R18.2).
    pub(super) assumption: Option<String>,
    pub(super) accepted: Vec<AcceptedList>,
    pub(super) programs: Vec<ProgramDigest>,
    /// Programs beyond [`MAX_PROGRAMS`].
    pub(super) more_programs: u32,
    pub(super) files: Vec<FileDigest>,
    pub(super) messages: Vec<Message>,
    /// Messages beyond [`MAX_MESSAGES`].
    pub(super) more_messages: u64,
    /// Lines with an event beyond [`MAX_EVENT_LINES`].
    pub(super) more_events: u64,
    pub(super) summary: Option<SummaryDigest>,
    pub(super) ways: Ways,
    /// Place where ways joined after the last block, and the differences there.
    met: Option<(SourceLine, Vec<JoinedStates>)>,
    by_name: HashMap<String, usize>,
    by_place: HashMap<(Code, Arc<str>, Position, String), usize>,
    /// The file of the last block.
    last_file: usize,
    counted_lines: usize,
    event_lines: usize,
    version: Option<u64>,
}

/// A line of source: the number of its file in the page, and its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SourceLine {
    pub(super) file: usize,
    pub(super) line: u32,
}

/// One axis of the machine.
#[derive(Debug)]
pub(super) struct AxisDigest {
    pub(super) name: String,
    pub(super) axis_type: AxisType,
    pub(super) configured: bool,
    /// Origin of P-AXIS-00522, in words.
    pub(super) origin: String,
    pub(super) friction: Parameterisation,
    /// Whether the records list the axis.
    pub(super) listed: bool,
}

/// One program of the session.
#[derive(Debug)]
pub(super) struct ProgramDigest {
    pub(super) number: u32,
    pub(super) file: usize,
    pub(super) name: Option<String>,
    pub(super) tracks: Vec<StateTrack>,
    pub(super) blocks: u64,
    pub(super) by: Option<EndedBy>,
}

/// One file whose blocks were executed.
#[derive(Debug)]
pub(super) struct FileDigest {
    pub(super) name: String,
    /// Number of executions of each line, the first line first.
    pub(super) runs: Vec<u32>,
    pub(super) events: BTreeMap<u32, LineDigest>,
}

impl FileDigest {
    /// Returns the number of counted executions of a line.
    pub(super) fn runs_of(&self, line: u32) -> u32 {
        let row = usize::try_from(line)
            .unwrap_or(usize::MAX)
            .saturating_sub(1);
        self.runs.get(row).copied().unwrap_or_default()
    }
}

/// A line with an event.
#[derive(Debug, Default)]
pub(super) struct LineDigest {
    /// The block as it was executed.
    pub(super) text: String,
    pub(super) changes: Vec<(Change, u64)>,
    /// Differences where ways join before it.
    pub(super) met: Vec<JoinedStates>,
    /// Different changes beyond [`MAX_CHANGES`].
    pub(super) more_changes: u64,
    /// Messages by their numbers in the report.
    pub(super) messages: Vec<usize>,
}

/// Possible states of an axis where ways join.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct JoinedStates {
    pub(super) axis: AxisIndex,
    pub(super) kind: Kind,
    pub(super) ways: WaysIndex,
}

/// A diagnostic and the number of its reports.
#[derive(Debug)]
pub(super) struct Message {
    pub(super) diagnostic: Diagnostic,
    /// The file and line at which the report shows it; `None` for the machine's lists.
    pub(super) shown: Option<SourceLine>,
    pub(super) times: u64,
    /// The number of the main program that reached it last.
    by: Option<u32>,
}

impl Message {
    /// Notes the main program that reached it (R17.1).
    fn reached_from(&mut self, program: Option<(u32, Arc<str>)>) {
        let Some((number, file)) = program else {
            return;
        };
        if self.by.replace(number) != Some(number) {
            self.diagnostic.reached_from.add(&file);
        }
    }
}

/// The end of the session.
#[derive(Debug)]
pub(super) struct SummaryDigest {
    pub(super) programs: u32,
    pub(super) blocks: u64,
    pub(super) counts: BTreeMap<Severity, u64>,
    pub(super) opaque: BTreeMap<String, u64>,
    pub(super) axes: Vec<AxisSummary>,
    pub(super) assumed: BTreeSet<Code>,
    /// Possible states at the end if FRICT of an axis is unknown.
    pub(super) ways: Vec<(AxisIndex, WaysIndex)>,
}

impl RunDigest {
    /// Returns a digest of FRICT and some other kinds.
    pub fn new(mut kinds: KindSet) -> Self {
        kinds.insert(Kind::Frict);
        Self {
            kinds,
            ..Self::default()
        }
    }

    /// Returns the name of an axis.
    pub(super) fn axis_name(&self, axis: AxisIndex) -> &str {
        self.axes.get(axis.get()).map_or("", |axis| &axis.name)
    }

    /// Compares a state of a kind on an axis with the start-up state.
    pub(super) fn relation(&self, axis: AxisIndex, kind: Kind, state: State) -> StartUpRelation {
        let mut tracks = self.programs.iter().flat_map(|program| &program.tracks);
        let track = tracks.find(|track| (track.axis, track.kind) == (axis, kind));
        track.map_or(StartUpRelation::StartUp, |track| {
            StartUpRelation::of(state, track.start_up)
        })
    }

    /// Returns the end of the last program.
    pub(super) fn ended(&self) -> Option<EndedBy> {
        self.programs.last().and_then(|program| program.by)
    }

    fn session(&mut self, state: StateView<'_>, remark: Option<&str>) {
        self.remark = remark.map(str::to_owned);
        self.assumption = state.machine.assumption();
        let listed = state.listed.iter().copied().chain(std::iter::repeat(false));
        self.axis_set = state.machine.axis_set;
        self.readings = (state.machine.readings.clone(), state.machine.build);
        self.accepted = AcceptedList::of(state.machine);
        self.axes = (state.machine.axes.iter().zip(listed))
            .map(|(axis, listed)| AxisDigest {
                name: axis.name.clone(),
                axis_type: axis.axis_type,
                configured: axis.configured.contains(Kind::Frict),
                origin: selector_origin(axis),
                friction: axis.friction.clone(),
                listed,
            })
            .collect();
    }

    fn program(&mut self, number: u32, file: &str, name: Option<&str>, state: StateView<'_>) {
        let (path, file) = (file, self.file(file));
        if self.programs.len() >= MAX_PROGRAMS {
            self.more_programs += 1;
        }
        let start = state.machine.compensation();
        let mut tracks = Vec::new();
        for (axis, _) in state.machine.axes.iter().enumerate() {
            let axis = AxisIndex::new(axis);
            let kinds = Kind::ALL.into_iter();
            for kind in kinds.filter(|&kind| self.kinds.contains(kind)) {
                let start_up = start.state(axis, kind);
                let now = self.ways.find(state, (axis, kind), path);
                tracks.push(StateTrack::new(axis, kind, now, start_up));
            }
        }
        self.version = Some(state.version);
        let program = ProgramDigest {
            number,
            file,
            name: name.map(str::to_owned),
            tracks,
            blocks: 0,
            by: None,
        };
        if self.more_programs > 0 {
            // Only the last one beyond the bound is kept, for how the session ended.
            self.programs.truncate(MAX_PROGRAMS);
        }
        self.programs.push(program);
    }

    fn file(&mut self, name: &str) -> usize {
        if let Some(&known) = self.by_name.get(name) {
            return known;
        }
        let number = self.files.len();
        self.by_name.insert(name.to_owned(), number);
        self.files.push(FileDigest {
            name: name.to_owned(),
            runs: Vec::new(),
            events: BTreeMap::new(),
        });
        number
    }

    fn block(&mut self, row: &Row<'_>) {
        let same = self.files.get(self.last_file);
        if same.is_none_or(|file| file.name != row.file) {
            self.last_file = self.file(row.file);
        }
        let file = self.last_file;
        self.count(file, row.line);
        self.show_met(row.text);
        if self.version != Some(row.state.version) {
            self.version = Some(row.state.version);
            let spot = SpanStart {
                file,
                line: row.line,
                number: row.number,
            };
            if let Some(program) = self.programs.last_mut() {
                let path = &self.files[program.file].name;
                for track in &mut program.tracks {
                    let now = self.ways.find(row.state, (track.axis, track.kind), path);
                    track.push(row.seq, now, spot);
                }
            }
            for (axis, listed) in self.axes.iter_mut().zip(row.state.listed) {
                axis.listed = *listed;
            }
        }
        for &change in row.changes {
            if self.kinds.contains(change.kind) {
                let place = SourceLine {
                    file,
                    line: row.line,
                };
                self.change(place, row.text, change);
            }
        }
        for diagnostic in row.diagnostics {
            self.message(diagnostic, Some((file, row.line, row.text)));
        }
    }

    /// Keeps the states that become possible where ways meet, for the line of the next block.
    fn join(&mut self, join: &Join<'_>) {
        self.show_met("");
        let file = self.file(join.file);
        let Some(program) = self.programs.last() else {
            return;
        };
        let path = &self.files[program.file].name;
        let mut met = Vec::new();
        for track in &program.tracks {
            let place = (track.axis, track.kind);
            if self.ways.find(join.state, place, path) != track.now
                && let Some(ways) = self.ways.find(join.state, place, join.file).ways
            {
                let (axis, kind) = place;
                met.push(JoinedStates { axis, kind, ways });
            }
        }
        if !met.is_empty() {
            let line = join.line;
            self.met = Some((SourceLine { file, line }, met));
        }
    }

    /// Keeps the states from the last meeting of ways with the line of a text.
    #[inline]
    fn show_met(&mut self, text: &str) {
        if let Some((place, met)) = self.met.take() {
            let Some(line) = self.line(place, text) else {
                return;
            };
            for met in met {
                if line.met.contains(&met) {
                    continue;
                }
                if line.met.len() < MAX_CHANGES {
                    line.met.push(met);
                } else {
                    line.more_changes += 1;
                }
            }
        }
    }

    fn count(&mut self, file: usize, line: u32) {
        let at = usize::try_from(line.max(1)).unwrap_or(usize::MAX) - 1;
        let runs = &mut self.files[file].runs;
        if at >= runs.len() {
            let more = at + 1 - runs.len();
            if self.counted_lines + more > MAX_COUNTED_LINES {
                return;
            }
            self.counted_lines += more;
            runs.resize(at + 1, 0);
        }
        runs[at] = runs[at].saturating_add(1);
    }

    /// Returns the entry of a line, unless there are too many already.
    fn line(&mut self, place: SourceLine, text: &str) -> Option<&mut LineDigest> {
        let SourceLine { file, line } = place;
        let events = &mut self.files[file].events;
        if !events.contains_key(&line) {
            if self.event_lines >= MAX_EVENT_LINES {
                self.more_events += 1;
                return None;
            }
            self.event_lines += 1;
        }
        let digest = events.entry(line).or_default();
        if digest.text.is_empty() {
            digest.text = text.chars().take(LINE_ROOM).collect();
        }
        Some(digest)
    }

    fn change(&mut self, place: SourceLine, text: &str, change: Change) {
        let Some(line) = self.line(place, text) else {
            return;
        };
        if let Some((_, times)) = line.changes.iter_mut().find(|(known, _)| *known == change) {
            *times += 1;
        } else if line.changes.len() < MAX_CHANGES {
            line.changes.push((change, 1));
        } else {
            line.more_changes += 1;
        }
    }

    /// Keeps a diagnostic; one about a block is shown at that block if it points into another file.
    fn message(&mut self, diagnostic: &Diagnostic, block: Option<(usize, u32, &str)>) {
        let place = &diagnostic.place;
        let key = (
            diagnostic.code,
            Arc::clone(&place.file),
            place.start(),
            diagnostic.message.clone(),
        );
        let program = self.program_of(place).filter(|_| block.is_some());
        if let Some(&known) = self.by_place.get(&key) {
            let message = &mut self.messages[known];
            message.times += 1;
            message.reached_from(program);
            return;
        }
        if self.messages.len() >= MAX_MESSAGES {
            self.more_messages += 1;
            return;
        }
        let number = self.messages.len();
        self.by_place.insert(key, number);
        let shown = block.and_then(|(file, line, text)| {
            let within = self.files[file].name == *place.file;
            let line = if within { place.start().line } else { line };
            let text = if within { &*place.text } else { text };
            let digest = self.line(SourceLine { file, line }, text)?;
            digest.messages.push(number);
            Some(SourceLine { file, line })
        });
        let mut message = Message {
            diagnostic: diagnostic.clone(),
            shown,
            times: 1,
            by: None,
        };
        message.reached_from(program);
        self.messages.push(message);
    }

    /// Returns the main program that runs, by its number in the session and its file, if a place is not in that file.
    fn program_of(&self, place: &Place) -> Option<(u32, Arc<str>)> {
        let program = self.programs.last()?;
        let file = self.files[program.file].name.as_str();
        (file != &*place.file).then(|| (program.number, Arc::from(file)))
    }

    fn end(&mut self, end: &End<'_>) {
        self.show_met("");
        for note in end.notes {
            let place = &note.diagnostic.place;
            let file = self.file(&place.file);
            let line = place.start().line;
            self.message(&note.diagnostic, Some((file, line, &place.text)));
        }
        for repeat in end.repeated {
            let key = (
                repeat.code,
                Arc::from(repeat.file.as_str()),
                repeat.start,
                repeat.message.clone(),
            );
            let known = self.by_place.get(&key);
            let said = known.and_then(|&known| self.messages.get_mut(known));
            if let Some(message) = said {
                message.times = message.times.max(repeat.times);
            }
        }
        if let Some(program) = self.programs.last_mut() {
            program.blocks = end.seq;
            program.by = Some(end.by);
        }
    }

    fn summary(&mut self, summary: &Summary<'_>) {
        let last = self.programs.last();
        let path = last.map_or("", |program| &self.files[program.file].name);
        let ways = summary.axes.iter().filter_map(|axis| {
            let found = self
                .ways
                .find(summary.state, (axis.axis, Kind::Frict), path);
            Some((axis.axis, found.ways?))
        });
        let ways = ways.collect();
        self.summary = Some(SummaryDigest {
            programs: summary.programs,
            blocks: summary.blocks,
            counts: summary.counts.clone(),
            opaque: summary.opaque.clone(),
            axes: summary.axes.clone(),
            assumed: summary.assumed.clone(),
            ways,
        });
        for axis in &summary.axes {
            self.axes[axis.axis.get()].listed = true;
        }
    }
}

impl Sink for RunDigest {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match *record {
            Record::Session { state, remark } => self.session(state, remark),
            Record::Machine(diagnostic) => self.message(diagnostic, None),
            Record::Program {
                program,
                file,
                name,
                state,
            } => self.program(program, file, name, state),
            Record::Block(ref row) => self.block(row),
            Record::Join(ref join) => self.join(join),
            Record::End(ref end) => self.end(end),
            Record::Summary(summary) => self.summary(summary),
        }
        ControlFlow::Continue(())
    }
}
