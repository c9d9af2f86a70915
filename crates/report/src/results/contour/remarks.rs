//! The basis of the figures of a contour.

use super::places::ProgramBlock;
use crate::assumptions::rests_on_text;
use crate::wording::{Detail, assumed_limits, visible_line};
use frictcomp_physics::contour::{
    ContourAxis, ContourLimits, ContourObstacle, ContourOptions, ContourReport, LimitedFigure,
    ListSource,
};
use frictcomp_physics::motion::{Departure, Transitions};

/// Returns the programmed feed and the reached one, the assumed limits, and lists that do not belong to the plant: one
/// line each (R11.23, R11.25).
pub fn contour_remarks(contour: &ContourReport, detail: Detail) -> Vec<String> {
    let mut lines: Vec<String> = feed(contour).into_iter().collect();
    lines.extend(transitions(&contour.transitions));
    let options = &contour.options;
    let axes = options.axes.iter();
    lines.extend(axes.filter_map(|axis| misfit(axis, options)));
    lines.extend(detail.full(conditions(contour)).into_iter().flatten());
    lines
}

/// Returns the assumed limits, and the readings on which the figures rest: one line each.
pub(super) fn conditions(contour: &ContourReport) -> Vec<String> {
    let assumed = assumed_limits(&contour.assumed_limits).into_iter();
    assumed.chain(rests_on_text(&contour.rests_on)).collect()
}

/// Returns text such as "feed: 2000 mm/min programmed, 105 mm/min reached; 98 % of the cutting time is below 80 % of F".
fn feed(contour: &ContourReport) -> Option<String> {
    let feed = &contour.feed;
    Some(format!(
        "feed: {:.0} mm/min programmed, {:.0} mm/min reached; {:.0} % of the cutting time is below \
         80 % of F",
        feed.programmed_mm_per_min()?,
        feed.reached_mm_per_min()?,
        feed.slow_share() * 100.0
    ))
}

/// Returns the passage of kinks in words: "7199 short lines are driven as curves, at most 0.01 µm
/// from their chords, at …"
fn transitions(transitions: &Transitions) -> Vec<String> {
    let mut lines = Vec::new();
    let at = |departure: &Departure| {
        let at = departure
            .at
            .as_deref()
            .map(|at| ProgramBlock::from(at).words());
        at.map_or(String::new(), |at| format!(", at {at}"))
    };
    let (joined, rounding) = (&transitions.sagitta, &transitions.rounding);
    if transitions.joined > 0 {
        lines.push(format!(
            "{} joined to curves: the sagitta of the lines is at most {:.2} µm{}; deviations are those \
             from the curve",
            counted(transitions.joined, "transition of short lines is", "transitions of short lines are"),
            joined.um,
            at(joined)
        ));
    }
    if transitions.rounded > 0 {
        lines.push(format!(
            "{} rounded by at most {:.1} µm{}; deviations are those from the rounded path",
            counted(transitions.rounded, "corner is", "corners are"),
            rounding.um,
            at(rounding)
        ));
    }
    if transitions.slow > 0 {
        lines.push(format!(
            "{} passed below 80 % of F, because no contour mode rounds {}: `#CONTOUR MODE ON`, `G261` \
             or `#HSC ON` does",
            counted(transitions.slow, "kink is", "kinks are"),
            if transitions.slow == 1 { "it" } else { "them" }
        ));
    }
    lines
}

fn counted(count: u64, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

fn misfit(axis: &ContourAxis, options: &ContourOptions) -> Option<String> {
    let fit = options.list_fit(axis).filter(|fit| !fit.belongs())?;
    Some(format!(
        "list and plant of {} do not belong together: from 1 to 100 mm/s the list adds {:.0} N on \
         average, and the friction of the plant is {:.0} N",
        visible_line(&axis.name),
        fit.added_n + 0.0,
        fit.friction_n
    ))
}

/// Returns text such as "compensation of X: the list of the machine, 5 N a drive unit".
pub(super) fn compensation(axis: &ContourAxis) -> String {
    let newtons = (axis.newtons_per_unit() * 1000.0).round() / 1000.0;
    let name = visible_line(&axis.name);
    match &axis.source {
        ListSource::Machine => {
            format!("compensation of {name}: the list of the machine, {newtons} N a drive unit")
        }
        ListSource::Given(file) => format!(
            "compensation of {name}: {}, {newtons} N a drive unit",
            visible_line(file)
        ),
        ListSource::Plant => format!(
            "compensation of {name}: the friction curve of the plant, {newtons} N a drive unit; the \
             machine has no list that the control takes, and without one the control adds nothing"
        ),
    }
}

/// Returns the reasons why a contour is not judged: one line each.
pub(super) fn not_judged(obstacles: &[ContourObstacle]) -> impl Iterator<Item = String> {
    let lines = obstacles.iter();
    lines.map(|obstacle| format!("not judged: {obstacle}"))
}

/// Returns why a contour is not judged, one line each.
pub fn why_not_judged(contour: &ContourReport) -> Vec<String> {
    not_judged(&contour.obstacles).collect()
}

/// Returns why a contour is not judged, or the limits that it exceeds, one line each; nothing without limits.
pub fn limit_remarks(contour: &ContourReport, limits: &ContourLimits) -> Vec<String> {
    if !limits.any() {
        return Vec::new();
    }
    let exceeded = limits.exceeded(contour).into_iter().map(|it| {
        let figure = match it.figure {
            LimitedFigure::Due => "the cost of missing compensation",
            _ => "the largest deviation",
        };
        let at = ProgramBlock::from(&*it.at).words();
        format!(
            "{figure}, {:.2} µm at {at}, is above {} µm",
            it.um, it.limit_um
        )
    });
    why_not_judged(contour)
        .into_iter()
        .chain(exceeded)
        .collect()
}
