//! The current of a recorded or made-up trace.

use std::io::{BufWriter, Write};
use std::path::Path;

use super::super::console::Console;
use super::super::exit;
use super::super::failure::Failure;
use super::super::machine::value_list;
use super::super::outputs::Outputs;
use super::args::CurrentArgs;
use super::plot::{Plot, say_at_rest, say_saturated, say_sign};
use frictcomp::comp::State;
use frictcomp_host::{FileRegistry, read_commanded};
use frictcomp_physics::current::{Added, AdditiveCurrent, CommandedTrace, Reading, Switched};
use frictcomp_report::pictures::{AxisPlot, AxisSample};

/// Computes the current of a recorded trace.
pub(super) fn run(
    trace: &Path,
    list: &Path,
    args: &CurrentArgs,
    console: Console,
) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    registry.reads("trace", trace);
    let mut outputs = Outputs::new(&registry, console);
    let list = value_list(list, &registry)?;
    let mut writer = outputs.result(args.output.as_deref())?.writer;
    let axes = vec![AxisPlot::new("", None)];
    let mut plot = Plot::create(args.svg.as_deref(), &mut outputs, axes)?;
    outputs.check()?;
    let trace = read_commanded(trace, &args.channels.selection(), args.trace_options()?)?;
    for remark in trace.remarks() {
        Console::talk(remark);
    }
    let reading = args.reading.over(Reading::default());
    let mut current = AdditiveCurrent::new(&list, reading);
    let written = write_csv(&mut writer, &trace, &mut current, plot.as_mut());
    if let Some(plot) = plot {
        plot.finish()?;
    }
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => written.map_err(Failure::output)?,
    }
    outputs.finish()?;
    Console::talk(&format!("reading: {reading}"));
    say_saturated("", current.saturated());
    say_at_rest("", reading, current.at_rest());
    say_sign(&list);
    Ok(exit::CLEAN)
}

fn write_csv(
    writer: &mut dyn Write,
    trace: &CommandedTrace,
    current: &mut AdditiveCurrent,
    mut plot: Option<&mut Plot>,
) -> std::io::Result<()> {
    let mut writer = BufWriter::new(writer);
    writeln!(writer, "t,x,v,w_before,w_after,current,output")?;
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
    writer.flush()
}

/// Returns the state that a picture shows for a switch.
fn state(switched: Switched) -> State {
    match switched {
        Switched::On => State::Active,
        Switched::Off => State::Inactive,
    }
}
