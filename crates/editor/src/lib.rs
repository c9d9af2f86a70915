//! What editors show of programs, lists and configurations: a language server, [`lsp`], and a debug adapter,
//! [`dap`].

pub mod dap;
pub mod lsp;
