//! The keys that `frictcomp.toml` may have, for completion.

use super::axis::{AXIS, VALUE};
use super::file::{CHECK, LINT, ROOT, VARIABLES};
use super::machine::{EXTERNAL_KEEPS, MACHINE, WORDS};
use super::readings::{CONFIRMATION, CONFIRMED, READING};
use super::section::Shape;

/// Every table, by its header; the file itself has none.
const TABLES: [(&str, &Shape); 12] = [
    ("", &ROOT),
    (AXIS.name, &AXIS),
    (VALUE.name, &VALUE),
    (MACHINE.name, &MACHINE),
    (EXTERNAL_KEEPS.name, &EXTERNAL_KEEPS),
    (WORDS.name, &WORDS),
    (VARIABLES.name, &VARIABLES),
    (LINT.name, &LINT),
    (CHECK.name, &CHECK),
    (READING.name, &READING),
    (CONFIRMED.name, &CONFIRMED),
    (CONFIRMATION.name, &CONFIRMATION),
];

/// Returns the keys of the table with a header such as `[[axis]]`; `None` if the user chooses them, or there is no such
/// table.
pub fn keys(header: &str) -> Option<&'static [&'static str]> {
    let table = TABLES.iter().find(|(name, _)| *name == header);
    table.and_then(|(_, shape)| shape.keys)
}
