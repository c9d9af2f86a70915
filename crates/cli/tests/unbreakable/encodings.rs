//! Old and new encodings, every line end: messages point at the right characters, in every
//! format and on every way in which a text reaches the tool.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use crate::folder::{Bench, json};

const MISTAKE: &str = "X[COMP ON FRIKT]";

/// The text before the mistake in its line, and its marker in text output: as many blanks as
/// terminal columns, a tab being four.
const LEADS: [(&str, usize); 7] = [
    ("", 0),
    ("N10 ", 4),
    ("\t", 4),
    ("N10\t(Ü)\t", 14),
    ("(äöüß°µ) ", 9),
    ("(軸の摩擦) ", 11),
    ("(e\u{301}\u{1f980}) ", 6),
];

/// Way in which a text reaches the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// A file, line by line.
    Streamed,
    /// A file with flow, in memory.
    Whole,
    /// Standard input.
    Stdin,
    /// A program that another one calls.
    Called,
}

const WAYS: [Way; 4] = [Way::Streamed, Way::Whole, Way::Stdin, Way::Called];

impl Way {
    /// Returns the name of the text in messages about it.
    fn file(self) -> &'static str {
        match self {
            Self::Streamed | Self::Whole => "a.nc",
            Self::Stdin => "<stdin>",
            Self::Called => "sub.nc",
        }
    }

    /// Returns the messages of `check` about a text.
    fn check(self, text: &[u8], format: &str) -> String {
        let mut text = text.to_owned();
        if self == Self::Whole {
            text.extend(b"$IF 1\n$ENDIF\n");
        }
        let end: &[u8] = if self == Self::Called { b"M17" } else { b"M30" };
        text.extend(end);
        let bench = Bench::new(&[("main.nc", "L sub.nc\nM30\n")]);
        if self != Self::Stdin {
            std::fs::write(bench.folder().join(self.file()), &text).expect("written");
        }
        let path = match self {
            Self::Streamed | Self::Whole => "a.nc",
            Self::Stdin => "-",
            Self::Called => "main.nc",
        };
        let mut command = bench.command(&["check", "--format", format, path]);
        let mut child = command.stdin(Stdio::piped()).spawn().expect("it starts");
        let mut stdin = child.stdin.take().expect("a pipe");
        if self == Self::Stdin {
            stdin.write_all(&text).expect("written");
        }
        drop(stdin);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(1), "{self:?} {text:?}");
        String::from_utf8(output.stdout).expect("text")
    }
}

/// Returns the first column of the mistake, counted in characters from 1 (R9.10).
fn column(lead: &str) -> usize {
    lead.chars().count() + 1
}

/// Returns the columns of `FRIKT`, the word that is wrong.
fn columns(lead: &str) -> (usize, usize) {
    let start = column(lead) + "X[COMP ON ".len();
    (start, start + "FRIKT".len())
}

fn text(lead: &str, line_end: &str) -> String {
    format!("; Prüfung{line_end}{lead}{MISTAKE}{line_end}")
}

#[test]
fn columns_count_characters_in_every_format() {
    // R9.10, R9.21, R9.25
    for way in WAYS {
        for (lead, _) in LEADS {
            let text = text(lead, "\r\n");
            let file = way.file();
            let (start, end) = columns(lead);
            let said = |format| way.check(text.as_bytes(), format);
            let concise = said("concise");
            let at = format!("{file}:2:{start}: error[FC202]");
            assert!(concise.contains(&at), "{way:?} {lead:?}: {concise}");
            let record = json(said("ndjson").lines().next().expect("a record"));
            let numbers =
                ["line", "column", "end_line", "end_column"].map(|key| record[key].clone());
            assert_eq!(
                numbers,
                [2, start, 2, end].map(Value::from),
                "{way:?} {lead:?}"
            );
            let sarif = json(&said("sarif"));
            let run = &sarif["runs"][0];
            assert_eq!(run["columnKind"], "unicodeCodePoints");
            let region = &run["results"][0]["locations"][0]["physicalLocation"]["region"];
            let keys = ["startLine", "startColumn", "endLine", "endColumn"];
            assert_eq!(
                keys.map(|key| region[key].clone()),
                [2, start, 2, end].map(Value::from)
            );
            let github = said("github");
            let at = format!("line=2,col={start},endColumn={end}");
            assert!(github.contains(&at), "{way:?} {lead:?}: {github}");
        }
    }
}

#[test]
fn carets_stand_under_what_is_meant() {
    // R9.21
    for way in WAYS {
        for (lead, columns) in LEADS {
            let said = way.check(text(lead, "\n").as_bytes(), "text");
            let lines: Vec<&str> = said.lines().collect();
            let shown = format!("2 | {}{MISTAKE}", lead.replace('\t', "    "));
            let at = lines.iter().position(|line| *line == shown);
            let at = at.unwrap_or_else(|| panic!("{way:?} {lead:?}:\n{said}"));
            let blanks = " ".repeat(columns + "X[COMP ON ".len());
            let carets = format!("  | {blanks}^^^^^");
            assert_eq!(
                lines[at + 1].trim_end(),
                carets,
                "{way:?} {lead:?}:\n{said}"
            );
        }
    }
}

#[test]
fn line_ends_and_a_byte_order_mark_make_no_difference() {
    // R2.1, R2.2
    for way in WAYS {
        let expected = way.check(text("N10 (Ü) ", "\n").as_bytes(), "text");
        assert!(expected.contains("^^^^^"), "{way:?}: {expected}");
        for line_end in ["\n", "\r\n", "\r"] {
            for mark in ["", "\u{feff}"] {
                let text = format!("{mark}{}", text("N10 (Ü) ", line_end));
                let said = way.check(text.as_bytes(), "text");
                assert_eq!(said, expected, "{way:?} {line_end:?} {mark:?}");
            }
        }
    }
}

#[test]
fn code_page_1252_is_read_as_its_characters() {
    // R2.2
    for way in WAYS {
        let lead = "N10 (\u{dc}\u{e4}\u{20ac}) ";
        let expected = way.check(text(lead, "\r\n").as_bytes(), "text");
        let mut bytes = b"; Pr\xfcfung\r\nN10 (\xdc\xe4\x80) ".to_vec();
        bytes.extend(MISTAKE.as_bytes());
        bytes.extend(b"\r\n");
        assert_eq!(way.check(&bytes, "text"), expected, "{way:?}");
    }
}

#[test]
fn records_carry_the_characters_of_the_file() {
    // R9.10
    let bench = Bench::new(&[]);
    let blocks = "N10 X1 (Ü\t\"軸\" \\ \u{7f})\rN20 X[COMP OFF FRICT] (\u{1f980})\rN30 M30\r";
    bench.write("a.nc", blocks);
    let found = bench.blocks(&["a.nc"]);
    let texts: Vec<&str> = found
        .iter()
        .filter_map(|block| block["text"].as_str())
        .collect();
    assert_eq!(texts, blocks.split_terminator('\r').collect::<Vec<_>>());
    let csv = bench.stdout(&["run", "--format", "csv", "a.nc"]);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let rows = reader
        .records()
        .map(|row| row.expect("a row")[5].to_owned());
    // CSV has no escape for what a terminal would obey (R9.76).
    let visible: Vec<String> = texts
        .iter()
        .map(|text| text.replace('\u{7f}', "\u{2421}"))
        .collect();
    assert_eq!(rows.collect::<Vec<_>>(), visible);
}
