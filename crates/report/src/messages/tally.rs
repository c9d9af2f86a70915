//! The totals of the messages of a list.

use std::collections::BTreeMap;

use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::timeline::ReadingsInForce;

use crate::document::{Headline, Standing};
use crate::wording::counted;

/// Result of one program, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ProgramResult {
    /// It has an error: the control stops.
    Failed,
    /// It leaves an axis away from its start-up state.
    LeavesOff,
    /// What it does depends on what only the machine knows.
    Depends,
    /// It has another warning.
    Warned,
    /// It has no warning.
    Clean,
}

impl ProgramResult {
    /// Returns the result that a message alone gives.
    pub fn of(said: &Diagnostic) -> Self {
        match (said.severity, said.code) {
            (Severity::Error, _) => Self::Failed,
            (Severity::Info, _) => Self::Clean,
            (Severity::Warning, Code::Fc401 | Code::Fc407) => Self::LeavesOff,
            (Severity::Warning, Code::Fc325 | Code::Fc901 | Code::Fc902 | Code::Fc903) => {
                Self::Depends
            }
            (Severity::Warning, _) => Self::Warned,
        }
    }

    /// Returns the result in words, after one program and after several.
    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Failed => ["has errors", "have errors"],
            Self::LeavesOff => ["leaves an axis off", "leave an axis off"],
            Self::Depends => ["depends on the machine", "depend on the machine"],
            Self::Warned => ["has warnings", "have warnings"],
            Self::Clean => ["is clean", "are clean"],
        }
    }

    fn standing(self) -> Standing {
        match self {
            Self::Failed | Self::LeavesOff | Self::Warned => Standing::Bad,
            Self::Depends => Standing::Open,
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
            let [one, several] = result.words();
            format!("{count} {}", if *count == 1 { one } else { several })
        };
        let text = match (worst, all) {
            (None, _) => "no program".to_owned(),
            (Some(result), 1) => format!("{name} {}", result.words()[0]),
            (Some(result), _) if self.programs.len() == 1 => {
                format!("{all} programs {}", result.words()[1])
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
