//! The audited axes and kinds of a machine, and their states.

use serde::Serialize;

use crate::comp::{AxisIndex, Compensation, Kind, KindSet, State};
use crate::machine::Machine;

/// A kind of compensation on an axis that is configured for it, or friction compensation on an axis that nothing
/// describes (R18.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AuditedKind {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// Kind of compensation.
    pub kind: Kind,
}

/// The audited part of a machine: each configured kind of each axis, and friction compensation of axes that nothing
/// describes; only friction compensation counts unless other kinds are requested.
#[derive(Debug, Clone)]
pub struct Scope {
    subjects: Vec<AuditedKind>,
    /// The range of subjects of each axis.
    by_axis: Vec<std::ops::Range<usize>>,
    /// The subjects whose axes nothing describes, with the names of these.
    undescribed: Vec<(String, usize)>,
    start_up: Compensation,
}

impl Scope {
    /// Creates the scope from the configured axes of a machine and the kinds that count.
    pub fn new(machine: &Machine, kinds: KindSet) -> Self {
        let start_up = machine.compensation();
        let mut subjects = Vec::new();
        let by_axis = (0..start_up.len()).map(AxisIndex::new).map(|axis| {
            let from = subjects.len();
            let is_open = !machine.axis(axis).is_described();
            let counts = |kind: &Kind| {
                start_up.is_configured(axis, *kind) || (is_open && *kind == Kind::Frict)
            };
            let counting = kinds.iter().filter(counts);
            subjects.extend(counting.map(|kind| AuditedKind { axis, kind }));
            from..subjects.len()
        });
        let by_axis = by_axis.collect();
        let open = subjects.iter().enumerate();
        let open = open.filter(|(_, it)| !start_up.is_configured(it.axis, it.kind));
        let named = open.map(|(at, it)| (machine.axis(it.axis).name.clone(), at));
        Self {
            undescribed: named.collect(),
            subjects,
            by_axis,
            start_up,
        }
    }

    /// Returns the audited kinds of the axes, in the order of the machine's axes.
    pub fn subjects(&self) -> &[AuditedKind] {
        &self.subjects
    }

    /// Whether anything says that the axis of a subject is configured for it (R18.2).
    pub(super) fn is_described(&self, at: usize) -> bool {
        self.undescribed.iter().all(|(_, open)| *open != at)
    }

    /// Returns the subject of an axis that nothing describes.
    pub(super) fn undescribed(&self, name: &str) -> Option<usize> {
        let mut open = self.undescribed.iter();
        open.find(|(axis, _)| axis == name).map(|(_, at)| *at)
    }

    /// Returns the state at the start of the control (R1.22).
    pub fn start_up(&self) -> &Compensation {
        &self.start_up
    }

    /// Returns a state that programs may leave: some subjects are away from the start-up state.
    pub(super) fn found(&self, is_away: impl Fn(usize) -> bool) -> Compensation {
        let mut found = self.start_up.clone();
        for (position, range) in self.by_axis.iter().enumerate() {
            let axis = AxisIndex::new(position);
            let mut selected = found.selected(axis);
            for at in range.clone().filter(|at| is_away(*at)) {
                let kind = self.subjects[at].kind;
                if selected.contains(kind) {
                    selected.remove(kind);
                } else {
                    selected.insert(kind);
                }
            }
            let unknown = found.unknown(axis);
            found.restore(axis, selected, unknown);
        }
        found
    }

    /// Returns the range of an axis' subjects.
    #[inline]
    pub(super) fn of_axis(&self, axis: AxisIndex) -> std::ops::Range<usize> {
        self.by_axis[axis.get()].clone()
    }

    /// Returns the selection of a subject that starts in its start-up state or away from it.
    pub(super) fn selected_at_start(&self, subject: AuditedKind, is_away: bool) -> Selected {
        if self.is_on_at_start_up(subject) == is_away {
            Selected::Off
        } else {
            Selected::On
        }
    }

    /// Returns the state of a subject that is in its start-up state or away from it.
    pub(super) fn state(&self, at: usize, is_away: bool) -> State {
        let AuditedKind { axis, kind } = self.subjects[at];
        self.found(|it| is_away && it == at).state(axis, kind)
    }

    /// Whether a subject is selected at the start of the control.
    pub(super) fn is_on_at_start_up(&self, subject: AuditedKind) -> bool {
        self.start_up.selected(subject.axis).contains(subject.kind)
    }
}

crate::words! {
    /// The selection of a kind of compensation on an axis (R1.23), whatever the parameterisation.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum Selected {
        /// It is selected.
        On = "on",
        /// It is not.
        Off = "off",
        /// It is not known offline.
        Unknown = "unknown",
    }
}

impl Selected {
    pub(super) fn digit(self) -> u64 {
        match self {
            Self::On => 1,
            Self::Off => 2,
            Self::Unknown => 3,
        }
    }

    pub(super) fn of(compensation: &Compensation, subject: AuditedKind) -> Self {
        let AuditedKind { axis, kind } = subject;
        if compensation.unknown(axis).contains(kind) {
            Self::Unknown
        } else if compensation.selected(axis).contains(kind) {
            Self::On
        } else {
            Self::Off
        }
    }
}
