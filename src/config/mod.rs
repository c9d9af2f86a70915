//! The file that users of frictcomp write, `frictcomp.toml`, as data with the place of every key. The machine module
//! gives the data their meaning. Packages of the same version read their own files with the same tables.

// Without the feature, the items that only they see are in effect private.
#![cfg_attr(not(feature = "unstable"), allow(unreachable_pub, dead_code))]

mod file;
mod forms;
mod machine;
mod section;

pub(crate) use file::{ConfigFile, ConfiguredVariable};
#[cfg(feature = "unstable")]
pub use forms::{CONFIG_FORMS, Form, KeyForm, TableForm};
pub(crate) use machine::AxisTable;
pub(crate) use machine::MachineTable;
pub use section::ConfigError;
#[cfg(feature = "unstable")]
pub use section::example;
#[cfg(feature = "unstable")]
pub use section::{Section, Shape, keys};
