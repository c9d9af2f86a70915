//! What a status bar and a timeline view ask for, beyond the protocol.

use gen_lsp_types::{
    LspRequestMethod, MessageDirection, Position, Request, TextDocumentIdentifier, Uri,
};
use serde::{Deserialize, Serialize};

use super::states::StateSet;
use super::view::View;
use crate::comp::State;

/// `frictcomp/states`: the states of all axes at a place.
pub(super) enum StatesRequest {}

impl Request for StatesRequest {
    type Params = StatesParams;
    type Result = Option<States>;
    const METHOD: LspRequestMethod<'static> = LspRequestMethod::Custom("frictcomp/states");
    const MESSAGE_DIRECTION: MessageDirection = MessageDirection::ClientToServer;
}

/// The place that `frictcomp/states` asks about.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StatesParams {
    /// The text.
    pub(super) text_document: TextDocumentIdentifier,
    /// The place.
    pub(super) position: Position,
}

/// The states of all axes at a block.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct States {
    /// The line of the block, from 0; that of the last executed block before the place where the
    /// place itself is in none.
    pub(super) line: u32,
    /// Whether the place is in that block.
    pub(super) executed: bool,
    /// How often the block was executed.
    pub(super) times: u64,
    /// The axes.
    pub(super) axes: Vec<AxisStates>,
    /// All of it in one short line: `X active, Y inactive → active`.
    pub(super) text: String,
}

/// An axis at a block. In a loop or a subprogram there may be several states.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct AxisStates {
    /// Its name.
    pub(super) axis: String,
    /// The states before the block, those of the first pass first.
    pub(super) before: Vec<State>,
    /// The states after it.
    pub(super) after: Vec<State>,
}

/// `frictcomp/timeline`: the states of all axes over the executed blocks.
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
    /// The program.
    pub(super) text_document: TextDocumentIdentifier,
}

/// The states of all axes over the executed blocks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Timeline {
    /// The axes.
    pub(super) axes: Vec<AxisTimeline>,
    /// How often states changed besides, in a run with too many changes to show.
    pub(super) left_out: u64,
    /// That no machine is described, in words.
    pub(super) remark: Option<String>,
}

/// An axis over the executed blocks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct AxisTimeline {
    /// Its name.
    pub(super) axis: String,
    /// Its states, in the order of the run.
    pub(super) segments: Vec<Segment>,
}

/// Executed blocks with the same state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Segment {
    /// The state.
    pub(super) state: State,
    /// The text that holds the block which begins it.
    pub(super) uri: Uri,
    /// The line of the block which begins it, from 0; that of the first line for the start.
    pub(super) from_line: u32,
    /// The line of the block which ends it, from 0; that of the last executed block at the end.
    pub(super) to_line: u32,
    /// The block which begins it; empty for the start.
    pub(super) text: String,
}

/// The states at a place.
pub(super) fn states(view: &View, params: &StatesParams) -> Option<States> {
    let document = view.document(&params.text_document.uri)?;
    let wanted = View::block_at(document, params.position);
    let (_, run, name) = view.runs(document).into_iter().next()?;
    let line = run.states.executed_up_to(&name, wanted)?;
    let passes = run.states.passes(&name, line);
    let of = |set: &StateSet, at: usize| set.get(at).copied().flatten();
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
                add(&mut states.before, of(pass.before, at));
                add(&mut states.after, of(pass.after, at));
            }
            (!states.after.is_empty()).then_some(states)
        });
    let axes: Vec<AxisStates> = axes.collect();
    Some(States {
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

/// `X active`, `X active → inactive`, `X active or inactive`.
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

/// The states of a program over its executed blocks.
pub(super) fn timeline(view: &View, params: &TimelineParams) -> Option<Timeline> {
    let document = view.document(&params.text_document.uri)?;
    let run = view.analysis(&document.uri)?.run.as_ref()?;
    let last = run.states.at_end().1.unwrap_or(1).saturating_sub(1);
    let marks: Vec<_> = run.states.marks().collect();
    let axes = run.states.axes().iter().enumerate();
    let axes = axes.filter_map(|(at, axis)| {
        let mut segments: Vec<Segment> = Vec::new();
        for (mark, set) in &marks {
            let Some(state) = set.get(at).copied().flatten() else {
                continue;
            };
            let line = mark.line.saturating_sub(1);
            if let Some(earlier) = segments.last_mut() {
                if earlier.state == state {
                    continue;
                }
                earlier.to_line = line;
            }
            segments.push(Segment {
                state,
                uri: view.translator().uri(&mark.file),
                from_line: line,
                to_line: last,
                text: mark.text.clone(),
            });
        }
        (!segments.is_empty()).then(|| AxisTimeline {
            axis: axis.clone(),
            segments,
        })
    });
    Some(Timeline {
        axes: axes.collect(),
        left_out: run.states.unmarked(),
        remark: run.remark.clone(),
    })
}
