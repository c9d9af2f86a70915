//! Changed severities of frictcomp's own codes.

use std::collections::BTreeMap;

use super::codes::Code;
use super::message::Diagnostic;
use super::severity::Severity;

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
