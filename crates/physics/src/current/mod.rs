//! The additive current: the value that the control sends to the drive's torque interface in every CNC
//! cycle, from the commanded motion and the value list (chapter 4 of the rules).
//!
//! Positions are in 0.1 µm or 0.0001°, velocities in µm/s or 0.001°/s, as in the lists;
//! [`POSITION_UNITS_PER_MM`] and [`VELOCITY_UNITS_PER_MM_PER_S`] convert. Currents are in drive
//! units, a thousandth of the rated current of the drive.

mod additive;
mod columns;
mod cycles;
mod followers;
mod program;
mod reading;
mod recorded;
mod standstill;
mod units;

pub use additive::{Added, AdditiveCurrent, Switched};
pub use columns::TraceColumns;
pub use cycles::{CyclesError, Resampling};
pub use followers::{Commanded, CurrentSample, Followers};
pub use program::{
    CurrentCycle, CurrentOptions, CurrentSink, FollowError, ProgramCurrents, axes_to_follow,
};
pub use reading::{Below, ChosenOptions, Decay, Delay, Reading, Standstill, Start, UnknownReading};
pub use recorded::{CommandedRow, CommandedTrace, TraceOptions};
pub use standstill::{DeadBand, Standstills};
pub use units::{POSITION_UNITS_PER_MM, VELOCITY_UNITS_PER_MM_PER_S};
