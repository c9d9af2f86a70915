//! The kinds of axis compensation, and sets of them.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

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

    /// Whether the kind is in the set.
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

    /// Whether the set is empty.
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

/// Whether a kind belongs to a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Membership {
    /// It does.
    In,
    /// It does not.
    Out,
}
