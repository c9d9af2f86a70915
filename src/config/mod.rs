//! The files that users of frictcomp write, `frictcomp.toml` and plant files, as data with the
//! place of every key. What the data mean for a machine or a plant is said in those rooms.

#[cfg(feature = "toml")]
mod advice;
#[cfg(feature = "toml")]
mod axis;
#[cfg(feature = "toml")]
mod error;
#[cfg(feature = "toml")]
mod file;
#[cfg(feature = "toml")]
mod machine;
#[cfg(feature = "toml")]
mod plant;
#[cfg(feature = "toml")]
mod plant_keys;
#[cfg(feature = "toml")]
mod section;
mod setting;

#[cfg(feature = "toml")]
pub(crate) use axis::AxisTable;
#[cfg(feature = "toml")]
pub use error::ConfigError;
#[cfg(feature = "toml")]
pub(crate) use file::ConfigFile;
#[cfg(feature = "toml")]
pub(crate) use machine::MachineTable;
#[cfg(feature = "toml")]
pub(crate) use plant::{DriveTable, PlantFile};
#[cfg(feature = "toml")]
pub(crate) use plant_keys::Quantity;
pub use setting::Setting;
