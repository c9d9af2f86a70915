//! The language server from the client's point of view.

#[path = "lsp/calls.rs"]
mod calls;
#[path = "lsp/contour.rs"]
mod contour;
#[path = "lsp/fixes.rs"]
mod fixes;
mod folder;
#[path = "lsp/healing.rs"]
mod healing;
#[path = "lsp/lifecycle.rs"]
mod lifecycle;
#[path = "lsp/client.rs"]
mod lsp_client;
#[path = "lsp/messages.rs"]
mod messages;
#[path = "lsp/pulled.rs"]
mod pulled;
#[path = "lsp/scripts.rs"]
mod scripts;
#[path = "lsp/shown.rs"]
mod shown;
#[path = "lsp/typing.rs"]
mod typing;
mod workspace;
