//! SARIF 2.1.0, the exchange format of static analysis.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde_json::{Value, json};

use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::text::Place;

use crate::wording::to_json;

use super::message_format::MessageFormat;
use super::tally::Tally;

/// Text before the results. The keys of SARIF may come in any order, so the results are written one by
/// one, followed by their summary.
const BEFORE: &str = r#"{
  "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
  "runs": [
    {
      "columnKind": "unicodeCodePoints",
      "results": ["#;

/// Columns of a result.
const RESULT: usize = 8;

/// Columns of the keys of a run.
const RUN: usize = 6;

/// The rules that the results of a run have named so far.
#[derive(Debug, Default)]
pub(super) struct Sarif {
    used: BTreeSet<Code>,
    results: u64,
}

impl MessageFormat for Sarif {
    fn open(&mut self, out: &mut Vec<u8>) {
        out.extend_from_slice(BEFORE.as_bytes());
    }

    fn message(&mut self, out: &mut Vec<u8>, diagnostic: &Diagnostic) {
        self.used.insert(diagnostic.code);
        out.extend_from_slice(if self.results == 0 { b"\n" } else { b",\n" });
        self.results += 1;
        indented(out, &result(diagnostic), RESULT);
    }

    /// Appends the named rules after the results.
    fn close(&mut self, out: &mut Vec<u8>, tally: &Tally) {
        let rules: Vec<Value> = Code::ALL
            .iter()
            .filter(|code| self.used.contains(code))
            .map(|code| {
                json!({
                    "id": code.as_str(),
                    "shortDescription": { "text": code.title() },
                    "help": { "text": code.page(), "markdown": code.page() },
                    "defaultConfiguration": { "level": level(code.severity()) },
                })
            })
            .collect();
        let mut tool = json!({ "driver": {
            "name": env!("CARGO_PKG_NAME"),
            "version": env!("CARGO_PKG_VERSION"),
            "rules": rules,
        }});
        if !tally.rests_on.is_empty() {
            tool["properties"] = json!({ "restsOn": tally.rests_on });
        }
        if self.results > 0 {
            out.extend_from_slice(b"\n      ");
        }
        out.extend_from_slice(b"],\n      \"tool\": ");
        let from = out.len();
        indented(out, &tool, RUN);
        // The first line follows its key.
        out.drain(from..from + RUN);
        out.extend_from_slice(b"\n    }\n  ],\n  \"version\": \"2.1.0\"\n}\n");
    }
}

/// Appends a value as printed at some column.
fn indented(out: &mut Vec<u8>, value: &Value, column: usize) {
    let text = to_json(value);
    for (at, line) in text.lines().enumerate() {
        if at > 0 {
            out.push(b'\n');
        }
        out.resize(out.len() + column, b' ');
        out.extend_from_slice(line.as_bytes());
    }
}

fn result(diagnostic: &Diagnostic) -> Value {
    let mut text = diagnostic.message.clone();
    if !diagnostic.reached_from.is_empty() {
        let _ = write!(text, "\nnote: {}", diagnostic.reached_from);
    }
    for advice in &diagnostic.advice {
        text.push_str("\nhelp: ");
        text.push_str(&advice.to_string());
    }
    let mut result = json!({
        "ruleId": diagnostic.code.as_str(),
        "level": level(diagnostic.severity),
        "message": { "text": text },
        "locations": [{ "physicalLocation": location(&diagnostic.place) }],
    });
    let related = related(diagnostic);
    if !related.is_empty() {
        result["relatedLocations"] = Value::Array(related);
    }
    result
}

/// Returns the places that explain a message, and the programs that reach its place (R17.1).
fn related(diagnostic: &Diagnostic) -> Vec<Value> {
    let labels = diagnostic.labels.iter();
    let labels = labels.map(|label| (label.text.as_str(), location(&label.place)));
    let programs = diagnostic.reached_from.programs().iter();
    let programs = programs.map(|file| {
        let whole = json!({
            "artifactLocation": { "uri": uri(file) },
            "region": { "startLine": 1 },
        });
        ("a program that reaches this", whole)
    });
    let numbered = labels.chain(programs).enumerate();
    numbered
        .map(|(id, (text, location))| {
            json!({
                "id": id,
                "message": { "text": text },
                "physicalLocation": location,
            })
        })
        .collect()
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "note",
    }
}

fn location(place: &Place) -> Value {
    let (start, end) = (place.start(), place.end());
    json!({
        "artifactLocation": { "uri": uri(&place.file) },
        "region": {
            "startLine": start.line.max(1),
            "startColumn": start.column,
            "endLine": end.line.max(1),
            "endColumn": end.column,
        },
    })
}

/// Returns a path as a relative reference: `/` between its parts, everything unusual percent-encoded.
fn uri(path: &str) -> String {
    let mut uri = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'\\' => uri.push('/'),
            b'/' | b'-' | b'.' | b'_' | b'~' => uri.push(char::from(byte)),
            byte if byte.is_ascii_alphanumeric() => uri.push(char::from(byte)),
            byte => {
                let _ = write!(uri, "%{byte:02X}");
            }
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::text::{SourceFile, Span};

    #[test]
    fn results_that_went_out_one_by_one_are_one_document() {
        // R2.85, R9.25
        let file = SourceFile::new("a b.nc", "N10 X1");
        for results in 0..3 {
            let (mut sarif, mut out) = (Sarif::default(), Vec::new());
            sarif.open(&mut out);
            for _ in 0..results {
                let place = file.place(Span::new(0, 3));
                let said =
                    Diagnostic::new(Code::Fc402, place.clone(), "a \"message\"\nof two lines");
                sarif.message(&mut out, &said.with_help("help").with_label(place, "here"));
            }
            sarif.close(&mut out, &Tally::default());
            let text = String::from_utf8(out).expect("text");
            let document: Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(
                document["runs"][0]["results"].as_array().map(Vec::len),
                Some(results)
            );
            let pretty = serde_json::to_string_pretty(&document).expect("JSON");
            assert_eq!(text, format!("{pretty}\n"));
        }
    }
}
