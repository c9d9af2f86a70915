//! Statements about the user's programs and lists, as plain data.

mod advice;
mod codes;
mod filter;
mod fix;
mod message;
mod number;
mod reached;
mod spelling;

pub use advice::{Advice, Budget, Wording};
pub use codes::{Code, UnknownCode};
pub use filter::{CodeFilter, Levels};
pub use fix::{Edit, Fix, FixForm, Fixed, NamedFix, Safety, edited, edits};
pub use message::{Collected, Diagnostic, Label, MAX_MESSAGES, Severity};
pub use number::{ReadableNumber, Rounded};
pub use reached::ReachedFrom;
pub use spelling::{UnknownName, did_you_mean, nearest};
