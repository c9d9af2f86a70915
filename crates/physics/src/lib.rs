//! The motion of the axes in a CNC program, in numbers.
//!
//! The inputs are the records of a [session](frictcomp::session::Session), the parameters of a machine, and a plant. A
//! [`motion::TrajectoryPlanner`] turns records into commanded traces, and a [`current::AdditiveCurrent`]
//! traces into the currents that friction compensation adds; [`currents`] does both. On feed drives with
//! friction ([`simulation`]), [`circle`] simulates and judges circular tests, and [`contour`] drives a
//! program. [`compare`] compares two versions of a program, and [`stiction`] has the formulas of
//! Heidenhain's stiction compensation.
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use frictcomp::{machine::Machine, text::SourceFile};
//! use frictcomp_physics::current::CurrentCycle;
//!
//! let machine = r#"
//! [[axis]]
//! name = "X"
//! frict_comp = true
//! value = { mode = 3, table = [[0, 126], [3000, 112]] }
//! "#;
//! let program = SourceFile::new("a.nc", "N10 G01 X0 F1500\nN20 X5\nN30 X0\nN40 M30\n");
//! let mut most = 0.0_f64;
//! let sink = |cycle: &CurrentCycle<'_>| {
//!     most = most.max(cycle.axes[0].added.current_units);
//!     ControlFlow::Continue(())
//! };
//! frictcomp_physics::currents(program, Machine::from_toml(machine)?, &["X".to_owned()], sink)?;
//! assert!(most > 100.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod circle;
pub mod compare;
pub mod contour;
pub mod current;
mod currents;
pub mod linear;
pub mod motion;
pub mod simulation;
pub mod stiction;

pub use currents::currents;
