//! The language server, as a client sees it.

#![cfg(feature = "lsp")]

mod folder;
#[path = "lsp/lifecycle.rs"]
mod lifecycle;
#[path = "lsp/client.rs"]
mod lsp_client;
#[path = "lsp/messages.rs"]
mod messages;
#[path = "lsp/shown.rs"]
mod shown;
