//! A run of a program, and the questions of the page about it.

use std::collections::HashMap;
use std::path::Path;

use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::Wording;
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::interpreter::{Limits, Options, StopPolicy};
use frictcomp::text::LineSource;
use frictcomp_host::{Axes, Disk, LoadedMachine, Naming, SingleRun, run_alone};
use frictcomp_report::html::{GivenForRun, RunDigest, RunInputs, Sources, render_run};
use frictcomp_report::{Headline, TimelineFormat, TimelineOptions, command_line, feed_moves_text};
use serde::{Deserialize, Serialize};

use crate::bars::{BarSpan, bar};
use crate::dropped::Dropped;
use crate::lines::IndexedText;
use crate::refusal::Refusal;
use crate::rows::{FrictionStates, MOST_ROWS};
use crate::timeline::Timeline;
use crate::wording::page;

/// Settings of a run.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(crate) struct RunSettings {
    /// The axes on which friction compensation is assumed.
    pub(crate) enable: Vec<String>,
    /// Whether a failing command is passed over.
    pub(crate) keep_going: bool,
    /// The maximum number of executed blocks, if it is not the usual one.
    pub(crate) max_blocks: Option<u64>,
}

/// Blocks that are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShownBlocks {
    All,
    /// Blocks with a change or a message.
    Notable,
}

/// A run that the page shows.
#[derive(Debug)]
pub(crate) struct ShownRun {
    timeline: Timeline,
    /// The rows with a change or a message.
    notable: Vec<u32>,
    program: String,
    disk: Disk,
    /// The lines of the files that were shown.
    lines: HashMap<u16, Option<IndexedText>>,
}

/// The part of the page above the timeline.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Overview<'a> {
    program: &'a str,
    name: Option<&'a str>,
    axes: Vec<AxisOverview<'a>>,
    axes_as_they_occur: bool,
    blocks: u64,
    /// The number of blocks in the timeline, if it is smaller.
    kept: usize,
    ended_by: Option<&'static str>,
    remark: Option<&'a str>,
    errors: u64,
    warnings: u64,
    infos: u64,
    messages: Vec<Message<'a>>,
    messages_left_out: u64,
    passed_over: Vec<(&'a str, u64)>,
    /// The verdict; none where nothing is known to be as it should be or not.
    headline: Option<&'a Headline>,
    machine: MachineOverview<'a>,
    /// Number of items of each view of the timeline.
    items: usize,
    notable_items: usize,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct AxisOverview<'a> {
    name: &'a str,
    /// The state after a start of the control.
    start_up: StateWord,
    start: StateWord,
    end: StateWord,
    listed: bool,
    changes: u64,
    changed_by: Vec<ChangedAt<'a>>,
    /// The possible states at the end where it is unknown because ways differ.
    possible: Option<String>,
    /// The feed moves without compensation, in words that follow the name.
    uncompensated: Option<String>,
    bar: Vec<BarSpan>,
}

type StateWord = &'static str;

#[derive(Debug, Serialize)]
struct ChangedAt<'a> {
    file: &'a str,
    line: u32,
    number: Option<i64>,
}

#[derive(Debug, Serialize)]
struct Message<'a> {
    after: u64,
    #[serde(flatten)]
    diagnostic: &'a Diagnostic,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct MachineOverview<'a> {
    /// The file that describes it.
    origin: Option<String>,
    is_described: bool,
    lists: usize,
    missing: usize,
    said: &'a [Diagnostic],
}

/// The states at a line of the timeline.
#[derive(Debug, Default, Serialize)]
pub(crate) struct LineStates {
    states: Vec<StateWord>,
    /// The possible states of axes, by their positions, where they are unknown because ways differ.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    possible: Vec<(usize, String)>,
}

/// One line of the timeline.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum TimelineItem<'a> {
    Start {
        #[serde(flatten)]
        states: LineStates,
    },
    Block {
        block: usize,
        /// The file, if it is not the program itself.
        file: Option<&'a str>,
        line: u32,
        level: u8,
        text: String,
        #[serde(flatten)]
        states: LineStates,
        changes: Vec<usize>,
    },
    Message {
        /// Position among the messages.
        at: usize,
    },
    End {
        #[serde(flatten)]
        states: LineStates,
    },
}

/// Returns a program run as on the command line, with advice in the words of a host.
fn alone(loaded: &LoadedMachine, settings: &RunSettings, wording: Wording) -> SingleRun {
    let stop = if settings.keep_going {
        StopPolicy::KeepGoing
    } else {
        StopPolicy::FirstError
    };
    let limits = Limits::default();
    let limits = limits.with_blocks(settings.max_blocks.unwrap_or(limits.blocks));
    let run = Options::default().with_stop(stop).with_limits(limits);
    SingleRun {
        options: loaded.session(run).with_wording(Some(wording)),
        naming: Naming::AsGiven,
        axes: Axes::Ahead,
    }
}

/// Runs a program for the page.
pub(crate) fn run(
    dropped: &mut Dropped,
    program: &str,
    settings: &RunSettings,
) -> Result<(ShownRun, Vec<u8>), Refusal> {
    let input = dropped.program(program)?;
    let loaded = dropped.machine(&input, &settings.enable)?;
    let mut timeline = Timeline::default();
    run_alone(
        &input,
        &loaded,
        alone(&loaded, settings, page),
        &mut timeline,
    )?;
    let mut notable = timeline.rows.changed.clone();
    let said = timeline.said.iter().filter_map(|said| {
        let row = said.after.checked_sub(1)?;
        u32::try_from(row).ok().filter(|row| *row < kept(&timeline))
    });
    notable.extend(said);
    notable.sort_unstable();
    notable.dedup();
    let shown = ShownRun {
        timeline,
        notable,
        program: program.to_owned(),
        disk: dropped.disk(),
        lines: HashMap::new(),
    };
    let overview = json(&shown.overview(&loaded));
    Ok((shown, overview))
}

fn kept(timeline: &Timeline) -> u32 {
    u32::try_from(timeline.rows.kept.len().min(MOST_ROWS)).unwrap_or(u32::MAX)
}

/// Returns an answer in JSON.
pub(crate) fn json(answer: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(answer).expect("keys are texts and numbers finite")
}

/// Returns the records of a program, the same bytes as those of `frictcomp run --format ndjson`.
pub(crate) fn records(
    dropped: &mut Dropped,
    program: &str,
    settings: &RunSettings,
) -> Result<Vec<u8>, Refusal> {
    let input = dropped.program(program)?;
    let loaded = dropped.machine(&input, &settings.enable)?;
    let written = crate::written::WrittenBytes::default();
    let mut report = TimelineFormat::Ndjson.report(written.clone(), TimelineOptions::default());
    let alone = alone(&loaded, settings, command_line);
    run_alone(&input, &loaded, alone, &mut *report)?;
    report
        .finish()
        .map_err(|error| Refusal::new(error.to_string()))?;
    Ok(written.take())
}

/// Returns the report of a run as a page, the same as that of `frictcomp run --html` except for the wording of advice.
pub(crate) fn report(
    dropped: &mut Dropped,
    program: &str,
    settings: &RunSettings,
) -> Result<Vec<u8>, Refusal> {
    let input = dropped.program(program)?;
    let loaded = dropped.machine(&input, &settings.enable)?;
    let mut digest = RunDigest::new(KindSet::of(Kind::Frict));
    let alone = alone(&loaded, settings, page);
    let stop = alone.options.run.stop;
    run_alone(&input, &loaded, alone, &mut digest)?;
    let given = RunInputs {
        given: GivenForRun {
            machine: loaded.origin.as_deref(),
            enabled: &settings.enable,
            variables: &loaded.settings,
            stop,
            ..GivenForRun::default()
        },
        parameters: &loaded.reports,
        programs: &loaded.programs,
    };
    let mut written = Vec::new();
    render_run(&digest, &given, &mut Texts(dropped.disk()), &mut written)
        .map_err(|error| Refusal::new(error.to_string()))?;
    Ok(written)
}

/// The dropped files, read once more for a report.
pub(crate) struct Texts(pub(crate) Disk);

impl Sources for Texts {
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>> {
        self.0.lines(name)
    }
}

impl LineStates {
    /// Returns the possible states of a moment, as seen from a file.
    fn seen(moment: Option<&FrictionStates>, file: &str) -> Self {
        moment.map_or_else(Self::default, |moment| Self {
            states: moment.states.iter().map(|state| state.as_str()).collect(),
            possible: moment.possible(file),
        })
    }
}

impl ShownRun {
    fn overview<'a>(&'a self, loaded: &'a LoadedMachine) -> Overview<'a> {
        let timeline = &self.timeline;
        let count = |severity| timeline.counts.get(&severity).copied().unwrap_or_default();
        let messages = timeline.said.iter().map(|said| Message {
            after: said.after,
            diagnostic: &said.diagnostic,
        });
        let passed_over = timeline.opaque.iter();
        Overview {
            program: &self.program,
            name: timeline.name.as_deref(),
            axes: self.axes(),
            axes_as_they_occur: timeline.axes_as_they_occur,
            blocks: timeline.rows.blocks,
            kept: timeline.rows.kept.len(),
            ended_by: timeline.ended_by.map(EndedBy::as_str),
            remark: timeline.remark.as_deref(),
            errors: count(Severity::Error),
            warnings: count(Severity::Warning),
            infos: count(Severity::Info),
            messages: messages.collect(),
            messages_left_out: timeline.left_out,
            passed_over: passed_over
                .map(|(word, times)| (word.as_str(), *times))
                .collect(),
            headline: timeline.headline.as_ref(),
            machine: MachineOverview {
                origin: loaded.origin.as_ref().map(|it| it.display().to_string()),
                is_described: loaded.machine.is_described()
                    && !timeline.summaries.iter().any(|axis| axis.is_undescribed),
                lists: loaded.lists.0,
                missing: loaded.lists.1,
                said: &loaded.diagnostics,
            },
            items: self.total(ShownBlocks::All),
            notable_items: self.total(ShownBlocks::Notable),
        }
    }

    fn axes(&self) -> Vec<AxisOverview<'_>> {
        let timeline = &self.timeline;
        let mut possible = LineStates::seen(timeline.rows.current(), &self.program).possible;
        let axes = timeline.axes.iter().enumerate();
        axes.map(|(at, axis)| {
            let mut summaries = timeline.summaries.iter();
            let summary = summaries.find(|summary| summary.axis.get() == at);
            let start = self.timeline.rows.states(None).get(at).copied();
            let start = start.unwrap_or(axis.start_up);
            let blocks = summary.map(|summary| summary.changed_by.as_slice());
            AxisOverview {
                name: &axis.name,
                start_up: axis.start_up.as_str(),
                start: start.as_str(),
                end: summary.map_or(start, |summary| summary.end).as_str(),
                listed: axis.listed,
                changes: summary.map_or(0, |summary| summary.changes),
                changed_by: blocks
                    .unwrap_or_default()
                    .iter()
                    .map(|block| ChangedAt {
                        file: &block.file,
                        line: block.line,
                        number: block.number,
                    })
                    .collect(),
                possible: possible
                    .iter_mut()
                    .find(|(axis, _)| *axis == at)
                    .map(|(_, words)| std::mem::take(words)),
                uncompensated: summary
                    .and_then(|summary| feed_moves_text(&summary.feed_moves, axis.axis_type)),
                bar: bar(&timeline.rows, at),
            }
        })
        .collect()
    }

    /// Returns the items of a view: the start, blocks and messages, the end.
    fn total(&self, view: ShownBlocks) -> usize {
        2 + self.shown_rows(view) + self.timeline.said.len()
    }

    fn shown_rows(&self, view: ShownBlocks) -> usize {
        match view {
            ShownBlocks::All => self.timeline.rows.kept.len(),
            ShownBlocks::Notable => self.notable.len(),
        }
    }

    /// Returns the number of shown blocks among the first so many.
    fn rank(&self, view: ShownBlocks, blocks: u64) -> usize {
        let blocks = usize::try_from(blocks).unwrap_or(usize::MAX);
        match view {
            ShownBlocks::All => blocks.min(self.timeline.rows.kept.len()),
            ShownBlocks::Notable => self
                .notable
                .partition_point(|row| usize::try_from(*row).is_ok_and(|row| row < blocks)),
        }
    }

    /// Returns the position of the message.
    fn place_of_message(&self, view: ShownBlocks, at: usize) -> usize {
        1 + self.rank(view, self.timeline.said[at].after) + at
    }

    /// Returns the position of a block, the start for 0; if it is not shown, that of the one before it.
    pub(crate) fn place(&self, view: ShownBlocks, block: u64) -> usize {
        let before = &self.timeline.said;
        let messages = before.partition_point(|said| said.after < block);
        self.rank(view, block) + if block == 0 { 0 } else { messages }
    }

    /// Returns the next block with a change or a message after a block, or the one before it.
    pub(crate) fn notable(&self, block: u64, forward: bool) -> Option<u64> {
        let numbers = self.notable.iter().map(|row| u64::from(*row) + 1);
        if forward {
            let mut after = numbers.skip_while(|number| *number <= block);
            after.next()
        } else {
            numbers.take_while(|number| *number < block).last()
        }
    }

    /// Returns the block that first executes a line of the program.
    pub(crate) fn block_of_line(&self, line: u32) -> Option<usize> {
        let rows = self.timeline.rows.kept.iter();
        let mut rows = rows.enumerate().filter(|(_, row)| row.level == 0);
        let (at, _) = rows.find(|(_, row)| {
            let last = row.line.saturating_add(u32::from(row.lines));
            (row.line..last).contains(&line)
        })?;
        Some(at + 1)
    }

    /// Returns a number of items of a view from one on.
    pub(crate) fn items(&mut self, view: ShownBlocks, from: usize, count: usize) -> Vec<u8> {
        let end = self.total(view).min(from.saturating_add(count));
        let wanted: Vec<Option<usize>> = (from..end).map(|at| self.row_at(view, at)).collect();
        for row in wanted.into_iter().flatten() {
            let file = self.timeline.rows.kept[row].file;
            let name = &self.timeline.rows.files[usize::from(file)];
            let text = self.disk.text(Path::new(name));
            let lines = || text.map(IndexedText::new);
            self.lines.entry(file).or_insert_with(lines);
        }
        let items: Vec<TimelineItem<'_>> = (from..end).map(|at| self.item(view, at)).collect();
        json(&items)
    }

    /// Returns the row of an item; `None` for the others.
    fn row_at(&self, view: ShownBlocks, at: usize) -> Option<usize> {
        let messages = self.messages_before(view, at);
        let is_message =
            messages < self.timeline.said.len() && self.place_of_message(view, messages) == at;
        let rank = at.checked_sub(1 + messages)?;
        if is_message || rank >= self.shown_rows(view) {
            return None;
        }
        Some(match view {
            ShownBlocks::All => rank,
            ShownBlocks::Notable => usize::try_from(self.notable[rank]).ok()?,
        })
    }

    fn messages_before(&self, view: ShownBlocks, at: usize) -> usize {
        let (mut low, mut high) = (0, self.timeline.said.len());
        while low < high {
            let middle = low.midpoint(high);
            if self.place_of_message(view, middle) < at {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }

    fn item(&self, view: ShownBlocks, at: usize) -> TimelineItem<'_> {
        let rows = &self.timeline.rows;
        let seen = |moment| LineStates::seen(moment, &self.program);
        let Some(row) = self.row_at(view, at) else {
            if at == 0 {
                return TimelineItem::Start {
                    states: seen(rows.moment(None)),
                };
            }
            let message = self.messages_before(view, at);
            if message < self.timeline.said.len() {
                return TimelineItem::Message { at: message };
            }
            return TimelineItem::End {
                states: seen(rows.current()),
            };
        };
        let kept = rows.kept[row];
        let file = rows.files[usize::from(kept.file)].as_str();
        let lines = self.lines.get(&kept.file).and_then(Option::as_ref);
        TimelineItem::Block {
            block: row + 1,
            file: (file != self.program).then_some(file),
            line: kept.line,
            level: kept.level,
            text: lines.map_or_else(String::new, |it| it.shown(kept.line, kept.lines)),
            states: LineStates::seen(rows.moment(Some(row)), file),
            changes: rows.changes(row),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROGRAM: &[u8] = b"\
N10 $IF V.E.MATERIAL == 2
N20 X[COMP OFF FRICT]
N30 $ENDIF
N40 G1 X1 F100
N50 M30
";

    #[test]
    fn an_unknown_state_says_when_it_is_which() {
        // R14.2
        let mut dropped = Dropped::default();
        dropped.put("a.nc", PROGRAM.to_vec(), true);
        let settings = RunSettings {
            enable: vec!["X".to_owned()],
            ..RunSettings::default()
        };
        let (mut shown, overview) = run(&mut dropped, "a.nc", &settings).expect("it runs");
        let read = |bytes: &[u8]| -> serde_json::Value {
            serde_json::from_slice(bytes).expect("it is JSON")
        };
        let words = "inactive if V.E.MATERIAL == 2 (line 1), else active";
        let overview = read(&overview);
        assert_eq!(overview["axes"][0]["end"], "unknown");
        assert_eq!(overview["axes"][0]["possible"], words);
        let items = read(&shown.items(ShownBlocks::All, 0, 100));
        let items = items.as_array().expect("a list");
        let at = |line: u32| items.iter().find(|it| it["line"] == line).expect("a block");
        assert_eq!(at(1).get("possible"), None);
        assert_eq!(at(2).get("possible"), None);
        assert_eq!(at(2)["changes"], serde_json::json!([0]));
        for line in [3, 4, 5] {
            assert_eq!(at(line)["states"][0], "unknown");
            assert_eq!(at(line)["possible"], serde_json::json!([[0, words]]));
            assert_eq!(at(line)["changes"], serde_json::json!([]));
        }
        let end = items.last().expect("the end");
        assert_eq!(end["possible"], serde_json::json!([[0, words]]));
        let notable = read(&shown.items(ShownBlocks::Notable, 0, 100));
        let notable = notable.as_array().expect("a list");
        assert!(notable.iter().any(|it| it["line"] == 3), "{notable:?}");
    }
}
