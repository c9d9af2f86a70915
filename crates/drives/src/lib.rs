//! Reads what ENI and ESI files say about the torque interfaces of drives.
//!
//! It takes the text of a file and returns the [`Network`](frictcomp::drive_interface::Network) of an ENI
//! file or the [`Device`](frictcomp::drive_interface::Device)s of an ESI file, from which
//! [`check_drive`](frictcomp::drive_interface::check_drive) judges whether the torque reaches the drive.
//!
//! ```
//! use frictcomp::text::SourceFile;
//! use frictcomp_drives::read_network;
//!
//! let eni = "<EtherCATConfig><Config><Slave><Info><Name>Drive 1</Name></Info></Slave></Config></EtherCATConfig>";
//! let network = read_network(&SourceFile::new("line.xml", eni))?;
//! assert_eq!(network.slaves.len(), 1);
//! # Ok::<(), frictcomp_drives::XmlError>(())
//! ```

mod xml;

pub use xml::{XmlError, read_devices, read_network};
