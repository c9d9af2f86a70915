//! Advice on a diagnostic, as data, and known words that resemble an unknown one.

use std::borrow::Cow;
use std::fmt;

use serde::{Serialize, Serializer};

use super::codes::Code;

/// A bound of the dry run that a host may raise (R2.60).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Budget {
    /// Executed blocks.
    Blocks,
    /// Nested subprogram calls.
    Calls,
    /// Nested control blocks.
    Nesting,
    /// Nested macros.
    Macros,
    /// Values that the program holds.
    Values,
    /// Work beyond the text of the executed blocks.
    Work,
    /// Ways that only the machine decides.
    Ways,
    /// CNC cycles of a trace.
    Cycles,
}

/// A piece of advice.
///
/// Its [`Display`](fmt::Display) is a clause in lower case that is true in every host. A host that
/// has its own way to do it uses its own words: the command line names an option, an editor offers
/// an action.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Advice {
    /// Advice that only the user can follow, in words.
    Words(Cow<'static, str>),
    /// Suggest this known word.
    DidYouMean(String),
    /// Look for the cause that uses up the budget, or raise it.
    RaiseBudget(Budget),
    /// Assume that friction compensation of these axes is configured and parameterised.
    Enable(Vec<String>),
    /// Set P-AXIS-00522 of this axis to 1 where its list sets it to 0.
    ConfigureInList {
        /// Name of the axis.
        axis: String,
        /// Path of the list.
        file: String,
        /// The line that sets it.
        line: u32,
    },
    /// Add this axis to `frictcomp.toml`.
    AddAxis(String),
    /// Describe the machine, or assume friction compensation of the axes that the programs switch.
    DescribeMachine(Vec<String>),
    /// Give this parameter or variable its value.
    SetVariable(String),
    /// Say which skip levels are on; the blocks of this level depend on it.
    SetSkip(u8),
    /// Write this parameter or variable before it is read, or give it its value.
    AssignVariable(String),
    /// Test the machine value that ends the loop in the loop condition, and give that value.
    EndLoop,
    /// Write the values that a motion lacks into the program, or give them.
    CompleteMotion,
    /// Give the start positions of these axes.
    GiveStart(Vec<String>),
    /// Give the radius of the tool, for the path beside a contour.
    GiveToolRadius,
    /// Allow calls of programs in the folder of this one, or anywhere.
    AllowOutside,
    /// Take what is hidden or ignored, too, or exclude it.
    TakeIgnored,
    /// Allow the text of lists outside the folders of the machine and the programs to be shown.
    ShowOutside,
    /// Give the network description, which lists the data that the drives exchange.
    GiveNetwork,
    /// Say which device of the network drives this axis.
    AssignSlave(String),
    /// Create a new configuration.
    WriteConfiguration,
    /// Read the page of this code.
    ReadPage(Code),
}

/// Wording of advice by a host; `None` selects the general words.
pub type Wording = fn(&Advice) -> Option<String>;

impl Advice {
    /// Suggests known words that are equally similar.
    pub fn did_you_mean(near: &[&str]) -> Self {
        match near {
            [near] => Self::DidYouMean((*near).to_owned()),
            several => Self::Words(format!("did you mean `{}`?", several.join("` or `")).into()),
        }
    }

    /// Returns the wording of a host, or the general one.
    pub fn in_words(&self, wording: Option<Wording>) -> String {
        let words = wording.and_then(|wording| wording(self));
        words.unwrap_or_else(|| self.to_string())
    }
}

impl Serialize for Advice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl From<&'static str> for Advice {
    fn from(words: &'static str) -> Self {
        Self::Words(words.into())
    }
}

impl From<String> for Advice {
    fn from(words: String) -> Self {
        Self::Words(words.into())
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words(words) => f.write_str(words),
            Self::DidYouMean(word) => write!(f, "did you mean `{word}`?"),
            Self::RaiseBudget(budget) => f.write_str(match budget {
                Budget::Blocks => "look for a loop that does not end, or raise the budget of blocks",
                Budget::Calls => "look for a program that calls itself, or raise the budget of calls",
                Budget::Nesting => "allow deeper nesting of control blocks",
                Budget::Macros => "allow deeper nesting of macros",
                Budget::Values => "look for a loop that keeps creating variables, or raise the budget of values",
                Budget::Work => "look for macros that use each other, strings that grow, and long regions under an unknown condition, or raise the budget of work",
                Budget::Ways => "give the values and skip levels that decide beforehand, or raise the budget of work",
                Budget::Cycles => "raise the budget of CNC cycles",
            }),
            Self::Enable(axes) => {
                let axes = axes.join(", ");
                write!(f, "to continue as if it were set, assume friction compensation of {axes}")
            }
            Self::ConfigureInList { file, line, .. } => write!(
                f,
                "{file}:{line} sets P-AXIS-00522 (lr_param.frict_comp) to 0; set it to 1 and restart the control"
            ),
            Self::AddAxis(axis) => write!(
                f,
                "if the machine has axis `{axis}`, add it: `[[axis]]` with `name = \"{axis}\"` in `frictcomp.toml`"
            ),
            Self::DescribeMachine(switched) => {
                f.write_str(
                    "no machine is described, so P-AXIS-00522 counts as 0 on every axis: describe it, or assume friction compensation",
                )?;
                match switched.as_slice() {
                    [] => Ok(()),
                    axes => write!(f, " of {}", axes.join(", ")),
                }
            }
            Self::SetVariable(name) => {
                write!(f, "give `{name}` a value, for example in `[variables]` of frictcomp.toml")
            }
            Self::SetSkip(level) => write!(
                f,
                "say which skip levels are on: `skip = [{level}]` or `skip = \"none\"` in `[machine]` of frictcomp.toml"
            ),
            Self::AssignVariable(name) => {
                write!(f, "assign it first, `{name} = …`, or give it its value")
            }
            Self::EndLoop => f.write_str(
                "if a value of the machine ends the loop, test it in the condition and give it its value",
            ),
            Self::CompleteMotion => f.write_str(
                "write what is missing into the program (`F`, absolute positions), or give the values; the trace restarts after it",
            ),
            Self::GiveStart(axes) => {
                write!(f, "give the start position of {}", axes.join(", "))
            }
            Self::GiveToolRadius => f.write_str(
                "give the radius: in a bore the tool runs on a smaller circle, and its axes reverse with a larger acceleration",
            ),
            Self::AllowOutside => f.write_str(
                "add its folder to `program_dirs`, or allow calls from anywhere",
            ),
            Self::TakeIgnored => f.write_str(
                "take the programs that are hidden or ignored, too, or exclude it",
            ),
            Self::ShowOutside => f.write_str("allow files outside the project to be shown"),
            Self::GiveNetwork => f.write_str(
                "give the network information of the master (ENI file), which says what the drives exchange",
            ),
            Self::AssignSlave(axis) => {
                write!(f, "say which device of the network drives axis `{axis}`")
            }
            Self::WriteConfiguration => f.write_str("begin with a new configuration"),
            Self::ReadPage(code) => write!(f, "the page of {code} says more"),
        }
    }
}

/// The most letters of a word that is compared; a longer one is not a misspelling.
const MAX_WORD: usize = 64;

/// The most equally similar words that are worth naming.
const MAX_EQUALLY_NEAR: usize = 4;

/// Returns the most similar of several known words, if it is similar enough to be meant; the first one of several that
/// are equally similar. Code that offers a change uses [`nearest`].
pub fn did_you_mean<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates(found, known).first().copied()
}

/// Returns the most similar words, in their order: a tool cannot decide which of several is meant (R1.60). Empty if
/// there are many.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut near = candidates(found, known);
    near.truncate(if near.len() > MAX_EQUALLY_NEAR {
        0
    } else {
        MAX_EQUALLY_NEAR
    });
    near
}

/// Returns the known words at the smallest distance: at most a third of the letters differ, swapped neighbours count
/// once; or one word is the beginning of the other.
fn candidates<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    if found.is_empty() || found.len() > MAX_WORD {
        return Vec::new();
    }
    let found = found.to_ascii_uppercase();
    let letters = found.chars().count();
    // In a single letter only the case can be wrong.
    let allowed = if letters > 1 { (letters / 3).max(1) } else { 0 };
    let near = known
        .into_iter()
        .filter(|word| word.len() <= MAX_WORD)
        .filter_map(|word| {
            let upper = word.to_ascii_uppercase();
            let begins = letters.min(upper.len()) > 2
                && (found.starts_with(&upper) || upper.starts_with(&found));
            let near = letters.abs_diff(upper.chars().count()) <= allowed;
            if !near && !begins {
                return None;
            }
            let distance = if look_alike(&found) == look_alike(&upper) {
                0
            } else {
                strsim::damerau_levenshtein(&found, &upper)
            };
            (distance <= allowed || begins).then_some((distance, word))
        });
    let mut smallest = usize::MAX;
    let mut words = Vec::new();
    for (distance, word) in near {
        if distance < smallest {
            smallest = distance;
            words.clear();
        }
        if distance == smallest && !words.contains(&word) && words.len() <= MAX_EQUALLY_NEAR {
            words.push(word);
        }
    }
    words
}

/// Returns a word in capitals with digits in place of letters that look like them: `FC4O2` means `FC402`.
fn look_alike(word: &str) -> String {
    word.replace('O', "0").replace(['I', 'L'], "1")
}

/// An unknown name, and the known ones.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct UnknownName {
    /// The name as it was given.
    pub name: String,
    /// The known name that is probably intended.
    pub near: Option<String>,
    /// The known names.
    pub known: Vec<String>,
}

impl UnknownName {
    /// Creates an unknown name.
    pub fn new<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Self {
        Self {
            name: name.to_owned(),
            near: did_you_mean(name, known.clone()).map(str::to_owned),
            known: known.map(str::to_owned).collect(),
        }
    }

    /// Returns help: the name that is probably intended, else the known ones: `its axes are X, Y`.
    pub fn help(&self, known: &str) -> Option<String> {
        match &self.near {
            Some(near) => Some(format!("did you mean `{near}`?")),
            None if self.known.is_empty() => None,
            None => Some(format!("{known} {}", self.known.join(", "))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_equally_near_are_all_named() {
        // R1.60
        assert_eq!(nearest("FRIKT", ["LEAD", "FRICT"]), ["FRICT"]);
        assert_eq!(nearest("X3", ["X1", "X2", "X1", "Y2"]), ["X1", "X2"]);
        assert_eq!(nearest("FC4O2", ["FC412", "FC402"]), ["FC402"]);
        assert_eq!(nearest("X9", ["X1", "X2", "X3", "X4", "X5"]), [""; 0]);
        assert_eq!(
            did_you_mean("X9", ["X1", "X2", "X3", "X4", "X5"]),
            Some("X1")
        );
    }
}
