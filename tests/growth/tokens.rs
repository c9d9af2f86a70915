//! The elements of programs and lists, drawn from the grammar.

use std::collections::BTreeSet;

const GRAMMAR: &str = include_str!("../../grammar.pest");

/// Elements that the grammar leaves open: names, values, texts, comments, and constructs of several words.
const MADE: &[&str] = &[
    "X1",
    "X-.5",
    "G1",
    "M30",
    "F100",
    "N10",
    "N10:",
    "/1",
    "P1",
    "P1=",
    "P1=1",
    "V.P.A",
    "V.E.X",
    "V.P.A=1",
    "@P1",
    "X[",
    "X[COMP ON FRICT]",
    "X[COMP",
    "[A]",
    "AB[",
    "ABS[",
    "\"M\"",
    "\"M\"=\"X1\"",
    "\"a b\"",
    "\"\\",
    "L a.nc",
    "LL S",
    "L CYCLE[",
    "#TIME 1",
    "#FOO",
    "#VAR",
    "#ENDVAR",
    "#COMMENT BEGIN",
    "#COMMENT END",
    "%L S",
    "%S",
    ";",
    "; frictcomp: allow FC402",
    "(c)",
    "(",
    ")",
    "\\",
    "\t",
    "\u{3}",
    "\u{e9}",
    "?",
    "1",
    "1.5",
    "1+",
    "-1",
    "AB",
    "ab",
    "_",
];

/// Tokens of each kind, for long combinations.
const KINDS: &[&str] = &[
    "$IF", "$FOR", "$ENDIF", "#TIME 1", "#IF", "X1", "P1", "P1=", "V.P.A", "AB", "1", "+", "*",
    "=", ",", "[", "]", "X[", "ABS[", "\"", "\"M\"", "(", ";", "L", "N", ":", "/", "\\", "?",
];

/// Elements that begin with a bracket, in commands and in expressions.
pub(crate) const OPENERS: &[&str] = &[
    "[",
    "X[",
    "X[COMP ON ",
    "AB[",
    "P1=AB[",
    "P1=ABS[",
    "P1=[",
    "P1=P[",
    "P1[",
    "V.P.A[",
    "G1[",
    "F[",
    "N[",
    "S.POS[",
    "M17 [",
    "L a[",
    "$IF [",
    "$SWITCH ABS[",
];

/// Contents of brackets.
pub(crate) const FILLERS: &[&str] = &["1+1", "X1 ", "AB", "[]", "[1]+", "\"a\"", "'1'", "1,", "-"];

/// Elements of lists.
const OF_LISTS: &[&str] = &[
    "kopf.achs_nr",
    "kopf",
    "lr_param.frict_comp",
    "kw.frict.table[0].in",
    "[0]",
    "[",
    "]",
    ".",
    "1",
    "-1",
    "1.5",
    "0x1F",
    "TRUE",
    "FRICT",
    "a",
    "=",
    ",",
    "#",
    "#1",
    "(",
    ")",
    "\"",
    "\"a\"",
    "'",
    "\\",
    "\t",
    ";",
    "?",
    "\u{e9}",
    "/*",
    "*/",
];

/// Returns every word and sign of the grammar, each `$` and `#` statement, and the open elements.
pub(crate) fn of_programs() -> Vec<String> {
    let mut tokens = BTreeSet::new();
    for line in GRAMMAR.lines() {
        let code = line.split("//").next().unwrap_or_default();
        let is_keyword = code.starts_with("kw_") || code.starts_with("hash_branch");
        for literal in literals(code) {
            if is_keyword && literal.starts_with(|c: char| c.is_ascii_alphabetic()) {
                tokens.extend(["$", "#"].map(|sign| format!("{sign}{literal}")));
            }
            tokens.insert(literal);
        }
    }
    tokens.extend(MADE.iter().map(|&made| made.to_owned()));
    tokens.retain(|token| !token.trim_matches(' ').is_empty() && token != "\n" && token != "\u{0}");
    tokens.into_iter().collect()
}

/// Returns one word of each kind.
pub(crate) fn kinds() -> Vec<String> {
    KINDS.iter().map(|&kind| kind.to_owned()).collect()
}

/// Returns keys, values and signs of lists.
pub(crate) fn of_lists() -> Vec<String> {
    OF_LISTS.iter().map(|&token| token.to_owned()).collect()
}

/// Returns the quoted texts in a line of the grammar.
fn literals(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = code.chars();
    while let Some(opening) = rest.next() {
        if opening != '"' && opening != '\'' {
            continue;
        }
        let mut literal = String::new();
        while let Some(next) = rest.next() {
            match next {
                '\\' => literal.push(match rest.next() {
                    Some('t') => '\t',
                    Some('n') => '\n',
                    Some('u') => '\u{3}',
                    Some(escaped) => escaped,
                    None => break,
                }),
                closing if closing == opening => break,
                other => literal.push(other),
            }
        }
        if !literal.contains(['{', '}']) || literal.len() == 1 {
            found.push(literal);
        }
    }
    found
}

#[test]
fn the_grammar_gives_its_words() {
    let tokens = of_programs();
    for token in [
        "$IF",
        "#ELSEIF",
        "$SWITCH",
        "COMP",
        "**",
        "XOR",
        "[",
        "\"",
        "STR_TO_INT",
        "'",
    ] {
        let is_made = token == "COMP";
        assert!(
            is_made || tokens.iter().any(|known| known == token),
            "{token}: {tokens:?}"
        );
    }
    assert!(tokens.len() > 150, "{tokens:?}");
}
