//! The result of `frictcomp replay` as text and as JSON.

use std::fmt::Write as _;

use serde_json::{Map, Value, json};

use frictcomp_host::replay::{
    Disagreement, MatchedChange, Replayed, ReplayedAxis, ReplayedBy, TriedCondition,
};
use frictcomp_report::visible_line;

/// Returns the result as text.
pub(super) fn text(replayed: &Replayed) -> String {
    let mut text = String::new();
    for axis in &replayed.axes {
        write_axis(&mut text, axis, replayed);
    }
    for tried in &replayed.decided {
        let _ = writeln!(text, "decided by the recording: {}", condition(tried));
    }
    if let Some(stopped) = &replayed.stopped {
        let _ = writeln!(text, "the dry run ends early: {}", visible_line(stopped));
    }
    if let Some(untried) = &replayed.untried {
        let _ = writeln!(text, "{}", visible_line(untried));
    }
    let [tried, fitting] = replayed.ways;
    if replayed.agrees() && fitting > 0 && tried > 1 {
        let _ = writeln!(
            text,
            "{fitting} of {tried} combinations of answers to the conditions fit; an answer that was fitted \
             proves nothing about itself"
        );
    } else if tried > 1 {
        let _ = writeln!(
            text,
            "none of {tried} combinations of answers to the conditions fits; the nearest one is shown"
        );
    }
    text
}

fn write_axis(text: &mut String, axis: &ReplayedAxis, replayed: &Replayed) {
    let count = axis.changes.len();
    let changes = if count == 1 { "change" } else { "changes" };
    let name = visible_line(&axis.name);
    let _ = match &axis.disagreement {
        None => writeln!(text, "{name}: {} ({count} {changes})", verdict(replayed)),
        Some(_) => writeln!(text, "{name}: disagrees after {count} {changes}"),
    };
    for change in &axis.changes {
        let state = word(change);
        let (file, line) = (visible_line(&change.at.file), change.at.line);
        let _ = writeln!(text, "  {:>10.3} s  {file}:{line}  {state}", change.t_s);
    }
    let by_order = axis.changes.iter();
    let by_order = by_order.filter(|it| it.by == ReplayedBy::Order).count();
    if by_order > 0 {
        let _ = writeln!(
            text,
            "  {by_order} of {count} compared by the order alone: where the machine switched is not known"
        );
    }
    if let Some(found) = &axis.disagreement {
        write_disagreement(text, found);
    }
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

fn write_disagreement(text: &mut String, found: &Disagreement) {
    let at = match &found.at {
        Some(at) => format!("{}:{}", visible_line(&at.file), at.line),
        None => "the start".to_owned(),
    };
    let _ = writeln!(
        text,
        "  {:>10.3} s  {at}  machine {}, dry run {}: {}",
        found.t_s,
        found.recorded,
        found.dry_run,
        visible_line(&found.why)
    );
    if !found.rests_on.is_empty() {
        let _ = writeln!(text, "  rests on {}", found.rests_on.join(", "));
    }
    for unknown in &found.unknown {
        let _ = writeln!(text, "  not known: {}", visible_line(unknown));
    }
}

fn condition(tried: &TriedCondition) -> String {
    let not = if tried.holds { "" } else { "not " };
    let (file, line) = (visible_line(&tried.file), tried.line);
    format!("{not}{} at {file}:{line}", visible_line(&tried.condition))
}

fn word(change: &MatchedChange) -> &'static str {
    if change.active { "active" } else { "inactive" }
}

/// Returns the result as JSON.
pub(super) fn document(replayed: &Replayed) -> Value {
    let axes = replayed.axes.iter();
    let axes: Map<String, Value> = axes.map(|it| (it.name.clone(), of_axis(it))).collect();
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
        "agrees": replayed.agrees(),
        "conditional": replayed.is_conditional(),
        "changes": replayed.changes(),
        "axes": axes,
        "decided": decided,
        "ways": { "tried": replayed.ways[0], "fitting": replayed.ways[1] },
    });
    for (key, reason) in [
        ("stopped", &replayed.stopped),
        ("untried", &replayed.untried),
    ] {
        if let Some(reason) = reason {
            document[key] = reason.as_str().into();
        }
    }
    document
}

fn of_axis(axis: &ReplayedAxis) -> Value {
    let place = |file: &str, line: u32| json!({ "file": file, "line": line });
    let changes: Vec<Value> = axis
        .changes
        .iter()
        .map(|it| {
            json!({
                "at": place(&it.at.file, it.at.line),
                "t": it.t_s,
                "state": word(it),
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
