//! The totals of the messages of a list.

use std::collections::{BTreeMap, BTreeSet};

use frictcomp::comp::State;
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::timeline::ReadingsInForce;

use crate::document::{Headline, Standing};
use crate::wording::{counted, listed};

/// Result of one program, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ProgramResult {
    /// Program with an error: the control stops.
    Failed,
    /// Program that leaves friction compensation of an axis off.
    LeavesOff,
    /// Program that leaves an axis otherwise away from its start-up state.
    LeavesAway,
    /// Program that may leave an axis away from its start-up state.
    MayLeaveAway,
    /// Program whose effect depends on values known only to the machine.
    Depends,
    /// Program with another warning.
    Warned,
    /// Program without a warning.
    Clean,
}

impl ProgramResult {
    /// Returns the result that a message alone gives of a program that leaves these axes away from their start-up states,
    /// each with its friction compensation.
    pub fn of(said: &Diagnostic, left: &BTreeMap<String, State>) -> Self {
        let left = said.axis.as_ref().and_then(|axis| left.get(axis));
        match (said.severity, said.code) {
            (Severity::Error, _) => Self::Failed,
            (Severity::Info, _) => Self::Clean,
            (Severity::Warning, Code::Fc401 | Code::Fc407) => match left {
                Some(State::Inactive) => Self::LeavesOff,
                Some(_) => Self::LeavesAway,
                None => Self::MayLeaveAway,
            },
            (Severity::Warning, Code::Fc325 | Code::Fc901 | Code::Fc902 | Code::Fc903) => {
                Self::Depends
            }
            (Severity::Warning, _) => Self::Warned,
        }
    }

    /// Returns whether it is that of an axis.
    pub fn is_of_axis(self) -> bool {
        matches!(
            self,
            Self::LeavesOff | Self::LeavesAway | Self::MayLeaveAway
        )
    }

    /// Returns the result in words, after one program and after several, about some axes.
    fn words(self, axes: &str) -> [String; 2] {
        let [one, several] = match self {
            Self::Failed => ["has errors", "have errors"],
            Self::LeavesOff => ["leaves AXES off", "leave AXES off"],
            Self::LeavesAway => [
                "leaves AXES away from the start-up state",
                "leave AXES away from the start-up state",
            ],
            Self::MayLeaveAway => ["may leave AXES away from the start-up state"; 2],
            Self::Depends => ["depends on the machine", "depend on the machine"],
            Self::Warned => ["has warnings", "have warnings"],
            Self::Clean => ["is clean", "are clean"],
        };
        [one, several].map(|words| words.replace("AXES", axes))
    }

    fn standing(self) -> Standing {
        match self {
            Self::Failed | Self::LeavesOff | Self::LeavesAway | Self::Warned => Standing::Bad,
            Self::MayLeaveAway | Self::Depends => Standing::Open,
            Self::Clean => Standing::Good,
        }
    }
}

/// Number of files examined, and of diagnostics of each severity.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Tally {
    /// Examined files.
    pub files: u64,
    /// Lists that a file names and that do not exist.
    pub missing: u64,
    /// Programs by their results.
    pub programs: BTreeMap<ProgramResult, u64>,
    /// The axes that are or may be left away from their start-up states, by the results that this gives.
    pub axes: BTreeMap<ProgramResult, BTreeSet<String>>,
    /// Diagnostics by severity.
    pub counts: BTreeMap<Severity, u64>,
    /// The readings of open questions on which the results rest (R15.3).
    pub rests_on: ReadingsInForce,
}

impl Tally {
    /// Counts a diagnostic.
    pub fn count(&mut self, severity: Severity) {
        *self.counts.entry(severity).or_default() += 1;
    }

    /// Returns the number of diagnostics of a severity.
    pub fn of(&self, severity: Severity) -> u64 {
        self.counts.get(&severity).copied().unwrap_or_default()
    }

    /// Returns the verdict on the programs; a single one has the `name`.
    pub fn on_programs(&self, name: &str) -> Headline {
        let all: u64 = self.programs.values().sum();
        let worst = self.programs.keys().next();
        let standing = worst.map_or(Standing::Open, |it| it.standing());
        let phrase = |(result, count): (&ProgramResult, &u64)| {
            let [one, several] = result.words("an axis");
            format!("{count} {}", if *count == 1 { one } else { several })
        };
        let text = match (worst, all) {
            (None, _) => "no program was checked".to_owned(),
            (Some(ProgramResult::Failed), 1) => format!("{name} has errors"),
            (Some(result), 1) if self.axes.is_empty() => {
                format!("{name} {}", result.words("an axis")[0])
            }
            (Some(_), 1) => {
                let left = self.axes.iter().map(|(result, axes)| {
                    let axes: Vec<&str> = axes.iter().map(String::as_str).collect();
                    let [one, _] = result.words(&listed(&axes).unwrap_or_default());
                    one
                });
                let left: Vec<String> = left.collect();
                format!("{name} {}", left.join(" and "))
            }
            (Some(result), _) if self.programs.len() == 1 => {
                format!("{all} programs {}", result.words("an axis")[1])
            }
            _ => {
                let parts: Vec<String> = self.programs.iter().map(phrase).collect();
                format!("{all} programs: {}", parts.join(", "))
            }
        };
        Headline::new(standing, text)
    }

    /// Returns the verdict on lists.
    pub fn on_lists(&self) -> Headline {
        let of = |severity, noun| {
            let count = self.of(severity);
            (count > 0).then(|| counted(count, noun))
        };
        let faults = [
            of(Severity::Error, "error"),
            of(Severity::Warning, "warning"),
        ];
        let faults: Vec<String> = faults.into_iter().flatten().collect();
        let standing = match (faults.len(), self.missing) {
            (0, 0) => Standing::Good,
            (0, _) => Standing::Open,
            _ => Standing::Bad,
        };
        let faults = if faults.is_empty() {
            "no fault".to_owned()
        } else {
            faults.join(" and ")
        };
        let missing = match self.missing {
            0 => String::new(),
            1 => ", 1 list is missing".to_owned(),
            several => format!(", {several} lists are missing"),
        };
        Headline::new(
            standing,
            format!("{faults} in {}{missing}", counted(self.files, "file")),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_verdict_counts_programs_by_their_worst_message() {
        // R18.20
        let mut tally = Tally::default();
        let said = |tally: &Tally| tally.on_programs("a.nc").text;
        tally.programs.insert(ProgramResult::Clean, 1);
        assert_eq!(said(&tally), "a.nc is clean");
        tally.programs.insert(ProgramResult::Clean, 296);
        assert_eq!(said(&tally), "296 programs are clean");
        tally.programs.insert(ProgramResult::LeavesOff, 3);
        tally.programs.insert(ProgramResult::Depends, 1);
        assert_eq!(
            said(&tally),
            "300 programs: 3 leave an axis off, 1 depends on the machine, 296 are clean"
        );
        assert_eq!(tally.on_programs("").standing, Standing::Bad);
    }
}
