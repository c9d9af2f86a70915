//! Answers in notes of an operator (R15.2).

use super::bench;
use crate::folder::json;

/// R15.2: a line that is marked as an answer but cannot be read as one is named with its place.
#[test]
fn lines_that_are_no_answers_are_named() {
    let bench = bench();
    bench.write(
        "note.txt",
        "frictcomp-ask R1.9\n\nfrictcomp-ask X9.9 0 X V3.1.3081.5 reading x\n",
    );
    let output = bench.call(&["ask", "read", "note.txt"]);
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

/// R15.2: the answers are a document, with the lines that cannot be read and where it was recorded what they decide.
#[test]
fn answers_are_a_document() {
    let bench = bench();
    bench.stdout(&["ask", "write", "--into", "ask"]);
    let copied = bench.read("ask/README.txt");
    let line = copied
        .lines()
        .find(|line| line.ends_with(" reading before"));
    let line = line.expect("a line to copy");
    bench.write("note.txt", &format!("{line}\nfrictcomp-ask R1.9\n"));
    let read = json(&bench.stdout(&["ask", "read", "note.txt", "--format", "json"]));
    assert_eq!(read["headline"]["text"], "1 question answered");
    let answer = &read["answers"][0];
    assert_eq!(answer["rule"], "R1.9");
    assert_eq!(answer["answer"], "confirmed");
    assert_eq!(answer["reading"], "before");
    assert_eq!(answer["build"], "V3.1.3081.05");
    assert_eq!(read["unread"][0]["line"], 2);
    assert_eq!(read["recorded_in"], "frictcomp.toml");
    assert_eq!(read["lacks_build"], false);
}

/// R15.2: the lines to copy name both readings of a question and are not an answer, nor are both of them in
/// one note.
#[test]
fn the_lines_to_copy_are_no_answers() {
    let bench = bench();
    let before = bench.read("frictcomp.toml");
    bench.stdout(&["ask", "write", "--into", "ask"]);
    let said = bench.stdout(&["ask", "read", "ask/README.txt"]);
    assert!(
        said.contains(
            "R1.9 not decidable\n  axis X on V3.1.3081.05: the note says `after` and `before`"
        ),
        "{said}"
    );
    assert_eq!(
        said.matches("; keep the line of what was seen").count(),
        10,
        "{said}"
    );
    assert_eq!(bench.read("frictcomp.toml"), before);

    let copied = bench.read("ask/README.txt");
    let line = copied
        .lines()
        .find(|line| line.ends_with(" reading before"));
    bench.write("note.txt", line.expect("a line to copy"));
    let said = bench.stdout(&["ask", "read", "note.txt"]);
    assert!(said.contains("\nR1.9 confirmed: before\n"), "{said}");
}
