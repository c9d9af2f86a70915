//! The last error of a thread, and the border that no panic crosses.

use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::null;

use frictcomp::comp::CompensationError;
use frictcomp::diagnostic::{Code, Diagnostic};
use frictcomp::session::StateError;
use frictcomp::syntax::Fault;
use frictcomp_host::HostError;
use thiserror::Error;

/// Result of a call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictcompStatus {
    /// Success.
    Ok = 0,
    /// The control refuses the command with its own error; nothing is changed.
    Refused = 1,
    /// The text is a bracket or a word that does not concern COMP; nothing is changed.
    NotComp = 2,
    /// The text is a COMP command with a mistake, or more than one command or line; nothing is changed.
    Faulty = 3,
    /// An argument is missing, is not UTF-8, or names something that does not exist.
    BadArgument = 4,
    /// A file cannot be read or used.
    NoMachine = 5,
    /// A mistake in frictcomp itself; the handle that was used should be freed.
    Internal = 6,
}

/// Reason why a call failed.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Refused(#[from] CompensationError),
    #[error("this is not a COMP command; write `X[COMP ON FRICT]`")]
    NotComp,
    #[error("{message}")]
    Text { code: Code, message: String },
    #[error("{0}")]
    BadArgument(String),
    #[error("{0}")]
    Machine(String),
    #[error("an internal error of frictcomp: {0}")]
    Internal(String),
}

impl Failure {
    pub(crate) fn bad(message: impl Into<String>) -> Self {
        Self::BadArgument(message.into())
    }

    pub(crate) fn of_state(path: &str, error: &StateError) -> Self {
        Self::Machine(format!("the state file `{path}` cannot be used: {error}"))
    }

    pub(crate) fn status(&self) -> FrictcompStatus {
        match self {
            Self::Refused(_) => FrictcompStatus::Refused,
            Self::NotComp => FrictcompStatus::NotComp,
            Self::Text { .. } => FrictcompStatus::Faulty,
            Self::BadArgument(_) => FrictcompStatus::BadArgument,
            Self::Machine(_) => FrictcompStatus::NoMachine,
            Self::Internal(_) => FrictcompStatus::Internal,
        }
    }

    fn code(&self) -> Option<Code> {
        match self {
            Self::Refused(error) => Some(error.code()),
            Self::Text { code, .. } => Some(*code),
            _ => None,
        }
    }
}

impl From<Fault> for Failure {
    fn from(fault: Fault) -> Self {
        let advice: Vec<String> = fault.advice.iter().map(ToString::to_string).collect();
        let message = match &advice[..] {
            [] => fault.message,
            advice => format!("{}; {}", fault.message, advice.join("; ")),
        };
        Self::Text {
            code: fault.code,
            message,
        }
    }
}

impl From<HostError> for Failure {
    fn from(error: HostError) -> Self {
        let mut message = error.to_string();
        if let HostError::Configuration { diagnostics, .. } = &error {
            for said in diagnostics {
                message.push_str("; ");
                message.push_str(&line(said));
            }
        }
        Self::Machine(message)
    }
}

/// The last error of a thread in the form that C reads.
#[derive(Default)]
struct LastError {
    message: Option<CString>,
    code: Option<CString>,
}

thread_local! {
    static LAST: RefCell<LastError> = RefCell::default();
}

/// Does the work of a call, and returns `fallback` if it fails or panics. The error of an earlier call stays until
/// then, and with it the text that the host may hold.
pub(crate) fn call<T>(
    fallback: impl FnOnce(FrictcompStatus) -> T,
    work: impl FnOnce() -> Result<T, Failure>,
) -> T {
    let done = catch_unwind(AssertUnwindSafe(work));
    let failure = match done {
        Ok(Ok(result)) => return result,
        Ok(Err(failure)) => failure,
        Err(panic) => {
            let words = panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|it| (*it).to_owned()));
            Failure::Internal(words.unwrap_or_else(|| "no reason is given".to_owned()))
        }
    };
    LAST.with_borrow_mut(|last| {
        last.message = Some(c_text(&failure.to_string()));
        last.code = failure.code().map(|code| c_text(code.as_str()));
    });
    fallback(failure.status())
}

/// The words of the last error of this thread; NULL before the first one.
pub(crate) fn last_message() -> *const c_char {
    LAST.with_borrow(|last| last.message.as_ref().map_or(null(), |text| text.as_ptr()))
}

/// The code of the last error, if it has one.
pub(crate) fn last_code() -> *const c_char {
    LAST.with_borrow(|last| last.code.as_ref().map_or(null(), |text| text.as_ptr()))
}

/// A message in one line, preceded by its place as in compilers.
pub(crate) fn line(said: &Diagnostic) -> String {
    let (file, start) = (&said.place.file, said.place.start());
    let Diagnostic {
        severity,
        code,
        message,
        ..
    } = said;
    format!("{file}:{start}: {severity}[{code}] {message}")
}

/// A text for C, without the NUL that would end it early.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).expect("it has no NUL")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_status() {
        // R13.5
        let status = call(|status| status, || panic!("of {} kinds", 2));
        assert_eq!(status, FrictcompStatus::Internal);
        // R13.16: a call that succeeds leaves the text where it is.
        let text = last_message();
        let done = call(|status| status, || Ok(FrictcompStatus::Ok));
        assert_eq!(done, FrictcompStatus::Ok);
        assert_eq!(last_message(), text);
    }

    #[test]
    fn a_text_with_a_nul_stays_whole() {
        assert_eq!(c_text("a\0b").as_c_str(), c"a\u{fffd}b");
    }
}
