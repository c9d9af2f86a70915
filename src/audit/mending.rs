//! The block that ends a hazard: its place, tried out before it is offered (R10.3).

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;

use super::effect::{Inherits, ProgramEffect};
use super::insertion::{Insertion, with_blocks};
use super::observation::Observation;
use super::places::places;
use super::program::{Auditor, AxisAudit};
use super::runs::ProgramRuns;
use crate::interpreter::{Interpreter, Observer};
use crate::text::Numbering;

/// Whether a block may change the state in which an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum CuredMotions {
    /// Every motion keeps its state (R10.8).
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
    /// No single block takes the program out of the hazards.
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
/// Those of `run`.
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
    /// Those with the accepted blocks, if there are any.
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

    /// Whether every motion keeps its state when started in the start-up state, and from another state changes at most
    /// to the start-up state.
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

    /// Whether a program now leaves, or may leave, an axis away from its start-up state.
    fn brings_a_hazard(&self, program: usize, after: &ProgramRuns) -> bool {
        let auditor = self.programs[program].auditor;
        let worse = |axis: &AxisAudit| axis.leaves_away() || axis.is_unknown();
        let pairs = auditor.axes(&self.before[program]);
        let mut pairs = pairs.iter().zip(auditor.axes(after));
        pairs.any(|(before, after)| worse(&after) && !worse(before))
    }

    /// Whether a program no longer takes part in the hazards.
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
        /// There is no hazard.
        None = "none",
        /// Those that leave the axis away from its start-up state; mended by a command before the
        /// end.
        Leavers = "leavers",
        /// Those that inherit it; mended by a command before the first motion.
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
