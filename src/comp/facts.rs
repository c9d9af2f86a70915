//! The facts about each kind of compensation, one row per kind, and the version of the control's kernel, on which lists and
//! commands depend.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::kind::Kind;
use crate::diagnostic::Code;

/// Statements of the control's documents about a kind (R1.10, R1.36, R1.40, R1.41).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Facts {
    /// Kind of compensation.
    pub kind: Kind,
    /// The key in the axis list that configures it.
    pub selector: &'static str,
    /// The number of that parameter.
    pub parameter: &'static str,
    /// The key that leaves the switching to the program: off at start-up, at program end and at
    /// reset.
    pub manual_activation: Option<&'static str>,
    /// The number of the manual-activation parameter, if one is documented.
    pub manual_parameter: Option<&'static str>,
    /// The control's error for `COMP ON` of the kind on an axis whose list does not select it.
    pub refusal: Code,
    /// The bit of the kind in P-AXIS-00465, if one is documented.
    pub monitor_bit: Option<u64>,
    /// The CNC build that introduced the keyword.
    pub since: CncBuild,
}

/// Sources: *Selecting/deselecting axis compensation in the NC program* (builds), the axis and
/// compensation parameter descriptions (selectors, manual activation), the control's error texts
/// (refusals), ISG kernel page 117737611 (bits of P-AXIS-00465).
const TABLE: [Facts; 7] = [
    Facts {
        kind: Kind::Backlash,
        selector: "lr_param.anwahl_losekomp",
        parameter: "P-AXIS-00021",
        manual_activation: None,
        manual_parameter: None,
        refusal: Code::PErr70637,
        monitor_bit: Some(0x1),
        since: CncBuild::new([3, 1, 3081, 5]),
    },
    Facts {
        kind: Kind::Cross,
        selector: "lr_param.crosscomp",
        parameter: "P-AXIS-00047",
        manual_activation: Some("kw.crosscomp.manual_activation"),
        manual_parameter: Some("P-COMP-00029"),
        refusal: Code::PErr70316,
        monitor_bit: Some(0x8),
        since: CncBuild::new([2, 10, 1501, 0]),
    },
    Facts {
        kind: Kind::Plane,
        selector: "lr_param.crosscomp2",
        parameter: "P-AXIS-00174",
        manual_activation: Some("kw.crosscomp2.manual_activation"),
        manual_parameter: Some("P-COMP-00030"),
        refusal: Code::PErr70319,
        monitor_bit: Some(0x10),
        since: CncBuild::new([2, 10, 1501, 0]),
    },
    Facts {
        kind: Kind::Lead,
        selector: "lr_param.ssfk",
        parameter: "P-AXIS-00175",
        manual_activation: Some("kw.ssfk.manual_activation"),
        manual_parameter: Some("P-COMP-00028"),
        refusal: Code::PErr70310,
        monitor_bit: Some(0x2),
        since: CncBuild::new([2, 10, 1501, 0]),
    },
    Facts {
        kind: Kind::Temp,
        selector: "lr_param.temp_comp",
        parameter: "P-AXIS-00271",
        manual_activation: Some("lr_param.temp_comp_manual_activation"),
        manual_parameter: Some("P-AXIS-00482"),
        refusal: Code::PErr70313,
        monitor_bit: Some(0x4),
        since: CncBuild::new([2, 10, 1501, 0]),
    },
    Facts {
        kind: Kind::Frict,
        selector: "lr_param.frict_comp",
        parameter: "P-AXIS-00522",
        manual_activation: None,
        manual_parameter: None,
        refusal: Code::PErr70495,
        monitor_bit: None,
        since: CncBuild::new([2, 11, 2022, 5]),
    },
    Facts {
        kind: Kind::Crosstalk,
        selector: "lr_param.crosstalk",
        parameter: "P-AXIS-00789",
        manual_activation: Some("kw.crosstalk.manual_activation"),
        manual_parameter: None,
        refusal: Code::PErr70631,
        monitor_bit: None,
        since: CncBuild::new([3, 1, 3079, 32]),
    },
];

impl Kind {
    /// Returns the facts about this kind.
    pub fn facts(self) -> &'static Facts {
        &TABLE[self as usize]
    }
}

/// The version of the control's kernel, `V3.1.3132.0`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CncBuild([u32; 4]);

impl CncBuild {
    /// Creates a build from its four numbers.
    pub const fn new(numbers: [u32; 4]) -> Self {
        Self(numbers)
    }
}

/// A text that is not a CNC build.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{0}` is not a CNC build; write it like `3.1.3132.0`")]
pub struct NoBuild(String);

impl CncBuild {
    /// Whether this build reads real numbers in the friction table: V3.1.3132.0 and later on the
    /// V3 line, V4.29.0 and later on the V4 line (chapter 3.3).
    pub fn reads_real_points(self) -> bool {
        let first = match self.0[0] {
            0..=3 => Self([3, 1, 3132, 0]),
            4 => Self([4, 29, 0, 0]),
            _ => return true,
        };
        self >= first
    }
}

impl FromStr for CncBuild {
    type Err = NoBuild;

    fn from_str(text: &str) -> Result<Self, NoBuild> {
        let no_build = || NoBuild(text.to_owned());
        let mut numbers = [0; 4];
        let mut parts = text.trim_start_matches(['V', 'v']).split('.');
        for (place, number) in numbers.iter_mut().enumerate() {
            match parts.next() {
                Some(part) => *number = part.parse().map_err(|_| no_build())?,
                None if place >= 2 => {}
                None => return Err(no_build()),
            }
        }
        match parts.next() {
            None => Ok(Self(numbers)),
            Some(_) => Err(no_build()),
        }
    }
}

impl fmt::Display for CncBuild {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [line, release, build, patch] = self.0;
        write!(f, "V{line}.{release}.{build}.{patch:02}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_own_row() {
        // R1.40
        for kind in Kind::ALL {
            assert_eq!(kind.facts().kind, kind);
        }
    }
}
