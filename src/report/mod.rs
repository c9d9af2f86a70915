//! Records and diagnostics as bytes, one file a format. Nothing here computes anything.
//!
//! Every timeline format is a [`Sink`] over a generic writer. The first error of the writer is
//! kept and ends the dry run; a closed pipe is no error for the caller.

mod advice;
pub mod assumptions;
pub mod circle;
mod concise;
mod csv;
mod diagnostics;
mod github;
pub mod html;
mod json;
mod listing;
pub mod lists;
mod markup;
mod ndjson;
pub mod pictures;
mod records;
mod sarif;
mod strings;
pub mod svg;
mod text;
pub mod tune;
mod visible;

use std::io::{self, Write};
use std::ops::ControlFlow;

pub use csv::Csv;
pub use diagnostics::{Look, Paint, render};
pub(crate) use diagnostics::{fitted, wrap};
pub use json::Json;
pub use listing::{Listing, ListingFormat, Tally};
pub use ndjson::Ndjson;
#[cfg(feature = "cli")]
pub(crate) use strings::shown_json;
pub use text::{Runs, Text, TextOptions};
#[cfg(feature = "cli")]
pub(crate) use visible::{leading, visible, visible_line};

use crate::comp::{Kind, KindSet};
use crate::timeline::{Row, Sink};

/// The width of text output that does not go to a terminal.
pub const DEFAULT_WIDTH: usize = 80;

/// How many bytes are gathered before they are written.
const CHUNK: usize = 64 * 1024;

/// Which blocks are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Blocks {
    /// Every block.
    #[default]
    All,
    /// Only blocks that changed a state or about which there is something to say.
    Changed,
}

/// What a timeline shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct View {
    /// The blocks that are written.
    pub blocks: Blocks,
    /// The kinds of compensation whose changes are written.
    pub kinds: KindSet,
}

impl Default for View {
    fn default() -> Self {
        Self {
            blocks: Blocks::All,
            kinds: KindSet::of(Kind::Frict),
        }
    }
}

impl View {
    /// Whether a block changed a selected kind, or something is said about it.
    fn is_eventful(self, row: &Row<'_>) -> bool {
        !row.diagnostics.is_empty()
            || row
                .changes
                .iter()
                .any(|change| self.kinds.contains(change.kind))
    }

    /// Whether a block is written.
    fn shows(self, row: &Row<'_>) -> bool {
        self.blocks == Blocks::All || self.is_eventful(row)
    }
}

/// A timeline format whose output can be ended.
pub trait Report: Sink {
    /// Writes what is ready while nobody knows when the next record comes. Formats that fold or
    /// hold back records keep those.
    fn flush(&mut self) -> ControlFlow<()>;

    /// Writes what is still held back.
    ///
    /// # Errors
    /// The first error of the writer; a closed pipe is none.
    fn finish(&mut self) -> io::Result<()>;

    /// Whether the reader closed the pipe.
    fn is_closed(&self) -> bool;
}

/// Bytes on their way to a writer, in chunks.
#[derive(Debug)]
struct Output<W> {
    writer: W,
    bytes: Vec<u8>,
    failure: Option<io::Error>,
}

impl<W: Write> Output<W> {
    fn new(writer: W) -> Self {
        Self {
            writer,
            bytes: Vec::with_capacity(CHUNK + CHUNK / 4),
            failure: None,
        }
    }

    /// Writes when a chunk is full.
    fn settle(&mut self) -> ControlFlow<()> {
        if self.bytes.len() >= CHUNK {
            return self.flush();
        }
        self.verdict()
    }

    /// Writes everything.
    fn flush(&mut self) -> ControlFlow<()> {
        if self.failure.is_none() && !self.bytes.is_empty() {
            let written = self
                .writer
                .write_all(&self.bytes)
                .and_then(|()| self.writer.flush());
            self.failure = written.err();
        }
        self.bytes.clear();
        self.verdict()
    }

    fn verdict(&self) -> ControlFlow<()> {
        if self.failure.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    fn finish(&mut self) -> io::Result<()> {
        let _ = self.flush();
        match self.failure.take() {
            Some(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.failure = Some(error);
                Ok(())
            }
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    fn is_closed(&self) -> bool {
        self.failure
            .as_ref()
            .is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    }
}

#[cfg(test)]
mod tests;
