//! The result of `frictcomp replay` in sentences and as JSON.

use serde_json::{Map, Value, json};

use frictcomp_host::replay::{
    Disagreement, MatchedChange, ReplayPlace, Replayed, ReplayedAxis, TriedCondition,
};
use frictcomp_report::{Headline, Standing, counted, visible_line};

/// Returns the verdict: the first axis that disagrees, or that all agree (R18.20).
pub(super) fn headline(replayed: &Replayed) -> Headline {
    let mut against = replayed.axes.iter();
    let against = against.find_map(|axis| Some((axis, axis.disagreement.as_ref()?)));
    if let Some((axis, found)) = against {
        let first = self::against(found).into_iter().next();
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
pub(super) fn remarks(replayed: &Replayed) -> Vec<String> {
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
pub(super) fn verdict_of(axis: &ReplayedAxis, replayed: &Replayed) -> String {
    let count = axis.changes.len();
    let changes = if count == 1 { "change" } else { "changes" };
    match &axis.disagreement {
        None => format!("{} ({count} {changes})", verdict(replayed)),
        Some(_) => format!("disagrees after {count} {changes}"),
    }
}

/// Returns a place as `file:line`.
pub(super) fn at_place(at: &ReplayPlace) -> String {
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
pub(super) fn against(found: &Disagreement) -> Vec<String> {
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

/// Returns the state after a change.
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
