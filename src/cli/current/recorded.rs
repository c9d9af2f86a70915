//! The current of a recorded or made-up trace.

use std::io::Write;
use std::path::Path;

use super::super::console::Console;
use super::super::cycle::checked;
use super::super::exit;
use super::super::failure::Failure;
use super::super::files::read_text;
use super::super::ledger::Ledger;
use super::super::outputs::Outputs;
use super::{CurrentArgs, Plot, say_saturated, value_list};
use crate::comp::State;
use crate::current::{
    Added, AdditiveCurrent, POSITION_UNITS_PER_MM, Switched, VELOCITY_UNITS_PER_MM_PER_S,
};
use crate::report::pictures::AxisPlot;

/// Units of position that one unit of velocity covers in a second.
const POSITION_PER_VELOCITY: f64 = POSITION_UNITS_PER_MM / VELOCITY_UNITS_PER_MM_PER_S;

/// Units of velocity that cover one unit of position in a second.
const VELOCITY_PER_POSITION: f64 = VELOCITY_UNITS_PER_MM_PER_S / POSITION_UNITS_PER_MM;

/// A commanded trace: positions and velocities of each cycle.
struct Trace {
    times: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    switched: Vec<Switched>,
}

/// Computes the current of a recorded trace.
pub(super) fn run(
    (trace, list): (&Path, &Path),
    args: &CurrentArgs,
    console: Console,
) -> Result<u8, Failure> {
    let ledger = Ledger::default();
    ledger.reads("trace", trace);
    let mut outputs = Outputs::new(&ledger, console);
    let list = value_list(list, &ledger)?;
    let mut writer = outputs.result(args.output.as_deref())?.writer;
    let mut plot = Plot::create(args, &mut outputs, vec![AxisPlot::new("", None)])?;
    outputs.check()?;
    let trace = Trace::read(trace, args.cycle.seconds()?)?;
    let mut current = AdditiveCurrent::new(&list, args.reading);
    let written = write_csv(&mut writer, &trace, (&mut current, plot.as_mut()));
    if let Some(plot) = plot {
        plot.finish()?;
    }
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => written.map_err(|error| Failure::output(&error))?,
    }
    outputs.finish()?;
    Console::talk(&format!("reading: {}", args.reading));
    say_saturated("", current.saturated());
    Ok(exit::CLEAN)
}

fn write_csv(
    writer: &mut dyn Write,
    trace: &Trace,
    (current, mut plot): (&mut AdditiveCurrent, Option<&mut Plot>),
) -> std::io::Result<()> {
    let mut writer = std::io::BufWriter::new(writer);
    writeln!(writer, "t,x,v,w_before,w_after,current,output")?;
    let lookahead = current.lookahead();
    for (at, (&x, &v)) in trace.positions.iter().zip(&trace.velocities).enumerate() {
        current.switch(trace.switched[at]);
        let end = trace.velocities.len().min(at + 1 + lookahead);
        let added = current.step(x, v, &trace.velocities[at + 1..end]);
        let t = trace.times[at];
        if let Some(plot) = &mut plot {
            plot.traces
                .push(t, [(v, state(trace.switched[at]), &added)]);
        }
        let Added {
            w_before,
            w_after,
            current,
            output,
        } = added;
        writeln!(
            writer,
            "{t},{x},{v},{w_before},{w_after},{current},{output}"
        )?;
    }
    writer.flush()
}

/// What a picture says of a switch.
fn state(switched: Switched) -> State {
    match switched {
        Switched::On => State::Active,
        Switched::Off => State::Inactive,
    }
}

impl Trace {
    fn read(path: &Path, cycle_time: Option<f64>) -> Result<Self, Failure> {
        let text = read_text(path)?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let damaged = |error: &csv::Error| {
            Failure::new(format!(
                "the trace `{}` cannot be read: {error}",
                path.display()
            ))
        };
        let headers = reader.headers().map_err(|error| damaged(&error))?.clone();
        let column = |name: &str| headers.iter().position(|header| header == name);
        let (times, positions) = (column("t"), column("x"));
        let (velocities, switches) = (column("v"), column("comp"));
        if positions.is_none() && velocities.is_none() {
            return Err(no_columns(path, &headers));
        }
        let mut trace = Self {
            times: Vec::new(),
            positions: Vec::new(),
            velocities: Vec::new(),
            switched: Vec::new(),
        };
        for (row, record) in (2_u64..).zip(reader.records()) {
            let record = record.map_err(|error| damaged(&error))?;
            let number = |column: Option<usize>| match column {
                Some(column) => parse_number(path, row, &headers[column], record.get(column)),
                None => Ok(0.0),
            };
            trace.times.push(number(times)?);
            trace.positions.push(number(positions)?);
            trace.velocities.push(number(velocities)?);
            let word = switches.and_then(|column| record.get(column));
            trace.switched.push(parse_switch(path, row, word)?);
        }
        let cycle = trace.cycle_time(cycle_time)?;
        trace.complete(cycle, (times, positions, velocities));
        Ok(trace)
    }

    fn cycle_time(&self, given: Option<f64>) -> Result<f64, Failure> {
        let cycle = given.unwrap_or_else(|| match self.times[..] {
            [first, second, ..] if second > first => second - first,
            _ => 0.001,
        });
        checked(cycle)
    }

    /// Computes the columns that are missing (4.1 of the rules).
    fn complete(&mut self, cycle: f64, columns: (Option<usize>, Option<usize>, Option<usize>)) {
        let (times, positions, velocities) = columns;
        if times.is_none() {
            #[allow(clippy::cast_precision_loss)] // rows of a file
            let seconds = (0..self.times.len()).map(|row| row as f64 * cycle);
            self.times = seconds.collect();
        }
        if positions.is_none() {
            let mut position = 0.0;
            for (place, velocity) in self.positions.iter_mut().zip(&self.velocities) {
                position += velocity * cycle * POSITION_PER_VELOCITY;
                *place = position;
            }
        }
        if velocities.is_none() {
            let steps = self.positions.windows(2).map(|pair| pair[1] - pair[0]);
            let velocities =
                std::iter::once(0.0).chain(steps.map(|step| VELOCITY_PER_POSITION * step / cycle));
            self.velocities = velocities.take(self.positions.len()).collect();
        }
    }
}

fn no_columns(path: &Path, headers: &csv::StringRecord) -> Failure {
    let found: Vec<&str> = headers.iter().collect();
    Failure::new(format!(
        "the trace `{}` has neither a column `x` nor a column `v`, only {}",
        path.display(),
        found.join(", ")
    ))
    .with_help("name the columns `t` (s), `x` (0.1 µm or 0.0001°), `v` (µm/s or 0.001°/s), `comp`")
}

fn parse_number(path: &Path, row: u64, column: &str, text: Option<&str>) -> Result<f64, Failure> {
    let text = text.unwrap_or_default();
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| {
        Failure::new(format!(
            "{}:{row}: column `{column}` holds `{text}`, which is not a number",
            path.display()
        ))
        .with_help("write numbers with a decimal point")
    })
}

fn parse_switch(path: &Path, row: u64, word: Option<&str>) -> Result<Switched, Failure> {
    match word {
        None => Ok(Switched::On),
        Some(word) if word.eq_ignore_ascii_case("on") => Ok(Switched::On),
        Some(word) if word.eq_ignore_ascii_case("off") => Ok(Switched::Off),
        Some(word) => Err(Failure::new(format!(
            "{}:{row}: column `comp` holds `{word}`",
            path.display()
        ))
        .with_help("write `on` or `off`")),
    }
}
