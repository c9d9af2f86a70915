//! The variables that are set but not read by any program (R9.74).

use std::collections::BTreeSet;
use std::path::Path;

use crate::disk::{FileRegistry, read_bytes};
use frictcomp::diagnostic::did_you_mean;
use frictcomp::syntax::code_words;

/// A variable that is set and that no program reads.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct UnreadVariable {
    /// The name as given.
    pub name: String,
    /// The program variable that is probably meant.
    pub near: Option<String>,
}

/// Finds the variables that occur in no program that was read. Programs from a pipe cannot be read
/// again: then the result is empty.
pub fn unread_variables<'a>(
    names: impl IntoIterator<Item = &'a str>,
    registry: &FileRegistry,
) -> Vec<UnreadVariable> {
    let mut unread: BTreeSet<&str> = names.into_iter().collect();
    if unread.is_empty() || registry.has_streams() {
        return Vec::new();
    }
    let mut variables = BTreeSet::new();
    for path in registry.programs() {
        if unread.is_empty() {
            break;
        }
        look(&path, &mut unread, &mut variables);
    }
    let variable = |name: &str| UnreadVariable {
        name: name.to_owned(),
        near: did_you_mean(name, variables.iter().map(String::as_str)).map(str::to_owned),
    };
    unread.into_iter().map(variable).collect()
}

/// Looks for the names in a program, and collects its variables.
fn look(path: &Path, unread: &mut BTreeSet<&str>, variables: &mut BTreeSet<String>) {
    let Ok(bytes) = read_bytes(path) else {
        return;
    };
    let text = String::from_utf8_lossy(&bytes);
    for word in text.split(['\n', '\r']).flat_map(code_words) {
        unread.retain(|name| {
            let whole = name.split('[').next().unwrap_or(name);
            !word.eq_ignore_ascii_case(whole)
        });
        if word.starts_with("V.") {
            variables.insert(word.to_owned());
        }
    }
}
