//! Simulated feed drives with friction (chapter 5.2 of the rules).
//!
//! A [`Plant`] has two [`DriveParameters`]. A [`Drive`] is one of them in motion: position loop,
//! speed loop, current loop, moved mass and a contact with [`Friction`]; [`Drives`] take several
//! through a CNC cycle. Nothing here depends on the driven path or on how it is judged.
//!
//! All quantities are in SI units, and the names of public numbers end in theirs.

mod clock;
mod coupling;
mod drive;
mod drives;
mod friction;
mod from_file;
mod parameters;
mod plant;
mod plant_file;
mod plant_keys;
mod plant_list;
mod stiction;
mod to_file;

pub use clock::{POSITION_LOOP_S, SPEED_LOOP_S, STEP_S};
pub use drive::{Drive, Setpoint};
pub use drives::Drives;
pub use friction::{Friction, FrictionModel, GmsElement, UnknownFrictionModel};
pub use parameters::{DriveParameters, PEAK_FORCE, RATED_FORCE_N};
pub use plant::{Plant, Preset, UnknownPreset};
pub use plant_keys::PLANT_FORMS;
pub use plant_list::plant_list;
pub(crate) use plant_list::plant_list_at;
