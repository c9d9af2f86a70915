//! The parser that pest makes of `grammar.pest`.

// The derive writes an enum whose variants have no documentation.
#![allow(missing_docs)]

use std::num::NonZeroUsize;

use pest::error::{Error, ErrorVariant};
use pest_derive::Parser;

/// Steps of the parser: more than a block of a megabyte needs, and a second or two of work.
const MAX_STEPS: NonZeroUsize = NonZeroUsize::new(200_000_000).expect("some steps");

#[derive(Parser)]
#[grammar = "../grammar.pest"]
#[cfg_attr(test, grammar = "../tests/reference.pest")]
pub(super) struct NcParser;

/// Bounds the steps in which a block is read (R12.16), for all of the process; past it the block is not
/// understood, FC913. No known block comes near the bound. It applies to every parser that the
/// process makes with pest, so it is up to the owner of the process; the command line sets it.
pub fn bound_reading() {
    pest::set_call_limit(Some(MAX_STEPS));
}

/// Returns whether the parser gave up, rather than finding no rule that fits.
pub(super) fn gave_up(error: &Error<Rule>) -> bool {
    matches!(error.variant, ErrorVariant::CustomError { .. })
}
