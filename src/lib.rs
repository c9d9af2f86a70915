//! Dry runs of ISG and TwinCAT CNC programs with an eye on friction compensation.
//!
//! A program switches friction compensation per axis with `X[COMP ON FRICT]`, and the state
//! outlives the program. This crate executes programs without a machine and says for every block
//! what it changed and which axis has friction compensation active after it.
//!
//! A host with an interpreter of its own needs only [`syntax::parse_comp`] and
//! [`comp::Compensation`]:
//!
//! ```
//! use frictcomp::machine::Machine;
//! use frictcomp::syntax::parse_comp;
//!
//! let machine = Machine::enabled(["X"]);
//! let mut compensation = machine.compensation();
//! let changes = compensation.apply(&parse_comp("X[COMP OFF FRICT]")?)?;
//! assert_eq!(changes[0].to.as_str(), "inactive");
//! let refused = compensation.apply(&parse_comp("Y[COMP ON FRICT]")?).unwrap_err();
//! assert_eq!(refused.code().text(), "P-ERR-70495");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`run`], [`check`] and [`currents`] are the questions that most hosts ask.
//! [`interpreter::Interpreter`] runs a program block by block and can be saved and resumed;
//! [`session::Session`] runs programs one after the other, with lints, and gives the records of
//! [`timeline`], of which a [`motion::TrajectoryPlanner`] makes commanded traces and a
//! [`current::AdditiveCurrent`] currents. A [`machine::Machine`] comes from the control's lists or
//! from `frictcomp.toml`.
//!
//! The library opens no file, prints nothing and reads neither clock nor environment: texts are
//! handed to it. The feature `report` adds formats and pictures, `host` what touches files and
//! threads. The command line, the feature `cli`, is on by default.

pub mod circle;
#[cfg(feature = "cli")]
pub mod cli;
pub mod comp;
#[cfg(feature = "toml")]
mod config;
pub mod current;
pub mod diagnostic;
mod facade;
#[cfg(feature = "host")]
pub mod host;
pub mod interpreter;
mod lint;
pub mod lists;
pub mod machine;
pub mod motion;
#[cfg(feature = "report")]
pub mod report;
pub mod session;
pub mod simulation;
pub mod syntax;
pub mod text;
pub mod timeline;

pub use facade::{check, currents, run};
