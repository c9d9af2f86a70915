//! The formats of the timeline.

use std::io::Write;

use super::csv::{Csv, Positions};
use super::json::Json;
use super::ndjson::Ndjson;
use super::output::Report;
use super::text::{Text, TextOptions};

frictcomp::words! {
    /// A format of the timeline.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    #[non_exhaustive]
    pub enum TimelineFormat {
        /// For people.
        #[default]
        Text = "text",
        /// One JSON object a line.
        Ndjson = "ndjson",
        /// One JSON document.
        Json = "json",
        /// One row a block.
        Csv = "csv",
    }
}

/// How a timeline looks. A format passes over what it does not have: only [`Text`] folds blocks and
/// has colours, only [`Csv`] has columns to add.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TimelineOptions {
    /// What is shown, and how text looks.
    pub text: TextOptions,
    /// Whether rows say where the axes stand.
    pub positions: Positions,
}

impl TimelineOptions {
    /// The same with another value of [`text`](Self::text).
    pub fn with_text(mut self, text: TextOptions) -> Self {
        self.text = text;
        self
    }

    /// The same with another value of [`positions`](Self::positions).
    pub fn with_positions(mut self, positions: Positions) -> Self {
        self.positions = positions;
        self
    }
}

impl TimelineFormat {
    /// What it is, in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Text => "For people",
            Self::Ndjson => "One JSON object per line",
            Self::Json => "One JSON document",
            Self::Csv => "One row per block",
        }
    }

    /// The timeline in this format.
    pub fn report<W: Write + 'static>(
        self,
        writer: W,
        options: TimelineOptions,
    ) -> Box<dyn Report> {
        let view = options.text.view;
        match self {
            Self::Text => Box::new(Text::new(writer, options.text)),
            Self::Ndjson => Box::new(Ndjson::new(writer, view)),
            Self::Json => Box::new(Json::new(writer, view)),
            Self::Csv => Box::new(Csv::new(writer, view).with_positions(options.positions)),
        }
    }
}
