//! Conditions that only the machine knows, as ways name them (R14.2).

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::comp::{Kind, State};
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::externals::SetAt;
use crate::syntax::VariableName;
use crate::text::Place;

/// Answers of one condition, which have a bit each.
pub(crate) const MAX_ANSWERS: usize = 60;

/// Kind of the asking statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum ConditionKind {
    /// `$IF`, `$ELSEIF`, `#IF`.
    Branch,
    /// `$SWITCH`.
    Case,
    /// The target of a jump.
    Jump,
    /// Whether a loop is repeated.
    Loop,
    /// A skip level.
    Skip(u8),
    /// The signal of a probe.
    Probe,
    /// Whether a program that only the machine has leaves a kind selected on an axis; the texts are the
    /// names of the program and of the axis.
    Call(Kind),
    /// Whether the program finds a kind selected on an axis, with its state then; the text is the name of the axis.
    Found(Kind, State),
    /// Whether a block search executes the commands that it passes.
    Search,
    /// Whether `#ERROR` without a remedy class ends the program (R2.100).
    Stop,
    /// Whether the control is restarted after an error, not only reset (R2.100).
    Restart,
}

/// Answers to an earlier condition and to a later one that no value gives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Clash {
    pub(crate) earlier: u32,
    /// Number of the time that the earlier one was asked.
    pub(crate) time: u32,
    /// Value that must change in between.
    pub(crate) name: Arc<str>,
    /// The answers to the earlier one, and those to the later one, a bit each.
    pub(crate) answers: [u64; 2],
}

/// The answers that hold while a variable of the machine keeps the value that the program set (R2.99).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct KeptAnswer {
    /// The variables; states before schema 4 have them in words.
    #[serde(
        alias = "name",
        serialize_with = "in_words",
        deserialize_with = "one_or_more"
    )]
    pub(crate) names: Arc<[VariableName]>,
    /// The block that set it.
    pub(crate) set: SetAt,
    /// The answers, a bit each.
    pub(crate) sides: u64,
}

fn in_words<S: Serializer>(names: &[VariableName], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(names.iter().map(ToString::to_string))
}

fn one_or_more<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Arc<[VariableName]>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Names {
        One(String),
        More(Vec<String>),
    }
    let names = match Names::deserialize(deserializer)? {
        Names::One(name) => vec![name],
        Names::More(names) => names,
    };
    Ok(names.iter().map(|name| VariableName::read(name)).collect())
}

/// A condition that only the machine knows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Condition {
    pub(crate) kind: ConditionKind,
    pub(crate) place: Place,
    /// Text of the condition for each answer but the last, which is that none of them holds.
    pub(crate) texts: Vec<Arc<str>>,
    /// The value that decides.
    pub(crate) cause: Unknown,
    /// Number of the question at its place: a place that is reached again asks again.
    pub(crate) round: u8,
    /// Number of times that its number was given to a question.
    #[serde(default)]
    pub(crate) time: u32,
    /// The answers to earlier conditions that contradict answers to it, unless a value changes in between.
    #[serde(default)]
    pub(crate) clashes: Vec<Clash>,
    /// The answers that what the program wrote gives, unless the machine changes it in between.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) kept: Option<KeptAnswer>,
}

impl Condition {
    /// A condition that is asked for the first time.
    pub(crate) fn new(
        kind: ConditionKind,
        place: Place,
        texts: Vec<Arc<str>>,
        cause: Unknown,
    ) -> Self {
        Self {
            kind,
            place,
            texts,
            cause,
            round: 0,
            time: 0,
            clashes: Vec::new(),
            kept: None,
        }
    }

    /// Renumbers the conditions; those without a number are left out.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> Option<u32>) -> Self {
        let mut copy = self.clone();
        copy.clashes.retain_mut(|clash| {
            let earlier = number(clash.earlier);
            clash.earlier = earlier.unwrap_or(clash.earlier);
            earlier.is_some()
        });
        copy
    }

    /// Whether some answers hold unless the machine changes what the program wrote.
    pub(crate) fn keeps(&self, sides: u64) -> bool {
        self.kept
            .as_ref()
            .is_some_and(|kept| sides & !kept.sides == 0)
    }

    /// Whether each of its answers has a bit.
    pub(crate) fn fits(&self) -> bool {
        self.texts.len() < MAX_ANSWERS
    }

    /// Whether it is the same question at the same place, at any time.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.place.first_line == other.place.first_line
            && self.place.span == other.place.span
            && self.kind == other.kind
            && self.place.file == other.place.file
            && self.texts == other.texts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_in_words_are_read() {
        // R9.32
        for names in ["\"name\":\"V.E.A\"", "\"names\":[\"V.E.A\"]"] {
            let saved = format!("{{{names},\"set\":{{\"file\":\"a.nc\",\"line\":3}},\"sides\":1}}");
            let kept: KeptAnswer = serde_json::from_str(&saved).expect("an answer");
            assert_eq!(*kept.names, [VariableName::read("V.E.A")]);
        }
    }
}
