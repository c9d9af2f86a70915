//! Advice on a diagnostic, as data.

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
