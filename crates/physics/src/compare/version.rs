//! One version of a program: its switches, and where they cease to be known.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use super::moves::UncompensatedMoves;
use super::obstacle::{Obstacle, Reason};
use super::switch::Switch;
use frictcomp::comp::{Kind, KindSet, State};
use frictcomp::diagnostic::{Code, Diagnostic};
use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{Record, Row, Sink};

/// Switches of one version of a program: a sink for the records of a session that runs it.
#[derive(Debug, Clone)]
pub struct Version {
    kinds: KindSet,
    pub(super) switches: Vec<Switch>,
    pub(super) moves: UncompensatedMoves,
    /// An error or a bound; the end shows whether it stopped the program.
    candidate: Option<Obstacle>,
    pub(super) obstacle: Option<Obstacle>,
    /// The file of the program.
    file: String,
    /// The states at its end.
    pub(super) end: BTreeMap<(String, Kind), State>,
}

impl Version {
    /// Creates a version for which these kinds count.
    pub fn new(kinds: KindSet) -> Self {
        Self {
            kinds,
            switches: Vec::new(),
            moves: UncompensatedMoves::default(),
            candidate: None,
            obstacle: None,
            file: String::new(),
            end: BTreeMap::new(),
        }
    }

    fn block(&mut self, row: &Row<'_>) {
        for change in row.changes {
            if !self.kinds.contains(change.kind) {
                continue;
            }
            let switch = Switch::new(row, *change, &self.file);
            // On some ways only: the other version may differ in them.
            if change.to == State::Unknown || row.branch.is_some() {
                self.obstacle.get_or_insert_with(|| Obstacle {
                    file: switch.file.clone(),
                    line: Some(switch.line),
                    reason: Reason::Unknown {
                        axis: switch.axis.clone(),
                        kind: switch.kind,
                    },
                });
            }
            self.switches.push(switch);
        }
        if self.kinds.contains(Kind::Frict) {
            self.moves.take(row);
        }
        row.diagnostics.iter().for_each(|said| self.judge(said));
    }

    /// Notes an obstacle to a comparison of the whole program, unless there is one for a block of it.
    fn hinder(&mut self, reason: Reason) {
        let file = &self.file;
        self.obstacle.get_or_insert_with(|| Obstacle {
            file: file.clone(),
            line: None,
            reason,
        });
    }

    /// Examines a message for an obstacle to a comparison of the version.
    fn judge(&mut self, said: &Diagnostic) {
        self.candidate = self.candidate.take().or_else(|| Obstacle::stop(said));
        self.obstacle = self.obstacle.take().or_else(|| Obstacle::of(said));
    }
}

impl Sink for Version {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Program { file, .. } => (*file).clone_into(&mut self.file),
            Record::Block(row) => self.block(row),
            Record::End(end) => {
                for (axis, name) in end.state.axes() {
                    let kinds = Kind::ALL.iter().filter(|kind| self.kinds.contains(**kind));
                    let states =
                        kinds.map(|kind| ((name.to_owned(), *kind), end.state.state(axis, *kind)));
                    self.end.extend(states);
                }
                for note in end.notes {
                    self.judge(&note.diagnostic);
                }
                if matches!(end.by, EndedBy::Error | EndedBy::Budget) {
                    self.obstacle = self.candidate.take().or(self.obstacle.take());
                    self.hinder(Reason::StoppedSilently);
                }
            }
            // The user may have silenced the message about it.
            Record::Summary(summary) if !summary.assumed.is_empty() => {
                let is_undescribed = summary.assumed.contains(&Code::Fc408);
                self.hinder(if is_undescribed {
                    Reason::Undescribed
                } else {
                    Reason::Assumed
                });
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}
