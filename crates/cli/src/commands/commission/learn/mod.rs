//! `frictcomp commission learn`: from recorded circles with a list to the next list (R16.4).

mod args;
mod folder;
mod recorded;
mod start;

use std::path::Path;

use crate::args::{ByAxis, ResultFormat};
use crate::output::{Console, Failure, Outputs, exit, progress, shown, write_page, write_text};
use folder::LearningFolder;
use frictcomp_host::{FileRegistry, find_plant, learn, memory_for_simulation, read_text};
use frictcomp_physics::circle::{LearningProgress, PlaneAxis};
use frictcomp_physics::simulation::Plant;
use frictcomp_report::assumptions::not_modelled;
use frictcomp_report::learn::{
    LearnReport, LearnedAxis, NextStep, Prediction, document, render_file, render_json,
};
use frictcomp_report::tune::round;
use frictcomp_report::value_lists::{LearnedFrom, render_learned};
use recorded::Learned;

pub(super) use args::LearnArgs;

/// Runs the command.
pub(super) fn run(args: &LearnArgs, console: Console) -> Result<u8, Failure> {
    memory_for_simulation()?;
    let registry = FileRegistry::default();
    let plant = find_plant(&args.plant, &registry)?;
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    let html = args.html.page(&mut outputs)?;
    let opened = LearningFolder::open(&args.folder, &registry)?;
    let is_new = opened.is_none();
    let mut folder = match opened {
        Some(folder) if args.friction.is_empty() => folder,
        Some(_) => return Err(start::already(&args.folder)),
        None => start::begin(args, &registry, &mut outputs)?,
    };
    let learned = recorded::learned(args, &folder, &registry)?;
    let is_recorded = learned.rounds[0].len() == folder.file.rounds.len();
    let is_over = is_recorded && learned.progress.iter().all(LearningProgress::is_over);
    if is_recorded {
        folder.keep_recordings();
    }
    if is_recorded && !is_over {
        next_round(args, &plant, &mut folder, (&learned, &mut outputs))?;
    }
    if is_recorded || is_new {
        let mut file = outputs.file("learning.json", &folder.json())?;
        write_text(&mut file, &render_file(&folder.file))?;
    }
    write_best(args, &folder, (&learned, &mut outputs))?;
    outputs.check()?;
    let report = report(&plant, &folder, &learned, is_over);
    let document = document(&report);
    write_page(html, &document)?;
    target.text(&match args.result.format {
        ResultFormat::Text => document.text(console.detail, target.look.width),
        ResultFormat::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(if is_over { exit::CLEAN } else { exit::FOUND })
}

/// Writes the lists of the next round: a step from the best one, or the best one itself for an axis that is done.
fn next_round(
    args: &LearnArgs,
    plant: &Plant,
    folder: &mut LearningFolder,
    (learned, outputs): (&Learned, &mut Outputs),
) -> Result<(), Failure> {
    let mut texts = [String::new(), String::new()];
    let mut predictions = [None; 2];
    for (at, axis) in PlaneAxis::ALL.into_iter().enumerate() {
        let (rounds, progress) = (&learned.rounds[at], &learned.progress[at]);
        let of_axis = args.learner(axis, plant, &folder.file);
        let proposal = if progress.is_over() {
            None
        } else {
            learn(&of_axis, rounds, &progress::watch())?
        };
        let Some(proposal) = proposal else {
            texts[at] = read_text(&folder.list(progress.best, at))?;
            continue;
        };
        let from = LearnedFrom {
            axis: axis.as_str(),
            round: rounds.len() + 1,
            plant: &plant.name,
            predicted_um: proposal.predicted_um,
        };
        texts[at] = render_learned(&proposal.list, from, args.build.cnc_build);
        predictions[at] = Some(Prediction {
            glitch_um: round(proposal.predicted_um),
            contact: round(proposal.contact),
        });
    }
    folder.add_round(&texts, predictions, outputs)
}

/// Writes the best list of each axis for which a file is given.
fn write_best(
    args: &LearnArgs,
    folder: &LearningFolder,
    (learned, outputs): (&Learned, &mut Outputs),
) -> Result<(), Failure> {
    let files = ByAxis {
        option: "--write-list",
        given: &args.write_list,
        axes: &["X", "Y"],
    };
    for (at, progress) in learned.progress.iter().enumerate() {
        let Some(file) = files.of(files.axes[at])? else {
            continue;
        };
        if progress.verdicts.is_empty() {
            return Err(
                Failure::new("no round is recorded yet, so there is no best list").with_help(
                    "leave `--write-list` out until the circles of a round are recorded",
                ),
            );
        }
        let text = read_text(&folder.list(progress.best, at))?;
        write_text(&mut outputs.list("--write-list", Path::new(file))?, &text)?;
    }
    Ok(())
}

/// Returns the result of a call.
fn report(plant: &Plant, folder: &LearningFolder, learned: &Learned, is_over: bool) -> LearnReport {
    let circles = learned.rounds[0].first().map(|it| it.circles.iter());
    let feeds = circles.into_iter().flatten();
    let axes = [0, 1].map(|at: usize| {
        let progress = &learned.progress[at];
        let best = (!progress.verdicts.is_empty()).then_some(progress.best);
        LearnedAxis {
            axis: PlaneAxis::ALL[at].as_str(),
            rounds: progress.verdicts.clone(),
            best_round: best.map(|it| it + 1),
            list: best.map(|it| shown(&folder.list(it, at))),
            is_over: progress.is_over(),
        }
    });
    let last = folder.file.rounds.len() - 1;
    LearnReport {
        schema: 1,
        plant: plant.name.clone(),
        not_modelled: not_modelled([&plant.x, &plant.y]),
        feeds: feeds.map(|it| round(it.circle.feed_mm_per_min)).collect(),
        axes,
        predictions: folder.file.rounds.iter().map(|it| it.predictions).collect(),
        next: if is_over {
            NextStep::Done
        } else {
            NextStep::Record {
                folder: shown(&folder.round(last)),
                lists: [0, 1].map(|at| shown(&folder.list(last, at))),
            }
        },
    }
}
