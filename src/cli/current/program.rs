//! The current of the axes of a program.

use std::collections::VecDeque;
use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use super::super::console::Console;
use super::super::cycle::checked;
use super::super::discovery::{LoadedMachine, Machines};
use super::super::dry_run::{Alone, Axes, run_alone};
use super::super::exit;
use super::super::failure::Failure;
use super::super::files::{Input, Naming};
use super::super::ledger::Ledger;
use super::super::outputs::Outputs;
use super::super::unread::say_unread;
use super::super::watch::{Course, Watch};
use super::{Column, CurrentArgs, Plot, say_saturated, value_list};
use crate::comp::{AxisIndex, State};
use crate::current::{
    AdditiveCurrent, Commanded, CurrentSample, Followers, POSITION_UNITS_PER_MM,
    VELOCITY_UNITS_PER_MM_PER_S,
};
use crate::diagnostic::{Diagnostic, Severity, did_you_mean};
use crate::lists::FrictionList;
use crate::machine::{AxisType, Parameterisation};
use crate::motion::{AxisLimits, Cause, PlannerOptions, Sample, TraceSink, TrajectoryPlanner};
use crate::report::pictures::AxisPlot;
use crate::session::{Motions, SessionOptions, StopPolicy};
use crate::timeline::{Record, Sink};

/// Cycles between two looks at the clock.
const STEP: u64 = 1 << 16;

/// Runs a program and writes the currents of its axes.
pub(super) fn run(program: &Path, args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let input = Input::new(program);
    input.probe()?;
    let ledger = Ledger::default();
    input.note(&ledger);
    let mut outputs = Outputs::new(&ledger, console);
    let mut machines = Machines::new(&args.machine, &ledger);
    machines.look_ahead(std::slice::from_ref(&input));
    let mut loaded = machines.for_folder(input.folder())?.as_ref().clone();
    if let Some(remark) = loaded.remark() {
        Console::talk(&remark);
    }
    let followed = followed(
        &args.axes,
        &mut loaded,
        (args.value_list.as_deref(), &ledger),
    )?;
    let cycle = args
        .cycle
        .seconds()?
        .or(loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0));
    let options = PlannerOptions {
        cycle_s: checked(cycle.unwrap_or(PlannerOptions::default().cycle_s))?,
        max_cycles: args.max_cycles,
    };
    say_limits(&loaded);
    let result = outputs.result(args.output.as_deref())?;
    let plot = Plot::create(args, &mut outputs, plotted(&loaded, &followed))?;
    outputs.check()?;
    let currents = followed.iter().map(|axis| {
        let list = values(&loaded, *axis);
        AdditiveCurrent::new(&list, args.reading)
    });
    let mut follow = Follow {
        planner: TrajectoryPlanner::new(&loaded.machine, &followed, options),
        table: Table {
            followers: Followers::new(currents.collect()),
            waiting: VecDeque::new(),
            columns: args.columns.clone(),
            writer: BufWriter::new(result.writer),
            written: Ok(()),
            cycles: 0,
            watch: Arc::clone(&loaded.watch),
            program: input.name(Naming::AsGiven),
            course: Course::default(),
            begins: Vec::new(),
            seen: vec![Vec::new(); followed.len()],
            plot,
        },
        errors: Vec::new(),
        over: ControlFlow::Continue(()),
    };
    let names: Vec<String> = followed
        .iter()
        .map(|axis| loaded.machine.axis(*axis).name.clone())
        .collect();
    follow.table.header(&names);
    let alone = Alone {
        options: SessionOptions {
            motions: Motions::Taken,
            ..args.execution.options(&loaded, StopPolicy::FirstError)
        },
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    };
    run_alone(&input, &loaded, alone, &mut follow)?;
    let Follow {
        mut planner,
        mut table,
        errors,
        over,
    } = follow;
    if over.is_continue() && planner.finish(&mut table).is_continue() {
        table.drain();
    }
    let cycles = table.cycles;
    if let Some(plot) = table.plot.take()
        && cycles > 0
    {
        plot.finish()?;
    }
    match table.finish() {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => written.map_err(|error| Failure::output(&error))?,
    }
    outputs.finish()?;
    let told = Told {
        names: &names,
        table: &table,
        loaded: &loaded,
    };
    let mut said = errors;
    said.extend(told.levelled(planner.diagnostics()));
    console.show(&said);
    if cycles == 0 {
        Console::talk(&told.nothing());
    }
    told.say_all(args);
    say_unread(&args.machine, &ledger, console);
    let failed = said.iter().any(|said| said.severity == Severity::Error);
    Ok(if failed { exit::FOUND } else { exit::CLEAN })
}

/// The axes that are followed. A value list of the command line takes the place of theirs.
fn followed(
    names: &[String],
    loaded: &mut LoadedMachine,
    (list, ledger): (Option<&Path>, &Ledger),
) -> Result<Vec<AxisIndex>, Failure> {
    let list = list.map(|path| value_list(path, ledger)).transpose()?;
    let mut followed: Vec<AxisIndex> = Vec::new();
    for name in names {
        let machine = &mut loaded.machine;
        let Some(axis) = machine.find(name) else {
            let known: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
            let failure = Failure::new(format!("the machine has no axis `{name}`"));
            return Err(match did_you_mean(name, known.iter().copied()) {
                Some(near) => failure.with_help(format!("did you mean `{near}`?")),
                None => failure.with_help(format!("it has {}", known.join(", "))),
            });
        };
        if followed.contains(&axis) {
            continue;
        }
        followed.push(axis);
        let axis = &mut machine.axes[axis.get()];
        if let Some(list) = &list {
            axis.friction = Parameterisation::Accepted(list.clone());
        }
        if axis.friction == Parameterisation::Assumed {
            return Err(Failure::new(format!(
                "the friction values of axis `{name}` are not known, only assumed to exist"
            ))
            .with_help("name its compensation value list with `--value-list`"));
        }
    }
    Ok(followed)
}

/// The value list of an axis; an empty one where the control would not take any.
fn values(loaded: &LoadedMachine, axis: AxisIndex) -> FrictionList {
    match &loaded.machine.axis(axis).friction {
        Parameterisation::Accepted(list) => list.clone(),
        _ => FrictionList {
            position_delay: 0,
            reversal_lookahead: 0,
            scaling_factor: 1000,
            delay_cycles: 0,
            max_points: 0,
            table: Vec::new(),
        },
    }
}

/// Which limits are assumed, for each axis that the configuration does not describe in full.
fn say_limits(loaded: &LoadedMachine) {
    let mut assumed: Vec<(String, Vec<&str>)> = Vec::new();
    for axis in &loaded.machine.axes {
        let limits = AxisLimits::of(axis);
        let (minute, second) = match axis.axis_type {
            AxisType::Linear => ("mm/min", ("m/s²", "m/s³", 1000.0)),
            _ => ("°/min", ("°/s²", "°/s³", 1.0)),
        };
        let (square, cube, unit) = second;
        let parts = [
            (limits.assumed.velocity, limits.velocity * 60.0, minute),
            (
                limits.assumed.acceleration,
                limits.acceleration / unit,
                square,
            ),
            (limits.assumed.jerk, limits.jerk / unit, cube),
        ];
        let parts: Vec<String> = parts
            .iter()
            .filter(|(assumed, ..)| *assumed)
            .map(|(_, value, unit)| format!("{value:.0} {unit}"))
            .collect();
        if parts.is_empty() {
            continue;
        }
        let text = parts.join(", ");
        match assumed.iter_mut().find(|(known, _)| *known == text) {
            Some((_, names)) => names.push(&axis.name),
            None => assumed.push((text, vec![&axis.name])),
        }
    }
    for (limits, names) in assumed {
        let names = names.join(" ");
        Console::talk(&format!("limits assumed for {names}: {limits}"));
    }
}

/// Follows a session.
struct Follow {
    planner: TrajectoryPlanner,
    table: Table,
    /// What stopped the program.
    errors: Vec<Diagnostic>,
    over: ControlFlow<()>,
}

impl Sink for Follow {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        let error = |said: &&Diagnostic| said.severity == Severity::Error;
        match *record {
            Record::Machine(said) => self.errors.extend(Some(said).filter(error).cloned()),
            Record::Block(ref row) => {
                self.errors
                    .extend(row.diagnostics.iter().filter(error).cloned());
                self.over = self.planner.block(row, &mut self.table);
            }
            Record::End(ref end) => {
                let notes = end.notes.iter().map(|note| &note.diagnostic);
                self.errors.extend(notes.filter(error).cloned());
            }
            _ => {}
        }
        self.over
    }
}

/// The rows of the result on their way out.
struct Table {
    followers: Followers,
    /// Time and line of the cycles whose current is not known yet.
    waiting: VecDeque<(f64, u32)>,
    columns: Vec<Column>,
    writer: BufWriter<Box<dyn Write>>,
    written: io::Result<()>,
    cycles: u64,
    watch: Arc<Watch>,
    program: String,
    course: Course,
    /// When and at which line the trace begins, and begins anew.
    begins: Vec<(f64, u32)>,
    /// The states that each axis was in, other than active.
    seen: Vec<Vec<State>>,
    plot: Option<Plot>,
}

impl Table {
    /// `t,x,v,…` for one axis, `t,x.X,v.X,…` for several.
    fn header(&mut self, names: &[String]) {
        let mut header = vec!["t".to_owned()];
        for name in names {
            let suffix = match names.len() {
                1 => String::new(),
                _ => format!(".{name}"),
            };
            let comp = self.columns.contains(&Column::Comp).then_some("comp");
            let columns = ["x", "v", "w_before", "w_after", "current", "output"];
            for column in columns.into_iter().chain(comp) {
                header.push(format!("{column}{suffix}"));
            }
        }
        if self.columns.contains(&Column::Line) {
            header.push("line".to_owned());
        }
        self.written = writeln!(self.writer, "{}", header.join(","));
    }

    /// Writes the cycles that wait for others.
    fn drain(&mut self) {
        while let Some(samples) = self.followers.pop() {
            let Some(head) = self.waiting.pop_front() else {
                return;
            };
            if self.written.is_ok() {
                self.written = write_row(&mut self.writer, &self.columns, head, samples);
                draw(&mut self.plot, head.0, samples);
            }
        }
    }

    fn finish(&mut self) -> io::Result<()> {
        std::mem::replace(&mut self.written, Ok(()))?;
        self.writer.flush()
    }
}

impl TraceSink for Table {
    fn begin(&mut self, time_s: f64, cause: &Arc<Cause>) -> ControlFlow<()> {
        self.drain();
        self.followers.restart();
        if let Some(plot) = &mut self.plot {
            plot.traces.interrupt();
        }
        self.begins.push((time_s, cause.line));
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.cycles += 1;
        let way = self.course.reach(sample.cause.line);
        if self.cycles.is_multiple_of(STEP) {
            let done = format!("{} cycles", self.cycles);
            self.watch
                .show(&done, (&self.program, sample.cause.line), way);
        }
        for (seen, state) in self.seen.iter_mut().zip(sample.cause.friction.iter()) {
            if *state != State::Active && !seen.contains(state) {
                seen.push(*state);
            }
        }
        self.waiting.push_back((sample.time_s, sample.cause.line));
        let axes = sample.positions.iter().zip(sample.velocities);
        let inputs = axes
            .zip(sample.cause.friction.iter())
            .map(|((x, v), state)| Commanded {
                position: x * POSITION_UNITS_PER_MM,
                velocity: v * VELOCITY_UNITS_PER_MM_PER_S,
                friction: *state,
            });
        if let Some(samples) = self.followers.push(inputs)
            && let Some(head) = self.waiting.pop_front()
        {
            self.written = write_row(&mut self.writer, &self.columns, head, samples);
            draw(&mut self.plot, head.0, samples);
        }
        match self.written {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    }
}

/// The axes of the picture.
fn plotted(loaded: &LoadedMachine, followed: &[AxisIndex]) -> Vec<AxisPlot> {
    let axes = followed.iter().map(|axis| loaded.machine.axis(*axis));
    axes.map(|axis| AxisPlot::new(&axis.name, Some(axis.axis_type)))
        .collect()
}

fn draw(plot: &mut Option<Plot>, time: f64, samples: &[CurrentSample]) {
    if let Some(plot) = plot {
        let samples = samples.iter();
        plot.traces.push(
            time,
            samples.map(|it| (it.commanded.velocity, it.commanded.friction, &it.added)),
        );
    }
}

fn write_row(
    writer: &mut impl Write,
    columns: &[Column],
    (time, line): (f64, u32),
    samples: &[CurrentSample],
) -> io::Result<()> {
    write!(writer, "{time}")?;
    for CurrentSample { commanded, added } in samples {
        let (x, v) = (commanded.position, commanded.velocity);
        write!(writer, ",{x},{v},{},{}", added.w_before, added.w_after)?;
        match commanded.friction {
            // Nobody knows it.
            State::Unknown => write!(writer, ",,")?,
            _ => write!(writer, ",{},{}", added.current, added.output)?,
        }
        if columns.contains(&Column::Comp) {
            write!(writer, ",{}", commanded.friction.as_str())?;
        }
    }
    if columns.contains(&Column::Line) {
        write!(writer, ",{line}")?;
    }
    writeln!(writer)
}

/// What is said when the result is out.
struct Told<'a> {
    names: &'a [String],
    table: &'a Table,
    loaded: &'a LoadedMachine,
}

impl Told<'_> {
    /// The diagnostics with the severities of the user.
    fn levelled(&self, diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
        let levels = &self.loaded.levels;
        let levelled = diagnostics.iter().filter_map(|said| {
            let severity = levels.severity(said.code)?;
            Some(Diagnostic {
                severity,
                ..said.clone()
            })
        });
        levelled.collect()
    }

    fn nothing(&self) -> String {
        let names = self.names.join(", ");
        format!(
            "no cycle: there is no motion whose start and end are known; program absolute \
             positions for {names} and the axes that move with it first"
        )
    }

    fn say_all(&self, args: &CurrentArgs) {
        for (at, (time, line)) in self.table.begins.iter().enumerate() {
            let anew = if at == 0 { "begins" } else { "restarts" };
            Console::talk(&format!("the trace {anew} with line {line}, at {time} s"));
        }
        for (name, states) in self.names.iter().zip(&self.table.seen) {
            for state in states {
                let word = state.as_str();
                let what = match state {
                    State::Unknown => "its current is left empty",
                    _ => "its current is 0",
                };
                Console::talk(&format!("{name}: while its state is `{word}`, {what}"));
            }
        }
        Console::talk(&format!("reading: {}", args.reading));
        for (name, cycles) in self.names.iter().zip(self.table.followers.saturated()) {
            say_saturated(&format!(" of axis {name}"), cycles);
        }
    }
}
