//! `frictcomp commission run`: recordings to lists, and what is missing (R16.2, R16.9).

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::channels::words;
use super::plan::plan_name;
use super::plants::Fitting;
use super::run_args::CommissionRunArgs;
use super::sources::{source_of, stage_of, write_list};
use crate::args::{ResultFormat, value_list};
use crate::output::{Console, Failure, Outputs, exit, progress, shown, write_page, write_text};
use frictcomp_host::commission::CommissionReader;
use frictcomp_host::{
    FileRegistry, find_plant, memory_for_simulation, read_text, recordings_in, sha256_of,
};
use frictcomp_recordings::commission::{
    BeforeAfter, CompensationShown, FrictionFound, JudgedRound, MOST_CURRENT, MeasuredAxis,
    MeasuringProgram, PlanFile, RecordingOutcome, RecordingResult, Shows, Stage, StagesOfAxis,
    SwitchedAs, before_after, feeds_against, recorded_otherwise, refuse_strangers,
};
use frictcomp_report::commission::{
    Acceptance, AxisVerdict, Plants, Results, ResultsReport, Round, document, glitch_unit,
    render_results_json,
};
use frictcomp_report::value_lists::{IdentifiedFrom, render_identified, tuned_on};
use frictcomp_report::{TextChange, render_unified};

/// Runs the command.
pub(crate) fn run(args: &CommissionRunArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let plans = plans(&args.folder, &registry)?;
    let paths = recordings_in(&args.folder.join("recordings"))?;
    for path in &paths {
        registry.reads("recording", path);
    }
    args.reading.check_roles(&paths)?;
    let known = known(&args.folder.join(RESULTS));
    let reader = CommissionReader {
        channels: &args.reading.channels(&plans)?,
        words,
    };
    let watch = progress::watch();
    let (mut results, kept) = reader.results((&plans, &paths), &known.recordings, &watch)?;
    drop(watch);
    reader.take_shares(&args.folder, &plans, (&mut results, &registry))?;
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    // What one recording shows about another is determined anew each time.
    let read = results.clone();
    refuse_strangers(&mut results);
    let axes = lists(args, &plans, &results, &mut outputs)?;
    let fitted_drives = match &args.plant {
        Some(name) => {
            memory_for_simulation()?;
            let fitting = Fitting {
                args,
                reader,
                base: &find_plant(name, &registry)?,
                plans: &plans,
                results: &results,
                known: &known.plants,
                registry: &registry,
            };
            fitting.plants(&mut outputs)?
        }
        None => Plants::not_wanted(),
    };
    let rounds = rounds(&plans, &results, (&fitted_drives, &registry))?;
    let report = ResultsReport {
        inputs: args.inputs(&plans)?,
        said: args.said(),
        plans,
        results,
        kept,
        axes,
        fitted: fitted_drives,
        rounds,
    };
    let given = acceptance(args, &report, &registry)?;
    let document = document(&report, &given);
    write_page(args.html.page(&mut outputs)?, &document)?;
    let mut file = outputs.file("results.json", &args.folder.join(RESULTS))?;
    let content = Results {
        schema: Results::SCHEMA,
        recordings: read,
        plants: report.fitted.found().cloned().collect(),
    };
    let text =
        serde_json::to_string_pretty(&content).map_err(|error| Failure::new(error.to_string()))?;
    write_text(&mut file, &text)?;
    outputs.check()?;
    target.text(&match args.result.format {
        ResultFormat::Text => document.text(console.detail, target.look.width),
        ResultFormat::Json => render_results_json(&report),
    })?;
    outputs.finish()?;
    Ok(if report.is_complete() {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

/// Returns the contents of the report beyond the results.
fn acceptance(
    args: &CommissionRunArgs,
    report: &ResultsReport,
    registry: &FileRegistry,
) -> Result<Acceptance, Failure> {
    let mut changes = Vec::new();
    let rounds = report.rounds.last().into_iter();
    let used: Vec<_> = rounds.flat_map(|it| &it.lists).collect();
    for (axis, before) in args.lists_before(&report.plans)? {
        let Some(used) = used.iter().find(|it| it.axis == axis) else {
            continue;
        };
        registry.reads("value list", &before);
        let (old, new) = (read_text(&before)?, read_text(Path::new(&used.file))?);
        let change = TextChange {
            before: (&shown(&before), &old),
            after: (&used.file, &new),
        };
        let patch = render_unified(change);
        let same = "no line differs".to_owned();
        changes.push((axis, if patch.is_empty() { same } else { patch }));
    }
    Ok(Acceptance {
        machine: args.machine.clone(),
        date: args.date.clone(),
        changes,
    })
}

/// The file of the results.
const RESULTS: &str = "results.json";

/// Returns the plans of stage 1, if it exists, and of each round of stage 2.
fn plans(folder: &Path, registry: &FileRegistry) -> Result<Vec<PlanFile>, Failure> {
    let mut plans = Vec::new();
    for round in 1.. {
        let path = folder.join(plan_name(round));
        if !path.exists() && round > 1 {
            break;
        }
        if !path.exists() {
            continue;
        }
        registry.reads("plan", &path);
        let plan: PlanFile = serde_json::from_str(&read_text(&path)?).map_err(|error| {
            let message = format!("`{}` is not a plan: {error}", shown(&path));
            Failure::new(message).with_help("`frictcomp commission plan` writes it")
        })?;
        if plan.schema != PlanFile::SCHEMA {
            let message = format!(
                "`{}` has the form {}, and {} is read",
                shown(&path),
                plan.schema,
                PlanFile::SCHEMA
            );
            return Err(Failure::new(message).with_help("plan again with this version"));
        }
        plans.push(plan);
    }
    if plans.is_empty() {
        let message = format!("the folder `{}` has no `plan-1.json`", shown(folder));
        return Err(Failure::new(message)
            .with_help("`frictcomp commission plan --into FOLDER` writes it with the programs"));
    }
    Ok(plans)
}

/// Returns the results of an earlier run; none if they do not exist or this version does not understand them.
fn known(path: &Path) -> Results {
    let text = read_text(path).ok();
    let read = text.and_then(|text| serde_json::from_str::<Results>(&text).ok());
    read.filter(|it| it.schema == Results::SCHEMA)
        .unwrap_or_default()
}

/// Writes a provisional list for each axis of stage 1 whose friction was recorded and that has no reason against it.
fn lists(
    args: &CommissionRunArgs,
    plans: &[PlanFile],
    results: &[RecordingResult],
    outputs: &mut Outputs,
) -> Result<Vec<AxisVerdict>, Failure> {
    let first = plans.iter().filter(|it| it.plan.stage == Stage::Off);
    let mut verdicts = Vec::new();
    for axis in first.flat_map(|it| &it.plan.axes) {
        let (source, notes) = source_of(axis, plans, results);
        let mut verdict = AxisVerdict {
            axis: axis.name.clone(),
            list: None,
            from: None,
            notes,
        };
        if let Some((result, found)) = source {
            let text = list_text(args, axis, result, found);
            let name = format!("{}-provisional", axis.name);
            let path = write_list(&args.folder.join("lists"), &name, &text, outputs)?;
            verdict.list = Some(shown(&path));
            verdict.from = Some(result.file.clone());
        }
        verdicts.push(verdict);
    }
    Ok(verdicts)
}

/// Returns the text of the list of an axis.
fn list_text(
    args: &CommissionRunArgs,
    axis: &MeasuredAxis,
    result: &RecordingResult,
    found: &FrictionFound,
) -> String {
    let remarks = [
        "Provisional: for stage 2 of the commissioning, until recorded circles confirm it"
            .to_owned(),
        format!("SHA-256 of the recording: {}", result.sha256),
    ];
    let made = IdentifiedFrom {
        axis: Some(&axis.name),
        from: &result.file,
        unit: "drive units",
        faults: &remarks,
    };
    render_identified(&found.list(), made, args.build.cnc_build)
}

/// Returns the rounds of stage 2, each judged by its own recordings and by the lists accepted before it.
fn rounds(
    plans: &[PlanFile],
    results: &[RecordingResult],
    (fitted, registry): (&Plants, &FileRegistry),
) -> Result<Vec<Round>, Failure> {
    let mut rounds: Vec<Round> = Vec::new();
    let second = plans.iter().filter(|it| it.plan.stage == Stage::On);
    for (number, plan) in (2..).zip(second) {
        let is_off = |number: u16| stage_of(plans, number) == Some(Stage::Off);
        let is_on = |number: u16| plan.has(number);
        let recorded = before_after(results, &plan.plan.axes, (is_off, is_on));
        let (mut against, mut not_shown) = (None, Vec::new());
        if !recorded.is_empty() {
            let mut reasons = against_feeds(plan, &recorded, &rounds);
            reasons.extend(lists_against(plan, plans, results, registry)?);
            reasons.extend(otherwise(plan, plans, results));
            let [otherwise, lacking] = switched(plan, number, (plans, results, fitted));
            reasons.extend(otherwise);
            not_shown = lacking;
            reasons.extend(plants_against(plan, fitted)?);
            against = Some(reasons);
        }
        rounds.push(Round {
            number,
            lists: plan.lists.clone(),
            shows: Shows::of(&plan.plan),
            unit: glitch_unit(&plan.plan),
            recorded,
            against,
            not_shown,
        });
    }
    Ok(rounds)
}

/// Returns what the recorded feeds say against the lists of a round.
fn against_feeds(plan: &PlanFile, recorded: &[BeforeAfter], earlier: &[Round]) -> Vec<String> {
    let programs = plan.plan.programs.iter();
    let feeds: Vec<f64> = programs
        .flat_map(MeasuringProgram::reversal_feeds)
        .copied()
        .collect();
    let accepted = earlier.iter().rev().find(|it| it.is_accepted());
    feeds_against(&JudgedRound {
        feeds: &feeds,
        recorded,
        accepted: accepted.map(|it| (it.number, &it.recorded[..])),
        unit: glitch_unit(&plan.plan),
    })
}

/// Returns the lists of a round that differ from the recorded ones, or add too much.
fn lists_against(
    plan: &PlanFile,
    plans: &[PlanFile],
    results: &[RecordingResult],
    registry: &FileRegistry,
) -> Result<Vec<String>, Failure> {
    let mut against = Vec::new();
    for used in &plan.lists {
        let path = PathBuf::from(&used.file);
        if !path.exists() || sha256_of(&path)? != used.sha256 {
            against.push(format!(
                "the list of {} that was recorded is no longer `{}`",
                used.axis, used.file
            ));
            continue;
        }
        let list = value_list(&path, registry)?;
        let (source, _) = plan
            .plan
            .axes
            .iter()
            .find(|it| it.name == used.axis)
            .map_or((None, Vec::new()), |axis| source_of(axis, plans, results));
        let Some((_, friction)) = source else {
            against.push(format!(
                "the friction of {} is not known, so its current cannot be compared",
                used.axis
            ));
            continue;
        };
        let strongest = friction.strongest(&list);
        if let Some((speed, part)) = strongest.filter(|it| it.1 > MOST_CURRENT) {
            against.push(format!(
                "at {speed:.3} mm/s the list of {} adds {part:.2} times the measured friction; the limit is {MOST_CURRENT}",
                used.axis
            ));
        }
    }
    Ok(against)
}

/// Returns how the recordings of a round were made otherwise than those of stage 1.
fn otherwise(plan: &PlanFile, plans: &[PlanFile], results: &[RecordingResult]) -> Vec<String> {
    let first = plans.iter().filter(|it| it.plan.stage == Stage::Off);
    let off: Vec<&RecordingOutcome> = first.flat_map(|it| used_in(it, results)).collect();
    let on: Vec<&RecordingOutcome> = used_in(plan, results).collect();
    let axes = plan.plan.axes.iter().map(|it| it.name.as_str());
    recorded_otherwise(&axes.collect::<Vec<_>>(), &off, &on)
}

/// Returns what the usable recordings of a plan show.
fn used_in<'a>(
    plan: &'a PlanFile,
    results: &'a [RecordingResult],
) -> impl Iterator<Item = &'a RecordingOutcome> {
    let is_own = |number: u16| plan.has(number);
    let own = results
        .iter()
        .filter(move |it| it.found.is_used() && it.program.is_some_and(is_own));
    own.map(|it| &it.found)
}

/// Returns what recordings of each axis say about its compensation, that the list was on in the round and none in
/// stage 1: what speaks against it, and what nothing shows (R16.13).
fn switched(
    plan: &PlanFile,
    number: usize,
    (plans, results, fitted): (&[PlanFile], &[RecordingResult], &Plants),
) -> [Vec<String>; 2] {
    let first = plans.iter().filter(|it| it.plan.stage == Stage::Off);
    let off = first.flat_map(|it| used_in(it, results));
    let off: Vec<&CompensationShown> = off.filter_map(RecordingOutcome::compensation).collect();
    let on = used_in(plan, results).filter_map(RecordingOutcome::compensation);
    let on: Vec<&CompensationShown> = on.collect();
    let found = fitted.verdicts.iter().find(|it| it.found.round == number);
    let [mut against, mut not_shown] = [Vec::new(), Vec::new()];
    for used in &plan.lists {
        let stages = StagesOfAxis {
            axis: &used.axis,
            list: &used.sha256,
            off: &off,
            on: &on,
            shows: Shows::of(&plan.plan),
            plant: found.and_then(|it| it.found.axes.iter().find(|it| it.axis == used.axis)),
        };
        for state in [stages.was_on(), stages.was_off()] {
            match state {
                SwitchedAs::Shown => {}
                SwitchedAs::Otherwise(words) => against.push(words),
                SwitchedAs::NotShown(words) => not_shown.push(words),
            }
        }
    }
    [against, not_shown]
}

/// Returns what the recordings show about the plants on which the lists of a round were tuned.
fn plants_against(plan: &PlanFile, fitted: &Plants) -> Result<Vec<String>, Failure> {
    let mut keys = BTreeSet::new();
    for used in &plan.lists {
        let path = PathBuf::from(&used.file);
        if path.exists() {
            keys.extend(tuned_on(&read_text(&path)?).map(str::to_owned));
        }
    }
    Ok(keys.iter().flat_map(|key| fitted.against(key)).collect())
}
