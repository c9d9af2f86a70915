//! Checks of programs, each from the start of the control (R17.2).

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::main_programs::{ExecutedProgram, main_programs};
use crate::disk::{Disk, Input, Naming};
use crate::error::HostError;
use crate::machines::{LoadedMachine, Machines};
use crate::outputs::{MendedFile, mend};
use crate::run::{Axes, SingleRun, run_alone};
use crate::workers::in_order;
use frictcomp::comp::{Kind, State};
use frictcomp::diagnostic::{Severity, Wording};
use frictcomp::interpreter::Options;
use frictcomp::lists::AxisType;
use frictcomp::session::{Causes, Findings, ProposedFixes, SafeFixes, Session};
use frictcomp::timeline::{FeedMoves, ReadingsInForce, Record, SilencedMessage, Sink};

/// Programs, each with the machine of its folder.
pub struct ProgramsOnMachines<'a> {
    programs: Vec<(&'a Input, Result<Arc<LoadedMachine>, HostError>)>,
}

/// Options of checks.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CheckOptions {
    /// Options of the runs.
    pub run: Options,
    /// The words of a front end for advice.
    pub wording: Option<Wording>,
    /// Treatment of programs that others call.
    pub called: CalledPrograms,
    /// Number of parallel runs.
    pub workers: NonZeroUsize,
    /// The disk by which calls are compared with programs.
    pub disk: Disk,
}

/// Treatment of programs that others call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CalledPrograms {
    /// Programs are checked in their callers, if they hold no program end and a caller executes them to their end.
    InCallers,
    /// Programs are checked by themselves, too.
    Alone,
}

/// The result of checks.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct CheckedPrograms {
    /// The programs that count on their own.
    pub programs: Vec<CheckedProgram>,
    /// Messages of the programs, and those on the lists of their machines, each cause once.
    pub causes: Causes,
    /// Number of programs that were checked only in their callers.
    pub in_callers: usize,
}

/// The result of a check.
#[derive(Debug)]
#[non_exhaustive]
pub struct CheckedProgram {
    /// Name.
    pub name: String,
    /// The places of its messages among the causes.
    pub said: Vec<usize>,
    /// Number of further messages, by severity (R2.85).
    pub unsaid: BTreeMap<Severity, u64>,
    /// The axes with their feed moves without compensation.
    pub uncompensated: Vec<(String, AxisType, FeedMoves)>,
    /// The axes that it certainly leaves away from their start-up states, each with its friction compensation.
    pub left: BTreeMap<String, State>,
    /// The messages that its comments silence.
    pub silenced: BTreeSet<SilencedMessage>,
    /// The states that are unknown at its end or where their axis moves.
    pub unknown: BTreeSet<(String, Kind)>,
    /// The readings on which its results depend.
    pub rests_on: ReadingsInForce,
}

/// A program that ran.
struct CheckedRun<'a> {
    executed: ExecutedProgram<'a>,
    loaded: Arc<LoadedMachine>,
    findings: Findings,
    checked: CheckedProgram,
}

impl<'a> ProgramsOnMachines<'a> {
    /// Finds the machine of each program, so that every list is known before anything runs.
    pub fn new(inputs: &'a [Input], machines: &mut Machines) -> Self {
        let programs = inputs.iter();
        Self {
            programs: programs
                .map(|input| (input, machines.for_folder(input.folder())))
                .collect(),
        }
    }

    /// Returns the programs whose machine is not described.
    pub fn undescribed(&self) -> impl Iterator<Item = &'a Input> {
        let undescribed = self.programs.iter().filter_map(|(input, loaded)| {
            let is_described = loaded.as_ref().map_or(true, |it| it.machine.is_described());
            (!is_described).then_some(*input)
        });
        undescribed.collect::<Vec<_>>().into_iter()
    }

    /// Runs each program from the start of the control; also returns why one cannot be checked.
    pub fn check(self, options: &CheckOptions) -> (CheckedPrograms, Vec<HostError>) {
        let (all, errors) = self.each(options.workers, |input, loaded| options.run(input, loaded));
        (options.gathered(all), errors)
    }

    /// Returns the files of the programs with the changes that do not affect what the machine does; also returns why
    /// one cannot be changed. Called programs stay as they are, unless they are among the programs themselves.
    pub fn mended(self, options: &CheckOptions) -> (Vec<MendedFile>, Vec<HostError>) {
        let files = self.programs.iter().filter_map(|(input, _)| match input {
            Input::File(path) => Some((input.name(Naming::AsGiven), path.as_path())),
            _ => None,
        });
        let files: BTreeMap<String, &Path> = files.collect();
        let (all, mut errors) = self.each(options.workers, |input, loaded| {
            let mut proposed = ProposedFixes::default();
            options.alone(input, &loaded, &mut proposed)?;
            Ok(proposed)
        });
        let mut safe = SafeFixes::default();
        for proposed in all {
            safe.add(proposed);
        }
        let mut mended = Vec::new();
        for (name, fixes) in safe.of_files() {
            match files.get(&*name).map(|path| mend(path, &fixes)) {
                Some(Ok(file)) => mended.extend(file),
                Some(Err(error)) => errors.push(error),
                None => {}
            }
        }
        (mended, errors)
    }

    /// Executes work on each program, and returns the results in the order of the programs.
    fn each<T: Send>(
        self,
        workers: NonZeroUsize,
        work: impl Fn(&'a Input, Arc<LoadedMachine>) -> Result<T, HostError> + Sync,
    ) -> (Vec<T>, Vec<HostError>) {
        let most = NonZeroUsize::new(self.programs.len()).unwrap_or(NonZeroUsize::MIN);
        let work = |(input, loaded): (&'a Input, Result<Arc<LoadedMachine>, _>)| {
            let loaded = loaded?;
            let watch = Arc::clone(&loaded.watch);
            Ok((work(input, loaded)?, watch))
        };
        let (mut all, mut errors) = (Vec::with_capacity(self.programs.len()), Vec::new());
        let programs = self.programs.into_iter();
        in_order(programs, workers.min(most), work, |done| {
            match done {
                Ok((done, watch)) => {
                    all.push(done);
                    if watch.is_stopped() {
                        return ControlFlow::Break(());
                    }
                }
                Err(error) => errors.push(error),
            }
            ControlFlow::Continue(())
        });
        (all, errors)
    }
}

/// Collector of the records of a program that a check needs.
#[derive(Default)]
struct CheckSink {
    findings: Findings,
    uncompensated: Vec<(String, AxisType, FeedMoves)>,
    left: BTreeMap<String, State>,
    silenced: BTreeSet<SilencedMessage>,
    rests_on: ReadingsInForce,
}

impl Sink for CheckSink {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Summary(summary) = record {
            let machine = summary.state.machine;
            self.rests_on = ReadingsInForce::of(summary.rests_on, machine);
            let axes = summary.uncompensated();
            let left = summary.axes.iter().filter(|axis| axis.is_left_away());
            let left = left.map(|axis| (machine.axis(axis.axis).name.clone(), axis.end));
            self.left.extend(left);
            self.silenced.extend(summary.silenced.iter().cloned());
            self.uncompensated.extend(axes.map(|axis| {
                let of = machine.axis(axis.axis);
                (of.name.clone(), of.axis_type, axis.feed_moves)
            }));
        }
        self.findings.record(record)
    }

    fn takes_quiet(&mut self) -> bool {
        self.findings.takes_quiet()
    }
}

impl CheckOptions {
    /// Runs one program from the start of the control.
    fn run<'a>(
        &self,
        input: &'a Input,
        loaded: Arc<LoadedMachine>,
    ) -> Result<CheckedRun<'a>, HostError> {
        let mut sink = CheckSink::default();
        let session = self.alone(input, &loaded, &mut sink)?;
        let unknown = session.unknown();
        let unknown = unknown.map(|(axis, kind)| (axis.to_owned(), kind));
        let returned = session.interpreter().returned_files();
        Ok(CheckedRun {
            checked: CheckedProgram {
                name: input.name(Naming::AsGiven),
                said: Vec::new(),
                unsaid: sink.findings.unsaid(session.counts()),
                uncompensated: sink.uncompensated,
                left: sink.left,
                silenced: sink.silenced,
                unknown: unknown.collect(),
                rests_on: sink.rests_on,
            },
            executed: ExecutedProgram {
                input,
                executed_to_end: returned.map(ToString::to_string).collect(),
            },
            loaded,
            findings: sink.findings,
        })
    }

    fn alone(
        &self,
        input: &Input,
        loaded: &LoadedMachine,
        sink: &mut dyn Sink,
    ) -> Result<Session, HostError> {
        let alone = SingleRun {
            options: loaded.session(self.run).with_wording(self.wording),
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        };
        run_alone(input, loaded, alone, sink)
    }

    /// Returns the programs that count on their own, with their messages.
    fn gathered(&self, all: Vec<CheckedRun<'_>>) -> CheckedPrograms {
        let mains = match self.called {
            CalledPrograms::Alone => vec![true; all.len()],
            CalledPrograms::InCallers => {
                let executed: Vec<_> = all.iter().map(|it| it.executed.clone()).collect();
                main_programs(&executed, &self.disk)
            }
        };
        let mut listed: Vec<Option<PathBuf>> = Vec::new();
        let mut gathered = CheckedPrograms {
            in_callers: mains.iter().filter(|is_main| !**is_main).count(),
            ..CheckedPrograms::default()
        };
        for (run, is_main) in all.into_iter().zip(mains) {
            if !listed.contains(&run.loaded.origin) {
                listed.push(run.loaded.origin.clone());
                for mut said in run.loaded.errors().cloned() {
                    if self.wording.is_some() {
                        said.reword(self.wording);
                    }
                    gathered.causes.say(said);
                }
            }
            if is_main {
                let said = gathered.causes.add(run.findings);
                gathered.programs.push(CheckedProgram {
                    said,
                    ..run.checked
                });
            }
        }
        gathered
    }
}
