//! Compensation in an axis list (R3.10), and the few keys of that kind in value lists (R3.11).

use std::collections::BTreeMap;

use super::dynamics::DynamicsDraft;
use super::entry::{Entry, Given, Number};
use super::line::Entries;
use super::monitor::{Monitor, REQUIRED};
use super::parameter::{AxisType, Origin, Parameter};
use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, Fix};

/// The values of one axis list, or of the head of a value list.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisValues {
    /// `kopf.achs_nr`, P-AXIS-00016.
    pub number: Option<Given<u32>>,
    /// `kopf.log_achs_name`, P-AXIS-00297.
    pub name: Option<Given<String>>,
    /// `kenngr.achs_typ`, P-AXIS-00018.
    pub axis_type: Option<Given<AxisType>>,
    /// The selectors of the kinds (R1.40); FRICT is P-AXIS-00522.
    pub selectors: BTreeMap<Kind, Given<bool>>,
    /// The manual activation of the kinds (R1.40).
    pub manual: BTreeMap<Kind, Given<bool>>,
    /// The kinds whose selector or manual activation is given, but without a usable value.
    pub unread: KindSet,
    /// The kinds that must be active while the axis moves, P-AXIS-00465.
    pub required: Option<Given<Monitor>>,
    /// The number of the master of a static gantry, P-AXIS-00070; `None` unless the axis is a slave.
    pub gantry_master: Option<Given<u32>>,
    /// The entries of the drive by their keys: `antr.*`, its type and its torque offset.
    pub drive: BTreeMap<String, Entry>,
    /// Velocity, acceleration and ramp times.
    pub dynamics: DynamicsDraft,
    /// The end of the last entry, after which another one could be added, and the columns that its key takes.
    pub end: Option<Given<usize>>,
}

/// Whether a name can be used in a program: a letter, then letters, digits or `_`, 16 at most (R2.20). Names of
/// spindles begin with other letters than those of axes.
pub(crate) fn is_axis_name(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(letter)
        && name.len() <= 16
}

/// Help on the form of an axis name.
pub(crate) const AXIS_NAME_HELP: &str =
    "a name is a letter, then letters, digits or `_`, 16 at most: `X`, `Y2`";

/// More drive entries than any axis list has; further ones are not kept.
const MAX_DRIVE_ENTRIES: usize = 4096;

/// Whether a key belongs to the drive (chapter 7).
fn is_drive_key(pattern: &str) -> bool {
    pattern.starts_with("antr.")
        || matches!(
            pattern,
            "kenngr.antr_typ" | "kenngr.drive_simulation" | "getriebe[].torque_offset"
        )
}

impl AxisValues {
    /// Collects the values; all keys that are not named in R3.10 and R3.11 are passed over.
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut values = Self {
            end: list.entries.last().map(Entry::end),
            ..Self::default()
        };
        for entry in &list.unresolved {
            values.unread = values.unread.union(switched_by(&entry.pattern));
        }
        for entry in &list.entries {
            match entry.pattern.as_str() {
                "kopf.achs_nr" => values.number = axis_number(entry, diagnostics),
                "kopf.log_achs_name" => values.name = text(entry),
                "kenngr.achs_typ" => values.axis_type = axis_type(entry, diagnostics),
                REQUIRED => values.required = Some(Monitor::of(entry, diagnostics)),
                "kenngr.gantry_ax_nr" => {
                    let master = axis_number(entry, diagnostics);
                    values.gantry_master = master.filter(|number| number.value != 0);
                }
                pattern if is_drive_key(pattern) => {
                    if values.drive.len() < MAX_DRIVE_ENTRIES {
                        values.drive.insert(entry.key(), entry.clone());
                    }
                }
                _ if values.dynamics.take(entry, diagnostics) => {}
                pattern => values.set_switch(pattern, entry, diagnostics),
            }
        }
        values
    }

    /// Replaces values by those of another list.
    pub fn override_with(&mut self, other: Self) {
        self.number = other.number.or(self.number.take());
        self.name = other.name.or(self.name.take());
        self.axis_type = other.axis_type.or(self.axis_type.take());
        self.selectors.extend(other.selectors);
        self.manual.extend(other.manual);
        self.unread = self.unread.union(other.unread);
        self.required = other.required.or(self.required.take());
        self.gantry_master = other.gantry_master.or(self.gantry_master.take());
        self.dynamics.override_with(other.dynamics);
        self.drive.extend(other.drive);
        self.end = other.end.or(self.end.take());
    }

    /// Returns the value of P-AXIS-00522 and its place; `None` if no list sets it.
    pub fn frict_comp(&self) -> Option<&Given<bool>> {
        self.selectors.get(&Kind::Frict)
    }

    /// Returns the change to the list that sets P-AXIS-00522: in the line that sets it to 0, unless that line is in the
    /// list `shared` by all axes, else in a new line. `None` if it is set, or if no list is for this axis alone.
    pub(crate) fn configuring(&self, shared: Option<&str>) -> Option<Fix> {
        let own = |given: &&Given<bool>| shared != Some(given.file());
        match self.frict_comp() {
            Some(given) if given.value => None,
            given => match given.filter(own) {
                Some(given) => Some(given.made_true()),
                None => self.end.as_ref().map(added),
            },
        }
    }

    /// Returns the rows of the table of effective parameters. P-AXIS-00522 is always included, other selectors if a
    /// list sets them.
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut rows = Vec::new();
        let mut row = |number, key: &str, value: String, origin| {
            rows.push(Parameter {
                number,
                key: key.to_owned(),
                value,
                unit: "",
                origin,
            });
        };
        if let Some(number) = &self.number {
            let value = number.value.to_string();
            row("P-AXIS-00016", "kopf.achs_nr", value, number.into());
        }
        if let Some(name) = &self.name {
            let value = name.value.clone();
            row("P-AXIS-00297", "kopf.log_achs_name", value, name.into());
        }
        if let Some(axis_type) = &self.axis_type {
            let value = axis_type.value.list_value().to_owned();
            row("P-AXIS-00018", "kenngr.achs_typ", value, axis_type.into());
        }
        for kind in Kind::ALL {
            let facts = kind.facts();
            let bit = |on: bool| u8::from(on).to_string();
            match self.selectors.get(&kind) {
                Some(on) => row(facts.parameter, facts.selector, bit(on.value), on.into()),
                None if kind == Kind::Frict => {
                    row(facts.parameter, facts.selector, bit(false), Origin::Default);
                }
                None => {}
            }
            if let (Some(key), Some(on)) = (facts.manual_activation, self.manual.get(&kind)) {
                let number = facts.manual_parameter.unwrap_or_default();
                row(number, key, bit(on.value), on.into());
            }
        }
        if let Some(required) = &self.required {
            let value = required.value.to_string();
            row("P-AXIS-00465", REQUIRED, value, required.into());
        }
        if let Some(master) = &self.gantry_master {
            let (number, key) = ("P-AXIS-00070", "kenngr.gantry_ax_nr");
            row(number, key, master.value.to_string(), master.into());
        }
        let axis_type = self.axis_type.as_ref();
        let axis_type = axis_type.map_or(AxisType::Linear, |given| given.value);
        rows.extend(self.dynamics.parameters(axis_type));
        rows
    }

    fn set_switch(&mut self, pattern: &str, entry: &Entry, diagnostics: &mut Vec<Diagnostic>) {
        for kind in Kind::ALL {
            let facts = kind.facts();
            let switches = if pattern == facts.selector {
                &mut self.selectors
            } else if facts.manual_activation == Some(pattern) {
                &mut self.manual
            } else {
                continue;
            };
            // P-AXIS-00021 is a number: backlash compensation is on if it is not 0 (R1.40).
            let on = match entry.number().value.number {
                Some(Number::Integer(value)) if kind == Kind::Backlash => {
                    Some(entry.word().with(value != 0))
                }
                _ => truth(entry, diagnostics),
            };
            match on {
                Some(on) => _ = switches.insert(kind, on),
                None => self.unread.insert(kind),
            }
            return;
        }
    }
}

/// Returns the kinds that a key selects or activates.
fn switched_by(pattern: &str) -> KindSet {
    let switches = |kind: &Kind| {
        let facts = kind.facts();
        pattern == facts.selector || facts.manual_activation == Some(pattern)
    };
    Kind::ALL.into_iter().filter(switches).collect()
}

/// Adds a line that sets P-AXIS-00522 after the last entry of a list.
fn added(end: &Given<usize>) -> Fix {
    let (key, columns) = (Kind::Frict.facts().selector, end.value);
    let line = if columns > key.len() {
        format!("\n{key:<columns$}1")
    } else {
        format!("\n{key} 1")
    };
    Fix::guess(end.place(), line)
}

/// Returns FC130 for a value that is not one of those in `expected`; the value is not used.
fn no_value(entry: &Entry, expected: &str) -> Diagnostic {
    let word = entry.word();
    let found = if word.value.is_empty() {
        "empty".to_owned()
    } else {
        format!("`{}`", word.value)
    };
    Diagnostic::new(
        Code::Fc130,
        word.place(),
        format!("`{}` is {found}; the value is not used", entry.key()),
    )
    .with_help(format!("write {expected}"))
}

fn truth(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<bool>> {
    let given = entry.truth();
    if given.value.is_none() {
        diagnostics.push(no_value(entry, "`0` or `1`, `FALSE` or `TRUE`"));
    }
    given.value.map(|on| given.with(on))
}

/// Reads an axis number, a whole number of type UNS16.
pub(super) fn axis_number(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<u32>> {
    let given = entry.number();
    let number = match given.value.number {
        Some(Number::Integer(value)) => u16::try_from(value).ok(),
        _ => None,
    };
    if number.is_none() {
        diagnostics.push(no_value(entry, "a whole number from 0 to 65535"));
    }
    number.map(|number| given.with(u32::from(number)))
}

/// Returns a text that is not empty.
pub(super) fn text(entry: &Entry) -> Option<Given<String>> {
    let given = entry.text();
    (!given.value.is_empty()).then(|| given.with(given.value.to_owned()))
}

fn axis_type(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Option<Given<AxisType>> {
    let given = entry.number();
    let axis_type = match given.value.number {
        Some(Number::Integer(1)) => Some(AxisType::Linear),
        Some(Number::Integer(2)) => Some(AxisType::Rotary),
        Some(Number::Integer(4)) => Some(AxisType::Spindle),
        _ => match given.value.text.as_str() {
            "ACHSTYP_TRANSLATOR" => Some(AxisType::Linear),
            "ACHSTYP_ROTATOR" => Some(AxisType::Rotary),
            "ACHSTYP_SPINDEL" => Some(AxisType::Spindle),
            _ => None,
        },
    };
    if axis_type.is_none() {
        let expected = "`1` for a linear axis, `2` for a rotary axis, `4` for a spindle";
        diagnostics.push(no_value(entry, expected));
    }
    axis_type.map(|axis_type| given.with(axis_type))
}
