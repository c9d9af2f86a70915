//! Statements about the user's programs and lists, as plain data.

mod advice;
mod codes;
mod collected;
mod filter;
mod fix;
mod levels;
mod message;
mod number;
mod reached;
mod severity;
mod spelling;
mod unknown_name;

pub use advice::{Advice, Budget, Wording};
pub use codes::{Code, UnknownCode};
pub use collected::{Collected, MAX_MESSAGES};
pub use filter::CodeFilter;
pub use fix::{Edit, Fix, FixForm, Fixed, NamedFix, Safety, edited, edits};
pub use levels::Levels;
pub use message::{Diagnostic, Label};
pub use number::ReadableNumber;
pub use number::Rounded;
pub use reached::ReachedFrom;
pub use severity::Severity;
pub use spelling::{did_you_mean, nearest};
pub use unknown_name::UnknownName;
