//! The parser that pest makes of `grammar.pest`.

// The derive writes an enum whose variants have no documentation.
#![allow(missing_docs)]

use pest_derive::Parser;

#[derive(Parser)]
#[grammar = "../grammar.pest"]
#[cfg_attr(test, grammar = "../tests/reference.pest")]
pub(super) struct NcParser;
