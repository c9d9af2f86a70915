//! Statements about the user's programs and lists, as plain data.

mod codes;
mod collected;
mod levels;
mod message;
mod number;
mod severity;
mod spelling;

pub use codes::Code;
pub use collected::{Collected, MAX_MESSAGES};
pub use levels::Levels;
pub use message::{Diagnostic, Label};
pub(crate) use number::Shown;
pub use severity::Severity;
pub(crate) use spelling::did_you_mean;
