//! The conditions of ways, as data and in words (R14.2, R14.5).

use std::borrow::Cow;
use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::comp::{Kind, State};
use crate::diagnostic::{Diagnostic, Severity};
use crate::text::in_a_row;

/// Ways that are named for a state.
pub(crate) const MAX_NAMED: usize = 4;

/// A condition of a way.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
#[non_exhaustive]
pub enum WayCondition {
    /// A condition of a control block.
    Condition(BlockCondition),
    /// A case of a `$SWITCH`.
    Case(BlockCondition),
    /// Repetition of a loop.
    Loop(BlockCondition),
    /// Answer of a probe.
    Probe(BlockCondition),
    /// The switch of a skip level.
    Skip {
        /// The level.
        level: u8,
        /// Whether the blocks are executed.
        executed: bool,
        /// The file of its first block.
        file: Arc<str>,
        /// The line of its first block.
        line: u32,
        /// The change that the way needs.
        #[serde(skip_serializing_if = "Option::is_none")]
        changed: Option<WayChange>,
    },
    /// State of an axis after a call of a program that only the machine has (R2.83).
    Call {
        /// The file of the call.
        file: Arc<str>,
        /// The line of the call, from 1.
        line: u32,
        /// The program.
        #[serde(serialize_with = "as_text")]
        text: Arc<str>,
        /// The name of the axis.
        #[serde(serialize_with = "as_text")]
        axis: Arc<str>,
        /// The kind of compensation.
        compensation: Kind,
        /// Whether the kind is selected after the call.
        on: bool,
    },
    /// The reading of a block search (R2.96).
    Search {
        /// The file of the searched block.
        file: Arc<str>,
        /// The line of the searched block, from 1.
        line: u32,
        /// Whether the search executes the commands that it passes.
        executed: bool,
    },
    /// End of the program by an error: `#ERROR` without a remedy class (R2.100), a feed move without a feed (R2.110).
    Stop {
        /// The file of the block.
        file: Arc<str>,
        /// The line of the block, from 1.
        line: u32,
        /// The error in words.
        #[serde(serialize_with = "as_text")]
        text: Arc<str>,
        /// Whether the error ends the program.
        stops: bool,
    },
    /// Start after an error with the remedy class 7 (R2.100).
    Restart {
        /// The file of the command.
        file: Arc<str>,
        /// The line of the command, from 1.
        line: u32,
        /// Whether the control is restarted, not only reset.
        restarted: bool,
    },
    /// The state in which an axis is found.
    Found {
        /// The name of the axis.
        axis: String,
        /// The kind of compensation.
        compensation: Kind,
        /// The state.
        state: State,
    },
}

/// Condition of a block.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
#[non_exhaustive]
pub struct BlockCondition {
    /// Path of the file.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
    /// The text of the condition.
    #[serde(serialize_with = "as_text")]
    pub text: Arc<str>,
    /// Whether the condition holds.
    pub holds: bool,
    /// The change that the way needs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub changed: Option<WayChange>,
}

/// A change of a value of the machine without which a way contradicts its own earlier condition (R14.1).
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
#[non_exhaustive]
pub struct WayChange {
    /// Name of the value that changes.
    #[serde(serialize_with = "as_text")]
    pub name: Arc<str>,
    /// The file of the earlier condition.
    pub file: Arc<str>,
    /// The line of the earlier condition, from 1.
    pub line: u32,
}

fn as_text<S: Serializer>(text: &Arc<str>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(text)
}

/// Ways as words, as seen from a file: `V.E.A == 2 (line 12), or if skip level 1 is on`.
pub(crate) fn ways_in_words(ways: &[Vec<WayCondition>], file: &str) -> String {
    let named = ways.len().min(MAX_NAMED);
    in_words(&ways[..named], ways.len() - named, ", or if ", file)
}

/// Returns the words after `if`, or after `only if` where a value of the machine must change on each way.
pub(crate) fn if_ways(ways: &[Vec<WayCondition>], file: &str) -> String {
    let named = ways.len().min(MAX_NAMED);
    after_if(&ways[..named], ways.len() - named, file)
}

/// Adds to a message the ways on which it applies (R14.5). One that is not an error and applies only if a
/// value of the machine changes in between is information only (R14.1).
pub(crate) fn limit_to(said: &mut Diagnostic, ways: &[Vec<WayCondition>]) {
    // A program that continues is the usual case and is not named.
    let goes_on = |it: &WayCondition| matches!(it, WayCondition::Stop { stops: false, .. });
    let mut ways = Cow::Borrowed(ways);
    if ways.iter().flatten().any(goes_on) {
        let told = ways.to_mut().iter_mut();
        told.for_each(|way| way.retain(|it| !goes_on(it)));
    }
    if said.code.is_about_text() || ways.is_empty() || ways.iter().any(Vec::is_empty) {
        return;
    }
    let words = if_ways(&ways, &said.place.file);
    said.message = format!("{}, {words}", said.message);
    if all_need_change(&ways) && said.severity != Severity::Error {
        said.lower(Severity::Info);
    }
}

/// Returns whether each of some ways needs a value of the machine to change between two conditions. The ways that need
/// no change come before the others.
pub(crate) fn all_need_change(ways: &[Vec<WayCondition>]) -> bool {
    !ways.is_empty() && ways.iter().all(|way| needs_change(way))
}

pub(crate) fn needs_change(way: &[WayCondition]) -> bool {
    way.iter().any(|condition| condition.changed().is_some())
}

pub(crate) fn after_if(ways: &[Vec<WayCondition>], more: usize, file: &str) -> String {
    let only = if all_need_change(ways) { "only " } else { "" };
    format!("{only}if {}", in_words(ways, more, ", or if ", file))
}

/// Returns the words for all other ways.
pub(crate) fn unless(ways: &[Vec<WayCondition>], more: usize, file: &str) -> String {
    format!("unless {}", in_words(ways, more, ", or ", file))
}

fn in_words(ways: &[Vec<WayCondition>], more: usize, or: &str, file: &str) -> String {
    let named = ways.iter().map(|way| way_in_words(way, file));
    let mut words = named.collect::<Vec<_>>().join(or);
    match more {
        0 => {}
        1 => words.push_str(", and on 1 more way"),
        more => words = format!("{words}, and on {more} more ways"),
    }
    words
}

/// Returns one way in words; two conditions between which a value changes are named as that change.
fn way_in_words(way: &[WayCondition], file: &str) -> String {
    let changes = way.iter().filter_map(WayCondition::changed);
    let is_earlier = |condition: &WayCondition| {
        let place = condition.place();
        let mut changes = changes.clone();
        changes.any(|change| place == Some((&change.file, change.line)))
    };
    let named = way
        .iter()
        .filter(|it| it.changed().is_some() || !is_earlier(it));
    let conditions: Vec<String> = named.map(|it| it.in_words(file)).collect();
    conditions.join(" and ")
}

impl WayChange {
    /// Returns `V.E.A changes between lines 1 and 9`.
    pub(crate) fn in_words(&self, (of, line): (&str, u32), file: &str) -> String {
        let Self {
            name, line: since, ..
        } = self;
        if *self.file == *file && of == file {
            return format!("{name} changes between lines {since} and {line}");
        }
        let [earlier, later] =
            [(&*self.file, *since), (of, line)].map(|place| seen_from(place, file));
        format!("{name} changes between {earlier} and {later}")
    }
}

pub(crate) fn seen_from((of, line): (&str, u32), file: &str) -> String {
    if of == file {
        format!("line {line}")
    } else {
        format!("{of}:{line}")
    }
}

impl WayCondition {
    /// Returns the condition in words, as seen from a file: `V.E.A == 2 (line 12)`, or `(sub.nc:12)`.
    pub fn in_words(&self, file: &str) -> String {
        if let Some((change, (of, line))) = self.changed().zip(self.place()) {
            return change.in_words((of, line), file);
        }
        match self {
            Self::Condition(asked) | Self::Case(asked) | Self::Loop(asked) => {
                let not = if asked.holds { "" } else { "not " };
                let place = asked.seen_from(file);
                if asked.text.contains("||") || asked.text.contains("&&") {
                    format!("{not}[{}] ({place})", asked.text)
                } else {
                    format!("{not}{} ({place})", asked.text)
                }
            }
            Self::Probe(asked) => {
                let word = if asked.holds {
                    "answers"
                } else {
                    "does not answer"
                };
                format!("the probe {word} ({})", asked.seen_from(file))
            }
            Self::Skip {
                level, executed, ..
            } => {
                let word = if *executed { "off" } else { "on" };
                format!("skip level {level} is {word}")
            }
            Self::Call {
                file: of,
                line,
                text,
                axis,
                compensation,
                on,
            } => {
                let word = if *on { "on" } else { "off" };
                let place = seen_from((of, *line), file);
                match compensation {
                    Kind::Frict => format!("`{text}` leaves {axis} {word} ({place})"),
                    kind => format!("`{text}` leaves {kind} of {axis} {word} ({place})"),
                }
            }
            Self::Search { executed, .. } => {
                let word = if *executed {
                    "executes"
                } else {
                    "only decodes"
                };
                format!("the block search {word} what it passes")
            }
            Self::Stop {
                file: of,
                line,
                text,
                stops,
            } => {
                let word = if *stops {
                    "ends the program"
                } else {
                    "lets the program go on"
                };
                format!("{text} {word} ({})", seen_from((of, *line), file))
            }
            Self::Restart {
                file: of,
                line,
                restarted,
            } => {
                let word = if *restarted {
                    "restarted"
                } else {
                    "only reset"
                };
                let place = seen_from((of, *line), file);
                format!("the control is {word} after the error ({place})")
            }
            Self::Found {
                axis,
                compensation: Kind::Frict,
                state,
            } => format!("{axis} is {state} at the start"),
            Self::Found {
                axis,
                compensation,
                state,
            } => format!("{compensation} of {axis} is {state} at the start"),
        }
    }
}

impl WayCondition {
    /// Returns the condition that holds where this one of a block does not.
    pub(crate) fn affirmed(&self) -> Option<Self> {
        let mut affirmed = self.clone();
        let (Self::Condition(asked) | Self::Case(asked) | Self::Loop(asked)) = &mut affirmed else {
            return None;
        };
        let is_denied = !asked.holds && asked.changed.is_none();
        asked.holds = true;
        is_denied.then_some(affirmed)
    }

    /// Returns the change of a value without which it contradicts an earlier condition of its way.
    fn changed(&self) -> Option<&WayChange> {
        match self {
            Self::Condition(asked) | Self::Case(asked) | Self::Loop(asked) | Self::Probe(asked) => {
                asked.changed.as_ref()
            }
            Self::Skip { changed, .. } => changed.as_ref(),
            Self::Call { .. }
            | Self::Search { .. }
            | Self::Stop { .. }
            | Self::Restart { .. }
            | Self::Found { .. } => None,
        }
    }

    fn place(&self) -> Option<(&Arc<str>, u32)> {
        match self {
            Self::Condition(asked) | Self::Case(asked) | Self::Loop(asked) | Self::Probe(asked) => {
                Some((&asked.file, asked.line))
            }
            Self::Skip { file, line, .. }
            | Self::Call { file, line, .. }
            | Self::Search { file, line, .. }
            | Self::Stop { file, line, .. }
            | Self::Restart { file, line, .. } => Some((file, *line)),
            Self::Found { .. } => None,
        }
    }
}

impl BlockCondition {
    fn seen_from(&self, file: &str) -> String {
        seen_from((&self.file, self.line), file)
    }
}

/// Limit of the axes that a message names.
const MAX_NAMED_AXES: usize = 8;

/// Returns the name of a kind of several axes in a message.
pub(crate) fn of_axes(kind: Kind, axes: &[&str]) -> String {
    let mut shown: Vec<String> = axes
        .iter()
        .take(MAX_NAMED_AXES)
        .map(|it| format!("`{it}`"))
        .collect();
    let more = axes.len() - shown.len();
    if more > 0 {
        shown.push(format!("{more} more"));
    }
    format!("`{}` of {}", kind.as_str(), in_a_row(&shown))
}
