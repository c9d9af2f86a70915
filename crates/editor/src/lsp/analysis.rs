//! The results of the check of an open text.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use super::documents::{Kind, OpenDocument};
use super::settings::MAX_BLOCKS;
use super::states::StateBook;
use super::wording::editor;
use super::worker::Cancel;
use frictcomp::comp::{CncBuild, State};
use frictcomp::diagnostic::{Code, Diagnostic};
use frictcomp::interpreter::EndedBy;
use frictcomp::interpreter::{Limits, Options, StopPolicy};
use frictcomp::session::{Findings, SessionOptions};
use frictcomp::timeline::{Record, Sink};
use frictcomp_host::{
    AllowedRoots, Axes, Disk, FileRegistry, HostError, Input, LoadedMachine, MachineOptions,
    Machines, Naming, SingleRun, check_list_file, run_alone,
};

/// A text to check, with all other texts, as of the moment of the request.
pub(super) struct AnalysisJob {
    /// The text that was checked.
    pub(super) document: Arc<OpenDocument>,
    /// The disk with all open texts.
    pub(super) disk: Disk,
    /// The executed blocks that are checked.
    pub(super) max_blocks: u64,
    /// Mark that the text has changed since.
    pub(super) cancel: Cancel,
}

/// Result of the check of a text.
#[derive(Debug, Default)]
pub(super) struct Analysis {
    /// The version of the text.
    pub(super) version: i32,
    /// Messages about the text and all that it uses.
    pub(super) said: Vec<Diagnostic>,
    /// Reason why the text could not be checked.
    pub(super) failure: Option<Failure>,
    /// The files that were read for it.
    pub(super) reads: Vec<PathBuf>,
    /// The names of programs that were called and not found.
    pub(super) missed: Vec<String>,
    /// Course of the program.
    pub(super) run: Option<ProgramRun>,
}

/// Reason why a text could not be checked.
#[derive(Debug)]
pub(super) struct Failure {
    /// The failure.
    pub(super) message: String,
    /// Advice on it.
    pub(super) help: Option<String>,
}

/// Course of a program.
#[derive(Debug)]
pub(super) struct ProgramRun {
    /// The states of its blocks.
    pub(super) states: StateBook,
    /// The axes when it has ended.
    pub(super) ends: Vec<AxisEnd>,
    /// Whether the program has more blocks than are checked.
    pub(super) is_cut: bool,
    /// The number of executed blocks.
    pub(super) blocks: u64,
    /// Remark that no machine is described, in words (R1.37).
    pub(super) remark: Option<String>,
}

/// An axis when a program has ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AxisEnd {
    /// Position in the machine.
    pub(super) at: usize,
    /// Name of the axis.
    pub(super) axis: String,
    /// The state at the end.
    pub(super) end: State,
    /// The state at the start of the control.
    pub(super) start_up: State,
}

impl AnalysisJob {
    /// Checks the text; `None` if it has changed meanwhile.
    pub(super) fn run(&self) -> Option<Analysis> {
        let registry = FileRegistry::default();
        let disk = &self.disk;
        let mut analysis = match self.document.kind {
            Kind::Program => self.check_program(disk, &registry),
            Kind::List | Kind::Configuration => self.check_list(disk, &registry),
            Kind::Other => Analysis::default(),
        };
        if self.cancel.is_set() {
            return None;
        }
        analysis.version = self.document.version;
        analysis.missed = registry.missed();
        let files = registry.files().into_iter();
        analysis.reads = files
            .map(|path| disk.absolute(&path).unwrap_or(path))
            .collect();
        Some(analysis)
    }

    fn check_program(&self, disk: &Disk, registry: &FileRegistry) -> Analysis {
        let input = Input::Open(self.document.open_text());
        input.note(registry);
        let mut machines = Machines::new(MachineOptions::default(), registry).on_disk(disk);
        let loaded = match machines.for_folder(input.folder()) {
            Ok(loaded) => loaded,
            Err(error) => return failed(&error),
        };
        let alone = SingleRun {
            options: options(&loaded, self.max_blocks),
            naming: Naming::AsGiven,
            axes: Axes::Ahead,
        };
        let mut survey = Survey::new(self.cancel.clone());
        if let Err(error) = run_alone(&input, &loaded, alone, &mut survey) {
            return failed(&error);
        }
        let mut said: Vec<Diagnostic> = loaded.errors().cloned().collect();
        for diagnostic in &mut said {
            diagnostic.reword(Some(editor));
        }
        let mut found = survey.findings.diagnostics();
        let is_cut = found.any(|it| it.code == Code::Fc910 && it.is_raised());
        let found = survey.findings.diagnostics();
        // The end of the check in the editor does not prove that a loop is endless.
        said.extend(
            found
                .filter(|it| !is_cut || it.code != Code::Fc910)
                .cloned(),
        );
        Analysis {
            said,
            run: Some(ProgramRun {
                states: survey.states,
                ends: survey.ends,
                is_cut,
                blocks: survey.blocks,
                remark: survey.remark,
            }),
            ..Analysis::default()
        }
    }

    fn check_list(&self, disk: &Disk, registry: &FileRegistry) -> Analysis {
        let path = &self.document.path;
        registry.reads("list", path);
        let build = match self.document.kind {
            Kind::List => self.build(disk, registry),
            Kind::Program | Kind::Configuration | Kind::Other => None,
        };
        let mut report = match check_list_file(path, build, disk) {
            Ok(report) => report,
            // Most projects have no CNC.
            Err(HostError::NotAProject { .. }) => return Analysis::default(),
            Err(error) => return failed(&error),
        };
        for file in &report.files {
            registry.reads("list", std::path::Path::new(&**file));
        }
        let folder = path.parent().unwrap_or(path);
        AllowedRoots::default()
            .with(std::path::Path::new(""))
            .with(folder)
            .conceal(&mut report.diagnostics);
        for diagnostic in &mut report.diagnostics {
            diagnostic.reword(Some(editor));
        }
        Analysis {
            said: report.diagnostics,
            ..Analysis::default()
        }
    }

    /// Returns the build of the machine that a list belongs to, if a configuration names it.
    fn build(&self, disk: &Disk, registry: &FileRegistry) -> Option<CncBuild> {
        let folder = self.document.path.parent()?;
        let mut machines = Machines::new(MachineOptions::default(), registry).on_disk(disk);
        machines.for_folder(folder).ok()?.machine.build
    }
}

/// Returns the options of runs in an editor: those of `check`, for fewer blocks.
pub(super) fn options(loaded: &LoadedMachine, max_blocks: u64) -> SessionOptions {
    let run = Options::default()
        .with_stop(StopPolicy::CheckAll)
        .with_limits(limits(max_blocks));
    loaded.session(run).with_wording(Some(editor))
}

/// Returns the budgets of a program in an editor: the more blocks are checked, the longer loops and calls may run, too.
pub(super) fn limits(max_blocks: u64) -> Limits {
    let limits = Limits::brief().with_blocks(max_blocks);
    limits.with_repeats(
        limits
            .repeats
            .saturating_mul(max_blocks.div_ceil(MAX_BLOCKS)),
    )
}

fn failed(error: &HostError) -> Analysis {
    Analysis {
        said: error.diagnostics().to_vec(),
        failure: Some(Failure {
            message: error.to_string(),
            help: error.help(),
        }),
        ..Analysis::default()
    }
}

/// Takes the records of a run.
struct Survey {
    cancel: Cancel,
    findings: Findings,
    states: StateBook,
    ends: Vec<AxisEnd>,
    ended_by: Option<EndedBy>,
    /// The number of executed blocks.
    blocks: u64,
    remark: Option<String>,
}

impl Survey {
    fn new(cancel: Cancel) -> Self {
        Self {
            cancel,
            findings: Findings::default(),
            states: StateBook::default(),
            ends: Vec::new(),
            ended_by: None,
            blocks: 0,
            remark: None,
        }
    }
}

impl Sink for Survey {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if self.cancel.is_set() {
            return ControlFlow::Break(());
        }
        match record {
            Record::Session { remark, .. } => self.remark = remark.map(str::to_owned),
            Record::Program { state, .. } => self.states.begin(*state),
            Record::Block(row) => {
                self.states.block(row);
                if row.diagnostics.is_empty() {
                    return ControlFlow::Continue(());
                }
            }
            Record::End(end) => {
                self.states.end(end.state);
                self.ended_by = Some(end.by);
            }
            Record::Summary(summary) => {
                self.blocks = summary.blocks;
                let axes = summary.axes.iter();
                let ends = axes.map(|axis| AxisEnd {
                    at: axis.axis.get(),
                    axis: summary.state.name(axis.axis).to_owned(),
                    end: axis.end,
                    start_up: axis.start_up,
                });
                self.ends = ends.collect();
            }
            Record::Join(join) => self.states.join(join),
            Record::Machine(_) => {}
        }
        self.findings.record(record)
    }
}
