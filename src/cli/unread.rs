//! Which variables the user set and no program reads (R9.74).

use std::collections::BTreeSet;
use std::path::Path;

use super::console::Console;
use super::discovery::MachineArgs;
use super::files::read_bytes;
use super::ledger::Ledger;
use crate::diagnostic::did_you_mean;

/// Says which `--set` stands in no program that was read. Programs from a pipe cannot be read again:
/// then nothing is said.
pub(super) fn say_unread(args: &MachineArgs, ledger: &Ledger, console: Console) {
    if args.settings.is_empty() || ledger.has_streams() {
        return;
    }
    let mut unread: BTreeSet<&str> = args.settings.iter().map(|it| it.name.as_str()).collect();
    let mut variables = BTreeSet::new();
    for path in ledger.programs() {
        if unread.is_empty() {
            return;
        }
        look(&path, &mut unread, &mut variables);
    }
    for name in unread {
        let near = did_you_mean(name, variables.iter().map(String::as_str));
        let meant = near.map_or(String::new(), |near| format!(", did you mean `{near}`?"));
        console.remark(&format!("`--set {name}`: no program reads it{meant}"));
    }
}

/// Looks for the names in a program, and gathers those that it has.
fn look(path: &Path, unread: &mut BTreeSet<&str>, variables: &mut BTreeSet<String>) {
    let Ok(bytes) = read_bytes(path) else {
        return;
    };
    let text = String::from_utf8_lossy(&bytes);
    let is_part = |it: char| it.is_ascii_alphanumeric() || "_.@".contains(it);
    for word in text.split(|it| !is_part(it)) {
        unread.retain(|name| {
            let whole = name.split('[').next().unwrap_or(name);
            !word.eq_ignore_ascii_case(whole)
        });
        if word.starts_with("V.") {
            variables.insert(word.to_owned());
        }
    }
}
