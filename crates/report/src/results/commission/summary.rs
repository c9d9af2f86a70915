//! A plan as text, and as the file by which recordings are recognised later.

use std::fmt::Write as _;

use serde::Serialize;

use super::program::render_program;
use super::readme::render_readme;
use super::words::{number, told};
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::{counted, to_json, visible_line};
use frictcomp_recordings::commission::{MeasuringProgram, PlanFile, PlanReport, Stage};

/// Returns the verdict: the stage, and how long its programs take (R18.20).
fn headline(report: &PlanReport) -> Headline {
    let plan = &report.plan;
    let stage = match plan.stage {
        Stage::Off => "stage 1, friction compensation off",
        Stage::On => "stage 2, friction compensation on",
    };
    let programs = counted(plan.programs.len(), "program");
    let text = format!("{stage}: {programs}, {}", minutes(plan.time_s()));
    Headline::new(Standing::Plain, text)
}

#[derive(Serialize)]
struct PlanDocument {
    headline: Headline,
    #[serde(flatten)]
    file: PlanFile,
}

/// Returns the plan with its verdict as JSON.
pub fn render_json(report: &PlanReport) -> String {
    to_json(&PlanDocument {
        headline: headline(report),
        file: report.file(),
    })
}

/// The programs of a plan and the page for the operator, each with the name of its file.
pub fn plan_texts(report: &PlanReport) -> impl Iterator<Item = (String, String)> {
    let programs = report.plan.programs.iter();
    let programs = programs.map(|it| (it.file.clone(), render_program(report, it)));
    programs.chain([("README.txt".to_owned(), render_readme(report))])
}

/// Returns the programs with their times, and their basis.
pub fn plan_document(report: &PlanReport) -> Document<'static> {
    let plan = &report.plan;
    let mut out = Document::new("Measuring programs", headline(report));
    out.push_str("\n");
    let mut table = Table::default()
        .left("program")
        .right("time")
        .left("motion");
    for program in &plan.programs {
        let what = told(program, &plan.axes);
        let file = visible_line(&program.file);
        table.row(&[&file, &minutes(program.time_s), &visible_line(&what)]);
    }
    out.table(table);
    out.push_str("\n");
    for axis in &plan.axes {
        let (dynamics, unit) = (axis.dynamics, axis.unit());
        let _ = writeln!(
            out,
            "{}: travel {} to {} {unit}, of which 5 % at each end stay free; {} {unit}/min, {} {unit}/s², {} {unit}/s³ of {}",
            visible_line(&axis.name),
            number(axis.travel.low),
            number(axis.travel.high),
            number(dynamics.velocity_per_s * 60.0),
            number(dynamics.acceleration_per_s2),
            number(dynamics.jerk_per_s3),
            visible_line(&report.machine),
        );
        if axis.pitch.is_none() {
            let name = visible_line(&axis.name);
            let _ = writeln!(
                out,
                "{name}: without `--pitch` slow speeds do not cover a turn of the screw, and its ripple stays in the friction"
            );
        }
    }
    for axis in &report.assumed_jerk {
        let axis = visible_line(axis);
        let _ = writeln!(
            out,
            "{axis}: the ramps are those of the control's defaults; give `max_jerk` where they differ"
        );
    }
    let circles = plan.programs.iter().filter_map(MeasuringProgram::feed);
    let feeds: Vec<f64> = circles.collect();
    if let (Some(slowest), Some(fastest)) = (feeds.first(), feeds.last()) {
        if feeds.len() < 6 {
            let _ = writeln!(
                out,
                "{} feeds: six show more, the glitch between four can be 1.8 µm larger",
                feeds.len()
            );
        }
        if fastest / slowest < 10.0 {
            out.push_str(
                "the feeds span less than a decade: the contact stiffness may stay undetermined\n",
            );
        }
    }
    out
}

/// Returns a time in a form for the operator.
pub(super) fn minutes(seconds: f64) -> String {
    let whole = (seconds / 60.0).floor();
    format!("{whole:.0}:{:02.0} min", (seconds - whole * 60.0).floor())
}
