//! A saved session: its content, and what is refused.

use std::ops::ControlFlow;

use fastrand::Rng;
use frictcomp::interpreter::Value;
use frictcomp::machine::Setting;
use frictcomp::session::{SavedState, Session, StateError};
use frictcomp::timeline::{Record, Sink};

use serde_json::json;

use super::program::machine;
use super::sessions::{options, play, resumed};

struct Nobody;

impl Sink for Nobody {
    fn record(&mut self, _: &Record<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

fn left_off() -> Session {
    let mut session = Session::new(machine(), options());
    let program = "%FRICTION\nN10 X[COMP OFF FRICT] ; known\nY[COMP OFF FRICT]\nM30\n";
    play(&mut session, ("friction.nc", program), &mut Nobody);
    session
}

#[test]
fn it_says_who_made_a_state() {
    // R9.32
    let saved = serde_json::to_value(left_off().save()).unwrap();
    assert_eq!(saved["schema"], 4);
    let away = &saved["axes"][0]["away"];
    let by = json!({
        "program": "FRICTION", "file": "friction.nc", "line": 2, "text": "N10 X[COMP OFF FRICT] ; known",
    });
    assert_eq!(*away, json!([{ "kind": "FRICT", "by": by }]));
    assert!(
        saved["axes"][2].get("away").is_none(),
        "Z is in its start-up state"
    );
}

/// Returns the output of a resumed session about a changed state.
fn refusal(change: impl FnOnce(&mut SavedState)) -> String {
    let mut saved = left_off().save();
    change(&mut saved);
    match Session::resume(machine(), options(), saved) {
        Ok(_) => String::new(),
        Err(error @ (StateError::Damaged { .. } | StateError::OtherMachine { .. })) => {
            error.to_string()
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn axes_are_matched_by_name() {
    // R9.30 R9.32: in any order, each once.
    assert_eq!(refusal(|_| ()), "");
    assert_eq!(refusal(|saved| saved.axes.reverse()), "");
    assert_eq!(refusal(|saved| saved.machine.reverse()), "");
    let said = refusal(|saved| drop(saved.axes.pop()));
    assert_eq!(said, "it is damaged (axis `B` is missing)");
    let said = refusal(|saved| saved.axes[1].axis = "X".to_owned());
    assert_eq!(said, "it is damaged (axis `X` occurs twice)");
    let said = refusal(|saved| {
        let mut surplus = saved.axes[2].clone();
        surplus.axis = "C".to_owned();
        saved.axes.push(surplus);
    });
    assert_eq!(said, "it is damaged (the machine has no axis `C`)");
    let said = refusal(|saved| saved.axes[2].selected = saved.axes[3].selected);
    assert!(
        said.contains("`FRICT` of axis `Z` is not configured"),
        "{said}"
    );

    let mut saved = left_off().save();
    saved.axes.swap(0, 1);
    saved.axes[0].selected = saved.axes[3].selected;
    let (session, _) = Session::resume(machine(), options(), saved).unwrap();
    let text = serde_json::to_string(&session.save().axes).unwrap();
    assert!(text.find("\"X\"") < text.find("\"Y\""), "{text}");
    let state = session.state();
    let word = |name| {
        let axis = state.machine.find(name).unwrap();
        state.state(axis, frictcomp::comp::Kind::Frict).as_str()
    };
    assert_eq!((word("X"), word("Y")), ("inactive", "active"));
}

#[test]
fn whatever_is_saved_is_read() {
    // R9.30 R9.32: extreme numbers, any text, what is not known.
    let mut rng = Rng::with_seed(14);
    for _ in 0..400 {
        let mut settings = options();
        for at in 0..rng.usize(1..8) {
            let value = match rng.u8(..3) {
                0 => Setting::Number(f64::from_bits(rng.u64(..))),
                1 => Setting::Number([f64::INFINITY, f64::NAN, -0.0, 5e-324][rng.usize(..4)]),
                _ => Setting::Text((0..rng.usize(..20)).map(|_| rng.char(..)).collect()),
            };
            settings.settings.push((format!("V.S.N{at}"), value));
        }
        let mut session = Session::new(machine(), settings);
        let program = "V.S.B = V.S.N0\nV.S.U = V.E.X\n#VAR\nV.S.A[2,3]\n#ENDVAR\nV.S.A[1,1] = 2\nX1e300\nM30\n";
        play(&mut session, ("a.nc", program), &mut Nobody);
        let again = resumed(machine(), &session);
        let (first, second) = (session.save(), again.save());
        assert_eq!(
            serde_json::to_string(&first).unwrap(),
            serde_json::to_string(&second).unwrap()
        );
        assert_eq!(first, second);
        let finite = |value: &Value| value.number().is_none_or(f64::is_finite);
        assert!(second.variables.values().all(finite));
    }
}
