//! A machine as NC programs see it, also where nobody described it (R9.73), and the commands of it that its user declares harmless
//! (R2.70).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::axis::Axis;
use super::programs::ConfiguredPrograms;
use crate::comp::{AxisIndex, AxisSetup, CncBuild, Compensation, KindSet};
use crate::diagnostic::NamedFix;
use crate::language::GFunction;
use crate::lists::{ChannelSettings, Origin};
use crate::readings::{Question, Readings};
use crate::syntax::{AxisUse, SkipLevels, axis_uses, hash_name};
use crate::text::in_a_row;

/// Origin of the axes of a machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum AxisSet {
    /// The configuration lists them; any other name raises P-ERR-21947.
    #[default]
    Configured,
    /// No configuration: X Y Z A B C U V W are added as they occur (R2.20).
    AsTheyOccur,
}

/// A machine as NC programs see it.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Machine {
    /// The axes, in the machine's order.
    pub axes: Vec<Axis>,
    /// Origin of the axes: the configuration, or their occurrence.
    pub axis_set: AxisSet,
    /// Whether start-up lists of the control name the axes, and all of them were read: a word of any other axis is then
    /// reported (R2.94).
    pub axes_are_listed: bool,
    /// The change to the configuration that adds an axis, if it lists the axes and no list of the control does.
    pub one_more_axis: Option<NamedFix>,
    /// The slaves of static gantries, which programs cannot use (R1.43).
    pub gantry_slaves: Vec<GantrySlave>,
    /// The CNC cycle in milliseconds.
    pub cycle_time_ms: Option<f64>,
    /// The kernel version, if the user gave it.
    pub build: Option<CncBuild>,
    /// Programs that run by themselves or are called by a word.
    pub programs: ConfiguredPrograms,
    /// Commands of the user's own machine that change nothing that frictcomp tracks.
    pub harmless: HarmlessWords,
    /// Effect of a program start on P parameters.
    pub parameters: Parameters,
    /// The skip levels that are on, if the configuration gives them (R2.90).
    pub skip: Option<SkipLevels>,
    /// The variables of the machine that keep their values while a program runs (R14.1).
    pub stable: Vec<String>,
    /// The `V.E.` variables that only programs write (R2.99).
    pub own: Vec<String>,
    /// Settings of motion from the channel list.
    pub channel: ChannelSettings,
    /// Selected readings of the open questions.
    pub readings: Readings,
}

/// An axis that follows another one in the position controller, P-AXIS-00070 (R1.43).
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct GantrySlave {
    /// Name, if its list gives one.
    pub name: String,
    /// The name of its master; `None` if no list describes the master.
    pub master: Option<String>,
}

/// Effect of a program start on P parameters (R2.33).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Parameters {
    /// Parameters are cleared.
    #[default]
    Cleared,
    /// Parameters keep the values that an earlier program wrote.
    Kept,
}

impl Machine {
    /// Returns the machine without any configuration: X Y Z A B C U V W with the documented defaults, added as they
    /// occur (R2.20).
    pub fn unconfigured() -> Self {
        Self {
            axes: ["X", "Y", "Z", "A", "B", "C", "U", "V", "W"]
                .into_iter()
                .map(Axis::new)
                .collect(),
            axis_set: AxisSet::AsTheyOccur,
            ..Self::default()
        }
    }

    /// Returns the unconfigured machine with friction compensation assumed on some axes.
    pub fn enabled<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let mut machine = Self::unconfigured();
        for name in names {
            machine.enable(name);
        }
        machine
    }

    /// Assumes friction compensation on an axis, see [`Axis::enable`]. Returns whether the
    /// machine has the axis; an unconfigured machine gets it.
    pub fn enable(&mut self, name: &str) -> bool {
        if let Some(axis) = self.axes.iter_mut().find(|axis| axis.name == name) {
            axis.enable();
            return true;
        }
        let admitted = self.axis_set == AxisSet::AsTheyOccur;
        if admitted {
            let mut axis = Axis::new(name);
            axis.enable();
            self.axes.push(axis);
        }
        admitted
    }

    /// Returns whether anything describes the machine: a configuration that lists its axes, or an assumption about one
    /// of them (R1.37).
    pub fn is_described(&self) -> bool {
        self.axis_set == AxisSet::Configured || self.axes.iter().any(Axis::is_described)
    }

    /// Returns the axes on which a line of `frictcomp.toml` assumes friction compensation, with its file and number: every
    /// verdict about them rests on it (R18.2).
    pub fn enabled_axes(&self) -> impl Iterator<Item = (&Axis, &str, u32)> {
        self.axes
            .iter()
            .filter_map(|axis| match &axis.frict_comp_origin {
                Origin::Enabled { file, line } => Some((axis, file.as_str(), *line)),
                _ => None,
            })
    }

    /// Returns the assumptions about friction compensation in words, with the lines or the axes; `None` without any.
    pub fn assumption(&self) -> Option<String> {
        let lines = self.enabled_axes();
        let lines = lines.map(|(axis, file, line)| format!("{file}:{line} ({})", axis.name));
        let lines: Vec<String> = lines.collect();
        let lines = (!lines.is_empty()).then(|| format!("`enable = true`, {}", lines.join(", ")));
        let axes = self.axes.iter();
        let axes = axes.filter(|axis| matches!(axis.frict_comp_origin, Origin::Assumed));
        let axes: Vec<&str> = axes.map(|axis| axis.name.as_str()).collect();
        let axes =
            (!axes.is_empty()).then(|| format!("friction compensation on {}", in_a_row(&axes)));
        let all: Vec<String> = lines.into_iter().chain(axes).collect();
        (!all.is_empty()).then(|| format!("assuming {}", all.join(", and ")))
    }

    /// Returns the state of all compensations after a start of the control.
    pub fn compensation(&self) -> Compensation {
        let mut compensation = Compensation::at_startup(self.axis_setups());
        if self.readings.takes_second(Question::ManualActivation) {
            for (at, axis) in self.axes.iter().enumerate() {
                compensation.restore(AxisIndex::new(at), axis.configured, KindSet::NONE);
            }
        }
        compensation
    }

    /// Returns the properties of the axes that matter to compensation.
    pub(crate) fn axis_setups(&self) -> impl Iterator<Item = AxisSetup> {
        self.axes.iter().map(|axis| {
            let mut setup = AxisSetup::new(&axis.name, axis.configured);
            setup.unselected = setup.unselected.union(axis.unselected);
            setup.is_spindle = axis.is_spindle();
            setup.manual = axis.manual;
            setup.parameterised = axis.parameterised();
            setup
        })
    }

    /// Returns the position of an axis by its name.
    pub fn find(&self, name: &str) -> Option<AxisIndex> {
        self.axes
            .iter()
            .position(|axis| axis.name == name)
            .map(AxisIndex::new)
    }

    /// Returns the axis with a logical number.
    pub(crate) fn axis_numbered(&self, number: u32) -> Option<AxisIndex> {
        let mut axes = self.axes.iter();
        let found = axes.position(|axis| axis.number == Some(number));
        found.map(AxisIndex::new)
    }

    /// Returns an axis by its position.
    pub fn axis(&self, index: AxisIndex) -> &Axis {
        &self.axes[index.get()]
    }
}

/// The user's value of a variable that only the machine knows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl Setting {
    /// Returns whether a name is that of a variable or a parameter, which can have a value (R2.33, R2.34).
    pub fn is_for(name: &str) -> bool {
        let number = name.strip_prefix('@').unwrap_or(name);
        let number = number.strip_prefix(['P', 'p']);
        if let Some(number) = number {
            return number.starts_with(|it: char| it.is_ascii_digit());
        }
        name.strip_prefix("V.")
            .or_else(|| name.strip_prefix("v."))
            .is_some_and(|rest| rest.starts_with(|it: char| it.is_ascii_alphabetic()))
    }
}

/// Knowledge about a machine that is not described.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Outline {
    /// The path of its start-up list, as a configuration would write it.
    Startup(String),
    /// The path of the TwinCAT project that holds its lists.
    Project(String),
    /// Use of axes by its programs.
    Programs(BTreeMap<String, AxisUse>),
}

impl Outline {
    /// Collects the axes that programs use, executed or not.
    pub fn of_programs(texts: impl IntoIterator<Item = String>) -> Self {
        let mut uses: BTreeMap<String, AxisUse> = BTreeMap::new();
        for (name, how) in texts.into_iter().flat_map(|text| axis_uses(&text)) {
            let known = uses.entry(name).or_insert(how);
            *known = how.max(*known);
        }
        Self::Programs(uses)
    }

    /// Returns the axes in the usual order, longer names last; none if a start-up list names them.
    pub fn axes(&self) -> Vec<(&str, AxisUse)> {
        const USUAL: &str = "XYZABCUVW";
        let Self::Programs(uses) = self else {
            return Vec::new();
        };
        let mut axes: Vec<_> = uses
            .iter()
            .map(|(name, how)| (name.as_str(), *how))
            .collect();
        axes.sort_by_key(|(name, _)| (name.len() > 1, USUAL.find(name)));
        axes
    }
}

/// `#` commands, G and M functions that change no state, no position and no value.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HarmlessWords {
    /// `#MYCMD ON`, in upper case with one blank between the words.
    commands: Vec<String>,
    /// The letters and numbers of the functions.
    functions: Vec<(u8, i64)>,
}

impl HarmlessWords {
    /// Adds a word; `false` if it is neither a `#` command nor a G or M function.
    pub fn add(&mut self, word: &str) -> bool {
        let word = word.trim();
        let is_command = word
            .strip_prefix('#')
            .is_some_and(|rest| rest.starts_with(|letter: char| letter.is_ascii_alphabetic()));
        if is_command {
            let (name, length) = hash_name(word);
            self.commands.push(name);
            return length == word.len();
        }
        let letter = word
            .bytes()
            .next()
            .map(|letter| letter.to_ascii_uppercase());
        let Some(letter @ (b'G' | b'M')) = letter else {
            return false;
        };
        let digits = &word[1..];
        let number = digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = number.then(|| digits.parse().ok()).flatten();
        let number = number.filter(|number| letter == b'M' || !is_followed(*number));
        self.functions.extend(number.map(|number| (letter, number)));
        number.is_some()
    }

    /// Returns whether a text begins with one of these `#` commands; a command includes all longer ones that begin with
    /// it.
    pub fn has_command(&self, text: &str) -> bool {
        if self.commands.is_empty() || !text.starts_with('#') {
            return false;
        }
        let (name, _) = hash_name(text);
        self.commands.iter().any(|known| {
            let rest = name.strip_prefix(known.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
        })
    }

    /// Returns whether a G or M function is one of them.
    pub(crate) fn has_function(&self, letter: u8, number: i64) -> bool {
        self.functions.contains(&(letter, number))
    }

    /// Returns all of them as written.
    pub fn words(&self) -> impl Iterator<Item = String> {
        let functions = self.functions.iter();
        let functions =
            functions.map(|(letter, number)| format!("{}{number}", char::from(*letter)));
        self.commands.iter().cloned().chain(functions)
    }
}

/// Returns whether a G function takes effect in a dry run, so that it cannot be declared harmless.
fn is_followed(number: i64) -> bool {
    let function = u32::try_from(number).ok().and_then(GFunction::of);
    function.is_some_and(GFunction::is_followed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_come_in_the_usual_order() {
        // R9.73
        let texts = ["G0 C1 Z2 X2=3", "X[COMP OFF FRICT]\nX1 M30"].map(str::to_owned);
        let outline = Outline::of_programs(texts);
        let expected = [
            ("X", AxisUse::Switched),
            ("Z", AxisUse::Named),
            ("C", AxisUse::Named),
            ("X2", AxisUse::Named),
        ];
        assert_eq!(outline.axes(), expected);
        assert!(Outline::Startup("h.lis".to_owned()).axes().is_empty());
    }
}
