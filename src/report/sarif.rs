//! SARIF 2.1.0, the exchange format of static analysis.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::codes::Code;
use crate::diagnostic::{Diagnostic, Place, Severity};

/// The results of one run; the rules that they name come with it.
#[derive(Debug, Default)]
pub(super) struct Sarif {
    results: Vec<Value>,
    used: BTreeSet<Code>,
}

impl Sarif {
    pub(super) fn push(&mut self, diagnostic: &Diagnostic) {
        self.used.insert(diagnostic.code);
        let mut text = diagnostic.message.clone();
        for help in &diagnostic.help {
            text.push_str("\nhelp: ");
            text.push_str(help);
        }
        let mut result = json!({
            "ruleId": diagnostic.code.text(),
            "level": level(diagnostic.severity),
            "message": { "text": text },
            "locations": [{ "physicalLocation": location(&diagnostic.place) }],
        });
        if !diagnostic.labels.is_empty() {
            let related: Vec<Value> = diagnostic
                .labels
                .iter()
                .enumerate()
                .map(|(id, label)| {
                    json!({
                        "id": id,
                        "message": { "text": label.text },
                        "physicalLocation": location(&label.place),
                    })
                })
                .collect();
            result["relatedLocations"] = Value::Array(related);
        }
        self.results.push(result);
    }

    /// The document.
    pub(super) fn document(&mut self) -> Value {
        let rules: Vec<Value> = Code::ALL
            .iter()
            .filter(|code| self.used.contains(code))
            .map(|code| {
                json!({
                    "id": code.text(),
                    "shortDescription": { "text": code.title() },
                    "help": { "text": code.page(), "markdown": code.page() },
                    "defaultConfiguration": { "level": level(code.severity()) },
                })
            })
            .collect();
        json!({
            "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
            "version": "2.1.0",
            "runs": [{
                "tool": { "driver": {
                    "name": env!("CARGO_PKG_NAME"),
                    "version": env!("CARGO_PKG_VERSION"),
                    "rules": rules,
                }},
                "columnKind": "unicodeCodePoints",
                "results": std::mem::take(&mut self.results),
            }],
        })
    }
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

/// A path as a relative reference: `/` between its parts, everything unusual percent-encoded.
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
