//! The machine: its axes and their parameters, whatever their source.

mod assemble;
mod axis;
mod check;
mod configuration;
mod description;
mod embedded;
mod files;
mod from_toml;
mod harmless;
mod loader;
mod programs;
mod project;
mod startup;

pub use assemble::AxisReport;
pub use axis::{Axis, Parameterisation};
pub use check::{AcceptedList, ListsReport, check_configuration, check_list};
pub use configuration::Configuration;
pub use description::{AxisSet, GantrySlave, Machine, Outline, Parameters, Setting};
pub use embedded::EmbeddedLists;
pub use files::{ListFiles, NoList, NoLists};
pub use harmless::HarmlessWords;
pub(crate) use programs::canonical_word;
pub use programs::{ConfiguredPrograms, Keeps};
