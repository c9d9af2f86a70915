//! Selection of the codes that count (R9.72), and changed severities of the own ones.

use std::collections::BTreeMap;

use super::codes::Code;
use super::message::{Diagnostic, Severity};

/// Selection of the codes that count, with their severity. Errors of the control always count.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct CodeFilter {
    /// Codes that are not reported.
    pub ignore: Vec<Code>,
    /// The only codes that are reported; all if empty.
    pub select: Vec<Code>,
    /// Severities that replace those of the codes. The last one counts.
    pub severity: Vec<(Code, Severity)>,
}

impl CodeFilter {
    /// Whether a code is reported.
    pub fn keeps(&self, code: Code) -> bool {
        let selected = self.select.is_empty() || self.select.contains(&code);
        code.is_controller() || (selected && !self.ignore.contains(&code))
    }

    /// Returns a code whose severity has no effect, because the code is not reported.
    pub fn without_effect(&self) -> Option<Code> {
        let codes = self.severity.iter().map(|(code, _)| *code);
        codes.into_iter().find(|code| !self.keeps(*code))
    }

    /// Changes the severities of a configuration.
    pub fn apply(&self, levels: &mut Levels) {
        for &code in Code::ALL {
            if !self.keeps(code) {
                levels.set(code, None);
            }
        }
        for &(code, severity) in &self.severity {
            levels.set(code, Some(severity));
        }
    }

    /// Applies the filter to messages about lists that were reported already.
    pub fn sift(&self, said: &mut Vec<Diagnostic>) {
        said.retain(|diagnostic| self.keeps(diagnostic.code));
        for diagnostic in said {
            let mut given = self.severity.iter().rev();
            if let Some((_, severity)) = given.find(|(code, _)| *code == diagnostic.code) {
                diagnostic.severity = *severity;
            }
        }
    }
}

/// Severities of the user's `[lint]` table for codes of frictcomp (R9.28).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Levels {
    levels: BTreeMap<Code, Option<Severity>>,
}

impl Levels {
    /// Gives a code another severity, or none, which silences it. The control's own errors keep theirs (R9.24). Returns
    /// whether the code may be changed.
    pub fn set(&mut self, code: Code, level: Option<Severity>) -> bool {
        let ours = !code.is_controller();
        if ours {
            self.levels.insert(code, level);
        }
        ours
    }

    /// Gives a diagnostic the severity that the user set for its code. A raised diagnostic keeps its own, a lowered one
    /// is not raised again, and all others stay as they are. Returns whether it is reported at all.
    pub(crate) fn weigh(&self, diagnostic: &mut Diagnostic) -> bool {
        if diagnostic.is_raised() {
            return true;
        }
        match self.levels.get(&diagnostic.code) {
            Some(None) => return false,
            Some(Some(severity)) if diagnostic.is_lowered() => {
                diagnostic.severity = diagnostic.severity.min(*severity);
            }
            Some(Some(severity)) => diagnostic.severity = *severity,
            None => {}
        }
        true
    }

    /// Returns the severity of a code; `None` if it is off.
    pub fn severity(&self, code: Code) -> Option<Severity> {
        self.levels
            .get(&code)
            .copied()
            .unwrap_or(Some(code.severity()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_left_out_and_weighed() {
        // R9.72
        let mut levels = Levels::default();
        let filter = CodeFilter {
            select: vec![Code::Fc401],
            severity: vec![(Code::Fc401, Severity::Error)],
            ..CodeFilter::default()
        };
        assert_eq!(filter.without_effect(), None);
        filter.apply(&mut levels);
        assert_eq!(levels.severity(Code::Fc401), Some(Severity::Error));
        assert_eq!(levels.severity(Code::Fc402), None);
        assert_eq!(levels.severity(Code::PErr70495), Some(Severity::Error));
        let filter = CodeFilter {
            ignore: vec![Code::Fc401],
            severity: vec![(Code::Fc401, Severity::Error)],
            ..CodeFilter::default()
        };
        assert_eq!(filter.without_effect(), Some(Code::Fc401));
    }
}
