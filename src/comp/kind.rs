//! The kinds of axis compensation, sets of them, the facts about each, one row per kind, and the version of the control's kernel,
//! on which lists and commands depend.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::diagnostic::Code;

crate::words! {
    /// A kind of axis compensation that COMP switches.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "UPPERCASE")]
    #[non_exhaustive]
    pub enum Kind {
        /// Backlash compensation.
        Backlash = "BACKLASH",
        /// Cross compensation.
        Cross = "CROSS",
        /// Plane compensation.
        Plane = "PLANE",
        /// Leadscrew error compensation.
        Lead = "LEAD",
        /// Temperature compensation.
        Temp = "TEMP",
        /// Friction compensation.
        Frict = "FRICT",
        /// Crosstalk compensation.
        Crosstalk = "CROSSTALK",
    }
}

/// A word that is not a kind of compensation.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no compensation `{0}`")]
pub struct UnknownKind(pub String);

impl FromStr for Kind {
    type Err = UnknownKind;

    /// Returns the kind of a keyword, in any case.
    fn from_str(word: &str) -> Result<Self, Self::Err> {
        let mut kinds = Self::ALL.into_iter();
        let found = kinds.find(|kind| kind.as_str().eq_ignore_ascii_case(word));
        found.ok_or_else(|| UnknownKind(word.to_owned()))
    }
}

/// A set of kinds; serialised as the list of their keywords.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(into = "Vec<Kind>", from = "Vec<Kind>")]
pub struct KindSet(u8);

impl From<KindSet> for Vec<Kind> {
    fn from(set: KindSet) -> Self {
        set.iter().collect()
    }
}

impl From<Vec<Kind>> for KindSet {
    fn from(kinds: Vec<Kind>) -> Self {
        kinds.into_iter().collect()
    }
}

impl KindSet {
    /// The empty set.
    pub const NONE: Self = Self(0);
    /// Every kind.
    pub const ALL: Self = Self(0x7f);

    /// Returns the set of one kind.
    pub const fn of(kind: Kind) -> Self {
        Self(1 << kind as u8)
    }

    /// Returns whether the kind is in the set.
    pub fn contains(self, kind: Kind) -> bool {
        self.0 & Self::of(kind).0 != 0
    }

    /// Adds a kind to the set.
    pub fn insert(&mut self, kind: Kind) {
        self.0 |= Self::of(kind).0;
    }

    /// Removes a kind from the set.
    pub fn remove(&mut self, kind: Kind) {
        self.0 &= !Self::of(kind).0;
    }

    /// Adds a kind to the set or removes it.
    pub fn assign(&mut self, kind: Kind, present: Membership) {
        match present {
            Membership::In => self.insert(kind),
            Membership::Out => self.remove(kind),
        }
    }

    /// Returns the kinds in either set.
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the kinds in both sets.
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns the kinds of this set that are not in the other.
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the kinds of the set, in the order of [`Kind::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Kind> {
        Kind::ALL
            .into_iter()
            .filter(move |&kind| self.contains(kind))
    }
}

impl FromIterator<Kind> for KindSet {
    fn from_iter<I: IntoIterator<Item = Kind>>(kinds: I) -> Self {
        let mut set = Self::NONE;
        for kind in kinds {
            set.insert(kind);
        }
        set
    }
}

/// Membership of a kind in a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Membership {
    /// Member of the set.
    In,
    /// Not a member of the set.
    Out,
}

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
    /// Returns whether this build reads real numbers in the friction table: V3.1.3132.0 and later on the V3 line,
    /// V4.29.0 and later on the V4 line (chapter 3.3).
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
