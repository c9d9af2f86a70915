//! The current over a recorded or made-up motion.

use std::io::{BufWriter, Write};
use std::path::Path;

use super::args::CurrentArgs;
use super::plot::{Plot, say_at_rest, say_saturated, say_sign};
use crate::args::{ByAxis, value_list};
use crate::output::{Console, Failure, Outputs, exit};
use frictcomp::comp::State;
use frictcomp::text::shown_path;
use frictcomp_host::{FileRegistry, read_commanded};
use frictcomp_physics::current::{Added, AdditiveCurrent, CommandedTrace, Reading, Switched};
use frictcomp_report::pictures::{AxisPlot, AxisSample};

/// Computes the current of a recording.
pub(super) fn run(recording: &Path, args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let name = match &args.axes[..] {
        [] => "",
        [name] => name,
        _ => {
            let message = "a recording gives the current of one axis, and `--axis` names several";
            return Err(Failure::new(message).with_help("name one axis in each call"));
        }
    };
    let registry = FileRegistry::default();
    registry.reads("recording", recording);
    let mut outputs = Outputs::new(&registry, console);
    let lists = ByAxis {
        option: "--value-list",
        given: &args.value_list,
        axes: &[name],
    };
    if args.value_list.is_empty() {
        let message = format!(
            "the current of `{}` needs a value list",
            shown_path(recording)
        );
        return Err(Failure::new(message).with_help("give it with `--value-list LIST`"));
    }
    let list = value_list(lists.required(name)?, &registry)?;
    let mut writer = outputs.result(args.output.as_deref())?.writer;
    let axes = vec![AxisPlot::new("", None)];
    let mut plot = Plot::create(args, &mut outputs, axes)?;
    outputs.check()?;
    let selection = args.channels.of_axis(name, &[name])?;
    let trace = read_commanded(recording, &selection, args.trace_options()?)?;
    for remark in trace.remarks() {
        Console::talk(remark);
    }
    let reading = args.reading.over(Reading::default());
    let mut current = AdditiveCurrent::new(&list, reading);
    let written = write_csv(&mut writer, &trace, &mut current, plot.as_mut());
    if let Some(plot) = plot {
        plot.finish(written.as_deref().unwrap_or_default())?;
    }
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => Console::talk(&written.map_err(Failure::output)?),
    }
    outputs.finish()?;
    console.detail(&format!("reading: {reading}"));
    say_saturated("", current.saturated());
    say_at_rest("", reading, current.at_rest());
    say_sign(&list);
    Ok(exit::CLEAN)
}

/// Writes the rows, and returns the verdict.
fn write_csv(
    writer: &mut dyn Write,
    trace: &CommandedTrace,
    current: &mut AdditiveCurrent,
    mut plot: Option<&mut Plot>,
) -> std::io::Result<String> {
    let mut writer = BufWriter::new(writer);
    writeln!(writer, "t,x,v,w_before,w_after,current,output")?;
    let (mut strongest, mut last_s) = ((0_i16, 0.0), 0.0);
    for (row, added) in trace.currents(current) {
        let (t, x, v) = (row.time_s, row.position, row.velocity);
        if let Some(plot) = &mut plot {
            let sample = AxisSample {
                velocity: v,
                state: state(row.switched),
                added: &added,
            };
            plot.traces.push(t, [sample]);
        }
        last_s = t;
        if added.output.unsigned_abs() > strongest.0.unsigned_abs() {
            strongest = (added.output, t);
        }
        let Added {
            w_before,
            w_after,
            current_units,
            output,
        } = added;
        writeln!(
            writer,
            "{t},{x},{v},{w_before},{w_after},{current_units},{output}"
        )?;
    }
    writer.flush()?;
    let (output, at_s) = strongest;
    Ok(match output.unsigned_abs() {
        0 => format!("over {last_s:.3} s of motion: nothing is added"),
        most => format!("over {last_s:.3} s of motion: at most {most} drive units, at {at_s:.3} s"),
    })
}

/// Returns the state that a picture shows for a switch.
fn state(switched: Switched) -> State {
    match switched {
        Switched::On => State::Active,
        Switched::Off => State::Inactive,
    }
}
