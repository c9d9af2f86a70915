//! A contour as a document.

use std::fmt::Write as _;

use super::places::ProgramBlock;
use super::recorder::ContourRecorder;
use super::remarks::{compensation, conditions, contour_remarks, not_judged};
use crate::assumptions::{not_modelled, not_modelled_line};
use crate::document::{Document, Headline, Phrase, Standing, Table};
use crate::wording::{Detail, counted, glitch_in_words, visible_line};
use frictcomp::comp::State;
use frictcomp_physics::contour::{
    ContourCompensation, ContourReport, ContourReversal, ContourSummary, Deviations, GlitchFigure,
};
use frictcomp_physics::motion::Cause;

/// Driven program.
#[derive(Debug, Clone)]
pub struct ContourSubject {
    /// Path of the program.
    pub program: String,
    /// The plant.
    pub plant: String,
}

impl ContourSubject {
    /// Returns the program, and whether its contour is judged.
    pub fn heading(&self, contour: &ContourReport) -> String {
        if contour.obstacles.is_empty() {
            self.program.clone()
        } else {
            format!("{}, not judged", self.program)
        }
    }
}

/// Returns the verdict: the reversals without compensation and what they cost, or what is not judged (R18.11, R18.20,
/// R18.26).
pub fn headline(contour: &ContourReport) -> Headline {
    let (standing, found) = match contour.compensation() {
        ContourCompensation::Missing { axes, is_measured } => {
            let missing = axes.into_iter().map(|axis| {
                let reversals = counted(axis.uncompensated, "reversal");
                let dearest = axis.dearest.as_ref().filter(|_| is_measured);
                let cost = dearest.map_or(String::new(), |dearest| {
                    format!(
                        ": {:.1} µm at {}, {:.1} µm with compensation",
                        dearest.glitch_um.programmed,
                        ProgramBlock::from(dearest).words(),
                        dearest.glitch_um.all_on,
                    )
                });
                format!("{} is not compensated at {reversals}{cost}", axis.axis)
            });
            (Standing::Bad, missing.collect::<Vec<_>>().join("; "))
        }
        ContourCompensation::Worsening(worst) => {
            let text = format!(
                "compensation makes {} worse: {:.1} µm at {}, {:.1} µm without compensation",
                worst.axis,
                worst.glitch_um.programmed,
                ProgramBlock::from(worst).words(),
                worst.glitch_um.all_off
            );
            (Standing::Bad, text)
        }
        ContourCompensation::Complete(worst) => {
            let text = format!(
                "every reversal that was driven is compensated: {} leaves at most {:.1} µm, at {}",
                worst.axis,
                worst.glitch_um.programmed,
                ProgramBlock::from(worst).words()
            );
            (Standing::Good, text)
        }
        ContourCompensation::NoReversal => {
            (Standing::Good, "no axis reverses while cutting".to_owned())
        }
        _ => {
            let text = "no path was driven while cutting".to_owned();
            (Standing::Open, text)
        }
    };
    match (contour.obstacles.first(), standing) {
        (None, _) => Headline::new(standing, found),
        (Some(first), standing) => {
            let standing = if standing == Standing::Bad {
                standing
            } else {
                Standing::Open
            };
            Headline::new(standing, format!("not judged as a whole: {first}; {found}"))
        }
    }
}

/// Returns the figures of the three runs, a sentence for each axis, the worst reversals, and the conditions.
pub fn document(
    contour: &ContourReport,
    recorder: &ContourRecorder<'_>,
    subject: &ContourSubject,
) -> Document<'static> {
    let title = format!("Contour of {}", subject.heading(contour));
    let mut out = Document::new(title, headline(contour));
    let axes = &contour.options.axes;
    let _ = writeln!(
        out,
        "\n{}: contour in the plane {}{}, {:.3} s of machine time, plant {}\n",
        visible_line(&subject.program),
        axes[0].name,
        axes[1].name,
        contour.machine_time_s,
        visible_line(&subject.plant),
    );
    out.lines(not_judged(&contour.obstacles));
    if !contour.obstacles.is_empty() {
        out.push_str("\n");
    }
    out.section("Figures");
    if contour.deviations.programmed.max_at().is_some() {
        push_figures(&mut out, contour);
        push_due(&mut out, contour);
    } else {
        out.push_str("no path was driven while cutting: there are no deviations to report\n");
    }
    out.lines(contour_remarks(contour, Detail::Brief));
    out.push_str("\n");
    out.section("Reversals");
    let is_whole = contour.is_whole();
    for axis in &contour.axes {
        let _ = writeln!(out, "{}", sentence(axis, Counted::of(is_whole)));
    }
    push_switches(&mut out, recorder.switches());
    push_beside_the_plane(&mut out, &contour.axes);
    push_worst(&mut out, recorder.worst(), &subject.program);
    let unknown = contour.time_not_of_the_machine_s;
    if unknown > 0.0 {
        let _ = writeln!(
            out,
            "left out: {unknown:.3} s in which positions are those of the program, not of the machine"
        );
    }
    if contour.left_out > 0 {
        let motions = match contour.left_out {
            1 => "1 motion".to_owned(),
            count => format!("{count} motions"),
        };
        let _ = writeln!(
            out,
            "left out: {motions} whose start, end or feed is not known"
        );
    }
    out.folded("Conditions");
    out.push_str("\n");
    out.lines(conditions(contour));
    out.lines(contour.options.axes.iter().map(compensation));
    let drives = contour.options.axes.iter().map(|axis| &axis.drive);
    out.lines([not_modelled_line(&not_modelled(drives))]);
    out
}

/// Adds the figures of the three runs, and the places of the extreme ones.
fn push_figures(out: &mut Document<'_>, contour: &ContourReport) {
    let runs = &contour.deviations;
    let runs = [&runs.programmed, &runs.all_on, &runs.all_off];
    let table = Table::default().left("while cutting, in µm");
    let mut table = table.right("programmed").right("all on").right("all off");
    for (name, values) in [
        ("largest deviation", runs.map(Deviations::max_um)),
        ("outermost", runs.map(|run| run.outermost_um)),
        ("innermost", runs.map(|run| run.innermost_um)),
        ("root mean square", runs.map(Deviations::rms_um)),
    ] {
        let [programmed, on, off] = values.map(|value| format!("{:.1}", value + 0.0));
        table.row(&[&name, &programmed, &on, &off]);
    }
    out.table(table);
    out.push_str("\n");
    for (name, at) in [
        (
            "largest deviation",
            runs.map(|run| run.max_at().map(|at| &**at)),
        ),
        ("outermost", runs.map(|run| run.outermost_at.as_deref())),
        ("innermost", runs.map(|run| run.innermost_at.as_deref())),
    ] {
        if let Some(places) = places(at) {
            let _ = writeln!(out, "{name} at {places}");
        }
    }
}

/// Returns text such as "part.nc:165 N1640 (programmed, all off), part.nc:168 N1670 (all on)".
fn places(at: [Option<&Cause>; 3]) -> Option<String> {
    let mut places: Vec<(String, Vec<&str>)> = Vec::new();
    for (at, run) in at.into_iter().zip(["programmed", "all on", "all off"]) {
        let place = ProgramBlock::from(at?).words();
        match places.iter_mut().find(|(known, _)| *known == place) {
            Some((_, runs)) => runs.push(run),
            None => places.push((place, vec![run])),
        }
    }
    if let [(place, _)] = places.as_slice() {
        return Some(place.clone());
    }
    let places = places.into_iter();
    let places = places.map(|(place, runs)| format!("{place} ({})", runs.join(", ")));
    Some(places.collect::<Vec<String>>().join(", "))
}

fn push_due(out: &mut Document<'_>, contour: &ContourReport) {
    let due = &contour.due;
    let _ = match &due.at {
        Some(at) => writeln!(
            out,
            "missing compensation costs up to {:.1} µm, at {}",
            due.um,
            ProgramBlock::from(&**at).words()
        ),
        None => writeln!(out, "missing compensation costs 0 µm"),
    };
}

/// Writes the switches of compensation during a motion of the axis (R1.57).
fn push_switches(out: &mut Document<'_>, (switches, more): (&[ContourReversal], u64)) {
    for switch in switches {
        let way = if switch.state == State::Active {
            "on"
        } else {
            "off"
        };
        let _ = write!(
            out,
            "{} is switched {way} while it keeps moving, before {}",
            switch.axis,
            ProgramBlock::from(switch).words()
        );
        let glitch = &switch.glitch_um;
        let _ = match switch.figure {
            GlitchFigure::Measured => writeln!(
                out,
                ": {:.1} µm there against {:.1} µm with all on; if the command stops the path, there is no jump",
                glitch.programmed, glitch.all_on
            ),
            GlitchFigure::AlongPath => writeln!(out, ": {}", glitch_in_words(switch)),
            GlitchFigure::Missing => writeln!(out, "; {}", glitch_in_words(switch)),
        };
    }
    if more > 0 {
        let _ = writeln!(out, "and {more} more such places");
    }
}

/// A glitch in µm that a deviation in its plane would show.
const NOTICEABLE_UM: f64 = 1.0;

/// Reports that an axis outside the plane deviates as well, in a plane that is not shown.
fn push_beside_the_plane(out: &mut Document<'_>, axes: &[ContourSummary]) {
    let [first, second, further @ ..] = axes else {
        return;
    };
    for axis in further {
        let worst = axis.worst.as_ref();
        if worst.is_some_and(|worst| worst.glitch_um.all_off > NOTICEABLE_UM) {
            let _ = writeln!(
                out,
                "outermost and innermost are those in the plane {}{}; `--plane {},{}` shows those of {}",
                first.axis, second.axis, first.axis, axis.axis, axis.axis
            );
        }
    }
}

/// Extent to which the reversals of a program are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Counted {
    All,
    /// Some motions were left out, and reversals with them.
    AtLeast,
}

impl Counted {
    fn of(is_whole: bool) -> Self {
        if is_whole { Self::All } else { Self::AtLeast }
    }
}

/// Returns text such as "X reverses 412 times while cutting, 57 times without compensation: …".
fn sentence(axis: &ContourSummary, counted: Counted) -> String {
    let mut text = format!("{} ", axis.axis);
    let rapid = match axis.rapid {
        0 => String::new(),
        rapid => format!(" ({} in rapid)", times(rapid)),
    };
    match (axis.cutting, counted) {
        (0, Counted::All) => {
            let _ = write!(text, "does not reverse while cutting{rapid}");
        }
        (0, Counted::AtLeast) => {
            let _ = write!(
                text,
                "has no reversal in the feed moves that were driven{rapid}; whether it reverses in \
                 what was left out is not known"
            );
        }
        (cutting, counted) => {
            let (least, driven) = match counted {
                Counted::All => ("", ""),
                Counted::AtLeast => ("at least ", " in what was driven"),
            };
            let cutting = times(cutting);
            let _ = write!(text, "reverses {least}{cutting} while cutting{rapid}");
            if axis.unmeasured > 0 {
                let _ = write!(
                    text,
                    ", {} too near to a stop or a corner for a figure",
                    times(axis.unmeasured)
                );
            }
            match &axis.dearest {
                None if axis.uncompensated > 0 => {
                    let _ = write!(
                        text,
                        ", {least}{} without compensation, where there is no figure",
                        times(axis.uncompensated)
                    );
                }
                None => {
                    let _ = write!(text, ", always with compensation{driven}");
                }
                Some(dearest) if dearest.figure == GlitchFigure::AlongPath => {
                    let _ = write!(
                        text,
                        ", {least}{} without compensation: {} at {}",
                        times(axis.uncompensated),
                        glitch_in_words(dearest),
                        ProgramBlock::from(dearest).words()
                    );
                }
                Some(dearest) => {
                    let _ = write!(
                        text,
                        ", {least}{} without compensation: {:.1} µm there against {:.1} µm with it, at {}",
                        times(axis.uncompensated),
                        dearest.glitch_um.programmed,
                        dearest.glitch_um.all_on,
                        ProgramBlock::from(dearest).words()
                    );
                }
            }
        }
    }
    if let Some(worst) = &axis.worst {
        let _ = write!(
            text,
            "; worst at {}, {}",
            ProgramBlock::from(worst).words(),
            glitch_in_words(worst)
        );
    }
    text
}

fn times(count: u64) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        count => format!("{count} times"),
    }
}

fn push_worst(out: &mut Document<'_>, worst: &[ContourReversal], program: &str) {
    if worst.is_empty() {
        return;
    }
    let mut table = Table::default().right("line").left("axis").left("state");
    for heading in ["F", "reached", "mm/s²", "programmed", "all on", "all off"] {
        table = table.right(heading);
    }
    table = table.left("block");
    for reversal in worst {
        let glitch = &reversal.glitch_um;
        let is_measured = reversal.figure == GlitchFigure::Measured;
        let glitches = [glitch.programmed, glitch.all_on, glitch.all_off];
        let [programmed, all_on, all_off] = glitches.map(|um| {
            if is_measured {
                format!("{um:.1}")
            } else {
                "-".to_owned()
            }
        });
        let block = ProgramBlock::from(reversal).beside(program);
        let why = if is_measured {
            String::new()
        } else {
            format!(" ({})", glitch_in_words(reversal))
        };
        let feed = reversal.programmed_mm_per_min;
        table.cells([
            Phrase::leading(reversal.line.to_string(), &reversal.file, reversal.line),
            visible_line(&reversal.axis).into(),
            Phrase::state(reversal.state),
            feed.map_or("-".to_owned(), |feed| format!("{feed:.0}"))
                .into(),
            format!("{:.0}", reversal.feed_mm_per_min).into(),
            format!("{:.0}", reversal.acceleration_mm_per_s2.round() + 0.0).into(),
            programmed.into(),
            all_on.into(),
            all_off.into(),
            format!("{block}{why}").into(),
        ]);
    }
    out.push_str("\nworst reversals, glitch in µm, feeds in mm/min\n");
    out.table(table);
}
