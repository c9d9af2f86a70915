//! The circular test of simulated drives, without compensation and with it.

mod compare;
mod lap;
mod method;
mod simulate;
mod test;

pub use compare::{Comparison, Side};
pub use lap::{Lap, LapRun};
pub use method::Method;
pub(crate) use simulate::{AxesSimulation, AxisRun};
pub use test::CircularTest;
