//! `frictcomp.check`: the messages of programs and folders of programs.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::diagnostic::Severity;
use frictcomp::interpreter::{Options, StopPolicy};
use frictcomp::session::{Causes, Findings, SessionOptions};
use frictcomp::timeline::{Record, Sink};
use frictcomp_host::{
    Axes, Disk, ExecutedProgram, FileRegistry, FolderOptions, FoundPrograms, HostError,
    IgnoreFiles, Input, LoadedMachine, MachineOptions, Machines, Naming, SingleRun, in_order,
    main_programs, processors, run_alone,
};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_options, remark_without_machine};
use crate::messages::{GivenMessages, PyMessage, PyMessages};
use crate::program::GivenPrograms;
use crate::several::Several;
use crate::work::{Stop, interruptible};

/// All messages of programs and of the programs below folders.
///
/// Each program runs from the start of the control. Below folders, what the patterns of ``exclude`` name is not
/// taken, and what ignore files name only with ``no_ignore``. ``Error`` if one of the programs cannot be read.
#[pyfunction]
#[pyo3(signature = (programs, *, machine=None, limits=None, exclude=None, no_ignore=false))]
pub(crate) fn check(
    programs: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    limits: Option<&Bound<'_, PyLimits>>,
    exclude: Option<Several<String>>,
    no_ignore: bool,
) -> PyResult<PyMessages> {
    let ignore_files = if no_ignore {
        IgnoreFiles::PassedOver
    } else {
        IgnoreFiles::Obeyed
    };
    let folders = FolderOptions {
        exclude: exclude.map_or_else(Vec::new, |it| it.0),
        ignore_files,
    };
    let mut machine = machine_options(machine)?;
    machine.folders = folders;
    let job = CheckJob {
        programs: GivenPrograms::of(programs)?,
        machine,
        run: limits::brief(limits).with_stop(StopPolicy::CheckAll),
    };
    let said = interruptible(programs.py(), move |stop| job.done(stop))?;
    Ok(PyMessages::new(said))
}

/// Everything that a check needs, independent of Python.
struct CheckJob {
    programs: GivenPrograms,
    machine: MachineOptions,
    run: Options,
}

/// A program with its machine.
type ProgramOnMachine<'a> = (&'a Input, Result<Arc<LoadedMachine>, HostError>);

/// The messages of one program.
struct ProgramFindings<'a> {
    executed: ExecutedProgram<'a>,
    loaded: Arc<LoadedMachine>,
    findings: Findings,
    /// How many more messages there are, by severity (R2.85).
    unsaid: BTreeMap<Severity, u64>,
}

impl CheckJob {
    fn done(self, stop: &Stop) -> Result<GivenMessages, Failure> {
        let registry = FileRegistry::default();
        let mut machines = Machines::new(self.machine, &registry).on_disk(&self.programs.disk);
        let disk = self.programs.disk.clone();
        let FoundPrograms {
            inputs,
            failures: mut errors,
            mut left_out,
            ..
        } = self.programs.found(&mut machines);
        machines.look_ahead(&inputs);
        let loaded = inputs.iter().map(|it| machines.for_folder(it.folder()));
        let pairs: Vec<ProgramOnMachine<'_>> =
            inputs.iter().zip(loaded.collect::<Vec<_>>()).collect();
        let undescribed = pairs.iter().filter_map(|(input, loaded)| {
            let loaded = loaded.as_ref().ok()?;
            (!loaded.machine.is_described()).then_some(*input)
        });
        let mut said = GivenMessages {
            remark: remark_without_machine(undescribed),
            ..GivenMessages::default()
        };
        let mut all = Vec::new();
        let check = |(input, loaded)| check_file((input, loaded?), self.run, stop);
        in_order(pairs.into_iter(), processors(), check, |found| {
            match found {
                Ok(found) => all.push(found),
                Err(error) => errors.push(error),
            }
            stop.flow()
        });
        said.gather(all, &disk);
        left_out.forget_read(&registry);
        let unseen = left_out.diagnostics(&mut machines);
        said.messages.extend(unseen.iter().map(PyMessage::of));
        match Failure::of_several(errors) {
            Some(failure) => Err(failure),
            None => Ok(said),
        }
    }
}

impl GivenMessages {
    /// The messages of the programs that count on their own (R17.2): the others were checked in their callers.
    fn gather(&mut self, all: Vec<ProgramFindings<'_>>, disk: &Disk) {
        let executed: Vec<_> = all.iter().map(|it| it.executed.clone()).collect();
        let mut causes = Causes::default();
        let mut listed: Vec<Option<PathBuf>> = Vec::new();
        for (found, is_main) in all.into_iter().zip(main_programs(&executed, disk)) {
            if !listed.contains(&found.loaded.origin) {
                listed.push(found.loaded.origin.clone());
                let errors = found.loaded.errors().cloned();
                for error in errors {
                    causes.say(error);
                }
            }
            if is_main {
                causes.add(found.findings);
                self.leave_out(&found.unsaid);
            }
        }
        let causes = causes.diagnostics().iter();
        self.messages.extend(causes.map(PyMessage::of));
    }
}

/// Runs one program from the start of the control.
fn check_file<'a>(
    (input, loaded): (&'a Input, Arc<LoadedMachine>),
    run: Options,
    stop: &Stop,
) -> Result<ProgramFindings<'a>, HostError> {
    let options = SessionOptions::from(run)
        .with_levels(loaded.levels.clone())
        .with_settings(loaded.settings.clone());
    let alone = SingleRun {
        options,
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    };
    let mut findings = Findings::default();
    let mut sink = |record: &Record<'_>| {
        findings.record(record)?;
        stop.flow()
    };
    let session = run_alone(input, &loaded, alone, &mut sink)?;
    let unsaid = findings.unsaid(session.counts());
    let returned = session.interpreter().returned_files();
    let executed = ExecutedProgram {
        input,
        executed_to_end: returned.map(ToString::to_string).collect(),
    };
    Ok(ProgramFindings {
        executed,
        loaded,
        findings,
        unsaid,
    })
}
