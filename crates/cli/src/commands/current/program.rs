//! The current of the axes of a program.

use std::path::Path;
use std::sync::Arc;

use super::args::CurrentArgs;
use super::plot::{Plot, say_at_rest, say_saturated, say_sign};
use super::table::{CurrentRows, TableOptions};
use crate::args::{ByAxis, remark, value_list};
use crate::output::{Console, Failure, Outputs, exit};
use frictcomp::comp::{AxisIndex, State};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::drive_interface::TorqueScale;
use frictcomp::interpreter::{Motions, StopPolicy};
use frictcomp::machine::{Axis, Machine, Parameterisation};
use frictcomp_host::{Axes, FileRegistry, Input, LoadedMachine, Naming, SingleRun, run_alone};
use frictcomp_physics::current::{CurrentOptions, ProgramCurrents, Reading, axes_to_follow};
use frictcomp_physics::motion::{AssumedLimits, PlannerOptions, check_cycle};
use frictcomp_report::assumed_limits;
use frictcomp_report::assumptions::rests_on_text;
use frictcomp_report::pictures::AxisPlot;

/// Runs a program and writes the currents of its axes.
pub(super) fn run(program: &Path, args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let input = Input::new(program);
    input.probe()?;
    let registry = FileRegistry::default();
    input.note(&registry);
    let mut outputs = Outputs::new(&registry, console);
    let mut machines = args.machine.machines(&registry);
    machines.look_ahead(std::slice::from_ref(&input));
    let mut loaded = machines.for_folder(input.folder())?.as_ref().clone();
    args.use_lists(&mut loaded.machine, &registry)?;
    let followed = axes_to_follow(&args.axes, &loaded.machine).map_err(|error| {
        let name = input.name(Naming::AsGiven);
        Failure::from(error).with_help(format!(
            "`{name}` was taken as a program; name a recording with `--recording`"
        ))
    })?;
    let options = options(args, &loaded)?;
    let result = outputs.result(args.output.as_deref())?;
    let plot = Plot::create(args, &mut outputs, plotted(&loaded, &followed))?;
    outputs.check()?;
    let name = |axis: &AxisIndex| loaded.machine.axis(*axis).name.clone();
    let names: Vec<String> = followed.iter().map(name).collect();
    let table = TableOptions {
        names: &names,
        columns: &args.columns,
        program: input.name(Naming::AsGiven),
        watch: Arc::clone(&loaded.watch),
    };
    let table = CurrentRows::new(result.writer, table, plot);
    let reading = reading(args, &loaded);
    let mut currents = ProgramCurrents::new(&loaded.machine, &followed, options, table);
    let mut session = args.execution.options(&loaded, StopPolicy::FirstError);
    session.run.motions = Motions::Taken;
    session.start = args.start.positions(&loaded.machine)?;
    let alone = SingleRun {
        options: session,
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    };
    run_alone(&input, &loaded, alone, &mut currents)?;
    currents.finish();
    let cycles = currents.cycles();
    let table = currents.sink();
    if let Some(plot) = table.take_plot()
        && cycles > 0
    {
        plot.finish(&table.verdict(&names))?;
    }
    match table.finish() {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => written.map_err(Failure::output)?,
    }
    outputs.finish()?;
    if cycles > 0 {
        Console::talk(&currents.sink().verdict(&names));
    }
    if let Some(remark) = remark(&loaded) {
        Console::talk(&remark);
    }
    let assumed = loaded.machine.axes.iter().filter_map(AssumedLimits::of);
    for line in assumed_limits(&assumed.collect::<Vec<_>>()) {
        console.detail(&line);
    }
    say_scaling(&loaded);
    let (errors, remarks) = currents.diagnostics();
    let mut said = errors.to_vec();
    said.extend(levelled(currents.undecided(), &loaded));
    said.extend(levelled(remarks, &loaded));
    console.show(&said);
    if cycles == 0 {
        Console::talk(&nothing(&names));
    }
    say_left_out(currents.left_out());
    say_table(&names, currents.sink());
    console.detail(&format!("reading: {reading}"));
    if let Some(text) = rests_on_text(currents.rests_on()) {
        console.detail(&text);
    }
    for (name, cycles) in names.iter().zip(currents.saturated()) {
        say_saturated(&format!(" of axis {name}"), cycles);
    }
    for (name, cycles) in names.iter().zip(currents.at_rest()) {
        say_at_rest(&format!(" of axis {name}"), reading, cycles);
    }
    let lists = followed
        .iter()
        .map(|axis| &loaded.machine.axis(*axis).friction);
    let lists = lists.filter_map(|friction| match friction {
        Parameterisation::Accepted(list) if cycles > 0 => Some(list),
        _ => None,
    });
    say_sign(lists);
    args.machine.say_unread(&machines, &registry, console);
    let failed = said.iter().any(|said| said.severity == Severity::Error);
    Ok(if failed { exit::FOUND } else { exit::CLEAN })
}

impl CurrentArgs {
    /// Puts the given lists in place of those of the machine.
    fn use_lists(&self, machine: &mut Machine, registry: &FileRegistry) -> Result<(), Failure> {
        let names: Vec<String> = machine.axes.iter().map(|it| it.name.clone()).collect();
        let lists = ByAxis {
            option: "--value-list",
            given: &self.value_list,
            axes: &names.iter().map(String::as_str).collect::<Vec<_>>(),
        };
        let followed = |it: &Axis| self.axes.is_empty() || self.axes.contains(&it.name);
        for axis in machine.axes.iter_mut().filter(|it| followed(it)) {
            if let Some(path) = lists.list(&axis.name)? {
                axis.friction = Parameterisation::Accepted(value_list(path, registry)?);
            }
        }
        Ok(())
    }
}

/// Returns the reading: options of the command line take precedence over the selection of the machine.
fn reading(args: &CurrentArgs, loaded: &LoadedMachine) -> Reading {
    args.reading.over(Reading::from(&loaded.machine.readings))
}

/// Returns the cycle of the command line, else that of the machine.
fn options(args: &CurrentArgs, loaded: &LoadedMachine) -> Result<CurrentOptions, Failure> {
    let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
    let cycle = args.cycle.seconds()?.or(of_machine);
    let planner = PlannerOptions {
        cycle_s: check_cycle(cycle.unwrap_or(PlannerOptions::default().cycle_s))?,
        max_cycles: args.max_cycles,
        tool_radii: args.tool.radii.clone().unwrap_or_default(),
    };
    Ok(CurrentOptions::from(planner).with_reading(reading(args, loaded)))
}

/// Reports the factor of the outputs on their way to the drives, if it is not 1 (R7.8).
fn say_scaling(loaded: &LoadedMachine) {
    for axis in &loaded.machine.axes {
        let scale = axis.torque_scale;
        if scale != TorqueScale::default() {
            let (name, above, below) = (&axis.name, scale.numerator, scale.denominator);
            Console::talk(&format!("{name}: `output` is scaled by {above}/{below}"));
        }
    }
}

/// Returns the axes of the picture.
fn plotted(loaded: &LoadedMachine, followed: &[AxisIndex]) -> Vec<AxisPlot> {
    let axes = followed.iter().map(|axis| loaded.machine.axis(*axis));
    axes.map(|axis| AxisPlot::new(&axis.name, Some(axis.axis_type)))
        .collect()
}

/// Returns the diagnostics with the user's severities.
fn levelled(diagnostics: &[Diagnostic], loaded: &LoadedMachine) -> Vec<Diagnostic> {
    let levelled = diagnostics.iter().filter_map(|said| {
        let severity = loaded.levels.severity(said.code)?;
        Some(Diagnostic {
            severity,
            ..said.clone()
        })
    });
    levelled.collect()
}

/// Reports how many motions are not in the trace.
fn say_left_out(motions: u64) {
    match motions {
        0 => {}
        1 => Console::talk("1 motion is left out of the trace"),
        more => Console::talk(&format!("{more} motions are left out of the trace")),
    }
}

fn nothing(names: &[String]) -> String {
    let names = names.join(", ");
    format!(
        "no cycle: there is no motion whose start and end are known; program absolute \
         positions for {names} and the axes that move with it first"
    )
}

/// Reports where the trace begins, and where an axis has no current.
fn say_table(names: &[String], table: &CurrentRows) {
    for (at, (time, line)) in table.begins().iter().enumerate() {
        let anew = if at == 0 { "begins" } else { "restarts" };
        Console::talk(&format!("the trace {anew} with line {line}, at {time} s"));
    }
    for (name, states) in names.iter().zip(table.seen()) {
        for state in states {
            let word = state.as_str();
            let what = match state {
                State::Unknown => "its current is left empty",
                _ => "its current is 0",
            };
            Console::talk(&format!("{name}: while its state is `{word}`, {what}"));
        }
    }
}
