//! Units of channels, and their conversion to the units of lists and traces.

use serde::Serialize;

frictcomp::words! {
    /// Quantity of a unit.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
    #[non_exhaustive]
    pub enum ChannelQuantity {
        /// Time in seconds.
        Time = "time",
        /// Position in 0.1 µm or 0.0001°.
        Position = "position",
        /// Velocity in µm/s or 0.001°/s.
        Velocity = "velocity",
        /// Torque in drive units, or in a unit that the drive measures.
        Torque = "torque",
    }
}

impl ChannelQuantity {
    /// Returns the unit in which the CNC records it, used if a file names none.
    pub fn own_unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Position => "0.1 µm or 0.0001°",
            Self::Velocity => "µm/s or 0.001°/s",
            Self::Torque => "drive units",
        }
    }

    /// Returns a usual unit of it, for an example.
    pub(crate) fn example(self) -> &'static str {
        match self {
            Self::Time => "ms",
            Self::Position => "mm",
            Self::Velocity => "mm/s",
            Self::Torque => "%",
        }
    }
}

/// The kind of motion of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[non_exhaustive]
pub enum AxisMotion {
    /// Along a line.
    Linear,
    /// Round an axis.
    Rotary,
}

/// A unit that a file names.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Unit {
    /// Quantity.
    pub quantity: ChannelQuantity,
    /// Factor to the units of lists and traces.
    pub factor: f64,
    /// Kind of motion that the unit measures, if it is one of lengths or of angles.
    pub motion: Option<AxisMotion>,
    /// Whether the result is in drive units; amperes, newtons and newton metres are not.
    pub is_of_the_drive: bool,
}

use AxisMotion::{Linear, Rotary};
use ChannelQuantity::{Position, Time, Torque, Velocity};

/// The units as [`plain`] writes them.
const UNITS: [(&str, ChannelQuantity, f64, Option<AxisMotion>); 50] = [
    ("s", Time, 1.0, None),
    ("ms", Time, 1e-3, None),
    ("us", Time, 1e-6, None),
    ("ns", Time, 1e-9, None),
    ("min", Time, 60.0, None),
    ("m", Position, 1e7, Some(Linear)),
    ("mm", Position, 1e4, Some(Linear)),
    ("um", Position, 10.0, Some(Linear)),
    ("0.1um", Position, 1.0, Some(Linear)),
    ("nm", Position, 1e-2, Some(Linear)),
    ("inch", Position, 254_000.0, Some(Linear)),
    ("in", Position, 254_000.0, Some(Linear)),
    ("deg", Position, 1e4, Some(Rotary)),
    ("mdeg", Position, 10.0, Some(Rotary)),
    ("0.001deg", Position, 10.0, Some(Rotary)),
    ("0.0001deg", Position, 1.0, Some(Rotary)),
    ("rad", Position, 1e4 * DEGREES, Some(Rotary)),
    ("mrad", Position, 10.0 * DEGREES, Some(Rotary)),
    ("turn", Position, 360e4, Some(Rotary)),
    ("rev", Position, 360e4, Some(Rotary)),
    ("m/s", Velocity, 1e6, Some(Linear)),
    ("mm/s", Velocity, 1e3, Some(Linear)),
    ("um/s", Velocity, 1.0, Some(Linear)),
    ("m/min", Velocity, 1e6 / 60.0, Some(Linear)),
    ("mm/min", Velocity, 1e3 / 60.0, Some(Linear)),
    ("inch/min", Velocity, 25_400.0 / 60.0, Some(Linear)),
    ("deg/s", Velocity, 1e3, Some(Rotary)),
    ("mdeg/s", Velocity, 1.0, Some(Rotary)),
    ("0.001deg/s", Velocity, 1.0, Some(Rotary)),
    ("deg/min", Velocity, 1e3 / 60.0, Some(Rotary)),
    ("rpm", Velocity, 6e3, Some(Rotary)),
    ("1/min", Velocity, 6e3, Some(Rotary)),
    ("u/min", Velocity, 6e3, Some(Rotary)),
    ("rev/s", Velocity, 360e3, Some(Rotary)),
    ("rev/min", Velocity, 6e3, Some(Rotary)),
    ("turn/s", Velocity, 360e3, Some(Rotary)),
    ("1/s", Velocity, 360e3, Some(Rotary)),
    ("rad/s", Velocity, 1e3 * DEGREES, Some(Rotary)),
    ("mrad/s", Velocity, DEGREES, Some(Rotary)),
    ("rad/min", Velocity, 1e3 / 60.0 * DEGREES, Some(Rotary)),
    ("%", Torque, 10.0, None),
    ("0.1%", Torque, 1.0, None),
    ("\u{2030}", Torque, 1.0, None),
    ("permille", Torque, 1.0, None),
    ("a", Torque, 1.0, None),
    ("ma", Torque, 1.0, None),
    ("n", Torque, 1.0, None),
    ("kn", Torque, 1.0, None),
    ("nm.", Torque, 1.0, None),
    ("ncm", Torque, 1.0, None),
];

/// Degrees of a radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Units of torque that are parts of the rated value of the drive.
const OF_THE_DRIVE: [&str; 4] = ["%", "0.1%", "\u{2030}", "permille"];

impl Unit {
    /// The known units, for a sentence.
    pub const NAMED: &str = "s, ms, us, m, mm, um, 0.1um, nm, inch, deg, 0.0001deg, rad, turn, m/s, mm/s, um/s, \
                             m/min, mm/min, deg/s, 0.001deg/s, rad/s, turn/s, rev/s, rpm, 1/min, %, 0.1%, permille, A, mA, \
                             N, kN, Nm, Ncm";

    /// Returns the unit of a text such as `mm/s`, `µm`, `%`, `V (Voltage)`. `Nm` is a torque, `nm` a length.
    pub fn parse(text: &str) -> Option<Self> {
        let name = plain(text);
        let (name, quantity, factor, motion) = *UNITS.iter().find(|(known, ..)| *known == name)?;
        Some(Self {
            quantity,
            factor,
            motion,
            is_of_the_drive: quantity != Torque || OF_THE_DRIVE.contains(&name),
        })
    }

    /// Returns the unit of the path of an axis that moves `lead_mm` in a turn of its motor, where this is one of the
    /// motor's turns.
    pub fn along_path(self, lead_mm: f64) -> Self {
        match (self.motion, self.quantity) {
            (Some(Rotary), Position | Velocity) => Self {
                factor: self.factor * lead_mm / 360.0,
                motion: Some(Linear),
                ..self
            },
            _ => self,
        }
    }

    /// Returns the unit in which a quantity is recorded by the CNC itself.
    pub fn own(quantity: ChannelQuantity) -> Self {
        Self {
            quantity,
            factor: 1.0,
            motion: None,
            is_of_the_drive: true,
        }
    }
}

/// Returns a unit in one way of writing: `mm / s`, `µm/s`, `grad/sec` and `V (Voltage)`.
fn plain(text: &str) -> String {
    let text = text.trim();
    // Scope appends the quantity: `mm/s (Velocity)`.
    let text = text.split(" (").next().unwrap_or(text);
    if text == "Nm" || text == "N\u{b7}m" {
        return "nm.".to_owned();
    }
    text.to_lowercase()
        .replace(char::is_whitespace, "")
        .replace(['\u{b5}', '\u{3bc}'], "u")
        .replace("degrees", "deg")
        .replace("degree", "deg")
        .replace("grad", "deg")
        .replace("radians", "rad")
        .replace("radian", "rad")
        .replace("turns", "turn")
        .replace("revs", "rev")
        .replace("per-mille", "permille")
        .replace('\u{b0}', "deg")
        .replace("sec", "s")
}

/// Returns a header cell such as `v [mm/s]`, `x_um`, `torque (A)`, `t/s` as a name and the unit in it.
pub(super) fn split_unit(header: &str) -> (&str, Option<&str>) {
    let header = header.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(rest) = header.strip_suffix(close)
            && let Some((name, unit)) = rest.rsplit_once(open)
            && !name.trim().is_empty()
            // Round brackets may hold anything: `SetVelo (X)`.
            && (open == '[' || Unit::parse(unit).is_some())
        {
            return (name.trim(), Some(unit.trim()));
        }
    }
    for between in ['_', ' ', '/', '.'] {
        // From the left, so that `v_mm/s` and `v/mm/s` end in a whole unit.
        for (at, _) in header.match_indices(between) {
            let (name, unit) = (header[..at].trim(), &header[at + 1..]);
            if !name.is_empty() && Unit::parse(unit).is_some() {
                return (name, Some(unit.trim()));
            }
        }
    }
    (header, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_in_every_way_of_writing() {
        // R6.3 R6.26
        for (text, quantity, factor) in [
            ("mm/s (Velocity)", Velocity, 1e3),
            ("m / min", Velocity, 1e6 / 60.0),
            ("\u{b5}m/s", Velocity, 1.0),
            ("\u{3bc}m", Position, 10.0),
            ("Grad/s", Velocity, 1e3),
            ("\u{b0}", Position, 1e4),
            ("Nm", Torque, 1.0),
            ("nm", Position, 1e-2),
            ("%", Torque, 10.0),
            ("ms", Time, 1e-3),
            ("rad/s", Velocity, 180e3 / std::f64::consts::PI),
            ("Rad / sec", Velocity, 180e3 / std::f64::consts::PI),
            ("radians", Position, 180e4 / std::f64::consts::PI),
            ("turns/s", Velocity, 360e3),
            ("rev/s", Velocity, 360e3),
            ("deg/s", Velocity, 1e3),
            ("1/min", Velocity, 6e3),
            ("Nm", Torque, 1.0),
            ("N", Torque, 1.0),
            ("A", Torque, 1.0),
            ("\u{2030}", Torque, 1.0),
            ("permille", Torque, 1.0),
        ] {
            let unit = Unit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!((unit.quantity, unit.factor), (quantity, factor), "{text}");
        }
        assert_eq!(Unit::parse("(None)"), None);
        assert_eq!(Unit::parse("V (Voltage)"), None);
    }

    #[test]
    fn a_turn_of_the_motor_is_a_lead_of_the_path() {
        // R6.26
        let of = |unit: &str, lead| Unit::parse(unit).expect("a unit").along_path(lead);
        // 10 mm a turn, one turn a second: 10 mm/s.
        assert!((of("turn/s", 10.0).factor - 1e4).abs() < 1e-6);
        assert!((of("rpm", 10.0).factor - 1e4 / 60.0).abs() < 1e-6);
        // Half a turn is π rad, and 5 mm.
        assert!((of("rad", 10.0).factor * std::f64::consts::PI - 5e4).abs() < 1e-6);
        assert_eq!(of("mm/s", 10.0), Unit::parse("mm/s").expect("a unit"));
        assert_eq!(of("Nm", 10.0), Unit::parse("Nm").expect("a unit"));
    }

    #[test]
    fn a_header_has_its_unit_behind_the_name() {
        // R6.3
        for (header, name, unit) in [
            ("v [mm/s]", "v", Some("mm/s")),
            ("x_um", "x", Some("um")),
            ("torque (A)", "torque", Some("A")),
            ("t/s", "t", Some("s")),
            ("v/mm/s", "v", Some("mm/s")),
            ("v mm/s", "v", Some("mm/s")),
            ("act_velo", "act_velo", None),
            ("[mm]", "[mm]", None),
            ("", "", None),
        ] {
            assert_eq!(split_unit(header), (name, unit), "{header}");
        }
    }
}
