//! Feed moves without friction compensation in a version, and those that only one version makes (R18.22).

use std::collections::{BTreeMap, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};

use super::comparison::Which;
use frictcomp::timeline::Row;

/// Moves of an axis by blocks of one number, or of one text.
#[derive(Debug, Clone, Copy)]
struct MovesOfBlock {
    count: u64,
    line: u32,
}

/// The feed moves of a version without friction compensation, each by its axis and its block.
#[derive(Debug, Clone, Default)]
pub(super) struct UncompensatedMoves(HashMap<(String, u64), MovesOfBlock>);

/// Feed moves of an axis that only one version makes without friction compensation.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ChangedMoves {
    /// Name of the axis.
    pub axis: String,
    /// The version that makes them.
    pub which: Which,
    /// Number of these moves.
    pub count: u64,
    /// The line of the first of them in that version.
    pub line: u32,
}

impl UncompensatedMoves {
    /// Takes the moves of a block.
    pub(super) fn take(&mut self, row: &Row<'_>) {
        for axis in row.uncompensated {
            let mut hasher = DefaultHasher::new();
            row.number.ok_or(row.text).hash(&mut hasher);
            let axis = row.state.name(*axis).to_owned();
            let moves = self.0.entry((axis, hasher.finish()));
            let line = row.line;
            moves.or_insert(MovesOfBlock { count: 0, line }).count += 1;
        }
    }

    /// Returns the moves that another version does not make, of each axis.
    pub(super) fn beyond(&self, other: &Self, which: Which) -> Vec<ChangedMoves> {
        let mut changed: BTreeMap<&str, MovesOfBlock> = BTreeMap::new();
        for (key, moves) in &self.0 {
            let there = other.0.get(key).map_or(0, |it| it.count);
            let count = moves.count.saturating_sub(there);
            if count > 0 {
                let line = moves.line;
                let of_axis = changed.entry(&key.0);
                let of_axis = of_axis.or_insert(MovesOfBlock { count: 0, line });
                of_axis.count += count;
                of_axis.line = of_axis.line.min(line);
            }
        }
        let changed = changed.into_iter();
        let changed = changed.map(|(axis, MovesOfBlock { count, line })| ChangedMoves {
            axis: axis.to_owned(),
            which,
            count,
            line,
        });
        changed.collect()
    }
}
