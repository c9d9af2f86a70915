//! Running a case on this engine.

use std::ops::ControlFlow;

use super::case::{Case, Expectation, Moment, is_between};
use super::cycles::is_near;
use super::outcome::{CaseOutcome, Mismatch};
use frictcomp::comp::{Kind, State};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::lists::FrictionList;
use frictcomp::machine::{Configuration, ListFiles, Machine, NoList, Parameterisation};
use frictcomp::readings::Alternative;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, StateView};
use frictcomp_physics::current::{AdditiveCurrent, Reading};

/// The lists of a case.
struct Lists<'a>(&'a Case);

impl ListFiles for Lists<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        source(self.0, path).ok_or(NoList::Missing)
    }
}

fn source(case: &Case, name: &str) -> Option<SourceFile> {
    let file = case.files.iter().find(|file| file.name == name)?;
    Some(SourceFile::new(name, file.text.clone()))
}

/// A state that was seen.
struct Seen {
    program: String,
    after: Moment,
    states: Vec<(String, Kind, State)>,
}

/// Result of the run of a case.
#[derive(Default)]
struct CaseRun {
    seen: Vec<Seen>,
    refusals: Vec<Diagnostic>,
}

/// Runs a case; an undecided one runs under both readings.
pub fn run_case(case: &Case) -> CaseOutcome {
    let mut outcome = CaseOutcome {
        is_undecided: !case.readings.is_empty(),
        failed: Vec::new(),
    };
    if case.readings.is_empty() || !case.expected.is_empty() {
        let missed = judge(case, None, &case.expected);
        outcome.failed.extend(missed);
    }
    for (reading, expected) in &case.readings {
        outcome.failed.extend(judge(case, Some(*reading), expected));
    }
    outcome
}

fn judge(case: &Case, reading: Option<Alternative>, expected: &[Expectation]) -> Vec<Mismatch> {
    let name = case.question().zip(reading);
    let under = name.map(|(question, reading)| format!("{}: ", question.name_of(reading)));
    let under = under.unwrap_or_default();
    let mismatch = |expected: String, found: String| Mismatch {
        file: case.file.clone(),
        expected: format!("{under}{expected}"),
        found,
    };
    let configuration = match configuration(case) {
        Ok(configuration) => configuration,
        Err(error) => return vec![mismatch("a machine".to_owned(), error)],
    };
    let mut machine = configuration.machine.clone();
    if let Some((question, reading)) = name {
        machine.readings.select(question, reading);
    }
    let run = play(case, &configuration, machine.clone());
    let mut missed: Vec<Mismatch> = expected
        .iter()
        .filter_map(|it| {
            let found = found(it, &run, &machine)?;
            Some(mismatch(it.to_string(), found))
        })
        .collect();
    let wanted = |it: &Expectation| matches!(it, Expectation::Refusal { .. });
    if let Some(refused) = run
        .refusals
        .first()
        .filter(|_| !expected.iter().any(wanted))
    {
        missed.push(mismatch("no refusal".to_owned(), said(refused)));
    }
    missed
}

/// Returns the machine of a case.
pub(super) fn configuration(case: &Case) -> Result<Configuration, String> {
    let file = SourceFile::new(case.name.as_str(), case.machine.clone());
    Configuration::from_toml(file, &mut Lists(case)).map_err(|error| error.to_string())
}

/// Runs the programs of a case.
fn play(case: &Case, configuration: &Configuration, machine: Machine) -> CaseRun {
    let mut run = CaseRun::default();
    let of_lists = configuration.diagnostics.iter();
    let is_error = |said: &&Diagnostic| said.severity == Severity::Error;
    run.refusals.extend(of_lists.filter(is_error).cloned());
    let options = SessionOptions::default().with_settings(configuration.settings.clone());
    let mut session = Session::new(machine, options);
    for step in &case.run {
        match step.as_str() {
            "reset" => session.reset(),
            "restart" => session.restart(),
            _ if session.is_stopped() => {}
            name => play_program(case, name, &mut session, &mut run),
        }
    }
    run
}

fn play_program(case: &Case, name: &str, session: &mut Session, run: &mut CaseRun) {
    debug_assert!(!is_between(name));
    let Some(text) = source(case, name) else {
        return;
    };
    let mut finder = |called: &str, _: &str| source(case, called);
    let mut sink = |record: &Record<'_>| {
        match record {
            Record::Block(row) => run.seen.push(Seen {
                program: row.file.to_owned(),
                after: Moment::Line(row.line),
                states: states(row.state),
            }),
            Record::End(end) => run.seen.push(Seen {
                program: name.to_owned(),
                after: Moment::End,
                states: states(end.state),
            }),
            _ => {}
        }
        let errors = record.diagnostics().map(|it| it.diagnostic());
        let errors = errors.filter(|said| said.severity == Severity::Error);
        run.refusals.extend(errors.cloned());
        ControlFlow::Continue(())
    };
    let _ = session.program(name, Program::Whole(text), &mut finder, &mut sink);
}

fn states(view: StateView<'_>) -> Vec<(String, Kind, State)> {
    let of_axis = |(axis, name): (_, &str)| {
        let name = name.to_owned();
        Kind::ALL.map(|kind| (name.clone(), kind, view.state(axis, kind)))
    };
    view.axes().flat_map(of_axis).collect()
}

/// Returns the state that was found where an expectation is not met.
fn found(expected: &Expectation, run: &CaseRun, machine: &Machine) -> Option<String> {
    match expected {
        Expectation::State {
            program,
            after,
            axis,
            kind,
            state,
        } => {
            let mut seen = run.seen.iter().rev();
            let Some(seen) = seen.find(|it| it.program == *program && it.after == *after) else {
                let refused = run.refusals.first().map(said);
                return Some(refused.unwrap_or_else(|| "the block is not executed".to_owned()));
            };
            let mut states = seen.states.iter();
            match states.find(|(name, of, _)| name == axis && of == kind) {
                Some((.., found)) if found == state => None,
                Some((.., found)) => Some(found.as_str().to_owned()),
                None => Some("no such axis".to_owned()),
            }
        }
        Expectation::Refusal { code, at } => {
            let is_it = |refused: &&Diagnostic| {
                let number = code == "error" || refused.code.as_str() == code;
                number
                    && at.as_ref().is_none_or(|(program, line)| {
                        *refused.place.file == **program && refused.place.start().line == *line
                    })
            };
            if run.refusals.iter().any(|it| is_it(&it)) {
                return None;
            }
            let others: Vec<String> = run.refusals.iter().map(said).collect();
            Some(if others.is_empty() {
                "no refusal".to_owned()
            } else {
                others.join(", ")
            })
        }
        Expectation::Current {
            axis,
            velocity,
            current,
        } => {
            let found = current_at(machine, axis, *velocity).unwrap_or(f64::NAN);
            (!is_near(found, *current, 1e-9)).then(|| format!("{found} drive units"))
        }
        Expectation::Currents(cycles) => match current_of(machine, &cycles.axis) {
            Some((mut current, _)) => cycles.differs(&cycles.run(&mut current)),
            None => Some("no accepted value list".to_owned()),
        },
    }
}

/// Returns the current of an axis with its value list; `None` without an accepted one.
pub(super) fn current_of<'a>(
    machine: &'a Machine,
    axis: &str,
) -> Option<(AdditiveCurrent, &'a FrictionList)> {
    let axis = machine.axis(machine.find(axis)?);
    let Parameterisation::Accepted(list) = &axis.friction else {
        return None;
    };
    let current = AdditiveCurrent::new(list, Reading::from(&machine.readings));
    Some((current.scaled(axis.torque_scale.factor()), list))
}

/// Returns the current of an axis at a constant velocity, long after the last reversal.
fn current_at(machine: &Machine, axis: &str, velocity: f64) -> Option<f64> {
    let (mut current, list) = current_of(machine, axis)?;
    let far = f64::from(list.position_delay.max(0)) + 1.0;
    let cycles = usize::try_from(list.delay_cycles).unwrap_or_default() + 2;
    let steps = (0..cycles).map(|cycle| if cycle == 0 { 0.0 } else { far });
    let added = steps.map(|position| current.step(position, velocity, &[]).current_units);
    added.last()
}

fn said(diagnostic: &Diagnostic) -> String {
    let place = &diagnostic.place;
    format!(
        "{} at {}:{}",
        diagnostic.code,
        place.file,
        place.start().line
    )
}
