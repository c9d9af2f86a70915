//! The machine: its axes and their parameters, whatever their source.

mod axis;
mod channels;
mod check;
mod configuration;
mod description;
mod loader;
mod programs;
mod project;
mod startup;

pub use axis::AxisReport;
pub use axis::{Axis, Parameterisation};
pub use channels::ChannelsOfAxis;
pub use check::{AcceptedList, ListsReport, check_configuration, check_list};
pub use configuration::Configuration;
pub use description::HarmlessWords;
pub use description::{AxisSet, GantrySlave, Machine, Outline, Parameters, Setting};
pub use loader::EmbeddedLists;
pub use loader::{ListFiles, NoList, NoLists};
pub(crate) use programs::canonical_word;
pub use programs::{ConfiguredPrograms, Keeps};
