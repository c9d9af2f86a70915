//! The results of a commissioning as a document and JSON (R16.2, R16.9).

use std::fmt::Write as _;

use serde::Serialize;

use super::acceptance::{Acceptance, push_acceptance};
use super::picture::glitches_by_feed;
use super::plants::{FittedPlantRecord, lacking, push_plants};
use super::words::{number, told};
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::{counted, to_json, visible_line};
use frictcomp_recordings::commission::{
    AxisVerdict, InputFile, RecordingOutcome, RecordingResult, Results, ResultsReport, Round,
    Shows, ValueListUsed,
};

/// Returns the verdict: whether the lists of the last round are accepted, and what speaks against them (R18.20).
fn headline(report: &ResultsReport) -> Headline {
    let missing = match report.missing().len() {
        0 => String::new(),
        1 => "; 1 program has no usable recording".to_owned(),
        more => format!("; {more} programs have no usable recording"),
    };
    let plant = report.fitted.verdicts.last();
    let rejected = plant.and_then(|plant| plant.rejected.first());
    let (standing, text) = match report.rounds.last().map(|it| (it, it.against.as_deref())) {
        None | Some((_, None)) => (
            Standing::Open,
            "no list is accepted yet: the motion with compensation on is not recorded".to_owned(),
        ),
        Some((round, Some(_))) if round.is_accepted() => (
            if report.is_complete() {
                Standing::Good
            } else {
                Standing::Open
            },
            format!(
                "the lists of round {} are accepted: at each of the {} recorded feeds they leave no more than \
                 there was without them{}",
                round.number,
                round.recorded.len(),
                limit(round)
            ),
        ),
        Some((round, Some(against))) => {
            let reason = against.iter().chain(&round.not_shown).next();
            let reason = reason.map_or(String::new(), |it| format!(": {it}"));
            let text = format!(
                "the lists of round {} are {}, the earlier ones stay{reason}",
                round.number,
                refusal(round)
            );
            (Standing::Bad, text)
        }
    };
    let rejected = rejected.map_or(String::new(), |it| format!("; the plant is rejected: {it}"));
    Headline::new(standing, format!("{text}{rejected}{missing}"))
}

/// Returns the limitation of an acceptance, in words.
fn limit(round: &Round) -> &'static str {
    match round.shows {
        Shows::FollowingError => ", and no contour",
        Shows::Contour => "",
    }
}

/// Returns in words the figure that is compared.
fn figure(round: &Round) -> &'static str {
    match round.shows {
        Shows::FollowingError => "following error after reversals; motor side, not contour",
        Shows::Contour => "glitch, a mean over 8 ms without noise, the largest of all turns",
    }
}

/// Returns the verdict on lists that are not accepted: something speaks against them, or only proof is missing.
fn refusal(round: &Round) -> &'static str {
    match round.against.as_deref() {
        Some([]) => "not proven",
        _ => "not accepted",
    }
}

/// Returns the recordings, what is missing, the lists, the circles before and after, and the plants; then what an
/// acceptance needs: the friction of each axis, and the files and statements on which the results rest.
pub fn document<'a>(report: &'a ResultsReport, given: &'a Acceptance) -> Document<'a> {
    let machine = given.machine.as_deref();
    let title = format!(
        "Friction compensation of {}",
        machine.unwrap_or("a machine without a name")
    );
    let mut out = Document::new(title, headline(report));
    let _ = writeln!(
        out,
        "\n{}, {} of them known from an earlier run\n",
        counted(report.results.len(), "recording"),
        report.kept
    );
    out.section("Recordings");
    for result in &report.results {
        push_recording(&mut out, report, result);
    }
    let missing = report.missing();
    let missing = missing.iter().map(|file| visible_line(file));
    out.lines(missing.map(|file| format!("missing: a recording of {file} that can be used")));
    out.section("Lists");
    out.push_str("\n");
    for axis in &report.axes {
        push_list(&mut out, axis);
    }
    for round in &report.rounds {
        push_round(&mut out, round);
    }
    if report.rounds.iter().any(|it| it.against.is_some()) {
        push_plants(&mut out, &report.fitted);
    }
    push_acceptance(&mut out, report, given);
    out
}

fn push_list(out: &mut Document<'_>, axis: &AxisVerdict) {
    let name = visible_line(&axis.axis);
    match (&axis.list, &axis.from) {
        (Some(list), Some(from)) => {
            let (list, from) = (visible_line(list), visible_line(from));
            out.lines([format!("{name}: provisional list {list}, from {from}")]);
        }
        _ => out.lines([format!("{name}: no list")]),
    }
    let notes = axis.notes.iter();
    out.lines(notes.map(|note| format!("  {}", visible_line(note))));
}

fn push_recording(out: &mut Document<'_>, report: &ResultsReport, result: &RecordingResult) {
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
    match &result.found {
        RecordingOutcome::Circles(found) => {
            let glitches = found.glitches.iter().flat_map(|it| &it.crossings);
            let error = glitches
                .filter(|it| it.um >= found.worst_um)
                .map(|it| it.error_um);
            let _ = writeln!(
                out,
                "  recorded: v²/R {:.2} mm/s², glitch at most {:.1} ± {:.1} µm",
                found.acceleration,
                found.worst_um,
                error.fold(0.0, f64::max)
            );
        }
        RecordingOutcome::Strokes(found) => {
            let _ = writeln!(
                out,
                "  recorded: following error of at most {:.1} {} after a reversal",
                found.worst(),
                found.unit
            );
        }
        RecordingOutcome::Friction(_) | RecordingOutcome::Refused(_) => {}
    }
    for reason in result.found.against() {
        let _ = writeln!(out, "  not used: {}", visible_line(reason));
    }
    for note in result.found.notes() {
        let _ = writeln!(out, "  {}", visible_line(note));
    }
}

/// Adds the circles off and on, and whether the lists are accepted.
fn push_round<'a>(out: &mut Document<'a>, round: &'a Round) {
    let Some(against) = &round.against else {
        return;
    };
    out.section(format!("Round {}", round.number));
    out.figure(|| glitches_by_feed(round));
    let table = Table::of_numbers(["feed /min", "driven"]).left("axis");
    let table = table.right("off").right("±").right("on").right("±");
    let mut table = table.right("left in %");
    for pair in &round.recorded {
        for place in &pair.places {
            let direction = place.direction.as_deref().unwrap_or_default();
            table.row(&[
                &number(pair.feed),
                &format_args!("{:.0}", pair.driven),
                &visible_line(format!("{} {direction}", place.axis).trim_end()),
                &format_args!("{:.1}", place.off.um),
                &format_args!("{:.1}", place.off.error_um),
                &format_args!("{:.1}", place.on.um),
                &format_args!("{:.1}", place.on.error_um),
                &format_args!("{:.0}", 100.0 * place.on.um / place.off.um),
            ]);
        }
    }
    let _ = writeln!(
        out,
        "\nround {}: recorded {}, in {}",
        round.number,
        figure(round),
        round.unit,
    );
    out.table(table);
    if round.is_accepted() {
        let list = |it: &ValueListUsed| {
            let sum = it.sha256.get(..16).unwrap_or(&it.sha256);
            format!("{} {} ({sum})", it.axis, it.file)
        };
        let lists: Vec<String> = round.lists.iter().map(list).collect();
        let _ = writeln!(
            out,
            "\naccepted: {}; at each of the {} recorded feeds no axis has more left in either direction than without \
             it, nor than with the lists that were accepted before, beyond the errors. Other feeds were not recorded{}",
            visible_line(&lists.join(", ")),
            round.recorded.len(),
            limit(round)
        );
    } else {
        let _ = writeln!(out, "\n{}, the earlier lists stay:", refusal(round));
        let reasons = against.iter().chain(&round.not_shown);
        out.lines(reasons.map(|reason| format!("  {}", visible_line(reason))));
    }
}

#[derive(Serialize)]
struct ResultsDocument<'a> {
    schema: u32,
    headline: Headline,
    complete: bool,
    recordings: &'a [RecordingResult],
    inputs: &'a [InputFile],
    said: &'a [String],
    missing: Vec<String>,
    axes: &'a [AxisVerdict],
    plants: Vec<FittedPlantRecord<'a>>,
    no_plant: Vec<&'a str>,
    rounds: &'a [Round],
}

/// Returns the results as JSON.
pub fn render_results_json(report: &ResultsReport) -> String {
    to_json(&ResultsDocument {
        schema: Results::SCHEMA,
        headline: headline(report),
        complete: report.is_complete(),
        recordings: &report.results,
        inputs: &report.inputs,
        said: &report.said,
        missing: report.missing(),
        axes: &report.axes,
        plants: report
            .fitted
            .verdicts
            .iter()
            .map(FittedPlantRecord::of)
            .collect(),
        no_plant: lacking(&report.fitted),
        rounds: &report.rounds,
    })
}
