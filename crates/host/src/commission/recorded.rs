//! A recorded program.

use frictcomp_physics::current::Switched;
use frictcomp_recordings::commission::{MeasuringProgram, Plan, Stage};

/// A recorded program with its plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordedProgram<'a> {
    pub(super) program: &'a MeasuringProgram,
    pub(super) plan: &'a Plan,
    /// The end of its signature in s.
    pub(super) from_s: f64,
}

impl RecordedProgram<'_> {
    /// Returns the state to which the program switches compensation.
    pub(super) fn wanted(self) -> Switched {
        match self.plan.stage {
            Stage::Off => Switched::Off,
            Stage::On => Switched::On,
        }
    }
}
