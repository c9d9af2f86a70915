//! Text and places in it: spans, lines and columns, physical lines one after another.
//!
//! Nothing here depends on NC blocks or list entries. Offsets are bytes in UTF-8 text; lines
//! and columns are made only when something is printed. The encoding of files, such as the code pages of
//! old systems, is handled where files are read.

mod file;
mod hidden;
mod index;
mod lines;
mod numbering;
mod place;
mod shown_path;
mod span;

pub use file::SourceFile;
pub use hidden::shown_json;
pub use hidden::{changed_direction, is_hidden};
pub use index::{LineIndex, Utf16Position};
pub use lines::line_end;
pub(crate) use lines::lines_of;
pub use lines::{LineSource, PhysicalLine, TextLines};
pub(crate) use numbering::Numbering;
pub use place::Place;
pub(crate) use place::{MAX_WHOLE, StartsInOrder};
pub use shown_path::shown_path;
pub use span::{Position, Span};
