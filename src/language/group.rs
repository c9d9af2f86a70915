//! Groups of G functions (R2.45).

use serde::{Deserialize, Serialize};

/// A group of G functions of which one is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Group {
    /// G00 G01 G02 G03.
    Motion,
    /// G17 G18 G19.
    Plane,
    /// G70 inch, G71 metric.
    Unit,
    /// G90 absolute, G91 incremental.
    Distance,
    /// G93 G94 G95 G194.
    Feed,
    /// G53 to G59, G159.
    Offset,
    /// G40 G41 G42.
    CutterRadius,
    /// G161 absolute, G162 relative circle centre.
    CircleCentre,
    /// G360 exact stop, G359 none.
    ExactStop,
}

impl Group {
    pub(crate) const ALL: [Self; Self::COUNT] = [
        Self::Motion,
        Self::Plane,
        Self::Unit,
        Self::Distance,
        Self::Feed,
        Self::Offset,
        Self::CutterRadius,
        Self::CircleCentre,
        Self::ExactStop,
    ];

    /// Number of groups.
    pub(crate) const COUNT: usize = Self::ExactStop as usize + 1;
}

impl From<Vec<Group>> for GroupSet {
    fn from(groups: Vec<Group>) -> Self {
        groups.into_iter().collect()
    }
}

impl From<GroupSet> for Vec<Group> {
    fn from(set: GroupSet) -> Self {
        let groups = Group::ALL.into_iter();
        groups.filter(|&group| set.contains(group)).collect()
    }
}

/// A set of groups, a bit each; serialised as the list of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "Vec<Group>", from = "Vec<Group>")]
pub(crate) struct GroupSet(u16);

impl GroupSet {
    pub(crate) fn contains(self, group: Group) -> bool {
        self.0 & 1 << group as u8 != 0
    }

    pub(crate) fn insert(&mut self, group: Group) {
        self.0 |= 1 << group as u8;
    }

    pub(crate) fn remove(&mut self, group: Group) {
        self.0 &= !(1 << group as u8);
    }
}

impl FromIterator<Group> for GroupSet {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        let mut set = Self::default();
        groups.into_iter().for_each(|group| set.insert(group));
        set
    }
}
