//! Axes on which friction compensation is assumed at the user's request (R9.74, R17.7).

use super::axes_ahead::{AxesAhead, may_be_axis};
use crate::disk::Input;
use crate::error::HostError;
use frictcomp::diagnostic::UnknownName;
use frictcomp::machine::{AxisReport, AxisSet, Machine};

/// The axes that programs have: those of their machines, and where none is described, those that
/// they name.
#[derive(Debug, Default)]
pub(crate) struct AxesOfPrograms {
    described: Vec<String>,
    ahead: AxesAhead,
}

impl AxesOfPrograms {
    /// Adds the axes of a described machine.
    pub(crate) fn describe(&mut self, machine: &Machine) {
        for axis in &machine.axes {
            if !self.described.contains(&axis.name) {
                self.described.push(axis.name.clone());
            }
        }
    }

    /// Looks through programs whose machine is not described, for the usual axes and further names.
    pub(crate) fn look<'a>(
        &mut self,
        inputs: impl IntoIterator<Item = &'a Input>,
        names: impl IntoIterator<Item = &'a str>,
    ) {
        self.ahead = AxesAhead::of(inputs, names);
    }

    /// Allows for programs of other runs, which name the usual axes and those of an earlier run.
    pub(crate) fn expect_more(&mut self, left: Vec<String>) {
        self.ahead.expect_more(left);
    }

    /// Returns whether any program may have an axis.
    pub(crate) fn may_hold(&self, name: &str) -> bool {
        self.ahead.may_hold(name) || self.described.iter().any(|known| known == name)
    }

    /// Returns an axis that no program has, with those that they have.
    pub(crate) fn unknown(&self, name: &str) -> UnknownName {
        let described = self.described.iter().map(String::as_str);
        let named: Vec<&'static str> = self.ahead.names().collect();
        let known: Vec<&str> = named.into_iter().chain(described).collect();
        UnknownName::new(name, known.iter().copied())
    }
}

/// Treatment of axes that are to be assumed where no program has any of them (R9.74).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum UnusedAxes {
    /// A mistake in writing.
    #[default]
    Refused,
    /// Unused axes have no effect.
    PassedOver,
}

/// Assumes friction compensation on the axes that the user names, and returns those that the machine
/// has. An axis that only other programs have does not belong to this machine; one that none has is passed over if
/// another is used.
///
/// # Errors
/// A name that no axis can have, or no name that a program has.
pub(crate) fn assume_axes<'a>(
    (names, unused): (&'a [String], UnusedAxes),
    (machine, reports): (&mut Machine, &mut [AxisReport]),
    programs: Option<&AxesOfPrograms>,
) -> Result<Vec<&'a str>, HostError> {
    let (mut assumed, mut refused, mut is_elsewhere) = (Vec::new(), None, false);
    for name in names.iter().map(|name| name.trim()) {
        check_name(name)?;
        let may_be_elsewhere = programs.is_some_and(|programs| programs.may_hold(name));
        is_elsewhere |= may_be_elsewhere;
        let is_described = machine.axis_set != AxisSet::AsTheyOccur;
        let is_here = machine.axes.iter().any(|axis| axis.name == name);
        if is_described && !is_here && may_be_elsewhere {
            continue;
        }
        let occurs = if is_described {
            Ok(())
        } else {
            check_occurs(name, programs)
        };
        match occurs.and_then(|()| enable(machine, name)) {
            Ok(()) => {
                assume(reports, machine, name);
                assumed.push(name);
            }
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    match refused {
        Some(error) if assumed.is_empty() && !is_elsewhere && unused == UnusedAxes::Refused => {
            Err(error)
        }
        _ => Ok(assumed),
    }
}

/// Checks that a program may name an axis, where no machine is described (R9.74). Called programs and pipes may name
/// axes that cannot be known in advance.
fn check_occurs(name: &str, programs: Option<&AxesOfPrograms>) -> Result<(), HostError> {
    match programs {
        Some(programs) if !programs.may_hold(name) => {
            Err(HostError::AxisNotNamed(programs.unknown(name)))
        }
        None if !may_be_axis(name) => Err(HostError::AxisName(name.to_owned())),
        _ => Ok(()),
    }
}

fn check_name(name: &str) -> Result<(), HostError> {
    let word = name.starts_with(|letter: char| letter.is_ascii_alphabetic())
        && name
            .chars()
            .all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if word {
        Ok(())
    } else {
        Err(HostError::AxisName(name.to_owned()))
    }
}

fn enable(machine: &mut Machine, name: &str) -> Result<(), HostError> {
    if machine.enable(name) {
        return Ok(());
    }
    let known = machine.axes.iter().map(|axis| axis.name.as_str());
    Err(HostError::NoAxis(UnknownName::new(name, known)))
}

/// Shows an assumed P-AXIS-00522 among the parameters of its axis.
fn assume(reports: &mut [AxisReport], machine: &Machine, name: &str) {
    let axes = machine.axes.iter().filter(|axis| axis.name == name);
    for axis in axes {
        let report = reports.iter_mut().filter(|report| report.axis == name);
        report.for_each(|report| axis.show_assumed(&mut report.parameters));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_that_the_machine_lacks_is_not_enabled() {
        let mut machine = Machine::unconfigured();
        machine.axis_set = AxisSet::Configured;
        assert!(enable(&mut machine, "X").is_ok());
        let error = enable(&mut machine, "XX").unwrap_err();
        assert_eq!(error.to_string(), "the machine has no axis `XX`");
        assert_eq!(error.help().as_deref(), Some("did you mean `X`?"));
        assert!(check_name("X[").is_err());
    }
}
