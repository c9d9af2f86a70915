//! The places of the figures of a contour: their lines and blocks (R11.24).

use serde_json::{Value, json};

use crate::wording::visible_line;
use frictcomp_physics::contour::ContourReversal;
use frictcomp_physics::motion::Cause;

/// A block of a program.
pub(crate) struct ProgramBlock<'a> {
    file: &'a str,
    line: u32,
    number: Option<i64>,
}

impl<'a> From<&'a Cause> for ProgramBlock<'a> {
    fn from(cause: &'a Cause) -> Self {
        Self {
            file: &cause.file,
            line: cause.line,
            number: cause.number,
        }
    }
}

impl<'a> From<&'a ContourReversal> for ProgramBlock<'a> {
    fn from(reversal: &'a ContourReversal) -> Self {
        Self {
            file: &reversal.file,
            line: reversal.line,
            number: reversal.number,
        }
    }
}

impl ProgramBlock<'_> {
    /// Returns text such as "part.nc:165 N1640".
    pub(crate) fn words(&self) -> String {
        let number = self.number.map_or(String::new(), |n| format!(" N{n}"));
        format!("{}:{}{number}", visible_line(self.file), self.line)
    }

    /// Returns text such as "N1640", with its file if that is not the main program.
    pub(crate) fn beside(&self, program: &str) -> String {
        let number = self.number.map(|n| format!("N{n}"));
        let file = (self.file != program).then(|| visible_line(self.file).into_owned());
        let parts: Vec<String> = [file, number].into_iter().flatten().collect();
        parts.join(" ")
    }

    pub(crate) fn record(&self) -> Value {
        json!({ "file": self.file, "line": self.line, "n": self.number })
    }
}

/// Returns the record of a block; `null` if there is none.
pub(crate) fn record<'a>(at: Option<impl Into<ProgramBlock<'a>>>) -> Value {
    at.map_or(Value::Null, |at| at.into().record())
}
