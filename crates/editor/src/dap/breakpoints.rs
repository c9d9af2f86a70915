//! Causes that stop a run: breakpoints at lines, changes of a state, values that are not known.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::PathBuf;

use super::arguments::SourceBreakpoint;
use super::conditions::{Condition, HitCount};
use super::paths::RealPaths;
use super::wording::in_words;
use frictcomp::interpreter::{Executed, Interpreter};
use frictcomp::syntax::ast::Block;
use frictcomp::syntax::{BlockReader, FastPath};
use frictcomp::text::TextLines;

/// Stops requested by the client.
#[derive(Debug, Default)]
pub(super) struct Breakpoints {
    lines: HashMap<PathBuf, BTreeMap<u32, Vec<Breakpoint>>>,
    /// The axes whose changes of state stop the run; all of them where the set is empty.
    changes: Option<BTreeSet<String>>,
    unknown: bool,
    paths: RealPaths,
}

/// Breakpoint at a line.
#[derive(Debug, Clone, PartialEq)]
struct Breakpoint {
    wanted: SourceBreakpoint,
    condition: Option<Condition>,
    hits: Option<HitCount>,
    /// Number of times that its block was about to be executed while its condition held.
    met: u64,
}

/// Effect of the breakpoints on a line when a run reaches it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct BreakpointsMet {
    /// Reason for the stop in words; `None` if the run does not stop.
    pub(super) stop: Option<String>,
    /// Texts of log points.
    pub(super) logged: Vec<String>,
}

/// The identifiers of the filters that a client can switch on.
pub(super) const STATE_CHANGES: &str = "state";
pub(super) const UNKNOWN_VALUES: &str = "unknown";

impl Breakpoint {
    /// # Errors
    /// The condition or the number of hits means nothing; the reason in words.
    fn new(wanted: SourceBreakpoint) -> Result<Self, String> {
        let given = |text: &Option<String>| {
            let text = text.as_deref().map(str::trim);
            text.filter(|text| !text.is_empty()).map(str::to_owned)
        };
        let condition = given(&wanted.condition).map(|text| Condition::parse(&text));
        let hits = given(&wanted.hit_condition).map(|text| HitCount::parse(&text));
        Ok(Self {
            condition: condition.transpose()?,
            hits: hits.transpose()?,
            wanted,
            met: 0,
        })
    }

    /// Evaluates the breakpoint for a run that is about to execute its block.
    fn meet(&mut self, here: &Interpreter, met: &mut BreakpointsMet) {
        let undecided = match self.condition.as_ref().map(|it| it.holds(here)) {
            None | Some(Ok(true)) => None,
            Some(Ok(false)) => return,
            // If that is not known, the run had better stop.
            Some(Err(why)) => Some(why),
        };
        self.met += 1;
        if self.hits.is_some_and(|hits| !hits.includes(self.met)) {
            return;
        }
        match &self.wanted.log_message {
            Some(message) if undecided.is_none() => met.logged.push(filled(message, here)),
            _ => met.stop = Some(undecided.unwrap_or_default()),
        }
    }
}

impl Breakpoints {
    /// Sets the breakpoints of a file. Returns, for each requested one, the line of the block that it
    /// applies to, or why there is none.
    pub(super) fn set_lines(
        &mut self,
        file: PathBuf,
        text: &str,
        wanted: Vec<SourceBreakpoint>,
    ) -> Vec<Result<u32, String>> {
        let starts = block_lines(text);
        let before = self.lines.remove(&file).unwrap_or_default();
        let mut lines: BTreeMap<u32, Vec<Breakpoint>> = BTreeMap::new();
        let mut set = |wanted: SourceBreakpoint| {
            let line = starts.range(wanted.line..).next().copied();
            let line = line.ok_or("there is no block here or below")?;
            // A client sends all breakpoints whenever it changes one: the others keep their counts.
            let same = before.get(&line).into_iter().flatten();
            let same = same.clone().find(|it| it.wanted == wanted).cloned();
            let breakpoint = same.map_or_else(|| Breakpoint::new(wanted), Ok)?;
            lines.entry(line).or_default().push(breakpoint);
            Ok(line)
        };
        let told = wanted.into_iter().map(&mut set).collect();
        self.lines.insert(file, lines);
        told
    }

    /// Takes the filters that the client switched on.
    pub(super) fn set_filters(&mut self, changes: Option<BTreeSet<String>>, unknown: bool) {
        self.changes = changes;
        self.unknown = unknown;
    }

    /// Returns whether the line of a block has a breakpoint.
    pub(super) fn is_on(&mut self, block: &Executed<'_>) -> bool {
        if self.lines.is_empty() {
            return false;
        }
        let lines = self.lines.get(self.paths.of(block.file));
        lines.is_some_and(|lines| lines.contains_key(&block.line))
    }

    /// Returns the effect of the breakpoints on the line that a run has reached.
    pub(super) fn meet(&mut self, (file, line): (&str, u32), here: &Interpreter) -> BreakpointsMet {
        let mut met = BreakpointsMet::default();
        let lines = self.lines.get_mut(self.paths.of(file));
        let breakpoints = lines.and_then(|lines| lines.get_mut(&line));
        for breakpoint in breakpoints.into_iter().flatten() {
            breakpoint.meet(here, &mut met);
        }
        met
    }

    /// Returns whether values that only the machine knows stop the run where they are read.
    pub(super) fn stops_at_unknown(&self) -> bool {
        self.unknown
    }

    /// Returns whether a change of state of this axis stops the run.
    pub(super) fn watches(&self, axis: &str) -> bool {
        self.changes
            .as_ref()
            .is_some_and(|axes| axes.is_empty() || axes.contains(axis))
    }
}

/// Returns the text of a log point, with the expressions in braces replaced by their values.
fn filled(message: &str, here: &Interpreter) -> String {
    let mut text = String::new();
    let mut rest = message;
    while let Some((before, after)) = rest.split_once('{') {
        let Some((expression, after)) = after.split_once('}') else {
            break;
        };
        text.push_str(before);
        match here.evaluate(expression) {
            Ok(value) => text.push_str(&in_words(&value)),
            Err(why) => text.push_str(&why),
        }
        rest = after;
    }
    text + rest
}

/// Returns the lines on which blocks start, from 1.
fn block_lines(text: &str) -> BTreeSet<u32> {
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    let mut lines = BTreeSet::new();
    while let Some(found) = reader.next(&mut block) {
        lines.insert(found.line);
    }
    lines
}
