//! Parts of programs: R2.77, R2.78.

use insta::assert_snapshot;

use crate::support::{Bench, SourceMode};

/// Returns the executed lines, with the level of each.
fn lines(bench: &Bench, program: &str) -> String {
    let transcript = bench.run(&[program]);
    let rows = transcript.lines().map(str::trim).filter(|line| {
        line.contains(" line ")
            || line.starts_with("FC2")
            || line.starts_with("FC9")
            || line.starts_with("end ")
    });
    let shown = rows.map(|row| match row.split_once(" line ") {
        Some((_, row)) => row.replace(" level ", "^").replace(" -", ""),
        None => row.split(" Z:").next().unwrap_or_default().to_owned(),
    });
    shown.collect::<Vec<_>>().join("; ")
}

#[test]
fn a_part_of_a_program_is_called_by_its_blocks() {
    // R2.77
    let bench = Bench::new();
    let body = "N10 X1\nN20 X[COMP OFF FRICT]\nN30 X2\n[FROM] X3\nX4\n[TO] X[COMP ON FRICT]\n";
    for (call, name) in [
        ("L SEQUENCE [N20 N30]", "numbers"),
        ("L SEQUENCE[N20]", "one block"),
        ("LSEQUENCE [[FROM] [TO]]", "labels"),
        ("L SEQUENCE [N10 N10 REPEAT=3]", "repeated"),
        ("L SEQUENCE [N[5*6] [TO]]", "mixed"),
        ("N77 L SEQUENCE [[TO] ENDTAG]", "up to the call"),
        ("L SEQUENCE [N10 N30 REPEAT 2 ENDTAG]", "end tag last"),
    ] {
        let program = format!("{body}{call}\nX9\nM30");
        let seen = lines(&bench, &program);
        insta::allow_duplicates! {
            insta::with_settings!({description => name}, {
                match name {
                    "numbers" => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7; 2 N20^1 X:active>inactive; 3 N30^1; 8; 9; end 11 M30 X:inactive Y:active"),
                    "one block" => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7; 2 N20^1 X:active>inactive; 8; 9; end 10 M30 X:inactive Y:active"),
                    "labels" => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7; 4^1; 5^1; 6^1; 8; 9; end 12 M30 X:active Y:active"),
                    "repeated" => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7; 1 N10^1; 1 N10^1; 1 N10^1; 8; 9; end 12 M30 X:active Y:active"),
                    "mixed" => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7; 3 N30^1; 4^1; 5^1; 6^1; 8; 9; end 13 M30 X:active Y:active"),
                    "up to the call" => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7 N77; 6^1; 8; 9; end 10 M30 X:active Y:active"),
                    _ => assert_snapshot!(seen, @"1 N10; 2 N20 X:active>inactive; 3 N30; 4; 5; 6 X:inactive>active; 7; 1 N10^1; 2 N20^1 X:active>inactive; 3 N30^1; 1 N10^1; 2 N20^1; 3 N30^1; 8; 9; end 15 M30 X:inactive Y:active"),
                }
            });
        }
    }
}

#[test]
fn a_part_of_another_program() {
    // R2.77
    let bench = Bench::new()
        .file("a.cyc", "%A\nN1 X1\nN2 X[COMP OFF FRICT]\nN3 X2\nN4 M17")
        .file("loop.cyc", "N1 L SEQUENCE [NAME=loop.cyc N1 N2]\nN2 M17");
    let all = [
        "L SEQUENCE [NAME=a.cyc N2 N3]",
        "L SEQUENCE [NAME=\"a.cyc\" N2 N4 REPEAT=2]",
        "#VAR\nV.P.N : STRING[20] = \"a.cyc\"\n#ENDVAR\nL SEQUENCE [NAME=V.P.N N3 N2]",
    ];
    let seen: Vec<String> = all
        .iter()
        .map(|call| lines(&bench, &format!("{call}\nM30")))
        .collect();
    assert_snapshot!(seen.join("\n"), @"
    1; 3 N2^1 X:active>inactive; 4 N3^1; 2; end 4 M30 X:inactive Y:active
    1; 3 N2^1 X:active>inactive; 4 N3^1; 5 N4^1; 3 N2^1; 4 N3^1; 5 N4^1; 2; end 8 M30 X:inactive Y:active
    1; 4; 4 N3^1; 5 N4^1; 5; end 5 M30 X:active Y:active
    ");
    for (call, code) in [
        ("L SEQUENCE [NAME=a.cyc N9]", "FC209"),
        ("L SEQUENCE [NAME=none.cyc N1]", "FC320"),
        ("L SEQUENCE [N99 N100]", "FC209"),
        ("L SEQUENCE [NAME=loop.cyc N1 N2]", "FC911"),
        ("L SEQUENCE []", "FC207"),
        ("L SEQUENCE [N1 JUNK]", "FC210"),
        ("L SEQUENCE [N1", "FC205"),
        ("L SEQUENCE [NAME=V.E.X N1]", "FC902"),
        ("L SEQUENCE [NAME=a.cyc N V.E.X]", "FC902"),
        ("L SEQUENCE [NAME=a.cyc N1 N2 REPEAT=V.E.X]", "FC902"),
    ] {
        let transcript = bench.run(&[&format!("{call}\nN50 X1\nM30")]);
        assert!(transcript.contains(code), "{call}: {transcript}");
        let unknown = matches!(code, "FC902" | "FC210");
        assert_eq!(
            transcript.contains("M30 X:unknown Y:unknown"),
            unknown,
            "{transcript}"
        );
    }
    // A part that consists only of skipped blocks is not repeated endlessly.
    let skipped = "/N10 X1\nL SEQUENCE [N10 N10 REPEAT=9000000000]\nM30";
    assert!(Bench::new().skip("1").run(&[skipped]).contains("end 2 M30"));
}

#[test]
fn a_part_in_an_unknown_region_may_be_executed() {
    // R2.51 R2.77
    let program =
        "$GOTO N50\nN10 X[COMP OFF FRICT]\nN50:\n$IF V.E.X\nL SEQUENCE [N10]\n$ENDIF\nM30";
    let transcript = Bench::new().run(&[program]);
    assert!(
        transcript.contains("M30 X:unknown Y:active"),
        "{transcript}"
    );
}

#[test]
fn subprograms_return_over_several_programs() {
    // R2.78
    for back in ["M17", "M29"] {
        for (end, name) in [
            ("[JUMPS=1]", "one"),
            ("[JUMPS = 2]", "two"),
            ("[JUMPS=99]", "too many"),
            ("[MAIN]", "main"),
            ("[MAIN [ERR]]", "label"),
            ("[MAIN N30]", "number"),
            ("[JUMPS=1 [SUB]]", "label of a subprogram"),
            ("[[SUB]]", "label of the caller"),
        ] {
            let bench = Bench::new()
                .file("one.nc", "L two.nc\nX1\n[SUB] Y1\nM17")
                .file("two.nc", &format!("Y2\n{back} {end}\nY3\nM17"));
            let program = "N10 L one.nc\nN20 X1\nN30 X2\n[ERR] X3\nM30";
            let seen = lines(&bench, program);
            assert_eq!(
                lines(&bench.handed(SourceMode::LineByLine), program),
                seen,
                "{end}"
            );
            insta::allow_duplicates! {
                match name {
                    "one" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 2^1; 3^1; 4^1; 2 N20; 3 N30; 4; 5; end 11 M30 X:active Y:active"),
                    "two" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 2 N20; 3 N30; 4; 5; end 8 M30 X:active Y:active"),
                    "too many" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 2 N20; 3 N30; 4; 5; end 8 M30 X:active Y:active"),
                    "main" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 2 N20; 3 N30; 4; 5; end 8 M30 X:active Y:active"),
                    "label" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 4; 5; end 6 M30 X:active Y:active"),
                    "number" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 3 N30; 4; 5; end 7 M30 X:active Y:active"),
                    "label of a subprogram" => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 3^1; 4^1; 2 N20; 3 N30; 4; 5; end 10 M30 X:active Y:active"),
                    _ => assert_snapshot!(seen, @"1 N10; 1^1; 1^2; 2^2; 3^1; 4^1; 2 N20; 3 N30; 4; 5; end 10 M30 X:active Y:active"),
                }
            }
        }
    }
}

#[test]
fn where_a_subprogram_returns_to_must_be_there() {
    // R2.78
    for (end, code) in [
        ("M17 [MAIN [NONE]]", "FC209"),
        ("M17 [MAIN N99]", "FC209"),
        ("M17 [JUMPS=0]", "FC312"),
        ("M17 [JUMPS=2]", "FC317"),
        ("M17 [JUMPS=V.E.N]", "FC902"),
        ("M29 [MAIN N V.E.N]", "FC902"),
    ] {
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            let bench = Bench::new().file("sub.nc", end).handed(handed);
            let transcript = bench.run(&["L sub.nc\nX1\nM30"]);
            assert!(transcript.contains(code), "{end}: {transcript}");
        }
    }
    // A program that is run by itself ends as with a plain M17.
    assert_eq!(
        lines(&Bench::new(), "X1\nM17 [MAIN]"),
        lines(&Bench::new(), "X1\nM17")
    );
}

#[test]
fn a_return_to_a_block_that_has_not_come_yet_is_found_after_a_statement() {
    // R2.78 R9.40: the `$IF` takes the rest of the text into memory
    let bench = Bench::new().file("sub.nc", "M17 [MAIN N30]");
    let program = "N10 L sub.nc\nN20 X1\n$IF 1\nX5\n$ENDIF\nN30 X2\nM30";
    let seen = lines(&bench, program);
    assert_snapshot!(seen, @"1 N10; 1^1; 6 N30; 7; end 4 M30 X:active Y:active");
    assert_eq!(lines(&bench.handed(SourceMode::LineByLine), program), seen);
}

#[test]
fn parts_of_a_program_that_arrives() {
    // R2.77 R9.40: text that was read line by line is not kept
    let program = "N10 X1\nN20 X2\nL SEQUENCE [N10 N20]\nM30";
    let transcript = Bench::new().handed(SourceMode::LineByLine).run(&[program]);
    assert!(
        transcript.contains("FC902") && transcript.contains("X:unknown"),
        "{transcript}"
    );
    let mut scan = frictcomp::syntax::FlowScan::default();
    scan.feed(program.as_bytes());
    assert!(scan.needs_whole_text());
    for (text, whole) in [
        ("Q10 X1", false),
        ("l Sequence [N1]", false),
        ("N1LSeQuEnCe[N1]", true),
        ("SEQ", true),
    ] {
        let mut scan = frictcomp::syntax::FlowScan::default();
        scan.feed(text.as_bytes());
        assert_eq!(scan.needs_whole_text(), whole, "{text}");
    }
}
