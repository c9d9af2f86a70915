//! Names of parameters and variables: as the run keeps them, and as programs and users write them.
//!
//! The letters before the name, `V.E.`, may be written in any case. The name itself may not:
//! upper and lower case are distinguished (TF5200 External variables, P-EXTV-00001).

use std::borrow::Cow;

/// Family of a variable, from the letters before its name as the run keeps it (R2.34).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::interpreter) enum VariableFamily {
    /// An array of P parameters.
    Parameter,
    /// `V.P.`
    Program,
    /// `V.L.`
    Local,
    /// `V.CYC.`
    Cycle,
    /// `V.S.`
    Shared,
    /// `V.E.`
    External,
    /// `V.A.`
    Axis,
    /// Any other variable of the control: `V.G.`.
    Control,
    /// No variable.
    Other,
}

impl VariableFamily {
    pub(in crate::interpreter) fn of(name: &str) -> Self {
        match name.as_bytes() {
            [b'P', ..] => Self::Parameter,
            [b'V', b'.', b'P', b'.', ..] => Self::Program,
            [b'V', b'.', b'L', b'.', ..] => Self::Local,
            [b'V', b'.', b'C', b'Y', b'C', b'.', ..] => Self::Cycle,
            [b'V', b'.', b'S', b'.', ..] => Self::Shared,
            [b'V', b'.', b'E', b'.', ..] => Self::External,
            [b'V', b'.', b'A', b'.', ..] => Self::Axis,
            [b'V', b'.', ..] => Self::Control,
            _ => Self::Other,
        }
    }

    /// Whether a program start clears its variables.
    pub(in crate::interpreter) fn is_of_run(self) -> bool {
        matches!(self, Self::Parameter | Self::Program | Self::Cycle)
    }

    /// Whether programs write its variables.
    pub(in crate::interpreter) fn is_written(self) -> bool {
        self.is_of_run() || matches!(self, Self::Shared | Self::Local)
    }

    /// Whether others than the program that writes its variables read them (R2.34, R2.36).
    pub(in crate::interpreter) fn is_read_by_others(self) -> bool {
        matches!(
            self,
            Self::Shared | Self::External | Self::Axis | Self::Control
        )
    }
}

/// The name under which a variable is kept: without blanks, its family in upper case.
pub(in crate::interpreter) fn canonical(text: &str) -> Cow<'_, str> {
    let family = &text[..family_length(text)];
    let is_upper = !family.bytes().any(|letter| letter.is_ascii_lowercase());
    if is_upper && !text.contains([' ', '\t']) {
        return Cow::Borrowed(text);
    }
    let compact = as_written(text);
    let (family, name) = compact.split_at(family_length(&compact));
    Cow::Owned(family.to_ascii_uppercase() + name)
}

/// The text of a variable in a program, without the blanks that it may contain.
pub(in crate::interpreter) fn as_written(text: &str) -> String {
    text.split_whitespace().collect()
}

/// The name that a user gives a value: that of a variable, an element, or an element as a program
/// writes it, `V.E.A[P1,2]`.
pub(crate) fn set_name(text: &str) -> String {
    canonical(text).replace(',', "][")
}

/// Returns the number of bytes before the name: `V.E.`, `P`, `@P`.
fn family_length(text: &str) -> usize {
    if text.starts_with(['V', 'v']) {
        let mut dots = text.match_indices('.');
        return dots.nth(1).map_or(text.len(), |(at, dot)| at + dot.len());
    }
    let number = text.strip_prefix('@').unwrap_or(text);
    let number = number.strip_prefix(['P', 'p']);
    number.map_or(0, |number| text.len() - number.len())
}

/// The name of an element whose subscripts are replaced by values, one bracket each.
pub(in crate::interpreter) fn with_subscripts(text: &str, values: &[String]) -> String {
    let mut name = String::with_capacity(text.len());
    let mut depth = 0_usize;
    let mut values = values.iter();
    let mut next = |name: &mut String| {
        name.push('[');
        name.push_str(values.next().map_or("", String::as_str));
        name.push(']');
    };
    for c in text.chars() {
        match c {
            '[' => {
                if depth == 0 {
                    next(&mut name);
                }
                depth += 1;
            }
            ']' => depth = depth.saturating_sub(1),
            ',' if depth == 1 => next(&mut name),
            _ if depth > 0 || c.is_whitespace() => {}
            _ => name.push(c),
        }
    }
    match canonical(&name) {
        Cow::Borrowed(_) => name,
        Cow::Owned(name) => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_before_a_name_tell_its_family() {
        // R2.34
        for (name, family) in [
            ("P5[1]", VariableFamily::Parameter),
            ("V.P.A", VariableFamily::Program),
            ("V.CYC.A", VariableFamily::Cycle),
            ("V.CYCLE.A", VariableFamily::Control),
            ("@P1", VariableFamily::Other),
        ] {
            assert_eq!(VariableFamily::of(name), family, "{name}");
        }
    }

    #[test]
    fn the_family_may_be_written_in_any_case() {
        // R2.36
        assert_eq!(canonical("V.E.Part"), "V.E.Part");
        assert_eq!(canonical("v.e.Part"), "V.E.Part");
        assert_eq!(canonical("V . spdl . n"), "V.SPDL.n");
        assert_eq!(canonical("@p5"), "@P5");
        assert_eq!(canonical("p7[1]"), "P7[1]");
        assert_eq!(canonical("\u{e4}"), "\u{e4}");
        assert_eq!(set_name("v.e.List[P1, 2].x"), "V.E.List[P1][2].x");
        let values = ["2".to_owned()];
        assert_eq!(with_subscripts("v.e.A[P1+1].x", &values), "V.E.A[2].x");
    }
}
