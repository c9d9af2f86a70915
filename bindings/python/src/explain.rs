//! `frictcomp.explain`: the pages about codes and parameters.

use frictcomp::diagnostic::{Code, UnknownName};
use frictcomp::documents::PARAMETER_PAGES;
use pyo3::prelude::*;

use crate::exceptions::refused;

/// The page about the code of a message, such as ``"FC401"``, or about a parameter, by its number or its key in the
/// lists, such as ``"P-AXIS-00522"``; as Markdown.
#[pyfunction]
pub(crate) fn explain(word: &str) -> PyResult<&'static str> {
    let word = word.trim();
    if let Ok(code) = word.parse::<Code>() {
        return Ok(code.page());
    }
    let is_it = |name: &str| name.eq_ignore_ascii_case(word);
    let mut pages = PARAMETER_PAGES.iter();
    let page = pages.find(|page| is_it(page.number) || is_it(page.key));
    page.map(|page| page.page).ok_or_else(|| {
        let codes = Code::ALL.iter().map(|code| code.as_str());
        let parameters = PARAMETER_PAGES.iter().map(|page| page.number);
        let unknown = UnknownName::new(word, codes.chain(parameters));
        let help = unknown.help("pages are about").unwrap_or_default();
        refused(format!("`word`: there is no page about `{word}`; {help}"))
    })
}
