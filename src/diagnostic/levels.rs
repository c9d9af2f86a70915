//! Other severities for codes of ours.

use std::collections::BTreeMap;

use super::codes::Code;
use super::message::Diagnostic;
use super::severity::Severity;

/// What the user's `[lint]` table says: other severities for codes of ours (R9.28).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Levels {
    levels: BTreeMap<Code, Option<Severity>>,
}

impl Levels {
    /// Gives a code another severity, or none, which silences it. The control's own errors keep
    /// theirs (R9.24); the return value says whether the code may be changed.
    pub fn set(&mut self, code: Code, level: Option<Severity>) -> bool {
        let ours = !code.is_controller();
        if ours {
            self.levels.insert(code, level);
        }
        ours
    }

    /// Gives a message the severity of its code, unless it is raised; whether it is said.
    pub fn weigh(&self, diagnostic: &mut Diagnostic) -> bool {
        if diagnostic.is_raised() {
            return true;
        }
        let severity = self.severity(diagnostic.code);
        diagnostic.severity = severity.unwrap_or(diagnostic.severity);
        severity.is_some()
    }

    /// The severity of a code, `None` when it is off.
    pub fn severity(&self, code: Code) -> Option<Severity> {
        self.levels
            .get(&code)
            .copied()
            .unwrap_or(Some(code.severity()))
    }
}
