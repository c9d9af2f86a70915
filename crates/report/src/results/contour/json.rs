//! A whole contour as data.

use serde_json::{Value, json};

use super::document::headline;
use super::places::record;
use super::recorder::ContourRecorder;
use super::records::reversal_record;
use crate::assumptions::not_modelled;
use crate::wording::{to_json, to_json_line};
use frictcomp_physics::contour::{
    ContourLimits, ContourOptions, ContourReport, ContourReversal, ContourSummary, ContourVerdict,
    Deviations, ListSource,
};
use frictcomp_physics::motion::{AssumedLimits, Departure};

fn figures(deviations: &Deviations) -> Value {
    json!({
        "max": deviations.max_um(),
        "max_at": record(deviations.max_at().map(|at| &**at)),
        "rms": deviations.rms_um(),
        "outermost": deviations.outermost_um,
        "outermost_at": record(deviations.outermost_at.as_deref()),
        "innermost": deviations.innermost_um,
        "innermost_at": record(deviations.innermost_at.as_deref()),
    })
}

/// Returns the counts of an axis, its drive, and the relation of its list to that.
fn axis_record(counted: &ContourSummary, options: &ContourOptions) -> Value {
    let glitch = |of: fn(&ContourReversal) -> f64| counted.dearest.as_ref().map_or(0.0, of);
    let mut axis = json!({
        "axis": counted.axis,
        "cutting": counted.cutting,
        "rapid": counted.rapid,
        "uncompensated": counted.uncompensated,
        "unmeasured": counted.unmeasured,
        "glitch_uncompensated": glitch(|it| it.glitch_um.programmed),
        "glitch_compensated": glitch(|it| it.glitch_um.all_on),
        "uncompensated_at": record(counted.dearest.as_ref()),
        "worst": Value::Null,
    });
    if let Some(worst) = &counted.worst {
        axis["worst"] = record(Some(worst));
        axis["worst"]["glitch"] = worst.glitch_um.programmed.into();
    }
    let driven = options.axes.iter().find(|it| it.name == counted.axis);
    if let Some(driven) = driven {
        let fit = options.list_fit(driven);
        axis["list"] = match &driven.source {
            ListSource::Machine => "machine".into(),
            ListSource::Given(file) => file.as_str().into(),
            ListSource::Plant => "plant".into(),
        };
        axis["newtons_per_unit"] = driven.newtons_per_unit().into();
        axis["list_to_friction"] = fit.and_then(|fit| fit.share()).into();
        axis["belongs"] = fit.is_none_or(|fit| fit.belongs()).into();
    }
    axis
}

fn feed_record(contour: &ContourReport) -> Value {
    let feed = &contour.feed;
    json!({
        "programmed": feed.programmed_mm_per_min(),
        "reached": feed.reached_mm_per_min(),
        "slow_share": feed.slow_share(),
        "slow_share_assumed": contour.slow_share_by_assumed,
    })
}

/// Returns the treatment of the transitions between feed moves, lengths in µm.
fn transitions_record(contour: &ContourReport) -> Value {
    let transitions = &contour.transitions;
    let departure =
        |from: &Departure| json!({ "max": from.um, "max_at": record(from.at.as_deref()) });
    json!({
        "joined": transitions.joined,
        "rounded": transitions.rounded,
        "slow": transitions.slow,
        "rounding": departure(&transitions.rounding),
        "sagitta": departure(&transitions.sagitta),
    })
}

fn limits_record(axis: &AssumedLimits) -> Value {
    json!({
        "axis": axis.axis,
        "max_velocity": axis.max_velocity,
        "max_acceleration": axis.max_acceleration,
        "max_jerk": axis.max_jerk,
    })
}

/// Returns the figures of the three runs, the counts of each axis, and their totals.
fn summary_record(contour: &ContourReport, limits: &ContourLimits) -> Value {
    let deviations = &contour.deviations;
    let due = &contour.due;
    let verdict = limits.verdict(contour);
    let reasons = contour.obstacles.iter().map(ToString::to_string);
    let axes = contour.axes.iter();
    let axes = axes.map(|axis| axis_record(axis, &contour.options));
    json!({
        "schema": 1,
        "headline": headline(contour),
        "machine_time": contour.machine_time_s,
        "verdict": verdict.map(ContourVerdict::as_str),
        "not_judged": reasons.collect::<Vec<String>>(),
        "programmed": figures(&deviations.programmed),
        "all_on": figures(&deviations.all_on),
        "all_off": figures(&deviations.all_off),
        "due": { "max": due.um, "max_at": record(due.at.as_deref()) },
        "feed": feed_record(contour),
        "transitions": transitions_record(contour),
        "assumed_limits": contour.assumed_limits.iter().map(limits_record).collect::<Vec<Value>>(),
        "axes": axes.collect::<Vec<Value>>(),
        "left_out": contour.left_out,
        "cut_short": contour.is_cut_short,
        "whole": contour.is_whole(),
        "time_not_of_the_machine": contour.time_not_of_the_machine_s,
        "not_modelled": not_modelled(contour.options.axes.iter().map(|axis| &axis.drive)),
        "rests_on": &contour.rests_on,
    })
}

/// Returns the figures and counts as one line, below the reversals.
pub fn render_summary(contour: &ContourReport, limits: &ContourLimits) -> String {
    let mut record = summary_record(contour, limits);
    record["record"] = "summary".into();
    to_json_line(&record)
}

/// Renders the whole contour as one document.
pub fn render_json(
    contour: &ContourReport,
    recorder: &ContourRecorder<'_>,
    limits: &ContourLimits,
) -> String {
    let mut document = summary_record(contour, limits);
    let names = names(contour);
    let reversals = recorder.reversals().iter();
    let reversals = reversals.map(|reversal| reversal_record(reversal, &names));
    document["reversals"] = reversals.collect::<Vec<Value>>().into();
    let (switches, _) = recorder.switches();
    let switches = switches
        .iter()
        .map(|switch| reversal_record(switch, &names));
    document["switches"] = switches.collect::<Vec<Value>>().into();
    let blocks = recorder
        .blocks()
        .iter()
        .map(|((file, line), max)| json!({ "file": &**file, "line": line, "max": max }));
    document["blocks"] = blocks.collect::<Vec<Value>>().into();
    to_json(&document)
}

/// Returns the names of the driven axes.
fn names(contour: &ContourReport) -> Vec<String> {
    let axes = contour.options.axes.iter();
    axes.map(|axis| axis.name.clone()).collect()
}
