//! What stands above a program: what it leaves, and the way to its timeline (R12.4).

use gen_lsp_types::{CodeLens, CodeLensParams, Command};
use serde_json::json;

use super::commands::SHOW_TIMELINE;
use super::documents::Kind;
use super::encoding::whole_line;
use super::hints::left;
use super::view::View;

/// The lenses over a text.
pub(super) fn code_lenses(view: &View, params: &CodeLensParams) -> Option<Vec<CodeLens>> {
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
    let left = left(run).unwrap_or_else(|| "leaves no axis away from home".to_owned());
    lenses.push(said(left));
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
