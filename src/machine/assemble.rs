//! Assembles one axis from the lists and `frictcomp.toml`, with the checks that need both the axis
//! list and the value list (R3.14, R3.27, R3.30).

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;

use super::axis::{Axis, Parameterisation, ValueList};
use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic};
use crate::drive_interface::{Evidence, ListedDrive, TorqueScale, check_drive};
use crate::lists::{
    AxisType, AxisValues, Conditions, Entry, Field, FrictionList, Given, Origin, Parameter, Verdict,
};

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
    pub(super) dynamics: ConfiguredDynamics,
    /// The line that assumes compensation, see [`Axis::enable`].
    pub(super) enabled: Option<Given<bool>>,
    /// Whether the axis has an axis list of the control.
    pub(super) is_listed: bool,
    /// Whether a start-up list leads to the axis, and every axis list that it names was read: no other one says more.
    pub(super) is_covered: bool,
    /// The list with the defaults for all axes.
    pub(super) shared: Option<Arc<str>>,
    /// The path of its axis list.
    pub(super) list: Option<String>,
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
            dynamics: ConfiguredDynamics::default(),
            enabled: None,
            is_listed: false,
            is_covered: false,
            shared: None,
            list: None,
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

    /// Whether its lists say that it is a spindle.
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

    /// R3.14: all lists give the axis the same number. `Some` if the value list has another one; it
    /// is then rejected.
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
        let value_list = self.value_list.head.number.as_ref()?;
        let other = [in_list, self.startup_number.as_ref()]
            .into_iter()
            .flatten()
            .find(|other| other.value != value_list.value)?;
        diagnostics.push(differ(value_list, other));
        Some(code)
    }

    /// R3.27 and R3.30: the axis list and the value list must agree.
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
