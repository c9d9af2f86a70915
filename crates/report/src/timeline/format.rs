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
        /// Text for people.
        #[default]
        Text = "text",
        /// One JSON object per line.
        Ndjson = "ndjson",
        /// One JSON document.
        Json = "json",
        /// One row per block.
        Csv = "csv",
    }
}

/// The appearance of a timeline. A format ignores what it does not support: only [`Text`] folds blocks and
/// has colours, only [`Csv`] has columns to add.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TimelineOptions {
    /// The shown blocks and kinds, and the look of text.
    pub text: TextOptions,
    /// Columns for the axis positions.
    pub positions: Positions,
}

impl TimelineOptions {
    /// Sets [`text`](Self::text).
    pub fn with_text(mut self, text: TextOptions) -> Self {
        self.text = text;
        self
    }

    /// Sets [`positions`](Self::positions).
    pub fn with_positions(mut self, positions: Positions) -> Self {
        self.positions = positions;
        self
    }
}

impl TimelineFormat {
    /// Returns its description in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Text => "For people",
            Self::Ndjson => "One JSON object per line",
            Self::Json => "One JSON document",
            Self::Csv => "One row per block",
        }
    }

    /// Returns the timeline in this format.
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
