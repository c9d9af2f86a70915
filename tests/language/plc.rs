//! 2.11: variables that a program shares with the PLC.

use crate::support::Bench;

/// Programs that write `V.E.REQ`, with what may be between that and the condition.
fn between(block: &str) -> String {
    format!("V.E.REQ = 1\n{block}\n$IF V.E.REQ == 0\nX[COMP OFF FRICT]\n$ENDIF\nM30")
}

#[test]
fn a_channel_list_says_which_functions_are_not_acknowledged() {
    // R2.99
    let mut bench = Bench::new();
    bench.machine.channel.unacknowledged = [(b'M', 8), (b'H', 2), (b'M', 0)].into();
    for (block, acts) in [("M8", false), ("H2", false), ("M9", true), ("M0", true)] {
        let said = bench.said(&between(block));
        assert_eq!(said.contains("may have changed"), acts, "{block}\n{said}");
    }
}
