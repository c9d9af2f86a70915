//! The pages of the codes, as texts that an editor can open (R12.2).

use gen_lsp_types::{TextDocumentContentParams, TextDocumentContentResult, Uri};

use super::settings::Settings;
use frictcomp::diagnostic::Code;

/// The scheme of texts that the server itself provides.
pub(super) const SCHEME: &str = "frictcomp";

/// The page of a code: in the folder that the client names, or a text of the server.
pub(super) fn page_uri(code: Code, settings: &Settings) -> Uri {
    Uri(match &settings.pages {
        Some(folder) => format!("{folder}/{code}.md"),
        None => format!("{SCHEME}:/codes/{code}.md"),
    })
}

/// The text of a page; empty if there is no such code.
pub(super) fn content(params: &TextDocumentContentParams) -> TextDocumentContentResult {
    let uri = &params.uri.0;
    let name = uri.rsplit('/').next().unwrap_or_default();
    let code = Code::ALL
        .iter()
        .find(|code| name.strip_suffix(".md") == Some(code.as_str()));
    TextDocumentContentResult {
        text: code.map(|code| code.page().to_owned()).unwrap_or_default(),
    }
}
