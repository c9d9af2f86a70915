//! 2.3 and 2.6: axes, words, modal state and positions.

use crate::support::Bench;

#[test]
fn a_tool_word_that_gives_data_counts_as_one() {
    // R2.45 R2.75
    let mut bench = Bench::new().keep_going();
    let said = |bench: &Bench, block: &str| bench.run(&[&format!("{block}\nM30")]);
    assert!(said(&bench, "D1 D2").contains("FC313 1:4-"));
    assert!(!said(&bench, "T1 D1").contains("FC313"));
    bench.machine.programs.data_with_tool = true;
    assert!(said(&bench, "T1 D1").contains("FC313 1:4-"));
    assert!(!said(&bench, "T1\nD1").contains("FC313"));
}
