//! The machine: its axes and their parameters, whatever their source.

mod assemble;
mod axis;
mod check;
mod configuration;
mod described;
mod description;
mod embedded;
mod files;
mod from_toml;
mod gantry;
mod harmless;
mod loader;
mod missing;
mod outline;
mod programs;
mod project;
mod setting;
mod startup;
mod value_list;

pub use assemble::AxisReport;
pub use axis::{Axis, Parameterisation};
pub use check::check_configuration;
pub use check::{AcceptedList, ListsReport, check_list};
pub use configuration::Configuration;
pub use description::{AxisSet, GantrySlave, Machine, Parameters};
pub use embedded::EmbeddedLists;
pub use files::{ListFiles, NoList, NoLists};
pub use harmless::HarmlessWords;
pub use outline::Outline;
pub(crate) use programs::canonical_word;
pub use programs::{ConfiguredPrograms, Keeps};
pub use setting::Setting;
