//! What programs leave of the control to the next one besides compensation and variables: couplings and exchanged axes
//! (R2.105), files that they changed (R2.108), and macros (R2.35).

use std::collections::{BTreeMap, BTreeSet};

use crate::comp::AxisIndex;
use crate::interpreter::control::{ChangedFiles, ControlState};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::value::Value;
use crate::machine::Machine;

/// What some program may have left: each part is that of the start of the control, or this.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct LastingState {
    /// The axes that groups in force may couple.
    coupled: BTreeSet<AxisIndex>,
    /// The axes that groups may couple once they are enabled.
    grouped: BTreeSet<AxisIndex>,
    /// Whether names of axes may mean others.
    pub(crate) exchanged: bool,
    files: ChangedFiles,
    /// The code of each macro, if every program defines it alike.
    macros: BTreeMap<String, Value>,
}

impl LastingState {
    /// Adds what another program may have left.
    pub(crate) fn add(&mut self, other: &Self) {
        self.coupled.extend(&other.coupled);
        self.grouped.extend(&other.grouped);
        self.exchanged |= other.exchanged;
        self.files.join(&other.files);
        for (name, code) in &other.macros {
            let known = self.macros.entry(name.clone()).or_insert(code.clone());
            if known != code {
                *known = unknown(name);
            }
        }
    }
}

/// Returns the code of a macro that programs define in several ways.
fn unknown(name: &str) -> Value {
    Value::Unknown(Unknown::Macro(name.into()))
}

/// Returns the memory of the start of the control.
fn memory_at_start(machine: &Machine) -> Memory {
    let mut memory = Memory::default();
    for (name, code) in &machine.programs.macros {
        memory.define_macro(name, code);
    }
    memory
}

impl ControlState {
    /// Returns what differs from the start of the control and outlives the program.
    pub(crate) fn lasting(&self, machine: &Machine) -> LastingState {
        let start = memory_at_start(machine);
        let macros = self.memory.macros.iter();
        let macros = macros.filter(|(name, code)| start.macro_code(name) != Some(code));
        LastingState {
            coupled: self.couplings.perhaps_in_force(),
            grouped: self.couplings.perhaps_defined(),
            exchanged: !self.channel_axes.are_own(),
            files: self.files.clone(),
            macros: macros
                .map(|(name, code)| (name.clone(), code.clone()))
                .collect(),
        }
    }

    /// Takes over what an earlier program may have left. What the start of a program resets ends with it.
    pub(crate) fn find_lasting(&mut self, found: &LastingState) {
        if !found.grouped.is_empty() {
            self.couplings.lose(found.grouped.iter().copied());
        }
        if !found.coupled.is_empty() {
            self.couplings.lose(found.coupled.iter().copied());
            self.havoc_couplings();
        }
        if found.exchanged {
            self.channel_axes.havoc();
        }
        self.files.join(&found.files);
        for (name, code) in &found.macros {
            let is_new = self.memory.macro_code(name).is_none_or(|own| own == code);
            let code = if is_new { code.clone() } else { unknown(name) };
            self.memory.hold_macro(name, code);
        }
    }
}
