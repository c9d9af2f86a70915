//! A value list as written.

use crate::diagnostic::Diagnostic;
use crate::lists::{AxisValues, Entries, FrictionDraft};

/// The head and the friction parameters of one value list.
#[derive(Debug, Clone, Default)]
pub(super) struct ValueList {
    pub(super) head: AxisValues,
    pub(super) friction: FrictionDraft,
}

impl ValueList {
    pub(super) fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        Self {
            head: AxisValues::from_entries(list, diagnostics),
            friction: FrictionDraft::from_entries(list, diagnostics),
        }
    }
}
