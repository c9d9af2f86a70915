//! One axis with its parameters, and static gantries: axes that follow others in the position controller (R1.43).
//!
//! The channel does not know the slave (TF5200 Gantry operation, 285764875, P-AXIS-00070).
//! An axis is assembled from the lists and `frictcomp.toml`, with the checks that need both the axis list and the value list (R3.14,
//! R3.27, R3.30).

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::channels::ChannelsOfAxis;
use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Advice, Code, Diagnostic, Fix};
use crate::drive_interface::{Evidence, ListedDrive, TorqueScale, check_drive};
use crate::lists::{
    AxisType, AxisValues, Conditions, DEFAULT_MAX_POINTS, Entries, Entry, Field, FrictionDraft,
    FrictionList, Given, ListedDynamics, Origin, Parameter, Verdict,
};
use crate::text::Place;

/// Existence of a friction value list for an axis that the control would accept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Parameterisation {
    /// No value list for the axis.
    #[default]
    Missing,
    /// List with mode 0, off.
    Off,
    /// List that was read and rejected with this code.
    Rejected {
        /// Path of the list.
        file: String,
        /// The code of the first check that it failed.
        code: String,
    },
    /// The user assumes a list; its values are not known.
    Assumed,
    /// List that was accepted.
    Accepted(FrictionList),
}

/// One axis of the machine.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Axis {
    /// The name in NC programs, case-sensitive.
    pub name: String,
    /// The logical axis number, P-AXIS-00016 (`kopf.achs_nr`).
    pub number: Option<u32>,
    /// The type.
    pub axis_type: AxisType,
    /// The kinds whose selector in the axis list is set; FRICT is P-AXIS-00522.
    pub configured: KindSet,
    /// The kinds that the lists of the control are known not to select (R1.41, R18.2); empty if none describes the axis.
    pub unselected: KindSet,
    /// Origin of the name; the default where no configuration lists the axes.
    pub name_origin: Origin,
    /// Origin of P-AXIS-00522.
    pub frict_comp_origin: Origin,
    /// The change to the axis list that sets P-AXIS-00522, if there is a list that does not set it.
    pub configuring: Option<Fix>,
    /// The kinds that only the program activates and that switch off at program end (R1.40).
    pub manual: KindSet,
    /// The kinds that must be active while the axis moves, P-AXIS-00465 (R1.36). The control monitors the configured
    /// ones.
    pub required: KindSet,
    /// The friction value list.
    pub friction: Parameterisation,
    /// The table size that was reserved at start-up, P-COMP-00062.
    pub max_points: u32,
    /// Place of that size, else of the value list; `None` without a value list.
    pub max_points_place: Option<Place>,
    /// The maximum velocity in mm/min or °/min, if known.
    pub max_velocity_per_min: Option<f64>,
    /// The maximum acceleration in m/s² or °/s², if known.
    pub max_acceleration_per_s2: Option<f64>,
    /// The maximum jerk in m/s³ or °/s³, if known.
    pub max_jerk_per_s3: Option<f64>,
    /// The way in mm in a turn of the motor, for recordings of the motor.
    pub motor_lead_mm: Option<f64>,
    /// Velocity, acceleration and ramp times from the axis list; values in `frictcomp.toml` take precedence.
    pub listed: ListedDynamics,
    /// The factor for the torque to the drive, P-AXIS-00325 and P-AXIS-00326.
    pub torque_scale: TorqueScale,
    /// The channels that have the axis.
    pub channels: ChannelsOfAxis,
    /// Whether the lists of the control give it the index 0, 1 or 2 in its channel: a main axis.
    pub(crate) is_main: bool,
}

impl Axis {
    /// Creates an axis with the documented defaults: P-AXIS-00522 is 0, no value list.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            name_origin: Origin::Default,
            number: None,
            axis_type: AxisType::Linear,
            configured: KindSet::NONE,
            unselected: KindSet::NONE,
            frict_comp_origin: Origin::Default,
            configuring: None,
            manual: KindSet::NONE,
            required: KindSet::NONE,
            friction: Parameterisation::Missing,
            max_points: DEFAULT_MAX_POINTS,
            max_points_place: None,
            max_velocity_per_min: None,
            max_acceleration_per_s2: None,
            max_jerk_per_s3: None,
            motor_lead_mm: None,
            listed: ListedDynamics::default(),
            torque_scale: TorqueScale::default(),
            channels: ChannelsOfAxis::default(),
            is_main: false,
        }
    }

    /// Returns the kinds without which the control refuses a motion of the axis (R1.36).
    pub fn monitored(&self) -> KindSet {
        self.required.intersection(self.configured)
    }

    /// Returns the kinds that have all they need to work. Only the friction value list is read; the other kinds count
    /// as parameterised.
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
            "`{}` sets `frict_comp.max_points` to {} for axis `{}`{number}, but it was {earlier} at the start of \
             the control; the list is not loaded, and the earlier one stays in force",
            place.file, self.max_points, self.name
        );
        Some(
            Diagnostic::new(Code::PErr110641, place, message)
                .with_axis(&self.name)
                .with_help("`frict_comp.max_points` changes only with a restart of the control"),
        )
    }

    /// Returns whether it is a spindle.
    pub fn is_spindle(&self) -> bool {
        self.axis_type == AxisType::Spindle
    }

    /// Returns whether a list that was read, or the user, says what P-AXIS-00522 is. Otherwise the documented default
    /// takes its place, and what a command to the axis does is not known (R1.37, R18.2). A spindle has no friction
    /// compensation.
    pub fn is_described(&self) -> bool {
        self.is_spindle()
            || self.frict_comp_origin != Origin::Default
            || self.unselected.contains(Kind::Frict)
    }

    /// Returns the advice to describe the axis, of which nothing is said (R18.2).
    pub(crate) fn describing(&self) -> Advice {
        let name = &self.name;
        let (place, where_to) = match &self.name_origin {
            Origin::File { file, line } => {
                (format!(" ({file}, line {line}, only names it)"), "there")
            }
            _ => (String::new(), "in `frictcomp.toml`"),
        };
        let words = format!(
            "nothing describes axis `{name}`{place}, so that its P-AXIS-00522 (lr_param.frict_comp) counts as 0; write \
             `frict_comp = true` or `frict_comp = false` {where_to}"
        );
        words.into()
    }

    /// Assumes P-AXIS-00522 = 1 and an accepted value list. A list that was actually accepted is kept.
    pub fn enable(&mut self) {
        self.assume(Origin::Assumed);
    }

    /// Assumes it, see [`enable`](Self::enable), as asked for at an origin.
    pub(super) fn assume(&mut self, origin: Origin) {
        if !self.configured.contains(Kind::Frict) {
            self.configured.insert(Kind::Frict);
            self.frict_comp_origin = origin;
        }
        if !matches!(self.friction, Parameterisation::Accepted(_)) {
            self.friction = Parameterisation::Assumed;
        }
    }

    /// Shows an assumed P-AXIS-00522 among the parameters of the axis.
    pub fn show_assumed(&self, parameters: &mut [Parameter]) {
        if !self.frict_comp_origin.is_assumed() {
            return;
        }
        let selector = Kind::Frict.facts().parameter;
        for row in parameters.iter_mut().filter(|row| row.number == selector) {
            "1".clone_into(&mut row.value);
            row.origin = self.frict_comp_origin.clone();
        }
    }
}

/// The head and the friction parameters of one value list.
#[derive(Debug, Clone, Default)]
pub(super) struct ValueList {
    pub(super) head: AxisValues,
    pub(super) friction: FrictionDraft,
}

impl ValueList {
    pub(super) fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        Self {
            head: AxisValues::from_entries(list, diagnostics),
            friction: FrictionDraft::from_entries(list, diagnostics),
        }
    }
}

/// Returns FC140 if the friction compensation of a slave differs from that of its master. `link` is
/// P-AXIS-00070 of the slave.
pub(super) fn compare_gantry(master: &Axis, slave: &Axis, link: &Given<u32>) -> Option<Diagnostic> {
    let difference = difference(master, slave)?;
    let message = format!(
        "{} is the static gantry slave of `{}`, but {difference}",
        named(slave),
        master.name
    );
    Some(
        Diagnostic::new(Code::Fc140, link.place(), message)
            .with_axis(slave.name.clone())
            .with_help("both axes make the same motion: compare what each of them needs"),
    )
}

/// Returns the name of a slave, else its number.
fn named(slave: &Axis) -> String {
    match slave.number {
        _ if !slave.name.is_empty() => format!("`{}`", slave.name),
        Some(number) => format!("axis {number}"),
        None => "this axis".to_owned(),
    }
}

/// Returns the difference between two axes, if either has friction compensation.
fn difference(master: &Axis, slave: &Axis) -> Option<String> {
    let is_on = |axis: &Axis| axis.configured.contains(Kind::Frict);
    match (is_on(master), is_on(slave)) {
        (false, false) => None,
        (true, false) => Some("P-AXIS-00522 is 1 on the master only".to_owned()),
        (false, true) => Some("P-AXIS-00522 is 1 on the slave only".to_owned()),
        (true, true) => values(&master.friction, &slave.friction),
    }
}

/// Returns the difference between the value lists of two configured axes.
fn values(master: &Parameterisation, slave: &Parameterisation) -> Option<String> {
    use Parameterisation::Accepted;
    match (master, slave) {
        (Accepted(master), Accepted(slave)) => {
            let keys = differing(master, slave);
            let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
            (!keys.is_empty()).then(|| format!("their value lists differ in {}", keys.join(", ")))
        }
        (Accepted(_), _) => Some("only the master has a value list that is accepted".to_owned()),
        (_, Accepted(_)) => Some("only the slave has a value list that is accepted".to_owned()),
        _ => None,
    }
}

/// Returns the keys of the values that differ.
fn differing(one: &FrictionList, other: &FrictionList) -> Vec<&'static str> {
    let checks = [
        ("table", one.table == other.table),
        ("scaling_factor", one.scaling_factor == other.scaling_factor),
        ("position_delay", one.position_delay == other.position_delay),
        (
            "reversal_lookahead",
            one.reversal_lookahead == other.reversal_lookahead,
        ),
        ("delay_cycles", one.delay_cycles == other.delay_cycles),
    ];
    let unlike = checks.into_iter().filter(|(_, same)| !same);
    unlike.map(|(key, _)| key).collect()
}

/// The effective parameters of one axis.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisReport {
    /// The name in NC programs; empty if a list is checked by itself and names no axis.
    pub axis: String,
    /// The type of the axis.
    pub axis_type: AxisType,
    /// The parameters in the order of the lists.
    pub parameters: Vec<Parameter>,
    /// The entries of the drive by their keys: `antr.*`, its type and its torque offset.
    #[serde(skip)]
    pub drive: BTreeMap<String, Entry>,
    /// P-AXIS-00522, if a list gives it.
    #[serde(skip)]
    pub selector: Option<Given<bool>>,
    /// Whether an axis list of the control describes the axis.
    #[serde(skip)]
    pub is_listed: bool,
}

impl AxisReport {
    /// Returns the statements of the lists about the drive of the axis, with the
    /// value list that the control accepts.
    pub fn listed_drive<'a>(&'a self, friction: Option<&'a FrictionList>) -> ListedDrive<'a> {
        ListedDrive {
            axis: &self.axis,
            entries: &self.drive,
            selector: self.selector.as_ref(),
            friction,
        }
    }
}

/// Dynamics of an axis in `frictcomp.toml`, in its units.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ConfiguredDynamics {
    pub(super) velocity: Option<f64>,
    pub(super) acceleration: Option<f64>,
    pub(super) jerk: Option<f64>,
    /// The way in mm in a turn of the motor.
    pub(super) lead: Option<f64>,
}

/// One axis while its sources are being read.
#[derive(Debug, Clone)]
pub(super) struct AxisDraft {
    pub(super) name: String,
    /// Values of the axis lists, then those of `frictcomp.toml`.
    pub(super) values: AxisValues,
    /// The number that the axis lists give, before `frictcomp.toml` overrides it.
    number_in_list: Option<Given<u32>>,
    /// The number that the channel list gives.
    channel_number: Option<Given<u32>>,
    /// The number that the start-up list gives to the value list.
    pub(super) startup_number: Option<Given<u32>>,
    pub(super) value_list: ValueList,
    /// The path of the value list in the start-up list, if the value list gives no number: the control takes 0
    /// (P-COMP-00001).
    pub(super) unnumbered: Option<Given<String>>,
    pub(super) dynamics: ConfiguredDynamics,
    /// The line that assumes compensation, see [`Axis::enable`].
    pub(super) enabled: Option<Given<bool>>,
    /// Whether the axis has an axis list of the control.
    pub(super) is_listed: bool,
    /// Whether a start-up list leads to the axis, and every axis list that it names was read, so that no other list
    /// adds anything.
    pub(super) is_covered: bool,
    /// Whether a channel list gives it the index of a main axis.
    pub(super) is_main: bool,
    /// The list with the defaults for all axes.
    pub(super) shared: Option<Arc<str>>,
    /// The path of its axis list.
    pub(super) list: Option<String>,
    /// The channels that have the axis.
    pub(super) channels: ChannelsOfAxis,
}

impl AxisDraft {
    pub(super) fn new(name: String, values: AxisValues) -> Self {
        Self {
            name,
            number_in_list: values.number.clone(),
            values,
            channel_number: None,
            startup_number: None,
            value_list: ValueList::default(),
            unnumbered: None,
            dynamics: ConfiguredDynamics::default(),
            enabled: None,
            is_listed: false,
            is_covered: false,
            is_main: false,
            shared: None,
            list: None,
            channels: ChannelsOfAxis::default(),
        }
    }

    /// Overrides values by those of another axis list.
    pub(super) fn add_list(&mut self, list: AxisValues) {
        self.is_listed = true;
        if list.number.is_some() {
            self.number_in_list.clone_from(&list.number);
        }
        self.values.override_with(list);
    }

    /// Sets the number that the channel list gives; it applies if no axis list has one.
    pub(super) fn set_channel_number(&mut self, number: Option<Given<u32>>) {
        if self.number_in_list.is_none() {
            self.number_in_list.clone_from(&number);
            self.values.number.clone_from(&number);
        }
        self.channel_number = number;
    }

    /// Returns whether its lists say that it is a spindle.
    pub(super) fn is_spindle(&self) -> bool {
        let axis_type = self.values.axis_type.as_ref();
        axis_type.is_some_and(|given| given.value == AxisType::Spindle)
    }

    /// Returns the axis number that the axis lists give.
    pub(super) fn list_number(&self) -> Option<u32> {
        self.number_in_list.as_ref().map(|number| number.value)
    }

    /// Returns the axis and the effective values of its parameters.
    pub(super) fn finish(
        self,
        conditions: &Conditions,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> (Axis, AxisReport) {
        let axis_type = self.values.axis_type.as_ref();
        let axis_type = axis_type.map_or(AxisType::Linear, |given| given.value);
        let reading = self.value_list.friction.check(&Conditions {
            axis_type,
            ..*conditions
        });
        let first = diagnostics.len();
        let conflict = self.check_numbers(diagnostics);
        diagnostics.extend(reading.diagnostics);

        let friction = self.parameterisation(reading.verdict, conflict);
        let set = |switches: &BTreeMap<Kind, Given<bool>>| -> KindSet {
            switches
                .iter()
                .filter(|(_, on)| on.value)
                .map(|(&kind, _)| kind)
                .collect()
        };
        let mut manual = self.values.manual.clone();
        manual.extend(self.value_list.head.manual.clone());
        let anchor = self.value_list.friction.anchor();
        let max_points_given = self.value_list.friction.get(Field::MaxPoints);
        let mut axis = Axis {
            name: self.name.clone(),
            name_origin: self
                .values
                .name
                .as_ref()
                .map_or(Origin::Default, Origin::from),
            number: self.values.number.as_ref().map(|number| number.value),
            axis_type,
            configured: set(&self.values.selectors),
            unselected: self.unselected(),
            configuring: self.values.configuring(self.shared.as_deref()),
            frict_comp_origin: self
                .values
                .frict_comp()
                .map_or(Origin::Default, Origin::from),
            manual: set(&manual),
            required: self
                .values
                .required
                .as_ref()
                .map_or(KindSet::NONE, |required| required.value.kinds),
            friction,
            max_points: reading.max_points,
            max_points_place: max_points_given
                .map(Given::place)
                .or_else(|| anchor.as_ref().map(Given::place)),
            max_velocity_per_min: self.dynamics.velocity,
            max_acceleration_per_s2: self.dynamics.acceleration,
            max_jerk_per_s3: self.dynamics.jerk,
            motor_lead_mm: self.dynamics.lead,
            listed: self.values.dynamics.dynamics(),
            torque_scale: TorqueScale::default(),
            channels: self.channels.clone(),
            is_main: self.is_main,
        };
        if let Some(given) = &self.enabled {
            let (file, line) = (given.file().to_owned(), given.line());
            axis.assume(Origin::Enabled { file, line });
        }
        diagnostics.extend(self.check_selection(&axis));
        diagnostics.extend(self.check_monitor(&axis));
        for diagnostic in &mut diagnostics[first..] {
            diagnostic.axis.get_or_insert_with(|| self.name.clone());
        }

        let mut values = self.values;
        values.manual = manual;
        let mut parameters = values.parameters();
        parameters.extend(reading.parameters);
        axis.show_assumed(&mut parameters);
        let report = AxisReport {
            axis: self.name,
            axis_type,
            parameters,
            selector: values.frict_comp().cloned(),
            drive: values.drive,
            is_listed: self.is_listed,
        };
        let list = match &axis.friction {
            Parameterisation::Accepted(list) => Some(list),
            _ => None,
        };
        let drive = check_drive(&report.listed_drive(list), &Evidence::default());
        diagnostics.extend(drive.diagnostics);
        axis.torque_scale = drive.scale;
        (axis, report)
    }

    /// Returns the kinds that the lists leave at their default, not selected (R1.41, R18.2).
    fn unselected(&self) -> KindSet {
        let said = match (self.is_listed, self.is_covered) {
            (true, _) => KindSet::ALL,
            (false, true) => KindSet::of(Kind::Frict),
            (false, false) => KindSet::NONE,
        };
        let selectors = self.values.selectors.iter();
        let on = selectors.filter(|(_, on)| on.value).map(|(&kind, _)| kind);
        said.without(self.values.unread).without(on.collect())
    }

    /// Returns FC124 for required kinds that may or may not be configured (R1.36).
    fn check_monitor(&self, axis: &Axis) -> Option<Diagnostic> {
        let required = self.values.required.as_ref()?;
        let known = axis.configured.union(axis.unselected);
        let open = axis.required.without(known.union(KindSet::of(Kind::Frict)));
        if open.is_empty() {
            return None;
        }
        let words: Vec<_> = open.iter().map(|kind| format!("`{kind}`")).collect();
        let message = format!(
            "axis `{}` requires {}, but nothing says whether it is configured; whether the axis moves \
             without it is not judged",
            axis.name,
            words.join(", ")
        );
        Some(
            Diagnostic::new(Code::Fc124, required.place(), message).with_help(
                "name the kind in `compensations`, or give the axis list of the control",
            ),
        )
    }

    fn parameterisation(&self, verdict: Verdict, conflict: Option<Code>) -> Parameterisation {
        let rejected = |code: Code| Parameterisation::Rejected {
            file: self
                .value_list
                .friction
                .anchor()
                .map_or_else(String::new, |anchor| anchor.file().to_owned()),
            code: code.as_str().to_owned(),
        };
        match (verdict, conflict) {
            (Verdict::Absent, _) => Parameterisation::Missing,
            (_, Some(code)) | (Verdict::Rejected(code), None) => rejected(code),
            (Verdict::Off, None) => Parameterisation::Off,
            (Verdict::Accepted(list), None) => Parameterisation::Accepted(list),
        }
    }

    /// Checks that all lists give the axis the same number (R3.14). `Some` if the value list has another one; it is
    /// then rejected.
    fn check_numbers(&self, diagnostics: &mut Vec<Diagnostic>) -> Option<Code> {
        let code = Code::PErr110229;
        let differ = |list: &Given<u32>, other: &Given<u32>| {
            let message = format!(
                "the axis number is {} in `{}`, but {} in `{}`",
                list.value,
                list.file(),
                other.value,
                other.file()
            );
            Diagnostic::new(code, list.place(), message)
                .with_label(other.place(), "the other number")
                .with_help("all lists of an axis have the same number")
        };
        let in_list = self.number_in_list.as_ref();
        if let (Some(list), Some(channel)) = (in_list, &self.channel_number)
            && list.value != channel.value
        {
            diagnostics.push(differ(list, channel));
        }
        let others = || {
            [in_list, self.startup_number.as_ref()]
                .into_iter()
                .flatten()
        };
        if let Some(path) = &self.unnumbered {
            diagnostics.push(without_number(path, others().next()?));
            return Some(code);
        }
        let value_list = self.value_list.head.number.as_ref()?;
        let other = others().find(|other| other.value != value_list.value)?;
        diagnostics.push(differ(value_list, other));
        Some(code)
    }

    /// Checks that the axis list and the value list agree (R3.27, R3.30).
    fn check_selection(&self, axis: &Axis) -> Option<Diagnostic> {
        let anchor = self.value_list.friction.anchor();
        let selector = self.values.frict_comp();
        if axis.is_spindle() {
            return on_spindle(&axis.name, anchor.as_ref(), selector);
        }
        let configured = axis.configured.contains(Kind::Frict);
        if configured {
            let why = match &axis.friction {
                Parameterisation::Accepted(_) | Parameterisation::Assumed => return None,
                Parameterisation::Missing => "no value list gives it friction values".to_owned(),
                Parameterisation::Off => "`frict_comp.mode` is 0".to_owned(),
                Parameterisation::Rejected { file, code } => {
                    format!("the control rejects `{file}` with {code}")
                }
            };
            let message = format!(
                "friction compensation of axis `{}` is selected without effect: {why}",
                axis.name
            );
            return selector.map(|given| {
                Diagnostic::new(Code::Fc303, given.place(), message)
                    .with_help("the axis needs a value list with `frict_comp.mode` 3")
            });
        }
        if !matches!(axis.friction, Parameterisation::Accepted(_)) {
            return None;
        }
        let selects = if axis.is_described() {
            "P-AXIS-00522 is 0"
        } else {
            "nothing says that P-AXIS-00522 is 1"
        };
        let message = format!(
            "axis `{}` has friction values, but {selects}: they have no effect",
            axis.name
        );
        let mut diagnostic = Diagnostic::new(Code::Fc135, anchor?.place(), message);
        diagnostic.fixes.extend(axis.configuring.clone());
        Some(match selector {
            Some(given) => diagnostic
                .with_label(given.place(), "set to 0 here")
                .with_help("set `lr_param.frict_comp` to 1"),
            None => diagnostic.with_help(
                "set `lr_param.frict_comp` to 1 in the axis list, or `frict_comp = true` in \
                 `frictcomp.toml`",
            ),
        })
    }
}

/// Returns P-ERR-110229 for a value list without a number: the default of P-COMP-00001 is 0, which no axis has
/// (TF5200 Axis compensation parameters, 113373067; R3.14).
fn without_number(path: &Given<String>, other: &Given<u32>) -> Diagnostic {
    let message = format!(
        "`{}` has no `kopf.achs_nr`, so that its axis number is 0, but it is {} in `{}`",
        path.value,
        other.value,
        other.file()
    );
    Diagnostic::new(Code::PErr110229, path.place(), message)
        .with_label(other.place(), "the other number")
        .with_help(format!("add `kopf.achs_nr {}` to the list", other.value))
}

/// Returns FC138 for a spindle whose lists select friction compensation.
pub(super) fn on_spindle(
    name: &str,
    values: Option<&Given<()>>,
    selector: Option<&Given<bool>>,
) -> Option<Diagnostic> {
    let selector = selector.filter(|given| given.value).map(Given::place);
    let said = |place, message: &str| {
        let message = format!("{message}; friction compensation is for linear and rotary axes");
        Diagnostic::new(Code::Fc138, place, message)
    };
    let named = match name {
        "" => "this axis".to_owned(),
        name => format!("`{name}`"),
    };
    match (values, selector) {
        (Some(values), selector) => {
            let diagnostic = said(values.place(), &format!("{named} is a spindle"));
            Some(match selector {
                Some(place) => diagnostic.with_label(place, "P-AXIS-00522 is 1 here"),
                None => diagnostic,
            })
        }
        (None, Some(place)) => {
            let message = format!("P-AXIS-00522 is 1, but {named} is a spindle");
            Some(said(place, &message).with_help("set `lr_param.frict_comp` to 0"))
        }
        (None, None) => None,
    }
}
