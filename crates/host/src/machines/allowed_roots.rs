//! The folders that programs and lists are expected in, and what is withheld about files elsewhere.

use std::path::{Path, PathBuf};

use crate::disk::Disk;
use frictcomp::diagnostic::{Advice, Diagnostic};
use frictcomp::text::Place;

/// Treatment of files outside the folders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum OutsidePolicy {
    /// Called programs are refused, the text of lists is not shown.
    #[default]
    Kept,
    /// Files outside are treated like any other file.
    Allowed,
}

/// Folders, each with everything below it.
#[derive(Debug, Clone, Default)]
pub struct AllowedRoots {
    /// The folders as named, from the root on.
    named: Vec<PathBuf>,
    /// The folders with all links resolved.
    real: Vec<PathBuf>,
    outside_policy: OutsidePolicy,
    /// Disk of the folders.
    disk: Disk,
}

impl AllowedRoots {
    /// Creates an empty set of folders.
    pub fn new(outside_policy: OutsidePolicy) -> Self {
        Self::on(&Disk::default(), outside_policy)
    }

    /// Creates an empty set of folders on a disk other than the system's.
    pub fn on(disk: &Disk, outside_policy: OutsidePolicy) -> Self {
        Self {
            outside_policy,
            disk: disk.clone(),
            ..Self::default()
        }
    }

    /// Adds a folder; an empty path is the current one.
    pub fn with(mut self, folder: &Path) -> Self {
        let named = self.disk.absolute(folder);
        self.named.extend(named.map(|path| folded(&path)));
        self.real.extend(self.disk.real(folder));
        self
    }

    /// Returns whether a file may lie here, judged by its name alone. Nothing is looked up: a look at a network share
    /// would sign in there, and whether a file exists elsewhere must not be disclosed.
    pub fn may_hold(&self, path: &Path) -> bool {
        if self.outside_policy == OutsidePolicy::Allowed {
            return true;
        }
        self.disk.absolute(path).is_some_and(|path| {
            let path = folded(&path);
            let real = self.real.iter().map(|root| folded(root));
            self.named.iter().any(|root| path.starts_with(root))
                || real.into_iter().any(|root| path.starts_with(root))
        })
    }

    /// Returns whether a file lies here once all links are resolved.
    pub fn holds(&self, path: &Path) -> bool {
        self.outside_policy == OutsidePolicy::Allowed
            || self
                .disk
                .real(path)
                .is_ok_and(|path| self.real.iter().any(|root| path.starts_with(root)))
    }

    /// Removes from diagnostics what they show of files elsewhere; place and code stay.
    pub fn conceal(&self, diagnostics: &mut [Diagnostic]) {
        for diagnostic in diagnostics {
            let is_elsewhere =
                |place: &Place| !place.text.is_empty() && !self.holds(Path::new(&*place.file));
            let labels = diagnostic.labels.iter().map(|label| &label.place);
            if !std::iter::once(&diagnostic.place)
                .chain(labels)
                .any(is_elsewhere)
            {
                continue;
            }
            diagnostic.message = format!(
                "{}; the file is outside the project, so its text is not shown",
                diagnostic.code.title()
            );
            diagnostic.advice = vec![Advice::ShowOutside];
            diagnostic.fixes.clear();
            blank(&mut diagnostic.place);
            for label in &mut diagnostic.labels {
                blank(&mut label.place);
                "the other place".clone_into(&mut label.text);
            }
        }
    }
}

/// Keeps a place's line and column, but blanks its text.
fn blank(place: &mut Place) {
    let text = place.text.char_indices();
    // As many bytes as before, so that the span keeps its place.
    let blank: String = text
        .flat_map(|(_, letter)| {
            let shown = if letter == '\n' { '\n' } else { ' ' };
            std::iter::repeat_n(shown, letter.len_utf8())
        })
        .collect();
    place.text = blank.into();
}

/// Returns a path in the form used for comparison: Windows ignores case.
fn folded(path: &Path) -> PathBuf {
    match path.to_str() {
        Some(text) if cfg!(windows) => {
            let text = text.to_lowercase();
            PathBuf::from(text.strip_prefix(r"\\?\").unwrap_or(&text))
        }
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::diagnostic::Code;
    use frictcomp::text::{SourceFile, Span};

    #[test]
    fn a_file_lies_in_its_folder_and_below() {
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir_all(path("in/deep")).unwrap();
        for name in ["in/a", "in/deep/b", "out"] {
            std::fs::write(path(name), "").unwrap();
        }
        let allowed_roots = AllowedRoots::new(OutsidePolicy::Kept).with(&path("in"));
        for (name, inside) in [
            ("in/a", true),
            ("in/deep/b", true),
            ("in/deep/../a", true),
            ("out", false),
            ("in/../out", false),
            ("inside", false),
        ] {
            assert_eq!(allowed_roots.may_hold(&path(name)), inside, "{name}");
            assert_eq!(allowed_roots.holds(&path(name)), inside, "{name}");
        }
        let any = AllowedRoots::new(OutsidePolicy::Allowed);
        assert!(any.may_hold(&path("out")) && any.holds(&path("out")));
    }

    #[test]
    fn a_file_elsewhere_is_named_and_not_shown() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("list");
        std::fs::write(&path, "").unwrap();
        let file = SourceFile::new(path.display().to_string(), "one\nÜ two secret");
        let mut said = [Diagnostic::new(
            Code::Fc122,
            file.place(Span::new(11, 17)),
            "unknown `secret`",
        )
        .with_help("did you mean `secrets`?")
        .with_label(file.place(Span::new(0, 3)), "one")];
        let before = said[0].place.start();
        AllowedRoots::new(OutsidePolicy::Allowed).conceal(&mut said);
        assert!(said[0].message.contains("secret"));
        AllowedRoots::new(OutsidePolicy::Kept).conceal(&mut said);
        assert_eq!(said[0].place.start().line, before.line);
        assert!(!format!("{said:?}").contains("secret"), "{said:?}");
        assert!(said[0].message.starts_with("unknown key"), "{said:?}");
    }
}
