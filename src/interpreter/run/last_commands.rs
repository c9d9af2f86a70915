//! The last COMP command on each way, to name the command that caused a state (R1.50, R14.5).

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Kind, KindSet, Selection};
use crate::text::Place;

/// Number of commands of one direction kept for a kind where ways meet; of more, the later lines are kept.
const MAX_KEPT: usize = 16;

/// A COMP command that was executed last on some way.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct LastCommand {
    /// The executed block.
    pub(crate) seq: u64,
    pub(crate) place: Place,
}

impl PartialEq for LastCommand {
    /// A command that a loop repeats counts as equal.
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
    }
}

/// Commands by file and line.
type ByLine = BTreeMap<(Arc<str>, u32), LastCommand>;

/// The last commands on the kinds of axes: those that switch a kind off, and those that switch it on. Nothing if no
/// command of the program switched the kind, on any way.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(into = "Vec<CommandRow>", from = "Vec<CommandRow>")]
pub(crate) struct LastCommands(BTreeMap<(AxisIndex, Kind), [ByLine; 2]>);

type CommandRow = ((AxisIndex, Kind), [Vec<LastCommand>; 2]);

impl From<Vec<CommandRow>> for LastCommands {
    fn from(rows: Vec<CommandRow>) -> Self {
        let by_line = |commands: Vec<LastCommand>| {
            let keyed = commands.into_iter().map(|it| (key(&it.place), it));
            keyed.collect::<ByLine>()
        };
        let rows = rows.into_iter();
        Self(rows.map(|(of, both)| (of, both.map(by_line))).collect())
    }
}

impl From<LastCommands> for Vec<CommandRow> {
    fn from(last: LastCommands) -> Self {
        let rows = last.0.into_iter();
        let listed = |commands: ByLine| commands.into_values().collect();
        rows.map(|(of, both)| (of, both.map(listed))).collect()
    }
}

fn key(place: &Place) -> (Arc<str>, u32) {
    (Arc::clone(&place.file), place.first_line)
}

impl LastCommands {
    /// A program begins.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// A command switches kinds of an axis: on this way it is the last one.
    pub(crate) fn switch(&mut self, axis: AxisIndex, selection: Selection, command: &LastCommand) {
        let is_on = matches!(selection, Selection::On(_));
        for kind in selection.kinds().iter() {
            let mut both = [ByLine::new(), ByLine::new()];
            both[usize::from(is_on)].insert(key(&command.place), command.clone());
            self.0.insert((axis, kind), both);
        }
    }

    /// Something other than a command set kinds of an axis.
    pub(crate) fn forget(&mut self, axis: AxisIndex, kinds: KindSet) {
        for kind in kinds.iter() {
            self.0.remove(&(axis, kind));
        }
    }

    /// Another way reaches the same block.
    pub(crate) fn join(&mut self, other: &Self) {
        if self == other {
            return;
        }
        for (of, theirs) in &other.0 {
            let mine = self.0.entry(*of).or_default();
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                for (line, command) in theirs {
                    mine.entry(line.clone()).or_insert_with(|| command.clone());
                }
                while mine.len() > MAX_KEPT {
                    mine.pop_first();
                }
            }
        }
    }

    /// The command that was executed latest, of those that are the last ones on some way and switch a kind off, or on.
    pub(crate) fn latest(&self, axis: AxisIndex, kind: Kind, is_on: bool) -> Option<&LastCommand> {
        let both = self.0.get(&(axis, kind))?;
        both[usize::from(is_on)].values().max_by_key(|it| it.seq)
    }

    /// Whether all axes that it names are below a number.
    pub(crate) fn fits(&self, axes: usize) -> bool {
        self.0.keys().all(|(axis, _)| axis.get() < axes)
    }
}
