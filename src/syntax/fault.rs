//! Faults in the text of a block.

use crate::diagnostic::{Advice, Code, Diagnostic, Fix};
use crate::language::ControlError;
use crate::text::{Place, Span};

/// A statement about the text of one block: a diagnostic whose span counts from the block's start.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Fault {
    /// The code of the message.
    pub code: Code,
    /// The bytes of the block's text that are meant.
    pub span: Span,
    /// One sentence in lower case.
    pub message: String,
    /// Advice on the fault.
    pub advice: Vec<Advice>,
    /// Changes to the text of the block, each of which alone does what is advised.
    pub fixes: Vec<Fix<Span>>,
}

impl Fault {
    /// A fault without advice.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            advice: Vec::new(),
            fixes: Vec::new(),
        }
    }

    /// An error of the control, with the advice of its row (R2.114).
    #[allow(
        clippy::unnecessary_box_returns,
        reason = "it is the error of a result"
    )]
    pub(crate) fn refused(code: Code, span: Span, message: impl Into<String>) -> Box<Self> {
        let number = code.as_str().strip_prefix("P-ERR-");
        let number = number.and_then(|number| number.parse().ok());
        Box::new(Self::new(code, span, message).with_cure(number))
    }

    /// Adds the advice on an error of the control.
    pub(crate) fn with_cure(self, number: Option<u32>) -> Self {
        match number.and_then(ControlError::of) {
            Some(row) => self.with_help(row.cure),
            None => self,
        }
    }

    /// Adds a piece of advice.
    pub fn with_help(mut self, advice: impl Into<Advice>) -> Self {
        self.advice.push(advice.into());
        self
    }

    /// Adds a change that does what is advised.
    pub fn with_fix(mut self, fix: Fix<Span>) -> Self {
        self.fixes.push(fix);
        self
    }

    /// Adds the known words that may be meant in place of the one at `found`; only a single one is
    /// offered as a change (R1.60).
    pub(crate) fn with_near(self, found: Span, near: &[&str]) -> Self {
        if near.is_empty() {
            return self;
        }
        let said = self.with_help(Advice::did_you_mean(near));
        match near {
            [near] => said.with_fix(Fix::guess(found, *near)),
            _ => said,
        }
    }

    /// Returns its diagnostic at a place. `at` turns the spans of its changes into places; `None` where
    /// that text is not part of the program.
    pub(crate) fn into_diagnostic(
        self,
        place: Place,
        at: impl Fn(Span) -> Option<Place>,
    ) -> Diagnostic {
        let mut diagnostic = Diagnostic::new(self.code, place, self.message);
        diagnostic.advice = self.advice;
        for fix in self.fixes {
            if let Some(place) = at(fix.place) {
                diagnostic.fixes.push(fix.map(|_| place));
            }
        }
        diagnostic
    }
}

/// FC313: a second word where the control accepts one in a block (TF5200 Diagnosis, errors 20105, 20170, 20175, 20181,
/// 20205, 20765).
pub(crate) fn repeated_word(text: &str, span: Span) -> Fault {
    let text = text.trim();
    let message =
        format!("`{text}` is the second such word in this block; the control accepts one");
    Fault::new(Code::Fc313, span, message)
        .with_help("remove one of them, or write it in another block")
}
