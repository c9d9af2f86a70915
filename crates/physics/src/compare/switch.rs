//! A change of one state by one block.

use std::fmt;

use frictcomp::comp::{Change, Kind, State};
use frictcomp::timeline::Row;

/// A change of one state by one block of a version.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Switch {
    /// Name of the axis.
    pub axis: String,
    /// The kind of compensation.
    pub kind: Kind,
    /// The state before the block.
    pub from: State,
    /// The state after it.
    pub to: State,
    /// The file that holds the block.
    pub file: String,
    /// Whether the file is one that the program calls.
    pub is_called: bool,
    /// The line on which the block starts, from 1.
    pub line: u32,
    /// The block number, if it is known.
    pub number: Option<i64>,
    /// The source lines of the block joined by `\n`.
    pub text: String,
}

/// Key by which a switch of one version is the same as one of the other: the line is not part of
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct SwitchIdentity<'a> {
    block: Result<i64, &'a str>,
    axis: &'a str,
    kind: Kind,
    from: State,
    to: State,
}

impl Switch {
    /// Returns a change by a block of a program in `main`.
    pub(super) fn new(row: &Row<'_>, change: Change, main: &str) -> Self {
        Self {
            axis: row.state.name(change.axis).to_owned(),
            kind: change.kind,
            from: change.from,
            to: change.to,
            file: row.file.to_owned(),
            is_called: row.file != main,
            line: row.line,
            number: row.number,
            text: row.text.to_owned(),
        }
    }

    /// Returns the identity of a block: its number, or its text if it has none.
    pub(super) fn identity(&self) -> SwitchIdentity<'_> {
        SwitchIdentity {
            block: self.number.ok_or(&self.text),
            axis: &self.axis,
            kind: self.kind,
            from: self.from,
            to: self.to,
        }
    }

    /// Returns the line of the block, with its file if the program calls that (R17.4).
    pub fn place(&self) -> String {
        if self.is_called {
            format!("{}:{}", self.file, self.line)
        } else {
            self.line.to_string()
        }
    }

    /// Returns the first line of the block.
    pub fn first_line(&self) -> &str {
        self.text.lines().next().unwrap_or_default().trim_end()
    }
}

impl fmt::Display for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { axis, kind, .. } = self;
        let (from, to) = (self.from.as_str(), self.to.as_str());
        write!(f, "{axis} {}: {from} → {to}", kind.as_str())
    }
}
