//! Machines of their own for tests: they execute measuring programs and are recorded, with every fault as a
//! parameter. They share no code with the packages that they test; only a [`PresetMachine`] is made of the drives of
//! the physics.
//!
//! A [`Program`] is read as text, a [`Control`] turns it into commanded positions with ramps of its own and adds
//! the current of a [`ValueList`], an [`Axis`] follows them in steps of 31.25 µs, and a [`Recorder`] writes what
//! a recording would hold.
//!
//! The [`generator`] makes NC programs of any kind, for tests and fuzzers. [`recorded_drive`] and [`recorded_circles`]
//! are recordings of a single axis, [`layouts`] the files that controls write, [`svg`] reads pictures, [`table`] holds a table of a document, and
//! [`measure`] times the work of a benchmark.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "rows, cycles and times of recordings that the tests make themselves"
)]

pub mod generator;
pub mod layouts;
pub mod measure;
pub mod recorded_circles;
pub mod recorded_drive;
pub mod svg;
pub mod table;

mod axis;
mod control;
mod glitches;
mod guide;
mod list;
mod machine;
mod plan;
mod preset_machine;
mod program;
mod ramp;
mod random;
mod recorder;
mod search;
mod stand_ins;

pub use axis::{Axis, Coupling};
pub use control::{Commanded, Control};
pub use glitches::{TrueGlitches, true_glitches};
pub use guide::{Guide, Presliding};
pub use list::ValueList;
pub use machine::{Machine, Run};
pub use plan::planned_circles;
pub use preset_machine::{PITCH_MM, PresetMachine, Row};
pub use program::{Move, Program};
pub use ramp::Ramp;
pub use random::Random;
pub use recorder::Recorder;
