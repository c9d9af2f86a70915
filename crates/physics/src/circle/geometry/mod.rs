//! A circle and its paths: commanded, crossed by the axes, measured over the angle.

mod centre;
mod crossing;
mod direction;
mod drift;
mod profile;
mod quality;
mod reference;
mod turning;
mod window;
mod zone;

pub use centre::{PathCentre, UnknownPathCentre};
pub use crossing::{Crossing, PlaneAxis};
pub use direction::Direction;
pub(crate) use drift::CircleDrift;
pub use profile::{ANGLES, RadialProfile, UM_PER_M};
pub(crate) use profile::{Gap, Gatherer, PER_DEGREE, ProfilePoint, Quality};
pub(crate) use quality::quality;
pub(crate) use reference::CircleArc;
pub use reference::{Circle, CircleError, MAX_STEPS, MIN_CYCLES, TURNS};
pub(crate) use turning::CosineSine;
pub(crate) use window::CrossingWindow;
pub(crate) use zone::{least_squares, minimum_zone, zone_about};
