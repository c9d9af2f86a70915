//! Names with their places, as listed by `check --unknowns` and `check --opaque`.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::console::DataTarget;
use super::failure::Failure;
use super::listing::records;
use frictcomp::session::NoteKind;
use frictcomp::text::{Position, shown_json};
use frictcomp_report::{ListingFormat, leading};

/// A name and its place.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct NotedName {
    pub(super) name: String,
    pub(super) file: String,
    pub(super) start: Position,
}

impl NotedName {
    /// Returns `V.E.PART mill.nc:12:5`.
    fn text(&self) -> String {
        let line = format!("{} {}:{}", self.name, self.file, self.start);
        leading(&line).into_owned() + "\n"
    }

    fn record(&self, kind: NoteKind) -> Value {
        json!({
            "record": match kind {
                NoteKind::Unknown => "unknown",
                NoteKind::Opaque => "opaque",
            },
            "name": self.name,
            "file": self.file,
            "line": self.start.line,
            "column": self.start.column,
        })
    }
}

/// Writes the notes that `take` collects, in the order of their names.
pub(super) fn list(
    kind: NoteKind,
    format: ListingFormat,
    mut target: DataTarget,
    take: impl FnOnce(&mut BTreeSet<NotedName>),
) -> Result<(), Failure> {
    let mut notes = BTreeSet::new();
    take(&mut notes);
    let text: String = notes.iter().map(NotedName::text).collect();
    let values: Vec<Value> = notes.iter().map(|note| note.record(kind)).collect();
    target.text(&shown_json(&records(format, &text, &values)))?;
    Ok(())
}
