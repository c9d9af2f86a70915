//! The report that compares a recording of a machine with the dry run (R15.21).

use serde_json::{Map, Value, json};

use crate::document::{Document, Headline, Phrase, Standing, Table};
use crate::svg::{Band, BandChart, BandRow, BandState, ChartAxis, StartUpRelation};
use crate::wording::{counted, to_json, visible_line};
use frictcomp::comp::State;
use frictcomp::diagnostic::Rounded;
use frictcomp_recordings::replay::{
    Disagreement, RecordedAxis, ReplayPlace, Replayed, ReplayedAxis, ReplayedBy, StateRecording,
    TriedCondition,
};

/// A recording of states compared with the dry run.
#[derive(Debug, Clone)]
pub struct ReplayReport<'a> {
    /// Name of the recording.
    pub name: String,
    /// The recorded states.
    pub recording: &'a StateRecording,
    /// The comparison.
    pub replayed: &'a Replayed,
}

/// Returns the recorded states, the verdict on each axis with its changes, and remarks on the whole.
pub fn document<'a>(report: &'a ReplayReport<'_>) -> Document<'a> {
    let title = format!("{} compared with the dry run", report.name);
    let mut out = Document::new(title, headline(report.replayed));
    out.figure(|| chart(report.recording));
    out.section("Changes");
    for axis in &report.replayed.axes {
        push_axis(&mut out, axis, report.replayed);
    }
    out.lines(remarks(report.replayed));
    out
}

fn push_axis(out: &mut Document<'_>, axis: &ReplayedAxis, replayed: &Replayed) {
    let verdict = verdict_of(axis, replayed);
    out.lines([format!("{}: {verdict}", visible_line(&axis.name))]);
    let at = |time_s: f64| format!("  {time_s:>10.3} s");
    let mut table = Table::plain(["time", "block of the dry run", "state"]);
    for change in &axis.changes {
        let (time, place) = (at(change.t_s), at_place(&change.at));
        table.cells([
            time.into(),
            place.into(),
            Phrase::state(state(change.active)),
        ]);
    }
    if !axis.changes.is_empty() {
        out.table(table);
    }
    let by_order = axis.changes.iter();
    let by_order = by_order.filter(|it| it.by == ReplayedBy::Order).count();
    if by_order > 0 {
        out.lines([format!(
            "  {by_order} of {} compared by the order alone: where the machine switched is not known",
            axis.changes.len()
        )]);
    }
    if let Some(found) = &axis.disagreement {
        let mut reasons = against(found).into_iter();
        let first = reasons.next();
        out.lines(first.map(|first| format!("{}  {first}", at(found.t_s))));
        out.lines(reasons.map(|it| format!("  {it}")));
    }
}

fn state(active: bool) -> State {
    if active {
        State::Active
    } else {
        State::Inactive
    }
}

fn chart(recording: &StateRecording) -> BandChart {
    BandChart {
        description: "The recorded state of friction compensation of each axis over the time."
            .to_owned(),
        x: ChartAxis {
            label: "time in s".to_owned(),
            ..ChartAxis::default()
        },
        rows: recording.axes.iter().map(row).collect(),
        ..BandChart::default()
    }
}

fn row(axis: &RecordedAxis) -> BandRow {
    let switched = axis.changes.iter().map(|it| (it.t_s, it.active));
    let ends = switched.clone().map(|it| it.0).chain([axis.end_s]);
    let states = std::iter::once((axis.start_s, axis.start)).chain(switched);
    let bands = states.zip(ends).map(|((from, active), to)| {
        let state = state(active);
        Band {
            from,
            to,
            state: BandState::One(state),
            relation: StartUpRelation::default(),
            title: format!(
                "{} from {} s to {} s",
                state.as_str(),
                Rounded(from, 3),
                Rounded(to, 3)
            ),
            href: None,
        }
    });
    BandRow {
        label: axis.name.clone(),
        bands: bands.collect(),
    }
}

/// Returns the verdict: the first axis that disagrees, or that all agree (R18.20).
fn headline(replayed: &Replayed) -> Headline {
    let mut axes = replayed.axes.iter();
    let disagreeing = axes.find_map(|axis| Some((axis, axis.disagreement.as_ref()?)));
    if let Some((axis, found)) = disagreeing {
        let first = against(found).into_iter().next();
        let count = counted(axis.changes.len(), "change");
        let text = format!(
            "the machine did not do what the dry run says: {} differs after {count}, at {:.3} s, {}",
            axis.name,
            found.t_s,
            first.unwrap_or_default()
        );
        return Headline::new(Standing::Bad, text);
    }
    let count = counted(replayed.changes(), "change");
    let axes: Vec<&str> = replayed.axes.iter().map(|it| it.name.as_str()).collect();
    let axes = axes.join(" ");
    if replayed.is_conditional() || !replayed.agrees() {
        let verdict = verdict(replayed);
        return Headline::new(
            Standing::Open,
            format!("the machine {verdict}: {count} of {axes}"),
        );
    }
    let text = format!("the machine did what the dry run says: {count} of {axes}");
    Headline::new(Standing::Good, text)
}

/// Returns the remarks on all axes, in sentences.
fn remarks(replayed: &Replayed) -> Vec<String> {
    let decided = replayed.decided.iter();
    let decided = decided.map(|it| format!("decided by the recording: {}", condition(it)));
    let stopped = replayed.stopped.iter();
    let stopped = stopped.map(|it| format!("the dry run ends early: {}", visible_line(it)));
    let untried = replayed.untried.iter();
    let untried = untried.map(|it| visible_line(it).into_owned());
    let [tried, fitting] = replayed.ways;
    let ways = if replayed.agrees() && fitting > 0 && tried > 1 {
        Some(format!(
            "{fitting} of {tried} combinations of answers to the conditions fit; an answer that was fitted \
             proves nothing about itself"
        ))
    } else if tried > 1 {
        Some(format!(
            "none of {tried} combinations of answers to the conditions fits; the nearest one is shown"
        ))
    } else {
        None
    };
    let unrecorded = replayed.unrecorded.iter();
    let unrecorded = unrecorded.map(|axis| {
        let axis = visible_line(axis);
        format!("{axis}: switched by the programs but not recorded, so not compared")
    });
    let gap = replayed.gap.map(|gap| {
        format!(
            "no samples for {:.3} s after {:.3} s: a change that is undone meanwhile is not seen",
            gap.length_s, gap.at_s
        )
    });
    let limits = unrecorded.chain(gap);
    let found = decided.chain(stopped).chain(untried).chain(ways);
    found.chain(limits).collect()
}

/// Returns the verdict on an axis, with the number of changes on which both agree.
fn verdict_of(axis: &ReplayedAxis, replayed: &Replayed) -> String {
    let count = axis.changes.len();
    let changes = if count == 1 { "change" } else { "changes" };
    match &axis.disagreement {
        None => format!("{} ({count} {changes})", verdict(replayed)),
        Some(_) => format!("disagrees after {count} {changes}"),
    }
}

/// Returns a place as `file:line`.
fn at_place(at: &ReplayPlace) -> String {
    format!("{}:{}", visible_line(&at.file), at.line)
}

fn verdict(replayed: &Replayed) -> String {
    if !replayed.is_conditional() {
        return "agrees".to_owned();
    }
    let decided: Vec<String> = replayed.decided.iter().map(condition).collect();
    match decided.len() {
        0 => "agrees with some answers to the conditions".to_owned(),
        _ => format!("agrees if {}", decided.join(", ")),
    }
}

/// Returns a disagreement in sentences, the first with its place.
fn against(found: &Disagreement) -> Vec<String> {
    let at = found.at.as_ref().map(at_place);
    let first = format!(
        "{}  machine {}, dry run {}: {}",
        at.as_deref().unwrap_or("the start"),
        found.recorded,
        found.dry_run,
        visible_line(&found.why)
    );
    let rests_on =
        (!found.rests_on.is_empty()).then(|| format!("rests on {}", found.rests_on.join(", ")));
    let unknown = found.unknown.iter();
    let unknown = unknown.map(|it| format!("not known: {}", visible_line(it)));
    std::iter::once(first)
        .chain(rests_on)
        .chain(unknown)
        .collect()
}

fn condition(tried: &TriedCondition) -> String {
    let not = if tried.holds { "" } else { "not " };
    let (file, line) = (visible_line(&tried.file), tried.line);
    format!("{not}{} at {file}:{line}", visible_line(&tried.condition))
}

/// Returns the result as JSON.
pub fn render_json(report: &ReplayReport<'_>) -> String {
    let replayed = report.replayed;
    let axes = replayed.axes.iter();
    let axes: Map<String, Value> = axes.map(|it| (it.name.clone(), axis_record(it))).collect();
    let decided: Vec<Value> = replayed
        .decided
        .iter()
        .map(|it| {
            let (file, line) = (&*it.file, it.line);
            json!({ "file": file, "line": line, "condition": it.condition, "holds": it.holds })
        })
        .collect();
    let mut document = json!({
        "schema": 1,
        "headline": headline(replayed),
        "agrees": replayed.agrees(),
        "conditional": replayed.is_conditional(),
        "changes": replayed.changes(),
        "axes": axes,
        "decided": decided,
        "ways": { "tried": replayed.ways[0], "fitting": replayed.ways[1] },
        "unrecorded": replayed.unrecorded,
    });
    if let Some(gap) = replayed.gap {
        document["gap"] = json!({ "t": gap.at_s, "seconds": gap.length_s });
    }
    for (key, reason) in [
        ("stopped", &replayed.stopped),
        ("untried", &replayed.untried),
    ] {
        if let Some(reason) = reason {
            document[key] = reason.as_str().into();
        }
    }
    to_json(&document)
}

fn axis_record(axis: &ReplayedAxis) -> Value {
    let place = |file: &str, line: u32| json!({ "file": file, "line": line });
    let changes: Vec<Value> = axis
        .changes
        .iter()
        .map(|it| {
            json!({
                "at": place(&it.at.file, it.at.line),
                "t": it.t_s,
                "state": state(it.active).as_str(),
                "by": it.by.as_str(),
            })
        })
        .collect();
    let Some(found) = &axis.disagreement else {
        return json!({ "agrees": true, "changes": changes });
    };
    json!({
        "agrees": false,
        "changes": changes,
        "at": found.at.as_ref().map(|it| place(&it.file, it.line)),
        "t": found.t_s,
        "recorded": found.recorded,
        "dry_run": found.dry_run,
        "why": found.why,
        "rests_on": found.rests_on,
        "unknown": found.unknown,
    })
}
