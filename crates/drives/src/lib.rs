//! What ENI and ESI files say about the torque interfaces of drives.
//!
//! In goes the text of a file; out come the [`Network`](frictcomp::drive_interface::Network) of an ENI
//! or the [`Device`](frictcomp::drive_interface::Device)s of an ESI, by which
//! [`check_drive`](frictcomp::drive_interface::check_drive) judges whether the torque reaches the drive.
//!
//! ```
//! use frictcomp::SourceFile;
//! use frictcomp_drives::read_network;
//!
//! let eni = "<EtherCATConfig><Config><Slave><Info><Name>Drive 1</Name></Info></Slave></Config></EtherCATConfig>";
//! let network = read_network(&SourceFile::new("line.xml", eni))?;
//! assert_eq!(network.slaves.len(), 1);
//! # Ok::<(), frictcomp_drives::XmlError>(())
//! ```

mod xml;

pub use xml::{XmlError, read_devices, read_network};
