//! A run that is stopped after any block, saved and resumed says what an uninterrupted one says.

mod support;

use std::cell::RefCell;
use std::fmt::Write as _;
use std::ops::ControlFlow;

use frictcomp::interpreter::{
    Event, Interpreter, Options, Outlook, ResumeError, Snapshot, StopPolicy,
};
use frictcomp::machine::Machine;
use frictcomp::text::SourceFile;
use serde_json::json;
use support::MACHINE;

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
const CYCLE: &str = "G1 @X@P1\n$IF @P2>1\nX[COMP OFF FRICT]\nL deep.nc\n$ENDIF\nM17\n";
const DEEP: &str = "V.S.COUNT = 7\nX[COMP ON FRICT]\n";

fn file(name: &str) -> Option<SourceFile> {
    let text = match name {
        "a.nc" => MAIN,
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
    Options {
        stop: StopPolicy::CheckAll,
        ..Options::default()
    }
}

/// What an event says.
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

fn start(observer: &mut dyn FnMut(&Event<'_>) -> ControlFlow<()>) -> (Interpreter, Outlook) {
    let machine = machine();
    let compensation = machine.compensation();
    let mut run = Interpreter::new(machine, compensation, options());
    let source = file("a.nc").expect("the main program");
    let outlook = run.program(source, &mut find, &mut |event: Event<'_>| observer(&event));
    (run, outlook)
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
        let (run, outlook) = start(&mut |event| {
            said.borrow_mut().push(shown(event));
            if said.borrow().len() == stop {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!(outlook, Outlook::Paused, "after {stop}");
        let saved = serde_json::to_string(&run.snapshot()).expect("a snapshot is JSON");
        let saved: Snapshot = serde_json::from_str(&saved).expect("what was written is read");
        assert_eq!(saved, run.snapshot());
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
fn a_run_is_resumed_after_every_block() {
    let mut whole = Vec::new();
    start(&mut |event| {
        whole.push(shown(event));
        ControlFlow::Continue(())
    });
    let mut said = Vec::new();
    let (mut run, mut outlook) = start(&mut |event| {
        said.push(shown(event));
        ControlFlow::Break(())
    });
    while outlook == Outlook::Paused {
        run = Interpreter::resume(machine(), options(), run.snapshot(), &mut file)
            .expect("all files are there");
        outlook = run.go_on(&mut find, &mut |event: Event<'_>| {
            said.push(shown(&event));
            ControlFlow::Break(())
        });
    }
    assert_eq!(said, whole);
}

/// A snapshot of the run with another value at each of the places, as JSON pointers.
fn damaged(places: &[(&str, serde_json::Value)]) -> Result<Interpreter, ResumeError> {
    let mut left = 40;
    let (run, _) = start(&mut |_| {
        left -= 1;
        if left == 0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let mut snapshot = serde_json::to_value(run.snapshot()).expect("a snapshot is JSON");
    for (place, value) in places {
        *snapshot.pointer_mut(place).expect(place) = value.clone();
    }
    let snapshot: Snapshot = serde_json::from_value(snapshot).expect("the right shape");
    Interpreter::resume(machine(), options(), snapshot, &mut file)
}

#[test]
fn a_damaged_snapshot_is_refused() {
    assert!(damaged(&[]).is_ok());
    for (place, value) in [
        ("/state/frames/0/unit", json!(9)),
        ("/state/frames/0/section", json!(9)),
        ("/state/frames/0/next", json!(4_000_000)),
        ("/state/frames/0/level", json!(4_000_000_000_u32)),
        ("/state/seq", json!(u64::MAX)),
        ("/state/blocks", json!(u64::MAX)),
        ("/state/level", json!(u64::MAX)),
        ("/state/occurred", json!([true])),
        ("/state/modal/positions", json!([])),
        ("/state/modal/references", json!([1.0])),
        ("/state/modal/suspended", json!([1.0])),
        ("/state/compensation/names", json!(["X"])),
        ("/state/compensation/spindles", json!([])),
        ("/state/couplings/holding", json!({"900": 1})),
        ("/state/parked", json!({"Jump": 4_000_000})),
        ("/files", json!([])),
    ] {
        let refused = damaged(&[(place, value)]);
        assert!(
            matches!(refused, Err(ResumeError::Damaged(_))),
            "{place}: {:?}",
            refused.err()
        );
    }
}
