//! The state of compensation behind a handle.

use std::ffi::CString;
use std::path::Path;

use frictcomp::comp::{AxisIndex, Change, Compensation, Coupling, Kind, State};
use frictcomp::session::Session;
use frictcomp::session::SessionOptions;
use frictcomp::syntax::parse_comp;
use frictcomp_host::StateFile;

use crate::failure::{Failure, c_text};
use crate::machine::FrictcompMachine;

/// A kind of axis compensation that COMP switches.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictcompKind {
    /// `BACKLASH`
    Backlash = 0,
    /// `CROSS`
    Cross = 1,
    /// `PLANE`
    Plane = 2,
    /// `LEAD`
    Lead = 3,
    /// `TEMP`
    Temp = 4,
    /// `FRICT`
    Frict = 5,
    /// `CROSSTALK`
    Crosstalk = 6,
}

/// The state of a kind of compensation on an axis.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictcompState {
    /// The axis parameters do not configure it.
    Unconfigured = 0,
    /// Switched off.
    Inactive = 1,
    /// Switched on and working.
    Active = 2,
    /// Switched on without effect, because its value list was not accepted.
    Ineffective = 3,
    /// Known only to the machine.
    Unknown = 4,
}

/// Membership of an axis in a coupling, in which the control refuses COMP.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictcompCoupling {
    /// Not a member of a coupling.
    None = 0,
    /// Member of a coupling.
    Active = 1,
    /// Possible member, known only to the machine: the state after COMP is unknown.
    Perhaps = 2,
}

/// One state that a call changed.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrictcompChange {
    /// The position of the axis in the machine.
    pub axis: usize,
    /// The kind of compensation.
    pub kind: FrictcompKind,
    /// The state before.
    pub from: FrictcompState,
    /// The state now.
    pub to: FrictcompState,
}

/// The state of every compensation on every axis of a machine.
#[derive(Debug)]
pub struct FrictcompCompensation {
    states: Compensation,
    changes: Vec<FrictcompChange>,
    possible: Vec<PossibleValues>,
}

/// The possible states where one is unknown.
#[derive(Debug)]
struct PossibleValues {
    axis: AxisIndex,
    kind: Kind,
    words: CString,
}

impl FrictcompCompensation {
    /// The states after a start of the control.
    pub(crate) fn at_startup(machine: &FrictcompMachine) -> Self {
        Self {
            states: machine.machine().compensation(),
            changes: Vec::new(),
            possible: Vec::new(),
        }
    }

    /// The states that dry runs left in a state file.
    pub(crate) fn left_in(machine: &FrictcompMachine, path: &Path) -> Result<Self, Failure> {
        let saved = StateFile::read(path)?;
        let resumed = Session::resume(machine.machine().clone(), SessionOptions::default(), saved);
        let (session, _) =
            resumed.map_err(|error| Failure::of_state(&path.display().to_string(), &error))?;
        let left = session.state();
        let possible = left.possible.iter().map(|it| PossibleValues {
            axis: it.axis,
            kind: it.kind,
            words: c_text(&it.in_words("")),
        });
        Ok(Self {
            states: left.compensation.clone(),
            changes: Vec::new(),
            possible: possible.collect(),
        })
    }

    /// Begins a call that may change a state.
    pub(crate) fn begin(&mut self) -> &mut Self {
        self.changes.clear();
        self
    }

    /// Applies one command, such as `X[COMP OFF FRICT]`.
    pub(crate) fn apply(&mut self, command: &str) -> Result<(), Failure> {
        let command = parse_comp(command)?.ok_or(Failure::NotComp)?;
        let changes = self.states.apply(&command)?;
        // After a command, an axis that may be coupled has an unknown state for another reason.
        let (axis, kinds) = (
            self.states.resolve(&command.axis)?,
            command.selection.kinds(),
        );
        self.possible
            .retain(|it| it.axis != axis || !kinds.contains(it.kind));
        self.changed(&changes);
        Ok(())
    }

    pub(crate) fn program_end(&mut self) {
        let changes = self.states.program_end();
        self.changed(&changes);
    }

    pub(crate) fn reset(&mut self) {
        let changes = self.states.reset();
        self.changed(&changes);
    }

    /// Sets a state that the host knows from elsewhere, such as the previous job.
    pub(crate) fn set(&mut self, axis: usize, kind: u32, state: u32) -> Result<(), Failure> {
        let (axis, kind) = (self.axis(axis)?, kind_of(kind)?);
        let mut selected = self.states.selected(axis);
        let mut unknown = self.states.unknown(axis);
        unknown.remove(kind);
        match state {
            _ if !self.states.is_configured(axis, kind) => {
                let words = "the kind is not configured on the axis: it has no state to set";
                return Err(Failure::bad(words));
            }
            it if it == FrictcompState::Active as u32 => selected.insert(kind),
            it if it == FrictcompState::Inactive as u32 => selected.remove(kind),
            it if it == FrictcompState::Unknown as u32 => unknown.insert(kind),
            other => {
                let words = format!("{other} cannot be set: use active, inactive or unknown");
                return Err(Failure::bad(words));
            }
        }
        let from = self.states.state(axis, kind);
        self.states.restore(axis, selected, unknown);
        self.possible
            .retain(|it| (it.axis, it.kind) != (axis, kind));
        let to = self.states.state(axis, kind);
        let change = Change {
            axis,
            kind,
            from,
            to,
        };
        self.changed(if from == to {
            &[]
        } else {
            std::slice::from_ref(&change)
        });
        Ok(())
    }

    pub(crate) fn couple(&mut self, axis: usize, coupling: u32) -> Result<(), Failure> {
        let axis = self.axis(axis)?;
        let coupling = match coupling {
            it if it == FrictcompCoupling::None as u32 => Coupling::None,
            it if it == FrictcompCoupling::Active as u32 => Coupling::Active,
            it if it == FrictcompCoupling::Perhaps as u32 => Coupling::Perhaps,
            other => return Err(Failure::bad(format!("{other} is not a coupling"))),
        };
        self.states.set_coupled(axis, coupling);
        Ok(())
    }

    pub(crate) fn state(&self, axis: usize, kind: u32) -> Result<FrictcompState, Failure> {
        let (axis, kind) = (self.axis(axis)?, kind_of(kind)?);
        Ok(self.states.state(axis, kind).into())
    }

    /// The possible states in words, where the conditions that they depend on are known.
    pub(crate) fn possible(&self, axis: usize, kind: u32) -> Result<Option<&CString>, Failure> {
        let (axis, kind) = (self.axis(axis)?, kind_of(kind)?);
        let mut possible = self.possible.iter();
        let found = possible.find(|it| (it.axis, it.kind) == (axis, kind));
        Ok(found.map(|it| &it.words))
    }

    /// The changes of the last call that could change a state, in their order.
    pub(crate) fn changes(&self) -> &[FrictcompChange] {
        &self.changes
    }

    fn changed(&mut self, changes: &[Change]) {
        let states = &self.states;
        self.possible
            .retain(|it| states.state(it.axis, it.kind) == State::Unknown);
        self.changes
            .extend(changes.iter().map(|change| FrictcompChange {
                axis: change.axis.get(),
                kind: change.kind.into(),
                from: change.from.into(),
                to: change.to.into(),
            }));
    }

    fn axis(&self, axis: usize) -> Result<AxisIndex, Failure> {
        let count = self.states.len();
        if axis < count {
            return Ok(AxisIndex::new(axis));
        }
        Err(Failure::bad(format!(
            "there is no axis {axis}: the machine has {count}"
        )))
    }
}

fn kind_of(number: u32) -> Result<Kind, Failure> {
    let found = Kind::ALL
        .into_iter()
        .find(|kind| FrictcompKind::from(*kind) as u32 == number);
    found.ok_or_else(|| Failure::bad(format!("{number} is not a kind of compensation")))
}

impl From<Kind> for FrictcompKind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Backlash => Self::Backlash,
            Kind::Cross => Self::Cross,
            Kind::Plane => Self::Plane,
            Kind::Lead => Self::Lead,
            Kind::Temp => Self::Temp,
            Kind::Frict => Self::Frict,
            Kind::Crosstalk => Self::Crosstalk,
            _ => unreachable!("a kind that C has no number for"),
        }
    }
}

impl From<State> for FrictcompState {
    fn from(state: State) -> Self {
        match state {
            State::Active => Self::Active,
            State::Ineffective => Self::Ineffective,
            State::Inactive => Self::Inactive,
            State::Unconfigured => Self::Unconfigured,
            State::Unknown => Self::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_number() {
        // R13.5
        for (number, kind) in Kind::ALL.into_iter().enumerate() {
            assert_eq!(FrictcompKind::from(kind) as usize, number);
        }
        assert!(kind_of(7).is_err());
    }
}
