//! Results as a notebook shows them.

use std::fmt::Write as _;
use std::hash::{BuildHasher, RandomState};

use pyo3::prelude::*;
use serde_json::Value;

use crate::arrow::ArrowTable;

/// The maximum number of rows of a table that are shown.
const MOST_ROWS: usize = 60;

/// Returns a sentence and pictures as HTML.
pub(crate) fn pictured(
    py: Python<'_>,
    words: &str,
    pictures: &[impl AsRef<str>],
) -> PyResult<String> {
    let mut html = format!("<p>{}</p>", escaped(py, words)?);
    for picture in pictures {
        html.push_str(&with_own_ids(picture.as_ref()));
    }
    Ok(html)
}

/// Returns a sentence and the named columns of a table as HTML.
pub(crate) fn tabular(
    py: Python<'_>,
    words: &str,
    (table, columns): (&ArrowTable, &[&str]),
) -> PyResult<String> {
    let mut html = format!("<p>{}</p><table><tr>", escaped(py, words)?);
    for column in columns {
        let _ = write!(html, "<th>{}</th>", column.replace('_', " "));
    }
    html.push_str("</tr>");
    for row in table.texts(columns).take(MOST_ROWS) {
        html.push_str("<tr>");
        for text in row {
            let _ = write!(html, "<td>{}</td>", escaped(py, &text)?);
        }
        html.push_str("</tr>");
    }
    html.push_str("</table>");
    if let more @ 1.. = table.rows().saturating_sub(MOST_ROWS) {
        let _ = write!(html, "<p>{more} more rows</p>");
    }
    Ok(html)
}

/// Returns the verdict of a document, or of the last one among records.
pub(crate) fn verdict(record: &str) -> String {
    let document: Value = serde_json::from_str(record).unwrap_or_default();
    let headed = match &document {
        Value::Array(records) => records.last(),
        one => Some(one),
    };
    let words = headed.and_then(|it| it["headline"]["text"].as_str());
    words.unwrap_or_default().to_owned()
}

fn escaped(py: Python<'_>, text: &str) -> PyResult<String> {
    py.import("html")?
        .call_method1("escape", (text,))?
        .extract()
}

/// Returns a picture with identifiers of its own: a notebook holds several, also those of earlier processes.
fn with_own_ids(picture: &str) -> String {
    let own = format!("fc-{:016x}", RandomState::new().hash_one(picture));
    // The identifiers of the picture itself, and of the one inside the picture of a contour.
    let names = ["picture-title", "picture-desc", "below-title", "below-desc"];
    names.iter().fold(picture.to_owned(), |picture, name| {
        picture.replace(&format!("\"{name}\""), &format!("\"{own}-{name}\""))
    })
}
