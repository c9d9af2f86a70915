//! 2.5 and 2.8: flow and budgets.

use frictcomp::interpreter::Limits;
use insta::assert_snapshot;

use crate::support::Bench;

#[test]
fn a_loop_with_step_0_is_endless() {
    // R2.41
    let limits = Limits::default().with_blocks(7);
    assert_snapshot!(Bench::new().limits(limits).run(&["$FOR P1=1,3,0\nX1\n$ENDFOR\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 2 -
      5 line 3 -
      6 line 2 -
      7 line 3 -
        FC910 2:1-3
      end 7 budget X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn budgets() {
    // R2.60
    let limits = |limits: Limits| Bench::new().limits(limits);
    let bench = limits(Limits::default().with_blocks(5));
    assert_snapshot!(bench.run(&["X1\n$WHILE 1\n$IF 1\nX2\n$ENDIF\n$ENDWHILE\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        FC910 6:1-10
      end 5 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(bench.run(&["X1\nX2\nX3\nX4\nX5\nX6\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        FC910 6:1-3
      end 5 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let bench = limits(Limits::default().with_calls(3));
    assert_snapshot!(bench.run(&["%L S\nLL S\nM17\n%M\nLL S\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc M
      1 line 5 -
      2 line 2 - level 1
      3 line 2 - level 2
      4 line 2 - level 3
        FC911 2:1-5
      end 4 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let bench = limits(Limits::default().with_nesting(2));
    assert_snapshot!(bench.run(&["$IF 1\n$IF 1\n$IF 1\n$ENDIF\n$ENDIF\n$ENDIF\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC912 3:1-6
      end 0 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let deep = format!("P1={}1{}\nM30", "[".repeat(65), "]".repeat(65));
    assert_snapshot!(Bench::new().run(&[&deep]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC913 1:68-69
      end 1 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let fits = format!("P1={}1{}\nM30", "[".repeat(64), "]".repeat(64));
    assert!(!Bench::new().run(&[&fits]).contains("FC913"));
    let bench = limits(Limits::default().with_macros(2));
    let chain = "\"A\"=\"\\\"B\\\"\"\n\"B\"=\"\\\"C\\\"\"\n\"C\"=\"X1\"\n\"B\"\n\"A\"\nM30";
    assert_snapshot!(bench.run(&[chain]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        FC914 5:1-4
      end 5 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    // A macro that uses itself many times does not cause a hang.
    for program in [
        "\"A\"=\"\\\"A\\\" \\\"A\\\" \\\"A\\\" \\\"A\\\"\"\n\"A\"\nM30",
        "\"A\"=\"\\\"A\\\"+\\\"A\\\"+\\\"A\\\"\"\nP1=\"A\"\nM30",
    ] {
        let said = Bench::new().keep_going().run(&[program]);
        assert!(said.contains("FC914"), "{program}\n{said}");
    }
}

#[test]
fn budgets_name_the_loop_that_used_them_up() {
    // R2.60
    let limits = Limits::default().with_blocks(5);
    let said = Bench::new()
        .limits(limits)
        .said("X1\n$WHILE 1\n$IF 1\nX2\n$ENDIF\n$ENDWHILE\nM30");
    assert_snapshot!(said, @"
    FC910 6:1 more than 5 blocks were executed; the dry run ends here
      help: look for a loop that does not end, or raise the budget with `--max-blocks`
      2:1: in this loop
    ");
}
