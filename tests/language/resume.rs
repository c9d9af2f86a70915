//! A run that is stopped after any block, saved and resumed reports the same as an uninterrupted
//! one.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::ops::ControlFlow;

use crate::support::MACHINE;
use frictcomp::interpreter::{
    EndedBy, Event, Interpreter, Limits, Options, ResumeError, RunOutcome, SearchedBlock, Snapshot,
    StopPolicy,
};
use frictcomp::machine::Machine;
use frictcomp::text::{SourceFile, TextLines};
use serde_json::{Value, json};

/// Nested loops, branches, calls with own parameters, cycles, macros, jumps, unknown values,
/// couplings, arrays.
const MAIN: &str = "%L INNER
N1 $FOR P3=1,2,1
N2 $IF P3==P1 $GOTO N4
N3 X[COMP OFF FRICT]
N4: X[COMP ON FRICT] V.L.DEPTH = V.L.DEPTH+1
N5 $ENDFOR
N6 M17
%MAIN
#VAR
V.L.DEPTH = 0
V.P.LIST[3] = [1, 2, 3]
#ENDVAR
\"OFF\" = \"Y[COMP OFF FRICT]\"
N10 $FOR P1=1,3,1
N20 $SWITCH P1
$CASE 1
LL INNER
$BREAK
$CASE 2
L CYCLE [NAME=c.cyc @P1=P1 @P2=V.P.LIST[1]]
$DEFAULT
G1 G91 X1 F100
\"OFF\"
$ENDSWITCH
P2=0
$WHILE P2<2
P2=P2+1
$REPEAT
$CONTINUE
X99
$UNTIL 1
; frictcomp: allow FC402 the loop sets it each time
Y[COMP ON FRICT]
$ENDWHILE
N30 $ENDFOR
#SET AX LINK [1, Y=X]
#ENABLE AX LINK [1]
Y[COMP OFF FRICT]
#DISABLE AX LINK
$IF V.E.A
B[COMP OFF FRICT]
$ENDIF
L CYCLE [NAME=c.cyc MODAL_MOVE @P1=1 @P2=1]
G90 X5
#DISABLE MODAL CYCLE
P9=1/0
N50 M30
";
/// Program with both sides of skip levels, conditions, cases and a loop, on the way to a searched block.
const SIDES: &str = "/1 X[COMP OFF FRICT]\n$IF V.E.A==1\nY[COMP ON FRICT]\n$ENDIF\n$SWITCH V.E.B\n$CASE 1\n\
                 Y[COMP OFF FRICT]\n$CASE 2\nX[COMP ON FRICT]\n$DEFAULT\nB[COMP ON FRICT]\n$ENDSWITCH\n$WHILE V.E.C\nX[COMP ON FRICT]\n\
                 $IF V.E.D>2\nY[COMP OFF FRICT]\n$ENDIF\n$ENDWHILE\n$IF V.E.A==2\nY[COMP ON FRICT]\n\
                 $ENDIF\nN90 X1\nM30\n";
const CYCLE: &str = "G1 @X@P1\n$IF @P2>1\nX[COMP OFF FRICT]\nL deep.nc\n$ENDIF\nM17\n";
const DEEP: &str = "V.S.COUNT = 7\nX[COMP ON FRICT]\n";

fn file(name: &str) -> Option<SourceFile> {
    let text = match name {
        "a.nc" => MAIN,
        "sides.nc" => SIDES,
        "c.cyc" => CYCLE,
        "deep.nc" => DEEP,
        "start.nc" => "N1 X[COMP ON FRICT]\nM17",
        "end.nc" => "N1 Y[COMP ON FRICT]\nM30",
        _ => return None,
    };
    Some(SourceFile::new(name, text))
}

fn machine() -> Machine {
    let ends = "[machine]\nstart_program = \"start.nc\"\nend_program = \"end.nc\"\n";
    Machine::from_toml(&format!("{ends}{MACHINE}")).expect("the test's machine")
}

fn options() -> Options {
    Options::default().with_stop(StopPolicy::CheckAll)
}

/// Returns an event as text.
fn shown(event: &Event<'_>) -> String {
    match event {
        Event::Started { name, .. } => format!("started {name:?}"),
        Event::Executed(block) => {
            let mut shown = format!(
                "{} {}:{} {:?} {:?} {:?} {:?}",
                block.seq,
                block.file,
                block.line,
                block.number,
                block.level,
                block.changes,
                block.moved,
            );
            for diagnostic in block.diagnostics {
                write!(shown, " {} {}", diagnostic.code, diagnostic.message).expect("text");
                write!(shown, " {:?}", diagnostic.labels).expect("text");
            }
            write!(shown, " {:?} {:?}", block.remark, block.modal).expect("text");
            shown
        }
        Event::Joined(joined) => format!("joined {}", joined.seq),
        Event::Ended(ended) => {
            let notes: Vec<String> = ended
                .diagnostics
                .iter()
                .map(|diagnostic| format!("{} {}", diagnostic.code, diagnostic.message))
                .collect();
            format!(
                "ended {} {:?} {notes:?} {:?}",
                ended.seq, ended.by, ended.changes
            )
        }
    }
}

fn find(name: &str, _: &str) -> Option<SourceFile> {
    file(name)
}

fn start(observer: &mut dyn FnMut(&Event<'_>) -> ControlFlow<()>) -> (Interpreter, RunOutcome) {
    let machine = machine();
    let compensation = machine.compensation();
    let mut run = Interpreter::new(machine, compensation, options());
    let source = file("a.nc").expect("the main program");
    let outcome = run.program(source, &mut find, &mut |event: Event<'_>| observer(&event));
    (run, outcome)
}

#[test]
fn a_run_is_resumed_at_any_block() {
    let mut whole = Vec::new();
    start(&mut |event| {
        whole.push(shown(event));
        ControlFlow::Continue(())
    });
    assert!(whole.len() > 80, "{}", whole.len());
    assert!(
        whole.last().is_some_and(|end| end.contains("M30")),
        "{whole:?}"
    );
    for stop in 1..whole.len() {
        let said = RefCell::new(Vec::new());
        let (run, outcome) = start(&mut |event| {
            said.borrow_mut().push(shown(event));
            if said.borrow().len() >= stop {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!(outcome, RunOutcome::Paused, "after {stop}");
        let saved = serde_json::to_string(&snapshot(&run)).expect("a snapshot is JSON");
        let saved: Snapshot = serde_json::from_str(&saved).expect("a written snapshot is read");
        assert_eq!(saved, snapshot(&run));
        let mut resumed = Interpreter::resume(machine(), options(), saved, &mut file)
            .expect("all files are there");
        resumed.go_on(&mut find, &mut |event: Event<'_>| {
            said.borrow_mut().push(shown(&event));
            ControlFlow::Continue(())
        });
        assert_eq!(*said.borrow(), whole, "stopped after {stop}");
    }
}

#[test]
fn a_clone_of_a_run_goes_on_as_the_run_would() {
    let mut whole = Vec::new();
    start(&mut |event| {
        whole.push(shown(event));
        ControlFlow::Continue(())
    });
    let mut said = Vec::new();
    let (mut run, mut outcome) = start(&mut |event| {
        said.push(shown(event));
        ControlFlow::Break(())
    });
    while outcome == RunOutcome::Paused {
        let mut ahead = Vec::new();
        run.clone().go_on(&mut find, &mut |event: Event<'_>| {
            ahead.push(shown(&event));
            ControlFlow::Continue(())
        });
        assert_eq!(ahead, whole[said.len()..], "after {}", said.len());
        outcome = run.go_on(&mut find, &mut |event: Event<'_>| {
            said.push(shown(&event));
            ControlFlow::Break(())
        });
    }
    assert_eq!(said, whole);
}

fn snapshot(run: &Interpreter) -> Snapshot {
    run.snapshot().expect("its text is in memory")
}

#[test]
fn a_run_is_resumed_after_every_block() {
    let mut whole = Vec::new();
    start(&mut |event| {
        whole.push(shown(event));
        ControlFlow::Continue(())
    });
    let mut said = Vec::new();
    let (mut run, mut outcome) = start(&mut |event| {
        said.push(shown(event));
        ControlFlow::Break(())
    });
    while outcome == RunOutcome::Paused {
        run = Interpreter::resume(machine(), options(), snapshot(&run), &mut file)
            .expect("all files are there");
        outcome = run.go_on(&mut find, &mut |event: Event<'_>| {
            said.push(shown(&event));
            ControlFlow::Break(())
        });
    }
    assert_eq!(said, whole);
}

/// Returns a run stopped in the middle of its calls.
fn stopped() -> Snapshot {
    let mut left = 40;
    let (run, _) = start(&mut |_| {
        left -= 1;
        if left == 0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    snapshot(&run)
}

/// Returns a run of a program stopped after some events.
fn stopped_after(events: usize, name: &str, options: Options) -> Snapshot {
    let compensation = machine().compensation();
    let mut run = Interpreter::new(machine(), compensation, options);
    let mut seen = 0;
    let source = file(name).expect("a program");
    let outcome = run.program(source, &mut find, &mut |_: Event<'_>| {
        seen += 1;
        if seen >= events {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert_eq!(outcome, RunOutcome::Paused);
    snapshot(&run)
}

/// Returns a run stopped on one of several sides, inside a loop and before its searched block.
fn stopped_on_sides() -> Snapshot {
    let searched = "N90".parse::<SearchedBlock>().expect("a block number");
    let options = options().with_search(searched);
    let is_full = |saved: &Snapshot| {
        let saved = document(saved);
        let (state, others) = (&saved["state"], &saved["others"]);
        let track = &state["track"];
        track["searching"].is_object()
            && track["readings"][0].is_object()
            && others["loop_heads"][0][1]["state"].is_object()
            && others["waiting"][0].is_object()
            && state["conditions"][3].is_object()
    };
    let mut stops = (10..40).map(|events| stopped_after(events, "sides.nc", options));
    stops.find(is_full).expect("a stop with everything")
}

fn document(snapshot: &Snapshot) -> Value {
    serde_json::to_value(snapshot).expect("a snapshot is JSON")
}

fn resume(snapshot: Snapshot) -> Result<Interpreter, ResumeError> {
    Interpreter::resume(machine(), options(), snapshot, &mut file)
}

/// Resumes a run with a deliberately forged value at a place, a JSON pointer.
fn forged(saved: &Snapshot, place: &str, value: Value) -> Result<Interpreter, ResumeError> {
    let mut document = document(saved);
    *document.pointer_mut(place).expect(place) = value;
    let snapshot: Snapshot = serde_json::from_value(document).expect("the right shape");
    resume(snapshot.sealed_anew())
}

#[test]
fn a_snapshot_that_names_what_is_not_there_is_refused() {
    assert!(resume(stopped()).is_ok());
    for (place, value) in [
        ("/state/control/frames/0/unit", json!(9)),
        ("/state/control/frames/0/section", json!(9)),
        ("/state/control/frames/0/next", json!(4_000_000)),
        ("/state/control/frames/0/level", json!(4_000_000_000_u32)),
        ("/state/seq", json!(u64::MAX)),
        ("/state/blocks", json!(u64::MAX)),
        ("/state/work/level", json!(u64::MAX)),
        ("/state/opaque", json!({"G99": u64::MAX})),
        ("/state/occurred", json!([true])),
        ("/state/control/modal/positions", json!([])),
        ("/state/control/modal/references", json!([1.0])),
        ("/state/control/modal/suspended", json!([1.0])),
        ("/state/control/couplings/holding", json!({"900": 1})),
        ("/state/parked", json!({"Jump": 4_000_000})),
        ("/executed/0/0", json!(4_000_000)),
        ("/executed", json!([[], [], [], [], [], []])),
        ("/files", json!([])),
    ] {
        let refused = forged(&stopped(), place, value);
        assert!(
            matches!(refused, Err(ResumeError::Damaged(_))),
            "{place}: {:?}",
            refused.err()
        );
    }
}

#[test]
fn sides_of_conditions_that_are_not_there_are_refused() {
    let saved = stopped_on_sides();
    assert!(resume(saved.clone()).is_ok());
    let whole = document(&saved);
    let texts = json!(vec!["V.E.A"; 70]);
    let answers = json!(vec![json!({"is": [], "is_not": []}); 70]);
    let reached = json!([[{"condition": 90, "sides": 1, "of": 2}]]);
    for (place, value) in [
        ("/state/conditions/0/texts", texts),
        ("/state/conditions/0/place/first_line", json!(u32::MAX)),
        ("/state/track/readings/0/answers", answers),
        ("/state/track/readings/0/condition", json!(90)),
        ("/state/track/reach", reached.clone()),
        ("/others/loop_heads/0/1/state/track/reach", reached.clone()),
        (
            "/others/loop_heads/0/1/state/control/compensation/axes",
            json!([]),
        ),
        ("/state/track/searching/compensation/axes", json!([])),
        ("/others/waiting/0/track/reach", reached),
    ] {
        assert_ne!(whole.pointer(place), Some(&value), "{place}");
        let refused = forged(&saved, place, value);
        assert!(
            matches!(refused, Err(ResumeError::Damaged(_))),
            "{place}: {:?}",
            refused.err()
        );
    }
}

/// Collects the places of all numbers in a document, as JSON pointers.
fn numbers(document: &Value, place: &str, found: &mut Vec<String>) {
    match document {
        Value::Number(_) => found.push(place.to_owned()),
        Value::Array(items) => {
            for (at, item) in items.iter().enumerate() {
                numbers(item, &format!("{place}/{at}"), found);
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                let name = name.replace('~', "~0").replace('/', "~1");
                numbers(field, &format!("{place}/{name}"), found);
            }
        }
        _ => {}
    }
}

#[test]
fn any_number_of_a_snapshot_may_be_wrong() {
    let options = options().with_limits(Limits::default().with_blocks(2000));
    for saved in [stopped(), stopped_on_sides()] {
        let whole = document(&saved);
        let mut places = Vec::new();
        numbers(&whole["state"], "/state", &mut places);
        assert!(places.len() > 40, "{}", places.len());
        for place in places {
            for wrong in [json!(7), json!(4_000_000_000_u32), json!(u64::MAX)] {
                let mut document = whole.clone();
                *document.pointer_mut(&place).expect("it was found") = wrong.clone();
                let Ok(snapshot) = serde_json::from_value::<Snapshot>(document) else {
                    continue;
                };
                // With its old seal it is refused; sealed anew, it is refused or runs to some end.
                let sealed = snapshot.clone().sealed_anew();
                assert!(
                    sealed == snapshot || matches!(resume(snapshot), Err(ResumeError::Damaged(_))),
                    "{place} is {wrong}"
                );
                if let Ok(mut run) = Interpreter::resume(machine(), options, sealed, &mut file) {
                    run.go_on(&mut find, &mut |_: Event<'_>| ControlFlow::Continue(()));
                }
            }
        }
    }
}

#[test]
fn a_snapshot_of_other_texts_is_refused() {
    let saved = stopped();
    for changed in saved.files() {
        let refused = Interpreter::resume(machine(), options(), saved.clone(), &mut |name| {
            let text = file(name)?;
            let more = if name == changed { " " } else { "" };
            Some(SourceFile::new(name, format!("{}{more}", text.text())))
        });
        let expected = ResumeError::OtherText(changed.to_owned());
        assert_eq!(refused.err(), Some(expected));
        let refused = Interpreter::resume(machine(), options(), saved.clone(), &mut |name| {
            file(name).filter(|_| name != changed)
        });
        let expected = ResumeError::MissingFile(changed.to_owned());
        assert_eq!(refused.err(), Some(expected));
    }
}

#[test]
fn a_snapshot_of_another_version_or_machine_is_refused() {
    let mut document = document(&stopped());
    document["schema"] = json!(1);
    let snapshot: Snapshot = serde_json::from_value(document).expect("the right shape");
    let refused = resume(snapshot).err();
    assert_eq!(refused, Some(ResumeError::Schema { found: 1 }));
    let other = Machine::from_toml(&MACHINE.replace("\"B\"", "\"C\"")).expect("a machine");
    let refused = Interpreter::resume(other, options(), stopped(), &mut file);
    assert_eq!(refused.err(), Some(ResumeError::OtherMachine));
}

#[test]
fn a_snapshot_that_was_cut_off_or_has_another_bit_is_refused() {
    let saved = stopped();
    let text = serde_json::to_string(&saved).expect("a snapshot is JSON");
    for length in (0..text.len()).step_by(11) {
        let cut = text.get(..length).unwrap_or_default();
        assert!(serde_json::from_str::<Snapshot>(cut).is_err(), "{cut}");
    }
    for at in (0..text.len()).step_by(5) {
        for bit in [0, 4] {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1 << bit;
            let Ok(snapshot) = serde_json::from_slice::<Snapshot>(&bytes) else {
                continue;
            };
            assert!(snapshot == saved || resume(snapshot).is_err(), "byte {at}");
        }
    }
}

#[test]
fn the_same_run_gives_the_same_snapshot() {
    let text = |saved: &Snapshot| serde_json::to_string(saved).expect("a snapshot is JSON");
    assert_eq!(text(&stopped()), text(&stopped()));
}

#[test]
fn a_stream_that_was_stopped_says_that_it_cannot_go_on() {
    for text in ["N1 X1\nN2 X2\nM30\n", "N1 X1\n$IF 1\nX2\n$ENDIF\nM30\n"] {
        for stop in 1..4 {
            let compensation = machine().compensation();
            let mut run = Interpreter::new(machine(), compensation, options());
            let mut left = stop;
            let mut lines = TextLines::new(text);
            let outcome = run.stream("a.nc", &mut lines, &mut find, &mut |_: Event<'_>| {
                left -= 1;
                if left == 0 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            assert_eq!(outcome, RunOutcome::Stopped, "{text}");
            assert_eq!(run.snapshot(), None);
            let mut nobody = |_: Event<'_>| panic!("it continues");
            assert_eq!(run.go_on(&mut find, &mut nobody), RunOutcome::Stopped);
            // The interpreter can run the next program.
            let source = SourceFile::new("b.nc", "X3\nM30\n");
            let outcome = run.program(source, &mut find, &mut |_: Event<'_>| {
                ControlFlow::Continue(())
            });
            assert_eq!(outcome, RunOutcome::Ended(EndedBy::M30));
            assert!(run.snapshot().is_some());
        }
    }
}
