//! The machine of a program, its lists, and where its programs find others.

mod allowed_roots;
mod assumed;
mod axes_ahead;
mod both_versions;
mod discovery;
mod finder;
mod list_files;
mod parameter_files;

pub use allowed_roots::{AllowedRoots, OutsidePolicy};
pub use assumed::UnusedAxes;
pub(crate) use axes_ahead::AxesAhead;
pub use axes_ahead::switched_axes;
pub use both_versions::{MachineOfVersions, MachineOwner};
pub use discovery::{ConfigurationChoice, LoadedMachine, MachineOptions, Machines, nearest_config};
pub use finder::{ProgramFinder, SearchPath};
pub use list_files::{ListsOnDisk, read_list};
pub use parameter_files::{check_list_file, find_plant, is_configuration, read_value_list};
