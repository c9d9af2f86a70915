//! Dry runs of ISG and TwinCAT CNC programs with an eye on friction compensation.
//!
//! A program switches friction compensation per axis with `X[COMP ON FRICT]`, and the state outlives the program. This
//! crate executes programs without a machine and reports for every block what it changed and which axes have friction
//! compensation active after it.
//!
//! # COMP commands alone
//!
//! A host with its own interpreter passes on the COMP commands that it meets, and gets the
//! changes or the control's own error:
//!
//! ```
//! use frictcomp::machine::Machine;
//! use frictcomp::syntax::parse_comp;
//!
//! let machine = Machine::enabled(["X"]);
//! let mut compensation = machine.compensation();
//! if let Some(command) = parse_comp("X[COMP OFF FRICT]")? {
//!     let changes = compensation.apply(&command)?;
//!     assert_eq!(changes[0].to.as_str(), "inactive");
//! }
//! let command = parse_comp("Y[COMP ON FRICT]")?.expect("a COMP command");
//! let refused = compensation.apply(&command).unwrap_err();
//! assert_eq!(refused.code().as_str(), "P-ERR-70495");
//! assert_eq!(parse_comp("V.E.OFFSET[2]")?, None);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The messages about a program
//!
//! [`check`] executes a text as a program. The remedy for a message is data, so that a host can offer it in its own
//! way: [`Advice`](diagnostic::Advice) in words, a [`Fix`](diagnostic::Fix) as a change to the text.
//!
//! ```
//! use frictcomp::diagnostic::Fixed;
//! use frictcomp::interpreter::NoFiles;
//! use frictcomp::machine::Machine;
//! use frictcomp::session::SessionOptions;
//! use frictcomp::text::SourceFile;
//!
//! let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRIKT]\nN20 M30\n");
//! let (machine, options) = (Machine::enabled(["X"]), SessionOptions::default());
//! let findings = frictcomp::check(program.clone(), machine, options, &mut NoFiles);
//! let said = findings.diagnostics().next().expect("a misspelt kind");
//! assert_eq!(said.code.as_str(), "FC202");
//! assert_eq!(said.help(), ["did you mean `FRICT`?"]);
//! let fixed = Fixed::new(&program, &said.fixes);
//! assert_eq!(fixed.text, "N10 X[COMP OFF FRICT]\nN20 M30\n");
//! ```
//!
//! # Programs one after the other
//!
//! A [`Session`](session::Session) keeps the state from program to program and passes the [records](timeline) of what
//! happens to a [`Sink`](timeline::Sink), for example a closure:
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use frictcomp::interpreter::NoFiles;
//! use frictcomp::machine::Machine;
//! use frictcomp::session::{Program, Session, SessionOptions};
//! use frictcomp::text::SourceFile;
//! use frictcomp::timeline::Record;
//!
//! let mut session = Session::new(Machine::enabled(["X"]), SessionOptions::default());
//! let mut changes = Vec::new();
//! let mut sink = |record: &Record<'_>| {
//!     if let Record::Block(row) = record {
//!         changes.extend(row.changes.iter().map(|change| (row.line, change.to.as_str())));
//!     }
//!     ControlFlow::Continue(())
//! };
//! for (name, text) in [("a.nc", "X[COMP OFF FRICT]\nM30"), ("b.nc", "X[COMP ON FRICT]\nM30")] {
//!     let program = Program::Whole(SourceFile::new(name, text));
//!     let _ = session.program(name, program, &mut NoFiles, &mut sink);
//! }
//! assert_eq!(changes, [(1, "inactive"), (1, "active")]);
//! ```
//!
//! # More
//!
//! [`interpreter::Interpreter`] runs a program block by block, and can be stopped, saved and resumed.
//! A [`Machine`](machine::Machine) comes from the control's lists or from `frictcomp.toml`.
//!
//! The library opens no file, prints nothing and reads neither clock nor environment: texts are passed to it. Its users
//! are separate packages: `frictcomp-physics` turns the records of a session into commanded traces and currents and
//! simulates circular tests, `frictcomp-recordings` reads recorded traces, `frictcomp-report` has the formats and
//! pictures, `frictcomp-host` touches files and threads, and `frictcomp-cli` is the command. Items that the feature
//! `unstable` exposes may change with every version.

#[macro_use]
mod words;

/// The examples of the README of the package.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
mod readme {}

pub mod audit;
pub mod comp;
pub mod config;
pub mod diagnostic;
pub mod documents;
pub mod drive_interface;
mod facade;
pub mod interpreter;
mod language;
mod lint;
pub mod lists;
pub mod machine;
pub mod readings;
pub mod session;
pub mod syntax;
pub mod text;
pub mod timeline;

pub use facade::{check, run};
pub use language::{ControlError, ControlErrorCheck};
