//! Reports that an editor shows in a separate window (R12.4).

use std::ops::ControlFlow;
use std::sync::Arc;

use gen_lsp_types::{ExecuteCommandParams, Uri};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::refusal::Refusal;
use super::uri::path_of;
use super::view::RequestView;
use super::wording::editor;
use frictcomp::comp::{Kind, KindSet};
use frictcomp::interpreter::Options;
use frictcomp::text::LineSource;
use frictcomp::timeline::{Record, Sink};
use frictcomp_host::{
    ArchiveAuditor, AuditOptions, Axes, Disk, FileRegistry, Input, MachineOptions, Machines,
    Naming, OpenText, SingleRun, find_programs, run_alone,
};
use frictcomp_report::html::{
    GivenForRun, RunDigest, RunInputs, Sources, render_run, render_with_lines,
};
use frictcomp_report::results::audit::{self, AuditReport};

/// The timeline of a program as an HTML report.
pub(super) const SHOW_TIMELINE: &str = "frictcomp.showTimeline";

/// Name of the command for the HTML report on the order of the programs of a folder.
const AUDIT: &str = "frictcomp.audit";

/// Commands of the server.
pub(super) const COMMANDS: [&str; 2] = [SHOW_TIMELINE, AUDIT];

/// Subject of a command: its one argument.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct CommandSubject {
    /// The program, or the folder.
    uri: Uri,
}

/// The result of a command.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct CommandResult {
    /// A self-contained page: no network, no script, no second file.
    html: String,
}

/// Runs a command.
pub(super) fn execute(
    view: &RequestView,
    params: ExecuteCommandParams,
) -> Result<CommandResult, Refusal> {
    let subject = params.arguments.into_iter().flatten().next();
    let subject: CommandSubject = serde_json::from_value(subject.unwrap_or(Value::Null))?;
    match params.command.as_str() {
        SHOW_TIMELINE => timeline(view, &subject),
        AUDIT => audit(view, &subject),
        other => Err(Refusal::Params(format!("there is no command `{other}`"))),
    }
}

/// The open texts, and the other files.
struct Texts(Disk);

impl Sources for Texts {
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>> {
        self.0.lines(name)
    }
}

/// The run of a program, until the client cancels it.
struct Digest<'a> {
    digest: RunDigest,
    view: &'a RequestView,
}

impl Sink for Digest<'_> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if self.view.cancel.is_set() {
            return ControlFlow::Break(());
        }
        self.digest.record(record)
    }
}

fn timeline(view: &RequestView, subject: &CommandSubject) -> Result<CommandResult, Refusal> {
    let document = view
        .document(&subject.uri)
        .ok_or_else(|| Refusal::Params(format!("`{}` is not open", subject.uri.0)))?;
    let disk = view.documents.disk();
    let input = Input::Open(document.open_text());
    let unheard = FileRegistry::default();
    let mut machines = Machines::new(MachineOptions::default(), &unheard).on_disk(&disk);
    let loaded = machines.for_folder(input.folder())?;
    let alone = SingleRun {
        options: loaded
            .session(Options::default())
            .with_wording(Some(editor)),
        naming: Naming::AsGiven,
        axes: Axes::Ahead,
    };
    let mut sink = Digest {
        digest: RunDigest::new(KindSet::of(Kind::Frict)),
        view,
    };
    run_alone(&input, &loaded, alone, &mut sink)?;
    let given = RunInputs {
        given: GivenForRun {
            machine: loaded.origin.as_deref(),
            variables: &loaded.settings,
            ..GivenForRun::default()
        },
        parameters: &loaded.reports,
        programs: &loaded.programs,
    };
    let mut page = Vec::new();
    render_run(&sink.digest, &given, &mut Texts(disk), &mut page)
        .map_err(|error| Refusal::Failed(error.to_string()))?;
    Ok(CommandResult {
        html: String::from_utf8_lossy(&page).into_owned(),
    })
}

/// Audits the programs of a folder and below, or of the folder of a program, each as it is open.
fn audit(view: &RequestView, subject: &CommandSubject) -> Result<CommandResult, Refusal> {
    let named = path_of(&subject.uri.0);
    let path =
        named.ok_or_else(|| Refusal::Params(format!("`{}` is not a file", subject.uri.0)))?;
    let folder = match path.parent() {
        Some(folder) if !path.is_dir() => folder.to_owned(),
        _ => path,
    };
    let disk = view.documents.disk();
    let unheard = FileRegistry::default();
    let mut machines = Machines::new(MachineOptions::default(), &unheard).on_disk(&disk);
    let mut found = find_programs(&[folder], |folder| machines.selection(folder));
    let inputs = found.inputs.into_iter().map(|input| match &input {
        Input::File(path) => match disk.text(path) {
            Some(text) => Input::Open(OpenText {
                path: path.clone(),
                text: Arc::clone(text),
            }),
            None => input,
        },
        Input::Open(_) | Input::Stdin => input,
    });
    let options = AuditOptions::new(Options::default());
    let (auditor, mut errors) = ArchiveAuditor::new(inputs.collect(), &mut machines, options);
    errors.extend(found.failures);
    let (archives, unread) = auditor.audit();
    errors.extend(unread);
    // A report that leaves programs out would look like an all-clear.
    if let Some(error) = errors.into_iter().next() {
        return Err(error.into());
    }
    found.left_out.forget_read(&unheard);
    let report = AuditReport::new(auditor.described(), archives, found.left_out.in_words());
    let mut page = Vec::new();
    render_with_lines(&audit::document(&report), &mut Texts(disk), &mut page)
        .map_err(|error| Refusal::Failed(error.to_string()))?;
    Ok(CommandResult {
        html: String::from_utf8_lossy(&page).into_owned(),
    })
}
