//! Text of cells and items: in a page it has a tone, and parts of it lead to lines of programs.

use std::borrow::Cow;
use std::fmt::{self, Display};
use std::sync::Arc;

use frictcomp::comp::State;
use serde::{Serialize, Serializer};

/// A line of a program, from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProgramLine {
    pub(crate) file: Arc<str>,
    pub(crate) line: u32,
}

/// Meaning of a text for the states of compensation, shown in a page by more than colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// State away from the start-up state.
    Away,
    /// The given state.
    State(State),
    /// Text that needs no attention.
    Quiet,
}

/// Part of a text.
#[derive(Debug, Clone)]
pub(crate) enum PhrasePiece {
    Plain(String),
    Code(String),
    /// Text that leads to a line, in a page that shows this line.
    Leading(String, ProgramLine),
}

/// Text of a cell or of an item. A terminal shows the text alone.
#[derive(Debug, Clone, Default)]
pub(crate) struct Phrase {
    pub(crate) pieces: Vec<PhrasePiece>,
    pub(crate) tone: Option<Tone>,
}

impl<T: Into<String>> From<T> for Phrase {
    fn from(text: T) -> Self {
        Self::default().then(text)
    }
}

impl Phrase {
    /// Creates a text that leads to a line.
    pub(crate) fn leading(text: impl Into<String>, file: &Arc<str>, line: u32) -> Self {
        let file = Arc::clone(file);
        let piece = PhrasePiece::Leading(text.into(), ProgramLine { file, line });
        Self::default().with(piece)
    }

    /// Creates the word of a state.
    pub(crate) fn state(state: State) -> Self {
        Self::from(state.as_str()).toned(Tone::State(state))
    }

    /// Returns the text with a tone.
    pub(crate) fn toned(self, tone: Tone) -> Self {
        let tone = Some(tone);
        Self { tone, ..self }
    }

    /// Appends a text.
    pub(crate) fn then(self, text: impl Into<String>) -> Self {
        self.with(PhrasePiece::Plain(text.into()))
    }

    /// Appends the block of a program.
    pub(crate) fn code(self, text: impl Into<String>) -> Self {
        self.with(PhrasePiece::Code(text.into()))
    }

    /// Appends another one.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.pieces.extend(other.pieces);
        self
    }

    fn with(mut self, piece: PhrasePiece) -> Self {
        self.pieces.push(piece);
        self
    }

    /// Returns the lines to which it leads.
    pub(crate) fn lines(&self) -> impl Iterator<Item = &ProgramLine> {
        self.pieces.iter().filter_map(|piece| match piece {
            PhrasePiece::Leading(_, line) => Some(line),
            PhrasePiece::Plain(_) | PhrasePiece::Code(_) => None,
        })
    }

    /// Returns the text alone.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        let mut texts = self.pieces.iter().map(PhrasePiece::text);
        match (texts.next(), texts.next()) {
            (first, None) => Cow::Borrowed(first.unwrap_or_default()),
            _ => Cow::Owned(self.pieces.iter().map(PhrasePiece::text).collect()),
        }
    }
}

impl PhrasePiece {
    fn text(&self) -> &str {
        let (Self::Plain(text) | Self::Code(text) | Self::Leading(text, _)) = self;
        text
    }
}

impl Display for Phrase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text())
    }
}

impl Serialize for Phrase {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text())
    }
}
