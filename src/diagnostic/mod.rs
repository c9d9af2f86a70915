//! Statements about the user's programs and lists, as plain data.

mod advice;
mod codes;
mod filter;
mod fix;
mod message;
mod spelling;

pub use advice::{Advice, Budget, Wording};
pub use codes::{Code, UnknownCode};
pub use filter::{CodeFilter, Levels};
pub use fix::{Edit, Fix, FixForm, Fixed, NamedFix, Safety, edited, edits};
pub use message::{
    Collected, Diagnostic, Label, MAX_MESSAGES, ReachedFrom, ReadableNumber, Rounded, Severity,
};
pub use spelling::{UnknownName, did_you_mean, nearest};
