//! Value lists as text.

use std::fmt::{Display, Write as _};

use super::friction::{Field, STRUCTURE};
use super::friction::{FrictionList, TablePoint};
use crate::comp::CncBuild;
use crate::text::is_hidden;

/// Form of the points in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Points {
    /// As whole numbers (SGN32), which every build of the control reads.
    Whole,
    /// As real numbers, outputs with three decimals, which newer builds read.
    Real,
}

/// Real outputs have three decimals.
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
    /// Its name, P-COMP-00002 (`kopf.log_achs_name`); left out if it is not a plain word.
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
