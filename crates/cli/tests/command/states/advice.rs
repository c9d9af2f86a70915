//! Each fact is reported once: the closing advice with the lints, and comments that allow them.

use crate::folder::Bench;

const LEFT_OFF: &str = "X[COMP OFF FRICT]\nX1\nM30\n";
const MOVED_BEFORE: &str = "X1\nX[COMP OFF FRICT]\nM30\n";

fn shown(program: &str, arguments: &[&str]) -> String {
    let bench = Bench::new(&[("a.nc", program)]);
    let mut all = vec!["run", "--width", "200"];
    all.extend(arguments);
    all.push("a.nc");
    bench.stdout(&all)
}

#[test]
fn the_advice_of_a_lint_is_not_repeated() {
    // R1.50 R1.53
    for (program, code) in [(LEFT_OFF, "FC401"), (MOVED_BEFORE, "FC407")] {
        for arguments in [&[][..], &["--changes"]] {
            let text = shown(program, arguments);
            assert_eq!(text.matches(code).count(), 1, "{text}");
            assert_eq!(text.matches("X[COMP ON FRICT]").count(), 1, "{text}");
            assert!(!text.contains("write X[COMP"), "{text}");
            assert!(!text.contains("nothing to do"), "{text}");
        }
    }
}

#[test]
fn an_allowed_lint_takes_the_axis_out_of_the_advice() {
    // R9.24
    for (program, code) in [(LEFT_OFF, "FC401"), (MOVED_BEFORE, "FC407")] {
        let allowed = format!("; frictcomp: allow {code} known\nX[COMP OFF FRICT]");
        let text = shown(&program.replace("X[COMP OFF FRICT]", &allowed), &[]);
        assert!(!text.contains(&format!("[{code}]")), "{text}");
        assert!(!text.contains("write X[COMP"), "{text}");
        assert!(
            !text.contains("nothing to do"),
            "X is not in its start-up state: {text}"
        );
        assert!(!text.contains("FC490"), "{text}");
    }
}

#[test]
fn an_allowed_lint_stays_allowed_in_the_state_file() {
    // R9.24 R9.32
    let allowed = "X[COMP OFF FRICT] ; frictcomp: allow FC401 known\nM30\n";
    let bench = Bench::new(&[("a.nc", allowed), ("b.nc", "Y1\nM30\n")]);
    bench.stdout(&["run", "--state", "s", "a.nc"]);
    let text = bench.stdout(&["run", "--state", "s", "b.nc"]);
    assert!(!text.contains("write X[COMP"), "{text}");
    assert!(!text.contains("nothing to do"), "{text}");
}

#[test]
fn what_no_lint_says_is_advised() {
    // R18.10: an error leaves the state that is there, which FC401 says.
    let text = shown("X[COMP OFF FRICT]\nZ[COMP ON FRICT]\nM30\n", &[]);
    assert!(
        text.contains("is left inactive after the error in line 2"),
        "{text}"
    );
    assert!(!text.contains("write X[COMP"), "{text}");
    let text = shown("X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n", &[]);
    assert!(text.contains("nothing to do"), "{text}");
}

#[test]
fn an_allow_comment_that_is_not_understood_is_said() {
    // R9.80
    let bench = Bench::new(&[(
        "a.nc",
        "; frictcomp: allow FC4O1 known\nX[COMP OFF FRICT]\n\
         $FOR P1=1,3,1\nX[COMP ON FRICT] ; frictcomp: alow FC402\n$ENDFOR\nM30\n",
    )]);
    let text = bench.stdout(&["check", "--format", "concise", "a.nc"]);
    assert!(text.contains("a.nc:1:20: warning[FC491]"), "{text}");
    assert!(text.contains("a.nc:4:31: warning[FC491]"), "{text}");
    assert_eq!(text.matches("FC491").count(), 2, "once a place: {text}");
    assert!(text.contains("FC402"), "{text}");
    bench.write("b.nc", "X1 ; frictcomp: allow FC401, FC402\nM30\n");
    let text = bench.stdout(&["check", "--format", "concise", "b.nc"]);
    assert_eq!(text.matches("FC490").count(), 2, "{text}");
}
