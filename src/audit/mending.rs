//! The block that ends a hazard: where it has to stand, tried out before anybody sees it (R10.3).

use super::cure::{Cure, Mending};
use super::effect::{Inherits, ProgramEffect};
use super::insertion::{Insertion, with_blocks};
use super::numbering::Numbering;
use super::observation::Observation;
use super::program::{Auditor, AxisAudit, BothRuns};
use crate::interpreter::{EndedBy, Interpreter, Observer};

/// How a program is mended.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mended {
    /// The blocks, in no order.
    pub insertions: Vec<Insertion>,
    /// What no single block mends.
    pub missed: Vec<Mending>,
}

impl Auditor {
    /// Finds the blocks that mend a program. Each place is tried out: the program with the block must
    /// have lost its part in the hazard, and every motion of the axis must have kept its state when
    /// the program starts in its start-up state.
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
    before: BothRuns,
    accepted: Mended,
    run: R,
}

impl<R> Trial<'_, R> {
    fn mend<E>(&mut self, mending: Mending) -> Result<(), E>
    where
        R: FnMut(&str, &mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    {
        let audits = self.before.audit(self.auditor);
        let command = audits[mending.at].way_home();
        let mut second_best = None;
        for lines in self.candidates(mending) {
            let attempt = self.with_blocks(&lines, &command);
            let edited = with_blocks(self.text, &attempt);
            let run = &mut self.run;
            let after = self
                .auditor
                .observe(&mut |interpreter, listen| run(&edited, interpreter, listen))?;
            if !is_cured(&after.audit(self.auditor)[mending.at], mending.cure) {
                continue;
            }
            if self.is_harmless(&after, mending) {
                self.accepted.insertions = attempt;
                return Ok(());
            }
            second_best.get_or_insert(attempt);
        }
        match second_best {
            Some(attempt) => self.accepted.insertions = attempt,
            None => self.accepted.missed.push(mending),
        }
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
        let BothRuns { start_up, away } = &self.before;
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
        let section = after.clone().find(|(_, line)| line.starts_with('%'));
        let end = section.map_or(lines.len(), |(at, _)| at);
        let written = lines[..end]
            .iter()
            .rposition(|line| !line.trim().is_empty());
        let end = written.map_or(0, |written| written + 1);
        u32::try_from(end + 1).unwrap_or(u32::MAX)
    }

    /// Whether every motion of the axis keeps its state, as far as it does not inherit it.
    fn is_harmless(&self, after: &BothRuns, mending: Mending) -> bool {
        let same = |before: &Observation, after: &Observation| {
            let motions = |run: &Observation| run.observed[mending.at].motions;
            motions(before) == motions(after)
        };
        let at_start_up = same(&self.before.start_up, &after.start_up);
        match mending.cure {
            Cure::Inheritors => at_start_up,
            Cure::Leavers | Cure::None => at_start_up && same(&self.before.away, &after.away),
        }
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
