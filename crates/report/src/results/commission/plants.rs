//! Fitted plants in words (R16.3, R16.7, R16.9).

use std::fmt::Write as _;

use frictcomp::diagnostic::Rounded;
use frictcomp_physics::circle::Extent;
use frictcomp_recordings::commission::{
    ComparedGlitch, PlantAxis, PlantFound, PlantVerdict, Plants,
};
use serde::Serialize;

use crate::assumptions::{not_modelled, not_modelled_line};
use crate::document::{Document, Table};
use crate::wording::visible_line;

/// A plant as JSON.
#[derive(Serialize)]
pub(super) struct FittedPlantRecord<'a> {
    #[serde(flatten)]
    verdict: &'a PlantVerdict,
    not_modelled: Vec<&'static str>,
}

impl<'a> FittedPlantRecord<'a> {
    pub(super) fn of(verdict: &'a PlantVerdict) -> Self {
        Self {
            verdict,
            not_modelled: not_modelled([&verdict.base.x, &verdict.base.y]),
        }
    }
}

/// Returns the reasons why no plant is fitted to all recordings.
pub(super) fn lacking(plants: &Plants) -> Vec<&str> {
    if plants.is_wanted {
        plants.lacking.iter().map(String::as_str).collect()
    } else {
        vec!["`--plant` does not say what is known of the machine"]
    }
}

/// A fitted parameter in words.
struct FittedParameter {
    name: &'static str,
    unit: &'static str,
    /// The value; "at least" if only its lower end is known.
    value: String,
    /// The 95 % range.
    range: String,
}

/// Returns the fitted parameters of an axis.
fn parameters(axis: &PlantAxis) -> [FittedParameter; 6] {
    const UM_PER_M: f64 = 1e6;
    const MS_PER_S: f64 = 1e3;
    let scaled = |name, unit, extent: Extent, factor: f64, digits| {
        let number = |value: f64| Rounded(value * factor, digits).to_string();
        let value = if extent.at_bound {
            "at its bound".to_owned()
        } else if extent.is_determined() {
            number(extent.value)
        } else {
            format!("at least {}", number(extent.low))
        };
        FittedParameter {
            name,
            unit,
            value,
            range: format!("{} to {}", number(extent.low), number(extent.high)),
        }
    };
    let delay = scaled("delay of the loop", "ms", axis.delay, MS_PER_S, 1);
    [
        scaled("contact stiffness", "N/µm", axis.contact, 1.0 / UM_PER_M, 0),
        scaled("Kp", "kN·s/m", axis.speed_gain, 1.0 / MS_PER_S, 1),
        scaled("Fc", "N", axis.coulomb, 1.0, 0),
        // The delay is a range, however precisely it is known.
        FittedParameter {
            value: delay.range.clone(),
            ..delay
        },
        scaled("contact damping", "kN·s/m", axis.damping, 1.0 / MS_PER_S, 1),
        FittedParameter {
            value: Rounded(axis.lost.value * UM_PER_M, 1).to_string(),
            ..scaled("lost motion", "µm", axis.lost, UM_PER_M, 1)
        },
    ]
}

/// Appends the last plant, and the lists that were tuned on it.
pub(super) fn push_plants(out: &mut Document<'_>, plants: &Plants) {
    let lacking = lacking(plants).into_iter();
    out.lines(lacking.map(|reason| format!("\nno plant is fitted: {}", visible_line(reason))));
    let Some(verdict) = plants.verdicts.last() else {
        return;
    };
    out.section("Plant");
    push_plant(out, verdict);
    out.lines([not_modelled_line(&not_modelled([
        &verdict.base.x,
        &verdict.base.y,
    ]))]);
    for (title, reasons) in [
        (
            "the plant is rejected, and the earlier lists stay:",
            &verdict.rejected,
        ),
        (
            "the machine does better than the plant, with which nothing is predicted from now on:",
            &verdict.retired,
        ),
    ] {
        if !reasons.is_empty() {
            out.lines([title]);
            out.lines(reasons.iter().map(|it| format!("  {}", visible_line(it))));
        }
    }
    for list in verdict.lists() {
        let _ = writeln!(
            out,
            "{}: tuned list {}, predicted to leave at most {:.1} µm; no recording has shown it yet",
            visible_line(&list.axis),
            visible_line(&list.file),
            list.predicted_um
        );
        let against = list.against.iter();
        out.lines(against.map(|it| format!("  do not record it: {}", visible_line(it))));
    }
    if verdict.holds() && verdict.found.lists.is_empty() {
        out.push_str(
            "no list is tuned: no feed is left to hold out; record a fifth feed off and on\n",
        );
    }
}

fn push_plant(out: &mut Document<'_>, verdict: &PlantVerdict) {
    let found = &verdict.found;
    let feeds = |feeds: &[f64]| {
        let feeds: Vec<String> = feeds.iter().map(|it| format!("F{it}")).collect();
        feeds.join(", ")
    };
    let _ = writeln!(
        out,
        "\nplant fitted to circles off and on up to round {}, at {}; held out: {}",
        found.round,
        feeds(&found.fitted_feeds),
        if found.held_out.is_empty() {
            "none".to_owned()
        } else {
            feeds(&found.held_out)
        }
    );
    for axis in &found.axes {
        let table = Table::default().left(visible_line(&axis.axis));
        let mut table = table
            .left("predicted")
            .left("")
            .right("")
            .left("95 % range");
        for it in parameters(axis) {
            table.row(&[&"", &it.name, &it.unit, &it.value, &it.range]);
        }
        out.table(table);
        let _ = writeln!(
            out,
            "{:.2} µm are left of {} recorded reversals, after {} simulated ones",
            axis.left, axis.reversals, axis.simulations
        );
    }
    push_compared(out, &verdict.compared);
    if verdict.retired.is_empty() {
        push_glitches(out, found);
    }
}

/// Returns `off`, or the beginning of the SHA-256 of the list that was on, as in the file names.
fn list_on(compared: &ComparedGlitch) -> &str {
    let list = compared.recorded.list.as_deref();
    list.map_or("off", |sum| sum.get(..8).unwrap_or(sum))
}

/// Appends the recorded glitches with their predictions.
fn push_compared(out: &mut Document<'_>, compared: &[ComparedGlitch]) {
    if compared.is_empty() {
        return;
    }
    let table = Table::of_numbers(["feed mm/min"]).left("axis").left("list");
    let mut table = table.right("predicted").right("recorded");
    for it in compared {
        table.row(&[
            &it.recorded.feed,
            &visible_line(&it.recorded.axis),
            &list_on(it),
            &format_args!("{:.1}", it.predicted_um),
            &format_args!("{:.1}", it.recorded.um),
        ]);
    }
    out.push_str(
        "glitches that the plant was not fitted to, recorded and predicted in µm, each a mean over 8 ms\n",
    );
    out.table(table);
}

/// Appends the predicted glitch of each axis at each feed, off and with the tuned lists.
fn push_glitches(out: &mut Document<'_>, found: &PlantFound) {
    for axis in &found.axes {
        let name = &axis.axis;
        let tuned = found.lists.iter().find(|it| it.axis == *name);
        let mut table = Table::of_numbers(["feed mm/min", "off", "tuned"]).left("");
        for feed in found.feeds() {
            let off = found.predicted(name, feed, None);
            let on = tuned.and_then(|it| found.predicted(name, feed, Some(&it.sha256)));
            let shown = |um: Option<f64>| um.map_or("-".to_owned(), |it| format!("{it:.1}"));
            let held = if found.is_held_out(feed) {
                "held out"
            } else {
                ""
            };
            table.row(&[&feed, &shown(off), &shown(on), &held]);
        }
        out.lines([format!("{} predicted glitch in µm", visible_line(name))]);
        out.table(table);
    }
}
