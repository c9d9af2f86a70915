//! The pages of the codes, as texts that an editor can open (R12.2, R12.21).

use std::ffi::OsString;
use std::path::PathBuf;
use std::{env, fs, io};

use gen_lsp_types::{TextDocumentContentParams, TextDocumentContentResult, Uri};

use super::settings::Settings;
use super::uri::uri_of;
use frictcomp::diagnostic::Code;

/// The scheme of texts that the server itself provides.
pub(super) const SCHEME: &str = "frictcomp";

/// Returns the page of a code: in the folder that the client names, or a text of the server.
pub(super) fn page_uri(code: Code, settings: &Settings) -> Uri {
    Uri(match &settings.pages {
        Some(folder) => format!("{folder}/{code}.md"),
        None => format!("{SCHEME}:/codes/{code}.md"),
    })
}

/// Writes the pages for a client that opens files only, and returns the URI of their folder; `None` if they cannot be
/// written.
pub(super) fn written_pages() -> Option<String> {
    let version = concat!("frictcomp-", env!("CARGO_PKG_VERSION"));
    let folder = cache_folder().join(version).join("codes");
    let write = |code: &Code| {
        let path = folder.join(format!("{code}.md"));
        match fs::read(&path) {
            Ok(known) if known == code.page().as_bytes() => Ok(()),
            _ => fs::write(&path, code.page()),
        }
    };
    let written: io::Result<()> =
        fs::create_dir_all(&folder).and_then(|()| Code::ALL.iter().try_for_each(write));
    written.ok().map(|()| uri_of(&folder))
}

/// Returns the folder of the user for what can be made again.
fn cache_folder() -> PathBuf {
    let named = |name: &str| env::var_os(name).filter(|it: &OsString| !it.is_empty());
    let home = || Some(PathBuf::from(named("HOME")?).join(".cache"));
    let cache = if cfg!(windows) {
        named("LOCALAPPDATA").map(PathBuf::from)
    } else {
        named("XDG_CACHE_HOME").map(PathBuf::from).or_else(home)
    };
    cache
        .filter(|it| it.is_absolute())
        .unwrap_or_else(env::temp_dir)
}

/// Returns the text of a page; empty if there is no such code.
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
