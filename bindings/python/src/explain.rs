//! `frictcomp.explain`: the pages about codes, parameters, rules and words.

use std::borrow::Cow;

use frictcomp_cli::page_about;
use pyo3::prelude::*;

use crate::exceptions::refused;

/// The page that the command `frictcomp explain` prints: about the code of a message, such as ``"FC401"``, an error number
/// of the control, a parameter by its number or its key in the lists, such as ``"P-AXIS-00522"``, a rule or another word;
/// as Markdown.
#[pyfunction]
pub(crate) fn explain(word: &str) -> PyResult<Cow<'static, str>> {
    page_about(word).map_err(|error| {
        let help = match error.near {
            Some(near) => format!("did you mean `{near}`?"),
            None => "pages are about codes, parameters, rules and words".to_owned(),
        };
        refused(format!(
            "`word`: there is no page about `{}`; {help}",
            word.trim()
        ))
    })
}
