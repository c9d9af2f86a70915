//! The start-up list, which names all others, and the channel list, which names the axes (R3.12,
//! R3.13).

use std::collections::BTreeMap;

use super::axis::{axis_number, text};
use super::channel_settings::{ChannelDraft, ChannelSettings};
use super::entry::{Entry, Given};
use super::line::Entries;
use super::program::ChannelPrograms;
use crate::diagnostic::{Code, Diagnostic};

/// A list that the start-up list names.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct NamedList {
    /// Its path as written.
    pub path: Given<String>,
    /// The axis that it belongs to, if the start-up list gives it.
    pub axis_number: Option<Given<u32>>,
    /// The path of the axis list of that axis, where a project gives it.
    pub(crate) owner: Option<String>,
}

/// The place of an axis in the channels, as an item of a project gives it (R3.42).
#[derive(Debug, Clone)]
pub(crate) struct AxisPlacement {
    /// The path of its axis list.
    pub(crate) list: String,
    /// Its channel, from 1.
    pub(crate) channel: Option<Given<u32>>,
    /// Its position in the channel, from 0.
    pub(crate) index: Option<u32>,
    /// Its name in programs.
    pub(crate) name: Option<Given<String>>,
}

impl AxisPlacement {
    /// Whether the axis is in the channel with a number, from 1.
    pub(crate) fn is_in(&self, number: u32) -> bool {
        self.channel
            .as_ref()
            .is_some_and(|given| given.value == number)
    }
}

/// The files that the control reads at start-up.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct StartupList {
    /// The axis list that applies before each axis' own list.
    pub default_axis_list: Option<Given<String>>,
    /// Axis lists in the order of their indices.
    pub axis_lists: Vec<Given<String>>,
    /// Value lists in the order of their indices.
    pub value_lists: Vec<NamedList>,
    /// The channel list that applies before each channel's own list.
    pub default_channel_list: Option<Given<String>>,
    /// Channel lists in the order of their channels.
    pub channel_lists: Vec<Given<String>>,
    /// The places of the axes, where a project gives them.
    pub(crate) placements: Vec<AxisPlacement>,
}

impl StartupList {
    /// Collects the files. The control does not load lists with an index beyond `zahl_mds` or
    /// `zahl_kw`, which FC124 reports.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let axis_lists = counted(list, "achs_mds[]", "zahl_mds", diagnostics);
        let value_lists = counted(list, "achs_kw[]", "zahl_kw", diagnostics);
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
                    owner: None,
                })
                .collect(),
            default_channel_list: list.find("default_sda_mds").and_then(text),
            channel_lists: channels.into_values().collect(),
            placements: Vec::new(),
        }
    }

    /// Returns the place of the axis of a list.
    pub(crate) fn placement(&self, list: &str) -> Option<&AxisPlacement> {
        self.placements.iter().find(|it| it.list == list)
    }

    /// Puts the axis lists in the order of the channels and of the axes in them.
    pub(crate) fn order_axes(&mut self) {
        let mut axis_lists = std::mem::take(&mut self.axis_lists);
        axis_lists.sort_by_key(|path| {
            let place = self.placement(&path.value);
            let channel = place.and_then(|it| Some(it.channel.as_ref()?.value));
            let index = place.and_then(|it| it.index);
            (channel.unwrap_or(u32::MAX), index.unwrap_or(u32::MAX))
        });
        self.axis_lists = axis_lists;
    }
}

/// Returns the files under a key; another key gives their number.
fn counted(
    list: &Entries,
    files_key: &str,
    count_key: &str,
    diagnostics: &mut Vec<Diagnostic>,
) -> BTreeMap<u32, Given<String>> {
    let count = list
        .find(count_key)
        .and_then(|entry| axis_number(entry, diagnostics));
    let mut files = BTreeMap::new();
    let mut surplus: Option<&Entry> = None;
    for (index, entry) in list.indexed(files_key) {
        if count.as_ref().is_some_and(|count| index >= count.value) {
            surplus = surplus.or(Some(entry));
        } else if let Some(path) = text(entry) {
            files.insert(index, path);
        }
    }
    if let (Some(entry), Some(count)) = (surplus, &count) {
        diagnostics.push(
            Diagnostic::new(
                Code::Fc124,
                entry.key_place(),
                format!(
                    "`{}` is not loaded, `{}` is {}",
                    entry.key(),
                    count_key,
                    count.value
                ),
            )
            .with_label(count.place(), "the number of lists"),
        );
    }
    // P-STUP-00015: the control tries to open the missing list and does not start.
    if let Some(count) = count
        && let Some(hole) = (0..count.value).find(|index| !files.contains_key(index))
    {
        let key = files_key.replace("[]", &format!("[{hole}]"));
        let message = format!(
            "`{}` is {}, but `{key}` names no list",
            count_key, count.value
        );
        diagnostics.push(
            Diagnostic::new(Code::Fc123, count.place(), message)
                .with_help(format!("add `{key}`, or lower `{count_key}`")),
        );
    }
    files
}

/// One axis or spindle of a channel.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ChannelAxis {
    /// `gruppe[0].achse[j].log_achs_nr`, P-CHAN-00035.
    pub number: Option<Given<u32>>,
    /// `gruppe[0].achse[j].bezeichnung`, P-CHAN-00006: the name that programs use.
    pub name: Option<Given<String>>,
    /// The path of its axis list, where a project gives it.
    pub(crate) list: Option<String>,
}

/// The axes of a channel.
#[derive(Debug, Clone, Default)]
pub struct ChannelList {
    /// The axes by their indices.
    axes: BTreeMap<u32, ChannelAxis>,
    /// The spindles by their indices.
    spindles: BTreeMap<u32, ChannelAxis>,
    /// `gruppe[0].achs_anzahl`, P-CHAN-00003: the number of axes.
    count: Option<u32>,
    /// The programs and macros that it names.
    pub programs: ChannelPrograms,
    /// Settings of motion.
    pub motion: ChannelDraft,
}

impl ChannelList {
    /// Collects the axes of the first group and the spindles.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut channel = Self {
            programs: ChannelPrograms::from_entries(list, diagnostics),
            motion: ChannelDraft::from_entries(list, diagnostics),
            ..Self::default()
        };
        for entry in &list.entries {
            let (axes, index, key) = match (entry.indices.as_slice(), entry.pattern.as_str()) {
                (&[0, index], key) => match key.strip_prefix("gruppe[].achse[].") {
                    Some(key) => (&mut channel.axes, index, key),
                    None => continue,
                },
                (&[0], "gruppe[].achs_anzahl") => {
                    channel.count = axis_number(entry, diagnostics).map(|given| given.value);
                    continue;
                }
                (&[index], key) => match key.strip_prefix("spindel[].") {
                    Some(key) => (&mut channel.spindles, index, key),
                    None => continue,
                },
                _ => continue,
            };
            match key {
                "log_achs_nr" => {
                    axes.entry(index).or_default().number = axis_number(entry, diagnostics);
                }
                "bezeichnung" => {
                    axes.entry(index).or_default().name = axis_name(entry, diagnostics);
                }
                _ => {}
            }
        }
        channel
    }

    /// Replaces values by those of another list.
    pub fn override_with(&mut self, other: Self) {
        for (mine, others) in [
            (&mut self.axes, other.axes),
            (&mut self.spindles, other.spindles),
        ] {
            for (index, axis) in others {
                let kept = mine.entry(index).or_default();
                kept.number = axis.number.or(kept.number.take());
                kept.name = axis.name.or(kept.name.take());
                kept.list = axis.list.or(kept.list.take());
            }
        }
        self.count = other.count.or(self.count);
        self.programs.override_with(other.programs);
        self.motion.override_with(other.motion);
    }

    /// Returns the axes in the order of their indices, as many as the group has. An axis with the
    /// number 0 is an empty slot.
    pub fn axes(&self) -> impl Iterator<Item = &ChannelAxis> {
        let count = self.count.unwrap_or(u32::MAX);
        let axes = self.axes.range(..count).map(|(_, axis)| axis);
        axes.filter(|axis| axis.is_there())
    }

    /// Puts an axis in its place (R3.42); its own number and name stay where the item of the project gives no name.
    pub(crate) fn place(&mut self, placement: &AxisPlacement) {
        let after = || {
            self.axes
                .keys()
                .last()
                .map_or(0, |last| last.saturating_add(1))
        };
        let index = placement.index.unwrap_or_else(after);
        let axis = self.axes.entry(index).or_default();
        axis.list = Some(placement.list.clone());
        axis.number = None;
        axis.name = placement.name.clone().or(axis.name.take());
        let count = self.count;
        self.count = count.map(|count| count.max(index.saturating_add(1)));
    }

    /// Returns the effective settings of motion.
    pub fn settings(&self) -> ChannelSettings {
        let spindles = self.spindles().filter_map(|spindle| {
            let name = spindle.name.as_ref()?;
            let number = spindle.number.as_ref().map(|given| given.value);
            Some((name.value.as_str(), number))
        });
        self.motion.settings(spindles)
    }

    /// Returns the spindles in the order of their indices.
    pub fn spindles(&self) -> impl Iterator<Item = &ChannelAxis> {
        self.spindles.values().filter(|axis| axis.is_there())
    }
}

impl ChannelAxis {
    /// Whether it is an axis: number 0 is an empty slot.
    fn is_there(&self) -> bool {
        self.number.as_ref().is_none_or(|number| number.value != 0)
    }
}

/// Returns the name of an axis, one word. Text after it without `(` is not a comment to the
/// control; here it is treated as one and reported.
fn axis_name(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<String>> {
    let given = text(entry)?;
    let word = given.value.split_whitespace().next().unwrap_or_default();
    if word.len() < given.value.len() {
        let message = format!("`{}` is not an axis name; `{word}` is used", given.value);
        let diagnostic = Diagnostic::new(Code::Fc124, given.place(), message)
            .with_help("only `(` opens a comment after a text");
        diagnostics.push(diagnostic);
    }
    Some(given.with(word.to_owned()))
}
