//! The writer of JSON lines against the serialised form of the records.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use proptest::prelude::*;
use serde_json::Value;

use super::*;
use frictcomp::comp::{AxisIndex, Change, Kind, KindSet, State};
use frictcomp::diagnostic::{Diagnostic, Fix, Severity};
use frictcomp::text::is_hidden;
use frictcomp::text::{Place, Span};
use frictcomp::timeline::{End, EndNote, EndedBy, Join, Record, Repeat, Row, StateView, Summary};

/// Texts with what JSON escapes, what is never shown as such, and what is neither.
fn text() -> impl Strategy<Value = String> {
    let letter = prop_oneof![
        4 => any::<char>(),
        8 => prop::char::range(' ', '~'),
        2 => prop::sample::select(vec!['"', '\\', '\n', '\t', '\u{8}', '\u{1b}', '\u{7f}', '\u{202e}', '\u{feff}', '軸']),
    ];
    prop::collection::vec(letter, 0..12).prop_map(String::from_iter)
}

fn place() -> impl Strategy<Value = Place> {
    (text(), text(), any::<u16>(), 0_u32..16, 0_u32..16).prop_map(
        |(file, text, line, start, length)| Place {
            file: file.into(),
            text: text.into(),
            first_line: u32::from(line),
            span: Span {
                start,
                end: start + length,
            },
        },
    )
}

fn fix() -> impl Strategy<Value = Fix> {
    (place(), text(), any::<bool>()).prop_map(|(place, text, safe)| {
        if safe {
            Fix::safe(place, text)
        } else {
            Fix::guess(place, text)
        }
    })
}

prop_compose! {
    fn diagnostic()(
        code in prop::sample::select(Code::ALL),
        severity in prop::sample::select(vec![Severity::Info, Severity::Warning, Severity::Error]),
        place in place(),
        message in text(),
        axis in prop::option::of(text()),
        help in prop::collection::vec(text(), 0..3),
        fixes in prop::collection::vec(fix(), 0..3),
    ) -> Diagnostic {
        let mut diagnostic = Diagnostic::new(code, place, message);
        diagnostic.severity = severity;
        diagnostic.axis = axis;
        diagnostic.advice = help.into_iter().map(Into::into).collect();
        diagnostic.fixes = fixes;
        diagnostic
    }
}

fn state() -> impl Strategy<Value = State> {
    prop::sample::select(vec![
        State::Active,
        State::Ineffective,
        State::Inactive,
        State::Unconfigured,
        State::Unknown,
    ])
}

const AXES: usize = 4;

fn change() -> impl Strategy<Value = Change> {
    let kind = prop::sample::select(Kind::ALL.to_vec());
    (0..AXES, kind, state(), state()).prop_map(|(axis, kind, from, to)| Change {
        axis: AxisIndex::new(axis),
        kind,
        from,
        to,
    })
}

fn repeat() -> impl Strategy<Value = Repeat> {
    let code = prop::sample::select(Code::ALL);
    (code, text(), any::<u32>(), any::<u64>()).prop_map(|(code, file, line, times)| Repeat {
        code,
        file,
        line,
        times,
        start: frictcomp::text::Position {
            line,
            column: line % 100,
        },
        message: String::new(),
    })
}

/// What the records of a session hold.
#[derive(Debug, Clone)]
struct Parts {
    axes: Vec<String>,
    enabled: Vec<bool>,
    listed: Vec<bool>,
    texts: [String; 3],
    name: Option<String>,
    numbers: (u32, u64, u32),
    number: Option<i64>,
    level: Option<u32>,
    changes: Vec<Change>,
    diagnostics: Vec<Diagnostic>,
    repeated: Vec<Repeat>,
    by: EndedBy,
    opaque: BTreeMap<String, u64>,
}

prop_compose! {
    fn parts()(
        axes in prop::collection::vec(text(), AXES),
        enabled in prop::collection::vec(any::<bool>(), AXES),
        listed in prop::collection::vec(any::<bool>(), AXES),
        texts in [text(), text(), text()],
        name in prop::option::of(text()),
        numbers in any::<(u32, u64, u32)>(),
        number in any::<Option<i64>>(),
        level in any::<Option<u32>>(),
        changes in prop::collection::vec(change(), 0..4),
        diagnostics in prop::collection::vec(diagnostic(), 0..3),
        repeated in prop::collection::vec(repeat(), 0..3),
        by in prop::sample::select(vec![
            EndedBy::M30, EndedBy::M02, EndedBy::EndOfFile, EndedBy::Error, EndedBy::Budget,
        ]),
        opaque in prop::collection::btree_map(text(), any::<u64>(), 0..3),
    ) -> Parts {
        Parts {
            axes, enabled, listed, texts, name, numbers, number, level, changes, diagnostics,
            repeated, by, opaque,
        }
    }
}

/// Every record that the parts make, one after another.
fn play(parts: &Parts, mut take: impl FnMut(&Record<'_>)) {
    let mut machine = Machine::default();
    for (name, enabled) in parts.axes.iter().zip(&parts.enabled) {
        let mut axis = frictcomp::machine::Axis::new(name);
        if *enabled {
            axis.enable();
        }
        machine.axes.push(axis);
    }
    let compensation = machine.compensation();
    let state = StateView {
        machine: &machine,
        compensation: &compensation,
        possible: &[],
        listed: &parts.listed,
        version: 1,
    };
    let (program, seq, line) = parts.numbers;
    let [file, text, remark] = &parts.texts;
    take(&Record::Session {
        state,
        remark: parts.name.as_ref().map(|_| remark.as_str()),
    });
    for diagnostic in &parts.diagnostics {
        take(&Record::Machine(diagnostic));
    }
    take(&Record::Program {
        program,
        file,
        name: parts.name.as_deref(),
        state,
    });
    let modal = frictcomp::timeline::Modal::new(AXES);
    take(&Record::Block(Row {
        program,
        seq,
        file,
        line,
        number: parts.number,
        level: parts.level,
        text,
        changes: &parts.changes,
        state,
        modal: &modal,
        motion: None,
        branch: None,
        diagnostics: &parts.diagnostics,
    }));
    take(&Record::Join(Join {
        program,
        seq,
        file,
        line,
        state,
    }));
    let note = |diagnostic: &Diagnostic| EndNote {
        seq,
        diagnostic: diagnostic.clone(),
    };
    let notes: Vec<EndNote> = parts.diagnostics.iter().map(note).collect();
    take(&Record::End(End {
        program,
        seq,
        by: parts.by,
        notes: &notes,
        repeated: &parts.repeated,
        changes: &parts.changes,
        state,
    }));
    take(&Record::Summary(&Summary {
        programs: program,
        blocks: seq,
        counts: BTreeMap::from([(Severity::Error, seq), (Severity::Info, 3)]),
        opaque: &parts.opaque,
        axes: Vec::new(),
        footing: frictcomp::timeline::Footing::Known,
        rests_on: frictcomp::readings::QuestionSet::default(),
        state,
    }));
}

/// A line as serde writes it; what cannot be seen is escaped (R9.76).
fn line(object: &impl serde::Serialize) -> String {
    let mut line = String::new();
    for letter in serde_json::to_string(object).expect("an object").chars() {
        if is_hidden(letter) {
            for unit in letter.encode_utf16(&mut [0; 2]) {
                let _ = write!(line, "\\u{unit:04x}");
            }
        } else {
            line.push(letter);
        }
    }
    line.push('\n');
    line
}

/// The lines of a record: what is said about a block comes after it, what is said at an end before.
fn lines(record: &Record<'_>) -> String {
    let said: String = record.diagnostics().map(|said| line(&said)).collect();
    match record {
        Record::End(_) => said + &line(record),
        _ => line(record) + &said,
    }
}

proptest! {
    #[test]
    fn json_lines_are_what_serde_writes(parts in parts()) {
        // R9.10, R9.12
        let mut bytes = Vec::new();
        let mut expected = String::new();
        written(&mut bytes, |bytes| Ndjson::new(bytes, View::default()), |sink| {
            play(&parts, |record| {
                let _ = sink.record(record);
                expected.push_str(&lines(record));
            });
        });
        prop_assert_eq!(String::from_utf8(bytes).expect("text"), expected);
    }

    #[test]
    fn the_document_holds_what_serde_writes(parts in parts()) {
        // R9.10, R9.12
        let mut bytes = Vec::new();
        let mut expected = Vec::new();
        written(&mut bytes, |bytes| Json::new(bytes, View::default()), |sink| {
            play(&parts, |record| {
                let _ = sink.record(record);
                expected.extend(lines(record).lines().map(value));
            });
        });
        let document: Value = serde_json::from_slice(&bytes).expect("a document");
        prop_assert_eq!(&document["records"], &Value::Array(expected));
    }

    #[test]
    fn other_kinds_add_their_states_and_changes(parts in parts(), kinds in kinds()) {
        // R9.12
        let mut bytes = Vec::new();
        let mut expected = Vec::new();
        written(&mut bytes, |bytes| Ndjson::new(bytes, View::default().with_kinds(kinds)), |sink| {
            play(&parts, |record| {
                let _ = sink.record(record);
                let of_record = |value: &Value| value["record"] != "diagnostic";
                expected.extend(lines(record).lines().map(|line| {
                    let mut value = value(line);
                    if of_record(&value) {
                        show_kinds(&mut value, record, kinds);
                    }
                    value
                }));
            });
        });
        let text = String::from_utf8(bytes).expect("text");
        let found: Vec<Value> = text.lines().map(value).collect();
        prop_assert_eq!(found, expected);
    }
}

fn value(line: &str) -> Value {
    serde_json::from_str(line).expect("an object")
}

/// Sets of kinds that are not friction compensation alone, whose records are the plain ones.
fn kinds() -> impl Strategy<Value = KindSet> {
    let some = prop::collection::vec(prop::sample::select(Kind::ALL.to_vec()), 0..8);
    some.prop_map(|kinds| kinds.into_iter().collect())
        .prop_filter("not friction alone", |kinds| {
            *kinds != KindSet::of(Kind::Frict)
        })
}

/// What a record shows where other kinds are asked for.
fn show_kinds(value: &mut Value, record: &Record<'_>, kinds: KindSet) {
    let (changes, state) = match record {
        Record::Session { state, .. } | Record::Program { state, .. } => (None, *state),
        Record::Block(row) => (Some(row.changes), row.state),
        Record::Join(join) => (None, join.state),
        Record::End(end) => (Some(end.changes), end.state),
        Record::Summary(summary) => (None, summary.state),
        Record::Machine(_) => return,
    };
    let of_axis = |axis| -> serde_json::Map<String, Value> {
        let states = kinds.iter();
        let states = states.map(|kind| (kind.to_string(), state.state(axis, kind).as_str().into()));
        states.collect()
    };
    let axes = state.axes();
    let axes: serde_json::Map<String, Value> = axes
        .map(|(axis, name)| (name.to_owned(), of_axis(axis).into()))
        .collect();
    value["compensation"] = axes.into();
    let Some(changes) = changes else { return };
    let shown = changes.iter().filter(|change| kinds.contains(change.kind));
    let shown: Vec<Value> = shown
        .map(|change| {
            serde_json::json!({
                "axis": state.name(change.axis),
                "kind": change.kind.as_str(),
                "from": change.from.as_str(),
                "to": change.to.as_str(),
            })
        })
        .collect();
    let object = value.as_object_mut().expect("a record");
    if shown.is_empty() && matches!(record, Record::End(_)) {
        object.remove("changes");
    } else {
        object.insert("changes".to_owned(), shown.into());
    }
}
