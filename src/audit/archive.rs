//! The programs of one machine together: which leave an axis away from its start-up state, and which inherit it.

use std::collections::BTreeMap;

use super::mending::{Cure, Mending};
use super::program::{AxisAudit, ProgramAudit};
use crate::comp::Kind;
use crate::interpreter::FoundVariables;
use crate::readings::{Question, QuestionSet};

/// The programs of one machine.
#[derive(Debug, Clone, Default)]
pub struct Archive {
    programs: Vec<ProgramAudit>,
}

/// The side of a hazard on which it is mended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MendedEnd {
    /// The programs that leave an axis away from its start-up state.
    Leavers,
    /// The programs that inherit it.
    Inheritors,
    /// For each axis whichever are fewer.
    Smaller,
}

/// Effect of all programs on one kind of compensation of one axis. Programs are named by their
/// position in [`Archive::programs`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct AxisFinding {
    /// Name of the axis.
    pub axis: String,
    /// Kind of compensation.
    pub kind: Kind,
    /// Whether it is selected at the start of the control.
    pub on_at_start_up: bool,
    /// The position of the axis and kind in [`ProgramAudit::axes`].
    pub at: usize,
    /// The programs that leave it away from its start-up state.
    pub leavers: Vec<usize>,
    /// The programs that move the axis in the state that they find.
    pub inheritors: Vec<usize>,
    /// The programs that may move it in the state that they find.
    pub possible_inheritors: Vec<usize>,
    /// The programs in both lists: the second run of each differs from its first (R1.53).
    pub both: Vec<usize>,
    /// The programs whose effect is not known offline: any of them may leave it away from its start-up state.
    pub unknown: Vec<usize>,
}

impl AxisFinding {
    /// Returns the number of ordered pairs of a program that leaves the axis away from its start-up state and one that
    /// inherits it (R10.2).
    pub fn hazards(&self) -> u64 {
        let count = |list: &[usize]| u64::try_from(list.len()).unwrap_or(u64::MAX);
        count(&self.leavers).saturating_mul(count(&self.inheritors))
    }

    /// Returns the number of ordered pairs of a program that leaves the axis away from the start-up state and one that
    /// may move it in that state (R10.7).
    pub fn possible_hazards(&self) -> u64 {
        let count = |list: &[usize]| u64::try_from(list.len()).unwrap_or(u64::MAX);
        count(&self.leavers).saturating_mul(count(&self.possible_inheritors))
    }

    /// Returns the programs that move, or may move, the axis in the state that they find, in their order.
    pub fn movers(&self) -> Vec<usize> {
        let both = self.inheritors.iter().chain(&self.possible_inheritors);
        let mut movers: Vec<usize> = both.copied().collect();
        movers.sort_unstable();
        movers
    }

    /// Returns the side with fewer programs.
    pub fn cure(&self) -> Cure {
        match (self.leavers.len(), self.movers().len()) {
            (0, _) | (_, 0) => Cure::None,
            (leavers, inheritors) if leavers <= inheritors => Cure::Leavers,
            _ => Cure::Inheritors,
        }
    }

    /// Whether programs leave, or may leave, it away from its start-up state and others inherit that.
    pub fn is_worth_a_warning(&self) -> bool {
        let movers = self.movers();
        !(movers.is_empty() || self.leavers.is_empty() && self.unknown.is_empty())
    }
}

impl Archive {
    /// Leaves out the axes that nothing describes and no program switches: there is nothing to leave or inherit.
    #[must_use]
    pub fn without_unswitched(mut self) -> Self {
        let first = self.programs.first().map_or(&[][..], |first| &first.axes);
        let counts = |at: usize| {
            let mut programs = self.programs.iter().map(|program| &program.axes[at]);
            programs.any(|axis| axis.is_described || axis.is_commanded)
        };
        let counting: Vec<bool> = (0..first.len()).map(counts).collect();
        for program in &mut self.programs {
            let mut counting = counting.iter().copied();
            program.axes.retain(|_| counting.next().unwrap_or(true));
        }
        self
    }

    /// Adds a program.
    pub fn push(&mut self, program: ProgramAudit) {
        self.programs.push(program);
    }

    /// Returns the values that each program finds in variables that outlive programs, after any other (R2.34).
    pub fn found(&self) -> FoundVariables {
        let mut found = FoundVariables::default();
        for program in &self.programs {
            found.add(&program.used.written);
        }
        found
    }

    /// Returns the positions of the programs that found other values in the variables they read than
    /// [`found`](Self::found) gives: these must run again.
    pub fn unsettled(&self) -> Vec<usize> {
        let found = self.found();
        let is_unsettled = |(_, program): &(usize, &ProgramAudit)| {
            program.found.wanted_by(&program.used) != found.wanted_by(&program.used)
        };
        let programs = self.programs.iter().enumerate();
        let unsettled = programs.filter(is_unsettled);
        unsettled.map(|(position, _)| position).collect()
    }

    /// Takes the audit of a program that has run again. Its earlier effects count as well, so that the repetition
    /// terminates.
    pub fn settle(&mut self, position: usize, mut program: ProgramAudit) {
        let before = &mut self.programs[position];
        program.used.add(&before.used);
        *before = program;
    }

    /// Returns the programs in the order in which they were added.
    pub fn programs(&self) -> &[ProgramAudit] {
        &self.programs
    }

    /// Returns the open questions whose readings decide how the programs affect each other (R15.3): the state that a
    /// program leaves reaches the next one unless a reset between them takes it back (R1.28).
    pub fn rests_on(&self) -> QuestionSet {
        let questions = self.programs.iter().map(|program| program.rests_on);
        let mut questions = questions.fold(QuestionSet::default(), QuestionSet::union);
        let mut axes = self.programs.iter().flat_map(|program| &program.axes);
        if axes.any(AxisAudit::leaves_away) {
            questions.insert(Question::Reset);
        }
        questions
    }

    /// Returns the effect of all programs together, for each axis and kind in the machine's order.
    pub fn findings(&self) -> Vec<AxisFinding> {
        let first = self.programs.first().map_or(&[][..], |first| &first.axes);
        first
            .iter()
            .enumerate()
            .map(|(at, axis)| self.finding(at, axis))
            .collect()
    }

    fn finding(&self, at: usize, axis: &AxisAudit) -> AxisFinding {
        let those = |are: fn(&AxisAudit) -> bool| {
            let programs = self.programs.iter().enumerate();
            let those = programs.filter(|(_, program)| are(&program.axes[at]));
            those.map(|(position, _)| position).collect()
        };
        AxisFinding {
            axis: axis.axis.clone(),
            kind: axis.kind,
            on_at_start_up: axis.on_at_start_up,
            at,
            leavers: those(AxisAudit::leaves_away),
            inheritors: those(AxisAudit::is_inheritor),
            possible_inheritors: those(AxisAudit::may_inherit),
            both: those(|axis| axis.leaves_away() && axis.is_inheritor()),
            unknown: those(AxisAudit::is_unknown),
        }
    }

    /// Returns the mendings of each program, by its position, that leave no hazard. A program that may leave an axis
    /// away from its start-up state, depending on a value of the machine, counts as a leaver; one stopped by an error
    /// or a budget has to be mended by hand first.
    pub fn to_mend(&self, end: MendedEnd) -> BTreeMap<usize, Vec<Mending>> {
        let mut wanted: BTreeMap<usize, Vec<Mending>> = BTreeMap::new();
        for finding in self.findings() {
            let first = self.programs.first().and_then(|it| it.axes.get(finding.at));
            let is_described = first.is_some_and(|axis| axis.is_described);
            if !finding.is_worth_a_warning() || !is_described {
                continue;
            }
            let cure = match end {
                MendedEnd::Inheritors => Cure::Inheritors,
                MendedEnd::Smaller if finding.cure() == Cure::Inheritors => Cure::Inheritors,
                MendedEnd::Leavers | MendedEnd::Smaller => Cure::Leavers,
            };
            let programs: Vec<usize> = if cure == Cure::Inheritors {
                finding.movers()
            } else {
                let unknown = finding.unknown.iter().filter(|&&program| {
                    self.programs[program].axes[finding.at].depends_on_the_machine()
                });
                finding.leavers.iter().chain(unknown).copied().collect()
            };
            let at = finding.at;
            for program in programs {
                let mendings = wanted.entry(program).or_default();
                mendings.push(Mending { at, cure });
            }
        }
        wanted
    }
}
