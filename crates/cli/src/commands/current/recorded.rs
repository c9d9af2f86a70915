//! The current over a recorded or made-up motion.

use std::io::{BufWriter, Write};
use std::path::Path;

use super::args::CurrentArgs;
use super::plot::{Plot, say_at_rest, say_saturated, say_sign};
use super::table::header;
use crate::args::{ByAxis, refuse_alike, value_list};
use crate::output::{Console, Failure, Outputs, exit};
use frictcomp::comp::State;
use frictcomp::lists::FrictionList;
use frictcomp::text::shown_path;
use frictcomp_host::{FileRegistry, commanded_axes, read_commanded};
use frictcomp_physics::current::{Added, AdditiveCurrent, CommandedTrace, Reading, Switched};
use frictcomp_report::pictures::{AxisPlot, AxisSample};
use frictcomp_report::visible_line;

/// The recorded motion of an axis, and the current over it.
struct RecordedMotion<'a> {
    /// Empty where the recording has only one.
    name: &'a str,
    list: FrictionList,
    trace: CommandedTrace,
    current: AdditiveCurrent,
}

impl RecordedMotion<'_> {
    /// Returns text such as " of axis X", or nothing for the axis of a recording that has only one.
    fn of(&self) -> String {
        match self.name {
            "" => String::new(),
            name => format!(" of axis {}", visible_line(name)),
        }
    }
}

/// Computes the currents of a recording.
pub(super) fn run(recording: &Path, args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    registry.reads("recording", recording);
    let mut axes = args.axes.clone();
    if axes.is_empty() {
        axes = match args.channels.axes_in(recording)? {
            Some(meant) => meant,
            None => commanded_axes(recording)?,
        };
    }
    let mut names: Vec<&str> = axes.iter().map(String::as_str).collect();
    if names.is_empty() {
        names.push("");
    }
    let mut outputs = Outputs::new(&registry, console);
    if args.value_list.is_empty() {
        let message = format!(
            "the current of `{}` needs a value list",
            shown_path(recording)
        );
        return Err(Failure::new(message).with_help("give it with `--value-list LIST`"));
    }
    let lists = names.iter().map(|name| {
        let lists = ByAxis::new("--value-list", &args.value_list, &names);
        value_list(lists.required(name)?, &registry)
    });
    let lists = lists.collect::<Result<Vec<_>, _>>()?;
    let mut writer = outputs.result(args.output.as_deref())?.writer;
    let plotted = names.iter().map(|name| AxisPlot::new(name, None));
    let mut plot = Plot::create(args, &mut outputs, plotted.collect())?;
    outputs.check()?;
    let reading = args.reading.over(Reading::default());
    let axes = names.iter().zip(lists).map(|(name, list)| {
        let selection = args.channels.of_axis(name, &names)?;
        Ok(RecordedMotion {
            name,
            trace: read_commanded(recording, &selection, args.trace_options()?)?,
            current: AdditiveCurrent::new(&list, reading),
            list,
        })
    });
    let mut axes = axes.collect::<Result<Vec<_>, Failure>>()?;
    for axis in &axes {
        for remark in axis.trace.remarks() {
            Console::talk(&match axis.name {
                "" => remark.clone(),
                name => format!("{}: {remark}", visible_line(name)),
            });
        }
    }
    // Axes that stand still are all alike.
    let moves = |axis: &&RecordedMotion<'_>| axis.trace.rows().any(|row| row.velocity != 0.0);
    let moving = axes.iter().filter(moves);
    refuse_alike(moving.map(|axis| (axis.name, &axis.trace)))?;
    let times = |axis: &RecordedMotion<'_>| axis.trace.rows().map(|row| row.time_s).collect();
    let times: Vec<Vec<f64>> = axes.iter().map(times).collect();
    if times.windows(2).any(|pair| pair[0] != pair[1]) {
        let message = "the recorded axes do not have the same cycles";
        return Err(Failure::new(message).with_help("name one axis in each call"));
    }
    let written = write_csv(&mut writer, &mut axes, plot.as_mut());
    if let Some(plot) = plot {
        plot.finish(written.as_deref().unwrap_or_default())?;
    }
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => Console::talk(&written.map_err(Failure::output)?),
    }
    outputs.finish()?;
    console.detail(&format!("reading: {reading}"));
    for axis in &axes {
        say_saturated(&axis.of(), axis.current.saturated());
        say_at_rest(&axis.of(), reading, axis.current.at_rest());
    }
    say_sign(axes.iter().map(|axis| &axis.list));
    Ok(exit::CLEAN)
}

/// Writes the rows, and returns the verdict.
fn write_csv(
    writer: &mut dyn Write,
    axes: &mut [RecordedMotion<'_>],
    mut plot: Option<&mut Plot>,
) -> std::io::Result<String> {
    let mut writer = BufWriter::new(writer);
    let names: Vec<&str> = axes.iter().map(|axis| axis.name).collect();
    writeln!(writer, "{}", header(&names, &[]).join(","))?;
    let mut strongest = vec![(0_i16, 0.0); axes.len()];
    let mut last_s = 0.0;
    let rows = axes.iter_mut();
    let mut rows: Vec<_> = rows
        .map(|axis| axis.trace.currents(&mut axis.current))
        .collect();
    while let Some(row) = rows
        .iter_mut()
        .map(Iterator::next)
        .collect::<Option<Vec<_>>>()
    {
        let t = row
            .first()
            .map_or(last_s, |(commanded, _)| commanded.time_s);
        if let Some(plot) = &mut plot {
            let samples = row.iter().map(|(commanded, added)| AxisSample {
                velocity: commanded.velocity,
                state: state(commanded.switched),
                added,
            });
            plot.traces.push(t, samples);
        }
        last_s = t;
        write!(writer, "{t}")?;
        for ((commanded, added), strongest) in row.iter().zip(&mut strongest) {
            if added.output.unsigned_abs() > strongest.0.unsigned_abs() {
                *strongest = (added.output, t);
            }
            let (x, v) = (commanded.position, commanded.velocity);
            let Added {
                w_before,
                w_after,
                current_units,
                output,
            } = added;
            write!(
                writer,
                ",{x},{v},{w_before},{w_after},{current_units},{output}"
            )?;
        }
        writeln!(writer)?;
    }
    writer.flush()?;
    let verdicts = names.iter().zip(strongest).map(|(name, (output, at_s))| {
        let name = visible_line(name);
        match (output.unsigned_abs(), &*name) {
            (0, "") => "nothing is added".to_owned(),
            (0, name) => format!("nothing is added to {name}"),
            (most, "") => format!("at most {most} drive units, at {at_s:.3} s"),
            (most, name) => format!("{name} at most {most} drive units, at {at_s:.3} s"),
        }
    });
    let verdicts: Vec<String> = verdicts.collect();
    Ok(format!(
        "over {last_s:.3} s of motion: {}",
        verdicts.join("; ")
    ))
}

/// Returns the state that a picture shows for a switch.
fn state(switched: Switched) -> State {
    match switched {
        Switched::On => State::Active,
        Switched::Off => State::Inactive,
    }
}
