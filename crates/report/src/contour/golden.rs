//! A contour as it is agreed on: figures with one decimal, and no line numbers, so that a change
//! shows where it is and nowhere else.

use std::fmt::Write as _;

use crate::visible::visible_line;
use frictcomp_physics::contour::{
    BlockDeviation, BlockDeviations, ContourObstacle, Deviations, GlitchFigure, PerRun,
    ProgramContour,
};

/// Driven program, and its start.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct GoldenContour {
    /// Path of the program.
    pub program: String,
    /// The plant.
    pub plant: String,
    /// Positions of axes before the program.
    pub start: Vec<(String, f64)>,
}

/// The figures of the three runs, the counts of each axis, and for each block that is cut its
/// largest deviation, with the glitches of its reversals below. Each figure is followed by `µm`.
pub fn render_agreed(
    contour: &mut ProgramContour<BlockDeviations>,
    subject: &GoldenContour,
) -> String {
    let mut out = String::new();
    let axes = &contour.options().axes;
    let start = subject.start.iter();
    let start: Vec<String> = start.map(|(axis, at)| format!("{axis}{at}")).collect();
    let _ = writeln!(
        out,
        "contour of {} in the plane {}{}, plant {}{}\n",
        visible_line(&subject.program),
        axes[0].name,
        axes[1].name,
        visible_line(&subject.plant),
        match start.as_slice() {
            [] => String::new(),
            start => format!(", from {}", start.join(" ")),
        }
    );
    push_figures(&mut out, contour.deviations());
    let least = if contour.is_whole() { "" } else { "at least " };
    for axis in contour.axes() {
        let _ = writeln!(
            out,
            "{} reverses {least}{} times while cutting, {} of them without compensation",
            axis.axis, axis.cutting, axis.uncompensated
        );
    }
    let (errors, remarks) = contour.diagnostics();
    for said in errors.iter().chain(remarks) {
        let _ = writeln!(out, "{}: {}", said.code, visible_line(&said.message));
    }
    for obstacle in contour.obstacles() {
        if let ContourObstacle::AssumedLimits(_) = obstacle {
            let _ = writeln!(out, "not judged: {obstacle}");
        }
    }
    if contour.left_out() > 0 {
        let _ = writeln!(out, "{} motions are left out", contour.left_out());
    }
    if contour.time_not_of_the_machine_s() > 0.0 {
        out.push_str("some positions are those of the program, not of the machine\n");
    }
    out.push('\n');
    let blocks = std::mem::take(contour.sink()).into_blocks();
    let mut file = blocks.first().map(|block| block.file.clone());
    for block in blocks.iter().filter(|block| !block.stretches.is_empty()) {
        if file.as_ref() != Some(&block.file) {
            let _ = writeln!(out, "in {}", visible_line(&block.file));
            file = Some(block.file.clone());
        }
        push_block(&mut out, block);
    }
    out
}

fn push_figures(out: &mut String, runs: &PerRun<Deviations>) {
    let runs = [&runs.programmed, &runs.all_on, &runs.all_off];
    for (name, [programmed, all_on, all_off]) in [
        ("largest deviation", runs.map(Deviations::max_um)),
        ("root mean square", runs.map(Deviations::rms_um)),
    ] {
        let _ = writeln!(
            out,
            "{name:<18} as programmed {programmed:>6.1} µm, all on {all_on:>6.1} µm, all off \
             {all_off:>6.1} µm"
        );
    }
}

fn push_block(out: &mut String, block: &BlockDeviation) {
    let _ = writeln!(
        out,
        "{:>6.1} µm  {}",
        block.max_um(),
        visible_line(&block.text)
    );
    let mut glitches: Vec<String> = block
        .reversals
        .iter()
        .map(|reversal| {
            let axis = visible_line(&reversal.axis);
            match reversal.figure {
                GlitchFigure::Measured => format!("{axis} {:.1} µm", reversal.glitch_um),
                GlitchFigure::AlongPath => format!("{axis} along the path"),
                GlitchFigure::Missing => format!("{axis} without a figure"),
            }
        })
        .collect();
    match block.more_reversals {
        (0, _) => {}
        (more, Some(largest)) => glitches.push(format!("{more} more {largest:.1} µm")),
        (more, None) => glitches.push(format!("{more} more without a figure")),
    }
    if !glitches.is_empty() {
        let _ = writeln!(out, "           reversals: {}", glitches.join(", "));
    }
}
