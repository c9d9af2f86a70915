//! The severities of codes for one call (R9.72), and the one from which a command fails.

use std::collections::{BTreeMap, BTreeSet};

use clap::{Args, ValueEnum};

use crate::output::{Console, Failure};
use frictcomp::comp::Kind;
use frictcomp::diagnostic::{Code, CodeFilter, Severity, did_you_mean};

/// A word of `--fail-on`; a list of them gives exit status 1 for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FailOnWord {
    /// Nothing
    Never,
    /// Any message
    Info,
    /// A warning or an error
    Warning,
    /// An error of the control or of a list
    Error,
    /// A state that is not known at a program's end or where its axis moves, besides the severity
    /// that is named or the default
    Unknown,
}

/// The option `--fail-on`. A command with another default than `warning` changes the argument.
#[derive(Debug, Clone, Args)]
pub(crate) struct FailOnArgs {
    /// What gives exit status 1; a list such as `error,unknown`
    #[arg(
        long,
        value_name = "SEVERITY",
        value_delimiter = ',',
        default_value = "warning"
    )]
    fail_on: Vec<FailOnWord>,
}

impl FailOnArgs {
    /// Returns what gives exit status 1; `unknown` alone adds to the default of the command.
    pub(crate) fn or(&self, default: Severity) -> FailOn {
        FailOn::new(&self.fail_on, default)
    }

    /// Returns what gives exit status 1 in a command that judges.
    pub(crate) fn judging(&self) -> FailOn {
        self.or(Severity::Warning)
    }
}

impl FailOnWord {
    fn severity(self) -> Option<Severity> {
        match self {
            Self::Info => Some(Severity::Info),
            Self::Warning => Some(Severity::Warning),
            Self::Error => Some(Severity::Error),
            Self::Never | Self::Unknown => None,
        }
    }
}

/// Messages that give exit status 1 (R18.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FailOn {
    least: Option<Severity>,
    unknown: bool,
}

impl FailOn {
    /// Creates the condition that the words of a command describe; `unknown` alone adds to the command's default.
    fn new(words: &[FailOnWord], default: Severity) -> Self {
        let names_severity = words.iter().any(|word| *word != FailOnWord::Unknown);
        let named = words.iter().filter_map(|word| word.severity()).min();
        Self {
            least: if names_severity { named } else { Some(default) },
            unknown: words.contains(&FailOnWord::Unknown),
        }
    }

    /// Returns whether this severity gives the status 1.
    pub(crate) fn counts(self, severity: Severity) -> bool {
        self.least.is_some_and(|least| severity >= least)
    }

    /// Returns the exit status for unknown states, given by their names (R2.98).
    pub(crate) fn unknown_status(self, unknown: &BTreeSet<String>) -> u8 {
        if self.unknown && !unknown.is_empty() {
            crate::output::FOUND
        } else {
            crate::output::CLEAN
        }
    }

    /// Returns the remark on unknown states, where they give the status 1.
    pub(crate) fn unknown_remark(self, unknown: &BTreeSet<String>) -> Option<String> {
        let named: Vec<&str> = unknown.iter().map(String::as_str).collect();
        let named = named.join(", ");
        (self.unknown_status(unknown) != crate::output::CLEAN)
            .then(|| format!("not known at the end of a program or where the axis moves: {named}"))
    }

    /// Returns the exit status for unknown states, which are reported where they count.
    pub(crate) fn judge<'a>(
        self,
        unknown: impl Iterator<Item = (&'a str, Kind)>,
        console: Console,
    ) -> u8 {
        let unknown = unknown.map(|(axis, kind)| of_axis(axis, kind)).collect();
        if let Some(remark) = self.unknown_remark(&unknown) {
            console.remark(&remark);
        }
        self.unknown_status(&unknown)
    }

    /// Returns the exit status for the number of diagnostics at each severity (R9.26).
    pub(crate) fn status(self, counts: &BTreeMap<Severity, u64>) -> u8 {
        let mut said = counts.iter().filter(|(_, count)| **count > 0);
        if said.any(|(severity, _)| self.counts(*severity)) {
            crate::output::FOUND
        } else {
            crate::output::CLEAN
        }
    }
}

/// Returns the name of a kind of an axis whose state is unknown.
pub(crate) fn of_axis(axis: &str, kind: Kind) -> String {
    format!("`{kind}` of `{axis}`")
}

/// The codes to report, for this call; those of the control itself always are.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Messages")]
pub(crate) struct SeverityArgs {
    /// Do not report these codes
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = parse_ours)]
    ignore: Vec<Code>,
    /// Report only these codes, and those of the control
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = parse_code)]
    #[arg(conflicts_with = "ignore")]
    select: Vec<Code>,
    /// Change the severity of a code: `info`, `warning`, `error`
    #[arg(long, value_name = "CODE=LEVEL", value_delimiter = ',', value_parser = parse_severity)]
    severity: Vec<(Code, Severity)>,
}

impl SeverityArgs {
    /// Returns the codes to report.
    pub(crate) fn filter(&self) -> Result<CodeFilter, Failure> {
        let mut filter = CodeFilter::default();
        filter.ignore.clone_from(&self.ignore);
        filter.select.clone_from(&self.select);
        filter.severity.clone_from(&self.severity);
        match filter.without_effect() {
            Some(code) => Err(Failure::new(format!(
                "`--severity {code}` has no effect: the code is not reported"
            ))
            .with_help("remove it from `--ignore`, or add it to `--select`")),
            None => Ok(filter),
        }
    }
}

fn parse_code(text: &str) -> Result<Code, String> {
    let text = text.trim();
    text.parse().map_err(|_| {
        let known = Code::ALL.iter().map(|code| code.as_str());
        match did_you_mean(text, known) {
            Some(near) => format!("there is no code `{text}`; did you mean `{near}`?"),
            None => format!("there is no code `{text}`; `frictcomp explain` lists them"),
        }
    })
}

/// Parses a code that may be changed (R9.24).
fn parse_ours(text: &str) -> Result<Code, String> {
    let code = parse_code(text)?;
    if code.is_controller() {
        return Err(format!(
            "{code} is an error of the control; it is always reported"
        ));
    }
    Ok(code)
}

fn parse_severity(text: &str) -> Result<(Code, Severity), String> {
    let Some((code, level)) = text.split_once('=') else {
        return Err("write it as CODE=LEVEL, such as FC402=warning".to_owned());
    };
    let code = parse_ours(code)?;
    match level.trim() {
        "info" => Ok((code, Severity::Info)),
        "warning" => Ok((code, Severity::Warning)),
        "error" => Ok((code, Severity::Error)),
        "off" => Err(format!("write `--ignore {code}` to leave it out")),
        other => Err(format!(
            "`{other}` is not a severity; write `info`, `warning` or `error`"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_follows_the_severity_that_counts() {
        // R9.26, R18.1
        use FailOnWord::{Error, Info, Never, Unknown, Warning};
        let judging = |words: &[FailOnWord]| FailOn::new(words, Severity::Warning);
        let mut counts = BTreeMap::new();
        assert_eq!(judging(&[Info]).status(&counts), 0);
        counts.insert(Severity::Warning, 1);
        assert_eq!(judging(&[]).status(&counts), 1);
        assert_eq!(FailOn::new(&[], Severity::Error).status(&counts), 0);
        assert_eq!(judging(&[Error]).status(&counts), 0);
        assert_eq!(judging(&[Warning]).status(&counts), 1);
        assert_eq!(judging(&[Error, Info]).status(&counts), 1);
        counts.insert(Severity::Error, 1);
        assert_eq!(judging(&[Error]).status(&counts), 1);
        assert_eq!(judging(&[Never]).status(&counts), 0);
        // R2.98
        let unknown = BTreeSet::from(["FRICT of X".to_owned()]);
        assert_eq!(judging(&[Unknown]).status(&counts), 1);
        assert_eq!(judging(&[Never, Unknown]).status(&counts), 0);
        assert_eq!(judging(&[Never, Unknown]).unknown_status(&unknown), 1);
        assert_eq!(judging(&[Error]).unknown_status(&unknown), 0);
        assert_eq!(judging(&[Unknown]).unknown_status(&BTreeSet::new()), 0);
    }

    #[test]
    fn codes_are_given_as_they_are_printed() {
        assert_eq!(parse_code("fc402"), Ok(Code::Fc402));
        assert!(parse_code("FC4O2").unwrap_err().contains("`FC402`"));
        assert!(
            parse_ours("P-ERR-70495")
                .unwrap_err()
                .contains("always reported")
        );
        assert_eq!(
            parse_severity("FC402=error"),
            Ok((Code::Fc402, Severity::Error))
        );
        for wrong in ["FC402", "FC402=off", "FC402=fatal", "P-ERR-70495=info"] {
            assert!(parse_severity(wrong).is_err(), "{wrong}");
        }
    }
}
