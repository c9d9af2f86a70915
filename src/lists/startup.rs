//! The start-up list, which names all others, and the channel list, which names the axes (R3.12,
//! R3.13).

use std::collections::BTreeMap;

use super::axis::{axis_number, text};
use super::{Entries, Entry, Given};
use crate::codes::Code;
use crate::diagnostic::Diagnostic;

/// The four kinds of list that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ListKind {
    /// It names the other lists: `hochlauf.lis`.
    Startup,
    /// It names the axes of a channel.
    Channel,
    /// The parameters of one axis.
    Axis,
    /// The compensation values of one axis.
    Value,
}

impl ListKind {
    /// The kind of a list by its keys; `None` when no key belongs to any of them.
    pub fn detect(list: &Entries) -> Option<Self> {
        let has = |test: fn(&str) -> bool| list.entries.iter().any(|entry| test(&entry.pattern));
        let starts = |key: &str, heads: &[&str]| heads.iter().any(|head| key.starts_with(head));
        if has(|key| STARTUP_KEYS.contains(&key)) {
            Some(Self::Startup)
        } else if has(|key| key.starts_with("gruppe[].achse[].")) {
            Some(Self::Channel)
        } else if list
            .entries
            .iter()
            .any(|entry| starts(&entry.pattern, &["frict_comp.", "frict_comp[", "kw."]))
        {
            Some(Self::Value)
        } else if list.entries.iter().any(|entry| {
            starts(
                &entry.pattern,
                &["kopf.", "kenngr.", "lr_param.", "antr.", "getriebe["],
            )
        }) {
            Some(Self::Axis)
        } else {
            None
        }
    }

    /// What it is called: `start-up list`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Startup => "start-up list",
            Self::Channel => "channel list",
            Self::Axis => "axis list",
            Self::Value => "value list",
        }
    }
}

const STARTUP_KEYS: [&str; 7] = [
    "zahl_mds",
    "default_achs_mds",
    "achs_mds[]",
    "zahl_kw",
    "achs_kw[]",
    "achs_kw_log_ax_nr[]",
    "sda_mds[]",
];

/// A list that the start-up list names.
#[derive(Debug, Clone)]
pub struct NamedList {
    /// Its path, as it is written.
    pub path: Given<String>,
    /// The axis that it belongs to, where the start-up list says so.
    pub axis_number: Option<Given<u32>>,
}

/// The files that the control reads at start-up.
#[derive(Debug, Clone, Default)]
pub struct StartupList {
    /// The axis list that applies before each axis' own one.
    pub default_axis_list: Option<Given<String>>,
    /// Axis lists in the order of their indices.
    pub axis_lists: Vec<Given<String>>,
    /// Value lists in the order of their indices.
    pub value_lists: Vec<NamedList>,
    /// Channel lists in the order of their channels.
    pub channel_lists: Vec<Given<String>>,
}

impl StartupList {
    /// Gathers the files. Lists with an index beyond `zahl_mds` or `zahl_kw` are not loaded by
    /// the control, FC124 says so.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let axis_lists = counted(list, ("achs_mds[]", "zahl_mds"), diagnostics);
        let value_lists = counted(list, ("achs_kw[]", "zahl_kw"), diagnostics);
        let mut numbers: BTreeMap<u32, Given<u32>> = list
            .indexed("achs_kw_log_ax_nr[]")
            .filter_map(|(index, entry)| Some((index, axis_number(entry, diagnostics)?)))
            .collect();
        let channels: BTreeMap<u32, _> = list
            .indexed("sda_mds[]")
            .filter_map(|(index, entry)| Some((index, text(entry)?)))
            .collect();
        Self {
            default_axis_list: list.find("default_achs_mds").and_then(text),
            axis_lists: axis_lists.into_values().collect(),
            value_lists: value_lists
                .into_iter()
                .map(|(index, path)| NamedList {
                    path,
                    axis_number: numbers.remove(&index),
                })
                .collect(),
            channel_lists: channels.into_values().collect(),
        }
    }
}

/// The files under `keys.0`, as many as `keys.1` says.
fn counted(
    list: &Entries,
    keys: (&str, &str),
    diagnostics: &mut Vec<Diagnostic>,
) -> BTreeMap<u32, Given<String>> {
    let count = list
        .find(keys.1)
        .and_then(|entry| axis_number(entry, diagnostics));
    let mut files = BTreeMap::new();
    let mut surplus: Option<&Entry> = None;
    for (index, entry) in list.indexed(keys.0) {
        if count.as_ref().is_some_and(|count| index >= count.value) {
            surplus = surplus.or(Some(entry));
        } else if let Some(path) = text(entry) {
            files.insert(index, path);
        }
    }
    if let (Some(entry), Some(count)) = (surplus, count) {
        diagnostics.push(
            Diagnostic::new(
                Code::Fc124,
                entry.key_place(),
                format!(
                    "`{}` is not loaded, `{}` is {}",
                    entry.key(),
                    keys.1,
                    count.value
                ),
            )
            .with_label(count.place(), "the number of lists"),
        );
    }
    files
}

/// One axis of a channel.
#[derive(Debug, Clone, Default)]
pub struct ChannelAxis {
    /// `gruppe[0].achse[j].log_achs_nr`.
    pub number: Option<Given<u32>>,
    /// `gruppe[0].achse[j].bezeichnung`: the name that programs use.
    pub name: Option<Given<String>>,
}

/// The axes of a channel.
#[derive(Debug, Clone, Default)]
pub struct ChannelList {
    /// The axes in the order of their indices.
    pub axes: Vec<ChannelAxis>,
}

impl ChannelList {
    /// Gathers the axes of the first group.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut axes: BTreeMap<u32, ChannelAxis> = BTreeMap::new();
        for entry in &list.entries {
            let &[0, index] = entry.indices.as_slice() else {
                continue;
            };
            match entry.pattern.as_str() {
                "gruppe[].achse[].log_achs_nr" => {
                    axes.entry(index).or_default().number = axis_number(entry, diagnostics);
                }
                "gruppe[].achse[].bezeichnung" => {
                    axes.entry(index).or_default().name = text(entry);
                }
                _ => {}
            }
        }
        Self {
            axes: axes.into_values().collect(),
        }
    }
}
