//! `diff`: versions that cannot be compared as a whole are reported as such.

use crate::folder::Bench;

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
