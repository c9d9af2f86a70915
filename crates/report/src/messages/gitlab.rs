//! Code Quality reports of GitLab, which shows them next to the changed lines of a merge request.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::Hasher;

use crate::wording::append_json;
use fnv::FnvHasher;
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use serde::Serialize;

use super::message_format::MessageFormat;
use super::tally::Tally;

/// A message as GitLab reads it.
#[derive(Serialize)]
struct Issue<'a> {
    description: Cow<'a, str>,
    check_name: Code,
    fingerprint: String,
    severity: &'static str,
    location: Location,
}

#[derive(Serialize)]
struct Location {
    path: String,
    lines: LineRange,
}

#[derive(Serialize)]
struct LineRange {
    begin: u32,
    end: u32,
}

/// The messages so far.
#[derive(Debug, Default)]
pub(super) struct GitLab {
    /// Number of messages with the same words about the same file.
    said: HashMap<u64, u64>,
}

impl MessageFormat for GitLab {
    fn open(&mut self, out: &mut Vec<u8>) {
        out.push(b'[');
    }

    fn message(&mut self, out: &mut Vec<u8>, diagnostic: &Diagnostic) {
        out.extend_from_slice(if self.said.is_empty() { b"\n" } else { b",\n" });
        let path = diagnostic.place.file.replace('\\', "/");
        let issue = Issue {
            description: diagnostic.line(),
            check_name: diagnostic.code,
            fingerprint: self.fingerprint(&path, diagnostic),
            severity: severity(diagnostic.severity),
            location: Location {
                lines: LineRange {
                    begin: diagnostic.place.start().line,
                    end: diagnostic.place.end().line,
                },
                path,
            },
        };
        append_json(out, &issue);
    }

    fn close(&mut self, out: &mut Vec<u8>, _tally: &Tally) {
        out.extend_from_slice(b"\n]\n");
    }
}

impl GitLab {
    /// Returns the fingerprint by which GitLab recognises new messages. It does not change when lines above
    /// do, nor when another program reaches the place (R17.1), so it is made of the words, and of a count if
    /// these are the same.
    fn fingerprint(&mut self, path: &str, diagnostic: &Diagnostic) -> String {
        let mut hasher = FnvHasher::default();
        for part in [path, diagnostic.code.as_str(), diagnostic.uncounted()] {
            hasher.write(part.as_bytes());
            hasher.write_u8(0);
        }
        let words = hasher.finish();
        let times = self.said.entry(words).or_default();
        *times += 1;
        format!("{words:016x}-{times}")
    }
}

fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "critical",
        Severity::Warning => "major",
        Severity::Info => "info",
    }
}
