//! Static gantries: axes that follow others in the position controller (R1.43).
//!
//! The channel does not know the slave (TF5200 Gantry operation, 285764875, P-AXIS-00070).

use super::axis::{Axis, Parameterisation};
use crate::comp::Kind;
use crate::diagnostic::{Code, Diagnostic};
use crate::lists::{FrictionList, Given};

/// Returns FC140 if the friction compensation of a slave differs from that of its master. `link` is
/// P-AXIS-00070 of the slave.
pub(super) fn compare(master: &Axis, slave: &Axis, link: &Given<u32>) -> Option<Diagnostic> {
    let difference = difference(master, slave)?;
    let message = format!(
        "{} is the static gantry slave of `{}`, but {difference}",
        named(slave),
        master.name
    );
    Some(
        Diagnostic::new(Code::Fc140, link.place(), message)
            .with_axis(slave.name.clone())
            .with_help("both axes make the same motion: compare what each of them needs"),
    )
}

/// Returns the name of a slave, else its number.
fn named(slave: &Axis) -> String {
    match slave.number {
        _ if !slave.name.is_empty() => format!("`{}`", slave.name),
        Some(number) => format!("axis {number}"),
        None => "this axis".to_owned(),
    }
}

/// Returns the difference between two axes, if either has friction compensation.
fn difference(master: &Axis, slave: &Axis) -> Option<String> {
    let is_on = |axis: &Axis| axis.configured.contains(Kind::Frict);
    match (is_on(master), is_on(slave)) {
        (false, false) => None,
        (true, false) => Some("P-AXIS-00522 is 1 on the master only".to_owned()),
        (false, true) => Some("P-AXIS-00522 is 1 on the slave only".to_owned()),
        (true, true) => values(&master.friction, &slave.friction),
    }
}

/// Returns the difference between the value lists of two configured axes.
fn values(master: &Parameterisation, slave: &Parameterisation) -> Option<String> {
    use Parameterisation::Accepted;
    match (master, slave) {
        (Accepted(master), Accepted(slave)) => {
            let keys = differing(master, slave);
            let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
            (!keys.is_empty()).then(|| format!("their value lists differ in {}", keys.join(", ")))
        }
        (Accepted(_), _) => Some("only the master has a value list that is accepted".to_owned()),
        (_, Accepted(_)) => Some("only the slave has a value list that is accepted".to_owned()),
        _ => None,
    }
}

/// Returns the keys of the values that differ.
fn differing(one: &FrictionList, other: &FrictionList) -> Vec<&'static str> {
    let checks = [
        ("table", one.table == other.table),
        ("scaling_factor", one.scaling_factor == other.scaling_factor),
        ("position_delay", one.position_delay == other.position_delay),
        (
            "reversal_lookahead",
            one.reversal_lookahead == other.reversal_lookahead,
        ),
        ("delay_cycles", one.delay_cycles == other.delay_cycles),
    ];
    let unlike = checks.into_iter().filter(|(_, same)| !same);
    unlike.map(|(key, _)| key).collect()
}
