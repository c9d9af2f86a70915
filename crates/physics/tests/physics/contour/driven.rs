//! The findings of the library on a program: deviations by line, and reversals.

use std::collections::BTreeMap;

use frictcomp::interpreter::{Motions, NoFiles, Options};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::Sink;
use frictcomp_physics::contour::{
    ContourOptions, ContourPoint, ContourReversal, ContourSink, MovingAxes, PerRun, ProgramContour,
    parameterise,
};
use frictcomp_physics::simulation::Plant;

/// The innermost and the outermost deviation of the three runs while a line was cut, in µm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extremes(pub(crate) PerRun<[f64; 2]>);

/// The time in which the residue of the previous line settles.
pub(crate) const SETTLING_S: f64 = 0.004;

/// The findings on a program.
#[derive(Debug, Default)]
pub(crate) struct Found {
    pub(crate) lines: BTreeMap<u32, Extremes>,
    pub(crate) reversals: Vec<ContourReversal>,
    /// The largest deviation in space, as programmed, in µm.
    pub(crate) largest_um: f64,
    /// Time from the start of a line that is not kept, in s.
    settling_s: f64,
    /// The line that is cut, and the start of the cut.
    since: (u32, f64),
}

/// Returns the smallest and the largest of the known values and one more.
pub(crate) fn widened(extremes: [f64; 2], deviation: f64) -> [f64; 2] {
    [extremes[0].min(deviation), extremes[1].max(deviation)]
}

impl Default for Extremes {
    fn default() -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self(PerRun {
            programmed: none,
            all_on: none,
            all_off: none,
        })
    }
}

impl Extremes {
    fn widen(&mut self, by: PerRun<f64>) {
        let Self(runs) = self;
        runs.programmed = widened(runs.programmed, by.programmed);
        runs.all_on = widened(runs.all_on, by.all_on);
        runs.all_off = widened(runs.all_off, by.all_off);
    }
}

impl ContourSink for Found {
    fn point(&mut self, point: &ContourPoint<'_>) {
        let line = point.cause.line;
        if self.since.0 != line {
            self.since = (line, point.time_s);
        }
        if point.counts {
            self.largest_um = self.largest_um.max(point.space_um.programmed);
        }
        if point.counts && point.time_s - self.since.1 >= self.settling_s {
            self.lines
                .entry(line)
                .or_default()
                .widen(point.deviation_um);
        }
    }

    fn reversal(&mut self, reversal: &ContourReversal) {
        self.reversals.push(reversal.clone());
    }
}

impl Found {
    /// Creates an empty result after a wait: the first cycles of a line show the residue of the previous line and are
    /// not kept.
    pub(crate) fn settled() -> Self {
        Self {
            settling_s: SETTLING_S,
            ..Self::default()
        }
    }

    /// Returns the extremes over some lines.
    pub(crate) fn over(&self, lines: std::ops::RangeInclusive<u32>) -> Extremes {
        let mut all = Extremes::default();
        for (_, Extremes(line)) in self.lines.range(lines) {
            for side in 0..2 {
                all.widen(PerRun {
                    programmed: line.programmed[side],
                    all_on: line.all_on[side],
                    all_off: line.all_off[side],
                });
            }
        }
        all
    }
}

/// The axis positions before a program.
type Stand<'a> = &'a [(&'a str, f64)];

/// Runs a program.
fn run(machine: &Machine, program: &str, (at, sink): (Stand<'_>, &mut dyn Sink)) {
    let options = SessionOptions::from(Options::default().with_motions(Motions::Taken));
    let start = at.iter().map(|(axis, at)| ((*axis).to_owned(), *at));
    let mut session = Session::new(machine.clone(), options.with_start(start.collect()));
    let source = SourceFile::new("part.nc", program);
    let _ = session.program("part.nc", Program::Whole(source), &mut NoFiles, sink);
}

/// Returns the contour of a program in the plane XY, from the given axis positions.
pub(crate) fn drive(
    machine: &str,
    plant: &Plant,
    program: (&str, Stand<'_>),
    found: Found,
) -> Found {
    let machine = Machine::from_toml(machine).expect("a machine");
    drive_on(machine, plant, program, found)
}

/// Returns the contour of a program on a machine that is read.
pub(crate) fn drive_on(
    mut machine: Machine,
    plant: &Plant,
    (program, at): (&str, Stand<'_>),
    found: Found,
) -> Found {
    let mut moving = MovingAxes::default();
    run(&machine, program, (at, &mut moving));
    let axes = moving.driven(&machine, ["X", "Y"], plant, &[]);
    let axes = axes.expect("axes");
    parameterise(&mut machine, &axes);
    let mut contour = ProgramContour::new(&machine, ContourOptions::new(axes), found);
    run(&machine, program, (at, &mut contour));
    let (report, found) = contour.finish();
    assert!(!report.is_unstable);
    assert_eq!(report.left_out, 0);
    found
}
