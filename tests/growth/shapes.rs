//! Time and memory grow no faster than the length of a program (R2.60, R2.85), shape by shape.
//!
//! A test cannot rely on time, so the tests compare counts that are the same in every run: units of
//! work, bytes allocated, and bytes held at a time, for a program and for one that is twice as
//! long.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use frictcomp::interpreter::{Limits, Options, StopPolicy};
use frictcomp::machine::{Machine, NoLists, check_list};
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};
use frictcomp_host::{Disk, read_axis};
use frictcomp_recordings::identify::{IdentifyOptions, identify};
use frictcomp_recordings::trace::ChannelSelection;

/// The factor that a program of twice the length may need: the exponent 1.2.
const TWICE: f64 = 2.3;

/// Work and bytes that a run may need however short its program is.
const ANYWAY: [u64; 2] = [2_000, 50_000];

/// Returns the lines of a program, one for each number.
fn each(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).fold(String::new(), |mut text, number| {
        let _ = writeln!(text, "{}", line(number));
        text
    })
}

/// Returns a list of values.
fn values(count: usize, separator: &str) -> String {
    let values: Vec<String> = (0..count).map(|value| value.to_string()).collect();
    values.join(separator)
}

/// Returns subprograms and calls of some of them.
fn subprograms(count: usize, calls: &str) -> String {
    let programs = each(count, |n| format!("%L S{n}\nX{n}\nM17"));
    format!("{programs}%MAIN\n{calls}M30\n")
}

type Shape = (&'static str, fn(usize) -> String, usize);

/// Program shapes, and the count that a test needs to see how they grow.
#[rustfmt::skip]
const SHAPES: &[Shape] = &[
    ("plain blocks", |n| each(n, |n| format!("N{n} G01 X{n} Y1 F500")), 1000),
    ("jump labels", |n| each(n, |n| format!("N{n}: X1")), 500),
    ("labels given twice", |n| each(n, |_| "N1: X1".to_owned()), 250),
    ("jumps", |n| each(n, |n| format!("N{n}: X1\n$GOTO N{}", n + 1)), 250),
    ("jumps to missing labels", |n| each(n, |n| format!("$IF 0 $GOTO N{n}")), 250),
    ("macros", |n| each(n, |n| format!("\"A{n}\" = \"X{n}\"\n\"A{n}\"")), 250),
    ("macros in an expression", |n| format!("\"A\"=\"1+1\"\n{}", each(n, |_| "P1=\"A\"*\"A\"".to_owned())), 250),
    ("a macro that is defined again", |n| format!("$FOR P1=1,{n},1\n\"A\"=\"X1\"\n\"A\"\n$IF V.E.X\n\"A\"\n$ENDIF\n$ENDFOR"), 250),
    ("local subprograms", |n| subprograms(n, ""), 250),
    ("calls of distinct local subprograms", |n| subprograms(n, &each(n, |n| format!("LL S{n}"))), 250),
    ("calls of missing local subprograms", |n| subprograms(n, &each(n, |n| format!("LL T{n}"))), 500),
    ("calls of missing programs", |n| each(n, |n| format!("L t{n}.nc")), 250),
    ("calls in an unknown region", |n| subprograms(n, &format!("$IF V.E.X\n{}$ENDIF\n", each(n, |n| format!("LL S{n}")))), 250),
    ("missing programs in an unknown region", |n| format!("$IF V.E.X\n{}$ENDIF", each(n, |n| format!("L t{n}.nc"))), 250),
    ("a long unknown region in a loop", |n| format!("$FOR P1=1,9,1\n$IF V.E.X\n{}$ENDIF\n$ENDFOR", each(n, |n| format!("P{}=1 X{n}", n + 9))), 150),
    ("an unknown region in a long loop", |n| format!("$FOR P1=1,{n},1\n$IF V.E.X\nP[P1]=1 X1\n$ENDIF\n$ENDFOR"), 150),
    ("many unknown regions", |n| each(n, |n| format!("$IF V.E.X\nP{n}=1\n$ENDIF")), 250),
    ("many unknown regions that write variables", |n| each(n, |n| format!("$IF V.E.X\nV.P.A{n}=1\n$ENDIF")), 250),
    ("many unknown regions that write elements", |n| each(n, |n| format!("$IF V.E.X\nV.P.A[{n}]=1\n$ENDIF")), 250),
    ("many unknown regions that define macros", |n| each(n, |n| format!("$IF V.E.X\n\"A{n}\"=\"X1\"\n$ENDIF")), 250),
    ("many unknown regions that couple axes", |n| each(n, |n| format!("$IF V.E.X\n#SET AX LINK [{n}, Y=X]\n$ENDIF")), 250),
    ("many unknown regions that call", |n| subprograms(n, &each(n, |n| format!("$IF V.E.A{n}\nLL S{n}\n$ENDIF"))), 250),
    ("many plain conditions", |n| each(n, |n| format!("P{n}=V.E.A\n$IF P{n}==1\nX[COMP OFF FRICT]\n$ENDIF")), 250),
    ("many skipped blocks", |n| each(n, |n| format!("/{} X{n}\nX1", n % 9 + 1)), 250),
    ("nested unknown regions", |n| format!("{}{}", each(n.min(40), |n| format!("$IF V.E.A{n}\nX1")), each(n.min(40), |_| "$ENDIF".to_owned())), 10),
    ("allow comments", |n| each(n, |_| "X[COMP ON FRICT] ; frictcomp: allow FC402".to_owned()), 250),
    ("unused allow comments", |n| each(n, |_| "X1 ; frictcomp: allow FC402".to_owned()), 250),
    ("lints", |n| each(n, |_| "X[COMP ON FRICT]".to_owned()), 250),
    ("lints in a loop", |n| format!("$FOR P1=1,3,1\n{}$ENDFOR", each(n, |_| "X[COMP ON FRICT]".to_owned())), 250),
    ("one message in a long loop", |n| format!("$FOR P1=1,{n},1\nP2=P9\n$ENDFOR"), 500),
    ("couplings", |n| each(n, |n| format!("#SET AX LINK [{n}, Y=X]\n#ENABLE AX LINK [{n}]")), 250),
    ("couplings that are released", |n| format!("{}{}", each(n, |n| format!("#SET AX LINK [{n}, Y=X]\n#ENABLE AX LINK [{n}]")), each(n, |n| format!("#DISABLE AX LINK [{n}]"))), 250),
    ("variables", |n| each(n, |n| format!("V.P.A{n}=1")), 250),
    ("variables of a call level", |n| each(n, |n| format!("V.L.A{n}=1")), 250),
    ("variables that are deleted", |n| format!("{}{}", each(n, |n| format!("V.P.A{n}=1")), each(n, |n| format!("#DELETE V.P.A{n}"))), 250),
    ("elements that are deleted", |n| format!("{}{}", each(n, |n| format!("V.P.A[{n}]=1")), each(n, |n| format!("#DELETE V.P.A[{n}]"))), 250),
    ("array declarations", |n| each(n, |n| format!("#VAR\nV.P.A{n}[3]=[1,2,3]\n#ENDVAR")), 250),
    ("array declarations in one region", |n| format!("#VAR\n{}#ENDVAR", each(n, |n| format!("V.P.A{n}[3]=[1,2,3]"))), 250),
    ("an array of many values", |n| format!("#VAR\nV.P.A[{n}]=[{}]\n#ENDVAR", values(n, ",\\\n")), 500),
    ("elements of an array", |n| each(n, |n| format!("V.P.A[{n}]=1")), 250),
    ("unknown elements", |n| each(n, |n| format!("V.P.A[{n}]=1\nV.P.A[V.E.I]=1")), 250),
    ("unknown parameters", |n| each(n, |n| format!("P{n}=1\nP[V.E.I]=1")), 250),
    ("faults of a continued block", |n| format!("V.P.T[9] = [1,\\\n{}1]", "1,2,3,4,5,6,7,8,9,0,\\\n".repeat(n)), 10),
    ("a continued block", |n| format!("X1 \\\n{}Y1", "F1 \\\n".repeat(n)), 250),
    ("continued blocks", |n| "X[COMP \\\nON \\\nFRICT]\n".repeat(n), 250),
    ("long lines", |n| format!("{}\n", "X1 ".repeat(n)).repeat(5), 300),
    ("long lines with faults", |n| format!("{}\n", "?1 ".repeat(n)).repeat(5), 150),
    ("long expressions", |n| format!("P1=1{}\n", "+1".repeat(n)).repeat(5), 450),
    ("strings that grow", |n| format!("P1=\"\"\n$FOR P2=1,{n},1\nP1=P1+\"a\"\n$IF LEN[P1]>50\nP1=\"\"\n$ENDIF\n$ENDFOR"), 500),
    ("diagnostics", |n| each(n, |n| format!("P1=P{}", n + 9)), 500),
    ("diagnostics of blocks that are never executed", |n| format!("M30\n{}", each(n, |n| format!("X1 ?{n}"))), 500),
    ("words that are passed over", |n| each(n, |n| format!("#FOO{n}")), 500),
    ("ends without an opener", |n| "$ENDIF\n".repeat(n), 250),
    ("openers without an end", |n| "$IF 1\n".repeat(n), 250),
    ("nested control blocks", |n| format!("{}{}", "$IF 1\n".repeat(n), "$ENDIF\n".repeat(n)), 250),
    ("loops", |n| "$FOR P1=1,2,1\nX1\n$ENDFOR\n".repeat(n), 250),
    ("cases", |n| format!("P1={n}\n$SWITCH P1\n{}$ENDSWITCH", each(n, |n| format!("$CASE {n}\nX1\n$BREAK"))), 250),
    ("branches", |n| format!("P1=-1\n$IF P1==-2\n{}$ENDIF", each(n, |n| format!("$ELSEIF P1=={n}\nX1"))), 250),
    ("programs in a file", |n| each(n, |n| format!("%P{n}\nX1\nM30")), 250),
    ("comments", |n| "(a (b)) X1 ; c\n".repeat(n), 250),
    ("comment regions", |n| "#COMMENT BEGIN\nX1\n#COMMENT END\n".repeat(n), 250),
    ("values of the machine", |n| each(n, |n| format!("P1=V.E.A{n}")), 250),
    ("the language of other controls", |n| each(n, |n| format!("CYCLE81({n},1,,2) ; IF R{n} > 2 GOTOF X")), 250),
];

/// A program with the files that it calls, on a machine with a given number of axes.
struct Case {
    text: String,
    files: BTreeMap<String, String>,
    axes: usize,
}

impl Case {
    fn new(text: String) -> Self {
        Self {
            text,
            files: BTreeMap::new(),
            axes: 2,
        }
    }

    fn with_file(mut self, name: &str, text: String) -> Self {
        self.files.insert(name.to_owned(), text);
        self
    }

    fn on_axes(mut self, axes: usize) -> Self {
        self.axes = axes;
        self
    }

    /// Creates a program that calls the file `called.nc` this many times.
    fn calls(count: usize, called: String) -> Self {
        Self::new("L called.nc\n".repeat(count)).with_file("called.nc", called)
    }
}

type CaseShape = (&'static str, fn(usize) -> Case, usize);

/// Shapes of called files and machines.
#[rustfmt::skip]
const CASES: &[CaseShape] = &[
    ("calls of a file with faults", |n| Case::calls(n, "$ENDIF\n".repeat(n) + "M17"), 100),
    ("calls of a file whose blocks have faults", |n| Case::calls(n, "P1=P9\n".repeat(10)), 100),
    ("a called file whose blocks have faults", |n| Case::calls(10, "P1=P9\n".repeat(n)), 100),
    ("called files", |n| (0..n).fold(Case::new(each(n, |n| format!("L f{n}.nc"))), |case, n| case.with_file(&format!("f{n}.nc"), "X1\nM17".to_owned())), 250),
    ("axes", |n| Case::new("X0[COMP OFF FRICT]\n".repeat(9)).on_axes(n), 250),
];

type ListShape = (&'static str, fn(usize) -> String, usize);

/// Shapes of lists.
#[rustfmt::skip]
const LISTS: &[ListShape] = &[
    ("entries of an axis list", |n| each(n, |n| format!("kenngr.a{n} {n}")), 500),
    ("entries that are given twice", |n| each(n, |_| "lr_param.frict_comp 1".to_owned()), 500),
    ("points of a value list", |n| each(n, |n| format!("kw.frict.table[{n}].in {n}")), 500),
    ("values out of their range", |n| each(n, |_| "kopf.achs_nr -1".to_owned()), 500),
    ("lines that are not entries", |n| "?\n".repeat(n), 500),
    ("lists that are missing", |n| each(n, |n| format!("achs_daten[{n}] a{n}.lis")), 250),
];

/// The cost of a run.
#[derive(Debug)]
struct Cost {
    work: u64,
    /// Units that the program and its executed blocks contribute.
    granted: u64,
    allocated: u64,
    held: u64,
}

/// Units of work that the program and its executed blocks contribute.
struct Granted(u64);

impl Sink for Granted {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            self.0 += 500 + 4 * bytes(row.text);
        }
        ControlFlow::Continue(())
    }
}

fn bytes(text: &str) -> u64 {
    u64::try_from(text.len()).expect("a short text")
}

fn cost(case: &Case) -> Cost {
    cost_within(case, Limits::default())
}

fn cost_within(case: &Case, limits: Limits) -> Cost {
    let names: Vec<String> = (0..case.axes).map(|axis| format!("X{axis}")).collect();
    let axes = match case.axes {
        2 => vec!["X", "Y"],
        _ => names.iter().map(String::as_str).collect(),
    };
    let run = Options::default()
        .with_stop(StopPolicy::CheckAll)
        .with_limits(limits);
    let options = SessionOptions::from(run);
    let mut granted = Granted(16 * bytes(&case.text));
    let source = SourceFile::new("a.nc", case.text.as_str());
    let mut finder = |name: &str, _: &str| {
        let text = case.files.get(name)?;
        Some(SourceFile::new(name, text.as_str()))
    };
    let mut work = 0;
    let info = allocation_counter::measure(|| {
        let mut session = Session::new(Machine::enabled(axes), options);
        let _ = session.program("a.nc", Program::Whole(source), &mut finder, &mut granted);
        work = session.interpreter().work();
    });
    Cost {
        work,
        granted: granted.0,
        allocated: info.bytes_total,
        held: info.bytes_max,
    }
}

/// Returns the cost of reading a list, which needs no work of a run.
fn list_cost(text: &str) -> Cost {
    let source = SourceFile::new("a.lis", text);
    let info = allocation_counter::measure(|| {
        let _ = check_list(source, None, &mut NoLists);
    });
    Cost {
        work: 0,
        granted: 0,
        allocated: info.bytes_total,
        held: info.bytes_max,
    }
}

#[allow(clippy::cast_precision_loss, reason = "counts of a test")]
fn growth(once: u64, twice: u64, anyway: u64) -> f64 {
    twice as f64 / once.max(anyway) as f64
}

#[test]
#[allow(clippy::print_stdout, reason = "the table is shown with `--nocapture`")]
fn twice_the_program_needs_twice_the_time_and_memory() {
    // R2.60, R2.85
    let runs = SHAPES.iter().map(|&(shape, text, count)| {
        (shape, [count, 2 * count].map(|n| cost(&Case::new(text(n)))))
    });
    let cases = CASES
        .iter()
        .map(|&(shape, case, count)| (shape, [count, 2 * count].map(|n| cost(&case(n)))));
    let lists = LISTS
        .iter()
        .map(|&(shape, text, count)| (shape, [count, 2 * count].map(|n| list_cost(&text(n)))));
    let mut table = String::new();
    let mut too_fast = Vec::new();
    for (shape, [once, twice]) in runs.chain(cases).chain(lists) {
        let growth = [
            growth(once.work, twice.work, ANYWAY[0]),
            growth(once.allocated, twice.allocated, ANYWAY[1]),
            growth(once.held, twice.held, ANYWAY[1]),
        ];
        let [work, allocated, held] = growth;
        let _ = writeln!(table, "{shape:<50} {work:.2} {allocated:.2} {held:.2}");
        if growth.into_iter().any(|growth| growth > TWICE) {
            too_fast.push(format!("{shape}: {once:?} {twice:?}"));
        }
    }
    println!("{table}");
    assert!(too_fast.is_empty(), "{}", too_fast.join("\n"));
}

type HostileProgram = (&'static str, fn() -> String);

/// Programs that do far more than their text suggests, until a budget ends them.
#[rustfmt::skip]
const HOSTILE: &[HostileProgram] = &[
    ("macros of macros", || format!("\"A0\"=\"1+1\"\n{}$FOR P1=1,99999,1\nP2=\"A7\"+P1\n$ENDFOR", each(7, |n| format!("\"A{}\"=\"\\\"A{n}\\\"+\\\"A{n}\\\"+\\\"A{n}\\\"\"", n + 1)))),
    ("macros in an unknown region", || format!("\"A0\"=\"X1 \"\n{}$FOR P1=1,99999,1\n$IF V.E.X\n\"A8\"\n$ENDIF\n$ENDFOR", each(8, |n| format!("\"A{}\"=\"\\\"A{n}\\\" \\\"A{n}\\\" \\\"A{n}\\\"\"", n + 1)))),
    ("strings that are searched", || format!("P1=\"{}\"\nP2=\"{}b\"\n$FOR P3=1,99999,1\nP4=FIND[P1,P2]\n$ENDFOR", "a".repeat(3900), "a".repeat(1900))),
    ("unknown jumps", || format!("$FOR P1=1,99999,1\n{}$GOTO N[V.E.X]\n$ENDFOR", each(3000, |n| format!("N{}: X1", n + 10)))),
    ("unknown calls", || subprograms(1500, &format!("$FOR P1=1,99999,1\n$IF V.E.X\n{}$ENDIF\n$ENDFOR\n", each(1500, |n| format!("LL S{n}"))))),
    ("a chain of unknown calls", || format!("{}%L S2000\nX1\nM17\n%MAIN\n$FOR P1=1,99999,1\n$IF V.E.X\nLL S0\n$ENDIF\n$ENDFOR\nM30", each(2000, |n| format!("%L S{n}\nLL S{0}\nLL S{0}\nM17", n + 1)))),
    ("names that are nearly right", || format!("{}%MAIN\n$FOR P1=1,99999,1\nLL {}\n$ENDFOR\nM30", each(500, |n| format!("%L {}{n}\nM17", "AB".repeat(40))), "AB".repeat(41))),
    ("one line of faults in a loop", || format!("$FOR P1=1,99999,1\nX1{}\n$ENDFOR", " ?1".repeat(900))),
    ("exchanged axes", || format!("$FOR P1=1,99999,1\n{}$ENDFOR", each(3000, |n| format!("#CALL AX [X{0}, {0}, {0}]", n + 1)))),
    ("couplings that may be enabled", || format!("{}$FOR P1=1,99999,1\n#ENABLE AX LINK [V.E.X]\nX[COMP ON FRICT]\n$ENDFOR", each(1500, |n| format!("#SET AX LINK [{n}, Y=X]\n#ENABLE AX LINK [{n}]")))),
];

/// Bytes that may be allocated for a unit of work, done or granted.
const BYTES_PER_UNIT: u64 = 128;

#[test]
#[allow(clippy::print_stdout, reason = "the table is shown with `--nocapture`")]
fn a_unit_of_work_costs_little_whatever_it_is_spent_on() {
    // R2.60
    let mut dear = Vec::new();
    for (what, program) in HOSTILE {
        let case = Case::new(program());
        let cost = cost_within(
            &case,
            Limits::default().with_work(1_000_000).with_blocks(2_000),
        );
        let units = cost.granted + cost.work;
        let each = cost.allocated / units;
        println!("{what:<35} {units:>10} units, {each} bytes each");
        if each > BYTES_PER_UNIT {
            dear.push(*what);
        }
    }
    assert!(dear.is_empty(), "{dear:?}");
}

#[test]
fn the_document_shows_every_shape() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reliability.md");
    let text = fs::read_to_string(path).expect("a document");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let runs = SHAPES.iter().map(|(shape, ..)| *shape);
    let cases = CASES.iter().map(|(shape, ..)| *shape);
    let lists = LISTS.iter().map(|(shape, ..)| *shape);
    let missing: Vec<&str> = runs
        .chain(cases)
        .chain(lists)
        .filter(|shape| !text.contains(shape))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// Returns a recording of ten channels as exported by TwinCAT Scope.
fn recording(rows: usize) -> String {
    let names: Vec<String> = (0..8).map(|at| format!("Unused{at}")).collect();
    let mut text = format!("Name\tv\ttorque\t{}\n\n", names.join("\t"));
    for row in 0..rows {
        let direction = if row / 1000 % 2 == 0 { 1 } else { -1 };
        let _ = write!(text, "{row}\t{}\t{}", 5000 * direction, 100 * direction);
        for unused in 0..8 {
            let _ = write!(text, "\t{}.{unused}", row * 7 % 1000);
        }
        text.push('\n');
    }
    text
}

#[test]
fn a_recording_takes_at_most_three_times_the_columns_that_are_used() {
    // R6.1 R6.20: read from a file and identified, whatever else the file contains.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("friction.csv");
    for rows in [100_000, 200_000] {
        fs::write(&path, recording(rows)).expect("written");
        // Times, velocities and torques.
        let used = 3 * 8 * u64::try_from(rows).expect("a few");
        let selection = ChannelSelection::default();
        let mut track = None;
        let read = allocation_counter::measure(|| {
            let recording = read_axis(&path, &selection, None, &Disk::default());
            track = Some(recording.expect("a recording").track);
        });
        let track = track.expect("a track");
        assert_eq!(track.torques.len(), rows);
        let identified = allocation_counter::measure(|| {
            let found = identify(&track, &IdentifyOptions::default());
            assert!(found.is_ok(), "{found:?}");
        });
        let held = read.bytes_max.max(used + identified.bytes_max);
        assert!(
            held <= 3 * used,
            "{rows} rows: {} and {} for columns of {used}",
            read.bytes_max,
            used + identified.bytes_max
        );
    }
}
