//! An axis list: compensation (R3.10), with the few keys of that kind in value lists (R3.11), P-AXIS-00465, the kinds without which
//! an axis must not move (R1.36), and dynamics (R11.20; TF5200 Axis parameters, `getriebe[i].dynamik`, `.slope_profil`,
//! `.lslope_profil`). Programs begin in gear step 0.

use std::collections::BTreeMap;
use std::fmt;

use super::line::{Entries, Entry, Given, Number};
use super::parameter::{AxisType, Origin, Parameter};
use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, Fix, nearest};

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

/// Returns whether a name can be used in a program: a letter, then letters, digits or `_`, 16 at most (R2.20). Names of
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

/// Limit on the drive entries, beyond any axis list; further ones are not kept.
const MAX_DRIVE_ENTRIES: usize = 4096;

/// Returns whether a key belongs to the drive (chapter 7).
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

/// The key of P-AXIS-00465.
pub(super) const REQUIRED: &str = "lr_param.prog_movement_requires_compensations";

/// The kinds that must be active while an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Monitor {
    /// The kinds that are named or whose bit is set.
    pub kinds: KindSet,
    /// The bits for which no kind is documented; their requirement is not judged.
    pub open: u64,
}

impl Monitor {
    /// Creates a monitor of these kinds.
    pub fn of_kinds(kinds: KindSet) -> Self {
        Self { kinds, open: 0 }
    }

    /// Reads words joined by `|`, or a bit code in any form of number. Reports once which of them
    /// are not judged.
    pub(super) fn of(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Given<Self> {
        let mut monitor = Self::default();
        for word in entry.words() {
            if let Ok(kind) = word.value.parse::<Kind>() {
                monitor.kinds.insert(kind);
            } else if let Some(bits) = bit_code(word.value) {
                let open = monitor.add(bits);
                if open != 0 {
                    diagnostics.push(undocumented(&word, open));
                }
            } else if !word.value.eq_ignore_ascii_case("NONE") {
                diagnostics.push(no_kind(&word));
            }
        }
        entry.word().with(monitor)
    }

    /// Adds the kinds of a bit code and returns the bits that no document explains.
    fn add(&mut self, bits: u64) -> u64 {
        let mut open = bits;
        for kind in Kind::ALL {
            if let Some(bit) = kind.facts().monitor_bit
                && bits & bit != 0
            {
                self.kinds.insert(kind);
                open &= !bit;
            }
        }
        self.open |= open;
        open
    }
}

/// The words of an axis list, followed by a bit code for what is not judged.
impl fmt::Display for Monitor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut words: Vec<String> = self.kinds.iter().map(|kind| kind.to_string()).collect();
        if self.open != 0 {
            words.push(format!("{:#x} (not judged)", self.open));
        }
        f.write_str(&words.join(" | "))
    }
}

/// Reads a bit code: `2`, `0x02`, `'16#2'`, `2#10`.
fn bit_code(word: &str) -> Option<u64> {
    let word = word.trim_matches('\'');
    if let Some((base, digits)) = word.split_once('#') {
        let base = base.parse().ok().filter(|base| (2..=36).contains(base))?;
        return u64::from_str_radix(digits, base).ok();
    }
    match Number::parse(word)? {
        Number::Integer(bits) => u64::try_from(bits).ok(),
        Number::Real(_) => None,
    }
}

/// Returns FC124 for bits without a documented kind.
fn undocumented(word: &Given<&str>, bits: u64) -> Diagnostic {
    let message = format!(
        "no document says which compensation the bits {bits:#x} of `{REQUIRED}` require; whether \
         the axis moves without it is not judged"
    );
    Diagnostic::new(Code::Fc124, word.place(), message)
        .with_help("name the kinds in words: `LEAD | FRICT`")
}

/// Returns FC124 for a word that is not a kind.
fn no_kind(word: &Given<&str>) -> Diagnostic {
    let message = format!(
        "`{}` is not a kind of compensation; whether the axis moves without it is not judged",
        word.value
    );
    let near = nearest(word.value, Kind::ALL.map(Kind::as_str));
    Diagnostic::new(Code::Fc124, word.place(), message).with_near(word.value, &near)
}

/// The quantity of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DynamicQuantity {
    /// µm/s or 0.001°/s.
    Velocity,
    /// mm/s² or °/s².
    Acceleration,
    /// µs.
    Ramp,
    /// A thousandth.
    Weight,
}

/// The keys, each with the number of its parameter.
const KEYS: [(&str, &str, DynamicQuantity); 18] = {
    use DynamicQuantity::{Acceleration, Ramp, Velocity, Weight};
    [
        ("P-AXIS-00008", "dynamik.a_max", Acceleration),
        ("P-AXIS-00212", "dynamik.vb_max", Velocity),
        ("P-AXIS-00209", "vb_eilgang", Velocity),
        ("P-AXIS-00001", "slope_profil.a_beschl", Acceleration),
        ("P-AXIS-00002", "slope_profil.a_brems", Acceleration),
        ("P-AXIS-00004", "slope_profil.a_grenz", Acceleration),
        ("P-AXIS-00195", "slope_profil.tr_beschl_ab", Ramp),
        ("P-AXIS-00196", "slope_profil.tr_beschl_zu", Ramp),
        ("P-AXIS-00197", "slope_profil.tr_brems_ab", Ramp),
        ("P-AXIS-00198", "slope_profil.tr_brems_zu", Ramp),
        ("P-AXIS-00200", "slope_profil.tr_grenz", Ramp),
        ("P-AXIS-00199", "dynamik.tr_geom", Ramp),
        ("P-AXIS-00201", "dynamik.tr_min", Ramp),
        ("P-AXIS-00011", "slope_profil.a_stufe_1", Acceleration),
        ("P-AXIS-00012", "slope_profil.a_stufe_2", Acceleration),
        ("P-AXIS-00221", "slope_profil.vb_stufe_1_2", Velocity),
        ("P-AXIS-00013", "dynamik.a_trans_weight", Weight),
        ("P-AXIS-00154", "dynamik.r_trans_weight", Weight),
    ]
};

/// The values of an axis list, by the numbers of their parameters.
#[derive(Debug, Clone, Default)]
pub struct DynamicsDraft(BTreeMap<&'static str, (String, Given<Number>)>);

/// The dynamics of an axis as given by its list: in mm or degrees, and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct ListedDynamics {
    /// The highest velocity, P-AXIS-00212.
    pub velocity_per_s: Option<f64>,
    /// The highest velocity of rapid motions, P-AXIS-00209.
    pub rapid_velocity_per_s: Option<f64>,
    /// The acceleration with ramps, the smaller of P-AXIS-00001 and P-AXIS-00002.
    pub acceleration_per_s2: Option<f64>,
    /// The acceleration without ramps, the smaller of P-AXIS-00011 and P-AXIS-00012.
    pub stage_acceleration_per_s2: Option<f64>,
    /// The acceleration of rapid motions, P-AXIS-00004.
    pub rapid_acceleration_per_s2: Option<f64>,
    /// The longest of the ramp times P-AXIS-00195 to P-AXIS-00198, not below P-AXIS-00201.
    pub ramp_s: Option<f64>,
    /// The ramp time of rapid motions, P-AXIS-00200.
    pub rapid_ramp_s: Option<f64>,
    /// The ramp time where the curvature of the path changes, P-AXIS-00199.
    pub curve_ramp_s: Option<f64>,
    /// The share of the acceleration that an axis may jump by in a corner, P-AXIS-00013.
    pub corner_share: Option<f64>,
}

impl DynamicsDraft {
    /// Takes an entry of gear step 0 and returns whether its key is one of these. Reports FC130 for a value that is not
    /// a number, or not above 0 if it is a limit.
    pub(super) fn take(&mut self, entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> bool {
        let Some(key) = entry.pattern.strip_prefix("getriebe[].") else {
            return false;
        };
        let key = key
            .strip_prefix('l')
            .filter(|key| key.starts_with("slope_profil."))
            .unwrap_or(key);
        let Some((number, _, quantity)) = KEYS.iter().find(|(_, known, _)| *known == key) else {
            return false;
        };
        if entry.indices.as_slice() != [0] {
            return true;
        }
        let given = entry.number();
        let is_possible =
            |value: f64| value > 0.0 || (*quantity == DynamicQuantity::Weight && value == 0.0);
        let possible = given.value.number;
        let possible = possible.filter(|value| is_possible(value.to_f64()));
        if let Some(value) = possible {
            self.0.insert(number, (entry.key(), given.with(value)));
        } else {
            let message = format!(
                "`{}` is `{}`; the value is not used",
                entry.key(),
                given.value.text
            );
            diagnostics.push(
                Diagnostic::new(Code::Fc130, given.place(), message)
                    .with_help("write a number above 0"),
            );
        }
        true
    }

    /// Replaces values by those of another list.
    pub(super) fn override_with(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Returns the values in mm or degrees and seconds.
    pub(crate) fn dynamics(&self) -> ListedDynamics {
        let value = |number: &str| self.0.get(number).map(|(_, given)| given.value.to_f64());
        let known = |numbers: &[&str]| -> Vec<f64> {
            numbers.iter().filter_map(|number| value(number)).collect()
        };
        let most = value("P-AXIS-00008").unwrap_or(f64::INFINITY);
        let least = |numbers: &[&str]| {
            let smallest = known(numbers).into_iter().reduce(f64::min);
            smallest.map(|value| value.min(most))
        };
        let shortest = value("P-AXIS-00201").unwrap_or(0.0);
        let longest = |numbers: &[&str]| {
            let largest = known(numbers).into_iter().reduce(f64::max);
            largest.map(|time| time.max(shortest) * 1e-6)
        };
        let velocity = |number: &str| value(number).map(|value| value / 1000.0);
        ListedDynamics {
            velocity_per_s: velocity("P-AXIS-00212").or_else(|| velocity("P-AXIS-00209")),
            rapid_velocity_per_s: velocity("P-AXIS-00209"),
            acceleration_per_s2: least(&["P-AXIS-00001", "P-AXIS-00002"]),
            stage_acceleration_per_s2: least(&["P-AXIS-00011", "P-AXIS-00012"]),
            rapid_acceleration_per_s2: least(&["P-AXIS-00004"]),
            ramp_s: longest(&[
                "P-AXIS-00195",
                "P-AXIS-00196",
                "P-AXIS-00197",
                "P-AXIS-00198",
            ]),
            rapid_ramp_s: longest(&["P-AXIS-00200"]),
            curve_ramp_s: longest(&["P-AXIS-00199"]),
            corner_share: value("P-AXIS-00013")
                .map(|thousandths| thousandths / 1000.0)
                .filter(|share| *share > 0.0),
        }
    }

    /// Returns the parameters that the list gives.
    pub(super) fn parameters(&self, axis_type: AxisType) -> Vec<Parameter> {
        let linear = axis_type == AxisType::Linear;
        let rows = self.0.iter().map(|(&number, (key, given))| {
            let quantity = KEYS.iter().find(|(known, ..)| *known == number);
            let unit = match quantity.map(|(_, _, quantity)| quantity) {
                Some(DynamicQuantity::Velocity) if linear => "µm/s",
                Some(DynamicQuantity::Velocity) => "0.001°/s",
                Some(DynamicQuantity::Acceleration) if linear => "mm/s²",
                Some(DynamicQuantity::Acceleration) => "°/s²",
                Some(DynamicQuantity::Ramp) => "µs",
                _ => "‰",
            };
            Parameter {
                number,
                key: key.clone(),
                value: given.value.to_string(),
                unit,
                origin: given.into(),
            }
        });
        rows.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_codes_have_any_form_of_number() {
        // R1.36
        for word in ["3", "0x3", "0X03", "16#3", "'16#3'", "2#11", "'8#3'"] {
            assert_eq!(bit_code(word), Some(3), "{word}");
        }
        for word in ["", "'", "-1", "1.0", "16#", "16#G", "LEAD", "0x", "40#1"] {
            assert_eq!(bit_code(word), None, "{word}");
        }
    }
}
