//! Text and places in it: spans, lines and columns, physical lines one after another.
//!
//! Nothing here knows what an NC block or a list entry is. Offsets are bytes in UTF-8 text; lines
//! and columns are made only when something is printed. What bytes of files mean, the code pages of old
//! systems, comes with the feature `report` or `host`.

#[cfg(any(feature = "report", feature = "host"))]
mod decode;
#[cfg(any(feature = "report", feature = "host"))]
mod encoded;
mod file;
mod hidden;
mod index;
mod lines;
mod place;
#[cfg(any(feature = "report", feature = "host"))]
mod shown_path;
mod span;

#[cfg(any(feature = "report", feature = "host"))]
pub use decode::decode;
#[cfg(feature = "host")]
pub(crate) use decode::{decode_lines, wide};
#[cfg(any(feature = "report", feature = "host"))]
pub use encoded::{EncodedText, NotEncodable};
pub use file::SourceFile;
#[cfg(any(feature = "report", feature = "host"))]
pub(crate) use hidden::shown_json;
pub(crate) use hidden::{changed_direction, is_hidden};
pub use index::{LineIndex, Utf16Position};
#[cfg(feature = "host")]
pub(crate) use lines::line_end;
pub use lines::{LineSource, PhysicalLine, TextLines};
pub use place::Place;
pub(crate) use place::StartsInOrder;
#[cfg(any(feature = "report", feature = "host"))]
pub use shown_path::shown_path;
pub use span::{Position, Span};
