//! The abilities and settings of the client.

use std::path::PathBuf;

use gen_lsp_types::{ClientCapabilities, InitializeParams, WorkspaceFolders};

use super::encoding::Encoding;
use super::pages::written_pages;
use super::settings::Settings;
use super::uri::path_of;

/// Abilities of the client, and the settings of its user.
#[derive(Debug, Clone)]
pub(super) struct LspClient {
    /// Unit of its columns.
    pub(super) encoding: Encoding,
    /// Settings of its user.
    pub(super) settings: Settings,
    /// Abilities.
    pub(super) capabilities: ClientCapabilities,
}

impl LspClient {
    /// Returns the client of an `initialize` request, and the settings that cannot be used.
    pub(super) fn new(params: &InitializeParams) -> (Self, Vec<String>) {
        let mut settings = Settings::default();
        let given = params.initialization_options.as_ref();
        let wrong = given.map(|given| settings.take(given)).unwrap_or_default();
        let workspace = params.capabilities.workspace.as_ref();
        let opens_texts = workspace.is_some_and(|it| it.text_document_content.is_some());
        if settings.pages.is_none() && !opens_texts {
            settings.pages = written_pages();
        }
        let client = Self {
            encoding: Encoding::negotiated(&params.capabilities),
            settings,
            capabilities: params.capabilities.clone(),
        };
        (client, wrong)
    }

    /// Returns whether it reports changed files on request.
    pub(super) fn watches_files(&self) -> bool {
        let workspace = self.capabilities.workspace.as_ref();
        let watching = workspace.and_then(|it| it.did_change_watched_files.as_ref());
        watching.and_then(|it| it.dynamic_registration) == Some(true)
    }

    /// Returns whether it can be asked for its settings.
    pub(super) fn gives_settings(&self) -> bool {
        let workspace = self.capabilities.workspace.as_ref();
        workspace.and_then(|it| it.configuration) == Some(true)
    }

    /// Returns whether it refreshes inlay hints on request.
    pub(super) fn refreshes_inlay_hints(&self) -> bool {
        let workspace = self.capabilities.workspace.as_ref();
        let hints = workspace.and_then(|it| it.inlay_hint.as_ref());
        hints.and_then(|it| it.refresh_support) == Some(true)
    }

    /// Returns whether it refreshes code lenses on request.
    pub(super) fn refreshes_code_lenses(&self) -> bool {
        let workspace = self.capabilities.workspace.as_ref();
        let lenses = workspace.and_then(|it| it.code_lens.as_ref());
        lenses.and_then(|it| it.refresh_support) == Some(true)
    }

    /// Returns whether it pulls messages, and refreshes them on request.
    pub(super) fn pulls_diagnostics(&self) -> bool {
        let workspace = self.capabilities.workspace.as_ref();
        let refreshing = workspace.and_then(|it| it.diagnostics.as_ref());
        let document = self.capabilities.text_document.as_ref();
        document.is_some_and(|it| it.diagnostic.is_some())
            && refreshing.and_then(|it| it.refresh_support) == Some(true)
    }

    /// Returns whether it asks what can be renamed before it asks for a new name.
    pub(super) fn prepares_renames(&self) -> bool {
        let document = self.capabilities.text_document.as_ref();
        let rename = document.and_then(|it| it.rename.as_ref());
        rename.and_then(|it| it.prepare_support) == Some(true)
    }

    /// Returns whether changes of files name the version that they are for.
    pub(super) fn edits_versions(&self) -> bool {
        let workspace = self.capabilities.workspace.as_ref();
        let edits = workspace.and_then(|it| it.workspace_edit.as_ref());
        edits.and_then(|it| it.document_changes) == Some(true)
    }
}

/// Returns the folder of the project, if the client names one.
#[allow(deprecated, reason = "older clients name nothing else")]
pub(super) fn project(params: &InitializeParams) -> Option<PathBuf> {
    let folders = params
        .workspace_folders_initialize_params
        .workspace_folders
        .as_ref();
    let first = match folders {
        Some(WorkspaceFolders::WorkspaceFolderList(folders)) => folders.first(),
        Some(WorkspaceFolders::Null) | None => None,
    };
    let uri = first
        .map(|folder| &folder.uri)
        .or(params.root_uri.as_ref())?;
    path_of(&uri.0)
}
