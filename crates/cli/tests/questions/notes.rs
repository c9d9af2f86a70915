//! Answers in notes of an operator (R15.2).

use super::bench;

/// R15.2: a line that is marked as an answer and cannot be read as one is named with its place.
#[test]
fn lines_that_are_no_answers_are_named() {
    let bench = bench();
    bench.write(
        "note.txt",
        "frictcomp-ask R1.9\n\nfrictcomp-ask X9.9 0 X V3.1.3081.5 reading x\n",
    );
    let output = bench.call(&["ask", "--read", "note.txt"]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).expect("text");
    for words in [
        "note.txt:1: not an answer: after `frictcomp-ask` an answer has a rule",
        "note.txt:3: not an answer: there is no question `X9.9`",
        "`note.txt` holds no answer",
    ] {
        assert!(said.contains(words), "{said}");
    }
}
