//! One axis with its parameters, and static gantries: axes that follow others in the position controller (R1.43).
//!
//! The channel does not know the slave (TF5200 Gantry operation, 285764875, P-AXIS-00070).

use serde::{Deserialize, Serialize};

use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Advice, Code, Diagnostic, Fix};
use crate::drive_interface::TorqueScale;
use crate::lists::{
    AxisType, AxisValues, DEFAULT_MAX_POINTS, Entries, FrictionDraft, FrictionList, Given,
    ListedDynamics, Origin, Parameter,
};
use crate::text::Place;

/// Whether an axis has a friction value list that the control would accept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Parameterisation {
    /// No value list belongs to the axis.
    #[default]
    Missing,
    /// The list has mode 0, off.
    Off,
    /// The list was read and rejected with this code.
    Rejected {
        /// Path of the list.
        file: String,
        /// The code of the first check that it failed.
        code: String,
    },
    /// The user assumes a list; its values are not known.
    Assumed,
    /// The list was accepted.
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

    /// Whether it is a spindle.
    pub fn is_spindle(&self) -> bool {
        self.axis_type == AxisType::Spindle
    }

    /// Whether a list that was read, or the user, says what P-AXIS-00522 is. Otherwise the documented default takes its
    /// place, and what a command to the axis does is not known (R1.37, R18.2). A spindle has no friction compensation.
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
