//! Diagnostics without a timeline, as `check` and `lists` print them (R9.25).

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::ControlFlow;

use crate::diagnostic::{Diagnostic, Severity};

use super::diagnostics::{Look, render};
use super::gitlab::{self, GitLab};
use super::output::Output;
use super::records::append_diagnostic;
use super::sarif::Sarif;
use super::strings::integer;
use super::{concise, github, json};

/// A format for diagnostics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum ListingFormat {
    /// Source lines with carets, for people.
    #[default]
    Text,
    /// One line a diagnostic.
    Concise,
    /// One JSON document.
    Json,
    /// One JSON object a line.
    Ndjson,
    /// Workflow commands of GitHub.
    Github,
    /// A Code Quality report of GitLab.
    Gitlab,
    /// SARIF 2.1.0.
    Sarif,
}

impl ListingFormat {
    /// Every format.
    pub const ALL: [Self; 7] = [
        Self::Text,
        Self::Concise,
        Self::Json,
        Self::Ndjson,
        Self::Github,
        Self::Gitlab,
        Self::Sarif,
    ];

    /// The name of the format.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Concise => "concise",
            Self::Json => "json",
            Self::Ndjson => "ndjson",
            Self::Github => "github",
            Self::Gitlab => "gitlab",
            Self::Sarif => "sarif",
        }
    }

    /// What it is, in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Text => "Source lines with carets, for people",
            Self::Concise => "One line per message",
            Self::Json => "One JSON document",
            Self::Ndjson => "One JSON object per line",
            Self::Github => "GitHub workflow commands",
            Self::Gitlab => "GitLab Code Quality report",
            Self::Sarif => "SARIF 2.1.0",
        }
    }

    /// Whether it is for diagnostics only, without records of other kinds.
    pub fn is_for_diagnostics(self) -> bool {
        matches!(self, Self::Github | Self::Gitlab | Self::Sarif)
    }
}

/// How many files were looked at and how many diagnostics of each severity were said.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tally {
    /// Files that were looked at.
    pub files: u64,
    /// Diagnostics by severity.
    pub counts: BTreeMap<Severity, u64>,
}

impl Tally {
    /// Counts a diagnostic.
    pub fn count(&mut self, severity: Severity) {
        *self.counts.entry(severity).or_default() += 1;
    }

    /// How many diagnostics of a severity were said.
    pub fn of(&self, severity: Severity) -> u64 {
        self.counts.get(&severity).copied().unwrap_or_default()
    }
}

/// Writes diagnostics one after another, then what they add up to.
#[derive(Debug)]
pub struct Listing<W> {
    output: Output<W>,
    format: ListingFormat,
    look: Look,
    gitlab: GitLab,
    sarif: Sarif,
    records: u64,
    tally: Tally,
}

impl<W: Write> Listing<W> {
    /// A list in a format; `look` matters for text only.
    pub fn new(writer: W, format: ListingFormat, look: Look) -> Self {
        let mut output = Output::new(writer);
        match format {
            ListingFormat::Json => output.bytes.extend_from_slice(json::OPENING),
            ListingFormat::Gitlab => output.bytes.extend_from_slice(gitlab::OPENING),
            ListingFormat::Sarif => Sarif::open(&mut output.bytes),
            _ => {}
        }
        Self {
            output,
            format,
            look,
            gitlab: GitLab::default(),
            sarif: Sarif::default(),
            records: 0,
            tally: Tally::default(),
        }
    }

    /// Counts a file that was looked at.
    pub fn file(&mut self) {
        self.tally.files += 1;
    }

    /// Counts diagnostics that are not written (R2.85).
    pub fn count(&mut self, severity: Severity, more: u64) {
        if more > 0 {
            *self.tally.counts.entry(severity).or_default() += more;
        }
    }

    /// What was counted so far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Writes one diagnostic. `Break` when the writer takes no more.
    pub fn diagnostic(&mut self, diagnostic: &Diagnostic) -> ControlFlow<()> {
        self.tally.count(diagnostic.severity);
        match self.format {
            ListingFormat::Text => {
                let text = render(diagnostic, self.look);
                self.output.bytes.extend_from_slice(text.as_bytes());
                self.output.bytes.push(b'\n');
            }
            ListingFormat::Concise => concise::append(&mut self.output.bytes, diagnostic),
            ListingFormat::Github => github::append(&mut self.output.bytes, diagnostic),
            ListingFormat::Gitlab => self.gitlab.append(&mut self.output.bytes, diagnostic),
            ListingFormat::Sarif => self.sarif.append(&mut self.output.bytes, diagnostic),
            ListingFormat::Json | ListingFormat::Ndjson => self.object(|out| {
                out.extend_from_slice(b"{\"record\":\"diagnostic\"");
                append_diagnostic(out, diagnostic);
                out.push(b'}');
            }),
        }
        self.output.settle()
    }

    /// Writes a record of another kind, in the formats that have records.
    pub fn record(&mut self, record: &serde_json::Value) {
        if matches!(self.format, ListingFormat::Json | ListingFormat::Ndjson) {
            self.object(|out| out.extend_from_slice(record.to_string().as_bytes()));
        }
    }

    /// Writes the end of the list.
    ///
    /// # Errors
    /// The first error of the writer; a closed pipe is none.
    pub fn finish(&mut self) -> io::Result<()> {
        match self.format {
            ListingFormat::Json | ListingFormat::Ndjson => {
                let tally = self.tally.clone();
                self.object(|out| append_tally(out, &tally));
                if self.format == ListingFormat::Json {
                    self.output.bytes.extend_from_slice(b"\n]}\n");
                }
            }
            ListingFormat::Gitlab => self.output.bytes.extend_from_slice(gitlab::CLOSING),
            ListingFormat::Sarif => self.sarif.close(&mut self.output.bytes),
            ListingFormat::Text | ListingFormat::Concise | ListingFormat::Github => {}
        }
        self.output.finish()
    }

    /// Whether the reader closed the pipe.
    pub fn is_closed(&self) -> bool {
        self.output.is_closed()
    }

    fn object(&mut self, append: impl FnOnce(&mut Vec<u8>)) {
        let out = &mut self.output.bytes;
        if self.format == ListingFormat::Json {
            let separator: &[u8] = if self.records == 0 { b"\n" } else { b",\n" };
            out.extend_from_slice(separator);
        }
        append(out);
        if self.format == ListingFormat::Ndjson {
            out.push(b'\n');
        }
        self.records += 1;
    }
}

fn append_tally(out: &mut Vec<u8>, tally: &Tally) {
    out.extend_from_slice(b"{\"record\":\"summary\",\"files\":");
    integer(out, tally.files);
    out.extend_from_slice(b",\"errors\":");
    integer(out, tally.of(Severity::Error));
    out.extend_from_slice(b",\"warnings\":");
    integer(out, tally.of(Severity::Warning));
    out.extend_from_slice(b",\"infos\":");
    integer(out, tally.of(Severity::Info));
    out.push(b'}');
}
