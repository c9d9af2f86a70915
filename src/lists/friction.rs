//! Friction compensation in a value list: the `frict_comp` structure (chapter 3.3).
//!
//! This file collects the written values; `check` decides on the control's reaction.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::entry::Entry;
use super::line::Entries;
use super::parameter::{AxisType, Origin, Parameter};
use super::value::{Given, Number, Written};
use crate::diagnostic::{Code, Diagnostic, nearest};

/// The keys that exist but are not documented; they are ignored (R3.5).
const UNDOCUMENTED: [&str; 10] = [
    "file_path",
    "f_i",
    "pitch",
    "torque_negative",
    "torque_positive",
    "max_t_break",
    "weight_fact_num",
    "weight_fact_denom",
    "reversal_num",
    "sample",
];

/// A documented parameter of the structure, except the table (chapter 3.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Field {
    /// P-COMP-00041: 0 off, 3 on.
    Mode,
    /// P-COMP-00042: number of points of the table that are used.
    TableEntries,
    /// P-COMP-00043: distance of the build-up after a reversal.
    PositionDelay,
    /// P-COMP-00044: CNC cycles of the decay before a reversal.
    ReversalLookahead,
    /// P-COMP-00045: scaling of all outputs.
    ScalingFactor,
    /// P-COMP-00058: dead time of the output in CNC cycles.
    DelayCycles,
    /// P-COMP-00062: reserved table size.
    MaxPoints,
}

impl Field {
    /// Every parameter, in the order of the manual's sample.
    pub const ALL: [Self; 7] = [
        Self::Mode,
        Self::MaxPoints,
        Self::TableEntries,
        Self::PositionDelay,
        Self::ReversalLookahead,
        Self::ScalingFactor,
        Self::DelayCycles,
    ];

    /// Returns the name after `frict_comp.`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mode => "mode",
            Self::TableEntries => "table_entries",
            Self::PositionDelay => "position_delay",
            Self::ReversalLookahead => "reversal_lookahead",
            Self::ScalingFactor => "scaling_factor",
            Self::DelayCycles => "delay_cycles",
            Self::MaxPoints => "max_points",
        }
    }

    /// Returns the parameter with this name after `frict_comp.`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|field| field.name() == name)
    }

    /// Returns the number in the parameter descriptions.
    pub fn number(self) -> &'static str {
        match self {
            Self::Mode => "P-COMP-00041",
            Self::TableEntries => "P-COMP-00042",
            Self::PositionDelay => "P-COMP-00043",
            Self::ReversalLookahead => "P-COMP-00044",
            Self::ScalingFactor => "P-COMP-00045",
            Self::DelayCycles => "P-COMP-00058",
            Self::MaxPoints => "P-COMP-00062",
        }
    }

    /// Returns the documented default.
    pub fn default(self) -> i64 {
        match self {
            Self::ScalingFactor => 1000,
            Self::MaxPoints => i64::from(DEFAULT_MAX_POINTS),
            _ => 0,
        }
    }

    /// Returns the unit for an axis of this type.
    pub fn unit(self, axis_type: AxisType) -> &'static str {
        match self {
            Self::Mode | Self::TableEntries | Self::MaxPoints => "",
            Self::PositionDelay if axis_type == AxisType::Linear => "0.1 \u{b5}m",
            Self::PositionDelay => "0.0001\u{b0}",
            Self::ReversalLookahead | Self::DelayCycles => "cycles",
            Self::ScalingFactor => "0.1 %",
        }
    }

    /// Returns the name of its type in the control.
    pub(super) fn type_name(self) -> &'static str {
        match self {
            Self::Mode | Self::TableEntries | Self::ReversalLookahead => "UNS16",
            Self::PositionDelay => "SGN32",
            Self::ScalingFactor | Self::DelayCycles => "SGN16",
            Self::MaxPoints => "UNS32",
        }
    }

    /// Whether a value is an end of an interval that is documented as open (R3.45).
    pub(super) fn is_end_of_open(self, value: i64) -> bool {
        let ends = [i16::MIN, i16::MAX].map(i64::from);
        self == Self::ScalingFactor && ends.contains(&value)
    }

    /// Returns the range of its type; the interval of the scaling factor is open (R3.24).
    pub(super) fn type_range(self) -> RangeInclusive<i64> {
        match self {
            Self::Mode | Self::TableEntries | Self::ReversalLookahead => 0..=i64::from(u16::MAX),
            Self::PositionDelay => i64::from(i32::MIN)..=i64::from(i32::MAX),
            Self::ScalingFactor => i64::from(i16::MIN) + 1..=i64::from(i16::MAX) - 1,
            Self::DelayCycles => i64::from(i16::MIN)..=i64::from(i16::MAX),
            Self::MaxPoints => 0..=i64::from(u32::MAX),
        }
    }

    /// Whether a value of this parameter counts as 0, being a negative distance or time (R3.25).
    pub(super) fn floors(self, value: i64) -> bool {
        let counted = matches!(
            self,
            Self::PositionDelay | Self::ReversalLookahead | Self::DelayCycles
        );
        let smallest = match self {
            Self::PositionDelay => i64::from(i32::MIN),
            _ => i64::from(i16::MIN),
        };
        counted && (smallest..0).contains(&value)
    }

    /// Returns the permitted values: the documented range, or that of its type.
    pub fn range(self) -> RangeInclusive<i64> {
        let documented = self.documented_range();
        documented.unwrap_or_else(|| self.type_range())
    }

    /// Returns the documented range if it is narrower than the type and no other check enforces it
    /// (R3.25).
    pub(super) fn documented_range(self) -> Option<RangeInclusive<i64>> {
        match self {
            Self::PositionDelay => Some(0..=10),
            Self::ReversalLookahead => Some(0..=4),
            Self::DelayCycles => Some(0..=248),
            _ => None,
        }
    }
}

/// One point of the table as written.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct WrittenPoint {
    /// `frict_comp.table[i].in`.
    pub input: Option<Given<Written>>,
    /// `frict_comp.table[i].out`.
    pub output: Option<Given<Written>>,
}

/// The friction parameters as written, before any check.
#[derive(Debug, Clone, Default)]
pub struct FrictionDraft {
    scalars: BTreeMap<Field, Given<Written>>,
    /// By index; only written points take memory, however large the index.
    pub(super) table: BTreeMap<u32, WrittenPoint>,
}

impl FrictionDraft {
    /// Collects the friction parameters of a value list; unknown keys of the structure are FC122
    /// (R3.5).
    pub fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut draft = Self::default();
        for entry in &list.entries {
            let Some(rest) = after_structure(&entry.pattern) else {
                continue;
            };
            let index = entry.indices.first().copied();
            match (rest.strip_prefix('.').unwrap_or_default(), index) {
                ("table[].in", Some(index)) => {
                    draft.table.entry(index).or_default().input = Some(entry.number());
                }
                ("table[].out", Some(index)) => {
                    draft.table.entry(index).or_default().output = Some(entry.number());
                }
                (name, _) => match Field::from_name(name) {
                    Some(field) if entry.pattern.starts_with(STRUCTURE) => {
                        draft.set(field, entry.number());
                    }
                    _ => diagnostics.extend(unknown_key(entry, name)),
                },
            }
        }
        draft
    }

    /// Sets one parameter.
    pub fn set(&mut self, field: Field, value: Given<Written>) {
        self.scalars.insert(field, value);
    }

    /// Replaces the whole table; points from earlier sources are dropped. The number of entries is
    /// set to the number of points.
    pub fn set_table(&mut self, points: Vec<WrittenPoint>, whole: &Given<()>) {
        let count = points.len();
        self.table = (0..).zip(points).collect();
        self.set(
            Field::TableEntries,
            whole.with(Written::new(&count.to_string())),
        );
    }

    /// Replaces values by those of another source.
    pub fn override_with(&mut self, other: Self) {
        if !other.table.is_empty() {
            self.table = other.table;
        }
        self.scalars.extend(other.scalars);
    }

    /// Whether the list has no values of friction compensation.
    pub fn is_empty(&self) -> bool {
        self.scalars.is_empty() && self.table.is_empty()
    }

    /// Returns the value as written for a parameter.
    pub fn get(&self, field: Field) -> Option<&Given<Written>> {
        self.scalars.get(&field)
    }

    /// Returns the place that represents the whole structure: the mode, else the first written
    /// value.
    pub fn anchor(&self) -> Option<Given<()>> {
        let point = || self.table.values().next();
        self.get(Field::Mode)
            .or_else(|| self.scalars.values().next())
            .or_else(|| point().and_then(|point| point.input.as_ref().or(point.output.as_ref())))
            .map(|given| given.with(()))
    }

    /// Returns the reserved table size; 0 and invalid values mean the default (P-COMP-00062).
    pub(super) fn max_points(&self) -> u32 {
        let number = self.get(Field::MaxPoints).and_then(|g| g.value.number);
        match number {
            Some(Number::Integer(value)) => u32::try_from(value)
                .ok()
                .filter(|&points| points > 0)
                .unwrap_or(DEFAULT_MAX_POINTS),
            _ => DEFAULT_MAX_POINTS,
        }
    }

    /// Returns the rows of the table of effective parameters; none if nothing is written.
    pub(super) fn parameters(&self, axis_type: AxisType) -> Vec<Parameter> {
        if self.is_empty() {
            return Vec::new();
        }
        let shown = |written: &Written| match written.number {
            Some(number) => number.to_string(),
            None => written.text.clone(),
        };
        let mut rows: Vec<_> = Field::ALL
            .into_iter()
            .map(|field| Parameter {
                number: field.number(),
                key: format!("{STRUCTURE}{}", field.name()),
                value: match self.get(field) {
                    _ if field == Field::MaxPoints => self.max_points().to_string(),
                    Some(given) if floored(field, &given.value) => "0".to_owned(),
                    Some(given) => shown(&given.value),
                    None => field.default().to_string(),
                },
                unit: field.unit(axis_type),
                origin: self.get(field).map_or(Origin::Default, Origin::from),
            })
            .collect();
        let velocity = if axis_type == AxisType::Linear {
            "\u{b5}m/s"
        } else {
            "0.001\u{b0}/s"
        };
        for (index, point) in &self.table {
            for (name, given, number, unit) in [
                ("in", &point.input, "P-COMP-00046", velocity),
                ("out", &point.output, "P-COMP-00047", "drive units"),
            ] {
                rows.push(Parameter {
                    number,
                    key: format!("frict_comp.table[{index}].{name}"),
                    value: given
                        .as_ref()
                        .map_or_else(|| "0".to_owned(), |given| shown(&given.value)),
                    unit,
                    origin: given.as_ref().map_or(Origin::Default, Origin::from),
                });
            }
        }
        rows
    }
}

fn floored(field: Field, written: &Written) -> bool {
    matches!(written.number, Some(Number::Integer(value)) if field.floors(value))
}

/// Prefix of the keys of friction compensation.
pub(super) const STRUCTURE: &str = "frict_comp.";

/// Returns the rest of a key after `frict_comp`, in any case.
fn after_structure(pattern: &str) -> Option<&str> {
    let name = STRUCTURE.trim_end_matches('.');
    let (head, rest) = pattern.split_at_checked(name.len())?;
    let ours = head.eq_ignore_ascii_case(name) && (rest.is_empty() || rest.starts_with(['.', '[']));
    ours.then_some(rest)
}

/// Returns FC122 for a key of the structure, unless it is one of the undocumented ones.
fn unknown_key(entry: &Entry, name: &str) -> Option<Diagnostic> {
    let base = name.trim_end_matches("[]");
    if entry.pattern.starts_with(STRUCTURE) && UNDOCUMENTED.contains(&base) {
        return None;
    }
    let diagnostic = Diagnostic::new(
        Code::Fc122,
        entry.key_place(),
        format!("friction compensation has no parameter `{}`", entry.key()),
    );
    let known = Field::ALL
        .into_iter()
        .map(Field::name)
        .chain(["table[].in", "table[].out"])
        .chain(UNDOCUMENTED);
    let index = entry.indices.first().copied().unwrap_or_default();
    let whole = |meant: &str| format!("{STRUCTURE}{}", meant.replace("[]", &format!("[{index}]")));
    let near: Vec<String> = nearest(name, known).into_iter().map(whole).collect();
    let near: Vec<&str> = near.iter().map(String::as_str).collect();
    Some(diagnostic.with_near(entry.written_key(), &near))
}

/// The table size without P-COMP-00062, or with the value 0.
pub const DEFAULT_MAX_POINTS: u32 = 20;

/// One point of the friction table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TablePoint {
    /// Velocity in µm/s, or 0.001°/s, P-COMP-00046.
    pub input: f64,
    /// Motor current in drive units, P-COMP-00047.
    pub output: f64,
}

/// A friction value list that passed the control's checks (chapter 3.3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrictionList {
    /// Distance of the build-up after a reversal in 0.1 µm or 0.0001°, P-COMP-00043.
    pub position_delay: i32,
    /// CNC cycles of the decay before a reversal, P-COMP-00044.
    pub reversal_lookahead: u16,
    /// Scaling of all outputs in 0.1 %, P-COMP-00045.
    pub scaling_factor: i16,
    /// Dead time of the output in CNC cycles, P-COMP-00058.
    pub delay_cycles: i16,
    /// Reserved table size, P-COMP-00062.
    pub max_points: u32,
    /// The points that are used, velocities ascending.
    pub table: Vec<TablePoint>,
}
