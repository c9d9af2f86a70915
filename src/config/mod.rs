//! The files that users of frictcomp write, `frictcomp.toml` and plant files, as data with the
//! place of every key. What the data mean for a machine or a plant is said in those rooms.

mod advice;
mod axis;
mod error;
mod file;
#[cfg(feature = "lsp")]
mod keys;
mod machine;
mod one_more_axis;
mod plant;
mod plant_keys;
mod section;

#[cfg(feature = "lsp")]
pub(crate) use advice::example;
pub(crate) use axis::AxisTable;
pub use error::ConfigError;
pub(crate) use file::{ConfigFile, Variable};
#[cfg(feature = "lsp")]
pub(crate) use keys::keys;
pub(crate) use machine::MachineTable;
pub(crate) use plant::{DriveTable, PlantFile, StictionTable};
pub(crate) use plant_keys::{Quantity, StictionKey};
