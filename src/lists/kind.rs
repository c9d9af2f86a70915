//! The kind of a list, which its keys decide (R3.44).

use super::line::{Entries, Entry};
use crate::diagnostic::{Code, Diagnostic};
use crate::text::lines_of;

/// The kinds of list that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ListKind {
    /// Start-up list, which names the other lists: `hochlauf.lis`.
    Startup,
    /// Channel list, which names the axes of a channel.
    Channel,
    /// The parameters of one axis.
    Axis,
    /// The compensation values of one axis.
    Value,
    /// List with only the number and name of an axis, as in an axis list or a value list.
    Head,
}

/// The keys of a kind of list, as beginnings of their patterns.
struct KindKeys {
    kind: ListKind,
    /// Keys of which any one decides the kind.
    deciding: &'static [&'static str],
    /// Keys that identify the kind if the list has no deciding key of any kind.
    others: &'static [&'static str],
}

/// A row for each kind that is read. Of two kinds with as many keys the earlier one counts.
const KINDS: [KindKeys; 5] = [
    KindKeys {
        kind: ListKind::Startup,
        deciding: &["zahl_mds", "achs_mds[", "default_achs_mds", "sda_mds["],
        others: &["zahl_kw", "achs_kw", "default_sda_mds", "kanal_anzahl"],
    },
    KindKeys {
        kind: ListKind::Value,
        deciding: &["frict_comp.", "frict_comp[", "kw."],
        others: &[],
    },
    KindKeys {
        kind: ListKind::Axis,
        deciding: &["kenngr.", "lr_param.", "getriebe[", "antr."],
        others: &["lr_hw[", "vorsteuer.", "handbetrieb."],
    },
    KindKeys {
        kind: ListKind::Channel,
        deciding: &["gruppe[", "prog_start.", "synchro_data."],
        others: &[
            "grp_anzahl",
            "spindel[",
            "makro_def[",
            "m_synch[",
            "h_synch[",
            "trafo[",
            "syn_chk.",
            "speed_limit_look_ahead.",
            "start_init_prog_file",
            "final_prog_file",
            "m6_prog_file",
            "t_prog_file",
            "d_prog_file",
            "g8",
            "einrechnen_mit_t",
            "main_spindle_",
            "mass_einh",
        ],
    },
    KindKeys {
        kind: ListKind::Head,
        deciding: &[],
        others: &["kopf."],
    },
];

/// Lists of the control that do not concern compensation, by the beginnings of their keys.
const UNREAD: [(&str, &str); 17] = [
    ("wz[", "a tool list"),
    ("np_grp[", "a zero offset list"),
    ("g53_verfuegbar", "a zero offset list"),
    ("default_index", "a zero offset list"),
    ("pzv_grp[", "a clamp position list"),
    ("hr_data[", "a manual mode list"),
    ("tasten_data[", "a manual mode list"),
    ("feedhold.", "a manual mode list"),
    ("var[", "a list of external variables"),
    ("name_rd_", "a list of external variables"),
    ("number_used_variables", "a list of external variables"),
    ("use_extended_string_var", "a list of external variables"),
    ("interrupt_source", "a list of real-time tasks"),
    ("time_slice", "a list of real-time tasks"),
    ("thread[", "a list of real-time tasks"),
    ("object[", "a list of display objects"),
    ("kin_step[", "a kinematics list"),
];

impl KindKeys {
    fn of(kind: ListKind) -> &'static Self {
        let mut rows = KINDS.iter();
        rows.find(|row| row.kind == kind)
            .expect("there is a row for each kind")
    }

    /// Returns whether a key belongs to the kind.
    fn has(&self, entry: &Entry) -> bool {
        begins(entry, self.deciding) || begins(entry, self.others)
    }
}

fn begins(entry: &Entry, beginnings: &[&str]) -> bool {
    let mut beginnings = beginnings.iter();
    beginnings.any(|beginning| entry.pattern.starts_with(*beginning))
}

/// Returns the kind with the most keys of a column of the table.
fn most(list: &Entries, column: fn(&KindKeys) -> &[&'static str]) -> Option<ListKind> {
    let count = |row: &KindKeys| list.all().filter(|it| begins(it, column(row))).count();
    let counts = KINDS.iter().map(|row| (count(row), row.kind));
    let counts = counts.filter(|(count, _)| *count > 0);
    // Of equal counts `max_by_key` takes the last one.
    let first = counts.rev();
    let most = first.max_by_key(|(count, kind)| (*kind != ListKind::Head, *count));
    most.map(|(_, kind)| kind)
}

impl ListKind {
    /// Returns the kind of a list by its keys; `None` if no key belongs to any kind.
    pub fn detect(list: &Entries) -> Option<Self> {
        most(list, |row| row.deciding).or_else(|| most(list, |row| row.others))
    }

    /// Returns whether a text has a line that begins with a deciding key, or with the head of a list, and a value.
    pub(crate) fn is_likely(text: &str) -> bool {
        let is_entry = |line: &str| {
            let line = line.trim_start();
            let key = KINDS.iter().find_map(|row| {
                let head = (row.kind == Self::Head).then_some(row.others);
                let keys = head.unwrap_or(row.deciding).iter();
                keys.clone().find(|key| line.starts_with(*key))
            });
            let rest = key.map(|key| &line[key.len()..]);
            let value = rest.and_then(|rest| rest.split_once([' ', '\t']));
            let value = value.map(|(_, value)| value.trim_start());
            // An assignment is code of a PLC.
            value.is_some_and(|value| !value.starts_with([':', '=']))
        };
        lines_of(text).any(is_entry)
    }

    /// Returns whether a list can serve as one of this kind: one of its keys identifies this kind, or none identifies
    /// another one. A start-up list, with which everything begins, needs a key of its own.
    pub fn admits(self, list: &Entries) -> bool {
        list.all().any(|entry| KindKeys::of(self).has(entry))
            || (self != Self::Startup && matches!(Self::detect(list), None | Some(Self::Head)))
    }

    /// Returns the name with its article: `a start-up list`.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Startup => "a start-up list",
            Self::Channel => "a channel list",
            Self::Axis => "an axis list",
            Self::Value => "a value list",
            Self::Head => "the head of an axis list or value list",
        }
    }

    /// Returns FC122 for the keys of other kinds in a list that is read as one of this kind, once for each other kind
    /// (R3.44).
    pub(crate) fn check_keys(self, list: &Entries) -> Vec<Diagnostic> {
        let own = KindKeys::of(self);
        let mut foreign: Vec<(&'static str, Vec<&Entry>)> = Vec::new();
        for entry in list.all().filter(|entry| !own.has(entry)) {
            let Some(other) = noun_of(entry) else {
                continue;
            };
            match foreign.iter_mut().find(|(noun, _)| *noun == other) {
                Some((_, entries)) => entries.push(entry),
                None => foreign.push((other, vec![entry])),
            }
        }
        let said = foreign.iter().map(|(noun, entries)| {
            let key = entries[0].key();
            let keys = match entries.len() - 1 {
                0 => format!("`{key}` belongs"),
                1 => format!("`{key}` and 1 more key belong"),
                more => format!("`{key}` and {more} more keys belong"),
            };
            let message = format!("{keys} to {noun}; this is {}", self.noun());
            Diagnostic::new(Code::Fc122, entries[0].key_place(), message)
                .with_help("write it in a list of that kind")
        });
        said.collect()
    }
}

/// Returns the kind of list that a key belongs to, with its article; the head is part of several.
fn noun_of(entry: &Entry) -> Option<&'static str> {
    let mut read = KINDS.iter().filter(|row| row.kind != ListKind::Head);
    let read = read.find(|row| row.has(entry)).map(|row| row.kind.noun());
    read.or_else(|| unread(entry))
}

/// Returns the list to which a key belongs that does not concern compensation.
fn unread(entry: &Entry) -> Option<&'static str> {
    let mut rows = UNREAD.iter();
    let found = rows.find(|(key, _)| entry.pattern.starts_with(key))?;
    Some(found.1)
}

impl Entries {
    /// Returns the entries, also those whose value is a reference to nothing.
    fn all(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().chain(&self.unresolved)
    }

    /// Returns the list that this one is if it does not concern compensation: `a tool list`.
    pub(crate) fn unread_kind(&self) -> Option<&'static str> {
        self.all().find_map(unread)
    }
}
