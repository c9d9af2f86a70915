//! The places in a program for a block that ends a hazard.

use std::collections::BTreeSet;

use super::mending::{Cure, Mending};
use super::observation::Observation;
use super::runs::ProgramRuns;
use crate::interpreter::EndedBy;
use crate::text::Numbering;

/// The most places that are tried.
const MOST: usize = 16;

/// Returns the lines before which blocks could go, the best ones first; several lines get a block
/// each.
pub(super) fn places<'a>(
    text: &str,
    mending: Mending,
    runs: impl Iterator<Item = &'a ProgramRuns> + Clone,
) -> Vec<Vec<u32>> {
    let observations = runs.flat_map(|ProgramRuns { start_up, away, .. }| [start_up, away]);
    let mut places = match mending.cure {
        Cure::Inheritors => before_motions(mending.at, observations),
        Cure::Leavers | Cure::None => before_ends(text, &observations),
    };
    let mut seen = BTreeSet::new();
    places.retain(|place| !place.is_empty() && seen.insert(place.clone()));
    places.truncate(MOST);
    places
}

fn before_motions<'a>(
    at: usize,
    runs: impl Iterator<Item = &'a Observation> + Clone,
) -> Vec<Vec<u32>> {
    let moved = runs.clone().filter_map(|run| {
        let moved = run.observed[at].inherited.as_ref();
        moved.and_then(|moved| moved.within)
    });
    let firsts = runs.filter_map(|run| run.within.first_line);
    let each = moved.clone().chain(firsts).map(|line| vec![line]);
    let all: BTreeSet<u32> = moved.collect();
    each.chain([all.into_iter().collect()]).collect()
}

fn before_ends<'a>(
    text: &str,
    runs: &(impl Iterator<Item = &'a Observation> + Clone),
) -> Vec<Vec<u32>> {
    let numbering = Numbering::of(text);
    let ends = |end: &dyn Fn(&Observation) -> BTreeSet<u32>| {
        let ends: BTreeSet<u32> = runs.clone().flat_map(end).collect();
        ends.into_iter().collect::<Vec<_>>()
    };
    let end_after = |line: u32| after(&numbering, line);
    // A file that others call ends with M17, however it is started.
    let is_called = runs.clone().any(|run| !run.within.is_of_main());
    let returned = |run: &Observation| match run.end {
        _ if !run.within.is_of_main() => run.within.returns.clone(),
        Some(line) if run.by != Some(EndedBy::EndOfFile) => BTreeSet::from([line]),
        _ => {
            let last = run.within.last_lines().next().unwrap_or_default();
            BTreeSet::from([if is_called { last } else { end_after(last) }])
        }
    };
    // A file that ends without M17 ends after its last block.
    let run_out = |run: &Observation| {
        let last = |line: u32| {
            let end = end_after(line);
            let is_last = end == line + 1;
            if is_last { end } else { line }
        };
        returned(run).into_iter().map(last).collect()
    };
    // It may also end earlier, in a control block or at an error.
    let each = |run: &Observation| run.ends.clone();
    let back = runs.clone().take(1);
    let back = back.flat_map(|run| run.within.last_lines());
    [ends(&returned), ends(&run_out), ends(&each)]
        .into_iter()
        .chain(back.map(|line| vec![line]))
        .collect()
}

/// Returns the line after the blocks that follow a line: the end of the file, or of its section.
fn after(numbering: &Numbering<'_>, last: u32) -> u32 {
    let lines = numbering.lines();
    let last = usize::try_from(last).unwrap_or_default();
    // Another program may follow in the same file.
    let after = lines.iter().enumerate().skip(last);
    let mut sections = after.filter(|(_, line)| line.trim_start().starts_with('%'));
    let end = sections.next().map_or(lines.len(), |(at, _)| at);
    let written = lines[..end]
        .iter()
        .rposition(|line| !line.trim().is_empty());
    let end = written.map_or(0, |written| written + 1);
    u32::try_from(end + 1).unwrap_or(u32::MAX)
}
