//! Meaning of axis names on a path: the axes of the machine, until the program exchanges them (TF5200 programming
//! manual, 206977419 and its neighbours).
//!
//! An axis that is given back keeps its compensation: what another channel does with it is reported when the programs of
//! that channel are checked.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;
use crate::interpreter::motion::modal::Modal;
use crate::language::MembersBy;
use crate::machine::Machine;
use crate::syntax::ast::{Argument, BracketArguments};

/// The axes of a machine by their names.
#[derive(Debug, Clone, Default)]
pub(crate) struct AxisNames {
    letters: [Option<AxisIndex>; 26],
    longer: BTreeMap<String, AxisIndex>,
}

impl AxisNames {
    pub(crate) fn of(machine: &Machine) -> Self {
        let mut names = Self::default();
        // A spindle is not an axis that coordinates move.
        let axes = machine.axes.iter().enumerate();
        for (position, axis) in axes.filter(|(_, axis)| !axis.is_spindle()) {
            let index = AxisIndex::new(position);
            match axis.name.as_bytes() {
                [letter @ b'A'..=b'Z'] => names.letters[usize::from(letter - b'A')] = Some(index),
                _ => {
                    names.longer.insert(axis.name.clone(), index);
                }
            }
        }
        names
    }

    #[inline]
    pub(crate) fn letter(&self, letter: u8) -> Option<AxisIndex> {
        self.letters[usize::from(letter - b'A')]
    }

    pub(crate) fn get(&self, name: &str) -> Option<AxisIndex> {
        match name.as_bytes() {
            [letter @ b'A'..=b'Z'] => self.letter(*letter),
            _ => self.longer.get(name).copied(),
        }
    }
}

/// The axes that names mean at a block, where that is known.
#[derive(Clone, Copy)]
pub(crate) struct AxisLookup<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) own: &'a AxisNames,
    pub(crate) channel: &'a ChannelAxes,
}

impl AxisLookup<'_> {
    /// Returns an axis or spindle by its name.
    pub(crate) fn any(self, name: &str) -> Option<AxisIndex> {
        match self.channel.meaning(name) {
            None => self.machine.find(name),
            Some(meaning) => meaning.axis(),
        }
    }

    /// Returns an axis by its name.
    pub(crate) fn named(self, name: &str) -> Option<AxisIndex> {
        match self.channel.meaning(name) {
            None => self.own.get(name),
            Some(meaning) => meaning.axis(),
        }
    }

    /// Returns an axis by its letter.
    pub(crate) fn letter(self, letter: u8) -> Option<AxisIndex> {
        self.named(char::from(letter).encode_utf8(&mut [0; 4]))
    }

    /// Returns the axis that `@X` means in the plane in force.
    pub(crate) fn main(self, letter: u8, modal: &Modal) -> Option<AxisIndex> {
        self.letter(modal.main_axis(letter)?)
    }

    /// Returns every axis and spindle.
    pub(crate) fn all(self) -> impl Iterator<Item = AxisIndex> + use<> {
        (0..self.machine.axes.len()).map(AxisIndex::new)
    }

    /// Returns every axis that words can move.
    pub(crate) fn path(self) -> Vec<AxisIndex> {
        let is_path = |axis: &AxisIndex| !self.machine.axis(*axis).is_spindle();
        self.all().filter(is_path).collect()
    }

    /// Returns the axes among X, Y and Z that the machine has.
    pub(crate) fn xyz(self) -> Vec<AxisIndex> {
        let letters = [b'X', b'Y', b'Z'].map(|it| self.letter(it));
        letters.into_iter().flatten().collect()
    }

    /// Returns the axes of the active plane; all main axes where it is not known.
    pub(crate) fn plane(self, modal: &Modal) -> Vec<AxisIndex> {
        match [b'X', b'Y'].map(|it| self.main(it, modal)) {
            [Some(first), Some(second)] => vec![first, second],
            _ => self.xyz(),
        }
    }

    /// Returns the axes that a command names.
    pub(crate) fn given(self, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
        let words = arguments.words(text);
        words.filter_map(|word| self.any(word)).collect()
    }

    /// Returns the axes that a command names, or else all.
    pub(crate) fn given_or_all(self, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
        let named = self.given(arguments, text);
        if named.is_empty() {
            self.all().collect()
        } else {
            named
        }
    }

    /// Returns the pairs of axes that a definition of a coupling group names, slave and master: `[1, X = Y]`, or
    /// `[1, 8 = 2]` by their logical numbers. An axis whose partner the machine does not have stands twice. `None`
    /// where a number may be that of an axis without a known one.
    pub(crate) fn members(
        self,
        by: MembersBy,
        arguments: &BracketArguments,
        text: &str,
    ) -> Option<Vec<AxisIndex>> {
        let has_unnumbered = || {
            let mut all = self.all();
            all.any(|axis| self.machine.axis(axis).number.is_none())
        };
        let mut members = Vec::new();
        for pair in arguments.pairs(text) {
            let pair = pair.map(|name| match by {
                MembersBy::Name => self.any(name),
                MembersBy::Number => self.machine.axis_numbered(name.parse().ok()?),
            });
            if by == MembersBy::Number && pair.contains(&None) && has_unnumbered() {
                return None;
            }
            let known = pair.into_iter().flatten().chain(pair.into_iter().flatten());
            members.extend(known.take(2));
        }
        Some(members)
    }

    /// Returns the axis that an argument gives by its name or its logical number.
    pub(crate) fn argument(self, argument: &Argument, text: &str) -> Option<AxisIndex> {
        let number = argument.logical_number(text);
        let by_number = || self.machine.axis_numbered(number?);
        self.any(argument.span.of(text)).or_else(by_number)
    }

    /// Returns whether a name is that of the main spindle (P-CHAN-00053).
    pub(crate) fn is_main_spindle(self, name: &str) -> bool {
        let main = &self.machine.channel.main_spindle;
        name == "S" || main.iter().any(|main| main == name)
    }
}

/// The changes that the program made to the names of the channel's axes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ChannelAxes {
    names: BTreeMap<String, AxisNameMeaning>,
    /// Whether the meaning of every name is unknown.
    doubtful: bool,
}

/// Meaning of an axis name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum AxisNameMeaning {
    /// Axis of the machine, possibly under another name.
    Axis(AxisIndex),
    /// An axis that the channel has given back.
    Released(Option<AxisIndex>),
    /// Some axis.
    Unknown,
}

impl AxisNameMeaning {
    fn axis(self) -> Option<AxisIndex> {
        match self {
            Self::Axis(axis) => Some(axis),
            Self::Released(_) | Self::Unknown => None,
        }
    }
}

/// Axis that a COMP command switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Addressed {
    /// Known axis.
    Axis(AxisIndex),
    /// Axis that the channel does not have; the control refuses it.
    Absent(Option<AxisIndex>),
    /// Any of them.
    Any,
}

impl ChannelAxes {
    /// Returns whether every name means the axis of the machine.
    #[inline]
    pub(crate) fn are_own(&self) -> bool {
        self.names.is_empty() && !self.doubtful
    }

    /// Returns whether the meaning of every name is unknown.
    pub(crate) fn is_doubtful(&self) -> bool {
        self.doubtful
    }

    /// Returns the meaning of a name; `None` where it means the axis of the machine, or none.
    pub(crate) fn meaning(&self, name: &str) -> Option<AxisNameMeaning> {
        if self.doubtful {
            return Some(AxisNameMeaning::Unknown);
        }
        self.names.get(name).copied()
    }

    /// Returns the meaning of a name, that of the machine included.
    pub(crate) fn meaning_on(&self, machine: &Machine, name: &str) -> Option<AxisNameMeaning> {
        let own = || machine.find(name).map(AxisNameMeaning::Axis);
        self.meaning(name).or_else(own)
    }

    /// Returns whether the program has changed what a name means.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.names.contains_key(name)
    }

    /// Makes the axes of the channel unknown, since some may have been exchanged.
    pub(crate) fn havoc(&mut self) {
        self.doubtful = true;
    }

    /// Gives the channel an axis under a name; `None` for one that is not known.
    pub(crate) fn request(&mut self, machine: &Machine, name: &str, axis: Option<AxisIndex>) {
        let is_own = |axis: AxisIndex| {
            Some(axis) == machine.find(name) && machine.axis(axis).channels.numbers().is_none()
        };
        if axis.is_some_and(is_own) {
            self.names.remove(name);
        } else {
            let meaning = axis.map_or(AxisNameMeaning::Unknown, AxisNameMeaning::Axis);
            self.names.insert(name.to_owned(), meaning);
        }
    }

    /// Takes an axis from the channel; the control does not mind where it does not have it.
    pub(crate) fn release(&mut self, machine: &Machine, name: &str) {
        let own = machine.find(name).map(AxisNameMeaning::Axis);
        let released = match self.names.get(name).copied().or(own) {
            Some(AxisNameMeaning::Axis(axis)) => Some(axis),
            Some(AxisNameMeaning::Unknown) => None,
            Some(AxisNameMeaning::Released(_)) | None => return,
        };
        self.names
            .insert(name.to_owned(), AxisNameMeaning::Released(released));
    }

    /// Takes every axis from the channel but those of these names. Returns how many names it went through.
    pub(crate) fn release_others(&mut self, machine: &Machine, stay: &[&str]) -> usize {
        let is_here =
            |name: &str| !matches!(self.names.get(name), Some(AxisNameMeaning::Released(_)));
        let own = machine.axes.iter().map(|axis| &axis.name);
        let gone: BTreeSet<String> = own
            .chain(self.names.keys())
            .filter(|name| is_here(name) && !stay.contains(&name.as_str()))
            .cloned()
            .collect();
        let count = machine.axes.len() + self.names.len();
        for name in &gone {
            self.release(machine, name);
        }
        count
    }

    /// Returns whether the channel gave an axis away and does not have it under any name.
    pub(crate) fn has_released(&self, axis: AxisIndex) -> bool {
        let released = AxisNameMeaning::Released(Some(axis));
        self.names.values().any(|meaning| *meaning == released)
    }

    /// Returns whether all axes that it names are below a number.
    pub(crate) fn fits(&self, count: usize) -> bool {
        self.names.values().all(|meaning| match meaning {
            AxisNameMeaning::Axis(axis) | AxisNameMeaning::Released(Some(axis)) => {
                axis.get() < count
            }
            AxisNameMeaning::Released(None) | AxisNameMeaning::Unknown => true,
        })
    }

    /// Merges the names of another way through the program, which may be in force instead.
    pub(crate) fn join(&mut self, other: &Self) {
        self.doubtful |= self != other;
    }
}
