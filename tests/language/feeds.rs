//! Feed moves without a feed: R2.110.

use crate::support::{Bench, SourceMode};

fn said(program: &str) -> String {
    Bench::new().keep_going().said(program)
}

/// The places of the messages on feeds.
fn places(program: &str) -> Vec<String> {
    let found = said(program);
    let lines = found.lines().filter(|line| line.starts_with("FC327 "));
    let places = lines.filter_map(|line| line.split(' ').nth(1).map(str::to_owned));
    let places: Vec<String> = places.collect();
    let lines = Bench::new().keep_going().handed(SourceMode::LineByLine);
    let count = lines.run(&[program]).matches("FC327").count();
    assert_eq!(count, places.len(), "{program}");
    places
}

#[test]
fn the_first_feed_move_needs_a_feed() {
    // R2.110
    for (program, place) in [
        ("G01 X10\nX20\nM30", "1:5"),
        ("N10 G0 X0\r\nN20 G90 G1\r\nN30 Y5\r\nN40 M02\r\n", "3:5"),
        ("G2 X10 Y0 I5\nM30", "1:4"),
        ("G3 I5\nM30", "1:4"),
        ("P1=5\nG1\nG91 XP1\nM30", "3:5"),
        ("$IF V.E.A == 1\nF100\n$ENDIF\nG1 X10\nM30", "4:4"),
        ("%L SUB\nG1 X10\nM17\n%M\nLL SUB\nM30", "2:4"),
        // F is modal for each of G93, G94, G95.
        ("F100\nG1 X1\nG95 X2\nM30", "3:5"),
        ("G95 F0.1\nG1 X1\nG94 X2\nM30", "3:5"),
    ] {
        assert_eq!(places(program), [place], "{program}");
    }
    for program in [
        "F100\nG1 X10\nM30",
        "G1 X10 F100\nM30",
        "P1=5\nG1 X10 FP1\nM30",
        "G1 X10 F=V.E.FEED\nM30",
        "G1 X10 E50\nM30",
        "G93 F2\nG1 X10\nM30",
        "G0 X10\nM30",
        "G1\nM30",
        "G1 G04 X10\nM30",
        "G1 G92 X10\nM30",
        "G1 G74 X1\nM30",
        "G1\nG0 X10\nG1 F5 X20\nM30",
        "#CONTOUR BEGIN [ID1]\nG1 X1\n#CONTOUR END\nM30",
        "%L SUB\nF100\nM17\n%M\nLL SUB\nG1 X10\nM30",
        "G81\nG1 X10\nM30",
        // Subprograms.
        "G1 X10\nM17",
        "G1 X10\nM29 ; end",
        "G1 X10",
        "$IF V.E.A\nM30\n$ENDIF\nG1 X10\nM17",
    ] {
        assert_eq!(places(program), [""; 0], "{program}");
    }
    let session = Bench::new().said_in_session(&["G1 X1 F5\nM30", "G1 X1\nM30"]);
    assert!(session.contains("b.nc\nFC327 1:4"), "{session}");
    let found = said("G1 X10\nM30");
    assert!(
        found.contains("20008") && found.contains("unless the PLC gives the feed"),
        "{found}"
    );
}

#[test]
fn a_channel_list_without_a_feed_makes_it_an_error() {
    // R2.110
    let program = "X[COMP OFF FRICT]\nG1 X10\nX[COMP ON FRICT]\nM30";
    let mut bench = Bench::new();
    bench.machine.channel.lacks_feed = true;
    let transcript = bench.run(&[program]);
    assert!(transcript.contains("P-ERR-20008 2:4"), "{transcript}");
    assert!(
        transcript.contains("end 2 error X:inactive"),
        "{transcript}"
    );
    // The number is for the first feed move in a main program.
    for (program, code) in [
        ("G1 X1 F0\nM30", "FC327"),
        ("F100\nG1 X1\nG95 X2\nM30", "FC327"),
        ("$IF V.E.A == 1\nF100\n$ENDIF\nG1 X10\nM30", "FC327"),
        ("G1 X10\nM17", ""),
    ] {
        let transcript = bench.run(&[program]);
        assert!(!transcript.contains("20008"), "{program}: {transcript}");
        assert_eq!(
            transcript.contains("FC327"),
            !code.is_empty(),
            "{program}: {transcript}"
        );
    }
}
