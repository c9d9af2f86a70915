//! The block that ends a hazard: the places for it, inserted into a text that stays as it is everywhere else, and tried out
//! before it is offered (R10.3).

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use serde::Serialize;

use super::effect::{Inherits, ProgramEffect};
use super::observation::Observation;
use super::program::{Auditor, AxisAudit};
use super::runs::ProgramRuns;
use crate::interpreter::{EndedBy, Interpreter, Observer};
use crate::text::Numbering;

/// Motions whose state of compensation a block may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum CuredMotions {
    /// No motion: every one keeps its state (R10.8).
    #[default]
    Kept,
    /// A block that changes one is taken where no other helps.
    Changed,
}

/// A mended file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Mended {
    /// The blocks, in no particular order.
    pub insertions: Vec<Insertion>,
    /// The programs that they take out of hazards, by their positions among the [`Affected`] ones.
    pub cured: Vec<usize>,
    /// The programs in which they change the state of a motion.
    pub changed: Vec<Arc<str>>,
    /// Mendings left to the user, with the file taken as a program in its own right.
    pub missed: Vec<Missed>,
}

/// A mending that no block achieves.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Missed {
    /// The mending wanted.
    pub mending: Mending,
    /// The reason for leaving it to the user.
    pub why: WhyMissed,
}

/// The reason for leaving something to the user.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum WhyMissed {
    /// No single block cures the program of its hazards.
    NotCured,
    /// Blocks that do so change the state in which axes move in this program (R10.8).
    ChangesMotion(Arc<str>),
}

/// A program that runs the blocks of a file: the file itself, or a program that calls it.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Affected<'a> {
    /// The auditor of its machine.
    pub auditor: &'a Auditor,
    /// Name of the program.
    pub name: Arc<str>,
    /// The name under which it calls the file; `None` for the file itself.
    pub calls: Option<Arc<str>>,
    /// Mendings that a block in the file should achieve.
    pub wanted: Vec<Mending>,
}

/// Runs one of the [`Affected`] programs, by its position, with a text in place of the file.
trait RunWith<E>: FnMut(usize, &str, &mut Interpreter, &mut dyn Observer) -> Result<(), E> {}

impl<E, F> RunWith<E> for F where
    F: FnMut(usize, &str, &mut Interpreter, &mut dyn Observer) -> Result<(), E>
{
}

/// Finds the blocks that mend a file of this text. Each place is tried out on every program that runs the file: those
/// to mend must no longer take part in the hazard, no program may enter one, and no motion of any of them may change
/// its state when the program starts in its start-up state; from another state, it may only change to the start-up
/// state, unless `motions` may change (R10.8). `run` runs a program, by its position, with a text in place of the file.
///
/// # Errors
/// The errors of `run`.
pub fn mend<E>(
    text: &str,
    programs: &[Affected<'_>],
    motions: CuredMotions,
    mut run: impl FnMut(usize, &str, &mut Interpreter, &mut dyn Observer) -> Result<(), E>,
) -> Result<Mended, E> {
    let before = (0..programs.len()).map(|at| observe(&programs[at], (at, text), &mut run));
    let before = before.collect::<Result<Vec<ProgramRuns>, E>>()?;
    let mut trial = Trial {
        text,
        programs,
        before,
        now: None,
        accepted: Mended::default(),
        motions,
        run,
    };
    let mut wanted: Vec<Mending> = Vec::new();
    for mending in programs.iter().flat_map(|program| &program.wanted) {
        if !wanted.contains(mending) {
            wanted.push(*mending);
        }
    }
    for mending in wanted {
        trial.mend(mending)?;
    }
    Ok(trial.accepted)
}

/// Runs a program with a text in place of one file.
fn observe<E>(
    program: &Affected<'_>,
    (at, text): (usize, &str),
    run: &mut impl RunWith<E>,
) -> Result<ProgramRuns, E> {
    let run = &mut |interpreter: &mut Interpreter, listen: &mut dyn Observer| {
        run(at, text, interpreter, listen)
    };
    program.auditor.observe(program.calls.as_ref(), run)
}

/// A file that is being mended.
struct Trial<'a, R> {
    text: &'a str,
    programs: &'a [Affected<'a>],
    /// The runs of the programs without any block.
    before: Vec<ProgramRuns>,
    /// The runs with the accepted blocks; `None` before the first block is accepted.
    now: Option<Vec<ProgramRuns>>,
    accepted: Mended,
    motions: CuredMotions,
    run: R,
}

/// Blocks at one place that cure programs and bring no hazard.
struct Attempt {
    insertions: Vec<Insertion>,
    runs: Vec<ProgramRuns>,
    cured: Vec<usize>,
    /// The programs in which they change the state of a motion.
    changed: Vec<Arc<str>>,
}

impl Attempt {
    /// Returns its worth among others: one that changes no motion goes before those that cure more.
    fn worth(&self) -> (bool, usize) {
        (self.changed.is_empty(), self.cured.len())
    }
}

impl<R> Trial<'_, R> {
    fn mend<E>(&mut self, mending: Mending) -> Result<(), E>
    where
        R: RunWith<E>,
    {
        let goals: Vec<usize> = (0..self.programs.len())
            .filter(|&at| self.programs[at].wanted.contains(&mending))
            .filter(|&at| !self.is_cured(at, &self.now()[at], mending))
            .collect();
        let Some(&first) = goals.first() else {
            return Ok(());
        };
        let audits = self.programs[first].auditor.axes(&self.before[first]);
        let command = audits[mending.at].way_home();
        let mut why = WhyMissed::NotCured;
        let mut best: Option<Attempt> = None;
        let runs = goals.iter().map(|&at| &self.before[at]);
        for lines in places(self.text, mending, runs) {
            let insertions = self.with_blocks(&lines, &command);
            match self.attempt(insertions, mending, &goals)? {
                Ok(attempt) => {
                    if best.as_ref().map(Attempt::worth) < Some(attempt.worth()) {
                        best = Some(attempt);
                    }
                }
                Err(reason) if why == WhyMissed::NotCured => why = reason,
                Err(_) => {}
            }
            if best
                .as_ref()
                .is_some_and(|it| it.worth() == (true, goals.len()))
            {
                break;
            }
        }
        let own = |&at: &usize| self.programs[at].calls.is_none();
        // One program that calls the file is mended in its own text.
        let is_root = |it: &Attempt| it.cured.len() > 1 || it.cured.iter().any(own);
        let best = best.filter(is_root);
        let cured = best.as_ref().map_or(&[][..], |it| &it.cured);
        let is_missed = goals.iter().any(|at| own(at) && !cured.contains(at));
        if is_missed {
            self.accepted.missed.push(Missed { mending, why });
        }
        if let Some(best) = best {
            self.accepted.insertions = best.insertions;
            self.accepted.changed.extend(best.changed);
            self.accepted.cured.extend(best.cured);
            self.accepted.cured.sort_unstable();
            self.accepted.cured.dedup();
            self.now = Some(best.runs);
        }
        Ok(())
    }

    /// Tries blocks on every program: first on those that they should mend.
    fn attempt<E>(
        &mut self,
        insertions: Vec<Insertion>,
        mending: Mending,
        goals: &[usize],
    ) -> Result<Result<Attempt, WhyMissed>, E>
    where
        R: RunWith<E>,
    {
        let edited = with_blocks(self.text, &insertions);
        let mut runs = BTreeMap::new();
        for &at in goals {
            let observed = observe(&self.programs[at], (at, &edited), &mut self.run)?;
            runs.insert(at, observed);
        }
        let is_cured = |at: &usize| self.is_cured(*at, &runs[at], mending);
        let cured: Vec<usize> = goals.iter().copied().filter(is_cured).collect();
        if cured.is_empty() {
            return Ok(Err(WhyMissed::NotCured));
        }
        let mut changed = Vec::new();
        for (at, program) in self.programs.iter().enumerate() {
            let observed = match runs.remove(&at) {
                Some(observed) => observed,
                None => observe(program, (at, &edited), &mut self.run)?,
            };
            if !self.keeps_motions(at, &observed) {
                let name = Arc::clone(&program.name);
                if self.motions == CuredMotions::Kept {
                    return Ok(Err(WhyMissed::ChangesMotion(name)));
                }
                changed.push(name);
            }
            if self.brings_a_hazard(at, &observed) {
                return Ok(Err(WhyMissed::NotCured));
            }
            runs.insert(at, observed);
        }
        Ok(Ok(Attempt {
            insertions,
            runs: runs.into_values().collect(),
            cured,
            changed,
        }))
    }

    fn now(&self) -> &[ProgramRuns] {
        self.now.as_ref().unwrap_or(&self.before)
    }

    /// Returns the blocks so far, plus one before each of the given lines.
    fn with_blocks(&self, lines: &[u32], command: &str) -> Vec<Insertion> {
        let mut blocks = self.accepted.insertions.clone();
        let mut numbering = Numbering::of(self.text);
        // Block numbers given out before are taken.
        for block in &blocks {
            numbering.take(&block.text);
        }
        for &line in lines {
            blocks.push(Insertion {
                line,
                text: numbering.block(line, command),
            });
        }
        blocks
    }

    /// Returns whether every motion keeps its state when started in the start-up state, and from another state changes
    /// at most to the start-up state.
    fn keeps_motions(&self, program: usize, after: &ProgramRuns) -> bool {
        let before = &self.before[program];
        let scope = self.programs[program].auditor.scope();
        (0..scope.subjects().len()).all(|at| {
            let start_up = scope.selected_at_start(scope.subjects()[at], false);
            let motions = |run: &Observation| run.observed[at].motions.clone();
            let only_become = |before: &Observation, after: &Observation| {
                motions(before).only_become(&motions(after), start_up)
            };
            let mut between = before.between.iter();
            motions(&before.start_up) == motions(&after.start_up)
                && only_become(&before.away, &after.away)
                && between.all(|(start, before)| {
                    let after = after.between.get(start);
                    after.is_none_or(|after| only_become(before, after))
                })
        })
    }

    /// Returns whether a program now leaves, or may leave, an axis away from its start-up state.
    fn brings_a_hazard(&self, program: usize, after: &ProgramRuns) -> bool {
        let auditor = self.programs[program].auditor;
        let worse = |axis: &AxisAudit| axis.leaves_away() || axis.is_unknown();
        let pairs = auditor.axes(&self.before[program]);
        let mut pairs = pairs.iter().zip(auditor.axes(after));
        pairs.any(|(before, after)| worse(&after) && !worse(before))
    }

    /// Returns whether a program no longer takes part in the hazards.
    fn is_cured(&self, program: usize, runs: &ProgramRuns, mending: Mending) -> bool {
        let audit = &self.programs[program].auditor.axes(runs)[mending.at];
        match mending.cure {
            Cure::Inheritors => audit.inherits == Inherits::No,
            Cure::Leavers | Cure::None => {
                !audit.leaves_away() && audit.effect != ProgramEffect::Unknown
            }
        }
    }
}

crate::words! {
    /// The programs to mend: the side of each hazard with fewer programs (R10.3).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum Cure {
        /// No hazard, so no program to mend.
        None = "none",
        /// The programs that leave the axis away from its start-up state; mended by a command before the end.
        Leavers = "leavers",
        /// The programs that inherit that state; mended by a command before the first motion.
        Inheritors = "inheritors",
    }
}

/// A subject to mend in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Mending {
    /// The position of the axis and kind in [`ProgramAudit::axes`](super::ProgramAudit::axes).
    pub at: usize,
    /// Side of the hazards to mend: [`Cure::Leavers`] or [`Cure::Inheritors`].
    pub cure: Cure,
}

/// A block that is inserted into a program.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Insertion {
    /// The line before which it is inserted, from 1; one past the last line means the end.
    pub line: u32,
    /// The block to insert, without its line end.
    pub text: String,
}

/// Returns the places in a text at which blocks are inserted, and the text inserted there: each block on its own line,
/// with the text's line ends (R10.3). In text order.
pub fn insertions(text: &str, blocks: &[Insertion]) -> Vec<(Range<usize>, String)> {
    let lines = lines(text);
    let usual = lines.first().map_or("", |line| line_end(line.1));
    let usual = if usual.is_empty() { "\n" } else { usual };
    let is_open = lines.last().is_some_and(|last| line_end(last.1).is_empty());
    let mut sorted: Vec<&Insertion> = blocks.iter().collect();
    sorted.sort_by_key(|block| block.line);
    let insertion = |block: &Insertion| {
        let before = usize::try_from(block.line.saturating_sub(1)).unwrap_or(usize::MAX);
        let end = match lines.get(before).map(|line| line_end(line.1)) {
            Some(end) if !end.is_empty() => end,
            _ => usual,
        };
        match lines.get(before) {
            Some((from, _)) => (*from..*from, format!("{}{end}", block.text)),
            // The last line of the text gets a line end; the block has none.
            None if is_open => (text.len()..text.len(), format!("{end}{}", block.text)),
            None => (text.len()..text.len(), format!("{}{end}", block.text)),
        }
    };
    sorted.into_iter().map(insertion).collect()
}

/// Returns the text with the blocks inserted.
pub(super) fn with_blocks(text: &str, blocks: &[Insertion]) -> String {
    let mut result = String::with_capacity(text.len() + 40 * blocks.len());
    let mut copied = 0;
    for (range, inserted) in insertions(text, blocks) {
        result.push_str(&text[copied..range.start]);
        result.push_str(&inserted);
        copied = range.end;
    }
    result.push_str(&text[copied..]);
    result
}

/// Returns the offset of each line, and the line with its end.
fn lines(text: &str) -> Vec<(usize, &str)> {
    let mut lines = Vec::new();
    let mut from = 0;
    while from < text.len() {
        let rest = &text[from..];
        let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
        let ends = if rest[end..].starts_with("\r\n") {
            2
        } else {
            1
        };
        let length = rest.len().min(end + ends);
        lines.push((from, &rest[..length]));
        from += length;
    }
    lines
}

fn line_end(line: &str) -> &str {
    &line[line.trim_end_matches(['\r', '\n']).len()..]
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn block(line: u32, text: &str) -> Insertion {
        Insertion {
            line,
            text: text.to_owned(),
        }
    }

    #[test]
    fn nothing_but_the_blocks_is_added() {
        // R10.3
        for (before, blocks, after) in [
            ("a\nb\n", &[block(2, "X")][..], "a\nX\nb\n"),
            ("a\r\nb", &[block(2, "X")], "a\r\nX\r\nb"),
            ("a\rb\r", &[block(1, "X"), block(3, "Y")], "X\ra\rb\rY\r"),
            (
                "a\r\nb",
                &[block(3, "X"), block(3, "Y")],
                "a\r\nb\r\nX\r\nY",
            ),
            (
                "a\nb\n\n",
                &[block(3, "X"), block(2, "Y")],
                "a\nY\nb\nX\n\n",
            ),
            ("", &[block(1, "X")], "X\n"),
        ] {
            assert_eq!(with_blocks(before, blocks), after, "{before:?}");
        }
    }
}
