//! The block that ends a hazard: where it has to stand, tried out before anybody sees it (R10.3).

use super::cure::{Cure, Mending};
use super::effect::{Inherits, ProgramEffect};
use super::insertion::{Insertion, with_blocks};
use super::numbering::Numbering;
use super::observation::Observation;
use super::program::{Auditor, AxisAudit};
use super::runs::Runs;

use crate::interpreter::{EndedBy, Interpreter, Observer};

/// How a program is mended.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mended {
    /// The blocks, in no order.
    pub insertions: Vec<Insertion>,
    /// What is left to the user.
    pub missed: Vec<Missed>,
}

/// What no block mends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Missed {
    /// What was to be mended.
    pub mending: Mending,
    /// Why it is left to the user.
    pub why: WhyMissed,
}

/// Why something is left to the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum WhyMissed {
    /// No single block takes the program out of the hazards.
    NotCured,
    /// Blocks that do so change the state in which axes move (R10.8).
    ChangesMotion,
}

impl Auditor {
    /// Finds the blocks that mend a program. Each place is tried out: the program with the block must
    /// have lost its part in the hazard, and no motion of the program or of what it calls may have
    /// another state when the program starts in its start-up state; from another one, only the
    /// start-up state (R10.8).
    ///
    /// # Errors
    /// Those of `run`.
    pub fn mend<E>(
        &self,
        text: &str,
        wanted: &[Mending],
        mut run: impl FnMut(&str, &mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<Mended, E> {
        let mut trial = Trial {
            auditor: self,
            text,
            before: self.observe(&mut |interpreter, listen| run(text, interpreter, listen))?,
            accepted: Mended::default(),
            run,
        };
        for mending in wanted {
            trial.mend(*mending)?;
        }
        Ok(trial.accepted)
    }
}

/// A program on its way to be mended.
struct Trial<'a, R> {
    auditor: &'a Auditor,
    text: &'a str,
    before: Runs,
    accepted: Mended,
    run: R,
}

impl<R> Trial<'_, R> {
    fn mend<E>(&mut self, mending: Mending) -> Result<(), E>
    where
        R: FnMut(&str, &mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    {
        let audits = self.auditor.axes(&self.before);
        let command = audits[mending.at].way_home();
        let mut why = WhyMissed::NotCured;
        for lines in self.candidates(mending) {
            let attempt = self.with_blocks(&lines, &command);
            let edited = with_blocks(self.text, &attempt);
            let run = &mut self.run;
            let after = self
                .auditor
                .observe(&mut |interpreter, listen| run(&edited, interpreter, listen))?;
            if !is_cured(&self.auditor.axes(&after)[mending.at], mending.cure) {
                continue;
            }
            if self.is_harmless(&after) {
                self.accepted.insertions = attempt;
                return Ok(());
            }
            why = WhyMissed::ChangesMotion;
        }
        self.accepted.missed.push(Missed { mending, why });
        Ok(())
    }

    /// The blocks so far and one more before each of some lines.
    fn with_blocks(&self, lines: &[u32], command: &str) -> Vec<Insertion> {
        let mut blocks = self.accepted.insertions.clone();
        let mut numbering = Numbering::of(self.text);
        // What was given out before is taken.
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

    /// Where the block could stand, the best place first.
    fn candidates(&self, mending: Mending) -> Vec<Vec<u32>> {
        let Runs { start_up, away, .. } = &self.before;
        let mut places = match mending.cure {
            Cure::Inheritors => {
                let moved = [start_up, away].map(|run| {
                    let observed = &run.observed[mending.at];
                    let moved = observed.inherited.as_ref().or(observed.doubtful.as_ref());
                    moved.and_then(|moved| moved.main)
                });
                let firsts = [start_up.first_line, away.first_line];
                let places = moved.into_iter().chain(firsts).flatten();
                places.map(|line| vec![line]).collect()
            }
            Cure::Leavers | Cure::None => {
                let mut ends = [start_up, away].map(|run| self.end(run)).to_vec();
                ends.dedup();
                let back = start_up.last_lines.iter().map(|line| vec![*line]);
                std::iter::once(ends).chain(back).collect::<Vec<_>>()
            }
        };
        let mut seen = std::collections::BTreeSet::new();
        places.retain(|place: &Vec<u32>| seen.insert(place.clone()));
        places
    }

    /// The line before which a command would be the last of a run.
    fn end(&self, run: &Observation) -> u32 {
        if let Some(line) = run.end
            && run.by != Some(EndedBy::EndOfFile)
        {
            return line;
        }
        let numbering = Numbering::of(self.text);
        let lines = numbering.lines();
        let last = run.last_lines.first().copied().unwrap_or_default();
        let last = usize::try_from(last).unwrap_or_default();
        // Another program may follow in the same file.
        let after = lines.iter().enumerate().skip(last);
        let section = after
            .clone()
            .find(|(_, line)| line.trim_start().starts_with('%'));
        let end = section.map_or(lines.len(), |(at, _)| at);
        let written = lines[..end]
            .iter()
            .rposition(|line| !line.trim().is_empty());
        let end = written.map_or(0, |written| written + 1);
        u32::try_from(end + 1).unwrap_or(u32::MAX)
    }

    /// Whether every motion keeps its state from the start-up state, and from another state becomes at
    /// most that of the start-up.
    fn is_harmless(&self, after: &Runs) -> bool {
        let scope = self.auditor.scope();
        let is_kept = |at: usize| {
            let motions = |run: &Observation| run.observed[at].motions.clone();
            let start_up = scope.selected_at_start(scope.subjects()[at], false);
            let (from_start_up, from_away) = (&self.before.start_up, &self.before.away);
            motions(from_start_up) == motions(&after.start_up)
                && motions(from_away).only_become(&motions(&after.away), start_up)
        };
        (0..scope.subjects().len()).all(is_kept)
    }
}

/// Whether a program has lost its part in the hazards.
fn is_cured(audit: &AxisAudit, cure: Cure) -> bool {
    match cure {
        Cure::Inheritors => audit.inherits == Inherits::No,
        Cure::Leavers | Cure::None => {
            !audit.leaves_away() && audit.effect != ProgramEffect::Unknown
        }
    }
}
