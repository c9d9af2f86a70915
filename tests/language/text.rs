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
