//! Programs of other controls, known by their words (R2.97).
//!
//! Plain DIN 66025 is the same on every control and shows nothing.

use std::fmt;

use super::hash_words::hash_name;
use super::keywords::FLOW_WORDS;
use super::pieces::code_stretches;
use crate::language::HashCommand;

/// Number of blocks at the head of a program that are looked at.
const MAX_LOOKED_AT: usize = 400;

/// Number of lines, with comments and without.
const MAX_LINES: usize = 4000;

/// Number of blocks with foreign words below which they may be mistakes.
const MIN_FOREIGN: usize = 3;

/// Number of words that a message shows.
const MAX_SHOWN: usize = 3;

/// A control whose programs are of another dialect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dialect {
    Sinumerik,
    Fanuc,
    Rs274,
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sinumerik => "SINUMERIK",
            Self::Fanuc => "Fanuc",
            Self::Rs274 => "RS-274 (LinuxCNC)",
        })
    }
}

/// Evidence that a program is of another control.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Foreign {
    pub(crate) dialect: Dialect,
    /// The first of its words that showed it.
    pub(crate) words: Vec<String>,
    /// Number of blocks with such words.
    pub(crate) blocks: usize,
    /// Number of blocks examined.
    pub(crate) of: usize,
}

/// The words of SINUMERIK that are neither DIN nor ISG.
const SINUMERIK: [&str; 44] = [
    "AMIRROR",
    "AROT",
    "ATRANS",
    "BRISK",
    "CALL",
    "CASE",
    "CFC",
    "CFTCP",
    "COMPCAD",
    "COMPOF",
    "DEF",
    "DIAMOF",
    "DIAMON",
    "ENDFOR",
    "ENDIF",
    "ENDLOOP",
    "ENDPROC",
    "ENDWHILE",
    "EXTERN",
    "FFWOF",
    "FFWON",
    "FOR",
    "GOTOB",
    "GOTOC",
    "GOTOF",
    "LIMS",
    "LOOP",
    "MCALL",
    "MIRROR",
    "MSG",
    "PROC",
    "REPEAT",
    "RET",
    "ROT",
    "SETMS",
    "SOFT",
    "SPOS",
    "STOPRE",
    "SUPA",
    "TRAFOOF",
    "TRANS",
    "TRAORI",
    "UNTIL",
    "WORKPIECE",
];

/// Beginnings of cycles of SINUMERIK, before a number.
const SINUMERIK_CYCLES: [&str; 5] = ["CYCLE", "HOLES", "LONGHOLE", "POCKET", "SLOT"];

/// Beginnings of system variables of SINUMERIK after `$`.
const SINUMERIK_VARIABLES: [&str; 9] =
    ["P_", "A_", "AA_", "AC_", "TC_", "MN_", "MC_", "MA_", "VA_"];

/// Keywords after the number of an O word of RS-274.
const O_WORDS: [&str; 13] = [
    "BREAK", "CALL", "CONTINUE", "DO", "ELSE", "ELSEIF", "ENDIF", "ENDSUB", "ENDWHILE", "IF",
    "RETURN", "SUB", "WHILE",
];

/// Looks at the head of a program: more than a quarter of its blocks have words of another control, and
/// none has one of ISG's.
pub(crate) fn foreign(text: &str) -> Option<Foreign> {
    let mut counts = [
        (Dialect::Sinumerik, 0),
        (Dialect::Fanuc, 0),
        (Dialect::Rs274, 0),
    ];
    let mut shown: Vec<(Dialect, String)> = Vec::new();
    let (mut blocks, mut found) = (0, 0);
    for line in text.split(['\n', '\r']).take(MAX_LINES) {
        let code = code_of(line);
        let code = code.trim();
        if code.is_empty() {
            continue;
        }
        let word = match meaning(code) {
            DialectEvidence::Isg => return None,
            DialectEvidence::Any => None,
            DialectEvidence::Of(dialect, word) => Some((dialect, word)),
        };
        if let Some((dialect, word)) = word {
            found += 1;
            counts
                .iter_mut()
                .filter(|(known, _)| *known == dialect)
                .for_each(|(_, count)| *count += 1);
            if !shown.iter().any(|(_, known)| *known == word) {
                shown.push((dialect, word));
            }
        }
        blocks += 1;
        if blocks == MAX_LOOKED_AT {
            break;
        }
    }
    if found < MIN_FOREIGN || found * 4 <= blocks {
        return None;
    }
    let (dialect, _) = counts.into_iter().rev().max_by_key(|(_, count)| *count)?;
    let words = shown.into_iter().filter(|(of, _)| *of == dialect);
    Some(Foreign {
        dialect,
        words: words.take(MAX_SHOWN).map(|(_, word)| word).collect(),
        blocks: found,
        of: blocks,
    })
}

/// Evidence of a block on its control.
enum DialectEvidence {
    Isg,
    Of(Dialect, String),
    /// It is valid on every control, or its control is not known.
    Any,
}

/// A line without comments and strings in upper case; the name of a program stays.
fn code_of(line: &str) -> String {
    if line.trim_start().starts_with('%') {
        return line.to_ascii_uppercase();
    }
    let code: Vec<&str> = code_stretches(line).collect();
    code.join(" ").to_ascii_uppercase()
}

fn meaning(code: &str) -> DialectEvidence {
    if let Some(name) = code.strip_prefix('%') {
        return match name {
            name if name.starts_with("_N_") => {
                DialectEvidence::Of(Dialect::Sinumerik, "%_N_".to_owned())
            }
            name if name.starts_with("L ") => DialectEvidence::Isg,
            _ => DialectEvidence::Any,
        };
    }
    let mut foreign = None;
    let bytes = code.as_bytes();
    let mut at = 0;
    while at < code.len() {
        let rest = &code[at..];
        let length = word_length(rest);
        let meaning = match bytes[at] {
            b'#' => after_hash(rest),
            b'$' => after_dollar(rest),
            b'@' if rest[1..].starts_with('P') => DialectEvidence::Isg,
            _ if length > 0 => of_word(&code[..at], &rest[..length], &rest[length..]),
            _ => DialectEvidence::Any,
        };
        match meaning {
            DialectEvidence::Isg => return DialectEvidence::Isg,
            DialectEvidence::Of(dialect, word) => foreign = foreign.or(Some((dialect, word))),
            DialectEvidence::Any => {}
        }
        let first = rest.chars().next().map_or(1, char::len_utf8);
        at += length.max(first);
    }
    match foreign {
        Some((dialect, word)) => DialectEvidence::Of(dialect, word),
        None => DialectEvidence::Any,
    }
}

/// The length of the word that a text begins with; a block number before a word does not belong to it.
fn word_length(text: &str) -> usize {
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    if !begins {
        return 0;
    }
    if let Some(number) = text.strip_prefix('N') {
        let digits = number.bytes().take_while(u8::is_ascii_digit).count();
        if digits > 0 {
            return digits + 1;
        }
    }
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.find(|c| !is_part(c)).unwrap_or(text.len())
}

fn after_hash(text: &str) -> DialectEvidence {
    let dialect = match text.as_bytes().get(1) {
        Some(b'<') => Dialect::Rs274,
        Some(b'0'..=b'9' | b'[') => Dialect::Fanuc,
        _ => {
            return match HashCommand::of(&hash_name(text).0) {
                Some(_) => DialectEvidence::Isg,
                None => DialectEvidence::Any,
            };
        }
    };
    let is_part = |c: char| c.is_ascii_alphanumeric() || "_<>".contains(c);
    let length = text[1..].find(|c| !is_part(c)).map(|length| length + 1);
    DialectEvidence::Of(dialect, text[..length.unwrap_or(text.len())].to_owned())
}

fn after_dollar(text: &str) -> DialectEvidence {
    let length = 1 + word_length(&text[1..]);
    let word = &text[..length];
    if FLOW_WORDS.contains(&word) {
        DialectEvidence::Isg
    } else if SINUMERIK_VARIABLES
        .iter()
        .any(|begin| word[1..].starts_with(begin))
    {
        DialectEvidence::Of(Dialect::Sinumerik, word.to_owned())
    } else {
        DialectEvidence::Any
    }
}

/// Returns the evidence of a word, from the text before and after it.
fn of_word(before: &str, word: &str, after: &str) -> DialectEvidence {
    let numbered = |begin: &str| {
        let number = word.strip_prefix(begin);
        number.is_some_and(|it| !it.is_empty() && it.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let next = after.trim_start();
    let is_assigned = next.starts_with('=');
    let of = |dialect| DialectEvidence::Of(dialect, word.to_owned());
    match word {
        "V" if after.starts_with('.') => DialectEvidence::Isg,
        "COMP" if before.trim_end().ends_with('[') => DialectEvidence::Isg,
        "LL" => DialectEvidence::Isg,
        "L" if next.starts_with("CYCLE") => DialectEvidence::Isg,
        _ if numbered("P") && is_assigned => DialectEvidence::Isg,
        _ if numbered("R") && is_assigned => {
            DialectEvidence::Of(Dialect::Sinumerik, format!("{word}="))
        }
        "O" if after.starts_with('<') => DialectEvidence::Of(Dialect::Rs274, "O<".to_owned()),
        _ if numbered("O") && O_WORDS.contains(&&next[..word_length(next)]) => DialectEvidence::Of(
            Dialect::Rs274,
            format!("{word} {}", &next[..word_length(next)]),
        ),
        "G38" | "G33" if after.starts_with('.') => of(Dialect::Rs274),
        "M98" | "M99" | "G65" => of(Dialect::Fanuc),
        "IF" | "WHILE" if next.starts_with('[') => of(Dialect::Fanuc),
        "GOTO" if next.starts_with(|c: char| c.is_ascii_digit()) => of(Dialect::Fanuc),
        _ if numbered("END") || numbered("DO") => of(Dialect::Fanuc),
        "IF" | "WHILE" | "GOTO" => of(Dialect::Sinumerik),
        "IC" | "AC" | "DC" if before.trim_end().ends_with('=') => of(Dialect::Sinumerik),
        _ if SINUMERIK.contains(&word) => of(Dialect::Sinumerik),
        _ if SINUMERIK_CYCLES.iter().any(|cycle| numbered(cycle)) => of(Dialect::Sinumerik),
        _ => DialectEvidence::Any,
    }
}
