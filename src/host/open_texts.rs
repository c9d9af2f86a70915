//! Texts that stand in for files: what an editor has open and may not have saved (R12.2).

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::grounds::absolute;

/// A text that is at hand, and the file that it stands in for, which may hold another one or not be
/// there at all.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct OpenText {
    /// The file.
    pub path: PathBuf,
    /// The text.
    pub text: Arc<String>,
}

/// The texts that stand in for files, whatever name finds them.
#[derive(Debug, Clone, Default)]
pub struct OpenTexts(Arc<HashMap<PathBuf, Arc<String>>>);

impl OpenTexts {
    /// These texts.
    pub fn new(texts: impl IntoIterator<Item = OpenText>) -> Self {
        let texts = texts.into_iter();
        Self(Arc::new(
            texts.map(|open| (real(&open.path), open.text)).collect(),
        ))
    }

    /// The text that stands in for a file.
    pub fn of(&self, path: &Path) -> Option<&Arc<String>> {
        if self.0.is_empty() {
            return None;
        }
        self.0.get(&real(path))
    }
}

/// The one path of a file that all its names lead to; that of a file which is not there goes by its
/// folder.
fn real(path: &Path) -> PathBuf {
    let there = || path.canonicalize().ok();
    let beside = || Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?));
    let named = || absolute(path);
    let found = there().or_else(beside).or_else(named);
    found.unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_found_under_every_name_of_its_file() {
        // R12.2
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("deep")).unwrap();
        std::fs::write(path("a.nc"), "disk").unwrap();
        let open = |name: &str| OpenText {
            path: path(name),
            text: Arc::new(name.to_owned()),
        };
        let texts = OpenTexts::new([open("a.nc"), open("deep/../new.nc")]);
        let of = |name: &str| texts.of(&path(name)).map(|text| text.as_str());
        assert_eq!(of("a.nc"), Some("a.nc"));
        assert_eq!(of("deep/../a.nc"), Some("a.nc"));
        assert_eq!(of("new.nc"), Some("deep/../new.nc"));
        assert_eq!(of("other.nc"), None);
        assert_eq!(OpenTexts::default().of(&path("a.nc")), None);
    }
}
