//! The preconditions of compensation, the COMP command as data, the compensation state of every axis, and the effect of
//! a command on it or the reason for its refusal.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::kind::{Kind, KindSet, Membership};
use crate::diagnostic::Code;
use crate::text::Span;

/// The compensation of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
struct AxisState {
    configured: KindSet,
    /// The kinds that are known not to be configured.
    unselected: KindSet,
    parameterised: KindSet,
    /// The kinds that switch off at program end and reset.
    manual: KindSet,
    selected: KindSet,
    unknown: KindSet,
    /// The kinds whose parameters a program wrote into the machine data: what switches them on is open until a restart.
    #[serde(default)]
    rewritten: KindSet,
    coupling: Coupling,
}

impl AxisState {
    /// Makes a change to a kind and reports it if it is visible to the user.
    fn change(
        &mut self,
        axis: AxisIndex,
        kind: Kind,
        make: impl FnOnce(&mut Self),
    ) -> Option<Change> {
        let from = self.state(kind);
        make(self);
        let to = self.state(kind);
        (from != to).then_some(Change {
            axis,
            kind,
            from,
            to,
        })
    }

    /// Leaves open whether the axis is configured for kinds.
    fn rewrite(&mut self, kinds: KindSet) {
        self.unselected = self.unselected.without(kinds);
        self.configured = self.configured.union(kinds);
        self.rewritten = self.rewritten.union(kinds);
    }

    fn state(self, kind: Kind) -> State {
        if !self.configured.contains(kind) {
            State::Unconfigured
        } else if self.unknown.contains(kind) {
            State::Unknown
        } else if !self.selected.contains(kind) {
            State::Inactive
        } else if self.parameterised.contains(kind) {
            State::Active
        } else {
            State::Ineffective
        }
    }
}

/// The compensation state of all axes of a machine.
///
/// ```
/// use frictcomp::comp::{AxisSetup, Compensation, Kind, KindSet, State};
/// use frictcomp::syntax::parse_comp;
///
/// let axis = AxisSetup::new("X", KindSet::of(Kind::Frict));
/// let mut comp = Compensation::at_startup([axis]);
/// let command = |text| parse_comp(text).map(|parsed| parsed.expect("a COMP command"));
/// let changes = comp.apply(&command("X[COMP OFF FRICT]")?)?;
/// assert_eq!((changes[0].from, changes[0].to), (State::Active, State::Inactive));
///
/// comp.program_end();
/// assert_eq!(comp.state(comp.resolve("X")?, Kind::Frict), State::Inactive);
///
/// let refused = comp.apply(&command("Y[COMP ON FRICT]")?);
/// assert_eq!(refused.unwrap_err().code().as_str(), "P-ERR-21947");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Compensation {
    axes: Vec<AxisState>,
    names: Vec<String>,
    spindles: Vec<bool>,
}

impl Compensation {
    /// Returns the state after a start of the control (R1.22, R1.29): a kind is selected if its
    /// axis parameter configures it, unless the program has to activate it.
    pub fn at_startup(axes: impl IntoIterator<Item = AxisSetup>) -> Self {
        let mut compensation = Self {
            axes: Vec::new(),
            names: Vec::new(),
            spindles: Vec::new(),
        };
        for axis in axes {
            compensation.axes.push(AxisState {
                configured: axis.configured,
                unselected: axis.unselected.without(axis.configured),
                parameterised: axis.parameterised,
                manual: axis.manual,
                selected: axis.configured.without(axis.manual),
                unknown: KindSet::NONE,
                rewritten: KindSet::NONE,
                coupling: Coupling::None,
            });
            compensation.names.push(axis.name);
            compensation.spindles.push(axis.is_spindle);
        }
        compensation
    }

    /// Returns whether this is a state of these axes.
    pub(crate) fn fits(&self, axes: impl IntoIterator<Item = AxisSetup>) -> bool {
        let setups = axes.into_iter().map(|axis| (axis.name, axis.is_spindle));
        let own = self
            .names
            .iter()
            .cloned()
            .zip(self.spindles.iter().copied());
        self.axes.len() == self.names.len()
            && self.names.len() == self.spindles.len()
            && own.eq(setups)
    }

    /// Returns the state of one kind on one axis.
    pub fn state(&self, axis: AxisIndex, kind: Kind) -> State {
        self.axes[axis.get()].state(kind)
    }

    /// Returns the number of axes.
    pub fn len(&self) -> usize {
        self.axes.len()
    }

    /// Returns whether the machine has no axes.
    pub fn is_empty(&self) -> bool {
        self.axes.is_empty()
    }

    /// Applies a command and returns what it changed.
    ///
    /// # Errors
    /// The control's refusal; the state is then unchanged (R1.24, R1.41).
    pub fn apply(&mut self, command: &CompCommand) -> Result<Vec<Change>, CompensationError> {
        let axis = self.resolve(&command.axis)?;
        let mut changes = Vec::new();
        self.switch(axis, command.selection, &mut changes)?;
        Ok(changes)
    }

    /// Returns the axis of this name if a command may address it.
    ///
    /// # Errors
    /// The machine has no such axis, or it is a spindle.
    pub fn resolve(&self, name: &str) -> Result<AxisIndex, CompensationError> {
        let found = self.names.iter().position(|axis| axis == name);
        match found {
            Some(index) if !self.spindles[index] => Ok(AxisIndex::new(index)),
            Some(_) => Err(CompensationError::Spindle { axis: name.into() }),
            None if name.starts_with('S') => Err(CompensationError::Spindle { axis: name.into() }),
            None => Err(CompensationError::UnknownAxis { axis: name.into() }),
        }
    }

    /// Applies a selection to an axis and appends what it changed to `changes`.
    ///
    /// # Errors
    /// The control's refusal; the state is then unchanged (R1.24, R1.41).
    pub fn switch(
        &mut self,
        axis: AxisIndex,
        selection: Selection,
        changes: &mut Vec<Change>,
    ) -> Result<(), CompensationError> {
        let name = &self.names[axis.get()];
        let state = &mut self.axes[axis.get()];
        let coupling = state.coupling;
        if coupling == Coupling::Active {
            return Err(CompensationError::Coupled { axis: name.clone() });
        }
        let on = matches!(selection, Selection::On(_));
        let refused = selection.kinds().intersection(state.unselected);
        let friction = refused.contains(Kind::Frict).then_some(Kind::Frict);
        if let Some(kind) = friction.or_else(|| refused.iter().next()).filter(|_| on) {
            let axis = name.clone();
            return Err(CompensationError::NotConfigured { axis, kind });
        }
        let membership = if on { Membership::In } else { Membership::Out };
        for kind in selection.kinds().intersection(state.configured).iter() {
            changes.extend(state.change(axis, kind, |state| {
                if on && state.rewritten.contains(kind) {
                    state.unknown.insert(kind);
                } else if coupling == Coupling::None {
                    state.selected.assign(kind, membership);
                    state.unknown.remove(kind);
                } else if state.selected.contains(kind) != on {
                    state.unknown.insert(kind);
                }
            }));
        }
        Ok(())
    }

    /// Ends a program (R1.27, R1.40): friction compensation keeps its state, kinds with manual
    /// activation switch off. Returns the changes.
    pub fn program_end(&mut self) -> Vec<Change> {
        let mut changes = Vec::new();
        for index in 0..self.axes.len() {
            let axis = AxisIndex::new(index);
            let state = &mut self.axes[index];
            for kind in state.manual.intersection(state.configured).iter() {
                changes.extend(state.change(axis, kind, |state| {
                    state.selected.remove(kind);
                    state.unknown.remove(kind);
                }));
            }
        }
        changes
    }

    /// Resets the control, with the effect of a program end (R1.28).
    pub fn reset(&mut self) -> Vec<Change> {
        self.program_end()
    }

    /// Gives kinds of an axis the selection that they have in another state of the same axes, and
    /// appends the changes.
    pub(crate) fn return_to(
        &mut self,
        other: &Self,
        (axis, kinds): (AxisIndex, KindSet),
        changes: &mut Vec<Change>,
    ) {
        let theirs = other.axes[axis.get()];
        let state = &mut self.axes[axis.get()];
        for kind in kinds.intersection(state.configured).iter() {
            let selected = theirs.selected.contains(kind);
            let selected = if selected {
                Membership::In
            } else {
                Membership::Out
            };
            changes.extend(state.change(axis, kind, |state| {
                state.selected.assign(kind, selected);
                state.unknown.remove(kind);
            }));
        }
    }

    /// Makes kinds of an axis unknown, because a command that decides them depends on a value that
    /// only the machine knows (R2.51), and appends the changes.
    pub fn havoc(&mut self, axis: AxisIndex, kinds: KindSet, changes: &mut Vec<Change>) {
        let state = &mut self.axes[axis.get()];
        for kind in kinds.intersection(state.configured).iter() {
            changes.extend(state.change(axis, kind, |state| state.unknown.insert(kind)));
        }
    }

    /// Records that a program wrote the parameters of a kind into the machine data: until a restart of the control it
    /// is open whether the axis is configured for the kind, and what a command that switches it on does (R2.92).
    pub(crate) fn rewrite(&mut self, axis: AxisIndex, kind: Kind, changes: &mut Vec<Change>) {
        let state = &mut self.axes[axis.get()];
        changes.extend(state.change(axis, kind, |state| {
            state.rewrite(KindSet::of(kind));
            state.unknown.insert(kind);
        }));
    }

    /// Returns the kinds whose parameters a program wrote.
    pub(crate) fn rewritten(&self, axis: AxisIndex) -> KindSet {
        self.axes[axis.get()].rewritten
    }

    /// Restores what programs of an earlier session wrote.
    pub(crate) fn restore_rewritten(&mut self, axis: AxisIndex, kinds: KindSet) {
        self.axes[axis.get()].rewrite(kinds);
    }

    /// Adds what a program wrote on another way.
    pub(crate) fn join_rewritten(&mut self, other: &Self) {
        for (mine, theirs) in self.axes.iter_mut().zip(&other.axes) {
            mine.rewrite(theirs.rewritten);
        }
    }

    /// Sets whether an axis is in a coupling: COMP is refused while it is, and the effect of COMP
    /// is unknown while that is open.
    pub fn set_coupled(&mut self, axis: AxisIndex, coupling: Coupling) {
        self.axes[axis.get()].coupling = coupling;
    }

    /// Returns whether an axis is in a coupling.
    pub fn coupling(&self, axis: AxisIndex) -> Coupling {
        self.axes[axis.get()].coupling
    }

    /// Returns the selected kinds of an axis, for the state file.
    pub fn selected(&self, axis: AxisIndex) -> KindSet {
        self.axes[axis.get()].selected
    }

    /// Returns the unknown kinds of an axis, for the state file.
    pub fn unknown(&self, axis: AxisIndex) -> KindSet {
        self.axes[axis.get()].unknown
    }

    /// Restores the state of an axis that an earlier session left.
    pub fn restore(&mut self, axis: AxisIndex, selected: KindSet, unknown: KindSet) {
        let state = &mut self.axes[axis.get()];
        state.selected = selected;
        state.unknown = unknown;
    }

    /// Sets the kinds of an axis whose value list was accepted. The other kinds' lists are not
    /// read; they count as parameterised.
    pub fn set_parameterised(&mut self, axis: AxisIndex, kinds: KindSet) {
        self.axes[axis.get()].parameterised = kinds;
    }

    /// Returns the kinds of an axis that may differ in another state, or that are unknown in
    /// either.
    pub(crate) fn differing(&self, other: &Self, axis: AxisIndex) -> KindSet {
        let (mine, theirs) = (&self.axes[axis.get()], &other.axes[axis.get()]);
        let symmetric = |one: KindSet, two: KindSet| one.without(two).union(two.without(one));
        let differ = symmetric(mine.selected, theirs.selected)
            .union(symmetric(mine.parameterised, theirs.parameterised));
        let differ = differ.union(mine.unknown).union(theirs.unknown);
        differ.intersection(mine.configured)
    }

    /// Returns whether the value list of a kind counts as accepted.
    pub(crate) fn is_parameterised(&self, axis: AxisIndex, kind: Kind) -> bool {
        self.axes[axis.get()].parameterised.contains(kind)
    }

    /// Makes a kind known: selected or not.
    pub(crate) fn decide(&mut self, axis: AxisIndex, kind: Kind, selected: Membership) {
        let state = &mut self.axes[axis.get()];
        state.selected.assign(kind, selected);
        state.unknown.remove(kind);
    }

    /// Returns whether an axis is configured for a kind.
    pub fn is_configured(&self, axis: AxisIndex, kind: Kind) -> bool {
        self.axes[axis.get()].configured.contains(kind)
    }
}

/// Membership of an axis in a coupling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Coupling {
    /// Member of a coupling.
    Active,
    /// Possible member of a coupling, which only the machine knows.
    Perhaps,
    /// Not a member of a coupling.
    None,
}

crate::words! {
    /// State of one kind on one axis, as a user sees it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum State {
        /// Selected, configured and parameterised: it works.
        Active = "active",
        /// Selected, but no value list was accepted: it does nothing.
        Ineffective = "ineffective",
        /// Configured, but not selected.
        Inactive = "inactive",
        /// The axis parameter that enables it is 0.
        Unconfigured = "unconfigured",
        /// The command that decides it depends on a value that only the machine knows.
        Unknown = "unknown",
    }
}

/// One state that a command changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Change {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// Kind of compensation.
    pub kind: Kind,
    /// The state before the command.
    pub from: State,
    /// The state after it.
    pub to: State,
}

/// The position of an axis in the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct AxisIndex(u16);

impl AxisIndex {
    /// Creates the index from a position in the axis list.
    pub fn new(position: usize) -> Self {
        Self(u16::try_from(position).expect("a control has fewer than 65536 axes"))
    }

    /// Returns the position in the axis list.
    pub fn get(self) -> usize {
        usize::from(self.0)
    }
}

/// The properties of an axis that matter to compensation.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct AxisSetup {
    /// The name in NC programs, case-sensitive.
    pub name: String,
    /// Whether the axis is a spindle; spindles have no COMP.
    pub is_spindle: bool,
    /// The kinds that the axis parameters configure.
    pub configured: KindSet,
    /// The kinds that are known not to be configured, so that the control refuses to switch them on
    /// (R1.24, R1.41).
    pub unselected: KindSet,
    /// The kinds that only the program activates and that switch off at program end (R1.40).
    pub manual: KindSet,
    /// The kinds that have all values they need to work.
    pub parameterised: KindSet,
}

impl AxisSetup {
    /// Creates an axis on which the kinds are configured and parameterised. Of the other kinds,
    /// only FRICT is known not to be configured.
    pub fn new(name: impl Into<String>, configured: KindSet) -> Self {
        Self {
            name: name.into(),
            is_spindle: false,
            configured,
            unselected: KindSet::of(Kind::Frict).without(configured),
            manual: KindSet::NONE,
            parameterised: configured,
        }
    }
}

/// Selection of a COMP bracket.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Selection {
    /// `ON` and the kinds after it.
    On(KindSet),
    /// `OFF` and the kinds after it.
    Off(KindSet),
    /// `OFF_ALL`.
    OffAll,
}

impl Selection {
    /// Returns the kinds that the command names; `OFF_ALL` names every kind (R1.3).
    pub fn kinds(self) -> KindSet {
        match self {
            Self::On(kinds) | Self::Off(kinds) => kinds,
            Self::OffAll => KindSet::ALL,
        }
    }
}

/// One understood COMP command, `X[COMP ON FRICT]`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CompCommand {
    /// The axis before the bracket.
    pub axis: String,
    /// Kinds to switch.
    pub selection: Selection,
    /// Whether the bracket contains `NO_MOVE`, which does not matter to friction compensation (R1.6).
    pub no_move: bool,
    /// Span from the axis name to the closing bracket.
    pub span: Span,
}

/// The reason for which the control, or this tool in its place, refuses a COMP command.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CompensationError {
    /// `X[COMP ON FRICT]` while P-AXIS-00522 of X is 0 (R1.24), and any other kind that the axis
    /// list does not select (R1.41).
    #[error(
        "{} of axis `{axis}` is switched on, but {} is not set",
        named(*.kind),
        .kind.facts().parameter
    )]
    NotConfigured {
        /// The axis of the command.
        axis: String,
        /// The kind that is not configured.
        kind: Kind,
    },
    /// `Q[COMP ON FRICT]` on a machine without an axis Q.
    #[error("the machine has no axis `{axis}`")]
    UnknownAxis {
        /// The name before the bracket.
        axis: String,
    },
    /// `Y[COMP ON FRICT]` in a program of a channel without the axis Y.
    #[error("{why}")]
    NotInChannel {
        /// The axis of the command.
        axis: String,
        /// The reason, in words.
        why: String,
    },
    /// `X[COMP ON FRICT]` between `#ENABLE AX LINK` and `#DISABLE AX LINK` of a coupling with X.
    #[error("axis `{axis}` is in an active coupling; COMP is not allowed")]
    Coupled {
        /// The axis of the command.
        axis: String,
    },
    /// A command that the documents leave open and that the configuration reads as refused (R15.2).
    #[error("by the selected reading ({rule}) the control refuses {what} of axis `{axis}`")]
    ReadAsRefused {
        /// The axis of the command.
        axis: String,
        /// The refused item.
        what: &'static str,
        /// The rule of the question.
        rule: &'static str,
    },
    /// `S[COMP ON FRICT]`.
    #[error("`{axis}` is a spindle; spindles have no COMP")]
    Spindle {
        /// The spindle's name.
        axis: String,
    },
}

impl CompensationError {
    /// Returns the control's error number, or ours if the control documents none.
    pub fn code(&self) -> Code {
        match self {
            Self::NotConfigured { kind, .. } => kind.facts().refusal,
            Self::UnknownAxis { .. } => Code::PErr21947,
            Self::NotInChannel { .. } => Code::PErr20200,
            Self::Coupled { .. } => Code::PErr21403,
            Self::ReadAsRefused { .. } => Code::Fc306,
            Self::Spindle { .. } => Code::Fc302,
        }
    }

    /// Returns the axis that the command names.
    pub fn axis(&self) -> &str {
        match self {
            Self::NotConfigured { axis, .. }
            | Self::UnknownAxis { axis }
            | Self::NotInChannel { axis, .. }
            | Self::Coupled { axis }
            | Self::ReadAsRefused { axis, .. }
            | Self::Spindle { axis } => axis,
        }
    }
}

/// Returns the name of a kind for messages.
fn named(kind: Kind) -> String {
    match kind {
        Kind::Frict => "friction compensation".to_owned(),
        other => format!("`{other}`"),
    }
}
