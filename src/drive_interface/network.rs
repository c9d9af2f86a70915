//! Torque values in network and device descriptions (R7.3, R7.4).

use std::sync::Arc;

use super::signal::Signal;
use crate::text::{Place, Span};

/// An element of an XML file that maps a torque value.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct NetworkObject {
    /// The value.
    pub signal: Signal,
    /// The axis of the device, from 1.
    pub channel: u8,
    /// The index of the process data object that holds it.
    pub pdo: u16,
    /// Name of that object.
    pub pdo_name: String,
    /// The path of the element in the file.
    pub path: String,
    /// Its line, from 1.
    pub line: u32,
}

/// A command of the start-up of a device that switches on its own friction compensation (R7.10).
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct OwnFriction {
    /// The axis of the device, from 1.
    pub channel: u8,
    /// The object that it writes, `3144:02`.
    pub object: String,
    /// The path of the element in the file.
    pub path: String,
    /// Its line, from 1.
    pub line: u32,
}

/// Protocol of a device, which decides the numbers of its process data.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Protocol {
    /// `CANopen` over `EtherCAT`: objects.
    #[default]
    CanOpen,
    /// SERCOS over `EtherCAT`: IDNs.
    Sercos,
}

/// A device of the network.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Slave {
    /// Name given by the engineer.
    pub name: String,
    /// The number of the vendor.
    pub vendor: Option<u32>,
    /// The number of the product.
    pub product: Option<u32>,
    /// Protocol for parameters.
    pub protocol: Protocol,
    /// Number of axes it drives; 0 for a device that is not a drive.
    pub axes: u8,
    /// Whether the file lists the process data objects that it exchanges.
    pub assigns: bool,
    /// The torque values that it exchanges in every cycle.
    pub mapped: Vec<NetworkObject>,
    /// What its start-up writes that compensates friction in the device.
    pub own_friction: Vec<OwnFriction>,
    /// The path of its element in the file.
    pub path: String,
    /// The line of that element, from 1.
    pub line: u32,
}

/// The network as it is configured, from an ENI file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Network {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// Its devices in the order of the file.
    pub slaves: Vec<Slave>,
}

/// A device that an ESI file describes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Device {
    /// Its type, such as `AX5103-0000`.
    pub name: String,
    /// The number of the vendor.
    pub vendor: Option<u32>,
    /// The number of the product, or of the module.
    pub product: Option<u32>,
    /// The torque values that it could exchange.
    pub mappable: Vec<NetworkObject>,
}

impl Network {
    /// Returns the devices that drive axes.
    pub fn drives(&self) -> impl Iterator<Item = &Slave> {
        self.slaves.iter().filter(|slave| slave.axes > 0)
    }

    /// Returns a place in the file, shown as the path of an element.
    pub(super) fn place(&self, path: &str, line: u32) -> Place {
        Place {
            file: Arc::clone(&self.file),
            text: path.into(),
            first_line: line,
            span: Span::new(0, path.len()),
        }
    }
}

impl Slave {
    /// Whether it is of a series that can compensate friction by itself, by its name (AX8000, AMP8000).
    pub(super) fn may_compensate(&self) -> bool {
        ["AX8", "AMP8"]
            .iter()
            .any(|series| self.name.contains(series))
    }

    /// Returns the element that maps a value for one of its axes.
    pub(super) fn maps(&self, signal: Signal, channel: u8) -> Option<&NetworkObject> {
        let is_it = |object: &&NetworkObject| object.signal == signal && object.channel == channel;
        self.mapped.iter().find(is_it)
    }
}
