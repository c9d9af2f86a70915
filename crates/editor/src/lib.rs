//! Language server and debug adapter for programs, lists and configurations.
//!
//! [`lsp`] is the language server, which shows messages, states and fixes as the user types; [`dap`] is
//! the debug adapter, which executes a program block by block. The caller provides input and output:
//!
//! ```no_run
//! let farewell = frictcomp_editor::lsp::serve_stdio()?;
//! # let _ = farewell;
//! # Ok::<(), std::io::Error>(())
//! ```

pub mod dap;
pub mod lsp;
