//! `diff`: versions that cannot be compared as a whole are reported as such.

use crate::folder::Bench;

fn diff(old: &str, new: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let bench = Bench::new(&[("old.nc", old), ("new.nc", new)]);
    let mut all = vec!["diff", "old.nc", "new.nc"];
    all.extend(arguments);
    let output = bench.call(&all);
    let shown = String::from_utf8(output.stdout).expect("text");
    (output.status.code(), shown)
}

#[test]
fn versions_that_stop_are_not_comparable() {
    // R1.37, R9.26
    let stops = "Z[COMP ON FRICT]\nX[COMP OFF FRICT]\nM30\n";
    let (status, shown) = diff(stops, stops, &[]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(!shown.contains("no difference"), "{shown}");
    assert_eq!(shown.matches("not comparable: ").count(), 2, "{shown}");
    assert!(shown.contains("old.nc:1 stops with P-ERR-70495"), "{shown}");
    assert!(shown.contains("new.nc:1 stops with P-ERR-70495"), "{shown}");

    let endless = "X[COMP OFF FRICT]\n$WHILE 1\nG90\n$ENDWHILE\nM30\n";
    let (status, shown) = diff(endless, endless, &["--max-blocks", "50"]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(shown.contains("FC910"), "{shown}");

    let refused = "$WHILE 1\nX[COMP OFF FRICT]\nM30\n";
    let (status, shown) = diff(refused, refused, &[]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(shown.contains("not comparable: "), "{shown}");
}

#[test]
fn what_is_not_known_is_not_comparable() {
    // R1.37, R9.26
    let unknown = "$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nM30\n";
    let (status, shown) = diff(unknown, unknown, &[]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(
        shown.contains("not comparable: from old.nc:2 on, FRICT of X"),
        "{shown}"
    );
    let (status, shown) = diff(unknown, unknown, &["--set", "V.E.A=1"]);
    assert_eq!(status, Some(0), "{shown}");
    assert!(shown.starts_with("no difference"), "{shown}");

    let off = "X[COMP OFF FRICT]\nM30\n";
    let (status, shown) = diff(off, off, &["--isolated"]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(shown.starts_with("no machine is described"), "{shown}");
    assert!(
        shown.contains("not comparable: what old.nc:1 does"),
        "{shown}"
    );
    let (status, shown) = diff(off, off, &["--isolated", "--enable", "X"]);
    assert_eq!(status, Some(0), "{shown}");
}

#[test]
fn a_feed_move_without_compensation_is_a_difference() {
    // R18.22
    let old = "N10 G01 X1 F100\nN20 X[COMP OFF FRICT]\nN30 X2\nN40 X[COMP ON FRICT]\nN50 X3\nM30\n";
    let moved = old.replace(
        "N30 X2\nN40 X[COMP ON FRICT]",
        "N40 X[COMP ON FRICT]\nN30 X2",
    );
    let (status, shown) = diff(old, &moved, &[]);
    assert_eq!(status, Some(1), "{shown}");
    assert_eq!(
        shown,
        "1 feed move of X is no longer without compensation, from line 3 of the old version\n"
    );
    let (status, shown) = diff(&moved, old, &["--format", "json"]);
    assert_eq!(status, Some(1), "{shown}");
    let document: serde_json::Value = serde_json::from_str(&shown).expect("a document");
    assert_eq!(document["verdict"], "different");
    let move_of_x = serde_json::json!({ "version": "new", "axis": "X", "count": 1, "line": 3 });
    assert_eq!(document["moves"], serde_json::json!([move_of_x]));
    // Motion with compensation, and rapid motion, make no difference.
    let more = old
        .replace("N50 X3", "N50 X3\nN55 X4")
        .replace("N30 X2", "N25 G00 X5\nN30 G01 X2");
    assert_eq!(diff(old, &more, &[]).0, Some(0));
}

#[test]
fn a_silenced_message_makes_nothing_comparable() {
    // R9.81
    let bench = Bench::new(&[
        (
            "undescribed.nc",
            "X[COMP OFF FRICT] ; frictcomp: allow FC408\nM30\n",
        ),
        (
            "assumed.nc",
            "N1 $GOTO N[V.E.A] ; frictcomp: allow FC902\nN5 X[COMP OFF FRICT]\nN6 X[COMP ON FRICT]\nM30\n",
        ),
        ("still.nc", "G0 X1\nM30\n"),
    ]);
    let diff = |name: &str, arguments: &[&str]| {
        let output = bench.call(&[&["diff", name, name], arguments].concat());
        let shown = String::from_utf8(output.stdout).expect("text");
        (output.status.code(), shown)
    };
    let (status, shown) = diff("undescribed.nc", &["--isolated"]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(
        shown.contains("not comparable: what undescribed.nc does depends on a machine"),
        "{shown}"
    );
    let (status, shown) = diff("assumed.nc", &[]);
    assert_eq!(status, Some(1), "{shown}");
    assert!(shown.contains("not comparable: "), "{shown}");
    // A program that switches nothing does not depend on the machine.
    assert_eq!(diff("still.nc", &["--isolated"]).0, Some(0));
}

#[test]
fn a_comparison_is_a_document_and_a_page() {
    // R9.81, R9.71
    let bench = Bench::new(&[
        (
            "old.nc",
            "N10 X[COMP OFF FRICT]\nN20 X[COMP ON FRICT]\nM30\n",
        ),
        (
            "new.nc",
            "(<b>moved</b>)\nN10 X[COMP OFF FRICT]\nN15 Y[COMP OFF FRICT] (<i>)\nN20 X[COMP ON FRICT]\nZ[COMP ON FRICT]\n",
        ),
    ]);
    let output = bench.call(&[
        "diff", "old.nc", "new.nc", "--format", "json", "--html", "d.html", "-o", "d.json",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(output.stdout, b"");
    let document: serde_json::Value =
        serde_json::from_str(&bench.read("d.json")).expect("a document");
    assert_eq!(document["verdict"], "not-comparable");
    assert_eq!(document["common"], 2);
    let difference = &document["differences"][0];
    assert_eq!(difference["version"], "new");
    assert_eq!(
        (&difference["line"], &difference["n"]),
        (&3.into(), &15.into())
    );
    assert_eq!(
        (&difference["axis"], &difference["to"]),
        (&"Y".into(), &"inactive".into())
    );
    let obstacle = &document["obstacles"][0];
    assert_eq!(
        (&obstacle["reason"], &obstacle["code"]),
        (&"stopped".into(), &"P-ERR-70495".into())
    );
    assert_eq!(obstacle["line"], 5);
    let page = bench.read("d.html");
    for part in [
        "The versions cannot be compared as a whole.",
        "1 of 3 changes of state are in only one version.",
        "not comparable: new.nc:5 stops with P-ERR-70495",
        "+ new only",
        "(&lt;i&gt;)",
    ] {
        assert!(page.contains(part), "{part}\n{page}");
    }
    assert!(!page.contains("<i>"));
    let output = bench.call(&["diff", "old.nc", "new.nc", "-o", "new.nc"]);
    assert_eq!(output.status.code(), Some(2), "an output is an input");
}

#[test]
fn differences_are_shown_beside() {
    // R9.26: a lint that the user turned into an error stops nothing.
    let stops = "X[COMP OFF FRICT]\nZ[COMP ON FRICT]\nM30\n";
    let (status, shown) = diff("M30\n", stops, &[]);
    assert_eq!(status, Some(1));
    assert!(
        shown.contains("+      1  X FRICT: active → inactive"),
        "{shown}"
    );
    assert!(shown.contains("not comparable: new.nc:2"), "{shown}");
    let bench = Bench::new(&[("a.nc", "X[COMP OFF FRICT]\nM30\n")]);
    bench.write(
        "frictcomp.toml",
        &format!("{}[lint]\nFC401 = \"error\"\n", crate::folder::MACHINE),
    );
    assert_eq!(bench.status(&["diff", "a.nc", "a.nc"]), Some(0));
}

#[test]
fn equal_differences_are_counted() {
    // R18.22
    let new = "$FOR P1 = 1, 4, 1\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\n$ENDFOR\nM30\n";
    let (status, shown) = diff("M30\n", new, &[]);
    assert_eq!(status, Some(1));
    let lines: Vec<&str> = shown.lines().filter(|it| it.starts_with("+  ")).collect();
    assert_eq!(lines.len(), 2, "{shown}");
    assert!(lines.iter().all(|it| it.ends_with("(4 times)")), "{shown}");
    let (_, document) = diff("M30\n", new, &["--format", "json"]);
    let document = crate::folder::json(&document);
    let differences = document["differences"].as_array().expect("differences");
    let times: Vec<Option<u64>> = differences.iter().map(|it| it["times"].as_u64()).collect();
    assert_eq!(times, [Some(4), Some(4)]);
}
