//! The lenses above a program: the states that it leaves, and the way to its timeline (R12.4).

use gen_lsp_types::{CodeLens, CodeLensParams, Command};
use serde_json::json;

use super::analysis::limits;
use super::calls;
use super::commands::SHOW_TIMELINE;
use super::documents::{Kind, OpenDocument};
use super::encoding::whole_line;
use super::hints::left;
use super::view::RequestView;
use frictcomp::interpreter::Options;
use frictcomp::text::shown_path;
use frictcomp_host::{ArchiveAuditor, AuditOptions, FileRegistry, Input, MachineOptions, Machines};

/// Returns the lenses over a text.
pub(super) fn code_lenses(view: &RequestView, params: &CodeLensParams) -> Option<Vec<CodeLens>> {
    let document = view.document(&params.text_document.uri)?;
    if document.kind != Kind::Program || !view.client.settings.code_lens {
        return None;
    }
    let run = view.analysis(&document.uri)?.run.as_ref()?;
    let said = |title: String| CodeLens {
        range: whole_line(0),
        command: Some(Command {
            title,
            ..Command::default()
        }),
        data: None,
    };
    let mut lenses = Vec::new();
    lenses.extend(run.remark.clone().map(said));
    let name = shown_path(&document.path);
    let left =
        left(run, &name).unwrap_or_else(|| "leaves every axis in its start-up state".to_owned());
    lenses.push(said(left));
    lenses.extend(inherited(view, document).map(said));
    lenses.extend(calls::lens(view, document));
    lenses.push(CodeLens {
        range: whole_line(0),
        command: Some(Command {
            title: "Show timeline".to_owned(),
            tooltip: Some("the states of all axes over the executed blocks".to_owned()),
            command: SHOW_TIMELINE.to_owned(),
            arguments: Some(vec![json!({ "uri": document.uri })]),
        }),
        data: None,
    });
    Some(lenses)
}

/// Returns the axes that a program moves in a state that it inherits (R10.1); `None` if that cannot be determined.
fn inherited(view: &RequestView, document: &OpenDocument) -> Option<String> {
    let disk = view.documents.disk();
    let unheard = FileRegistry::default();
    let mut machines = Machines::new(MachineOptions::default(), &unheard).on_disk(&disk);
    let limits = limits(view.client.settings.max_blocks);
    let options = AuditOptions::new(Options::default().with_limits(limits));
    let inputs = vec![Input::Open(document.open_text())];
    let (auditor, _) = ArchiveAuditor::new(inputs, &mut machines, options);
    let (archives, _) = auditor.audit();
    let program = archives.first()?.programs().first()?;
    let axes = program.axes.iter().filter(|axis| axis.is_inheritor());
    let axes: Vec<&str> = axes.map(|axis| axis.axis.as_str()).collect();
    Some(match axes.as_slice() {
        [] => "inherits no state".to_owned(),
        axes => format!("inherits the state of {}", axes.join(", ")),
    })
}
