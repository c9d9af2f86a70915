//! `frictcomp.check`: the messages of programs and folders of programs.

use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::interpreter::{Options, StopPolicy};
use frictcomp_host::{
    Baseline, CalledPrograms, CheckOptions, FileRegistry, FolderOptions, FoundPrograms,
    IgnoreFiles, MachineOptions, Machines, ProgramsOnMachines, processors,
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
/// taken, and what ignore files name only with ``no_ignore``. ``baseline`` is a file of known findings, which
/// ``frictcomp check --write-baseline`` wrote: they are left out. ``Error`` if one of the programs cannot be read.
#[pyfunction]
#[pyo3(signature = (programs, *, machine=None, limits=None, exclude=None, no_ignore=false, baseline=None))]
pub(crate) fn check(
    programs: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    limits: Option<&Bound<'_, PyLimits>>,
    exclude: Option<Several<String>>,
    no_ignore: bool,
    baseline: Option<PathBuf>,
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
        baseline,
    };
    let said = interruptible(programs.py(), move |stop| job.done(stop))?;
    Ok(PyMessages::new(said))
}

/// Input of a check, independent of Python.
struct CheckJob {
    programs: GivenPrograms,
    machine: MachineOptions,
    run: Options,
    baseline: Option<PathBuf>,
}

impl CheckJob {
    fn done(self, stop: &Stop) -> Result<GivenMessages, Failure> {
        let registry = FileRegistry::default();
        let known = self.baseline.as_ref();
        let known = known
            .map(|path| Baseline::read(path, &registry))
            .transpose()?;
        let mut known = known.unwrap_or_default();
        let machines = Machines::new(self.machine, &registry).on_disk(&self.programs.disk);
        let mut machines = machines.watched_by(Arc::new(stop.clone()));
        let options = CheckOptions {
            run: self.run,
            wording: None,
            called: CalledPrograms::InCallers,
            workers: processors(),
            disk: self.programs.disk.clone(),
        };
        let FoundPrograms {
            inputs,
            failures: mut errors,
            mut left_out,
            ..
        } = self.programs.found(&mut machines);
        machines.look_ahead(&inputs);
        let programs = ProgramsOnMachines::new(&inputs, &mut machines);
        let mut said = GivenMessages {
            remark: remark_without_machine(programs.undescribed()),
            ..GivenMessages::default()
        };
        let (checked, unread) = programs.check(&options);
        errors.extend(unread);
        for program in &checked.programs {
            let unsaid = program.unsaid.iter();
            let unsaid =
                unsaid.map(|(severity, more)| (*severity, known.unlisted(*severity, *more)));
            said.leave_out(&unsaid.collect());
        }
        left_out.forget_read(&registry);
        let unseen = left_out.diagnostics(&mut machines);
        let causes = checked.causes.diagnostics().iter().chain(&unseen);
        let listed = causes.filter(|said| known.lists(said));
        said.messages.extend(listed.map(PyMessage::of));
        match Failure::of_several(errors) {
            Some(failure) => Err(failure),
            None => Ok(said),
        }
    }
}
