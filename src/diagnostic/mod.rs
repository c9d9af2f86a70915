//! Statements about the user's programs and lists, as plain data.

mod advice;
mod codes;
mod fix;
mod message;

pub use advice::{Advice, Budget, Wording};
pub use advice::{UnknownName, did_you_mean, nearest};
pub use codes::{Code, UnknownCode};
pub use codes::{CodeFilter, Levels};
pub use fix::{Edit, Fix, FixForm, Fixed, NamedFix, Safety, edited, edits};
pub use message::{
    Collected, Diagnostic, Label, MAX_MESSAGES, ReachedFrom, ReadableNumber, Rounded, Severity,
};
