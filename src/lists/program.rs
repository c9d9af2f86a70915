//! The programs and macros that a channel list names (R2.75).

use std::collections::BTreeMap;

use super::channel_keys::number_of;
use super::channel_settings::odd;
use super::entry::{Entry, Given};
use super::line::Entries;
use super::parameter::Parameter;
use crate::diagnostic::Diagnostic;

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

/// More macros than any channel list has; further ones are not kept.
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
                    place.symbol = Some(text(entry));
                }
            }
            ("makro_def[].nc_code", &[index]) => {
                if let Some(place) = self.macro_at(index) {
                    place.code = Some(text(entry));
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
            name: text(entry),
        };
        self.named.insert(role, named);
    }

    /// The modes of operation in which a program runs, `AUTOMATIC | MDI` (P-CHAN-00260, P-CHAN-00433).
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

    /// Whether a T word also has the effect of a D word.
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
fn text(entry: &Entry) -> Given<String> {
    let given = entry.text();
    let text = given.value.trim();
    let text = if text == "*" { "" } else { text };
    given.with(text.to_owned())
}
