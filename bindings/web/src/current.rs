//! The additive current of a program's axes over its commanded trace.

use std::ops::ControlFlow;

use frictcomp::comp::{AxisIndex, State};
use frictcomp::interpreter::{Motions, Options};
use frictcomp::machine::Machine;
use frictcomp_host::{Axes, Naming, SingleRun, run_alone};
use frictcomp_physics::current::{
    CurrentCycle, CurrentOptions, CurrentSink, FollowError, ProgramCurrents, axes_to_follow,
};
use frictcomp_physics::motion::{AssumedLimits, PlannerOptions, check_cycle};
use frictcomp_report::assumed_limits;
use frictcomp_report::pictures::{AxisPlot, AxisSample, CurrentPlot};
use frictcomp_report::svg::Frame;
use serde::Serialize;

use crate::contour::expect_axes;
use crate::dropped::Dropped;
use crate::refusal::Refusal;
use crate::run::{RunSettings, json};
use crate::watched::show_progress;
use crate::wording::page;

/// Cycles between two progress reports.
const STEP: u64 = 1 << 16;

/// Limit on the cycles; more would take minutes.
const MOST_CYCLES: u64 = 20_000_000;

#[derive(Serialize)]
struct CurrentAnswer {
    svg: Option<String>,
    /// Basis of the picture, and what is missing in it.
    notes: Vec<String>,
}

/// Draws the cycles as they come.
struct Drawing {
    plot: CurrentPlot,
    block: Option<(u32, u64)>,
    cycles: u64,
    seen: Vec<Vec<State>>,
    begins: Vec<(f64, u32)>,
}

impl CurrentSink for Drawing {
    fn begin(&mut self, time_s: f64, line: u32) {
        self.plot.interrupt();
        self.begins.push((time_s, line));
    }

    fn cycle(&mut self, cycle: &CurrentCycle<'_>) -> ControlFlow<()> {
        self.cycles += 1;
        if self.cycles.is_multiple_of(STEP) {
            show_progress(u32::try_from(self.cycles).unwrap_or(u32::MAX), 0);
        }
        let (cause, block) = (cycle.cause, (cycle.cause.program, cycle.cause.seq));
        if self.block.replace(block) != Some(block) {
            self.plot.block(cycle.time_s, cause.number, cause.line);
        }
        for (seen, axis) in self.seen.iter_mut().zip(cycle.axes) {
            let state = axis.commanded.friction;
            if state != State::Active && !seen.contains(&state) {
                seen.push(state);
            }
        }
        let axes = cycle.axes.iter();
        self.plot.push(
            cycle.time_s,
            axes.map(|it| AxisSample {
                velocity: it.commanded.velocity_units,
                state: it.commanded.friction,
                added: &it.added,
            }),
        );
        ControlFlow::Continue(())
    }
}

/// Returns the picture of the current of every axis that has a value list.
pub(crate) fn answer(
    dropped: &mut Dropped,
    program: &str,
    start: Vec<(String, f64)>,
    settings: &RunSettings,
) -> Result<Vec<u8>, Refusal> {
    let input = dropped.program(program)?;
    let loaded = dropped.machine(&input, &settings.enable)?;
    expect_axes(&loaded, &start)?;
    let followed = axes_to_follow(&[], &loaded.machine).map_err(|error| refused(&error))?;
    let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
    let usual = PlannerOptions::default().cycle_s;
    let cycle_s = check_cycle(of_machine.unwrap_or(usual))
        .map_err(|error| Refusal::new(error.to_string()))?;
    let planner = PlannerOptions::default()
        .with_cycle_s(cycle_s)
        .with_max_cycles(MOST_CYCLES);
    let plots = followed.iter().map(|axis| {
        let axis = loaded.machine.axis(*axis);
        AxisPlot::new(&axis.name, Some(axis.axis_type))
    });
    let drawing = Drawing {
        plot: CurrentPlot::new(plots.collect()),
        block: None,
        cycles: 0,
        seen: vec![Vec::new(); followed.len()],
        begins: Vec::new(),
    };
    let options = CurrentOptions::from(planner);
    let mut currents = ProgramCurrents::new(&loaded.machine, &followed, options, drawing);
    let mut session = loaded
        .session(Options::default())
        .with_start(start)
        .with_wording(Some(page));
    session.run = session.run.with_motions(Motions::Taken);
    let alone = SingleRun {
        options: session,
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    };
    run_alone(&input, &loaded, alone, &mut currents)?;
    currents.finish();
    let notes = notes(&loaded.machine, &followed, &mut currents);
    let has_cycles = currents.cycles() > 0;
    let svg = has_cycles.then(|| currents.sink().plot.chart().render(Frame::Alone));
    Ok(json(&CurrentAnswer { svg, notes }))
}

/// Returns the basis of the picture, and what is missing in it.
fn notes(
    machine: &Machine,
    followed: &[AxisIndex],
    currents: &mut ProgramCurrents<Drawing>,
) -> Vec<String> {
    let mut notes = Vec::new();
    let drawn = followed.iter().map(|axis| machine.axis(*axis));
    let names: Vec<&str> = drawn.clone().map(|axis| axis.name.as_str()).collect();
    let assumed: Vec<AssumedLimits> = drawn.filter_map(AssumedLimits::of).collect();
    notes.extend(assumed_limits(&assumed));
    let (errors, remarks) = currents.diagnostics();
    let said = errors.iter().chain(remarks);
    notes.extend(said.map(|said| format!("{} {}", said.code, said.message)));
    match currents.left_out() {
        0 => {}
        1 => notes.push("1 motion is left out of the trace".to_owned()),
        more => notes.push(format!("{more} motions are left out of the trace")),
    }
    let is_empty = currents.cycles() == 0;
    let drawing = currents.sink();
    for (at, (time, line)) in drawing.begins.iter().enumerate() {
        let anew = if at == 0 { "begins" } else { "restarts" };
        notes.push(format!("the trace {anew} with line {line}, at {time} s"));
    }
    for (name, states) in names.iter().zip(&drawing.seen) {
        for state in states {
            let what = match state {
                State::Unknown => "its current is not drawn",
                _ => "its current is 0",
            };
            notes.push(format!("{name}: while its state is {state}, {what}"));
        }
    }
    if is_empty {
        notes.push(format!(
            "no cycle: there is no motion whose start and end are known; program absolute positions for {} and the axes that move with it first",
            names.join(", ")
        ));
    }
    notes
}

fn refused(error: &FollowError) -> Refusal {
    match error {
        FollowError::NoAxis(unknown) => Refusal::unknown(error.to_string(), unknown),
        FollowError::Assumed(_) => Refusal::new(error.to_string()),
        FollowError::NoList => Refusal::new(error.to_string()).with_help(
            "drop the start-up list with its axis lists and value lists, or frictcomp.toml",
        ),
    }
}
