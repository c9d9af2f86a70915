//! 2.1: text.

use frictcomp::syntax::{ast::Operand, parse_block};
use insta::assert_snapshot;

use crate::support::Bench;

fn run(program: &str) -> String {
    Bench::new().keep_going().run(&[program])
}

#[test]
fn text_of_any_editor() {
    // R2.1
    let expected = run("N10 X[COMP OFF FRICT]\nN20 X[COMP ON FRICT]\nN30 M30\n");
    for text in [
        "\u{feff}N10 X[COMP OFF FRICT]\nN20 X[COMP ON FRICT]\nN30 M30",
        "N10 X[COMP OFF FRICT]\r\nN20 X[COMP ON FRICT]\r\nN30 M30\r\n",
        "N10 X[COMP OFF FRICT]\rN20 X[COMP ON FRICT]\rN30 M30\r",
        "N10 X[COMP OFF FRICT]\nN20 X[COMP ON FRICT]\nN30 M30\n\u{0}\u{3}",
        "N10 X[COMP OFF FRICT] ; \u{dc}ber\nN20 X[COMP ON FRICT] (\u{b5}m)\nN30 M30 \u{3}",
    ] {
        assert_eq!(run(text), expected, "{text:?}");
    }
    assert_snapshot!(run("N10 X1 \u{dc}\nN20 V.P.S = \"\u{dc}\"\nN30 M30"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
        FC101 1:8-9
      2 line 2 N20
      3 line 3 N30
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_block_is_a_line() {
    // R2.2
    let long = format!("N10 X1 ({})\nM30", "x".repeat(4000));
    assert_snapshot!(run(&long), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC206 1:1-4001
      2 line 2 -
      end 2 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    let fits = format!("N10 X1 ({})\nM30", "x".repeat(4000 - 9));
    assert!(!run(&fits).contains("FC206"));
}

#[test]
fn blocks_are_skipped_by_level() {
    // R2.3
    let program = "/N10 X[COMP OFF FRICT]\n/2 N20 Y[COMP OFF FRICT]\n/10N30 X[COMP ON FRICT]\n/ Y[COMP ON FRICT]\nM30";
    assert_snapshot!(Bench::new().skip("none").run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive
      2 line 2 N20 Y:active>inactive
      3 line 3 N30 X:inactive>active
      4 line 4 - Y:inactive>active
      5 line 5 -
      end 5 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().skip("1").run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 2 N20 Y:active>inactive
      2 line 3 N30
      3 line 5 -
        FC401 2:8-25
      end 3 M30 X:active Y:inactive Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().skip("2,10").run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive
      2 line 4 -
      3 line 5 -
        FC401 1:6-23
      end 3 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn block_numbers() {
    // R2.4
    let program = "P1=7\nN[P1*10+0.4] X1\nNP1 X2\nN5 X3\nn6 X4\nN20: X5\n[HERE]\n[THERE] X6\nM30";
    assert_snapshot!(run(program), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 N70
      3 line 3 N7
      4 line 4 N5
      5 line 5 N6
        FC404 5:1-2
      6 line 6 N20
      7 line 7 -
      8 line 8 -
      9 line 9 -
      end 9 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn words_need_no_blanks() {
    // R2.5
    let words = |text: &str| {
        let block = parse_block(text);
        let shown = block.words.iter().map(|word| match word.value {
            Some(Operand::Number(value)) => format!("{} = {value}", word.span.of(text)),
            _ => word.span.of(text).to_owned(),
        });
        assert_eq!(block.items, []);
        let faults = block
            .faults
            .iter()
            .map(|fault| fault.code.as_str().to_owned());
        shown.chain(faults).collect::<Vec<_>>().join(", ")
    };
    assert_snapshot!(words("N10G1X100F200"), @"G1 = 1, X100 = 100, F200 = 200");
    assert_snapshot!(words("G01 X 100 Y-.5Z+7."), @"G01 = 1, X 100 = 100, Y-.5 = -0.5, Z+7. = 7");
    assert_snapshot!(words("g1 X10 f200"), @"g1 = 1, X10 = 10, f200 = 200, FC404");
    assert_snapshot!(words("G1x10"), @"G1 = 1, x10 = 10");
}

#[test]
fn comments() {
    // R2.6
    let program = "N10 (a (nested) one) X[COMP OFF FRICT] (and) Y(here)[COMP (there) OFF FRICT]\n\
        N20 X[COMP ON FRICT] (not closed Y[COMP ON FRICT]\n\
        N30 Y[COMP ON FRICT] ; X[COMP OFF FRICT] ( \n\
        N40 #COMMENT BEGIN\nX[COMP OFF FRICT]\n#COMMENT END\n\
        N50 V.P.S = \"; no ( comment\" X[COMP OFF FRICT]\n\
        N60 X[COMP ON FRICT]\nM30";
    assert_snapshot!(run(program), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive Y:active>inactive
      2 line 2 N20 X:inactive>active
        FC414 2:22-50
      3 line 3 N30 Y:inactive>active
      4 line 7 N50 X:active>inactive
      5 line 8 N60 X:inactive>active
      6 line 9 -
      end 6 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(run("X1\n#COMMENT BEGIN\nX[COMP OFF FRICT]\nM30"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC310 1:1-3
        FC414 2:1-15
      end 1 end-of-file X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_call_may_go_on_in_the_next_line() {
    // R2.7, R2.74
    let bench = Bench::new().file("b.nc", "N1 X[COMP OFF FRICT]\nM17");
    for call in [
        "LL \\\nOFF",
        "LL \\ ; a comment\n N20 OFF",
        "L \\\n b.nc",
        "L \\\n\"b.nc\"",
        "L \\\nSEQUENCE [NAME=b.nc N1 N1]",
    ] {
        let said = bench.run(&[&format!(
            "%MAIN\n{call}\nM30\n%L OFF\nN1 X[COMP OFF FRICT]\nM17"
        )]);
        assert!(
            said.contains("X:active>inactive") && !said.contains("FC320"),
            "{said}"
        );
    }
}

#[test]
fn continued_lines() {
    // R2.7
    let bench = Bench::new().file("c.cyc", "N1 X[COMP OFF FRICT]\nN2 P9=@P1+@P2\nM17");
    let program = "N10 G1 X10 \\\nN11 Y20 \\ ; comment\n\
        (a comment line)\n\nF1000\n\
        N20 L CYCLE [NAME=c.cyc \\\n; a comment line\nN21 @P1=1 \\\n(another)\n@P2=2]\n\
        N30 #VAR\nV.P.A[4] = [1, 2, \\\n3, 4]\n#ENDVAR\n\
        N40 $IF P9==3 && V.P.A[3]==4\nN50 X[COMP ON FRICT]\nN60 $ENDIF\n\
        N70 S[M3 \\\nREV1000]\nM30";
    assert_snapshot!(bench.keep_going().run(&[program]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 6 N20
      3 line 1 N1 level 1 X:active>inactive
      4 line 2 N2 level 1
      5 line 3 - level 1
      6 line 11 N30
      7 line 15 N40
      8 line 16 N50 X:inactive>active
      9 line 17 N60
      10 line 18 N70
      11 line 20 -
      end 11 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {"S[M3]": 1}
    "#);
}

#[test]
fn nothing_is_a_program() {
    // R2.8 R18.6
    assert_snapshot!(run(""), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC103 1:1-1
      end 0 end-of-file X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(run("\n; only\n(comments)\n#COMMENT BEGIN\n#COMMENT END\n"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC103 1:1-1
      end 0 end-of-file X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn neighbours_without_blanks() {
    // R2.5 R1.9: a word before a command needs no blank.
    let program = "N10 G01X10Y[COMP OFF FRICT]F100\nN20 X10Y20X[COMP OFF FRICT]\nN30X[COMP ON FRICT]Y[COMP ON FRICT]M30";
    assert_snapshot!(run(program), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 Y:active>inactive
        FC405 1:11-28
      2 line 2 N20 X:active>inactive
        FC405 2:11-28
      3 line 3 N30 X:inactive>active Y:inactive>active
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    let machine = "[[axis]]\nname = \"X1\"\nfrict_comp = true\n[[axis]]\nname = \"X50P1\"\nfrict_comp = true\n";
    let program = "X1[COMP OFF FRICT]\nX50P1[COMP OFF FRICT]\nX50P1=7 X1=3\nM30";
    assert_snapshot!(Bench::on(machine).run(&[program]), @"
    start X1:ineffective X50P1:ineffective
    a.nc -
      1 line 1 - X1:ineffective>inactive
      2 line 2 - X50P1:ineffective>inactive
      3 line 3 -
      4 line 4 -
        FC401 1:1-19
        FC401 2:1-22
      end 4 M30 X1:inactive X50P1:inactive
    ");
}
