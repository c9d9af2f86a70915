//! Learning from recorded circles as text and JSON (R16.4).

use std::fmt::Write as _;

use serde::Serialize;

use crate::assumptions::{not_modelled, not_modelled_line};
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::{to_json, visible_line};
use frictcomp_recordings::commission::{LearnReport, LearnedAxis, NextStep, Prediction};

/// Returns the record as JSON.
pub fn render_json(report: &LearnReport) -> String {
    #[derive(Serialize)]
    struct LearnRecord<'a> {
        headline: Headline,
        schema: u32,
        plant: &'a str,
        not_modelled: Vec<&'static str>,
        feeds: &'a [f64],
        axes: &'a [LearnedAxis; 2],
        predictions: &'a [[Option<Prediction>; 2]],
        next: &'a NextStep,
    }
    let record = LearnRecord {
        headline: headline(report),
        schema: 1,
        plant: &report.plant.name,
        not_modelled: not_modelled([&report.plant.x, &report.plant.y]),
        feeds: &report.feeds,
        axes: &report.axes,
        predictions: &report.predictions,
        next: &report.next,
    };
    to_json(&record)
}

/// Returns the verdict: the best lists so far, and the next step (R18.20).
pub fn headline(report: &LearnReport) -> Headline {
    let best = report.axes.iter().filter_map(|axis| {
        let number = axis.best_round?;
        let glitch = axis.rounds.get(number.checked_sub(1)?)?.worst_um;
        Some(format!("{} {glitch:.1} µm with round {number}", axis.axis))
    });
    let best: Vec<String> = best.collect();
    let best = match &*best.join(", ") {
        "" => String::new(),
        best => format!("largest glitch so far: {best}; "),
    };
    match &report.next {
        NextStep::Record { folder, lists } => Headline::new(
            Standing::Open,
            format!(
                "{best}next: load {} for X and {} for Y, record each circle twice in both directions, at least \
                 six feeds, and put the recordings into {folder}",
                lists[0], lists[1]
            ),
        ),
        NextStep::Done if report.axes[0].best_round == report.axes[1].best_round => Headline::new(
            Standing::Good,
            format!("{best}two rounds gained nothing more: hand over the best lists"),
        ),
        NextStep::Done => Headline::new(
            Standing::Good,
            format!(
                "{best}two rounds gained nothing more: hand over the best lists, which are of different rounds, \
                 after recording them together once more"
            ),
        ),
    }
}

/// Returns the rounds, and the best lists.
pub fn document(report: &LearnReport) -> Document<'_> {
    let mut out = Document::new("Learning from recorded circles", headline(report));
    if !report.feeds.is_empty() {
        let feeds: Vec<String> = report.feeds.iter().map(|it| format!("{it:.0}")).collect();
        let _ = writeln!(
            out,
            "\ncircles at {} mm/min, each recorded twice; the plant {} gives the direction\n{}\n",
            feeds.join(", "),
            visible_line(&report.plant.name),
            not_modelled_line(&not_modelled([&report.plant.x, &report.plant.y]))
        );
        out.table(rounds(report));
    }
    push_best(&mut out, report);
    out
}

/// Returns the rounds of all axes.
fn rounds(report: &LearnReport) -> Table {
    let table = Table::of_numbers(["round"]).left("axis").right("glitch µm");
    let mut table = table.right("spread").right("predicted").left("");
    let rounds = report
        .axes
        .iter()
        .flat_map(|axis| axis.rounds.iter().enumerate().map(move |it| (axis, it)));
    for (axis, (at, round)) in rounds {
        let predicted = report.predictions.get(at);
        let predicted = predicted.and_then(|it| it[usize::from(axis.axis != "X")]);
        let number = predicted.map_or("-".to_owned(), |it| format!("{:.2}", it.glitch_um));
        let verdict = match (at, round.is_accepted) {
            (0, _) => "the first",
            (_, true) => "accepted",
            (_, false) => "no gain: the next round tries half the step from the best list",
        };
        let missed = predicted.is_some_and(|it| it.is_missed_by(round.worst_um));
        let missed = if missed {
            "; the prediction missed it"
        } else {
            ""
        };
        table.row(&[
            &(at + 1),
            &axis.axis,
            &format_args!("{:.2}", round.worst_um),
            &format_args!("{:.2}", round.spread_um),
            &number,
            &format_args!("{verdict}{missed}"),
        ]);
    }
    table
}

/// Adds the best list of each axis, and what the simulation expects of the next ones.
fn push_best(out: &mut Document<'_>, report: &LearnReport) {
    for axis in &report.axes {
        if let (Some(number), Some(list)) = (axis.best_round, &axis.list) {
            let _ = writeln!(
                out,
                "{}{}: the best so far is round {number}, {}",
                if axis.axis == "X" { "\n" } else { "" },
                axis.axis,
                visible_line(list)
            );
        }
    }
    let predicted = report.predictions.get(report.axes[0].rounds.len());
    if let Some([Some(x), Some(y)]) = predicted {
        let _ = writeln!(
            out,
            "predicted with the next lists: X {:.1} µm, Y {:.1} µm; the contact is predicted to be {:.2} and {:.2} times \
             as stiff as that of the plant",
            x.glitch_um, y.glitch_um, x.contact, y.contact
        );
    }
}
