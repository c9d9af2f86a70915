//! The page for the operator (R16.1, R16.8).

use std::fmt::Write as _;

use super::summary::minutes;
use super::words::told;
use frictcomp::lists::AxisType;
use frictcomp_recordings::commission::{Installed, PlanReport, Stage};

/// Returns one page in ASCII letters, at most 78 columns wide: the programs, and how to run and record them.
pub(super) fn render_readme(report: &PlanReport) -> String {
    let plan = &report.plan;
    let mut out = String::new();
    let names: Vec<&str> = plan.axes.iter().map(|it| it.name.as_str()).collect();
    let (number, compensation) = match plan.stage {
        Stage::Off => (1, "off"),
        Stage::On => (2, "on"),
    };
    let _ = writeln!(
        out,
        "MEASURING FRICTION OF {} - stage {number}, compensation {compensation}\n\
         {} programs, {} at 100 percent override, metric (G71)\n",
        names.join(" AND "),
        plan.programs.len(),
        minutes(plan.time_s())
    );
    out.push_str(BEFORE);
    for axis in &plan.axes {
        let (travel, unit) = (
            axis.travel,
            if axis.axis_type == AxisType::Linear {
                "mm"
            } else {
                "deg"
            },
        );
        let _ = writeln!(
            out,
            "  [ ] {}: {} to {} {unit} of the machine are free",
            axis.name, travel.low, travel.high
        );
        if !axis.followers.is_empty() {
            let _ = writeln!(
                out,
                "  [ ] {} is a gantry: record the motors of {} too",
                axis.name,
                axis.followers.join(", ")
            );
        }
        if axis.installed == Installed::Unconfigured {
            let _ = writeln!(
                out,
                "      {}: friction compensation is not configured, so it is off",
                axis.name
            );
        }
    }
    for list in &report.lists {
        let axis = plan.axes.iter().find(|it| it.name == list.axis);
        let followers = axis.into_iter().flat_map(|it| &it.followers);
        let motors: Vec<&str> = std::iter::once(&list.axis)
            .chain(followers)
            .map(String::as_str)
            .collect();
        let _ = writeln!(
            out,
            "  [ ] the list of {} is loaded; SHA-256 {}...",
            motors.join(" and "),
            list.sha256.get(..16).unwrap_or(&list.sha256)
        );
    }
    out.push_str(RUN);
    for program in &plan.programs {
        let _ = writeln!(
            out,
            "  {:<18} {:>9}  {}",
            program.file,
            minutes(program.time_s),
            told(program, &plan.axes).replace('\u{b0}', "deg")
        );
    }
    out.push_str(RECORD);
    out
}

const BEFORE: &str = "\
BEFORE
  [ ] tool out of the spindle, Z clear of table, vice and fixtures
  [ ] machine warm: half an hour of motion, noted with the recordings
  [ ] no workpiece, no other program; offsets of G92 and of the operator off
";

const RUN: &str = "
RUN, one after the other, each in its own recording
  First pass at 10 percent override, hand on the feed stop. Then 100 percent
  to the end: do not turn the override while a program runs. Record both.
  Nothing moves at rapid. Each program begins with 2 s of standstill and short
  strokes of 1 and 2 units: they are its number. Keep them in the recording.
  A program that was stopped leaves compensation as it was then: restart it,
  or the control.
";

const RECORD: &str = "
RECORD, for each axis that moves, one sample every ms (the CNC cycle)
  commanded position, actual position, commanded velocity, actual torque;
  friction compensation active (frict_comp.f_is_active) if there is room
  Start the recording before the program, stop it after M30.
  TwinCAT Scope: objects of the CNC at port 551 of the target, index group
  0x120300, offset 0x<axis>nnnn with the logical number of the axis
    000A, 000B  commanded and actual position    000C  commanded velocity
    0115        actual torque                    0221  compensation active
  Export CSV, header as full as possible, timelines for each sample time, no
  scaling of values; note how many increments a mm or a degree has.
  Note as well: actual position of the MOTOR or of the LOAD (linear scale)?
  Backlash and the contact of the slide show at the load only.

THEN put the exported files into the folder `recordings` next to this page.
";
