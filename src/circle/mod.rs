//! The circular test: two simulated feed drives on a circle, with friction compensation off and
//! on, and the figures of ISO 230-4 (chapters 5.2 and 5.3 of the rules).
//!
//! A [`Plant`] has two drives; a [`CircularTest`] sends them round a [`Circle`] in both directions
//! and gives the [`Figures`].

mod default_list;
mod drive;
mod figures;
mod friction;
mod glitch;
mod plant;
mod profile;
mod reference;
mod simulate;
mod test;
mod zone;

pub use default_list::plant_list;
pub use drive::{Drive, DriveParameters, POSITION_LOOP, SPEED_LOOP, Setpoint};
pub use figures::{Centre, Figures, PathFigures, Paths};
pub use friction::{Friction, FrictionModel, GmsElement, STEP};
pub use glitch::{Crossing, Glitch};
pub use plant::{PEAK, Plant, Preset, RATED_FORCE};
pub use profile::{ANGLES, Profile};
pub use reference::{Circle, CircleError, Direction, MAX_STEPS, MIN_CYCLES, TURNS};
pub use test::{CircularTest, Compensation, Job, Lap, Outcome, Side};
