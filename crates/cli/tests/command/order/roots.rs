//! One block in a file that many programs call (R10.8).

use std::fs;

use super::{bench, text};
use crate::folder::Bench;

const HOME: &str = "X[COMP ON FRICT]";

/// The output and the messages of `audit`.
fn audited(bench: &Bench, arguments: &[&str]) -> (String, String) {
    let output = bench.call(&[&["audit"], arguments].concat());
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("text");
    (text(&output.stdout), text(&output.stderr))
}

/// The files that a difference changes.
fn changed(difference: &str) -> Vec<String> {
    let names = difference
        .lines()
        .filter_map(|line| line.strip_prefix("+++ "));
    names
        .map(|name| name.trim_start_matches("./").replace('\\', "/"))
        .collect()
}

fn hazards(bench: &Bench) -> String {
    let shown = text(bench, &["audit", "."]);
    let last = shown.lines().last();
    last.unwrap_or_default().to_owned()
}

#[test]
fn one_block_in_a_subprogram_mends_its_callers() {
    // R10.8: also where only the callers are named.
    let caller = "N10 G01 X10 F200\nN20 L tool.nc\nN30 M30\n";
    let tool = "N10 X[COMP OFF FRICT]\nN20 G01 X5 F100\nN30 M17\n";
    for named in [&["."][..], &["a.nc", "b.nc", "c.nc"]] {
        let bench = bench(&[
            ("a.nc", caller),
            ("b.nc", caller),
            ("c.nc", caller),
            ("tool.nc", tool),
        ]);
        let (shown, said) = audited(&bench, &[&["--diff=leavers"], named].concat());
        assert_eq!(changed(&shown), ["tool.nc"], "{shown}{said}");
        assert!(
            said.contains("tool.nc: this mends 3 programs that call it: "),
            "{said}"
        );
        let is_unnamed = said.contains("; programs that were not audited may call it, too\n");
        assert_eq!(is_unnamed, named.len() > 1, "{said}");
        audited(&bench, &[&["--fix=leavers"], named].concat());
        let mended = "N10 X[COMP OFF FRICT]\nN20 G01 X5 F100\nN25 X[COMP ON FRICT]\nN30 M17\n";
        assert_eq!(bench.read("tool.nc"), mended);
        assert_eq!(bench.read("a.nc"), caller);
        assert!(
            hazards(&bench).contains("in no order does one"),
            "{}",
            hazards(&bench)
        );
    }
}

#[test]
fn bytes_of_a_mended_subprogram_stay() {
    // R10.8, R10.3
    for (end, comment) in [
        ("\r\n", &b"; Gr\xf6\xdfe"[..]),
        ("\r", b"(\xfc)"),
        ("\n", "; Größe".as_bytes()),
    ] {
        let caller = format!("%MAIN{end}G01 X1 F100{end}L SUB/tool.nc{end}M30{end}");
        let caller = caller.as_str();
        let bench = bench(&[("a.nc", caller), ("b.nc", caller)]);
        let path = bench.folder().join("sub/tool.nc");
        fs::create_dir(bench.folder().join("sub")).expect("a folder");
        let [head, tail] = [
            "n010 X[comp off frict] ".to_owned(),
            format!("{end}n020 m17"),
        ];
        let before = [head.as_bytes(), comment, tail.as_bytes()].concat();
        fs::write(&path, before).expect("written");
        let (_, said) = audited(&bench, &["--fix=leavers", "."]);
        let block = format!("{end}N015 {HOME}");
        let after = [head.as_bytes(), comment, block.as_bytes(), tail.as_bytes()].concat();
        let found = fs::read(&path).expect("bytes");
        assert_eq!(
            String::from_utf8_lossy(&found),
            String::from_utf8_lossy(&after),
            "{said}"
        );
        assert_eq!(found, after);
    }
}

#[test]
fn a_caller_that_needs_it_otherwise_is_named_and_nothing_is_changed_for_it() {
    // R10.8
    let caller = "G01 X10 F200\nL tool.nc\nM30\n";
    let needs = "L tool.nc\nG01 X20 F200\nX[COMP ON FRICT]\nM30\n";
    let tool = "X[COMP OFF FRICT]\nG01 X5 F100\nM17\n";
    let bench = bench(&[
        ("a.nc", caller),
        ("b.nc", caller),
        ("needs.nc", needs),
        ("tool.nc", tool),
    ]);
    let (shown, said) = audited(&bench, &["--diff=leavers", "."]);
    assert_eq!(changed(&shown), ["a.nc", "b.nc"], "{shown}{said}");
    assert!(
        said.contains(
            "tool.nc: a block that mends this would change the state in which axes move in `needs.nc`, \
             which calls it; write `X[COMP ON FRICT]` wherever it is needed by hand, or take the block with `--unsafe`\n"
        ),
        "{said}"
    );
    assert!(!said.contains("this mends"), "{said}");
    // Only with `--unsafe`, and the program whose motion changes is named.
    let (shown, said) = audited(&bench, &["--diff=leavers", "--unsafe", "."]);
    assert_eq!(changed(&shown), ["tool.nc"], "{shown}{said}");
    let changes = "tool.nc: a block changes the state in which axes move in needs.nc\n";
    assert!(said.contains(changes), "{said}");
    assert_eq!(bench.status(&["audit", "--unsafe", "."]), Some(2));
}

#[test]
fn the_innermost_file_that_can_be_mended_is_the_proposal() {
    // R10.8
    let caller = "G01 X10 F200\nL mid.nc\nM30\n";
    let leaf = "X[COMP OFF FRICT]\nM17\n";
    // `mid.nc` moves as `leaf.nc` leaves the axis.
    let moves = "L leaf.nc\nG01 X5 F100\nM17\n";
    let quiet = "L leaf.nc\nG04 1\nM17\n";
    for (mid, root) in [(moves, "mid.nc"), (quiet, "leaf.nc")] {
        let programs = [
            ("a.nc", caller),
            ("b.nc", caller),
            ("mid.nc", mid),
            ("leaf.nc", leaf),
        ];
        let bench = bench(&programs);
        let (shown, said) = audited(&bench, &["--diff=leavers", "."]);
        assert_eq!(changed(&shown), [root], "{shown}{said}");
        let mended = if root == "leaf.nc" {
            "3 programs"
        } else {
            "2 programs"
        };
        assert!(
            said.contains(&format!("{root}: this mends {mended} that call it: ")),
            "{said}"
        );
    }
}

#[test]
fn a_subprogram_with_several_returns_is_mended_at_each() {
    // R10.8
    let caller = |value| format!("V.P.KIND = {value}\nG01 X10 F200\nL tool.nc\nM30\n");
    let (one, two) = (caller(1), caller(2));
    let tool = "X[COMP OFF FRICT]\n$IF V.P.KIND == 1\nG01 X1 F100\nM17\n$ENDIF\nG01 X2 F100\nM17\n";
    let bench = bench(&[
        ("a.nc", one.as_str()),
        ("b.nc", two.as_str()),
        ("tool.nc", tool),
    ]);
    let (_, said) = audited(&bench, &["--fix=leavers", "a.nc", "b.nc"]);
    let mended = "X[COMP OFF FRICT]\n$IF V.P.KIND == 1\nG01 X1 F100\nX[COMP ON FRICT]\nM17\n$ENDIF\nG01 X2 F100\nX[COMP ON FRICT]\nM17\n";
    assert_eq!(bench.read("tool.nc"), mended, "{said}");
    assert_eq!(bench.read("a.nc"), one);
}

#[test]
fn a_subprogram_without_a_return_is_mended_at_its_end() {
    // R10.8
    let caller = "G01 X10 F200\nL tool.nc\nM30\n";
    let tool = "G01 X5 F100\nX[COMP OFF FRICT]\n";
    let bench = bench(&[("a.nc", caller), ("b.nc", caller), ("tool.nc", tool)]);
    let (_, said) = audited(&bench, &["--fix=leavers", "."]);
    assert_eq!(bench.read("tool.nc"), format!("{tool}{HOME}\n"), "{said}");
    assert_eq!(bench.read("a.nc"), caller);
}

#[test]
fn a_motion_in_a_subprogram_is_mended_there() {
    // R10.8: one that switches off on purpose before its call needs it otherwise.
    let caller = "L tool.nc\nM30\n";
    let leaver = "X[COMP OFF FRICT]\nM30\n";
    let tool = "G04 1\nG01 X5 F100\nM17\n";
    let needs = "X[COMP OFF FRICT]\nL tool.nc\nM30\n";
    let mut programs = vec![
        ("a.nc", caller),
        ("b.nc", caller),
        ("leaver.nc", leaver),
        ("tool.nc", tool),
    ];
    let (shown, said) = audited(&bench(&programs), &["--diff=inheritors", "."]);
    assert_eq!(changed(&shown), ["tool.nc"], "{shown}{said}");
    assert!(
        shown.contains(" G04 1\n+X[COMP ON FRICT]\n G01 X5 F100\n"),
        "{shown}"
    );
    programs.push(("needs.nc", needs));
    let (shown, said) = audited(&bench(&programs), &["--diff=inheritors", "."]);
    assert_eq!(changed(&shown), ["a.nc", "b.nc"], "{shown}{said}");
    assert!(said.contains("in `needs.nc`, which calls it"), "{said}");
}

#[test]
fn the_only_caller_is_mended_in_its_own_text() {
    // R10.8: no output blames the subprogram.
    let bench = bench(&[
        ("a.nc", "G01 X10 F200\nL tool.nc\nM30\n"),
        ("tool.nc", "X[COMP OFF FRICT]\nM17\n"),
    ]);
    let (shown, said) = audited(&bench, &["--diff=leavers", "a.nc"]);
    assert_eq!(changed(&shown), ["a.nc"], "{shown}{said}");
}
