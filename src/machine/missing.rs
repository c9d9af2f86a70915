//! Named lists that are missing, reported once for each folder (R3.12).

use std::collections::BTreeSet;
use std::sync::Arc;

use super::files::{folder, is_absolute, join};
use crate::diagnostic::{Code, Diagnostic};
use crate::lists::Given;

/// The folders that were searched for lists, and the lists that were not found.
#[derive(Debug, Default)]
pub(super) struct MissingLists {
    /// Folders in which a list was found: the list that names it, and the folder.
    found: BTreeSet<(Arc<str>, String)>,
    lacking: Vec<Lacking>,
}

/// A list that was not found.
#[derive(Debug)]
struct Lacking {
    /// The list that names it.
    asker: Arc<str>,
    folder: String,
    /// The last part of its path.
    name: String,
    /// Index of the message about it.
    message: usize,
}

impl MissingLists {
    /// Records that a list exists.
    pub(super) fn find(&mut self, asked: &Given<String>) {
        self.found.insert(whereabouts(asked));
    }

    /// Records that a list is missing, as reported by the diagnostic with this index.
    pub(super) fn lack(&mut self, asked: &Given<String>, message: usize) {
        let (list, folder) = whereabouts(asked);
        if folder.is_empty() || is_absolute(&asked.value) {
            return;
        }
        let name = asked.value.rsplit(['\\', '/']).next().unwrap_or_default();
        self.lacking.push(Lacking {
            asker: list,
            folder,
            name: name.to_owned(),
            message,
        });
    }

    /// Merges the messages about the lists of a folder if none of them was found: the control finds
    /// the folder from its own working folder, but it does not exist here.
    pub(super) fn merge(self, diagnostics: &mut Vec<Diagnostic>) {
        let mut surplus = Vec::new();
        let mut rest = self.lacking;
        while let Some(first) = rest.first() {
            let place = (first.asker.clone(), first.folder.clone());
            let (same, others): (Vec<_>, Vec<_>) = rest
                .into_iter()
                .partition(|it| it.asker == place.0 && it.folder == place.1);
            rest = others;
            if same.len() < 2 || self.found.contains(&place) {
                continue;
            }
            let names: Vec<&str> = same.iter().map(|it| it.name.as_str()).collect();
            let first = &mut diagnostics[same[0].message];
            first.message = format!(
                "the folder `{}`, in which `{}` names {} lists, is not here",
                place.1,
                place.0,
                names.len()
            );
            first.advice.insert(
                0,
                "the control finds it from its working folder; copy it next to this list".into(),
            );
            first
                .advice
                .push(format!("the lists are {}", names.join(", ")).into());
            surplus.extend(same[1..].iter().map(|it| it.message));
        }
        surplus.sort_unstable();
        let mut at = 0;
        diagnostics.retain(|diagnostic| {
            let is_surplus = surplus.binary_search(&at).is_ok();
            debug_assert!(!is_surplus || diagnostic.code == Code::Fc123);
            at += 1;
            !is_surplus
        });
    }
}

/// Returns the list that names a path, and the folder of the path.
fn whereabouts(asked: &Given<String>) -> (Arc<str>, String) {
    (asked.file().into(), join("", folder(&asked.value)))
}
