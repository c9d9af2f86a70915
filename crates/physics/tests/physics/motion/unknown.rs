//! R5.1 and R5.4: what is not known is left out and reported.

use frictcomp_physics::motion::PlannerOptions;

use super::{MACHINE, trace, trace_of};

/// Returns the messages about a program, and where the trace of X begins.
fn said(program: &str) -> (Vec<(String, u32)>, usize) {
    let trace = trace(program, &["X"]);
    (trace.said, trace.begins.len())
}

/// Returns the message that the first motion is left out, because its start is not known.
fn fc906() -> Vec<(String, u32)> {
    vec![("FC906".to_owned(), 1)]
}

fn fc903(lines: &[u32]) -> Vec<(String, u32)> {
    lines
        .iter()
        .map(|line| ("FC903".to_owned(), *line))
        .collect()
}

#[test]
fn the_trace_begins_where_the_positions_are_known() {
    // R5.1
    let found = trace("G01 X5 Y5 F1000\nX10\nM30", &["X", "Y"]);
    assert_eq!(found.positions[0], [5.0, 5.0]);
    assert_eq!((found.said, found.begins.len()), (fc906(), 1));
    assert_eq!(said("G01 G91 X5 F1000\nX10\nM30"), (fc906(), 0));
}

#[test]
fn motions_that_are_not_known_are_left_out() {
    // R5.1
    let known =
        |middle: &str| format!("G01 X0 F1000\nX10\n{middle}\nG90 G94 G01 X0 F1000\nX10\nM30");
    for middle in [
        "G74 X1",
        "G95 F0.1 X20",
        "G194 F150 X20",
        "X=V.E.PLACE",
        "G54 X20",
        "G33 X20 K2",
        "G02 X20 Y0",
        "G02 X20 R1",
        "G93 X20",
        "G94 F0 X20",
        "G04 V.E.TIME",
        "$IF V.E.A == 1\nX30\n$ENDIF\nG91 X20",
    ] {
        let (mut codes, begins) = said(&known(middle));
        codes.retain(|(code, _)| code != "FC906");
        assert!(
            codes.iter().all(|(code, _)| code == "FC903"),
            "{middle}: {codes:?}"
        );
        assert_eq!((codes.len(), begins), (1, 2), "{middle}");
    }
    let expected = [fc906(), fc903(&[2])].concat();
    assert_eq!(said("G01 X0\nX10\nX20 F100\nX30\nM30"), (expected, 1));
}

#[test]
fn transformed_positions_are_said_to_be_the_programs() {
    // R5.4
    let program =
        "G01 X0 Y0 F1000\n#ROTATION ON [ANGLE 30]\nX0 Y0\nX10\nX20\n#ROTATION OFF\nX0 Y0\nX1\nM30";
    let trace = trace(program, &["X"]);
    assert!(
        trace.said.contains(&("FC904".to_owned(), 4)),
        "{:?}",
        trace.said
    );
    let again = trace.said.iter().filter(|(code, _)| code == "FC904");
    assert_eq!(again.count(), 1);
}

#[test]
fn a_trace_is_bounded() {
    // R5.1: without an end, and with numbers that no axis can drive.
    let options = PlannerOptions::default().with_max_cycles(1000);
    for program in [
        "G01 X0 F1000\n$WHILE 1\nX10\nX0\n$ENDWHILE\nM30",
        "G01 X0 F0.000001\nX1000\nM30",
        "G01 X0 F1000\nX1\nG04 1e9\nM30",
        "G01 X0 F1000\nX100000000000000000000\nM30",
    ] {
        let trace = trace_of(MACHINE, program, &["X"], options.clone());
        assert_eq!(trace.positions.len(), 1000, "{program}");
        assert_eq!(
            trace.said.last().map(|(code, _)| code.as_str()),
            Some("FC915")
        );
    }
}
