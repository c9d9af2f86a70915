//! Messages without a timeline, one file per format.

mod carets;
mod concise;
mod format;
mod github;
mod gitlab;
mod junit;
mod listing;
mod message_format;
mod objects;
mod sarif;
mod tally;

pub use concise::concise_line;
pub use format::ListingFormat;
pub use listing::Listing;
pub use tally::{ProgramResult, Tally};
