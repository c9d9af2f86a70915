//! What stands above everything that depends on a machine that is not described (R1.37).

use crate::machine::Machine;

/// Says that no machine is described, and how to mend it for the axes that the programs switch.
/// `None` where one is.
pub fn undescribed(machine: &Machine, switched: &[String]) -> Option<String> {
    if machine.is_described() {
        return None;
    }
    let mut text = "no machine is described, so P-AXIS-00522 counts as 0 on every axis: describe \
                    it with `frictcomp init`, or assume friction compensation with `--enable"
        .to_owned();
    if !switched.is_empty() {
        text.push(' ');
        text.push_str(&switched.join(","));
    }
    text.push('`');
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_axes_are_proposed_in_one_list() {
        // R1.37
        let axes = ["X".to_owned(), "Y".to_owned()];
        let said = undescribed(&Machine::unconfigured(), &axes).unwrap_or_default();
        assert!(said.contains("`frictcomp init`"), "{said}");
        assert!(said.ends_with("`--enable X,Y`"), "{said}");
        let said = undescribed(&Machine::unconfigured(), &[]).unwrap_or_default();
        assert!(said.ends_with("`--enable`"), "{said}");
        assert_eq!(undescribed(&Machine::enabled(["X"]), &axes), None);
    }
}
