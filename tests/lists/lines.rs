//! The line format, R3.1 to R3.5.

use std::sync::Arc;

use frictcomp::diagnostic::Severity;
use frictcomp::lists::{Entries, Entry, Number};
use frictcomp::text::SourceFile;

use super::host::{codes, judge, meant};

fn parse(text: &str) -> Entries {
    Entries::parse(&Arc::new(SourceFile::new("a.lis", text)))
}

fn keys(text: &str) -> Vec<String> {
    parse(text).entries.iter().map(Entry::key).collect()
}

#[test]
fn an_entry_is_a_path_and_a_value() {
    // R3.1
    let list = parse("frict_comp.table[ 0 ].in \t 316 note\r\n  =5 b\r\nx[007].y[ 2].z 1\nEnde");
    let found: Vec<_> = list.entries.iter().map(Entry::key).collect();
    assert_eq!(found, ["frict_comp.table[0].in", "x[7].y[2].z"]);
    assert_eq!(
        list.entries[0].number().value.number,
        Some(Number::Integer(316))
    );
    assert_eq!(codes(&list.diagnostics), ["FC124 2:3"]);
}

#[test]
fn comments_and_blank_lines_are_free() {
    // R3.2
    let text = "# head\n\n  # more\n#*****\n/* a.b 1 */\n/* c */ a.b 2\n:\n\ta.c 3 # x\n\
                a.d 4 (x)\na.e 5 /* x */\na.f 6 words\nEnde\n";
    let list = parse(text);
    assert_eq!(keys(text), ["a.b", "a.c", "a.d", "a.e", "a.f"]);
    let values: Vec<_> = list
        .entries
        .iter()
        .map(|e| e.word().value.to_owned())
        .collect();
    assert_eq!(values, ["2", "3", "4", "5", "6"]);
    assert_eq!(codes(&list.diagnostics), [""; 0]);
}

#[test]
fn only_a_parenthesis_opens_a_comment_behind_a_text() {
    // R3.2
    let list = parse("kopf.log_achs_name  X axis # 1 (the long one)\nEnde");
    assert_eq!(list.entries[0].text().value, "X axis # 1");
}

#[test]
fn keys_that_are_commented_out_are_no_matter() {
    // R3.2
    let list = parse("#cax_face_id 1\n#gruppe[0].achse[0].bezeichnung X\n  #a.b 2\n...\n:\nEnde");
    assert_eq!(codes(&list.diagnostics), [""; 0]);
    assert!(list.entries.is_empty());
}

#[test]
fn a_comment_that_swallows_lines_is_said() {
    // R3.2
    let list = parse("/* open\na.c 2\nEnde");
    assert_eq!(codes(&list.diagnostics), ["FC124 1:1"]);
    assert_eq!(list.entries.len(), 1);
}

#[test]
fn a_text_in_quotes_may_hold_a_parenthesis() {
    // R3.2
    for (open, close) in [
        ("\"", "\""),
        ("\u{201c}", "\u{201d}"),
        ("\u{2033}", "\u{2033}"),
    ] {
        let text = format!("sda_mds[0] {open}C:\\Program Files (x86)\\a.lis{close} (main)\nEnde");
        let list = parse(&text);
        let given = list.entries[0].text();
        assert_eq!(given.value, "C:\\Program Files (x86)\\a.lis");
        assert_eq!(given.place().start().column, 13);
    }
    assert_eq!(parse("a.b \"x (y)\nEnde").entries[0].text().value, "\"x");
}

#[test]
fn a_key_may_have_no_value_but_a_word_is_no_key() {
    // R3.1, R3.4
    let list = parse("default_achs_mds\nkopf.log_achs_name\nhello\nEnde");
    assert_eq!(codes(&list.diagnostics), ["FC124 3:1"]);
    assert_eq!(list.entries.len(), 2);
}

#[test]
fn what_is_no_list_is_said_once_and_shortly() {
    // R3.1
    let program = "X[COMP ON FRICT]\n".repeat(500);
    let found = parse(&program);
    let codes = codes(&found.diagnostics);
    assert_eq!(
        codes
            .iter()
            .filter(|code| code.starts_with("FC124"))
            .count(),
        21
    );
    assert!(found.diagnostics[20].message.starts_with("480 more lines"));
    let xml = parse("<?xml version=\"1.0\"?>\n<a>\n</a>\n");
    assert_eq!(xml.diagnostics.len(), 1);
    assert!(xml.diagnostics[0].message.contains("XML"));
}

#[test]
fn ende_closes_a_list() {
    // R3.3
    for end in ["Ende", "End", "ENDE # x", "  Ende"] {
        let list = parse(&format!("a.b 1\n{end}\na.c 2\n%%\n"));
        assert_eq!(list.entries.len(), 1, "{end}");
        assert!(list.diagnostics.is_empty(), "{end}");
    }
    let open = parse("a.b 1\n  a.c 2  \n\n");
    assert_eq!(codes(&open.diagnostics), ["FC120 2:1"]);
    assert_eq!(open.diagnostics[0].severity, Severity::Info);
    assert_eq!(codes(&parse("").diagnostics), ["FC120 1:1"]);
}

#[test]
fn values_have_many_forms() {
    // R3.4
    let list = parse(
        "a.a -7\na.b 0x1f\na.c 2.5\na.d TRUE\na.e 0\na.f FRICT | CROSS | # both\na.g \u{fc}ber 3\nEnde",
    );
    let number = |at: usize| list.entries[at].number().value.number;
    assert_eq!(number(0), Some(Number::Integer(-7)));
    assert_eq!(number(1), Some(Number::Integer(31)));
    assert_eq!(number(2), Some(Number::Real(2.5)));
    assert_eq!(list.entries[3].truth().value, Some(true));
    assert_eq!(list.entries[4].truth().value, Some(false));
    let words: Vec<_> = list.entries[5].words().iter().map(|w| w.value).collect();
    assert_eq!(words, ["FRICT", "CROSS"]);
    assert_eq!(list.entries[6].text().value, "\u{fc}ber 3");
}

#[test]
fn the_last_of_two_values_wins() {
    // R3.5
    let report = judge("frict_comp.mode 3\nfrict_comp.mode 0\nEnde");
    assert_eq!(codes(&report.diagnostics), ["FC121 2:1"]);
    let twice = &report.diagnostics[0];
    assert_eq!(twice.labels[0].place.start().line, 1);
    assert_eq!(report.reports[0].parameters[0].value, "0");
    let spread = parse("a.b[0] 1\na.b[1] 1\na.b[ 00 ] 2\nEnde");
    assert_eq!(codes(&spread.diagnostics), ["FC121 3:1"]);
    assert_eq!(spread.entries.len(), 2);
}

#[test]
fn unknown_friction_keys_are_said_and_others_passed_over() {
    // R3.5
    let report = judge(
        "frict_comp.revesal_lookahead 4\nfrict_comp.table[3].inn 4\nfrict_comp.sample 4\n\
         frict_comp.f_i[2] 4\nfrict_comp.file_path C:\\a b\nother.key 4\nFrict_Comp.mode 3\nEnde",
    );
    assert_eq!(
        codes(&report.diagnostics),
        ["FC122 1:1", "FC122 2:1", "FC122 7:1"]
    );
    let help: Vec<_> = report
        .diagnostics
        .iter()
        .map(|d| d.help().join(" "))
        .collect();
    assert_eq!(
        help,
        [
            "did you mean `frict_comp.reversal_lookahead`?",
            "did you mean `frict_comp.table[3].in`?",
            "did you mean `frict_comp.mode`?",
        ]
    );
    assert_eq!(meant(&report.diagnostics[1]), "frict_comp.table[3].inn");
}
