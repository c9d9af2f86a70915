//! The findings of an earlier check, so that only new ones are shown (R17.3).

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::disk::{Disk, FileRegistry, read_text};
use crate::error::HostError;
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::text::shown_path;

/// The version of the file.
const SCHEMA: u64 = 1;

/// Key that identifies a finding, wherever its block is in its file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct BaselineKey {
    /// Relative to the folder of the baseline.
    file: String,
    code: String,
    severity: String,
    axis: Option<String>,
    /// Text of the message with the kind, the state and the ways, without lines and the number of occurrences.
    message: String,
    /// The text of its block.
    block: String,
}

/// A finding of the file, and how often it occurs there.
#[derive(Debug, Serialize, Deserialize)]
struct Counted {
    #[serde(flatten)]
    finding: BaselineKey,
    count: u64,
}

/// The whole file.
#[derive(Debug, Deserialize)]
struct BaselineFile {
    findings: Vec<Counted>,
    /// Findings that were too many to be listed, by severity.
    #[serde(default)]
    unlisted: BTreeMap<String, u64>,
}

/// Known findings, which a check leaves out, or those of a check, to be known from now on.
#[derive(Default)]
pub struct Baseline {
    /// Known findings that were not met yet, or those to be written.
    findings: BTreeMap<BaselineKey, u64>,
    unlisted: BTreeMap<String, u64>,
    purpose: Purpose,
    /// The folder of the file.
    folder: PathBuf,
    /// The names of files relative to it, by their names in messages.
    names: BTreeMap<String, String>,
    /// Number of known findings, and of errors among them.
    known: u64,
    errors: u64,
}

/// Purpose of a baseline.
#[derive(Default, Clone, Copy)]
enum Purpose {
    /// No baseline: all findings are listed.
    #[default]
    None,
    /// Known findings are left out.
    Compare,
    /// All findings are kept for the file.
    Keep,
}

/// Counts of a check beside its baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct KnownFindings {
    /// Number of findings that are known, or were kept for the file.
    pub known: u64,
    /// Number of errors of the control among them.
    pub errors: u64,
    /// Number of known findings that the checked or removed files no longer have.
    pub gone: u64,
}

impl Baseline {
    /// Creates a baseline whose file will be `path`: every finding is kept for it, and none is listed.
    pub fn kept_for(path: &Path) -> Self {
        Self {
            purpose: Purpose::Keep,
            folder: folder_of(path),
            ..Self::default()
        }
    }

    /// Reads the known findings of a file that [`Baseline::text`] made.
    ///
    /// # Errors
    ///
    /// [`HostError::Read`] for a file that cannot be read, [`HostError::Baseline`] for a folder and for a file that is
    /// damaged, of another schema, or no baseline.
    pub fn read(path: &Path, registry: &FileRegistry) -> Result<Self, HostError> {
        registry.reads("baseline", path);
        let refused = |reason: String| HostError::Baseline {
            path: path.to_owned(),
            reason,
        };
        if path.is_dir() {
            return Err(refused("is a folder".to_owned()));
        }
        let text = read_text(path)?;
        let damaged = |error: serde_json::Error| refused(format!("is damaged: {error}"));
        let value: Value = serde_json::from_str(&text).map_err(damaged)?;
        match value.get("schema").and_then(Value::as_u64) {
            Some(SCHEMA) => {}
            Some(other) => {
                return Err(refused(format!(
                    "has schema {other}; this version of frictcomp reads schema {SCHEMA}"
                )));
            }
            None => {
                return Err(refused(
                    "has no `schema`, so it is not a baseline".to_owned(),
                ));
            }
        }
        let file: BaselineFile = serde_json::from_value(value).map_err(damaged)?;
        let mut findings = BTreeMap::new();
        for Counted { finding, count } in file.findings {
            let known: &mut u64 = findings.entry(finding).or_default();
            *known = known.saturating_add(count);
        }
        Ok(Self {
            findings,
            unlisted: file.unlisted,
            purpose: Purpose::Compare,
            folder: folder_of(path),
            ..Self::default()
        })
    }

    /// Takes a finding, and returns whether it is listed.
    pub fn lists(&mut self, said: &Diagnostic) -> bool {
        if matches!(self.purpose, Purpose::None) {
            return true;
        }
        let key = BaselineKey::of(said, self.name(&said.place.file));
        match self.purpose {
            Purpose::None | Purpose::Keep => *self.findings.entry(key).or_default() += 1,
            Purpose::Compare => match self.findings.get_mut(&key) {
                Some(left) if *left > 0 => *left -= 1,
                _ => return true,
            },
        }
        self.count(said.severity, 1);
        false
    }

    /// Returns the name of a file relative to the baseline.
    fn name(&mut self, file: &str) -> String {
        let Self { names, folder, .. } = self;
        let name = || shown_path(&Disk::named_from(Path::new(file), folder));
        names.entry(file.to_owned()).or_insert_with(name).clone()
    }

    /// Takes findings that are too many to be listed, and returns how many of them are not known.
    pub fn unlisted(&mut self, severity: Severity, more: u64) -> u64 {
        let word = severity.as_str().to_owned();
        let known = match self.purpose {
            Purpose::None => return more,
            Purpose::Keep => {
                *self.unlisted.entry(word).or_default() += more;
                more
            }
            Purpose::Compare => {
                let left = self.unlisted.entry(word).or_default();
                let known = more.min(*left);
                *left -= known;
                known
            }
        };
        self.count(severity, known);
        more - known
    }

    fn count(&mut self, severity: Severity, more: u64) {
        self.known += more;
        if severity == Severity::Error {
            self.errors += more;
        }
    }

    /// Returns what was known, and what is gone from the files that were read or removed; `None` without a baseline.
    pub fn counts(&mut self, registry: &FileRegistry) -> Option<KnownFindings> {
        let gone = match self.purpose {
            Purpose::None => return None,
            Purpose::Keep => 0,
            Purpose::Compare => {
                let files = registry.files();
                let read: BTreeSet<String> =
                    files.iter().map(|it| self.name(&shown_path(it))).collect();
                let is_checked =
                    |file: &String| read.contains(file) || !self.folder.join(file).exists();
                let left = self.findings.iter();
                let gone = left.filter(|(finding, _)| is_checked(&finding.file));
                gone.map(|(_, left)| *left).sum()
            }
        };
        Some(KnownFindings {
            known: self.known,
            errors: self.errors,
            gone,
        })
    }

    /// Returns the text of the file, one finding per line, so that two branches can be merged.
    pub fn text(&self) -> String {
        let lines = self.findings.iter().map(|(finding, count)| {
            let counted = Counted {
                finding: finding.clone(),
                count: *count,
            };
            format!("\n    {}", json!(counted))
        });
        let lines: Vec<String> = lines.collect();
        format!(
            "{{\n  \"schema\": {SCHEMA},\n  \"unlisted\": {},\n  \"findings\": [{}\n  ]\n}}\n",
            json!(self.unlisted),
            lines.join(",")
        )
    }
}

fn folder_of(path: &Path) -> PathBuf {
    let place = Disk::place(path);
    place.parent().map_or_else(PathBuf::new, Path::to_owned)
}

impl BaselineKey {
    fn of(said: &Diagnostic, file: String) -> Self {
        Self {
            file,
            code: said.code.as_str().to_owned(),
            severity: said.severity.as_str().to_owned(),
            axis: said.axis.clone(),
            message: without_lines(said.uncounted()),
            block: said.place.text.trim().to_owned(),
        }
    }
}

/// Returns a message without its line numbers, which change.
fn without_lines(message: &str) -> String {
    const WORD: &str = "line ";
    let mut plain = String::with_capacity(message.len());
    let mut rest = message;
    while let Some(at) = rest.find(WORD) {
        let (before, after) = rest.split_at(at + WORD.len());
        plain.push_str(before);
        rest = after.trim_start_matches(|letter: char| letter.is_ascii_digit());
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::diagnostic::Code;
    use frictcomp::text::{SourceFile, Span};

    fn said(text: &str, start: usize, message: &str) -> Diagnostic {
        let file = SourceFile::new("a.nc", text);
        Diagnostic::new(
            Code::Fc401,
            file.place(Span::new(start, start + 1)),
            message,
        )
    }

    #[test]
    fn a_finding_is_the_same_on_another_line() {
        // R17.3
        let above = "(new)\nN1 X\n";
        let key = |said: &Diagnostic| BaselineKey::of(said, "a.nc".to_owned());
        let before = key(&said("N1 X\n", 0, "left if V.E.A (line 12), else off"));
        let after = key(&said(above, 6, "left if V.E.A (line 13), else off"));
        assert_eq!(before, after);
        let other = key(&said("N1 X\n", 0, "left if V.E.B (line 12), else off"));
        assert_ne!(before, other);
        let other = key(&said("N1 Y\n", 0, "left if V.E.A (line 12), else off"));
        assert_ne!(before, other);
    }

    #[test]
    fn one_more_of_the_same_is_new() {
        // R17.3
        let finding = said("N1 X\n", 0, "left");
        let mut baseline = Baseline {
            findings: BTreeMap::from([(BaselineKey::of(&finding, "a.nc".to_owned()), 2)]),
            unlisted: BTreeMap::from([("error".to_owned(), 5)]),
            purpose: Purpose::Compare,
            ..Baseline::default()
        };
        let listed = [0; 3].map(|_| baseline.lists(&finding));
        assert_eq!(listed, [false, false, true]);
        assert_eq!(baseline.unlisted(Severity::Error, 4), 0);
        assert_eq!(baseline.unlisted(Severity::Error, 4), 3);
        assert_eq!((baseline.known, baseline.errors), (7, 5));
    }
}
