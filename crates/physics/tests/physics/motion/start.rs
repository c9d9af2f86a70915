//! R5.1 and R5.4: the start of a trace, the motions that it leaves out, and the cause of each cycle.

use frictcomp::machine::Machine;
use frictcomp_physics::motion::{Movement, PlannerOptions, PositionFrame};

use super::{MACHINE, Trace, follow, trace};

fn from(program: &str, axes: &[&str], start: &[(&str, f64)]) -> Trace {
    let machine = Machine::from_toml(MACHINE).expect("a machine");
    follow(machine, program, (axes, start), PlannerOptions::default())
}

#[test]
fn a_start_that_is_given_makes_the_first_motion_known() {
    // R5.1
    let program = "G01 X5 Y5 F1000\nX10\nM30";
    let found = from(program, &["X", "Y"], &[("X", 0.0), ("Y", 1.0)]);
    assert_eq!(found.positions[0], [0.0, 1.0]);
    assert_eq!(found.lines[0], 1);
    assert_eq!((found.said.len(), found.left_out.len()), (0, 0));
    let found = from("G01 G91 X5 F1000\nX10\nM30", &["X"], &[("X", -20.0)]);
    assert_eq!(found.end(), [-5.0]);
    // One of several axes is not enough.
    let found = from("G01 X5 Y5 F1000\nX10\nM30", &["X", "Y"], &[("X", 0.0)]);
    assert_eq!(found.said, [("FC906".to_owned(), 1)]);
    assert!(
        found.messages[0].contains("unknown start position of Y"),
        "{:?}",
        found.messages
    );
}

#[test]
fn a_start_is_proposed_where_it_is_not_known() {
    // R5.1
    let found = trace("G00 Z5\nG01 G91 X5 Y5 F1000\nX10\nM30", &["X"]);
    assert_eq!(found.said, [("FC906".to_owned(), 1)]);
    assert_eq!(
        found.messages,
        [
            "the trace leaves out 3 motions, of which this is the first: unknown start positions of \
             X, Y, Z; give the start position of X, Y, Z"
        ]
    );
    // After homing, the axis positions at the start would not help.
    let found = trace("G74 X1\nG01 G91 X5 F1000\nX10\nM30", &["X"]);
    assert_eq!(found.said, [("FC903".to_owned(), 1)]);
    // An origin of the machine makes a start useless.
    let found = trace("G54\nG01 X5 F1000\nX10\nM30", &["X"]);
    assert_eq!(found.said, [("FC906".to_owned(), 2)]);
    assert!(found.messages[0].contains("the origin was moved"));
    let found = from("G54\nG01 X5 F1000\nX10\nM30", &["X"], &[("X", 0.0)]);
    assert_eq!(found.said, [("FC906".to_owned(), 2)]);
}

#[test]
fn what_is_left_out_is_told_with_its_time() {
    // R5.1 R5.4
    let found = trace("G01 X0 F1000\nX10\nG74 X1\nX0\nX10\nM30", &["X"]);
    let lines: Vec<u32> = found.left_out.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [1, 3, 4]);
    let first = u32::try_from(found.begins[1]).expect("a short trace");
    let at = found.left_out[1].1;
    assert!((at - f64::from(first) * 0.001).abs() < 1e-9, "{at}");
}

#[test]
fn every_cycle_says_what_it_belongs_to() {
    // R5.1 R5.4
    let program = "N10 G00 X0 Y0\nN20 X10\nN30 G01 X20 F1000\nN40 G04 0.1\nN50 #ROTATION ON [ANGLE 30]\nN60 X0 Y0\nN70 X1\nM30";
    let found = trace(program, &["X", "Y"]);
    for (movement, number, frame) in [
        (Movement::Rapid, 20, PositionFrame::Machine),
        (Movement::Feed, 30, PositionFrame::Machine),
        (Movement::Dwell, 40, PositionFrame::Machine),
        (Movement::Feed, 70, PositionFrame::Programmed),
    ] {
        let of_block = found.causes.iter().filter(|it| it.number == Some(number));
        let all: Vec<_> = of_block.collect();
        assert!(!all.is_empty(), "N{number}");
        assert!(
            all.iter()
                .all(|it| it.movement == movement && it.frame == frame && it.program == 1),
            "N{number}"
        );
    }
    let rest = found.causes.iter().zip(&found.path_velocities);
    let mut rest = rest.filter(|(cause, _)| cause.movement == Movement::Dwell);
    assert!(rest.all(|(_, velocity)| *velocity == 0.0));
    let fastest = found.path_velocities.iter().copied().fold(0.0, f64::max);
    assert!((fastest - found.top_speed(0)).abs() < 1e-9);
}
