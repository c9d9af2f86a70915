//! The drive's torque interface: whether the additive torque of friction compensation reaches the
//! drive, and whether the actual torque comes back (chapter 7).
//!
//! The evidence is used in this order: the axis list, the data that the network maps (ENI), the
//! data that the device could map (ESI). A value that none of them decides is unknown, never
//! assumed to be present.

mod judge;
mod settings;
mod signal;

pub use judge::{
    DriveReport, Evidence, IdleBy, ListedDrive, Presence, SlaveOfAxis, TorqueEvidence, check_drive,
};
pub use settings::{DriveSettings, TorqueScale};
pub use signal::{Device, Network, NetworkObject, OwnFriction, Protocol, Slave};
pub use signal::{DriveType, Signal, channel};
