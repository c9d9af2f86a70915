//! Dry runs of ISG and TwinCAT CNC programs with an eye on friction compensation.

#[cfg(feature = "cli")]
pub mod cli;
pub mod codes;
pub mod compensation;
pub mod current;
pub mod diagnostic;
pub mod interpreter;
mod lint;
pub mod lists;
pub mod machine;
#[cfg(feature = "cli")]
pub mod report;
pub mod session;
pub mod source;
pub mod syntax;
pub mod timeline;
