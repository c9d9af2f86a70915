//! The start-up list, which names all others, the channel list, which names the axes (R3.12, R3.13), and the programs and macros that
//! it names (R2.75).

use std::collections::BTreeMap;

use super::axis::{axis_number, text};
use super::channel_settings::{ChannelDraft, ChannelSettings, odd};
use super::keywords::number_of;
use super::line::{Entries, Entry, Given};
use super::parameter::Parameter;
use crate::diagnostic::{Code, Diagnostic};

/// A list that the start-up list names.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct NamedList {
    /// Path as written.
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
    /// Channel, from 1.
    pub(crate) channel: Option<Given<u32>>,
    /// Position in the channel, from 0.
    pub(crate) index: Option<u32>,
    /// Name in programs.
    pub(crate) name: Option<Given<String>>,
}

impl AxisPlacement {
    /// Returns whether the axis is in the channel with a number, from 1.
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
    /// `zahl_kw`, nor any where the number is missing (P-STUP-00014, P-STUP-00016), which FC124 reports.
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
    let written = list.find(count_key);
    let count = written.and_then(|entry| axis_number(entry, diagnostics));
    let end = match (written, &count) {
        (_, Some(count)) => count.value,
        // A number that cannot be read is reported by itself.
        (Some(_), None) => u32::MAX,
        (None, None) => 0,
    };
    let mut files = BTreeMap::new();
    let mut surplus: Vec<&Entry> = Vec::new();
    for (index, entry) in list.indexed(files_key) {
        if index >= end {
            surplus.push(entry);
        } else if let Some(path) = text(entry) {
            files.insert(index, path);
        }
    }
    diagnostics.extend(match &count {
        Some(count) => beyond(&surplus, count_key, count),
        None => uncounted(&surplus, count_key),
    });
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

/// Returns FC124 for lists beyond their number.
fn beyond(surplus: &[&Entry], count_key: &str, count: &Given<u32>) -> Option<Diagnostic> {
    let first = surplus.first()?;
    let message = format!(
        "`{}` is not loaded, `{count_key}` is {}",
        first.key(),
        count.value
    );
    let said = Diagnostic::new(Code::Fc124, first.key_place(), message);
    Some(said.with_label(count.place(), "the number of lists"))
}

/// Returns FC124 for lists whose number is missing: its default is 0 (P-STUP-00014, P-STUP-00016).
fn uncounted(surplus: &[&Entry], count_key: &str) -> Option<Diagnostic> {
    let first = surplus.first()?;
    let message = format!(
        "`{}` is not loaded: `{count_key}` is missing, and the control takes 0",
        first.key()
    );
    let indices = surplus.iter().filter_map(|entry| entry.indices.last());
    let needed = indices.max().map_or(0, |index| index.saturating_add(1));
    let said = Diagnostic::new(Code::Fc124, first.key_place(), message);
    Some(said.with_help(format!("add `{count_key} {needed}`")))
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

    /// Returns the axes in the order of their indices, as many as the group has. An axis with the number 0 is an empty
    /// slot, which does not count (P-CHAN-00003).
    pub fn axes(&self) -> impl Iterator<Item = &ChannelAxis> {
        self.indexed_axes().map(|(_, axis)| axis)
    }

    /// Returns the same with their indices.
    pub(crate) fn indexed_axes(&self) -> impl Iterator<Item = (u32, &ChannelAxis)> {
        let count = self.count.unwrap_or(u32::MAX);
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        let axes = self.axes.iter().map(|(index, axis)| (*index, axis));
        axes.filter(|(_, axis)| axis.is_there()).take(count)
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
    /// Returns whether it is an axis: number 0 is an empty slot.
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

/// Event that starts a program of the channel list.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ProgramRole {
    /// The start of every main program.
    Start,
    /// The end of every main program.
    End,
    /// A word: `G80`, `M6`, `T`.
    Word(String),
}

/// The keys that name a program, each with the word that calls it (TF5200 Channel parameters).
const WORDS: [(&str, &str); 13] = [
    ("m6_prog_file", "M6"),
    ("t_prog_file", "T"),
    ("d_prog_file", "D"),
    ("g80_prog_file", "G80"),
    ("g81_prog_file", "G81"),
    ("g82_prog_file", "G82"),
    ("g83_prog_file", "G83"),
    ("g84_prog_file", "G84"),
    ("g85_prog_file", "G85"),
    ("g86_prog_file", "G86"),
    ("g87_prog_file", "G87"),
    ("g88_prog_file", "G88"),
    ("g89_prog_file", "G89"),
];

/// P-CHAN-00187.
const G800: &str = "g800_prog_file[]";

/// Limit on the macros, beyond any channel list; further ones are not kept.
const MAX_MACROS: usize = 4096;

/// A program that a channel list names.
#[derive(Debug, Clone)]
struct ListedProgram {
    number: &'static str,
    key: String,
    name: Given<String>,
}

/// A macro of a channel list.
#[derive(Debug, Clone, Default)]
struct Macro {
    /// `makro_def[i].symbol`, P-CHAN-00085.
    symbol: Option<Given<String>>,
    /// `makro_def[i].nc_code`, P-CHAN-00062.
    code: Option<Given<String>>,
}

/// The programs and macros of a channel list.
#[derive(Debug, Clone, Default)]
pub struct ChannelPrograms {
    named: BTreeMap<ProgramRole, ListedProgram>,
    macros: BTreeMap<u32, Macro>,
    /// Start and end programs that only run in manual block mode, with the key of the mode.
    manual: BTreeMap<ProgramRole, Given<bool>>,
    /// `einrechnen_mit_t`, P-CHAN-00014: a T word also has the effect of a D word.
    data_with_tool: Option<Given<bool>>,
}

impl ChannelPrograms {
    /// Collects the programs and macros that a list names.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut programs = Self::default();
        for entry in &list.entries {
            programs.add(entry, diagnostics);
        }
        programs
    }

    fn add(&mut self, entry: &Entry, diagnostics: &mut Vec<Diagnostic>) {
        let indices = entry.indices.as_slice();
        match (entry.pattern.as_str(), indices) {
            ("start_init_prog_file", []) => self.name(ProgramRole::Start, entry),
            ("final_prog_file", []) => self.name(ProgramRole::End, entry),
            ("start_init_prog_file_mode", []) => {
                diagnostics.extend(self.mode(ProgramRole::Start, entry));
            }
            ("final_prog_file_mode", []) => {
                diagnostics.extend(self.mode(ProgramRole::End, entry));
            }
            (G800, &[index]) if index < 200 => {
                self.name(ProgramRole::Word(format!("G{}", 800 + index)), entry);
            }
            ("einrechnen_mit_t", []) => {
                let given = entry.truth();
                let on = given.value;
                self.data_with_tool = on.map(|on| given.with(on)).or(self.data_with_tool.take());
            }
            ("makro_def[].symbol", &[index]) => {
                if let Some(place) = self.macro_at(index) {
                    place.symbol = Some(named(entry));
                }
            }
            ("makro_def[].nc_code", &[index]) => {
                if let Some(place) = self.macro_at(index) {
                    place.code = Some(named(entry));
                }
            }
            (key, []) => {
                let word = WORDS.iter().find(|(known, _)| *known == key);
                let word = word.map(|(_, word)| (*word).to_owned());
                if let Some(word) = word.or_else(|| numbered(key)) {
                    self.name(ProgramRole::Word(word), entry);
                }
            }
            _ => {}
        }
    }

    /// Sets a program; an empty name removes it.
    fn name(&mut self, role: ProgramRole, entry: &Entry) {
        let pattern = match numbered(&entry.pattern) {
            Some(_) => G800,
            None => &entry.pattern,
        };
        let named = ListedProgram {
            number: number_of(pattern),
            key: entry.key(),
            name: named(entry),
        };
        self.named.insert(role, named);
    }

    /// Returns the modes of operation in which a program runs, `AUTOMATIC | MDI` (P-CHAN-00260, P-CHAN-00433).
    fn mode(&mut self, role: ProgramRole, entry: &Entry) -> Option<Diagnostic> {
        let given = entry.text();
        let text = given.value.trim().trim_matches('"').to_ascii_uppercase();
        let modes: Vec<&str> = text.split('|').map(str::trim).collect();
        let is_known = modes
            .iter()
            .all(|mode| matches!(*mode, "" | "*" | "MDI" | "AUTOMATIC"));
        let is_manual = modes == ["MDI"];
        self.manual.insert(role, given.with(is_manual));
        (!is_known).then(|| odd(entry, "`AUTOMATIC`, `MDI` or `AUTOMATIC | MDI`"))
    }

    fn macro_at(&mut self, index: u32) -> Option<&mut Macro> {
        let is_room = self.macros.len() < MAX_MACROS || self.macros.contains_key(&index);
        is_room.then(|| self.macros.entry(index).or_default())
    }

    /// Replaces programs and macros by those of another list.
    pub fn override_with(&mut self, other: Self) {
        self.named.extend(other.named);
        self.manual.extend(other.manual);
        for (index, found) in other.macros {
            let kept = self.macros.entry(index).or_default();
            kept.symbol = found.symbol.or(kept.symbol.take());
            kept.code = found.code.or(kept.code.take());
        }
        self.data_with_tool = other.data_with_tool.or(self.data_with_tool.take());
    }

    /// Returns the programs with the events that run them.
    pub fn programs(&self) -> impl Iterator<Item = (&ProgramRole, &str)> {
        let named = self
            .named
            .iter()
            .map(|(role, named)| (role, &*named.name.value));
        let is_manual = |role| self.manual.get(role).is_some_and(|given| given.value);
        named.filter(move |(role, name)| !name.is_empty() && !is_manual(*role))
    }

    /// Returns the macros: name and code.
    pub fn macros(&self) -> impl Iterator<Item = (&str, &str)> {
        self.macros.values().filter_map(|found| {
            let symbol = found.symbol.as_ref()?;
            let code = found.code.as_ref()?;
            (!symbol.value.is_empty()).then_some((&*symbol.value, &*code.value))
        })
    }

    /// Returns whether a T word also has the effect of a D word.
    pub fn data_with_tool(&self) -> bool {
        self.data_with_tool
            .as_ref()
            .is_some_and(|given| given.value)
    }

    /// Returns the effective parameters, in the order of their keys, except those of roles set
    /// elsewhere.
    pub fn parameters(&self, elsewhere: &dyn Fn(&ProgramRole) -> bool) -> Vec<Parameter> {
        let row = |number, key: String, given: &Given<String>| Parameter {
            number,
            key,
            value: given.value.clone(),
            unit: "",
            origin: given.into(),
        };
        let named = self.named.iter().filter(|(role, _)| !elsewhere(role));
        let mut rows: Vec<_> = named
            .map(|(_, named)| row(named.number, named.key.clone(), &named.name))
            .collect();
        if let Some(given) = &self.data_with_tool {
            rows.push(Parameter {
                number: number_of("einrechnen_mit_t"),
                key: "einrechnen_mit_t".to_owned(),
                value: u8::from(given.value).to_string(),
                unit: "",
                origin: given.into(),
            });
        }
        for (index, found) in &self.macros {
            for (key, given) in [("symbol", &found.symbol), ("nc_code", &found.code)] {
                let number = number_of(&format!("makro_def[].{key}"));
                let key = format!("makro_def[{index}].{key}");
                rows.extend(given.as_ref().map(|given| row(number, key, given)));
            }
        }
        rows
    }
}

/// Returns the word of `g812_prog_file`, a form that some lists use for `g800_prog_file[12]`.
fn numbered(key: &str) -> Option<String> {
    let number = key.strip_prefix('g')?.strip_suffix("_prog_file")?;
    let number: u32 = number.parse().ok()?;
    (800..1000).contains(&number).then(|| format!("G{number}"))
}

/// Returns the text of an entry; the descriptions use `*` for an empty one.
fn named(entry: &Entry) -> Given<String> {
    let given = entry.text();
    let text = given.value.trim();
    let text = if text == "*" { "" } else { text };
    given.with(text.to_owned())
}
