//! What ENI and ESI files say of the torque interfaces of drives.
//!
//! The text of a file goes in; the [`Network`](frictcomp::drive_interface::Network) of an ENI or the
//! [`Device`](frictcomp::drive_interface::Device)s of an ESI come out, which
//! [`check_drive`](frictcomp::drive_interface::check_drive) judges.

mod xml;

pub use xml::{XmlError, read_devices, read_network};
