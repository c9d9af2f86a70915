//! The pictures that commands draw.

use std::fs;
use std::path::Path;

use crate::folder::{call, succeeded};
use frictcomp_testing::svg::{read, sound, texts};

/// Runs the tool in a folder and gives the picture that it draws there.
fn drawn(folder: &Path, arguments: &[&str]) -> String {
    succeeded(folder, arguments);
    let svg = fs::read_to_string(folder.join("out.svg")).expect("a picture");
    sound(&svg);
    svg
}

#[test]
fn commands_draw_what_they_compute() {
    // R5.23
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write(
        "frictcomp.toml",
        "[[axis]]\nname = \"X\"\nfrict_comp = true\n\
         value = { mode = 3, position_delay = 10, reversal_lookahead = 2, table = [[0, 12], [1800, 10]] }\n",
    );
    write("v.lis", LIST);
    write(
        "t.csv",
        "t,x,v,comp\n0,0,0,on\n0.001,10,1000,on\n0.002,20,1000,off\n0.003,30,1000,on\n",
    );
    write(
        "a.nc",
        "N10 G90 G01 X0 F1000\nN20 X1\nN30 X[COMP OFF FRICT]\nN40 X0\nN50 X[COMP ON FRICT]\nN60 X1\nN70 M30\n",
    );
    let draw = |arguments: &[&str]| drawn(folder.path(), arguments);
    let svg = draw(&["lists", "--svg", "out.svg", "v.lis"]);
    assert!(svg.contains("Value list of axis X"), "{svg}");
    let recorded = [
        "current",
        "--recording",
        "t.csv",
        "--value-list",
        "v.lis",
        "--svg",
        "out.svg",
    ];
    let svg = draw(&recorded);
    let document = read(&svg);
    let shown = texts(&document);
    for wanted in [
        "active",
        "inactive",
        "additive current in drive units",
        "time in s",
    ] {
        assert!(shown.contains(&wanted), "no `{wanted}` in {shown:?}");
    }
    let svg = draw(&[
        "current", "a.nc", "--axis", "X", "--svg", "out.svg", "-o", "a.csv",
    ]);
    assert!(svg.contains("Additive current of axis X"));
    assert!(svg.contains("X inactive from"), "{svg}");
    let svg = draw(&[
        "circle", "--feed", "5000", "--radius", "50", "--svg", "out.svg",
    ]);
    let document = read(&svg);
    let shown = texts(&document);
    // R5.30
    for wanted in [
        "compensation off (clockwise in fine dashes)",
        "compensation on (clockwise in fine dashes)",
        "on: largest glitch 1.8 \u{b5}m, magnified",
        "X+",
        "Y\u{2212}",
    ] {
        assert!(shown.contains(&wanted), "no `{wanted}` in {shown:?}");
    }
}

/// A value list of the axis X.
const LIST: &str = "kopf.achs_nr 1\nkopf.log_achs_name X\nfrict_comp.mode 3\nfrict_comp.table_entries 2\n\
    frict_comp.position_delay 10\nfrict_comp.reversal_lookahead 2\n\
    frict_comp.table[0].in 0\nfrict_comp.table[0].out 12\n\
    frict_comp.table[1].in 1800\nfrict_comp.table[1].out 10\n";

#[test]
fn there_is_no_picture_of_a_list_that_is_not_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(
        folder.path().join("v.lis"),
        LIST.replace("mode 3", "mode 0"),
    )
    .expect("written");
    let output = call(folder.path(), &["lists", "--svg", "out.svg", "v.lis"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no value list to draw"));
    assert!(!folder.path().join("out.svg").exists());
}
