//! The remark above every result that depends on a machine that is not described (R1.37).

use crate::diagnostic::Advice;
use crate::machine::Machine;

/// Says that no machine is described, and how to mend it for the axes that the programs switch.
/// `None` where one is.
pub fn undescribed(machine: &Machine, switched: &[String]) -> Option<Advice> {
    (!machine.is_described()).then(|| Advice::DescribeMachine(switched.to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_axes_are_proposed_in_one_list() {
        // R1.37
        let axes = ["X".to_owned(), "Y".to_owned()];
        let said = undescribed(&Machine::unconfigured(), &axes).map(|said| said.to_string());
        assert!(said.is_some_and(|said| said.ends_with("friction compensation of X, Y")));
        let said = undescribed(&Machine::unconfigured(), &[]).map(|said| said.to_string());
        assert!(said.is_some_and(|said| said.ends_with("assume friction compensation")));
        assert_eq!(undescribed(&Machine::enabled(["X"]), &axes), None);
    }
}
