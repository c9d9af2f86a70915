//! Audits of programs on the disk (chapter 10).

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use crate::disk::{Disk, Input, Naming, Opened, read_text};
use crate::error::HostError;
use crate::machines::{LoadedMachine, Machines, ProgramFinder};
use crate::watch::{Done, LineTracker, Reached};
use crate::workers::{in_order, processors};
use frictcomp::audit::{Archive, Auditor, ProgramAudit, Sequence, Step};
use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::interpreter::{Event, Interpreter, Observer, Options};
use frictcomp::machine::Machine;
use frictcomp::session::Causes;
use frictcomp::text::SourceFile;

/// Number of blocks between two looks at the clock.
const STEP: u64 = 1 << 14;

/// Options of an audit.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct AuditOptions {
    /// Options of its runs.
    pub run: Options,
    /// The kinds of compensation that count.
    pub kinds: KindSet,
    /// Number of parallel runs.
    pub workers: NonZeroUsize,
}

impl AuditOptions {
    /// Creates the options of an audit on all processors that looks at friction compensation.
    pub fn new(run: Options) -> Self {
        Self {
            // Its own runs distinguish the states in which programs start.
            run,
            kinds: KindSet::of(Kind::Frict),
            workers: processors(),
        }
    }

    /// Sets the [`kinds`](Self::kinds).
    pub fn with_kinds(self, kinds: KindSet) -> Self {
        Self { kinds, ..self }
    }

    /// Sets the number of [`workers`](Self::workers).
    pub fn with_workers(self, workers: NonZeroUsize) -> Self {
        Self { workers, ..self }
    }
}

/// Reads the programs of an order, one on each line, from the folder of the file; empty lines and those that begin with
/// `#` or `;` are ignored.
///
/// # Errors
/// The file or one of its programs cannot be read, or the file names no program.
pub fn programs_in_order(order: &Path) -> Result<Vec<Input>, HostError> {
    let text = read_text(order)?;
    let folder = order.parent().unwrap_or(Path::new(""));
    let names = text.lines().map(str::trim);
    let names = names.filter(|name| !name.is_empty() && !name.starts_with(['#', ';']));
    let inputs: Vec<Input> = names.map(|name| Input::File(folder.join(name))).collect();
    if inputs.is_empty() {
        return Err(HostError::NoProgramInOrder(order.to_owned()));
    }
    inputs.iter().try_for_each(Input::probe)?;
    Ok(inputs)
}

/// Audits programs on the disk, each on the machine of its folder. What cannot be read is left out
/// and reported.
pub struct ArchiveAuditor {
    machines: Vec<Arc<LoadedMachine>>,
    /// The programs, each with the position of its machine.
    programs: Vec<(Input, usize)>,
    options: AuditOptions,
}

/// Audits the programs of one machine.
pub(crate) struct ProgramAuditor<'a> {
    pub(crate) loaded: &'a LoadedMachine,
    pub(crate) auditor: Auditor,
}

impl ArchiveAuditor {
    /// Notes the programs among the files that are read, and finds the machine of each; also returns why a program has
    /// none.
    pub fn new(
        inputs: Vec<Input>,
        machines: &mut Machines,
        options: AuditOptions,
    ) -> (Self, Vec<HostError>) {
        for input in &inputs {
            input.note(machines.registry());
        }
        machines.look_ahead(&inputs);
        let mut auditor = Self {
            machines: Vec::new(),
            programs: Vec::with_capacity(inputs.len()),
            options,
        };
        let mut errors = Vec::new();
        for input in inputs {
            match machines.for_folder(input.folder()) {
                Ok(loaded) => {
                    let machine = auditor.position(loaded);
                    auditor.programs.push((input, machine));
                }
                Err(error) => errors.push(error),
            }
        }
        (auditor, errors)
    }

    fn position(&mut self, loaded: Arc<LoadedMachine>) -> usize {
        let mut known = self.machines.iter();
        known
            .position(|it| Arc::ptr_eq(it, &loaded))
            .unwrap_or_else(|| {
                self.machines.push(loaded);
                self.machines.len() - 1
            })
    }

    /// Returns the machines of the programs, in the order in which they were found.
    pub fn machines(&self) -> &[Arc<LoadedMachine>] {
        &self.machines
    }

    /// Returns the machines, each with the configuration or start-up list that describes it, if there is one.
    pub fn described(&self) -> impl Iterator<Item = (Option<&Path>, &Machine)> {
        let machines = self.machines.iter();
        machines.map(|it| (it.origin.as_deref(), &it.machine))
    }

    /// Returns the programs whose machine is not described.
    pub fn undescribed(&self) -> impl Iterator<Item = &Input> {
        self.programs.iter().filter_map(|(input, machine)| {
            let is_described = self.machines[*machine].machine.is_described();
            (!is_described).then_some(input)
        })
    }

    /// Returns why the control does not accept its lists.
    pub fn list_errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.machines.iter().flat_map(|it| it.errors())
    }

    /// Returns the messages about programs without a block, and files that are no programs (R18.6), of the archive of
    /// each machine.
    pub fn about_files<'a>(&self, archives: impl IntoIterator<Item = &'a Archive>) -> Causes {
        let mut causes = Causes::default();
        for (loaded, archive) in self.machines.iter().zip(archives) {
            let programs = archive.programs().iter();
            for said in programs.flat_map(|program| &program.about_file) {
                if let Some(severity) = loaded.levels.severity(said.code) {
                    let mut said = said.clone();
                    said.severity = severity;
                    causes.say(said);
                }
            }
        }
        causes
    }

    /// Returns the programs, each with the position of its machine.
    pub fn programs(&self) -> &[(Input, usize)] {
        &self.programs
    }

    pub(crate) fn auditors(&self) -> Vec<ProgramAuditor<'_>> {
        let machines = self.machines.iter();
        machines
            .map(|loaded| ProgramAuditor::new(loaded, self.options))
            .collect()
    }

    pub(crate) fn workers(&self, most: usize) -> NonZeroUsize {
        let most = NonZeroUsize::new(most).unwrap_or(NonZeroUsize::MIN);
        self.options.workers.min(most)
    }

    /// Returns `Break` where the watcher stops the work.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.machines.iter().any(|it| it.watch.is_stopped()) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Runs every program, and those again that depend on what others leave in variables (R2.34). Returns the
    /// archive of each machine, and what cannot be read.
    pub fn audit(&self) -> (Vec<Archive>, Vec<HostError>) {
        let auditors = self.auditors();
        let mut archives = vec![Archive::default(); auditors.len()];
        let mut inputs = vec![Vec::new(); auditors.len()];
        let mut errors = Vec::new();
        let work = |(input, machine): &'_ (Input, usize)| {
            let audited = auditors[*machine].audit(input);
            if audited.is_ok() {
                self.machines[*machine].watch.program_done();
            }
            (*machine, audited)
        };
        let workers = self.workers(self.programs.len());
        let programs = self.programs.iter().enumerate();
        let work = |(at, program): (usize, &'_ (Input, usize))| (at, work(program));
        in_order(programs, workers, work, |(at, (machine, audited))| {
            match audited {
                Ok(program) => {
                    archives[machine].push(program);
                    inputs[machine].push(at);
                }
                Err(error) => errors.push(error),
            }
            self.flow()
        });
        self.settle(auditors, (&mut archives, &inputs), &mut errors);
        (archives, errors)
    }

    /// Runs programs again until each has found what others may leave. `inputs` are the positions of the programs of
    /// each archive.
    fn settle(
        &self,
        mut auditors: Vec<ProgramAuditor<'_>>,
        (archives, inputs): (&mut [Archive], &[Vec<usize>]),
        errors: &mut Vec<HostError>,
    ) {
        let count = errors.len();
        while errors.len() == count && self.flow().is_continue() {
            let unsettled: Vec<(usize, usize)> = unsettled(archives);
            if unsettled.is_empty() {
                return;
            }
            find(&mut auditors, archives);
            let work = |(machine, at): (usize, usize)| {
                let (input, _) = &self.programs[inputs[machine][at]];
                (machine, at, auditors[machine].audit(input))
            };
            let workers = self.workers(unsettled.len());
            in_order(
                unsettled.into_iter(),
                workers,
                work,
                |(machine, at, audited)| {
                    match audited {
                        Ok(program) => archives[machine].settle(at, program),
                        Err(error) => errors.push(error),
                    }
                    self.flow()
                },
            );
        }
    }

    /// Runs the programs in their order, each machine from the start of its control.
    pub fn follow(&self) -> (Vec<Step>, Vec<HostError>) {
        let auditors = self.auditors();
        let mut sequences: Vec<Sequence<'_>> = auditors
            .iter()
            .map(|auditor| Sequence::new(&auditor.auditor))
            .collect();
        let (mut steps, mut errors) = (Vec::with_capacity(self.programs.len()), Vec::new());
        for (input, machine) in &self.programs {
            match auditors[*machine].step(&mut sequences[*machine], input) {
                Ok(step) => steps.push(step),
                Err(error) => errors.push(error),
            }
            if self.flow().is_break() {
                break;
            }
        }
        (steps, errors)
    }
}

/// Returns the programs of archives that have to be run again, each with its archive.
fn unsettled(archives: &[Archive]) -> Vec<(usize, usize)> {
    let archives = archives.iter().enumerate();
    let unsettled = archives.flat_map(|(machine, archive)| {
        let programs = archive.unsettled().into_iter();
        programs.map(move |at| (machine, at))
    });
    unsettled.collect()
}

/// Passes to the auditors what the programs of their archives find in variables that outlive programs.
pub(crate) fn find(auditors: &mut [ProgramAuditor<'_>], archives: &[Archive]) {
    for (auditor, archive) in auditors.iter_mut().zip(archives) {
        auditor.auditor.find(archive.found());
    }
}

impl<'a> ProgramAuditor<'a> {
    fn new(loaded: &'a LoadedMachine, options: AuditOptions) -> Self {
        let machine = loaded.machine.clone();
        Self {
            auditor: Auditor::new(machine, options.run, &loaded.settings, options.kinds),
            loaded,
        }
    }

    fn audit(&self, input: &Input) -> Result<ProgramAudit, HostError> {
        let name = input.name(Naming::AsGiven);
        let audit = self.auditor.audit(&name, |interpreter, observer| {
            let finder = self.finder(input, &self.loaded.disk);
            self.run(input, finder, (interpreter, observer))
        })?;
        Ok(audit)
    }

    fn step(&self, sequence: &mut Sequence<'_>, input: &Input) -> Result<Step, HostError> {
        let name = input.name(Naming::AsGiven);
        let step = sequence.step(&name, |interpreter, observer| {
            let finder = self.finder(input, &self.loaded.disk);
            self.run(input, finder, (interpreter, observer))
        })?;
        self.loaded.watch.program_done();
        Ok(step)
    }

    /// Runs a program with texts in place of some files.
    pub(crate) fn run_with(
        &self,
        texts: &Disk,
        path: &Path,
        (interpreter, observer): (&mut Interpreter, &mut dyn Observer),
    ) -> Result<(), HostError> {
        let input = Input::File(path.to_owned());
        let finder = self.finder(&input, texts);
        match texts.text(path) {
            Some(text) => {
                let source = SourceFile::new(input.name(Naming::AsGiven), text.as_str());
                interpreter.program(source, &mut { finder }, observer);
                Ok(())
            }
            None => self.run(&input, finder, (interpreter, observer)),
        }
    }

    fn finder(&self, input: &Input, disk: &Disk) -> ProgramFinder {
        let loaded = self.loaded;
        ProgramFinder::new(input, &loaded.search_path, Naming::AsGiven, disk)
            .noting(&loaded.registry)
    }

    fn run(
        &self,
        input: &Input,
        mut finder: ProgramFinder,
        (interpreter, observer): (&mut Interpreter, &mut dyn Observer),
    ) -> Result<(), HostError> {
        let name = input.name(Naming::AsGiven);
        let mut heard = Heard::default();
        let mut listener = |event: Event<'_>| {
            if self.loaded.watch.is_on() {
                heard.event(&event, self.loaded)?;
            }
            observer.event(event)
        };
        match input.open(Naming::AsGiven, &|| ())? {
            Opened::Whole(source) => {
                interpreter.program(source, &mut finder, &mut listener);
            }
            Opened::Lines(mut lines) => {
                interpreter.stream(&name, &mut lines, &mut finder, &mut listener);
                if let Some(error) = lines.take_failure() {
                    return Err(HostError::read(Path::new(&name), error));
                }
            }
        }
        Ok(())
    }
}

/// Reports the blocks of a run to a watch.
#[derive(Default)]
struct Heard {
    blocks: u64,
    tracker: LineTracker,
}

impl Heard {
    fn event(&mut self, event: &Event<'_>, loaded: &LoadedMachine) -> ControlFlow<()> {
        let Event::Executed(executed) = event else {
            return ControlFlow::Continue(());
        };
        self.blocks += 1;
        if self.blocks.is_multiple_of(STEP) && loaded.watch.is_stopped() {
            return ControlFlow::Break(());
        }
        if executed.level.is_none() {
            let passes = self.tracker.reach(executed.line);
            if self.blocks.is_multiple_of(STEP) {
                let reached = Reached {
                    file: executed.file,
                    line: executed.line,
                };
                let done = Done::Blocks(self.blocks);
                loaded.watch.show_program(done, reached, passes);
            }
        }
        ControlFlow::Continue(())
    }
}
