//! The machine: its axes and their parameters, wherever they came from.

#[cfg(feature = "toml")]
mod advice;
mod assemble;
mod check;
#[cfg(feature = "toml")]
mod config;
mod described;
mod harmless;
mod load;
mod programs;
mod resolve;
#[cfg(feature = "toml")]
pub(crate) mod section;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use assemble::AxisReport;
pub use check::{AcceptedList, ListsReport, check_list};
#[cfg(feature = "toml")]
pub use config::ConfigError;
pub use harmless::HarmlessWords;
pub(crate) use programs::canonical_word;
pub use programs::{ConfiguredPrograms, Keeps};
pub use resolve::{ListFiles, NoList, NoLists};

use crate::comp::{AxisIndex, AxisSetup, CncBuild, Compensation, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, Levels};
pub use crate::lists::{AxisType, Origin};
use crate::lists::{FrictionList, Parameter};
use crate::text::Place;

/// Whether an axis has a friction value list that the control would take.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Parameterisation {
    /// No value list belongs to the axis.
    #[default]
    Missing,
    /// The list says mode 0, off.
    Off,
    /// The list was read and rejected with this code.
    Rejected {
        /// The list.
        file: String,
        /// The code of the first check that it failed.
        code: String,
    },
    /// The user said `--enable`: a list is assumed, its values are not known.
    Assumed,
    /// The list was accepted.
    Accepted(FrictionList),
}

/// One axis of the machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name in NC programs, case-sensitive.
    pub name: String,
    /// The logical axis number, P-AXIS-00016 (`kopf.achs_nr`).
    pub number: Option<u32>,
    /// The type.
    pub axis_type: AxisType,
    /// The kinds whose selector in the axis list is set; FRICT is P-AXIS-00522.
    pub configured: KindSet,
    /// Where P-AXIS-00522 came from.
    pub frict_comp_origin: Origin,
    /// The kinds that only the program activates and that fall off at program end (R1.40).
    pub manual: KindSet,
    /// The kinds that must be active while the axis moves, P-AXIS-00465 (R1.36).
    pub required: KindSet,
    /// The friction value list.
    pub friction: Parameterisation,
    /// The table size that was reserved at start-up, P-COMP-00062.
    pub max_points: u32,
    /// Where that size stands, or else the value list; `None` without a value list.
    pub max_points_place: Option<Place>,
    /// The maximum velocity in mm/min or °/min, where known.
    pub max_velocity: Option<f64>,
    /// The maximum acceleration in m/s² or °/s², where known.
    pub max_acceleration: Option<f64>,
    /// The maximum jerk in m/s³ or °/s³, where known.
    pub max_jerk: Option<f64>,
}

impl Axis {
    /// An axis with the documented defaults: P-AXIS-00522 is 0, no value list.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            number: None,
            axis_type: AxisType::Linear,
            configured: KindSet::NONE,
            frict_comp_origin: Origin::Default,
            manual: KindSet::NONE,
            required: KindSet::NONE,
            friction: Parameterisation::Missing,
            max_points: crate::lists::DEFAULT_MAX_POINTS,
            max_points_place: None,
            max_velocity: None,
            max_acceleration: None,
            max_jerk: None,
        }
    }

    /// The kinds that have what they need to work. Only the friction value list is read; the
    /// other kinds count as parameterised.
    pub fn parameterised(&self) -> KindSet {
        let mut kinds = KindSet::ALL;
        if !matches!(
            self.friction,
            Parameterisation::Accepted(_) | Parameterisation::Assumed
        ) {
            kinds.remove(Kind::Frict);
        }
        kinds
    }

    /// Compares the reserved table size with that of an earlier load in the same session. The
    /// control cannot change it later: it refuses the list and keeps the earlier one (R3.22).
    pub fn check_max_points(&self, earlier: u32) -> Option<Diagnostic> {
        let place = self.max_points_place.clone()?;
        if self.max_points == earlier {
            return None;
        }
        let number = match self.number {
            Some(number) => format!(" (axis number {number})"),
            None => String::new(),
        };
        let message = format!(
            "`{}` reserves {} points for axis `{}`{number}, at the start of the control it was \
             {earlier}: the list is not loaded, the earlier one remains in force",
            place.file, self.max_points, self.name
        );
        Some(
            Diagnostic::new(Code::PErr110641, place, message)
                .with_axis(&self.name)
                .with_help("`frict_comp.max_points` changes only with a restart of the control"),
        )
    }

    /// Whether it is a spindle.
    pub fn is_spindle(&self) -> bool {
        self.axis_type == AxisType::Spindle
    }

    /// Assumes P-AXIS-00522 = 1 and an accepted value list, as `--enable` does. A list that was
    /// accepted stays.
    pub fn enable(&mut self) {
        if !self.configured.contains(Kind::Frict) {
            self.configured.insert(Kind::Frict);
            self.frict_comp_origin = Origin::Assumed;
        }
        if !matches!(self.friction, Parameterisation::Accepted(_)) {
            self.friction = Parameterisation::Assumed;
        }
    }
}

/// Where the axes of a machine come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AxisSet {
    /// The configuration lists them; any other name is P-ERR-21947.
    #[default]
    Configured,
    /// Nothing is configured: X Y Z A B C U V W are taken as they occur (R2.20).
    AsTheyOccur,
}

/// A machine as far as NC programs see it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Machine {
    /// The axes, in the machine's order.
    pub axes: Vec<Axis>,
    /// Whether the configuration lists the axes.
    pub axis_set: AxisSet,
    /// The CNC cycle in milliseconds.
    pub cycle_time_ms: Option<f64>,
    /// The kernel version, where the user gave it.
    pub build: Option<CncBuild>,
    /// Programs that run by themselves or stand behind a word.
    pub programs: ConfiguredPrograms,
    /// Words of the shop that change nothing that is followed here.
    pub harmless: HarmlessWords,
    /// What a program start does to P parameters.
    pub parameters: Parameters,
}

/// What a program start does to P parameters (R2.33).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Parameters {
    /// They are cleared.
    #[default]
    Cleared,
    /// They keep what an earlier program wrote.
    Kept,
}

/// The value that the user gives to a variable that only the machine knows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

/// A machine and everything else that its configuration says.
#[derive(Debug, Clone, Default)]
pub struct Configuration {
    /// The machine.
    pub machine: Machine,
    /// The values of variables that only the machine knows.
    pub settings: Vec<(String, Setting)>,
    /// The user's severities; those of `diagnostics` follow them already.
    pub levels: Levels,
    /// The extensions of files that are programs, in lower case; empty for the usual ones.
    pub extensions: Vec<String>,
    /// The folders in which called programs are looked for, as written.
    pub program_dirs: Vec<String>,
    /// What the lists give reason to say.
    pub diagnostics: Vec<Diagnostic>,
    /// The lists that were read, as they are named in diagnostics, in the order of reading.
    pub files: Vec<Arc<str>>,
    /// How many lists are named and are not there.
    pub missing: usize,
    /// The effective parameters of each axis, in the order of [`Machine::axes`].
    pub reports: Vec<AxisReport>,
    /// The programs and macros that the configuration names, and where.
    pub programs: Vec<Parameter>,
}

impl Machine {
    /// The machine without any configuration: X Y Z A B C U V W with the documented defaults,
    /// taken as they occur (R2.20).
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

    /// The unconfigured machine with friction compensation assumed on some axes.
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

    /// Whether a configuration, a list or `--enable` says anything about friction compensation.
    /// Without, every axis has the documented default (R1.37).
    pub fn is_described(&self) -> bool {
        let given = |axis: &Axis| axis.frict_comp_origin != Origin::Default;
        self.axis_set == AxisSet::Configured || self.axes.iter().any(given)
    }

    /// The state of all compensations after a start of the control.
    pub fn compensation(&self) -> Compensation {
        Compensation::at_startup(self.axis_setups())
    }

    /// The axes as the compensation sees them.
    pub(crate) fn axis_setups(&self) -> impl Iterator<Item = AxisSetup> {
        self.axes.iter().map(|axis| {
            let mut setup = AxisSetup::new(&axis.name, axis.configured);
            setup.is_spindle = axis.is_spindle();
            setup.manual = axis.manual;
            setup.parameterised = axis.parameterised();
            setup
        })
    }

    /// The position of an axis by its name.
    pub fn find(&self, name: &str) -> Option<AxisIndex> {
        self.axes
            .iter()
            .position(|axis| axis.name == name)
            .map(AxisIndex::new)
    }

    /// An axis by its position.
    pub fn axis(&self, index: AxisIndex) -> &Axis {
        &self.axes[index.get()]
    }
}
