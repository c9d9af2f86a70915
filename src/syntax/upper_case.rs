//! Words in lower case, written in upper case (R1.8).

use crate::diagnostic::Fix;
use crate::text::Span;

/// The change that writes words in upper case: the first, and those after it up to a place that may
/// hold something that the parser does not see. A comment or a foreign character is at least two
/// blanks in `code`, a continued line has a line end.
pub(super) fn in_upper_case(code: &str, words: &[Span]) -> Option<Fix<Span>> {
    let (first, others) = words.split_first()?;
    let mut whole = *first;
    let mut text = first.of(code).to_ascii_uppercase();
    for word in others {
        let between = code.get(whole.range().end..word.range().start);
        let Some(between) = between.filter(|it| !it.contains("  ") && !it.contains('\n')) else {
            break;
        };
        text.push_str(between);
        text.push_str(&word.of(code).to_ascii_uppercase());
        whole = whole.to(*word);
    }
    Some(Fix::safe(whole, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_written_in_upper_case_as_far_as_all_is_seen() {
        let words = |spans: &[(usize, usize)]| -> Vec<Span> {
            let spans = spans.iter();
            spans.map(|(start, end)| Span::new(*start, *end)).collect()
        };
        let fixed = |code: &str, spans| {
            let fix = in_upper_case(code, &words(spans)).expect("a word");
            let mut code = code.to_owned();
            code.replace_range(fix.place.range(), &fix.text);
            code
        };
        assert_eq!(
            fixed("X[COMP on\tfrict]", &[(7, 9), (10, 15)]),
            "X[COMP ON\tFRICT]"
        );
        assert_eq!(fixed("g1 x2", &[(0, 1), (3, 4)]), "G1 X2");
        // There may be a comment.
        assert_eq!(
            fixed("X[COMP on  frict]", &[(7, 9), (11, 16)]),
            "X[COMP ON  frict]"
        );
        assert_eq!(fixed("g1\nx2", &[(0, 1), (3, 4)]), "G1\nx2");
        assert_eq!(in_upper_case("", &[]), None);
    }
}
