//! Language server and debug adapter for programs, lists and configurations.
//!
//! [`lsp`] is the language server, which shows messages, states and fixes while one types; [`dap`] is the
//! debug adapter, which executes a program block by block. Both are given where they read and write:
//!
//! ```no_run
//! let farewell = frictcomp_editor::lsp::serve_stdio()?;
//! # let _ = farewell;
//! # Ok::<(), std::io::Error>(())
//! ```

pub mod dap;
pub mod lsp;
