//! What frictcomp assumes where the documents leave something open: the one table, a file a
//! chapter. `docs/assumptions.md` and the part of a report that names what its run depends on are
//! made from it.

mod assumption;
mod chapters;
mod circle;
mod command;
mod contour;
mod current;
mod differences;
mod drives;
mod identification;
mod in_force;
mod language;
mod lists;
mod motion;
mod runs;
mod stiction;

pub(crate) use assumption::Met;
pub use assumption::{Assumption, When};
pub use chapters::{CHAPTERS, Chapter};
pub use differences::{DIFFERENCES, Difference};
pub use in_force::{ReadingInForce, ReadingsInForce};
