//! Remarks on a whole program: FC326, it is plainly one of another control (R2.97); the machine is not described (R1.37).

use crate::diagnostic::{Advice, Code, Diagnostic};
use crate::machine::Machine;
use crate::syntax::{Foreign, foreign};
use crate::text::{Place, Span, lines_of};

/// Number of messages about such a file: this one and 20 others.
pub(super) const MAX_SAID: usize = 21;

/// Looks at the head of a program.
pub(super) fn look(file: &str, head: &str) -> Option<Diagnostic> {
    let found = foreign(head)?;
    let mut lines = lines_of(head).zip(1..);
    let (line, number) = lines.find(|(line, _)| !line.trim().is_empty())?;
    let place = Place {
        file: file.into(),
        text: line.trim_end().into(),
        first_line: number,
        span: Span::new(0, line.trim_end().len()),
    };
    let Foreign {
        dialect,
        words,
        blocks,
        of,
    } = found;
    let words = words.join("`, `");
    let message = format!(
        "this is a program for {dialect}, not for an ISG control: {blocks} of the first {of} blocks have words such as `{words}`"
    );
    let help = "its other messages are meaningless; leave the program out, or translate it";
    Some(Diagnostic::new(Code::Fc326, place, message).with_help(help))
}

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
