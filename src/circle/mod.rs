//! The circular test: two simulated feed drives on a circle, with friction compensation off and
//! on, and the figures of ISO 230-4 (chapters 5.2 and 5.3 of the rules).
//!
//! A [`Plant`] has two drives; a [`CircularTest`] sends them round a [`Circle`] in both directions
//! and gives the [`Figures`].

mod advice;
mod default_list;
mod drive;
mod figures;
mod friction;
mod glitch;
mod plant;
#[cfg(feature = "toml")]
mod plant_file;
mod profile;
mod recorded;
mod reference;
mod simulate;
mod test;
mod tune;
mod zone;

pub use advice::{Advice, Finding, NOTICEABLE, Place, advise, advise_on};
pub use default_list::plant_list;
pub use drive::{Drive, DriveParameters, POSITION_LOOP, SPEED_LOOP, Setpoint};
pub use figures::{Figures, PathFigures, Paths};
pub use friction::{Friction, FrictionModel, GmsElement, STEP};
pub use glitch::{Crossing, Glitch};
pub use plant::{PEAK, Plant, Preset, RATED_FORCE};
pub use profile::{ANGLES, Profile};
pub use recorded::{MIN_POINTS, RecordedCircle, RecordedError, Recording};
pub use reference::{Circle, CircleError, Direction, MAX_STEPS, MIN_CYCLES, TURNS};
pub use test::{CircularTest, Compensation, Job, Lap, Outcome, Side};
pub use tune::{Candidate, FeedResult, Ranges, Search, Task, Tuned, Variant, tune};
