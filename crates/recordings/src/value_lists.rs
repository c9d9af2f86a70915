//! Generated value lists, with remarks on their origin.

use frictcomp::comp::CncBuild;
use frictcomp::lists::{FrictionList, ListHead, Points, write_value_list};
use frictcomp_physics::circle::{Tuned, TunedAxis};

/// The remark in a list for a build that reads fractions.
const FRACTIONS: &str = "Outputs with decimals need the build V3.1.3132.0 or V4.29.0";

/// The unit of the outputs that a control reads.
pub const DRIVE_UNITS: &str = "drive units";

/// The remark in a list that is not in drive units.
const CONVERT: &str = "Convert the outputs to drive units before the control reads this list";

/// Returns the text of a list for a build, with remarks above its head.
fn written<'a>(
    list: &FrictionList,
    build: Option<CncBuild>,
    mut remarks: Vec<&'a str>,
    head: &ListHead<'a>,
) -> String {
    let points = Points::of_build(build);
    if points == Points::Real {
        remarks.push(FRACTIONS);
    }
    let remarks = &remarks;
    write_value_list(list, points, &ListHead { remarks, ..*head })
}

/// Origin of a value list that was tuned on a plant.
#[derive(Debug, Clone, Copy)]
pub struct TunedFor<'a> {
    /// The name of the plant.
    pub plant: &'a str,
    /// The name of the friction model.
    pub model: &'a str,
    /// The result of the tuning.
    pub tuned: &'a Tuned,
    /// The axis of the list.
    pub axis: &'a TunedAxis,
}

/// Returns the accelerations for which lists were tuned, and the largest glitch left there.
pub fn tuned_range(tuned: &Tuned) -> String {
    let [least, most] = tuned.accelerations();
    format!(
        "Tuned for reversals with v\u{b2}/R from {least:.2} to {most:.2} mm/s\u{b2}, where at most {:.2} \u{b5}m are \
         left",
        tuned.worst_um()
    )
}

/// Returns the tuned value list of an axis of a plant, written for a build; nothing if it has none. The head gives the
/// number and the name of the axis.
pub fn render_tuned(made: TunedFor<'_>, build: Option<CncBuild>, head: &ListHead<'_>) -> String {
    let Some(list) = made.axis.list() else {
        return String::new();
    };
    let from = format!(
        "Friction compensation for the plant {}, tuned with the model {}",
        made.plant, made.model
    );
    let range = tuned_range(made.tuned);
    let [x, y] = &made.tuned.axes;
    let whose = match made.axis {
        both if x == y && both == x => "both axes",
        one if one == x => "its X axis",
        _ => "its Y axis",
    };
    let table = format!("The table is the friction curve of {whose}");
    let mut remarks = vec![from.as_str(), range.as_str(), table.as_str()];
    if made.axis.is_shaped {
        remarks.push("Below 1 mm/s it is shaped for the reversals");
    }
    written(list, build, remarks, head)
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

/// Returns an identified value list, written for a build; outputs in another unit than the drive's have decimals, to be
/// converted.
pub fn render_identified(
    list: &FrictionList,
    made: IdentifiedFrom<'_>,
    build: Option<CncBuild>,
) -> String {
    let axis = made.axis.map(|axis| format!(" of axis {axis}"));
    let from = format!(
        "Friction{} identified from {}",
        axis.unwrap_or_default(),
        made.from
    );
    let unit = format!("Outputs are in {}", made.unit);
    let mut remarks = vec![from.as_str(), unit.as_str()];
    remarks.extend(made.faults.iter().map(String::as_str));
    // An axis that is not a name is a number.
    let number = made.axis.and_then(|axis| axis.parse().ok());
    let head = ListHead {
        number,
        name: made.axis.filter(|_| number.is_none()),
        ..ListHead::default()
    };
    if made.unit != DRIVE_UNITS {
        remarks.push(CONVERT);
        let remarks = &remarks;
        return write_value_list(list, Points::Real, &ListHead { remarks, ..head });
    }
    written(list, build, remarks, &head)
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

/// Returns a learned value list, written for a build.
pub fn render_learned(
    list: &FrictionList,
    made: LearnedFrom<'_>,
    build: Option<CncBuild>,
) -> String {
    let from = format!(
        "Friction compensation of axis {} for round {} of learning",
        made.axis, made.round
    );
    let predicted = format!(
        "Predicted with the plant {}: at most {:.2} \u{b5}m are left; no recording has shown it yet",
        made.plant, made.predicted_um
    );
    let remarks = vec![from.as_str(), predicted.as_str()];
    let head = ListHead {
        name: Some(made.axis),
        ..ListHead::default()
    };
    written(list, build, remarks, &head)
}

/// The remark in the head of a list that names the plant on which it was tuned.
const TUNED_ON: &str = "SHA-256 of what the plant was fitted to: ";

/// Returns the key of the fitted plant on which a list was tuned, as the text of the list names it.
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

/// Returns a value list that was tuned on a fitted plant, written for a build.
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
        made.axis,
        feeds(made.feeds)
    );
    let held_out = format!("Held out: {}", feeds(made.held_out));
    let plant = format!("{TUNED_ON}{}", made.plant);
    let predicted = "What it leaves is predicted; no recording has shown it yet";
    let remarks = vec![from.as_str(), held_out.as_str(), plant.as_str(), predicted];
    let head = ListHead {
        name: Some(made.axis),
        ..ListHead::default()
    };
    written(list, build, remarks, &head)
}
