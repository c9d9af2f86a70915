//! Values that refer to another parameter of the list: `P-AXIS-00008.0` (R3.40).

use super::entry::Entry;
use super::keywords::{is_known, known_keys};
use crate::diagnostic::{Code, Diagnostic};
use crate::text::Span;

/// A value `P-AXIS-00008.0`: a parameter and the indices in its key.
struct Reference {
    number: String,
    indices: Vec<u32>,
}

impl Reference {
    /// Reads a reference; `None` for any other value.
    fn parse(word: &str) -> Option<Self> {
        let mut parts = word.split('.');
        let number = parts.next()?.to_ascii_uppercase();
        let (room, digits) = number.strip_prefix("P-")?.split_once('-')?;
        let is_number = digits.len() == 5 && digits.bytes().all(|byte| byte.is_ascii_digit());
        if !is_number || !matches!(room, "AXIS" | "CHAN" | "COMP" | "STUP") {
            return None;
        }
        let indices: Result<Vec<u32>, _> = parts.map(str::parse).collect();
        Some(Self {
            number,
            indices: indices.ok()?,
        })
    }

    /// Returns the entry of the parameter. An omitted index is 0.
    fn find(&self, entries: &[Entry]) -> Result<usize, &'static str> {
        let mut keys = known_keys()
            .filter(|key| key.number == self.number)
            .peekable();
        if keys.peek().is_none() {
            return Err("whose key is not known to frictcomp");
        }
        let at = |index: usize| self.indices.get(index).copied().unwrap_or(0);
        let is_meant = |entry: &Entry, pattern: &str| {
            entry.pattern == pattern && entry.indices.iter().enumerate().all(|(i, &it)| it == at(i))
        };
        keys.find_map(|key| {
            let mut entries = entries.iter();
            entries.position(|entry| is_meant(entry, key.pattern))
        })
        .ok_or("which no line of this list gives")
    }
}

/// Gives every known entry that refers to another one the value of that one. Removes and returns
/// those whose reference cannot be resolved, each reported with FC124.
pub(super) fn resolve(entries: &mut Vec<Entry>, diagnostics: &mut Vec<Diagnostic>) -> Vec<Entry> {
    let begins = |entry: &Entry| matches!(entry.word().value.as_bytes(), [b'P' | b'p', b'-', ..]);
    let referring = (0..entries.len())
        .filter(|&at| is_known(&entries[at].pattern) && begins(&entries[at]))
        .collect::<Vec<_>>();
    let mut broken = Vec::new();
    for at in referring {
        match follow(entries, at) {
            Ok(Some(value)) => entries[at].meant = value,
            Ok(None) => {}
            // A circle is reported at the first of its members.
            Err((_, passed)) if passed.iter().any(|it| broken.contains(it)) => broken.push(at),
            Err((why, _)) => {
                let entry = &entries[at];
                let word = entry.word();
                let message = format!(
                    "`{}` refers to `{}`, {why}; the value is not used",
                    entry.key(),
                    word.value
                );
                diagnostics.push(
                    Diagnostic::new(Code::Fc124, word.place(), message)
                        .with_help("write the value itself"),
                );
                broken.push(at);
            }
        }
    }
    let mut unresolved = Vec::new();
    for at in broken.into_iter().rev() {
        unresolved.push(entries.remove(at));
    }
    unresolved
}

/// Returns the span of the value that an entry refers to; `None` for an entry without a reference.
fn follow(entries: &[Entry], first: usize) -> Result<Option<Span>, (&'static str, Vec<usize>)> {
    let mut passed = vec![first];
    loop {
        let last = &entries[*passed.last().unwrap_or(&first)];
        let Some(reference) = Reference::parse(last.word().value) else {
            return Ok((passed.len() > 1).then_some(last.meant));
        };
        let next = match reference.find(entries) {
            Ok(next) => next,
            Err(why) => return Err((why, passed)),
        };
        if passed.contains(&next) {
            return Err(("which leads back to itself", passed));
        }
        passed.push(next);
    }
}
