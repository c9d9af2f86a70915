//! Text that has the form of the language, but no known meaning (R2.70).

use super::fault::Fault;
use crate::diagnostic::Code;
use crate::text::Span;

/// FC210 for a text.
pub(crate) fn not_known(text: &str, span: Span) -> Fault {
    let shown: String = text.trim().chars().take(40).collect();
    Fault::new(
        Code::Fc210,
        span,
        format!(
            "`{shown}` is not known to frictcomp; whatever it could change is unknown from here on"
        ),
    )
    .with_help("if the control knows it, check yourself what it does to compensation")
}

/// Whether the parts of a name, `V` left out, make a variable: a sign begins only the name of a
/// software limit, `V.A.+SWE.X`, an `@` only what a call gave, `V.G.@P[1].VALID`.
pub(super) fn is_variable<'a>(mut parts: impl Iterator<Item = &'a str>) -> bool {
    let plain = |part: &str| !part.starts_with(['+', '-', '@']);
    let family = parts.next().unwrap_or_default();
    let name = parts.next().unwrap_or_default();
    let is_limit = family.eq_ignore_ascii_case("A") && !name.starts_with('@');
    let is_given = family.eq_ignore_ascii_case("G") && name.starts_with('@');
    plain(family) && (plain(name) || is_limit || is_given) && parts.all(plain)
}
