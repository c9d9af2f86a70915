//! Requests for a status bar and a timeline view, beyond the protocol.

use gen_lsp_types::{
    LspRequestMethod, MessageDirection, Position, Request, TextDocumentIdentifier,
};
use serde::{Deserialize, Serialize};

use super::states::{Pass, StateSet};
use super::view::RequestView;
use frictcomp::comp::State;

/// `frictcomp/states`: the states of all axes at a place.
pub(super) enum StatesRequest {}

impl Request for StatesRequest {
    type Params = StatesParams;
    type Result = Option<BlockStates>;
    const METHOD: LspRequestMethod<'static> = LspRequestMethod::Custom("frictcomp/states");
    const MESSAGE_DIRECTION: MessageDirection = MessageDirection::ClientToServer;
}

/// The place that `frictcomp/states` asks about.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StatesParams {
    /// The program or list that is asked about.
    pub(super) text_document: TextDocumentIdentifier,
    /// The place.
    pub(super) position: Position,
}

/// The states of all axes at a block.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct BlockStates {
    /// The line of the block, from 0; if the place is not in an executed block, that of the last executed
    /// block before it.
    pub(super) line: u32,
    /// Whether the place is in an executed block.
    pub(super) executed: bool,
    /// Number of executions of the block.
    pub(super) times: u64,
    /// The axes.
    pub(super) axes: Vec<AxisStates>,
    /// States of all axes in one short line: `X active, Y inactive → active`.
    pub(super) text: String,
}

/// An axis at a block. In a loop or a subprogram there may be several states.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct AxisStates {
    /// Name of the axis.
    pub(super) axis: String,
    /// The states before the block, those of the first pass first.
    pub(super) before: Vec<State>,
    /// The states after it.
    pub(super) after: Vec<State>,
}

/// `frictcomp/timeline`: the states of all axes over the lines of a program.
pub(super) enum TimelineRequest {}

impl Request for TimelineRequest {
    type Params = TimelineParams;
    type Result = Option<Timeline>;
    const METHOD: LspRequestMethod<'static> = LspRequestMethod::Custom("frictcomp/timeline");
    const MESSAGE_DIRECTION: MessageDirection = MessageDirection::ClientToServer;
}

/// The program that `frictcomp/timeline` asks about.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TimelineParams {
    /// The program that is asked about.
    pub(super) text_document: TextDocumentIdentifier,
}

/// The states of all axes over the lines of a program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Timeline {
    /// Number of lines of the program.
    pub(super) lines: u32,
    /// The axes.
    pub(super) axes: Vec<AxisTimeline>,
    /// Remark that no machine is described, in words.
    pub(super) remark: Option<String>,
}

/// An axis over the lines of a program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct AxisTimeline {
    /// Name of the axis.
    pub(super) axis: String,
    /// States, from the first line to the last.
    pub(super) segments: Vec<StateSegment>,
}

/// Lines after which an axis has the same states.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StateSegment {
    /// The first line, from 0.
    pub(super) from: u32,
    /// The first line after them.
    pub(super) to: u32,
    /// The states; in a loop or a subprogram there may be several.
    pub(super) states: Vec<State>,
}

/// Returns the states at a place.
pub(super) fn states(view: &RequestView, params: &StatesParams) -> Option<BlockStates> {
    let document = view.document(&params.text_document.uri)?;
    let wanted = RequestView::block_at(document, params.position);
    let (_, run, name) = view.runs(document).into_iter().next()?;
    let line = run.states.executed_up_to(&name, wanted)?;
    let passes = run.states.passes(&name, line);
    let axes = run
        .states
        .axes()
        .iter()
        .enumerate()
        .filter_map(|(at, axis)| {
            let mut states = AxisStates {
                axis: axis.clone(),
                before: Vec::new(),
                after: Vec::new(),
            };
            for pass in &passes {
                add(&mut states.before, pass.before.state(at));
                add(&mut states.after, pass.after.state(at));
            }
            (!states.after.is_empty()).then_some(states)
        });
    let axes: Vec<AxisStates> = axes.collect();
    Some(BlockStates {
        line: line - 1,
        executed: line == wanted,
        times: passes.iter().map(|pass| u64::from(pass.times)).sum(),
        text: axes.iter().map(in_words).collect::<Vec<_>>().join(", "),
        axes,
    })
}

fn add(states: &mut Vec<State>, state: Option<State>) {
    if let Some(state) = state
        && !states.contains(&state)
    {
        states.push(state);
    }
}

/// Returns `X active`, `X active → inactive`, `X active or inactive`.
fn in_words(axis: &AxisStates) -> String {
    let words = |states: &[State]| {
        let words: Vec<&str> = states.iter().map(|state| state.as_str()).collect();
        words.join(" or ")
    };
    let (name, after) = (&axis.axis, words(&axis.after));
    if axis.before == axis.after {
        return format!("{name} {after}");
    }
    format!("{name} {} \u{2192} {after}", words(&axis.before))
}

/// Returns the states of a program over its lines. Before the first executed block they are those at its start; lines
/// that are not executed have those of the block above.
pub(super) fn timeline(view: &RequestView, params: &TimelineParams) -> Option<Timeline> {
    let document = view.document(&params.text_document.uri)?;
    let (_, run, name) = view.runs(document).into_iter().next()?;
    let lines = document.line_count();
    let names = run.states.axes().iter();
    let mut axes: Vec<AxisTimeline> = names
        .map(|axis| AxisTimeline {
            axis: axis.clone(),
            segments: Vec::new(),
        })
        .collect();
    for (line, passes) in run.states.executed(&name) {
        for (at, axis) in axes.iter_mut().enumerate() {
            let states = |of: for<'p> fn(&Pass<'p>) -> &'p StateSet| {
                let mut states = Vec::new();
                for pass in &passes {
                    add(&mut states, of(pass).state(at));
                }
                states
            };
            if axis.segments.is_empty() && line > 1 {
                axis.begin(0, states(|pass| pass.before));
            }
            axis.begin(line - 1, states(|pass| pass.after));
        }
    }
    axes.retain_mut(|axis| axis.finish(lines));
    Some(Timeline {
        lines,
        axes,
        remark: run.remark.clone(),
    })
}

impl AxisTimeline {
    /// Notes that the axis has these states from a line on.
    fn begin(&mut self, line: u32, states: Vec<State>) {
        if let Some(last) = self.segments.last_mut() {
            if last.states == states {
                return;
            }
            last.to = line;
        }
        self.segments.push(StateSegment {
            from: line,
            to: line,
            states,
        });
    }

    /// Ends the program after this many lines. Returns whether the axis occurs in it.
    fn finish(&mut self, lines: u32) -> bool {
        if let Some(last) = self.segments.last_mut() {
            last.to = lines;
        }
        self.segments.retain(|segment| !segment.states.is_empty());
        !self.segments.is_empty()
    }
}
