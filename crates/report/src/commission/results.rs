//! The results of a commissioning as text and JSON (R16.2, R16.9).

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::program::{number, told};
use super::summary::{PlanFile, ValueListUsed};
use crate::strings::to_pretty;
use crate::visible::visible_line;
use frictcomp_recordings::commission::{BeforeAfter, Found, FrictionFound, RecordingResult};

/// The content of `results.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Results {
    /// The form of this file.
    pub schema: u32,
    /// A result for each recording.
    pub recordings: Vec<RecordingResult>,
}

impl Results {
    /// The form that is written.
    pub const SCHEMA: u32 = 1;
}

/// The list of an axis, or the reasons for which there is none.
#[derive(Debug, Clone, Serialize)]
pub struct AxisVerdict {
    /// The axis.
    pub axis: String,
    /// The file of the provisional list, as it is shown.
    pub list: Option<String>,
    /// The recording that it rests on.
    pub from: Option<String>,
    /// Reasons against a list, and what there is to say about it.
    pub notes: Vec<String>,
}

/// All that is known of a commissioning.
#[derive(Debug, Clone)]
pub struct ResultsReport {
    /// The plans of both stages, as far as they are there.
    pub plans: Vec<PlanFile>,
    /// A result for each recording.
    pub results: Vec<RecordingResult>,
    /// The number of results that were kept from an earlier run.
    pub kept: usize,
    /// The lists.
    pub axes: Vec<AxisVerdict>,
    /// The circles with compensation off and on.
    pub circles: Vec<BeforeAfter>,
    /// Reasons for which the lists of stage 2 are not accepted; `None` before they can be judged.
    pub against_lists: Option<Vec<String>>,
}

impl ResultsReport {
    /// The programs without a recording that is used.
    pub fn missing(&self) -> Vec<String> {
        let programs = self.plans.iter().flat_map(|it| it.plan.programs.iter());
        let lacks = |number: u8| {
            !self
                .results
                .iter()
                .any(|it| it.program == Some(number) && is_used(&it.found))
        };
        let missing = programs.filter(|it| lacks(it.number));
        missing.map(|it| it.file.clone()).collect()
    }

    /// Whether every program is recorded, every axis has a list, and the lists of stage 2 are accepted.
    pub fn is_complete(&self) -> bool {
        self.missing().is_empty()
            && self.axes.iter().all(|it| it.list.is_some())
            && self.against_lists.as_ref().is_some_and(Vec::is_empty)
    }

    /// The friction that the list of an axis is made of.
    pub fn friction_of(&self, axis: &AxisVerdict) -> Option<&FrictionFound> {
        let from = axis.from.as_ref()?;
        self.results.iter().find_map(|it| match &it.found {
            Found::Friction(found) if it.file == *from => Some(found),
            _ => None,
        })
    }

    fn lists(&self) -> impl Iterator<Item = &ValueListUsed> {
        self.plans.iter().flat_map(|it| it.lists.iter())
    }
}

fn is_used(found: &Found) -> bool {
    match found {
        Found::Friction(found) => found.against.is_empty(),
        Found::Circles(found) => found.against.is_empty(),
        Found::Refused(_) => false,
    }
}

/// The recordings, what is missing, the lists, and the circles before and after.
pub fn render_results(report: &ResultsReport) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "{} recordings, {} of them known from an earlier run\n",
        report.results.len(),
        report.kept
    );
    for result in &report.results {
        push_recording(&mut out, report, result);
    }
    for file in report.missing() {
        let _ = writeln!(
            out,
            "missing: a recording of {} that can be used",
            visible_line(&file)
        );
    }
    out.push('\n');
    for axis in &report.axes {
        let name = visible_line(&axis.axis);
        match (&axis.list, &axis.from) {
            (Some(list), Some(from)) => {
                let _ = writeln!(
                    out,
                    "{name}: provisional list {}, from {}",
                    visible_line(list),
                    visible_line(from)
                );
            }
            _ => {
                let _ = writeln!(out, "{name}: no list");
            }
        }
        for note in &axis.notes {
            let _ = writeln!(out, "  {}", visible_line(note));
        }
    }
    push_circles(&mut out, report);
    out
}

fn push_recording(out: &mut String, report: &ResultsReport, result: &RecordingResult) {
    let mut programs = report
        .plans
        .iter()
        .flat_map(|it| it.plan.programs.iter().map(move |program| (program, it)));
    let program = programs.find(|(program, _)| Some(program.number) == result.program);
    let what = program.map(|(program, file)| told(program, &file.plan.axes));
    let what = what.unwrap_or_else(|| "program not known".to_owned());
    let _ = writeln!(
        out,
        "{}: {}",
        visible_line(&result.file),
        visible_line(&what)
    );
    let (notes, against) = match &result.found {
        Found::Friction(found) => (&found.notes[..], &found.against[..]),
        Found::Circles(found) => {
            let _ = writeln!(
                out,
                "  recorded: v²/R {:.2} mm/s², glitch at most {:.1} µm",
                found.acceleration, found.worst_um
            );
            (&found.notes[..], &found.against[..])
        }
        Found::Refused(reason) => (&[][..], std::slice::from_ref(reason)),
    };
    for reason in against {
        let _ = writeln!(out, "  not used: {}", visible_line(reason));
    }
    for note in notes {
        let _ = writeln!(out, "  {}", visible_line(note));
    }
}

/// The circles off and on, and whether the lists of stage 2 are accepted.
fn push_circles(out: &mut String, report: &ResultsReport) {
    if !report.circles.is_empty() {
        let _ = writeln!(
            out,
            "\nrecorded glitch in µm, the largest of both directions\n{:>12} {:>8} {:>8}",
            "feed mm/min", "off", "on"
        );
    }
    for circle in &report.circles {
        let _ = writeln!(
            out,
            "{:>12} {:>8.1} {:>8.1}",
            number(circle.feed),
            circle.off_um,
            circle.on_um
        );
    }
    out.push('\n');
    match &report.against_lists {
        None => out.push_str(
            "no list is accepted: stage 2, the same circles with it on, is not recorded\n",
        ),
        Some(against) if against.is_empty() => {
            let lists: Vec<String> = report
                .lists()
                .map(|it| {
                    format!(
                        "{} {} ({})",
                        it.axis,
                        it.file,
                        it.sha256.get(..16).unwrap_or(&it.sha256)
                    )
                })
                .collect();
            let _ = writeln!(
                out,
                "accepted: {}; at each of the {} recorded feeds it leaves less than there is without it. Other \
                 feeds were not recorded",
                visible_line(&lists.join(", ")),
                report.circles.len()
            );
        }
        Some(against) => {
            out.push_str("not accepted, the lists of before stay:\n");
            for reason in against {
                let _ = writeln!(out, "  {}", visible_line(reason));
            }
        }
    }
}

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    complete: bool,
    recordings: &'a [RecordingResult],
    missing: Vec<String>,
    axes: &'a [AxisVerdict],
    circles: &'a [BeforeAfter],
    lists: Vec<&'a ValueListUsed>,
    against_lists: Option<&'a [String]>,
}

/// The same for machines.
pub fn render_results_json(report: &ResultsReport) -> String {
    to_pretty(&Document {
        schema: Results::SCHEMA,
        complete: report.is_complete(),
        recordings: &report.results,
        missing: report.missing(),
        axes: &report.axes,
        circles: &report.circles,
        lists: report.lists().collect(),
        against_lists: report.against_lists.as_deref(),
    })
}
