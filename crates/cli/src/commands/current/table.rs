//! Writing the currents of a program as CSV.

use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;
use std::sync::Arc;

use super::args::CurrentColumn;
use super::plot::Plot;
use frictcomp::comp::State;
use frictcomp_host::{Done, LineTracker, Reached, Watch};
use frictcomp_physics::current::{CurrentCycle, CurrentSample, CurrentSink};
use frictcomp_physics::motion::Simplification;
use frictcomp_report::pictures::AxisSample;

/// Number of cycles between two looks at the clock.
const STEP: u64 = 1 << 16;

/// Subject and columns of a table.
pub(super) struct TableOptions<'a> {
    pub(super) names: &'a [String],
    pub(super) columns: &'a [CurrentColumn],
    /// The name of the program in records.
    pub(super) program: String,
    pub(super) watch: Arc<Watch>,
}

/// The rows of the result that are being written.
pub(super) struct CurrentRows {
    columns: Vec<CurrentColumn>,
    writer: BufWriter<Box<dyn Write + Send>>,
    written: io::Result<()>,
    cycles: u64,
    watch: Arc<Watch>,
    program: String,
    tracker: LineTracker,
    /// Times and lines at which the trace begins and resumes.
    begins: Vec<(f64, u32)>,
    /// The states of each axis, other than active.
    seen: Vec<Vec<State>>,
    /// The strongest output of each axis, with its line.
    strongest: Vec<(i16, u32)>,
    /// The time of the last cycle in s.
    last_s: f64,
    plot: Option<Plot>,
    /// The current block: program and executed block.
    block: Option<(u32, u64)>,
}

impl CurrentRows {
    /// Creates a table with its header.
    pub(super) fn new(
        writer: Box<dyn Write + Send>,
        options: TableOptions<'_>,
        plot: Option<Plot>,
    ) -> Self {
        let mut writer = BufWriter::new(writer);
        Self {
            columns: options.columns.to_vec(),
            written: writeln!(
                writer,
                "{}",
                header(options.names, options.columns).join(",")
            ),
            writer,
            cycles: 0,
            watch: options.watch,
            program: options.program,
            tracker: LineTracker::default(),
            begins: Vec::new(),
            seen: vec![Vec::new(); options.names.len()],
            strongest: vec![(0, 0); options.names.len()],
            last_s: 0.0,
            plot,
            block: None,
        }
    }

    /// Returns the times and lines at which the trace begins and resumes.
    pub(super) fn begins(&self) -> &[(f64, u32)] {
        &self.begins
    }

    /// Returns the states of each axis, other than active.
    pub(super) fn seen(&self) -> &[Vec<State>] {
        &self.seen
    }

    /// Returns the verdict: the strongest output of each axis (R18.20).
    pub(super) fn verdict(&self, names: &[String]) -> String {
        let axes = names.iter().zip(&self.strongest);
        let axes = axes.map(|(name, (output, line))| match output {
            0 => format!("nothing is added to {name}"),
            _ => format!(
                "{name} at most {} drive units (line {line})",
                output.unsigned_abs()
            ),
        });
        let axes: Vec<String> = axes.collect();
        format!("over {:.3} s of motion: {}", self.last_s, axes.join(", "))
    }

    /// Takes the picture of the output.
    pub(super) fn take_plot(&mut self) -> Option<Plot> {
        self.plot.take()
    }

    /// Writes the rest, or returns why a row could not be written.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        std::mem::replace(&mut self.written, Ok(()))?;
        self.writer.flush()
    }
}

/// Returns the columns: `t,x,v,…` for one axis, `t,x.X,v.X,…` for several.
pub(super) fn header<N: AsRef<str>>(names: &[N], columns: &[CurrentColumn]) -> Vec<String> {
    let mut header = vec!["t".to_owned()];
    for name in names {
        let suffix = match names.len() {
            1 => String::new(),
            _ => format!(".{}", name.as_ref()),
        };
        let comp = columns.contains(&CurrentColumn::Comp).then_some("comp");
        let of_axis = ["x", "v", "w_before", "w_after", "current", "output"];
        for column in of_axis.into_iter().chain(comp) {
            header.push(format!("{column}{suffix}"));
        }
    }
    for (column, name) in [
        (CurrentColumn::Line, "line"),
        (CurrentColumn::Simplified, "simplified"),
    ] {
        if columns.contains(&column) {
            header.push(name.to_owned());
        }
    }
    header
}

impl CurrentSink for CurrentRows {
    fn begin(&mut self, time_s: f64, line: u32) {
        if let Some(plot) = &mut self.plot {
            plot.traces.interrupt();
        }
        self.begins.push((time_s, line));
    }

    fn cycle(&mut self, cycle: &CurrentCycle<'_>) -> ControlFlow<()> {
        self.cycles += 1;
        let passes = self.tracker.reach(cycle.cause.line);
        if self.cycles.is_multiple_of(STEP) {
            let reached = Reached {
                file: &self.program,
                line: cycle.cause.line,
            };
            self.watch
                .show_program(Done::Cycles(self.cycles), reached, passes);
        }
        self.last_s = cycle.time_s;
        for (strongest, axis) in self.strongest.iter_mut().zip(cycle.axes) {
            if axis.added.output.unsigned_abs() > strongest.0.unsigned_abs() {
                *strongest = (axis.added.output, cycle.cause.line);
            }
        }
        for (seen, axis) in self.seen.iter_mut().zip(cycle.axes) {
            let state = axis.commanded.friction;
            if state != State::Active && !seen.contains(&state) {
                seen.push(state);
            }
        }
        if self.written.is_ok() {
            self.written = write_row(&mut self.writer, &self.columns, cycle);
        }
        if let Some(plot) = &mut self.plot {
            let (cause, block) = (cycle.cause, (cycle.cause.program, cycle.cause.seq));
            if self.block.replace(block) != Some(block) {
                plot.traces.block(cycle.time_s, cause.number, cause.line);
            }
            let axes = cycle.axes.iter();
            plot.traces.push(
                cycle.time_s,
                axes.map(|it| AxisSample {
                    velocity: it.commanded.velocity_units,
                    state: it.commanded.friction,
                    added: &it.added,
                }),
            );
        }
        match self.written {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    }
}

fn write_row(
    writer: &mut impl Write,
    columns: &[CurrentColumn],
    cycle: &CurrentCycle<'_>,
) -> io::Result<()> {
    write!(writer, "{}", cycle.time_s)?;
    for CurrentSample { commanded, added } in cycle.axes {
        let (x, v) = (commanded.position_units, commanded.velocity_units);
        write!(writer, ",{x},{v},{},{}", added.w_before, added.w_after)?;
        match commanded.friction {
            // The current is unknown.
            State::Unknown => write!(writer, ",,")?,
            _ => write!(writer, ",{},{}", added.current_units, added.output)?,
        }
        if columns.contains(&CurrentColumn::Comp) {
            write!(writer, ",{}", commanded.friction.as_str())?;
        }
    }
    if columns.contains(&CurrentColumn::Line) {
        write!(writer, ",{}", cycle.cause.line)?;
    }
    if columns.contains(&CurrentColumn::Simplified) {
        let names = cycle.cause.simplified.iter().map(Simplification::name);
        write!(writer, ",{}", names.collect::<Vec<_>>().join(" "))?;
    }
    writeln!(writer)
}
