//! A contour for people.

use std::fmt::Write as _;

use super::recorder::ContourRecorder;
use crate::contour::{ContourReversal, ContourSummary, Deviations, ListSource, ProgramContour};
use crate::report::visible::visible_line;

/// What was driven.
#[derive(Debug, Clone)]
pub struct ContourSubject {
    /// The program.
    pub program: String,
    /// The plant.
    pub plant: String,
}

/// The figures of the three runs, a sentence for each axis, the worst reversals, and what is not
/// modelled.
pub fn render_text(
    contour: &mut ProgramContour<ContourRecorder<'_>>,
    subject: &ContourSubject,
) -> String {
    let mut out = String::new();
    let axes = &contour.options().axes;
    let _ = writeln!(
        out,
        "{}: contour in the plane {}{}, {:.3} s of machine time, plant {}\n",
        visible_line(&subject.program),
        axes[0].name,
        axes[1].name,
        contour.machine_time_s(),
        visible_line(&subject.plant),
    );
    let runs = contour.deviations();
    let runs = [&runs.programmed, &runs.all_on, &runs.all_off];
    let _ = writeln!(
        out,
        "{:<24}{:>12}{:>12}{:>12}",
        "while cutting, in µm", "programmed", "all on", "all off"
    );
    let mut row = |name: &str, values: [f64; 3]| {
        let _ = write!(out, "{name:<24}");
        for value in values {
            let _ = write!(out, "{:>12.2}", value + 0.0);
        }
        out.push('\n');
    };
    row("largest deviation", runs.map(Deviations::max_um));
    row("outermost", runs.map(|run| run.outermost_um));
    row("innermost", runs.map(|run| run.innermost_um));
    row("root mean square", runs.map(Deviations::rms_um));
    out.push('\n');
    for axis in contour.axes() {
        let _ = writeln!(out, "{}", sentence(axis));
    }
    push_beside_the_plane(&mut out, contour.axes());
    push_worst(&mut out, contour.sink().worst());
    out.push('\n');
    for axis in &contour.options().axes {
        let source = match &axis.source {
            ListSource::Machine => "the list of the machine".to_owned(),
            ListSource::Given(file) => visible_line(file).into_owned(),
            ListSource::Plant => {
                "the friction curve of the plant; the machine has no list that the control takes, and \
                 without one the control adds nothing"
                    .to_owned()
            }
        };
        let _ = writeln!(out, "compensation of {}: {source}", axis.name);
    }
    let backlash = contour
        .options()
        .axes
        .iter()
        .all(|axis| axis.drive.backlash_m == 0.0);
    let _ = writeln!(
        out,
        "not modelled: cutting forces, errors of the machine's geometry{}",
        if backlash { ", backlash" } else { "" }
    );
    let unknown = contour.time_not_of_the_machine_s();
    if unknown > 0.0 {
        let _ = writeln!(
            out,
            "left out: {unknown:.3} s in which positions are those of the program, not of the machine"
        );
    }
    if contour.left_out() > 0 {
        let motions = match contour.left_out() {
            1 => "1 motion".to_owned(),
            count => format!("{count} motions"),
        };
        let _ = writeln!(
            out,
            "left out: {motions} whose start, end or feed is not known"
        );
    }
    out
}

/// A glitch in µm that a deviation in its plane would show.
const NOTICEABLE_UM: f64 = 1.0;

/// Says that an axis beside the plane deviates, too: in the plane that is not seen.
fn push_beside_the_plane(out: &mut String, axes: &[ContourSummary]) {
    let [first, second, further @ ..] = axes else {
        return;
    };
    for axis in further {
        let worst = axis.worst.as_ref();
        if worst.is_some_and(|worst| worst.reversal.glitch_um.all_off > NOTICEABLE_UM) {
            let _ = writeln!(
                out,
                "the deviations above are those in the plane {}{}; `--plane {},{}` shows those of {}",
                first.axis, second.axis, first.axis, axis.axis, axis.axis
            );
        }
    }
}

/// "X reverses 412 times while cutting, 57 times without compensation: …"
fn sentence(axis: &ContourSummary) -> String {
    let mut text = format!("{} ", axis.axis);
    let rapid = match axis.rapid {
        0 => String::new(),
        rapid => format!(" ({} in rapid)", times(rapid)),
    };
    match axis.cutting {
        0 => {
            let _ = write!(text, "does not reverse while cutting{rapid}");
        }
        cutting => {
            let _ = write!(text, "reverses {} while cutting{rapid}", times(cutting));
            if axis.uncompensated == 0 {
                text.push_str(", always with compensation");
            } else {
                let _ = write!(
                    text,
                    ", {} without compensation: {:.1} µm there against {:.1} µm with it",
                    times(axis.uncompensated),
                    axis.uncompensated_um,
                    axis.compensated_um
                );
            }
        }
    }
    if let Some(worst) = &axis.worst {
        let worst = &worst.reversal;
        let _ = write!(
            text,
            "; worst at {}:{}, {:.1} µm",
            visible_line(&worst.file),
            worst.line,
            worst.glitch_um.programmed
        );
    }
    text
}

fn times(count: u64) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        count => format!("{count} times"),
    }
}

fn push_worst(out: &mut String, worst: &[ContourReversal]) {
    if worst.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "\nworst reversals, glitch in µm\n{:>7}  {:<4} {:<12} {:>9} {:>12} {:>12} {:>9} {:>9}",
        "line", "axis", "state", "mm/min", "mm/s²", "programmed", "all on", "all off"
    );
    for reversal in worst {
        let glitch = &reversal.glitch_um;
        let _ = writeln!(
            out,
            "{:>7}  {:<4} {:<12} {:>9.0} {:>12.0} {:>12.2} {:>9.2} {:>9.2}",
            reversal.line,
            visible_line(&reversal.axis),
            reversal.state.as_str(),
            reversal.feed_mm_per_min,
            reversal.acceleration_mm_per_s2.round() + 0.0,
            glitch.programmed,
            glitch.all_on,
            glitch.all_off
        );
    }
}
