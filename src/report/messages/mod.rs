//! Messages without a timeline, one file a format.

mod carets;
mod concise;
mod format;
mod github;
mod gitlab;
mod listing;
mod message_format;
mod objects;
mod sarif;
mod tally;

#[cfg(feature = "cli")]
pub(crate) use concise::concise_line;
pub use format::ListingFormat;
pub use listing::Listing;
pub use tally::Tally;
