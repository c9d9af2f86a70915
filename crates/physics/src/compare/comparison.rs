//! Two versions side by side.

use similar::{Algorithm, DiffOp, capture_diff_slices};

use frictcomp::comp::{Kind, State};

use super::moves::ChangedMoves;
use super::obstacle::Obstacle;
use super::switch::{Switch, SwitchIdentity};
use super::version::Version;

frictcomp::words! {
    /// One of the two versions.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum Which {
        /// The old version.
        Old = "old",
        /// The new version.
        New = "new",
    }
}

/// A switch in its place among those of the other version.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum PairedSwitch {
    /// A switch in both versions.
    Both {
        /// The switch of the old version.
        old: Switch,
        /// The switch of the new one, perhaps on another line.
        new: Switch,
    },
    /// A switch in one version only.
    One(Which, Switch),
}

frictcomp::words! {
    /// Result of a comparison.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum Agreement {
        /// Same switches in both versions.
        Same = "same",
        /// A block switches, or a feed move lacks friction compensation, in one version and not in the other.
        Different = "different",
        /// At least one version is not known as a whole, whatever differs in the known part.
        NotComparable = "not-comparable",
    }
}

/// Two versions side by side.
#[derive(Debug, Clone)]
pub struct VersionComparison {
    pairs: Vec<PairedSwitch>,
    obstacles: [Option<Obstacle>; 2],
    ends: Vec<ChangedEnd>,
    moves: Vec<ChangedMoves>,
}

/// State of an axis at the program end that differs between the versions.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ChangedEnd {
    /// Name of the axis.
    pub axis: String,
    /// The kind of compensation.
    pub kind: Kind,
    /// The state at the end of the old version.
    pub old: State,
    /// The state at the end of the new version.
    pub new: State,
}

impl VersionComparison {
    /// Compares two versions.
    pub fn new(old: Version, new: Version) -> Self {
        let end = |((axis, kind), new): (&(String, Kind), &State)| {
            let old = *old.end.get(&(axis.clone(), *kind))?;
            let (axis, kind, new) = (axis.clone(), *kind, *new);
            let changed = ChangedEnd {
                axis,
                kind,
                old,
                new,
            };
            (old != new).then_some(changed)
        };
        let mut moves = new.moves.beyond(&old.moves, Which::New);
        moves.extend(old.moves.beyond(&new.moves, Which::Old));
        Self {
            moves,
            ends: new.end.iter().filter_map(end).collect(),
            pairs: pair(old.switches, new.switches),
            obstacles: [old.obstacle, new.obstacle],
        }
    }

    /// Compares two versions that are the same text with the same programs around it: whatever the control does in one,
    /// it does in the other.
    #[must_use]
    pub fn of_same_texts(mut self) -> Self {
        self.obstacles = [None, None];
        self
    }

    /// Returns the switches of both versions in their order.
    pub fn pairs(&self) -> &[PairedSwitch] {
        &self.pairs
    }

    /// Returns the states at the program end that differ.
    pub fn ends(&self) -> &[ChangedEnd] {
        &self.ends
    }

    /// Returns the feed moves that only one version makes without friction compensation.
    pub fn moves(&self) -> &[ChangedMoves] {
        &self.moves
    }

    /// Returns the switches of only one version.
    pub fn differences(&self) -> impl Iterator<Item = (Which, &Switch)> {
        self.pairs.iter().filter_map(|pair| match pair {
            PairedSwitch::Both { .. } => None,
            PairedSwitch::One(which, switch) => Some((*which, switch)),
        })
    }

    /// Returns the number of switches that both versions have.
    pub fn common(&self) -> usize {
        self.pairs.len() - self.differences().count()
    }

    /// Returns the obstacles to a comparison of the whole versions.
    pub fn obstacles(&self) -> impl Iterator<Item = (Which, &Obstacle)> {
        let both = [Which::Old, Which::New].into_iter().zip(&self.obstacles);
        both.filter_map(|(which, obstacle)| Some((which, obstacle.as_ref()?)))
    }

    /// Returns the result of the comparison.
    pub fn agreement(&self) -> Agreement {
        if self.obstacles().next().is_some() {
            Agreement::NotComparable
        } else if self.differences().next().is_some() || !self.moves.is_empty() {
            Agreement::Different
        } else {
            Agreement::Same
        }
    }
}

fn pair(old: Vec<Switch>, new: Vec<Switch>) -> Vec<PairedSwitch> {
    let operations = capture_diff_slices(Algorithm::Myers, &identities(&old), &identities(&new));
    let (mut old, mut new) = (old.into_iter(), new.into_iter());
    let mut pairs = Vec::with_capacity(old.len().max(new.len()));
    for operation in operations {
        let (before, after) = (operation.old_range().len(), operation.new_range().len());
        if let DiffOp::Equal { .. } = operation {
            let both = old.by_ref().zip(new.by_ref()).take(before);
            pairs.extend(both.map(|(old, new)| PairedSwitch::Both { old, new }));
        } else {
            let gone = old.by_ref().take(before);
            pairs.extend(gone.map(|switch| PairedSwitch::One(Which::Old, switch)));
            let come = new.by_ref().take(after);
            pairs.extend(come.map(|switch| PairedSwitch::One(Which::New, switch)));
        }
    }
    pairs
}

fn identities(switches: &[Switch]) -> Vec<SwitchIdentity<'_>> {
    switches.iter().map(Switch::identity).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::{Kind, State};

    fn switch(line: u32, number: i64) -> Switch {
        Switch {
            axis: "Y".to_owned(),
            kind: Kind::Frict,
            from: State::Active,
            to: State::Inactive,
            file: "a.nc".to_owned(),
            is_called: false,
            line,
            number: Some(number),
            text: format!("N{number} Y[COMP OFF FRICT]"),
        }
    }

    #[test]
    fn moved_lines_make_no_difference() {
        // R9.81
        let both = |pairs: &PairedSwitch| matches!(pairs, PairedSwitch::Both { .. });
        let pairs = pair(vec![switch(4, 25)], vec![switch(9, 25)]);
        assert!(pairs.len() == 1 && pairs.iter().all(both));
        let pairs = pair(
            vec![switch(4, 25), switch(5, 30)],
            vec![switch(4, 20), switch(5, 30)],
        );
        let expected = [
            PairedSwitch::One(Which::Old, switch(4, 25)),
            PairedSwitch::One(Which::New, switch(4, 20)),
            PairedSwitch::Both {
                old: switch(5, 30),
                new: switch(5, 30),
            },
        ];
        assert_eq!(pairs, expected);
    }
}
