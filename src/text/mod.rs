//! Text and places in it: spans, lines and columns, physical lines one after another.
//!
//! Nothing here depends on NC blocks or list entries. Offsets are bytes in UTF-8 text; lines
//! and columns are made only when something is printed. The encoding of files, such as the code pages of
//! old systems, is handled where files are read.

mod file;
mod hidden;
mod numbering;
mod place;

pub use file::SourceFile;
pub(crate) use file::lines_of;
pub use file::{LineIndex, LineSource, PhysicalLine, TextLines, Utf16Position, line_end};
pub use hidden::{changed_direction, is_hidden, shown_json};
pub(crate) use numbering::Numbering;
pub(crate) use place::{MAX_WHOLE, StartsInOrder};
pub use place::{Place, Position, Span, in_a_row, shown_path};
