//! Files that hold no NC program, known by how they begin (R18.6).
//!
//! Only what no block can begin with counts: text that is merely not understood is reported block by block.

use crate::text::lines_of;

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

/// `<?xml`, `<!--`, `<svg`: no block begins with `<`.
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

/// `{"`, `{}`, `[{`, `["`, `[[1`: a block may begin with `[LABEL]`, settings with `[[table]]`.
fn is_json(text: &str) -> bool {
    let mut letters = text.chars().filter(|it| !it.is_whitespace());
    match (letters.next(), letters.next(), letters.next()) {
        (Some('{'), Some('"' | '}'), _) | (Some('['), Some('{' | '"'), _) => true,
        (Some('['), Some('['), Some(next)) => next == '"' || next.is_ascii_digit(),
        _ => false,
    }
}

/// Whether there are control characters of several kinds that no text has. Tapes and serial lines leave NUL, DEL,
/// STX, ETX, EOT, SUB and DC1 to DC4.
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

/// How surely a value is one of TOML.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Told {
    Surely,
    Perhaps,
}

/// Whether a `#` begins a comment of TOML, not a command.
fn is_remark(after: &str) -> bool {
    after.is_empty() || after.starts_with([' ', '\t', '#', '-', '='])
}

/// `[machine]`, `[[axis]]`: with a letter in lower case, which jump labels rarely have.
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

/// The value of `key = value`, whose key no axis, parameter or variable of a program has.
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
}
