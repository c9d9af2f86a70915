//! Failures in reading a recorded trace or in finding a channel.

use std::fmt::Write as _;

use super::unit::ChannelQuantity;
use thiserror::Error;

/// Reason why a trace cannot be read: one sentence in lower case, with its line if there is one.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TraceProblem {
    /// A file of bytes, not of text.
    #[error("it is binary, not text")]
    Binary,
    /// A file that gzip compressed.
    #[error("it is compressed with gzip")]
    Gzip,
    /// A text without a row of numbers.
    #[error("it holds no row of numbers")]
    NoRows,
    /// `0,001,5,2`, where the numbers cannot be told apart.
    #[error(
        "line {line} has {cells} cells below {columns} columns: a decimal comma cannot be told from the separator `,`"
    )]
    DecimalComma {
        /// The line of the file.
        line: u64,
        /// Number of cells of the row.
        cells: usize,
        /// Number of columns.
        columns: usize,
    },
    /// `0,5` and `0.5` in one file.
    #[error("line {line} has a decimal {found}, the lines above have the other one")]
    MixedDecimals {
        /// The line of the file.
        line: u64,
        /// `point` or `comma`.
        found: &'static str,
    },
    /// A row that is too short or too long.
    #[error("line {line} has {cells} cells, but there are {columns} columns")]
    Row {
        /// The line of the file.
        line: u64,
        /// Number of cells of the row.
        cells: usize,
        /// Number of columns.
        columns: usize,
    },
    /// `1,5` in quotes, or a word.
    #[error("column `{column}` holds `{text}`, which is not a number")]
    Number {
        /// The line of the file.
        line: u64,
        /// Name of the column.
        column: String,
        /// Text at that place.
        text: String,
    },
    /// `yes` in a column of switches.
    #[error("column `{column}` holds `{text}`")]
    Switch {
        /// The line of the file.
        line: u64,
        /// Name of the column.
        column: String,
        /// Text at that place.
        text: String,
    },
    /// A line, a header or a row that is longer than any export.
    #[error("line {line} is longer than {most} bytes")]
    Long {
        /// The line of the file.
        line: u64,
        /// Limit of a line.
        most: usize,
    },
    /// A trace that was recorded at a very high rate.
    #[error("it has more than {most} rows")]
    TooLong {
        /// Limit.
        most: usize,
    },
    /// A header that cannot be divided, because its names contain the separator.
    #[error("the header cannot be divided: its names contain the separator")]
    Divided,
    /// `<!DOCTYPE`, by which a small text becomes a large one.
    #[error("line {line} defines entities, which are not read")]
    Entities {
        /// The line of the file.
        line: u64,
    },
    /// XML that is not well-formed, or is not a trace.
    #[error("line {line}: {reason}")]
    Xml {
        /// The line of the file.
        line: u64,
        /// The fault, in words.
        reason: String,
    },
    /// A requested item does not exist.
    #[error(transparent)]
    Select(#[from] SelectError),
}

impl TraceProblem {
    /// Returns the line of the file, if it is about one value.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Number { line, .. } | Self::Switch { line, .. } => Some(*line),
            _ => None,
        }
    }

    /// Returns the advice.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            Self::Binary => {
                "export the recording as CSV: in TwinCAT Scope `Export`, or with \
                 `TC3ScopeExportTool.exe svd=FILE.svdx target=FILE.csv silent`"
            }
            Self::Gzip => "unpack it first, with `gunzip` or any archiver",
            Self::NoRows => {
                "a recording is a CSV file with a header, an export of TwinCAT Scope or the XML of a SINUMERIK trace"
            }
            Self::DecimalComma { .. } => {
                "export with the separator tab or `;`, or with a decimal point"
            }
            Self::MixedDecimals { .. } => "export with one decimal mark",
            Self::Row { cells, columns, .. } if columns > cells => {
                "every row has a cell for each column; where a name in the header contains the separator, \
                 such as `;`, put that name in quotes"
            }
            Self::Row { .. } => "every row has a cell for each column",
            Self::Number { .. } => "write numbers with a decimal point",
            Self::Switch { .. } => "write `on` or `off`",
            Self::Long { .. } => "a recording has one line for each sample",
            Self::TooLong { .. } => "record with a lower rate, or a shorter time",
            Self::Divided => "export with the separator tab or `;`",
            Self::Entities { .. } => "export the recording again; it needs no entities",
            Self::Xml { .. } => "export the recording from the control again",
            Self::Select(error) => return error.help(),
        };
        Some(help.to_owned())
    }
}

/// Reason why a channel was not found.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SelectError {
    /// A name that no channel has.
    #[error("there is no channel `{wanted}`")]
    None {
        /// Requested item.
        wanted: String,
        /// Existing items.
        found: Vec<String>,
        /// Probable item.
        guess: Option<String>,
    },
    /// A name that several channels have.
    #[error("{} channels fit `{wanted}`: {}", .found.len(), .found.join(", "))]
    Several {
        /// Requested item.
        wanted: String,
        /// Channels that fit.
        found: Vec<String>,
    },
    /// A unit that Scope scales, so that the samples are in another one.
    #[error(
        "`{channel}` has the unit scale {factor} and the unit offset {offset}, so its samples are not in `{unit}`"
    )]
    UnitScaled {
        /// Name of the channel.
        channel: String,
        /// The unit in the header.
        unit: String,
        /// `Unit ScaleFactor`, as a text.
        factor: Box<str>,
        /// `Unit Offset`, as a text.
        offset: Box<str>,
        /// The quantity for which it is taken.
        quantity: ChannelQuantity,
    },
    /// A unit of the user that is one of another quantity than the channel.
    #[error("`{channel}` is the {quantity}, but the unit given for it is one of {given}")]
    OtherUnit {
        /// Name of the channel.
        channel: String,
        /// The quantity for which it is taken.
        quantity: ChannelQuantity,
        /// The quantity of the unit.
        given: ChannelQuantity,
    },
    /// A channel in a unit that is not known as one of its quantity.
    #[error("the {quantity} `{channel}` is in `{unit}`, which is no known unit of {quantity}")]
    UnknownUnit {
        /// Name of the channel.
        channel: String,
        /// The quantity for which it is taken.
        quantity: ChannelQuantity,
        /// The unit in the file.
        unit: String,
    },
    /// Channels that are needed and not named.
    #[error("the recording has {lacks}, only {}", listed(.found))]
    Lacks {
        /// Missing items: no columns `x` and `y`.
        lacks: String,
        /// Existing items.
        found: Vec<String>,
        /// Advice.
        help: String,
    },
}

/// Names for a sentence; of very many the first ones.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 40;
    let mut text = names[..names.len().min(SHOWN)].join(", ");
    if names.len() > SHOWN {
        let _ = write!(text, " and {} more", names.len() - SHOWN);
    }
    text
}

impl SelectError {
    /// Adds another guess if no name is spelled like the requested one.
    pub(super) fn or_guess(self, guess: impl FnOnce() -> Option<String>) -> Self {
        match self {
            Self::None {
                wanted,
                found,
                guess: None,
            } => Self::None {
                wanted,
                found,
                guess: guess(),
            },
            other => other,
        }
    }

    /// Returns its words about a recording with a path.
    pub fn of_trace(&self, path: &str) -> String {
        match self {
            Self::Lacks { lacks, found, .. } => {
                format!("the recording `{path}` has {lacks}, only {}", listed(found))
            }
            _ => format!("the recording `{path}`: {self}"),
        }
    }

    /// Returns the advice.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::None { found, guess, .. } => {
                let there = format!("the channels are {}", listed(found));
                Some(match guess {
                    Some(guess) => format!("did you mean `{guess}`? {there}"),
                    None => there,
                })
            }
            Self::Several { .. } => Some(
                "name one by its symbol, by its comment or as a CNC object, `0x120300:0x10017`, \
                 or give the axis"
                    .to_owned(),
            ),
            Self::UnitScaled {
                channel, quantity, ..
            } => Some(format!(
                "export it with the unit scale 1 and the unit offset 0, or name the unit of its samples, \
                 as in `{channel}={}`",
                quantity.example()
            )),
            Self::OtherUnit {
                channel, quantity, ..
            } => Some(format!(
                "give a unit of the {quantity}, as in `{channel}={}`",
                quantity.example()
            )),
            Self::UnknownUnit {
                channel, quantity, ..
            } => Some(format!(
                "say in which unit of {quantity} it is, as in `{channel}={}`",
                quantity.example()
            )),
            Self::Lacks { help, .. } => Some(help.clone()),
        }
    }
}
