//! Errors in a user's file.

use thiserror::Error;

use crate::diagnostic::{Advice, Code, Diagnostic, nearest};
use crate::lists::Given;
use crate::text::{SourceFile, Span};

/// A `frictcomp.toml` that cannot be used: it is not TOML, or has an unknown key or value.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}:{}: {}", .diagnostic.place.file, .diagnostic.place.start(), .diagnostic.message)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ConfigError {
    /// FC110 with the place.
    pub diagnostic: Box<Diagnostic>,
}

impl ConfigError {
    /// Creates an error about a part of a file.
    pub fn new(source: &SourceFile, span: Span, message: impl Into<String>) -> Self {
        let place = source.place(span);
        Self {
            diagnostic: Box::new(Diagnostic::new(Code::Fc110, place, message)),
        }
    }

    /// Creates an error about a value.
    pub fn at<T>(given: &Given<T>, message: impl Into<String>) -> Self {
        Self {
            diagnostic: Box::new(Diagnostic::new(Code::Fc110, given.place(), message)),
        }
    }

    /// Adds a line of help.
    pub fn with_help(mut self, advice: impl Into<Advice>) -> Self {
        self.diagnostic.advice.push(advice.into());
        self
    }

    /// Adds "did you mean" if a known word is similar.
    pub(crate) fn with_near<'a>(
        mut self,
        found: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let near = nearest(found, known);
        self.diagnostic = Box::new(self.diagnostic.with_near(found, &near));
        self
    }
}
