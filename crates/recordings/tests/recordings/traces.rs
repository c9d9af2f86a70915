//! Recorded traces: every layout that the rules name is read, and anything else is reported.

use std::fmt::Write as _;

use frictcomp_recordings::trace::{
    ChannelQuantity, ChannelSelection, Choice, CncObject, NotAligned, Pick, SelectError,
    TraceProblem, TraceReader, TraceRecording, Unit,
};
use frictcomp_testing::layouts::{
    Comments, Export, Filled, Header, Letters, Signal, Task, Times, sinumerik,
};
use proptest::prelude::*;

/// Reads bytes that come in pieces of some length.
fn read_pieces(bytes: &[u8], piece: usize) -> Result<TraceRecording, TraceProblem> {
    let selection = ChannelSelection::default();
    let mut reader = TraceReader::new(1_000_000, |channels| {
        let time = selection.find(ChannelQuantity::Time, channels)?;
        Ok(Choice::all(channels, time))
    });
    for piece in bytes.chunks(piece.max(1)) {
        reader.feed(piece)?;
    }
    reader.finish()
}

fn read(text: &str) -> Result<TraceRecording, TraceProblem> {
    read_pieces(text.as_bytes(), 7)
}

/// Returns the channel of a name, taken as a torque.
fn torque(recording: &TraceRecording, name: &str) -> Pick {
    let (selection, channels) = (ChannelSelection::default(), recording.channels());
    let picked = selection.pick_named(name, ChannelQuantity::Torque, channels);
    picked.expect("a channel")
}

fn problem(text: &str) -> TraceProblem {
    read(text).expect_err("a problem")
}

/// Returns the samples of a channel by its name.
fn values<'a>(recording: &'a TraceRecording, name: &str) -> &'a [f64] {
    let found = recording
        .kept()
        .find(|it| recording.channels()[it.get()].name == name);
    recording.values(found.unwrap_or_else(|| panic!("no channel `{name}`")))
}

fn words() -> impl Strategy<Value = String> {
    prop_oneof![
        "[A-Z][a-z]{2,6}",
        Just("Name".to_owned()),
        Just("test space".to_owned()),
        Just("äöü!?ß²".to_owned()),
        Just("15\" screw".to_owned()),
    ]
}

fn comments() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        Just("actual torque".to_owned()),
        Just("(* first\n\n  5 is the second line\n12.5 the third *)".to_owned()),
    ]
}

fn signal() -> impl Strategy<Value = Signal> {
    let samples = prop::collection::vec(-1_000_000_i32..1_000_000, 10..40);
    let unit = prop::sample::select(vec!["", "mm/s", "A", "%"]);
    (words(), comments(), unit, 0_u32..6, samples).prop_map(
        |(name, comment, unit, axis, samples)| Signal {
            name,
            comment,
            unit: unit.to_owned(),
            axis,
            samples: samples.iter().map(|it| f64::from(*it) / 64.0).collect(),
        },
    )
}

fn task() -> impl Strategy<Value = Task> {
    let step = prop::sample::select(vec![0.25, 0.5, 1.0, 2.0, 4.0]);
    (step, prop::collection::vec(signal(), 1..4))
        .prop_map(|(step_ms, signals)| Task { step_ms, signals })
}

fn export() -> impl Strategy<Value = Export> {
    let look = (
        prop::sample::select(vec!['\t', ';', ',']),
        prop::sample::select(vec!['.', ',']),
        prop::sample::select(vec![
            Header::Full,
            Header::Full,
            Header::Names,
            Header::Symbols,
            Header::WithoutFile,
        ]),
        prop::sample::select(vec![Times::Milliseconds, Times::FileTime, Times::None]),
        prop::sample::select(vec![
            Filled::Blank,
            Filled::Short,
            Filled::Repeated,
            Filled::Shifted,
        ]),
        prop::sample::select(vec![Comments::Quoted, Comments::Bare]),
    );
    let bytes = (
        prop::sample::select(vec![
            Letters::Utf8,
            Letters::Marked,
            Letters::Latin,
            Letters::Little,
            Letters::Big,
        ]),
        prop::sample::select(vec!["\n", "\r\n"]),
        any::<bool>(),
        any::<bool>(),
    );
    (prop::collection::vec(task(), 1..4), look, bytes).prop_map(|(tasks, look, bytes)| {
        let (separator, decimal, header, times, filled, comments) = look;
        let (letters, end, has_eof, ends_in_separator) = bytes;
        let mut export = Export {
            tasks,
            separator,
            decimal: if separator == ',' { '.' } else { decimal },
            header,
            times,
            // Without times the repeated rows cannot be recognised.
            filled: match (times, filled) {
                (Times::None, Filled::Repeated | Filled::Shifted) => Filled::Blank,
                _ => filled,
            },
            comments,
            letters,
            end,
            has_eof,
            ends_in_separator,
        };
        number_the_names(&mut export);
        export
    })
}

/// Numbers channels of one name as Scope does; the first channel of a file gets a unique name here, so that `Name` next
/// to `Name` is not ambiguous if nothing else is above the numbers.
fn number_the_names(export: &mut Export) {
    let signals = export.tasks.iter_mut().flat_map(|task| &mut task.signals);
    for (number, signal) in signals.enumerate() {
        if number > 0 || signal.name == "Name" && export.header == Header::Names {
            signal.name = format!("{} ({number})", signal.name);
        }
    }
}

/// Returns the words of a comment, wherever its lines end.
fn words_of(comment: &str) -> Vec<&str> {
    comment.split_whitespace().collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_layout_of_scope_is_read(export in export(), piece in 1_usize..3000) {
        // R6.1 R6.2
        let recording = read_pieces(&export.bytes(), piece)
            .map_err(|error| TestCaseError::fail(format!("{error}: {}", String::from_utf8_lossy(&export.bytes()))))?;
        prop_assert_eq!(recording.layout().as_str(), "TwinCAT Scope CSV");
        let signals: Vec<(&Task, &Signal)> = export
            .tasks
            .iter()
            .flat_map(|task| task.signals.iter().map(move |signal| (task, signal)))
            .collect();
        prop_assert_eq!(recording.channels().len(), signals.len());
        for (index, (task, signal)) in recording.kept().zip(signals) {
            let channel = &recording.channels()[index.get()];
            let is_full = matches!(export.header, Header::Full | Header::WithoutFile);
            if export.header == Header::Symbols {
                prop_assert_eq!(&channel.symbol, &format!("Axes.{}", signal.name.replace(' ', "_")));
            } else {
                prop_assert_eq!(&channel.name, &signal.name);
            }
            // Raw values: they do not contain the offset and the factor of the drawing.
            prop_assert_eq!(recording.values(index), &signal.samples[..]);
            if is_full {
                prop_assert_eq!(channel.object.map(CncObject::axis), Some(signal.axis));
                prop_assert_eq!(words_of(&channel.comment), words_of(&signal.comment));
                prop_assert_eq!(channel.unit.is_some(), !signal.unit.is_empty());
                prop_assert!(channel.is_drawn_scaled);
            }
            if is_full || export.times != Times::None {
                let times = recording.times_s(index).expect("times");
                prop_assert_eq!(times.len(), signal.samples.len());
                for (at, time) in times.iter().enumerate() {
                    let wanted = task.step_ms * at as f64 / 1000.0;
                    prop_assert!((time - wanted).abs() < 1e-9, "{} is not {}", time, wanted);
                }
            }
        }
    }

    #[test]
    fn numbers_without_a_header_are_read(task in task(), other in task(), piece in 1_usize..500) {
        // R6.2: the columns of times are found by how they count.
        let export = Export {
            tasks: vec![task, other],
            separator: ';',
            decimal: ',',
            header: Header::None,
            times: Times::Milliseconds,
            filled: Filled::Blank,
            comments: Comments::Bare,
            letters: Letters::Utf8,
            end: "\n",
            has_eof: true,
            ends_in_separator: false,
        };
        let recording = read_pieces(&export.bytes(), piece).expect("a recording");
        prop_assert_eq!(recording.layout().as_str(), "CSV without a header");
        let signals: Vec<&Signal> = export.tasks.iter().flat_map(|it| &it.signals).collect();
        prop_assert_eq!(recording.channels().len(), signals.len());
        for (index, signal) in recording.kept().zip(signals) {
            prop_assert_eq!(recording.values(index), &signal.samples[..]);
        }
    }

    #[test]
    fn traces_of_sinumerik_are_read(task in task(), apart in any::<bool>(), piece in 1_usize..500) {
        // R6.1: a signal that ends before others keeps its last value (R6.24).
        let text = sinumerik(&task, apart);
        let rows = task.signals.iter().map(|it| it.samples.len()).max().unwrap_or(0);
        let recording = read_pieces(text.as_bytes(), piece)
            .map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(recording.layout().as_str(), "SINUMERIK trace XML");
        for (index, signal) in recording.kept().zip(&task.signals) {
            prop_assert_eq!(&recording.channels()[index.get()].name, &signal.name);
            let mut samples = signal.samples.clone();
            let last = *samples.last().expect("a sample");
            samples.resize(rows, last);
            prop_assert_eq!(recording.values(index), &samples[..]);
            let times = recording.times_s(index).expect("times");
            prop_assert_eq!(times.len(), rows);
        }
    }

    #[test]
    fn a_trace_of_changes_is_the_whole_one(
        rows in prop::collection::vec([0_i32..3, 0_i32..3, 0_i32..3], 2..60),
        interval_us in prop::sample::select(vec![250_u32, 1000, 2000, 4000, 1333]),
        begin in 0_u32..50,
        piece in 1_usize..500,
    ) {
        // R6.24: to the last digit, times included.
        let whole = Changes { rows: &rows, interval_us, begin, form: Form::Whole }.text();
        let changes = Changes { rows: &rows, interval_us, begin, form: Form::Changes }.text();
        let read = |text: &str| read_pieces(text.as_bytes(), piece)
            .map_err(|error| TestCaseError::fail(error.to_string()));
        let (whole, changes) = (read(&whole)?, read(&changes)?);
        prop_assert!(whole.remarks().is_empty(), "{:?}", whole.remarks());
        for (at, index) in whole.kept().enumerate() {
            prop_assert_eq!(whole.values(index), changes.values(index));
            prop_assert_eq!(whole.times_s(index), changes.times_s(index));
            prop_assert_eq!(whole.clock(index), changes.clock(index));
            let unit = whole.channels()[index.get()].unit.as_deref();
            prop_assert_eq!(unit, Some(["%", "mm/min", "mm"][at]));
            prop_assert_eq!(changes.channels()[index.get()].unit.as_deref(), unit);
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..3000), piece in 1_usize..100) {
        // R6.1
        let _ = read_pieces(&bytes, piece);
    }

    #[test]
    fn any_text_of_tables_is_read_or_refused(
        lines in prop::collection::vec("(Name|SymbolComment|Unit|EOF|t|x|\"|<|rec|[0-9.,;\t \"e-]){0,12}", 0..40),
        piece in 1_usize..100,
    ) {
        // R6.1 R6.2
        let text = lines.join("\n");
        if let Ok(recording) = read_pieces(text.as_bytes(), piece) {
            for index in recording.kept() {
                let times = recording.times_s(index).map_or(usize::MAX, <[f64]>::len);
                prop_assert!(times >= recording.values(index).len());
            }
        }
    }
}

/// Values that a SINUMERIK trace writes.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Whole,
    /// Only changed values; records in which nothing changed are left out.
    Changes,
}

/// Three signals of a SINUMERIK trace.
struct Changes<'a> {
    rows: &'a [[i32; 3]],
    interval_us: u32,
    begin: u32,
    form: Form,
}

impl Changes<'_> {
    fn text(&self) -> String {
        let seconds = |steps: u32| f64::from(steps * self.interval_us) / 1e6;
        let mut text = format!(
            "<traceSession><traceData><dataFrame><frameHeader startTime=\"0\" interval=\"{}\" datapointCount=\"{}\"/>\n",
            seconds(1),
            self.rows.len()
        );
        // The ids count, not the order.
        for (id, name, unit) in [(2, "torque", "%"), (1, "v", "mm/min"), (3, "x", "mm")] {
            let _ = writeln!(
                text,
                "<dataSignal id=\"f{id}\" name=\"/Nck/{name}\" description=\"{name}\" unitsType=\"{unit}\"/>"
            );
        }
        let mut before = None;
        for (step, row) in (self.begin..).zip(self.rows) {
            let is_written = |at: usize| {
                self.form == Form::Whole || before.is_none_or(|old: [i32; 3]| old[at] != row[at])
            };
            let values = (0..3).filter(|at| is_written(*at));
            let values: Vec<String> = values
                .map(|at| format!(" f{}=\"{}\"", at + 1, row[at]))
                .collect();
            if !values.is_empty() {
                let _ = writeln!(text, "<rec time=\"{}\"{}/>", seconds(step), values.concat());
            }
            before = Some(*row);
        }
        text + "</dataFrame></traceData></traceSession>\n"
    }
}

#[test]
fn signals_that_hold_only_changes_are_named() {
    // R6.24
    let rows = [[1, 5, 0], [2, 5, 0], [3, 5, 0], [4, 6, 0], [4, 6, 0]];
    let trace = Changes {
        rows: &rows,
        interval_us: 2000,
        begin: 0,
        form: Form::Changes,
    };
    let recording = read(&trace.text()).expect("a recording");
    assert_eq!(values(&recording, "x"), [0.0; 5]);
    assert_eq!(values(&recording, "torque"), [5.0, 5.0, 5.0, 6.0, 6.0]);
    let remarks = recording.remarks().join("\n");
    assert!(remarks.contains("`x` 1 times"), "{remarks}");
    assert!(remarks.contains("`torque` 2 times"), "{remarks}");
    let more = trace
        .text()
        .replace("datapointCount=\"5\"", "datapointCount=\"3\"");
    let recording = read(&more).expect("a recording");
    let remarks = recording.remarks().join("\n");
    assert!(
        remarks.contains("states 3 samples, but there are 4"),
        "{remarks}"
    );
}

#[test]
fn numbers_without_a_header_need_a_column_that_counts() {
    // R6.27
    let wave = |row: u32| (f64::from(row) / 5.0).sin();
    let table = |first: &dyn Fn(u32) -> f64| -> String {
        let rows = (0..40).map(|row| format!("{};{}\n", first(row), wave(row)));
        rows.collect::<Vec<_>>().concat()
    };
    let recording = read(&table(&|row| f64::from(row))).expect("a recording");
    let kept: Vec<_> = recording.kept().collect();
    assert_eq!(kept.len(), 1);
    assert!(recording.times_s(kept[0]).is_some());
    for first in [&wave as &dyn Fn(u32) -> f64, &|row: u32| {
        wave(row + 7) * 3.0
    }] {
        let recording = read(&table(first)).expect("a recording");
        let kept: Vec<_> = recording.kept().collect();
        assert_eq!(kept.len(), 2);
        assert_eq!(recording.times_s(kept[0]), None);
        let picks = ["column 1", "column 2"].map(|name| torque(&recording, name));
        let error = recording.align(&picks, None).expect_err("no times");
        assert_eq!(error, NotAligned::NoTimes { guess: None });
    }
}

#[test]
fn a_separator_within_a_name_is_named() {
    // R6.27
    let error = problem("t;v;actual;torque\n0;1;2\n1;2;3\n");
    let help = error.help().unwrap_or_default();
    assert!(
        help.contains("contains the separator, such as `;`"),
        "{error}: {help}"
    );
    let error = problem("t;v;torque\n0;1;2\n1;2\n");
    let help = error.help().unwrap_or_default();
    assert!(help.contains("contains the separator"), "{help}");
}

#[test]
fn groups_of_unequal_span_share_a_part_or_are_named() {
    // R6.27: two groups of Scope, with their own times in ms.
    let export = |from: i32| {
        let rows = (0..40).map(|row| format!("{row}\t1\t{}\t2\n", row + from));
        let rows = rows.collect::<Vec<_>>().concat();
        format!("Name\tv\tName\ttorque\n\n{rows}")
    };
    let align = |text: &str| {
        let recording = read(text).expect("a recording");
        let picks = ["v", "torque"].map(|name| torque(&recording, name));
        recording.align(&picks, None)
    };
    let same = align(&export(0)).expect("aligned");
    let remarks = same.remarks.join("\n");
    assert!(!remarks.contains("different times"), "{remarks}");
    let part = align(&export(10)).expect("aligned");
    let remarks = part.remarks.join("\n");
    assert!(
        remarks.contains("`v` (0 to 0.039 s), `torque` (0.01 to 0.049 s); the 0.029 s"),
        "{remarks}"
    );
    assert_eq!(part.times_s.len(), 30);
    let error = align(&export(100)).expect_err("apart").to_string();
    assert!(
        error.contains("`torque` (0.1 to 0.139 s) and of `v` (0 to 0.039 s)"),
        "{error}"
    );
}

#[test]
fn plain_tables_are_read_with_any_separator() {
    // R6.1
    for (separator, decimal) in [
        ("\t", ","),
        ("\t", "."),
        (";", ","),
        (";", "."),
        (",", "."),
        ("   ", ","),
        (" ", "."),
    ] {
        let text = format!(
            "t{separator}v{separator}torque\n0{separator}1.5{separator}-2.25\n0.001{separator}1{separator}3\n"
        );
        let text = match decimal {
            "," => text.replace('.', ","),
            _ => text,
        };
        let recording = read(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(values(&recording, "v"), [1.5, 1.0], "{text}");
        assert_eq!(values(&recording, "torque"), [-2.25, 3.0], "{text}");
        let v = recording.kept().nth(1).expect("v");
        assert_eq!(recording.times_s(v), Some(&[0.0, 0.001][..]), "{text}");
    }
}

#[test]
fn a_decimal_comma_between_commas_is_refused() {
    // R6.1
    for text in [
        "t,v\n0,000,1,5\n",
        "t,v\n0,1\n0,001,1,5\n",
        "Name,Velocity\n\n0,1\n0,5,1,25\n",
    ] {
        let error = problem(text);
        assert!(
            matches!(error, TraceProblem::DecimalComma { .. }),
            "{text}: {error}"
        );
        assert!(error.help().is_some_and(|help| help.contains("tab or `;`")));
    }
    assert!(matches!(
        problem("t;v\n0,5;1\n1.5;2\n"),
        TraceProblem::MixedDecimals { line: 3, .. }
    ));
    // The row of sample times may be written with the comma of the system.
    let text = "Name,A,Name,B\nSampleTime[ms],0,2,SampleTime[ms],1\n\n0,1,0,2\n0.2,1,1,2\n";
    let recording = read(text).expect("a recording");
    let announced: Vec<_> = recording
        .channels()
        .iter()
        .map(|it| it.sample_time_s)
        .collect();
    assert_eq!(announced, [Some(0.2e-3), Some(1e-3)]);
}

#[test]
fn blanks_between_cells_need_names_without_blanks_or_single_channels() {
    // R6.2
    let text = "Name test space Name other\nSymbolComment  SymbolComment \n\n0 1 0 2\n1 3 1 4\n";
    let recording = read(text).expect("a recording");
    assert_eq!(values(&recording, "test space"), [1.0, 3.0]);
    assert_eq!(values(&recording, "other"), [2.0, 4.0]);
    let text = "Name test space other\n\n0 1 2\n1 3 4\n";
    assert_eq!(problem(text), TraceProblem::Divided);
    // Rows without blanks in their cells show the number of channels, and name them.
    let text = "Name Axis 1 Velo Axis 1 Torque\nData-Type INT32 INT16\n\
                SymbolName Axes.Velo Axes.Torque\n\n0 1 2\n1 3 4\n";
    let recording = read(text).expect("a recording");
    assert_eq!(values(&recording, "Axes.Velo"), [1.0, 3.0]);
    assert_eq!(values(&recording, "Axes.Torque"), [2.0, 4.0]);
}

#[test]
fn aligned_columns_may_have_names_with_blanks() {
    // R6.2
    let text = "Name   Axis 1 Velo   Axis 1 Torque\nUnit   mm/s          %\n\n   0   1.5  -12\n   1  -3.5 -140\n";
    let recording = read(text).expect("a recording");
    assert_eq!(values(&recording, "Axis 1 Velo"), [1.5, -3.5]);
    assert_eq!(values(&recording, "Axis 1 Torque"), [-12.0, -140.0]);
    assert_eq!(torque(&recording, "Axis 1 Torque").unit.factor, 10.0);
}

#[test]
fn a_table_may_have_units_below_its_names_and_remarks_above() {
    // R6.1
    let text = "# recorded on Monday\n# 1000 Hz\nt;v;torque\ns;mm/s;%\n0;1;2\n";
    let recording = read(text).expect("a recording");
    let units: Vec<_> = recording
        .channels()
        .iter()
        .map(|it| it.unit.as_deref())
        .collect();
    assert_eq!(units, [Some("s"), Some("mm/s"), Some("%")]);
    assert_eq!(values(&recording, "v"), [1.0]);
}

#[test]
fn hostile_files_are_refused_with_what_is_wrong() {
    // R6.1
    assert_eq!(problem(""), TraceProblem::NoRows);
    assert_eq!(problem("\n\n\n"), TraceProblem::NoRows);
    assert_eq!(
        problem("just a text\nwithout numbers"),
        TraceProblem::NoRows
    );
    assert_eq!(problem("PK\u{3}\u{4}\u{0}\u{0}\u{0}"), TraceProblem::Binary);
    assert_eq!(problem("t;x\n\u{0};1\n"), TraceProblem::Binary);
    assert!(matches!(
        problem("x;y\n1;2\n3\n"),
        TraceProblem::Row {
            line: 3,
            cells: 1,
            columns: 2
        }
    ));
    assert!(matches!(
        problem("x;y\n1;2\n3;4;5\n"),
        TraceProblem::Row {
            line: 3,
            cells: 3,
            columns: 2
        }
    ));
    assert!(matches!(
        problem("x;y\n\n1;2\n\n3;u\n"),
        TraceProblem::Number { line: 5, .. }
    ));
    assert!(matches!(
        problem("x;y\n1;1e999\n"),
        TraceProblem::Number { .. }
    ));
    let names: Vec<String> = (0..30_000).map(|it| format!("c{it};")).collect();
    let wide = names.concat();
    let row = "1;".repeat(30_000);
    assert!(matches!(
        problem(&format!("{wide}\n{row}\n")),
        TraceProblem::Long { .. }
    ));
    let endless = "x".repeat(20 << 20);
    assert!(read_pieces(endless.as_bytes(), 1 << 16).is_err());
    let header = "a;b\n".repeat(6 << 20);
    assert!(read_pieces(header.as_bytes(), 1 << 16).is_err());
    let quote = format!("Name\tA\nSymbolComment\t\"{}", "open\n".repeat(100_000));
    assert!(read_pieces(quote.as_bytes(), 1 << 16).is_err());
}

#[test]
fn entities_of_xml_are_refused() {
    // R6.1
    let bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE a [<!ENTITY b \"bbbb\">]>\n<a>&b;</a>";
    assert_eq!(problem(bomb), TraceProblem::Entities { line: 2 });
    let unknown =
        "<a><dataFrame><dataSignal name=\"&b;\"/><rec time=\"0\" f1=\"1\"/></dataFrame></a>";
    assert!(matches!(
        problem(unknown),
        TraceProblem::Xml { line: 1, .. }
    ));
    assert_eq!(
        problem("<html><body>no trace</body></html>"),
        TraceProblem::NoRows
    );
    assert!(matches!(
        problem("<a><rec time=\"0\" f1=\"1\"/><rec time="),
        TraceProblem::Xml { .. }
    ));
    assert!(matches!(
        problem("<a>\n<rec f1=\"1\"/></a>"),
        TraceProblem::Xml { line: 2, .. }
    ));
    let far = "<a><rec time=\"0\" f4000000000=\"1\"/></a>";
    assert!(matches!(problem(far), TraceProblem::Xml { .. }));
}

#[test]
fn what_is_no_number_is_missing_and_counted() {
    // R6.2
    let text = "Name\tA\tB\n\n0\t1\t2\n1\tNaN\t\n2\t3\t4\n3\t5\n";
    let recording = read(text).expect("a recording");
    let [a, b] = [0, 1].map(|at| recording.kept().nth(at).expect("a channel"));
    assert_eq!(recording.missing(a).count, 1);
    assert_eq!(
        (recording.missing(b).count, recording.missing(b).line),
        (1, 4)
    );
    assert_eq!(recording.values(b).len(), 3);
    let aligned = recording
        .align(&["A", "B"].map(|name| torque(&recording, name)), None)
        .expect("one clock");
    assert_eq!(aligned.columns[1], [2.0, 4.0]);
    assert!(
        aligned.remarks[0].contains("1 samples of `A` are not numbers"),
        "{:?}",
        aligned.remarks
    );
}

#[test]
fn channels_of_different_rates_are_brought_to_one() {
    // R6.2
    let text = "Name\tFast\tName\tSlow\n\n0\t0\t0\t0\n1\t10\t4\t8\n2\t20\t8\t16\n3\t30\n4\t40\n5\t50\n6\t60\n";
    let recording = read(text).expect("a recording");
    let aligned = recording
        .align(&["Slow", "Fast"].map(|name| torque(&recording, name)), None)
        .expect("one clock");
    assert_eq!(aligned.columns[0], [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0]);
    assert_eq!(aligned.columns[1][6], 60.0);
    assert_eq!(
        aligned.remarks,
        ["`Slow`, sampled every 4 ms, is brought to the 1 ms of `Fast` by interpolation"]
    );
}

#[test]
fn a_channel_that_is_not_there_is_said_with_what_there_is() {
    // R6.3
    let selection = ChannelSelection {
        torque: Some("ActTorqe".to_owned()),
        ..ChannelSelection::default()
    };
    let mut reader = TraceReader::new(100, |channels| {
        selection.require(ChannelQuantity::Torque, channels)?;
        Ok(Choice::default())
    });
    reader
        .feed(b"t;ActTorque;SetVelo\n0;1;2\n")
        .expect("few bytes");
    let error = reader.finish().expect_err("no such channel");
    let TraceProblem::Select(SelectError::None { .. }) = error else {
        panic!("{error}")
    };
    assert_eq!(
        error.help().as_deref(),
        Some("did you mean `ActTorque`? the channels are t, ActTorque, SetVelo")
    );
    assert!(Unit::parse("furlong").is_none());
}
