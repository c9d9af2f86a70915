//! Content of a file: an NC program (R18.5), none, known by how it begins (R18.6), or one of another control, known by
//! its words (R2.97).
//!
//! Only what no block can begin with counts as no program: text that is merely not understood is reported block by block. Plain
//! DIN 66025 is the same on every control and shows nothing.

use std::fmt;

use super::ast::{Address, Block, Item};
use super::keywords::{FLOW_WORDS, hash_name};
use super::lines::{BlockReader, FastPath};
use super::pieces::code_stretches;
use super::raw::Stretch;
use crate::language::HashCommand;
use crate::text::{TextLines, lines_of};

/// Number of bytes at the head of a file that are looked at.
pub const HEAD: usize = 4096;

/// Number of lines of settings that are looked at.
const MAX_LINES: usize = 40;

/// Beginnings of files, as decoded, with what they show.
const BEGINNINGS: [(&str, &str); 16] = [
    ("PK\u{3}\u{4}", "a ZIP archive"),
    ("PK\u{5}\u{6}", "a ZIP archive"),
    ("%PDF-", "a PDF document"),
    ("\u{2030}PNG\r\n", "a PNG picture"),
    ("\u{ff}\u{d8}\u{ff}", "a JPEG picture"),
    ("GIF87a", "a GIF picture"),
    ("GIF89a", "a GIF picture"),
    ("\u{1f}\u{2039}\u{8}", "a gzip archive"),
    ("7z\u{bc}\u{af}", "a 7-Zip archive"),
    ("Rar!\u{1a}", "a RAR archive"),
    ("\u{7f}ELF", "an executable"),
    ("\u{d0}\u{cf}\u{11}\u{e0}", "an Office document"),
    ("#!", "a script"),
    ("CDF\u{1}", "NetCDF data"),
    ("CDF\u{2}", "NetCDF data"),
    ("\u{2030}HDF\r\n", "HDF data"),
];

/// Returns what a text is, in words, where its head shows that it is no NC program.
pub fn no_program(text: &str) -> Option<&'static str> {
    let mut ends = (0..=HEAD.min(text.len())).rev();
    let head = &text[..ends.find(|end| text.is_char_boundary(*end))?];
    let known = BEGINNINGS.iter().find(|(begin, _)| head.starts_with(begin));
    if let Some((_, what)) = known {
        return Some(what);
    }
    let first = head.trim_start_matches(|it: char| it.is_whitespace() || "\0\u{feff}".contains(it));
    match first.as_bytes().first()? {
        b'<' => markup(first),
        b'{' | b'[' if is_json(first) => Some("JSON"),
        _ if is_binary(head) => Some("binary data"),
        _ => settings(first),
    }
}

/// Returns `<?xml`, `<!--`, `<svg`: no block begins with `<`.
fn markup(text: &str) -> Option<&'static str> {
    let begins = |begin: &str| {
        let head = text.get(..begin.len());
        head.is_some_and(|head| head.eq_ignore_ascii_case(begin))
    };
    let next = text[1..].chars().next()?;
    if begins("<!doctype html") || begins("<html") {
        Some("HTML")
    } else if "?!/".contains(next) || next.is_ascii_alphabetic() {
        Some("XML")
    } else {
        None
    }
}

/// Returns whether a text begins like JSON: `{"`, `{}`, `[{`, `["`, `[[1`; a block may begin with `[LABEL]`, settings
/// with `[[table]]`.
fn is_json(text: &str) -> bool {
    let mut letters = text.chars().filter(|it| !it.is_whitespace());
    match (letters.next(), letters.next(), letters.next()) {
        (Some('{'), Some('"' | '}'), _) | (Some('['), Some('{' | '"'), _) => true,
        (Some('['), Some('['), Some(next)) => next == '"' || next.is_ascii_digit(),
        _ => false,
    }
}

/// Returns whether there are control characters of several kinds that no text has. Tapes and serial lines leave NUL,
/// DEL, STX, ETX, EOT, SUB and DC1 to DC4.
fn is_binary(head: &str) -> bool {
    let (mut count, mut kinds) = (0, 0_u32);
    let odd = head.bytes().filter(|byte| {
        *byte < b' ' && !matches!(byte, 0 | 2..=4 | b'\t'..=b'\r' | 0x11..=0x14 | 0x1a)
    });
    for byte in odd {
        count += 1;
        kinds |= 1 << byte;
    }
    let read = head.bytes().filter(|byte| *byte != 0).count();
    kinds.count_ones() >= 3 && count * 64 >= read
}

/// Tables and keys of TOML, or sections of an INI file, and hardly anything else. A line `[LABEL]` alone shows
/// nothing: it is a jump label.
fn settings(head: &str) -> Option<&'static str> {
    let lines = lines_of(head).map(str::trim);
    let lines = lines.filter(|line| {
        let is_comment = line.starts_with(';') || line.strip_prefix('#').is_some_and(is_remark);
        !line.is_empty() && !is_comment
    });
    let lines: Vec<&str> = lines.take(MAX_LINES).collect();
    let values: Vec<&str> = lines.iter().filter_map(|line| value(line)).collect();
    let tables = lines.iter().filter(|line| is_table(line)).count();
    let is_settings = |line: &str| is_table(line) || value(line).is_some();
    let is_told = tables > 0 || values.iter().any(|it| is_toml(it, Told::Surely));
    if !is_settings(lines.first()?)
        || values.is_empty()
        || !is_told
        || (tables + values.len()) * 4 < lines.len() * 3
    {
        return None;
    }
    let is_all_toml = values.iter().all(|it| is_toml(it, Told::Perhaps));
    Some(if is_all_toml { "TOML" } else { "an INI file" })
}

/// Certainty with which a value is one of TOML.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Told {
    Surely,
    Perhaps,
}

/// Returns whether a `#` begins a comment of TOML, not a command.
fn is_remark(after: &str) -> bool {
    after.is_empty() || after.starts_with([' ', '\t', '#', '-', '='])
}

/// Returns whether a line is the head of a TOML table: `[machine]`, `[[axis]]`, with a letter in lower case, which jump
/// labels rarely have.
fn is_table(line: &str) -> bool {
    let line = line
        .split_once('#')
        .map_or(line, |(code, _)| code.trim_end());
    let name = line.strip_prefix('[').and_then(|it| it.strip_suffix(']'));
    let inner = name.map(|it| {
        it.strip_prefix('[')
            .and_then(|it| it.strip_suffix(']'))
            .unwrap_or(it)
    });
    inner.is_some_and(|name| {
        name.contains(|it: char| it.is_ascii_lowercase())
            && name
                .chars()
                .all(|it| it.is_alphanumeric() || "_-. \"".contains(it))
    })
}

/// Returns the value of `key = value`, whose key no axis, parameter or variable of a program has.
fn value(line: &str) -> Option<&str> {
    let (key, value) = line.split_once('=')?;
    let (key, value) = (key.trim(), value.trim());
    let is_key = key
        .chars()
        .all(|it| it.is_alphanumeric() || "_-.".contains(it))
        && (key.chars().filter(|it| it.is_alphabetic()).count() > 1
            || is_toml(value, Told::Surely))
        && key.contains(|it: char| it.is_ascii_lowercase())
        && !key.get(..2).is_some_and(|it| it.eq_ignore_ascii_case("v."));
    is_key.then_some(value)
}

fn is_toml(value: &str, told: Told) -> bool {
    let is_word = |word: &str| {
        value == word
            || value
                .strip_prefix(word)
                .is_some_and(|it| it.trim_start().starts_with('#'))
    };
    let is_sure = value.starts_with(['"', '\'', '{'])
        || value.starts_with("[\"")
        || is_word("true")
        || is_word("false");
    is_sure
        || (told == Told::Perhaps
            && value.starts_with(|it: char| it.is_ascii_digit() || "+-[".contains(it)))
}

/// Number of blocks at the head of a text that are looked at.
const MAX_BLOCKS: usize = 400;

/// Number of blocks after which a text that hardly has any is given up.
const FIRST_BLOCKS: usize = 24;

/// Returns whether more than two thirds of the lines at the head of a text are blocks, and one of them is of a kind
/// that only NC programs have: R2.97 turned round.
pub fn reads_as_program(text: &str) -> bool {
    if no_program(text).is_some() {
        return false;
    }
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    let (mut all, mut good, mut is_told) = (0, 0, false);
    while let Some(raw) = reader.next(&mut block) {
        if raw.text.starts_with("```") {
            return false;
        }
        if raw.stretch != Stretch::Block {
            continue;
        }
        all += 1;
        if block.faults.is_empty() {
            good += 1;
            is_told |= tells(&block);
        }
        if all == MAX_BLOCKS || (all == FIRST_BLOCKS && good * 4 < all) {
            break;
        }
    }
    is_told && good * 3 > all * 2
}

/// Returns whether other texts hardly have such a block: a block number, a G or M function, a command, a statement.
fn tells(block: &Block) -> bool {
    let is_function = |address: &Address| matches!(address, Address::Letter(b'G' | b'M'));
    block.number.is_some()
        || block.words.iter().any(|word| is_function(&word.address))
        || block.items.iter().any(|item| match item {
            Item::Word(word) => is_function(&word.address),
            Item::Comp(_) | Item::Bracket { .. } | Item::Flow(..) | Item::Hash(_) => true,
            _ => false,
        })
}

/// Number of blocks at the head of a program that are looked at.
const MAX_LOOKED_AT: usize = 400;

/// Number of lines, with comments and without.
const JUDGED_LINES: usize = 4000;

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
    for line in text.split(['\n', '\r']).take(JUDGED_LINES) {
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
    /// Block valid on every control, or of an unknown control.
    Any,
}

/// Returns a line without comments and strings in upper case; the name of a program stays.
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

/// Returns the length of the word that a text begins with; a block number before a word does not belong to it.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_files_are_known_by_their_beginning() {
        // R18.6
        for (text, what) in [
            ("[machine]\nstartup = \"hochlauf.lis\"\n", "TOML"),
            (
                "# A machine\n\n[[axis]]\nname = \"X\"\nenable = true\n",
                "TOML",
            ),
            ("name = \"part\"\nversion = 3\n", "TOML"),
            ("[a]\nb = \"x\"\n", "TOML"),
            ("[Section]\nName=a part\nCount=3\n", "an INI file"),
            ("{\n  \"schema\": 1\n}", "JSON"),
            ("[ {\"a\": 1} ]", "JSON"),
            ("[[1, 2], [3, 4]]", "JSON"),
            ("\u{feff}\r\n<?xml version=\"1.0\"?>", "XML"),
            ("<svg xmlns=\"a\">", "XML"),
            ("<!DOCTYPE html>", "HTML"),
            ("PK\u{3}\u{4}\u{14}\0", "a ZIP archive"),
            ("%PDF-1.7\n", "a PDF document"),
            ("\u{2030}PNG\r\n\u{1a}\n", "a PNG picture"),
            ("#!/bin/sh\nX1\n", "a script"),
            ("CDF\u{1}\0\0\0\0", "NetCDF data"),
            ("\u{1}\u{6}\u{1f}\u{8}\u{e}ab", "binary data"),
        ] {
            assert_eq!(no_program(text), Some(what), "{text:?}");
        }
    }

    #[test]
    fn programs_are_none_of_them() {
        // R18.6
        for text in [
            "",
            "\0\0\0",
            "; comment\n(all)\n",
            "%PART\nN10 X1\nM30\n",
            "[LOOP]\nP1 = P1 + 1\nP2 = 3\n$GOTO [LOOP]\n",
            "[Loop]\nX1\n$GOTO [Loop]\nM30\n",
            "p1 = 3\nx = 5\nv.p.name = \"A\"\nm30\n",
            "\"CUT\" = \"G1 X5\"\n\"CUT\"\n",
            "\u{2}N10 X1\r\n\u{11}N20 M30\u{3}\u{4}\u{1a}\0\0",
            "#MSG [\"A\"]\n# SLOPE\n",
            "V.P.A = \"text\"\nV.S.B = \"text\"\n",
            "AX2 = 5\nAX3 = 7\n",
            "{X1}\n[X1]\n",
        ] {
            assert_eq!(no_program(text), None, "{text:?}");
        }
    }

    #[test]
    fn programs_are_known_by_their_blocks() {
        // R18.5
        for text in [
            "X[COMP OFF FRICT]\r\nG1 X5 F100\r\nM30\r\n",
            "; a part\n%PART\n\nN10 G0 X0 Y0\nN20 L SUB.nc\nsomething else\nN30 M30\n",
            "$IF P1 == 1\nX5\n$ENDIF\n",
            "M17",
            "[LOOP]\nP1 = P1 + 1\nX=P1\n$GOTO [LOOP]\n",
        ] {
            assert!(reads_as_program(text), "{text}");
        }
        for text in [
            "",
            "; only a comment\n",
            "# Title\n\nThe axis is switched by a command:\n\n```nc\nX[COMP OFF FRICT]\nM30\n```\n\nThen it moves.\nMore text.\n",
            "```nc\nX[COMP OFF FRICT]\nX1\nX2\nM30\n```\n",
            "An example follows.\nIt ends the program.\nX[COMP OFF FRICT]\nG1 X5\nM30\n",
            "t,line,X\n0.000,2,0\n0.001,2,1\n",
            "0.000 2 0\n0.001 2 1\n",
            "Dear colleague,\nG54 is set. M30 ends it.\nRegards\n",
            "PROGRAM MAIN\nVAR\n  x : INT;\nEND_VAR\nx := 5;\nIF x > 3 THEN\n  y := 1;\nEND_IF\n",
            "fn main() {\n    let x = 5;\n    println!(\"X[COMP OFF FRICT]\");\n}\n",
            "kopf.achs_nr   1\nlr_param.frict_comp.enable 1\n",
            "all:\n\tcargo build\n\nclean:\n\trm -rf out\n",
            "a = 5\nb = 7\n",
            "*.o\n/build\n!keep\n",
        ] {
            assert!(!reads_as_program(text), "{text}");
        }
    }
}
