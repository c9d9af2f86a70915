//! The capabilities of the server.

use gen_lsp_types::{
    CodeActionKind, CodeActionOptions, CodeLensOptions, CompletionOptions, DiagnosticOptions,
    DiagnosticProvider, ExecuteCommandOptions, InitializeResult, RenameOptions, RenameProvider,
    SaveOptions, ServerCapabilities, ServerInfo, TextDocumentContent, TextDocumentContentOptions,
    TextDocumentSyncKind, TextDocumentSyncOptions, WorkspaceFoldersServerCapabilities,
    WorkspaceOptions,
};

use super::client::LspClient;
use super::commands::COMMANDS;
use super::pages::SCHEME;
use super::project_calls::ProjectCalls;

/// Returns the answer to `initialize`.
pub(super) fn offer(client: &LspClient, calls: &ProjectCalls) -> InitializeResult {
    let has_project = calls.are_known().then_some(true);
    let shows_calls = has_project.filter(|_| client.settings.outlines());
    let outlines = client.settings.outlines().then_some(true);
    let finds_names = client.settings.finds_names().then_some(true);
    InitializeResult {
        capabilities: ServerCapabilities {
            position_encoding: Some(client.encoding.kind()),
            text_document_sync: Some(
                TextDocumentSyncOptions {
                    open_close: Some(true),
                    change: Some(TextDocumentSyncKind::Incremental),
                    save: Some(SaveOptions::default().into()),
                    ..TextDocumentSyncOptions::default()
                }
                .into(),
            ),
            hover_provider: Some(true.into()),
            code_lens_provider: Some(CodeLensOptions {
                resolve_provider: has_project,
                ..CodeLensOptions::default()
            }),
            call_hierarchy_provider: shows_calls.map(Into::into),
            workspace_symbol_provider: shows_calls.map(Into::into),
            code_action_provider: Some(
                CodeActionOptions {
                    code_action_kinds: Some(vec![
                        CodeActionKind::QuickFix,
                        CodeActionKind::SourceFixAll,
                    ]),
                    ..CodeActionOptions::default()
                }
                .into(),
            ),
            completion_provider: Some(CompletionOptions {
                trigger_characters: Some(vec![" ".to_owned()]),
                ..CompletionOptions::default()
            }),
            document_symbol_provider: outlines.map(Into::into),
            definition_provider: finds_names.map(Into::into),
            references_provider: finds_names.map(Into::into),
            folding_range_provider: outlines.map(Into::into),
            rename_provider: outlines.map(|_| renames(client)),
            execute_command_provider: Some(ExecuteCommandOptions {
                commands: COMMANDS.map(str::to_owned).to_vec(),
                ..ExecuteCommandOptions::default()
            }),
            inlay_hint_provider: Some(true.into()),
            diagnostic_provider: client.pulls_diagnostics().then(diagnostics),
            workspace: Some(WorkspaceOptions {
                workspace_folders: Some(WorkspaceFoldersServerCapabilities::default()),
                text_document_content: Some(TextDocumentContent::Options(
                    TextDocumentContentOptions::new(vec![SCHEME.to_owned()]),
                )),
                ..WorkspaceOptions::default()
            }),
            ..ServerCapabilities::default()
        },
        server_info: Some(ServerInfo {
            name: "frictcomp".to_owned(),
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        }),
    }
}

/// Returns the support for requests for messages: those on a text depend on others.
fn diagnostics() -> DiagnosticProvider {
    let options = DiagnosticOptions {
        inter_file_dependencies: true,
        ..DiagnosticOptions::default()
    };
    options.into()
}

/// Returns the support for renaming; a client with the ability is told first whether there is a
/// name.
fn renames(client: &LspClient) -> RenameProvider {
    if client.prepares_renames() {
        let options = RenameOptions {
            prepare_provider: Some(true),
            ..RenameOptions::default()
        };
        options.into()
    } else {
        true.into()
    }
}
