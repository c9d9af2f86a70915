//! Generated value lists, with remarks on their origin.

use super::{TuneReport, tuned_range};
use crate::wording::visible_line;
use frictcomp::comp::CncBuild;
use frictcomp::lists::{FrictionList, ListHead, Points, write_value_list};
use frictcomp_physics::circle::TunedAxis;

/// The remark in a list for a build that reads fractions.
const FRACTIONS: &str = "Outputs with decimals need the build V3.1.3132.0 or V4.29.0";

/// The tuned value list of an axis of a plant, written for a build; nothing if it has none. The head
/// gives the number and the name of the axis.
pub fn render_tuned(
    report: &TuneReport,
    axis: &TunedAxis,
    build: Option<CncBuild>,
    head: &ListHead<'_>,
) -> String {
    let Some(list) = axis.list() else {
        return String::new();
    };
    let points = Points::of_build(build);
    let made = format!(
        "Friction compensation for the plant {}, tuned with the model {}",
        visible_line(&report.plant),
        report.model
    );
    let range = tuned_range(&report.tuned);
    let [x, y] = &report.tuned.axes;
    let whose = match axis {
        both if x == y && both == x => "both axes",
        one if one == x => "its X axis",
        _ => "its Y axis",
    };
    let table = format!("The table is the friction curve of {whose}");
    let mut remarks = vec![made.as_str(), range.as_str(), table.as_str()];
    if axis.is_shaped {
        remarks.push("Below 1 mm/s it is shaped for the reversals");
    }
    if points == Points::Real {
        remarks.push(FRACTIONS);
    }
    let head = ListHead {
        remarks: &remarks,
        ..*head
    };
    write_value_list(list, points, &head)
}

/// Origin of an identified value list.
#[derive(Debug, Clone, Copy)]
pub struct IdentifiedFrom<'a> {
    /// The axis by name or number, if it is given.
    pub axis: Option<&'a str>,
    /// The recordings.
    pub from: &'a str,
    /// The unit of torque and friction.
    pub unit: &'a str,
    /// The faults of the recordings, one line each.
    pub faults: &'a [String],
}

/// An identified value list, written for a build.
pub fn render_identified(
    list: &FrictionList,
    made: IdentifiedFrom<'_>,
    build: Option<CncBuild>,
) -> String {
    let axis = made
        .axis
        .map(|axis| format!(" of axis {}", visible_line(axis)));
    let from = format!(
        "Friction{} identified from {}",
        axis.unwrap_or_default(),
        visible_line(made.from)
    );
    let unit = format!("Outputs are in {}", visible_line(made.unit));
    let points = Points::of_build(build);
    let faults: Vec<_> = made.faults.iter().map(|it| visible_line(it)).collect();
    let mut remarks = vec![from.as_str(), unit.as_str()];
    remarks.extend(faults.iter().map(AsRef::as_ref));
    if points == Points::Real {
        remarks.push(FRACTIONS);
    }
    // An axis that is not a name is a number.
    let number = made.axis.and_then(|axis| axis.parse().ok());
    let head = ListHead {
        remarks: &remarks,
        number,
        name: made.axis.filter(|_| number.is_none()),
    };
    write_value_list(list, points, &head)
}

/// Origin of a learned value list.
#[derive(Debug, Clone, Copy)]
pub struct LearnedFrom<'a> {
    /// The axis.
    pub axis: &'a str,
    /// The round in which it is recorded.
    pub round: usize,
    /// The reference plant.
    pub plant: &'a str,
    /// The largest glitch that is predicted with it.
    pub predicted_um: f64,
}

/// A learned value list, written for a build.
pub fn render_learned(
    list: &FrictionList,
    made: LearnedFrom<'_>,
    build: Option<CncBuild>,
) -> String {
    let from = format!(
        "Friction compensation of axis {} for round {} of learning",
        visible_line(made.axis),
        made.round
    );
    let predicted = format!(
        "Predicted with the plant {}: at most {:.2} \u{b5}m are left; no recording has shown it yet",
        visible_line(made.plant),
        made.predicted_um
    );
    let points = Points::of_build(build);
    let mut remarks = vec![from.as_str(), predicted.as_str()];
    if points == Points::Real {
        remarks.push(FRACTIONS);
    }
    let head = ListHead {
        remarks: &remarks,
        name: Some(made.axis),
        ..ListHead::default()
    };
    write_value_list(list, points, &head)
}

/// The remark in the head of a list that names the plant on which it was tuned.
const TUNED_ON: &str = "SHA-256 of what the plant was fitted to: ";

/// The key of the fitted plant on which a list was tuned, as the text of the list names it.
pub fn tuned_on(text: &str) -> Option<&str> {
    let (_, key) = text.split_once(TUNED_ON)?;
    key.split_whitespace().next()
}

/// Origin of a value list that was tuned on a fitted plant.
#[derive(Debug, Clone, Copy)]
pub struct TunedFrom<'a> {
    /// The axis.
    pub axis: &'a str,
    /// The SHA-256 of what the plant was fitted to.
    pub plant: &'a str,
    /// The feeds in mm/min for which it was tuned.
    pub feeds: &'a [f64],
    /// The feeds that were held out.
    pub held_out: &'a [f64],
}

/// A value list that was tuned on a fitted plant, written for a build.
pub fn render_tuned_on_plant(
    list: &FrictionList,
    made: TunedFrom<'_>,
    build: Option<CncBuild>,
) -> String {
    let feeds = |feeds: &[f64]| {
        let feeds: Vec<String> = feeds.iter().map(|it| format!("F{it}")).collect();
        feeds.join(", ")
    };
    let from = format!(
        "Friction compensation of axis {}, tuned at {} on a plant fitted to recorded circles",
        visible_line(made.axis),
        feeds(made.feeds)
    );
    let held_out = format!("Held out: {}", feeds(made.held_out));
    let plant = format!("{TUNED_ON}{}", made.plant);
    let predicted = "What it leaves is predicted; no recording has shown it yet";
    let points = Points::of_build(build);
    let mut remarks = vec![from.as_str(), held_out.as_str(), plant.as_str(), predicted];
    if points == Points::Real {
        remarks.push(FRACTIONS);
    }
    let head = ListHead {
        remarks: &remarks,
        name: Some(made.axis),
        ..ListHead::default()
    };
    write_value_list(list, points, &head)
}
