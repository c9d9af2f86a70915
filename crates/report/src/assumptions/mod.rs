//! Assumptions of frictcomp where the documents leave something open, and its deliberate differences from the control:
//! two tables as data. They are the source of `docs/assumptions.md`, of the page of differences and of the part of a
//! report that names what its run depends on.

mod in_force;
mod simulated;
mod table;

pub use in_force::rests_on_text;
pub use simulated::not_modelled;
pub(crate) use simulated::not_modelled_line;
pub(crate) use table::SessionFacts;
pub use table::{Assumption, Chapter, Difference, When, chapters, differences};
