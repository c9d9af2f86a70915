//! `; frictcomp: allow FC402 reason`: a user's word that a remark is known (R9.24).

use crate::codes::Code;

/// What a comment that speaks to this tool contains.
pub(crate) const MARK: &str = "frictcomp:";

/// The codes that a text allows; words that are no code end the list, they are the reason.
pub(crate) fn allowed(text: &str) -> Vec<Code> {
    let Some((_, behind)) = text.split_once(MARK) else {
        return Vec::new();
    };
    let mut words = behind
        .split(|c: char| c.is_whitespace() || matches!(c, ',' | ')'))
        .filter(|word| !word.is_empty());
    if words.next() != Some("allow") {
        return Vec::new();
    }
    words.map_while(Code::find).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_stand_before_the_reason() {
        // R9.24
        assert_eq!(
            allowed("X[COMP ON FRICT] ; frictcomp: allow FC402 FC405, on purpose"),
            [Code::Fc402, Code::Fc405]
        );
        assert_eq!(allowed("(frictcomp: allow FC402)"), [Code::Fc402]);
        assert_eq!(allowed("; frictcomp: allow because"), []);
        assert_eq!(allowed("; frictcomp"), []);
    }
}
