//! Reports of several axes of one recording.

use serde::Serialize;

use crate::wording::to_pretty;

#[derive(Serialize)]
struct AxesDocument<T> {
    schema: u32,
    axes: Vec<T>,
}

/// The texts of axes, one after the other.
pub fn of_axes(texts: impl Iterator<Item = String>) -> String {
    texts.collect::<Vec<_>>().join("\n")
}

/// The record of an axis, or a document with those of several.
pub(crate) fn json_of_axes<T: Serialize>(records: impl Iterator<Item = T>) -> String {
    let records: Vec<T> = records.collect();
    match &records[..] {
        [only] => to_pretty(only),
        _ => to_pretty(&AxesDocument {
            schema: 1,
            axes: records,
        }),
    }
}
