//! The result of a command: its format and its destination.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use frictcomp::timeline::SCHEMA;
use frictcomp_report::to_json;

/// A format of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum ResultFormat {
    /// Text for people.
    #[default]
    Text,
    /// One JSON document.
    Json,
}

/// A format of records of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum RecordsFormat {
    /// Text for people.
    #[default]
    Text,
    /// One JSON document.
    Json,
    /// One record per line.
    Ndjson,
}

impl RecordsFormat {
    /// Returns records in this format, `text` as they are for people.
    pub(crate) fn records(self, text: &str, records: &[Value]) -> String {
        match self {
            Self::Text => text.to_owned(),
            Self::Json => to_json(&json!({ "schema": SCHEMA, "records": records })),
            Self::Ndjson => records
                .iter()
                .fold(String::new(), |lines, it| lines + &it.to_string() + "\n"),
        }
    }
}

/// A result that goes to standard output or to a file, in one of the formats `F`.
#[derive(Debug, Clone, Args)]
pub(crate) struct ResultArgs<F = ResultFormat>
where
    F: ValueEnum + Clone + Default + Send + Sync + 'static,
{
    /// The format of the result
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: F,
    /// Write the result to this file
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}
