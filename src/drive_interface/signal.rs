//! The two torque values of the drive's cyclic data, their names (R7.1 to R7.3), and what network and device descriptions say
//! of them (R7.3, R7.4); the drive type of an axis, P-AXIS-00020 (R7.6).

use std::sync::Arc;

use serde::Serialize;

use crate::text::{Place, Span};

/// Distance between the `CANopen` objects of two successive axes of a device.
const PER_CHANNEL: u16 = 0x800;

/// The objects of drives; there is room for eight axes.
const DRIVE_OBJECTS: std::ops::RangeInclusive<u16> = 0x6000..=0x9FFF;

/// Bits of an IDN that give the number of its data block. The top bit marks IDNs that the
/// manufacturer defines; the bits between choose a parameter set.
const IDN_NUMBER: u16 = 0x0FFF;
const IDN_OF_MANUFACTURER: u16 = 0x8000;

crate::words! {
    /// A torque value of the cyclic data.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
    #[serde(rename_all = "snake_case")]
    #[non_exhaustive]
    pub enum Signal {
        /// The additive torque command, which friction compensation needs: S-0-0081, 60B2h.
        AdditiveTorque = "additive torque command",
        /// The actual torque, by which friction is measured and verified: S-0-0084, 6077h.
        ActualTorque = "actual torque",
    }
}

impl Signal {
    /// Returns its number in SERCOS.
    pub fn idn(self) -> u16 {
        match self {
            Self::AdditiveTorque => 81,
            Self::ActualTorque => 84,
        }
    }

    /// Returns its object in `CANopen`, for the first axis of a device.
    pub fn object(self) -> u16 {
        match self {
            Self::AdditiveTorque => 0x60B2,
            Self::ActualTorque => 0x6077,
        }
    }

    /// Returns the axis of a device whose object this is, from 1.
    pub fn channel(self, index: u16) -> Option<u8> {
        channel(self.object(), index)
    }

    /// Returns whether this is its IDN, in any parameter set.
    pub fn is_idn(self, idn: u16) -> bool {
        idn & IDN_OF_MANUFACTURER == 0 && idn & IDN_NUMBER == self.idn()
    }

    /// Returns the names in `nc_ref` besides the number (P-AXIS-00131, R7.2).
    fn words(self) -> &'static [&'static str] {
        match self {
            Self::AdditiveTorque => &[],
            Self::ActualTorque => &[
                "TORQUE_FEEDBACK",
                "TORQUE_FEEDBACK_VALUE",
                "MOMENT_IST_WERT",
                "STROMIST_WERT",
                "TORQUE_ACT",
            ],
        }
    }

    /// Returns whether an `nc_ref` names it.
    pub(super) fn is_reference(self, reference: &str) -> bool {
        self.words().contains(&reference)
            || idn(reference).is_some_and(|idn| self.is_idn(idn))
            || object(reference).is_some_and(|index| self.channel(index).is_some())
    }
}

/// Returns whether an `nc_ref` names the torque command itself, which is not the additive one (R7.1).
pub(super) fn is_torque_command(reference: &str) -> bool {
    matches!(reference, "TORQUE_COMMAND_VALUE" | "MOMENT_SOLL_WERT")
        || idn(reference).is_some_and(|idn| idn == 80)
        || object(reference).is_some_and(|index| channel(0x6071, index).is_some())
}

/// Returns the axis, from 1, that object `index` of a device belongs to; `first` is the object of
/// its first axis.
pub fn channel(first: u16, index: u16) -> Option<u8> {
    let above = index.checked_sub(first)?;
    let is_one = above % PER_CHANNEL == 0 && DRIVE_OBJECTS.contains(&index);
    is_one.then(|| u8::try_from(above / PER_CHANNEL + 1).ok())?
}

/// Returns the number of an IDN written as `S-0-0081` or `S_0_0081`.
fn idn(reference: &str) -> Option<u16> {
    let rest = reference.strip_prefix(['S', 's'])?;
    let mut parts = rest.strip_prefix(['-', '_'])?.split(['-', '_']);
    let (set, number) = (parts.next()?, parts.next()?);
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    if parts.next().is_some() || !is_number(set) || !is_number(number) {
        return None;
    }
    let (set, number): (u16, u16) = (set.parse().ok()?, number.parse().ok()?);
    (set < 8 && number <= IDN_NUMBER).then_some(set << 12 | number)
}

/// Returns the object written as `60B2_00`.
fn object(reference: &str) -> Option<u16> {
    let (index, sub) = reference.split_once('_')?;
    let is_whole = index.len() == 4 && matches!(sub, "00" | "0");
    is_whole.then(|| u16::from_str_radix(index, 16).ok())?
}

/// The drive type of an axis, P-AXIS-00020 (`kenngr.antr_typ`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DriveType {
    /// Conventional interface, 1.
    Conventional,
    /// SERCOS, 2.
    Sercos,
    /// `PROFIdrive` MC, 3.
    Profidrive,
    /// Simulation, 4; the control's default if no list gives a type.
    Simulation,
    /// Lightbus, 5.
    Lightbus,
    /// ±10 V over a field bus, 6.
    Terminal,
    /// Real-time Ethernet, 7.
    RealTimeEthernet,
    /// `CANopen`, 8.
    CanOpen,
    /// Virtual axis, 16.
    Virtual,
    /// CAN bus, 32.
    CanBus,
}

/// Names of a drive type.
struct DriveTypeNames {
    drive_type: DriveType,
    number: i64,
    /// The word for the number (TwinCAT CNC axis parameters, table 3-1).
    word: &'static str,
    name: &'static str,
}

const fn names(
    drive_type: DriveType,
    number: i64,
    word: &'static str,
    name: &'static str,
) -> DriveTypeNames {
    DriveTypeNames {
        drive_type,
        number,
        word,
        name,
    }
}

/// P-AXIS-00020.
const NAMES: [DriveTypeNames; 10] = [
    names(DriveType::Conventional, 1, "ANTR_TYP_KONV", "conventional"),
    names(DriveType::Sercos, 2, "ANTR_TYP_SERCOS", "SERCOS"),
    names(
        DriveType::Profidrive,
        3,
        "ANTR_TYP_PROFIDRIVE",
        "PROFIdrive MC",
    ),
    names(DriveType::Simulation, 4, "ANTR_TYP_SIMU", "simulation"),
    names(DriveType::Lightbus, 5, "ANTR_TYP_LIGHTBUS", "Lightbus"),
    names(
        DriveType::Terminal,
        6,
        "ANTR_TYP_TERM",
        "±10 V over a field bus",
    ),
    names(
        DriveType::RealTimeEthernet,
        7,
        "ANTR_TYP_ETHERNET",
        "real-time Ethernet",
    ),
    names(DriveType::CanOpen, 8, "ANTR_TYP_CANOPEN", "CANopen"),
    names(DriveType::Virtual, 16, "ANTR_TYP_VIRTUELL", "virtual axis"),
    names(DriveType::CanBus, 32, "ANTR_TYP_CAN", "CAN bus"),
];

impl DriveType {
    /// Returns the type of a list value, which is a number or the vendor's word for it.
    pub fn from_number(number: i64) -> Option<Self> {
        let row = NAMES.iter().find(|row| row.number == number)?;
        Some(row.drive_type)
    }

    /// Returns the type of the vendor's word.
    pub fn from_word(word: &str) -> Option<Self> {
        let row = NAMES.iter().find(|row| row.word == word)?;
        Some(row.drive_type)
    }

    /// Returns the common name.
    pub fn as_str(self) -> &'static str {
        let row = NAMES.iter().find(|row| row.drive_type == self);
        row.map_or("", |row| row.name)
    }

    /// Returns whether friction compensation is available with it (P-AXIS-00522).
    pub fn compensates_friction(self) -> bool {
        matches!(self, Self::Sercos | Self::CanOpen)
    }

    /// Returns whether no drive exists that could take a torque.
    pub fn is_without_drive(self) -> bool {
        matches!(self, Self::Simulation | Self::Virtual)
    }

    /// Returns whether it takes a static torque offset (P-AXIS-00324).
    pub(super) fn takes_torque_offset(self) -> bool {
        matches!(self, Self::Sercos | Self::Lightbus | Self::CanOpen)
    }

    /// Returns the vendor's words, for a "did you mean".
    pub(super) fn words() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|row| row.word)
    }
}

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
    /// Line, from 1.
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
    /// Line, from 1.
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
    /// Start-up commands that switch on friction compensation in the device itself.
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
    /// Devices in the order of the file.
    pub slaves: Vec<Slave>,
}

/// A device that an ESI file describes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Device {
    /// Type, such as `AX5103-0000`.
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
    /// Returns whether it is of a series that can compensate friction by itself, by its name (AX8000, AMP8000).
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
