//! A measuring program as the control reads it (R16.1, R16.8).

use std::fmt::Write as _;

use super::words::{number, told};
use frictcomp_recordings::commission::{
    Installed, MeasuredAxis, MeasuringProgram, PlanReport, PlanStep, Stage, Turning,
};

/// Returns a program of a plan, with `\n` at the end of each line and ASCII letters only.
pub(super) fn render_program(report: &PlanReport, program: &MeasuringProgram) -> String {
    let plan = &report.plan;
    let mut blocks = NumberedBlocks::default();
    blocks.comment(&format!(
        "measuring program {}: {}",
        program.number,
        told(program, &plan.axes)
    ));
    blocks.comment(&format!(
        "{:.0} s at 100 percent override",
        program.time_s.ceil()
    ));
    for list in &report.lists {
        blocks.comment(&format!(
            "value list {}: SHA-256 {}",
            list.axis, list.sha256
        ));
    }
    blocks.block(&format!("G71 G90 G94 G40 G162 G{}", plane_of(&plan.axes)));
    blocks.comment("no zero offset, no transformation, no rotated coordinates");
    blocks.block("G53");
    blocks.block("#TRAFO OFF");
    blocks.block("#CS OFF ALL");
    let wanted = match plan.stage {
        Stage::Off => Some("OFF"),
        Stage::On => Some("ON"),
    };
    let switchable = |axis: &&MeasuredAxis| axis.installed != Installed::Unconfigured;
    for axis in plan.axes.iter().filter(switchable) {
        blocks.switch(axis, wanted);
    }
    blocks.comment("approach, no rapid");
    let axes = plan.axes.iter().zip(&program.start);
    let places = axes.map(|(axis, place)| format!("{}{}", axis.name, number(*place)));
    let places: Vec<String> = places.collect();
    blocks.block(&format!(
        "G01 {} F{}",
        places.join(" "),
        number(plan.approach)
    ));
    for step in &program.steps {
        blocks.step(step, &plan.axes);
    }
    blocks.comment("back to the state at the start of the control");
    for axis in plan.axes.iter().filter(switchable) {
        let at_start = if axis.installed == Installed::On {
            "ON"
        } else {
            "OFF"
        };
        blocks.switch(axis, Some(at_start).filter(|it| wanted != Some(*it)));
    }
    blocks.block("M30");
    blocks.text
}

/// Returns the plane of the circles.
fn plane_of(axes: &[MeasuredAxis]) -> u8 {
    match axes {
        [first, _] if first.name == "Z" => 18,
        [first, _] if first.name == "Y" => 19,
        _ => 17,
    }
}

/// Numbered blocks, one per line.
#[derive(Default)]
struct NumberedBlocks {
    text: String,
    number: u32,
}

impl NumberedBlocks {
    fn comment(&mut self, text: &str) {
        let plain: String = text.chars().filter(|it| !matches!(it, '(' | ')')).collect();
        let _ = writeln!(self.text, "({})", plain.replace('\u{b0}', "deg"));
    }

    fn block(&mut self, words: &str) {
        self.number += 10;
        let _ = writeln!(self.text, "N{} {words}", self.number);
    }

    fn switch(&mut self, axis: &MeasuredAxis, state: Option<&str>) {
        if let Some(state) = state {
            self.block(&format!("{}[COMP {state} FRICT]", axis.name));
        }
    }

    fn step(&mut self, step: &PlanStep, axes: &[MeasuredAxis]) {
        let name = |axis: usize| axes.get(axis).map_or("?", |it| it.name.as_str());
        match step {
            PlanStep::Note(text) => self.comment(text),
            PlanStep::Dwell(seconds) => self.block(&format!("G04 {}", number(*seconds))),
            PlanStep::Line { axis, to, feed } => {
                self.block(&format!(
                    "G01 {}{} F{}",
                    name(*axis),
                    number(*to),
                    number(*feed)
                ));
            }
            PlanStep::Arc {
                turning,
                to,
                centre,
                feed,
            } => {
                let circle = match turning {
                    Turning::Ccw => "G03",
                    Turning::Cw => "G02",
                };
                let words = [0, 1].map(|at| {
                    let letter = match name(at) {
                        "X" => "I",
                        "Y" => "J",
                        _ => "K",
                    };
                    [
                        format!("{}{}", name(at), number(to[at])),
                        format!("{letter}{}", number(centre[at])),
                    ]
                });
                let [[x, i], [y, j]] = words;
                self.block(&format!("{circle} {x} {y} {i} {j} F{}", number(*feed)));
            }
        }
    }
}
