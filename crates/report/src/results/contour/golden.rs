//! A contour to agree on: figures with one decimal, and no line numbers, so that a change shows only
//! where it is.

use super::agreed::{AgreedContour, AgreedLine};
use crate::wording::visible_line;
use frictcomp_physics::contour::{
    BlockDeviation, BlockDeviations, ContourReport, Deviations, GlitchFigure, PerRun,
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

/// Returns the figures of the three runs, the counts of each axis, and for each block that is cut its largest
/// deviation, with the glitches of its reversals below.
pub fn agreed_contour(
    (contour, blocks): (ContourReport, BlockDeviations),
    subject: &GoldenContour,
) -> AgreedContour {
    let mut out = AgreedContour::default();
    let axes = &contour.options.axes;
    let start = subject.start.iter();
    let start: Vec<String> = start.map(|(axis, at)| format!("{axis}{at}")).collect();
    out.say(&format!(
        "contour of {} in the plane {}{}, plant {}{}",
        visible_line(&subject.program),
        axes[0].name,
        axes[1].name,
        visible_line(&subject.plant),
        match start.as_slice() {
            [] => String::new(),
            start => format!(", from {}", start.join(" ")),
        }
    ));
    out.say("");
    for obstacle in &contour.obstacles {
        let words = obstacle.without_places();
        out.say(&format!("not judged: {}", visible_line(&words)));
    }
    push_figures(&mut out, &contour.deviations);
    let least = if contour.is_whole() { "" } else { "at least " };
    for axis in &contour.axes {
        out.say(&format!(
            "{} reverses {least}{} times while cutting, {} of them without compensation",
            axis.axis, axis.cutting, axis.uncompensated
        ));
    }
    for said in contour.diagnostics() {
        out.say(&format!("{}: {}", said.code, visible_line(&said.message)));
    }
    out.say("");
    let blocks = blocks.into_blocks();
    let mut file = blocks.first().map(|block| block.file.clone());
    for block in blocks.iter().filter(|block| !block.stretches.is_empty()) {
        if file.as_ref() != Some(&block.file) {
            out.say(&format!("in {}", visible_line(&block.file)));
            file = Some(block.file.clone());
        }
        push_block(&mut out, block);
    }
    out
}

fn push_figures(out: &mut AgreedContour, runs: &PerRun<Deviations>) {
    let runs = [&runs.programmed, &runs.all_on, &runs.all_off];
    for (name, [programmed, all_on, all_off]) in [
        ("largest deviation", runs.map(Deviations::max_um)),
        ("root mean square", runs.map(Deviations::rms_um)),
    ] {
        let line = AgreedLine::default().and(&format!("{name:<18} as programmed "));
        let line = line.figure(programmed, 6).and(", all on ");
        let line = line.figure(all_on, 6).and(", all off ");
        out.push(line.figure(all_off, 6));
    }
}

fn push_block(out: &mut AgreedContour, block: &BlockDeviation) {
    let line = AgreedLine::default().figure(block.max_um(), 6).and("  ");
    out.push(line.and(&visible_line(&block.text)));
    let reversals = block.reversals.iter().map(|reversal| {
        let figure = match reversal.figure {
            GlitchFigure::Measured => Ok(reversal.glitch_um),
            GlitchFigure::AlongPath => Err("along the path"),
            GlitchFigure::Missing => Err("without a figure"),
        };
        (visible_line(&reversal.axis).into_owned(), figure)
    });
    let more = match block.more_reversals {
        (0, _) => None,
        (more, largest) => Some((format!("{more} more"), largest.ok_or("without a figure"))),
    };
    let mut line = AgreedLine::default().and("           reversals: ");
    for (at, (what, figure)) in reversals.chain(more).enumerate() {
        line = line
            .and(if at == 0 { "" } else { ", " })
            .and(&what)
            .and(" ");
        line = match figure {
            Ok(um) => line.figure(um, 0),
            Err(words) => line.and(words),
        };
    }
    if !block.reversals.is_empty() || block.more_reversals.0 > 0 {
        out.push(line);
    }
}
