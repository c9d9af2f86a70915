//! `frictcomp current`: the additive current over a commanded trace.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, ValueEnum};

use super::console::Console;
use super::exit;
use super::failure::Failure;
use super::files::read_text;
use crate::current::{AdditiveCurrent, Below, Cycle, Delay, Reading, Standstill, Switched};
use crate::diagnostic::{Severity, did_you_mean};
use crate::lists::{Conditions, Entries, FrictionDraft, FrictionList, Verdict};
use crate::source::SourceFile;

/// Computes the additive current of a commanded trace, cycle by cycle
///
/// The trace is a CSV file with a header: `t` in s, `x` in 0.1 µm or 0.0001°, `v` in µm/s or
/// 0.001°/s, one row a CNC cycle. Either `x` or `v` may be missing. A column `comp` with `on` and
/// `off` switches as COMP would.
#[derive(Debug, Args)]
pub(super) struct CurrentArgs {
    /// The commanded trace
    #[arg(long, value_name = "FILE")]
    trace: PathBuf,
    /// The compensation value list
    #[arg(long, value_name = "LIST")]
    value_list: PathBuf,
    /// The CNC cycle in seconds; without it the distance of the first two times
    #[arg(long, value_name = "SECONDS")]
    cycle_time: Option<f64>,
    /// How the documents are read: `standstill=zero,below=origin,delay=reversal`
    #[arg(long, value_name = "READING", default_value = "", value_parser = parse_reading)]
    reading: Reading,
    /// The format of the result
    #[arg(long, default_value = "csv")]
    format: Format,
    /// Write the result into this file
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A format of the currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Format {
    /// One row a cycle.
    #[default]
    Csv,
}

/// A commanded trace: positions and velocities of each cycle.
struct Trace {
    times: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    switched: Vec<Switched>,
}

/// Runs the command.
pub(super) fn run(args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let list = value_list(&args.value_list)?;
    let trace = Trace::read(&args.trace, args.cycle_time)?;
    let mut current = AdditiveCurrent::new(&list, args.reading);
    let Format::Csv = args.format;
    let mut writer = console.target(args.output.as_deref())?.writer;
    let written = write_csv(&mut writer, &trace, &mut current);
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(exit::CLEAN),
        written => written.map_err(|error| Failure::output(&error))?,
    }
    Console::talk(&format!("reading: {}", args.reading.words()));
    if current.saturated() > 0 {
        let cycles = current.saturated();
        Console::talk(&format!(
            "FC137: the current of {cycles} cycles is beyond 16 bit and was cut"
        ));
    }
    Ok(exit::CLEAN)
}

fn write_csv(
    writer: &mut dyn Write,
    trace: &Trace,
    current: &mut AdditiveCurrent,
) -> std::io::Result<()> {
    let mut writer = std::io::BufWriter::new(writer);
    writeln!(writer, "t,x,v,w_before,w_after,current,output")?;
    let lookahead = current.lookahead();
    for (at, (&x, &v)) in trace.positions.iter().zip(&trace.velocities).enumerate() {
        current.switch(trace.switched[at]);
        let end = trace.velocities.len().min(at + 1 + lookahead);
        let Cycle {
            w_before,
            w_after,
            current,
            output,
        } = current.step(x, v, &trace.velocities[at + 1..end]);
        let t = trace.times[at];
        writeln!(
            writer,
            "{t},{x},{v},{w_before},{w_after},{current},{output}"
        )?;
    }
    writer.flush()
}

/// The values that a list would give the control.
pub(super) fn value_list(path: &Path) -> Result<FrictionList, Failure> {
    let source = Arc::new(SourceFile::new(
        path.display().to_string(),
        read_text(path)?,
    ));
    let entries = Entries::parse(&source);
    let mut diagnostics = entries.diagnostics.clone();
    let draft = FrictionDraft::from_entries(&entries, &mut diagnostics);
    let reading = draft.check(&Conditions::default());
    diagnostics.extend(reading.diagnostics);
    let reason = match reading.verdict {
        Verdict::Accepted(list) => {
            let count = diagnostics.len();
            if count > 0 {
                let name = source.name();
                Console::talk(&format!(
                    "lists: {count} remarks (`frictcomp lists {name}` shows them)"
                ));
            }
            return Ok(list);
        }
        Verdict::Absent => "it holds no friction parameters",
        Verdict::Off => "its mode is 0, off",
        Verdict::Rejected(_) => "the control would reject it",
    };
    diagnostics.retain(|diagnostic| diagnostic.severity == Severity::Error);
    Err(Failure {
        message: format!(
            "the value list `{}` cannot be used: {reason}",
            source.name()
        ),
        help: Vec::new(),
        diagnostics,
    })
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
        if cycle.is_finite() && cycle > 0.0 {
            Ok(cycle)
        } else {
            Err(
                Failure::new(format!("a CNC cycle of {cycle} s is not possible"))
                    .with_help("write the seconds of a cycle, `--cycle-time 0.001`"),
            )
        }
    }

    /// Computes the columns that are missing: 1 unit of position is 0.1 units of velocity times
    /// a second (4.1 of the rules).
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
                position += velocity * cycle * 10.0;
                *place = position;
            }
        }
        if velocities.is_none() {
            let steps = self.positions.windows(2).map(|pair| pair[1] - pair[0]);
            let velocities = std::iter::once(0.0).chain(steps.map(|step| 0.1 * step / cycle));
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
            "{}:{row}: column `{column}` holds `{text}`, which is no number",
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

/// `standstill=zero,below=origin,delay=reversal`, each of them optional.
pub(super) fn parse_reading(text: &str) -> Result<Reading, String> {
    const OPTIONS: [&str; 6] = [
        "standstill=hold",
        "standstill=zero",
        "below=hold",
        "below=origin",
        "delay=all",
        "delay=reversal",
    ];
    let mut reading = Reading::default();
    for option in text
        .split(',')
        .map(str::trim)
        .filter(|option| !option.is_empty())
    {
        match option {
            "standstill=hold" => reading.standstill = Standstill::Hold,
            "standstill=zero" => reading.standstill = Standstill::Zero,
            "below=hold" => reading.below = Below::Hold,
            "below=origin" => reading.below = Below::Origin,
            "delay=all" => reading.delay = Delay::All,
            "delay=reversal" => reading.delay = Delay::Reversal,
            _ => {
                return Err(match did_you_mean(option, OPTIONS) {
                    Some(near) => format!("`{option}` is no reading, did you mean `{near}`?"),
                    None => format!("`{option}` is no reading; there are {}", OPTIONS.join(", ")),
                });
            }
        }
    }
    Ok(reading)
}
