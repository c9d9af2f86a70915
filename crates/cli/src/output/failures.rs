//! Failures of parts of a command; the other parts are done nevertheless (R9.77).

use super::console::Console;
use super::exit;
use super::failure::Failure;
use frictcomp_host::HostError;

/// Failures of parts of a command.
#[derive(Debug, Default)]
pub(crate) struct Failures(Vec<Failure>);

impl From<Vec<HostError>> for Failures {
    fn from(errors: Vec<HostError>) -> Self {
        Self(errors.into_iter().map(Failure::from).collect())
    }
}

impl Failures {
    /// Adds a failure; a reason that stops many programs is reported once.
    pub(crate) fn push(&mut self, failure: Failure) {
        if self.0.iter().all(|it| it.message != failure.message) {
            self.0.push(failure);
        }
    }

    /// Adds the failures of another part of the work.
    pub(crate) fn extend(&mut self, others: Self) {
        others.0.into_iter().for_each(|it| self.push(it));
    }

    /// Returns the results, and keeps the failures.
    pub(crate) fn keep<T>(&mut self, (done, errors): (T, Vec<HostError>)) -> T {
        for error in errors {
            self.push(error.into());
        }
        done
    }

    /// Whether everything was done.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Does work that collects its failures, and reports all of them at the end, even if the work is
    /// aborted (R9.95).
    pub(crate) fn of(
        console: Console,
        work: impl FnOnce(&mut Self) -> Result<u8, Failure>,
    ) -> Result<u8, Failure> {
        let mut failures = Self::default();
        let done = work(&mut failures).unwrap_or_else(|failure| {
            failures.push(failure);
            exit::CLEAN
        });
        failures.status(console, done)
    }

    /// Reports what could not be done, and returns the status of a command that could do the rest.
    fn status(mut self, console: Console, done: u8) -> Result<u8, Failure> {
        let Some(last) = self.0.pop() else {
            return Ok(done);
        };
        for failure in &self.0 {
            console.explain(failure);
        }
        Err(last)
    }
}
