//! The drive type of an axis, P-AXIS-00020 (R7.6).

use serde::Serialize;

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

    /// Whether friction compensation is available with it (P-AXIS-00522).
    pub fn compensates_friction(self) -> bool {
        matches!(self, Self::Sercos | Self::CanOpen)
    }

    /// Whether no drive exists that could take a torque.
    pub fn is_without_drive(self) -> bool {
        matches!(self, Self::Simulation | Self::Virtual)
    }

    /// Whether it takes a static torque offset (P-AXIS-00324).
    pub(super) fn takes_torque_offset(self) -> bool {
        matches!(self, Self::Sercos | Self::Lightbus | Self::CanOpen)
    }

    /// Returns the vendor's words, for a "did you mean".
    pub(super) fn words() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|row| row.word)
    }
}
