//! The machine behind a handle.

use std::ffi::CString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use frictcomp::comp::{AxisIndex, Kind};
use frictcomp::machine::Machine;
use frictcomp::syntax::parse_comp;
use frictcomp_host::{ConfigurationChoice, FileRegistry, LoadedMachine, MachineOptions, Machines};

use crate::failure::{Failure, c_text, line};

/// A machine: its axes, and what the lists of the control say about their compensation.
#[derive(Debug)]
pub struct FrictcompMachine {
    machine: Machine,
    names: Vec<CString>,
    messages: Vec<CString>,
    errors: usize,
}

impl FrictcompMachine {
    /// The machine of a start-up list or, if the file has that name, of a `frictcomp.toml`.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let is_configuration = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
        let mut options = MachineOptions::default();
        if is_configuration {
            options.configuration = ConfigurationChoice::File(path.to_owned());
        } else {
            options.configuration = ConfigurationChoice::Isolated;
            options.startup = Some(PathBuf::from(path));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let loaded = Machines::new(options, &FileRegistry::default()).for_folder(folder)?;
        Ok(Self::of(&loaded))
    }

    fn of(loaded: &Arc<LoadedMachine>) -> Self {
        Self {
            names: names(&loaded.machine),
            messages: loaded
                .diagnostics
                .iter()
                .map(|said| c_text(&line(said)))
                .collect(),
            errors: loaded.errors().count(),
            machine: loaded.machine.clone(),
        }
    }

    /// The machine without lists: the usual axes, none of them configured.
    pub(crate) fn unconfigured() -> Self {
        let machine = Machine::unconfigured();
        Self {
            names: names(&machine),
            messages: Vec::new(),
            errors: 0,
            machine,
        }
    }

    /// Assumes friction compensation on an axis.
    pub(crate) fn enable(&mut self, name: &str) -> Result<(), Failure> {
        if self.machine.find(name).is_none() && !may_be_axis(name) {
            return Err(Failure::bad(format!("`{name}` is not an axis name")));
        }
        if !self.machine.enable(name) {
            return Err(Failure::bad(format!("the machine has no axis `{name}`")));
        }
        self.names = names(&self.machine);
        Ok(())
    }

    pub(crate) fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The names of the axes, in the machine's order.
    pub(crate) fn names(&self) -> &[CString] {
        &self.names
    }

    pub(crate) fn find(&self, name: &str) -> Result<AxisIndex, Failure> {
        let found = self.machine.find(name);
        found.ok_or_else(|| Failure::bad(format!("the machine has no axis `{name}`")))
    }

    /// The messages about the lists, a line each.
    pub(crate) fn messages(&self) -> &[CString] {
        &self.messages
    }

    /// Returns the number of errors among the messages.
    pub(crate) fn errors(&self) -> usize {
        self.errors
    }
}

/// Returns whether a program can name an axis so where no list does (R2.20): in capital letters, not by `Q` alone, which
/// is an axis only where a list says so, and not by a word of the COMP command.
fn may_be_axis(name: &str) -> bool {
    let is_word = matches!(name, "Q" | "COMP" | "ALL") || name.parse::<Kind>().is_ok();
    let is_capital = !name.contains(|letter: char| letter.is_ascii_lowercase());
    let command = parse_comp(&format!("{name}[COMP ON FRICT]"));
    is_capital && !is_word && matches!(command, Ok(Some(command)) if command.axis == name)
}

fn names(machine: &Machine) -> Vec<CString> {
    machine.axes.iter().map(|axis| c_text(&axis.name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_is_no_name_makes_no_axis() {
        // R13.14, R13.16
        let mut machine = FrictcompMachine::unconfigured();
        let before = machine.names().len();
        for name in [
            "",
            " ",
            "x y",
            "X[",
            "7",
            "X;",
            "X Y",
            "P1",
            "X\n",
            "G",
            "Q",
            "x",
            "COMP",
            "CROSS",
            "/X",
            "N1X",
            "X[COMP ON FRICT]\nY",
        ] {
            assert!(machine.enable(name).is_err(), "{name}");
        }
        assert_eq!(machine.names().len(), before);
        for name in ["X", "X2", "Z_AXIS", "Q1"] {
            assert!(machine.enable(name).is_ok(), "{name}");
        }
    }
}
