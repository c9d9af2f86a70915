//! Friction compensation in a value list: the `frict_comp` structure (chapter 3.3).
//!
//! This file collects the written values; `check` decides on the control's reaction.

use std::collections::BTreeMap;
use std::fmt::{Display, Write as _};
use std::ops::RangeInclusive;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::check::{Conditions, Verdict};
use super::line::{Entries, Entry, Given, Number, Written};
use super::parameter::{AxisType, Origin, Parameter};
use crate::comp::CncBuild;
use crate::diagnostic::{Code, Diagnostic, Severity, nearest};
use crate::text::{SourceFile, is_hidden};

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

    /// Returns whether a value is an end of an interval that is documented as open (R3.45).
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

    /// Returns whether a value of this parameter counts as 0, being a negative distance or time (R3.25).
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
    /// Points by index; only written ones take memory, however large the index.
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

    /// Returns whether the list has no values of friction compensation.
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

/// A value list that the control would accept.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ReadList {
    /// The values.
    pub list: FrictionList,
    /// Messages on the values.
    pub diagnostics: Vec<Diagnostic>,
}

/// A value list that gives the control no values.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct NoValues {
    /// The reason, in a few words.
    pub reason: &'static str,
    /// Messages on the lines that are the reason.
    pub diagnostics: Vec<Diagnostic>,
}

impl FrictionList {
    /// Returns whether all outputs are 0, or scaled to 0.
    pub fn adds_nothing(&self) -> bool {
        self.scaling_factor == 0 || self.table.iter().all(|point| point.output == 0.0)
    }

    /// Reads the values that this list alone would give the control.
    ///
    /// # Errors
    /// The control would not accept them.
    pub fn read(source: SourceFile) -> Result<ReadList, NoValues> {
        let source = Arc::new(source);
        let entries = Entries::parse(&source);
        let mut diagnostics = entries.diagnostics.clone();
        let draft = FrictionDraft::from_entries(&entries, &mut diagnostics);
        let reading = draft.check(&Conditions::default());
        diagnostics.extend(reading.diagnostics);
        let reason = match reading.verdict {
            Verdict::Accepted(list) => return Ok(ReadList { list, diagnostics }),
            Verdict::Absent => "it holds no friction parameters",
            Verdict::Off => "its mode is 0, off",
            Verdict::Rejected(_) => "the control would reject it",
        };
        diagnostics.retain(|diagnostic| diagnostic.severity == Severity::Error);
        Err(NoValues {
            reason,
            diagnostics,
        })
    }
}

/// Form of the points in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Points {
    /// Whole numbers (SGN32), which every build of the control reads.
    Whole,
    /// Real numbers, outputs with three decimals, which newer builds read.
    Real,
}

/// Factor of the three decimals of real outputs.
const DECIMALS: f64 = 1000.0;

impl Points {
    /// Returns the form that a build reads (P-COMP-00046, P-COMP-00047): whole numbers, unless the build
    /// is known to read real ones.
    pub fn of_build(build: Option<CncBuild>) -> Self {
        match build {
            Some(build) if build.reads_real_points() => Self::Real,
            _ => Self::Whole,
        }
    }

    /// Returns the points as written. Velocities that round to the same value become one point (R3.20).
    pub fn rounded(self, table: &[TablePoint]) -> Vec<TablePoint> {
        if self == Self::Real {
            let written = |point: &TablePoint| TablePoint {
                output: (point.output * DECIMALS).round() / DECIMALS,
                ..*point
            };
            return table.iter().map(written).collect();
        }
        let mut whole: Vec<TablePoint> = Vec::with_capacity(table.len());
        for point in table {
            let input = point.input.round();
            if whole.last().is_none_or(|before| input > before.input) {
                let output = point.output.round();
                whole.push(TablePoint { input, output });
            }
        }
        whole
    }

    /// Formats an output in drive units; never a negative zero.
    fn output(self, output: f64) -> String {
        match self {
            Self::Whole => format!("{:.0}", output + 0.0),
            Self::Real if output.abs() < 0.5e-3 => "0.000".to_owned(),
            Self::Real => format!("{output:.3}"),
        }
    }
}

/// Comment above the values of a list.
#[derive(Debug, Clone, Copy, Default)]
pub struct ListHead<'a> {
    /// Remarks, one line each.
    pub remarks: &'a [&'a str],
    /// The logical number of the axis, P-COMP-00001 (`kopf.achs_nr`).
    pub number: Option<u32>,
    /// Name, P-COMP-00002 (`kopf.log_achs_name`); left out if it is not a plain word.
    pub name: Option<&'a str>,
}

/// Writes a value list as the control reads it, switched on, below its head. Reading it back gives the same list,
/// except for the decimals of its points.
///
/// ```
/// use frictcomp::lists::{FrictionList, ListHead, Points, TablePoint, write_value_list};
///
/// let list = FrictionList {
///     position_delay: 9,
///     reversal_lookahead: 2,
///     scaling_factor: 1000,
///     delay_cycles: 1,
///     max_points: 20,
///     table: vec![TablePoint { input: 0.0, output: 103.3 }],
/// };
/// let head = ListHead { remarks: &["measured in May"], name: Some("X"), ..ListHead::default() };
/// let text = write_value_list(&list, Points::Whole, &head);
/// assert!(text.starts_with("# measured in May\nkopf.log_achs_name              X\n"));
/// assert!(text.contains("frict_comp.table[0].out         103\n"));
/// ```
pub fn write_value_list(list: &FrictionList, points: Points, head: &ListHead<'_>) -> String {
    let mut out = String::new();
    for remark in head.remarks {
        let _ = writeln!(out, "# {}", remark.replace(is_hidden, " "));
    }
    let mut entry = |key: &str, value: &dyn Display| {
        let _ = writeln!(out, "{key:<31} {value}");
    };
    if let Some(number) = head.number {
        entry("kopf.achs_nr", &number);
    }
    let is_plain = |name: &&str| {
        let mut letters = name.chars();
        !name.is_empty() && letters.all(|it| it.is_ascii_alphanumeric() || it == '_')
    };
    if let Some(name) = head.name.filter(is_plain) {
        entry("kopf.log_achs_name", &name);
    }
    let mut line = |key: &str, value: &dyn Display| entry(&format!("{STRUCTURE}{key}"), value);
    let table = points.rounded(&list.table);
    for field in Field::ALL {
        let value: &dyn Display = match field {
            Field::Mode => &3,
            Field::MaxPoints => &list.max_points,
            Field::TableEntries => &table.len(),
            Field::PositionDelay => &list.position_delay,
            Field::ReversalLookahead => &list.reversal_lookahead,
            Field::ScalingFactor => &list.scaling_factor,
            Field::DelayCycles => &list.delay_cycles,
        };
        line(field.name(), value);
    }
    for (at, point) in table.iter().enumerate() {
        line(&format!("table[{at}].in"), &point.input);
        line(&format!("table[{at}].out"), &points.output(point.output));
    }
    out.push_str("Ende\n");
    out
}

#[cfg(test)]
mod tests {
    use super::super::friction::TablePoint;
    use super::super::friction::{ListHead, Points, write_value_list};
    use super::*;

    #[test]
    fn a_list_is_taken_or_refused_as_a_whole() {
        let read = |text: &str| FrictionList::read(SourceFile::new("x.lis", text));
        let point = |input, output| TablePoint { input, output };
        let list = FrictionList {
            position_delay: 10,
            reversal_lookahead: 2,
            scaling_factor: 1000,
            delay_cycles: 0,
            max_points: 20,
            table: vec![point(0.0, 126.0), point(3000.0, 112.0)],
        };
        let text = write_value_list(&list, Points::Whole, &ListHead::default());
        assert_eq!(read(&text).map(|read| read.list), Ok(list));
        let reason = |text: &str| read(text).map_err(|refused| refused.reason);
        assert_eq!(
            reason("# nothing\n"),
            Err("it holds no friction parameters")
        );
        let rejected = read(&text.replace("3000", "0")).unwrap_err();
        assert_eq!(rejected.reason, "the control would reject it");
        assert!(!rejected.diagnostics.is_empty());
    }
}
