//! Names of parameters and variables: as programs and users write them, and as a run keeps them.
//!
//! The letters before the name, `V.E.`, may be written in any case. The name itself may not:
//! upper and lower case are distinguished (TF5200 External variables, P-EXTV-00001).

use std::fmt;

use serde::{Deserialize, Serialize};

/// Family of a variable, from the letters before its name as the run keeps it (R2.34).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VariableFamily {
    /// A P parameter, or an array of them.
    Parameter,
    /// `V.P.`
    Program,
    /// `V.L.`
    Local,
    /// `V.CYC.`
    Cycle,
    /// `V.S.`
    Shared,
    /// `V.I.`
    Internal,
    /// `V.E.`
    External,
    /// `V.A.`
    Axis,
    /// Any other variable of the control: `V.G.`.
    Control,
    /// Not a variable.
    Other,
}

impl VariableFamily {
    pub(crate) fn of(array: &str) -> Self {
        match array.as_bytes() {
            [b'P', ..] => Self::Parameter,
            [b'V', b'.', b'P', b'.', ..] => Self::Program,
            [b'V', b'.', b'L', b'.', ..] => Self::Local,
            [b'V', b'.', b'C', b'Y', b'C', b'.', ..] => Self::Cycle,
            [b'V', b'.', b'S', b'.', ..] => Self::Shared,
            [b'V', b'.', b'I', b'.', ..] => Self::Internal,
            [b'V', b'.', b'E', b'.', ..] => Self::External,
            [b'V', b'.', b'A', b'.', ..] => Self::Axis,
            [b'V', b'.', ..] => Self::Control,
            _ => Self::Other,
        }
    }

    /// Returns whether a program start clears its variables.
    pub(crate) fn is_of_run(self) -> bool {
        matches!(self, Self::Parameter | Self::Program | Self::Cycle)
    }

    /// Returns whether programs write its variables.
    pub(crate) fn is_written(self) -> bool {
        self.is_of_run() || matches!(self, Self::Shared | Self::Internal | Self::Local)
    }

    /// Returns whether only programs write its variables: `V.P.`, `V.L.`, `V.S.`.
    pub(crate) fn is_of_programs(self) -> bool {
        self.is_written() && !matches!(self, Self::Cycle | Self::Internal)
    }

    /// Returns whether its variables end with the level of the program that creates them.
    pub(crate) fn is_of_level(self) -> bool {
        matches!(self, Self::Local | Self::Cycle)
    }

    /// Returns whether others than the program that writes its variables read them (R2.34, R2.36).
    pub(crate) fn is_read_by_others(self) -> bool {
        matches!(
            self,
            Self::Shared | Self::Internal | Self::External | Self::Axis | Self::Control
        )
    }
}

/// Name of a variable, of an array, or of an element of an array.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) struct VariableName {
    /// The name before the first subscript, without blanks, its family in upper case.
    array: String,
    subscripts: Subscripts,
}

/// The way from an array to one of its elements; empty for a variable or a whole array.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub(crate) struct Subscripts(Vec<Subscript>);

/// A step from an array to one of its elements.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) enum Subscript {
    /// `[2]`
    Number(i64),
    /// `[X]`: a text, or an expression that is not evaluated.
    Word(Box<str>),
    /// `.x`: a field of an element.
    Field(Box<str>),
}

impl VariableName {
    /// Reads a name whose subscripts count as they are written: `V.E.A[P1,2]`.
    pub(crate) fn read(text: &str) -> Self {
        Self::assembled(text, |written| Some(Subscript::read(written)))
    }

    /// Reads a name with the values of its subscripts in their places.
    pub(crate) fn with_values(text: &str, values: Vec<Subscript>) -> Self {
        let mut values = values.into_iter();
        Self::assembled(text, |_| values.next())
    }

    /// Reads the whole array of an element.
    pub(crate) fn array_of(text: &str) -> Self {
        let (array, _) = divided(text);
        Self::assembled(array, |_| None)
    }

    /// Reads the first argument of a function: `V.P.A` of `SIZEOF[V.P.A, 2]`.
    pub(crate) fn first_argument(call: &str) -> Self {
        let arguments = divided(call).1.strip_prefix('[').unwrap_or_default();
        let end = arguments.find(['[', ']', ',']);
        Self::array_of(
            arguments
                .get(..end.unwrap_or(arguments.len()))
                .unwrap_or_default(),
        )
    }

    /// Returns the name of a P parameter.
    pub(crate) fn parameter(index: u32) -> Self {
        Self::whole(format!("P{index}"))
    }

    /// Returns the name of an own parameter of a call.
    pub(crate) fn own_parameter(index: u32) -> Self {
        Self::whole(format!("@P{index}"))
    }

    /// Returns a variable or a whole array.
    pub(crate) fn whole(array: String) -> Self {
        Self {
            array,
            subscripts: Subscripts::default(),
        }
    }

    /// Returns an element of the array.
    pub(crate) fn at(&self, subscripts: Subscripts) -> Self {
        Self {
            array: self.array.clone(),
            subscripts,
        }
    }

    /// Returns the variable, or the array that an element belongs to.
    pub(crate) fn array(&self) -> &str {
        &self.array
    }

    pub(crate) fn subscripts(&self) -> &Subscripts {
        &self.subscripts
    }

    pub(crate) fn is_element(&self) -> bool {
        !self.subscripts.0.is_empty()
    }

    pub(crate) fn family(&self) -> VariableFamily {
        VariableFamily::of(&self.array)
    }

    /// Returns the number of a P parameter.
    pub(crate) fn parameter_index(&self) -> Option<u32> {
        let number = self.array.strip_prefix('P')?;
        number.parse().ok().filter(|_| !self.is_element())
    }

    /// Returns the variable of an axis and the axis: `LIFT.ACTIVE` and `X` of `V.A.LIFT.ACTIVE.X`.
    pub(crate) fn of_axis(&self) -> Option<(&str, AxisOfVariable<'_>)> {
        let variable = self.array.strip_prefix("V.A.")?;
        match self.subscripts.0.as_slice() {
            [] => {
                let (variable, axis) = variable.rsplit_once('.')?;
                Some((variable, AxisOfVariable::Name(axis)))
            }
            [Subscript::Number(index)] => {
                let index = usize::try_from(*index).ok()?;
                Some((variable, AxisOfVariable::Index(index)))
            }
            _ => None,
        }
    }

    /// Returns whether it is the array or structure of a name, or belongs to it.
    pub(crate) fn is_in(&self, whole: &Self) -> bool {
        self.is_any(|it| it == whole)
    }

    /// Returns whether a name, or that of an array or structure that it belongs to, is one of some.
    pub(crate) fn is_any(&self, is_it: impl Fn(&Self) -> bool) -> bool {
        let structures = self.array.match_indices('.');
        let structures = structures.map(|(end, _)| Self::whole(self.array[..end].to_owned()));
        let elements = (0..=self.subscripts.0.len())
            .map(|length| self.at(Subscripts(self.subscripts.0[..length].to_vec())));
        structures.chain(elements).any(|it| is_it(&it))
    }

    fn assembled(text: &str, mut step: impl FnMut(&str) -> Option<Subscript>) -> Self {
        let compact = compact(text);
        let (array, mut rest) = divided(&compact);
        let mut subscripts = Vec::new();
        while !rest.is_empty() {
            let Some(inner) = rest.strip_prefix('[') else {
                let (field, after) = divided(rest);
                let fields = field.split('.').filter(|field| !field.is_empty());
                subscripts.extend(fields.map(|field| Subscript::Field(field.into())));
                rest = after;
                continue;
            };
            let (mut depth, mut start, mut end) = (1_usize, 0, inner.len());
            for (at, sign) in inner.char_indices() {
                match sign {
                    '[' => depth += 1,
                    ']' => depth -= 1,
                    ',' if depth == 1 => {
                        subscripts.extend(step(&inner[start..at]));
                        start = at + 1;
                    }
                    _ => {}
                }
                if depth == 0 {
                    end = at;
                    break;
                }
            }
            subscripts.extend(step(&inner[start..end]));
            rest = inner.get(end + 1..).unwrap_or_default();
        }
        let (family, name) = array.split_at(family_length(array));
        Self {
            array: family.to_ascii_uppercase() + name,
            subscripts: Subscripts(subscripts),
        }
    }
}

impl fmt::Display for VariableName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.array)?;
        for step in &self.subscripts.0 {
            match step {
                Subscript::Number(number) => write!(f, "[{number}]")?,
                Subscript::Word(word) => write!(f, "[{word}]")?,
                Subscript::Field(field) => write!(f, ".{field}")?,
            }
        }
        Ok(())
    }
}

/// The axis that a variable of the control belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AxisOfVariable<'a> {
    /// `V.A.ABS.X`
    Name(&'a str),
    /// `V.A.ABS[0]`
    Index(usize),
}

impl Subscripts {
    /// Returns the numbers that lead to an element; `None` where a step is a word or a field.
    pub(crate) fn numbers(&self) -> Option<Vec<i64>> {
        let number = |step: &Subscript| match step {
            Subscript::Number(number) => Some(*number),
            Subscript::Word(_) | Subscript::Field(_) => None,
        };
        self.0.iter().map(number).collect()
    }

    pub(crate) fn as_slice(&self) -> &[Subscript] {
        &self.0
    }

    /// Returns whether they lead to an element, or to a part of it.
    pub(crate) fn starts_with(&self, outer: &Self) -> bool {
        self.0.starts_with(&outer.0)
    }

    /// Returns the number of bytes that they hold beside the name.
    pub(crate) fn len(&self) -> usize {
        let bytes = |step: &Subscript| match step {
            Subscript::Number(_) => size_of::<u32>(),
            Subscript::Word(text) | Subscript::Field(text) => text.len(),
        };
        self.0.iter().map(bytes).sum()
    }
}

impl FromIterator<Subscript> for Subscripts {
    fn from_iter<I: IntoIterator<Item = Subscript>>(steps: I) -> Self {
        Self(steps.into_iter().collect())
    }
}

impl Subscript {
    /// Reads a subscript, which is a number or any other text.
    pub(crate) fn read(text: &str) -> Self {
        let number = text.parse().map(Self::Number);
        number.unwrap_or_else(|_| Self::Word(text.into()))
    }
}

/// Returns the text of a variable in a program without the blanks that it may contain.
pub(crate) fn compact(text: &str) -> String {
    text.split_whitespace().collect()
}

/// Divides a text before its first bracket.
fn divided(text: &str) -> (&str, &str) {
    text.split_at(text.find('[').unwrap_or(text.len()))
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
            assert_eq!(VariableName::read(name).family(), family, "{name}");
        }
    }

    #[test]
    fn a_name_is_kept_without_blanks_and_its_family_in_upper_case() {
        // R2.36
        for (written, kept) in [
            ("V.E.Part", "V.E.Part"),
            ("v.e.Part", "V.E.Part"),
            ("V . spdl . n", "V.SPDL.n"),
            ("@p5", "@P5"),
            ("p7[1]", "P7[1]"),
            ("\u{e4}", "\u{e4}"),
            ("v.e.List[P1, 2].x", "V.E.List[P1][2].x"),
            ("V.E.A[B[1,2],3", "V.E.A[B[1,2]][3]"),
            ("V.E.A[", "V.E.A[]"),
        ] {
            assert_eq!(VariableName::read(written).to_string(), kept, "{written}");
        }
        let values = vec![Subscript::Number(2)];
        let element = VariableName::with_values("v.e.A[P1+1].x", values);
        assert_eq!(element, VariableName::read("V.E.A[2].x"));
    }
}
