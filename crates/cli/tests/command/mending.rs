//! `check --fix` and `check --diff`: the changes that are made, and that nothing else is touched.

use std::fs;

use crate::folder::Bench;

fn status(bench: &Bench, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = bench.call(arguments);
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

/// Returns the bytes of a program after `--fix`.
fn fixed(bytes: &[u8]) -> Vec<u8> {
    let bench = Bench::new(&[]);
    let path = bench.folder().join("a.nc");
    fs::write(&path, bytes).expect("written");
    let (status, shown, said) = status(&bench, &["check", "--fix", "a.nc"]);
    assert_eq!(status, Some(0), "{shown}{said}");
    fs::read(&path).expect("bytes")
}

#[test]
fn safe_changes_touch_nothing_else() {
    // R9.82: code pages, byte order marks, line ends, a last line without one.
    let cases: [(&[u8], &[u8]); 5] = [
        (
            b"%A (\xdcbung \x81)\r\n\tX[COMP off frict]  \r\nX[COMP ON FRICT] (\xe4)\r\nM30",
            b"%A (\xdcbung \x81)\r\n\tX[COMP OFF FRICT]  \r\nX[COMP ON FRICT] (\xe4)\r\nM30",
        ),
        (
            b"\xef\xbb\xbf(\xc3\x9c)\rX[COMP off FRICT] (\xc3\x9c)\rX[COMP ON FRICT] M30\r",
            b"\xef\xbb\xbf(\xc3\x9c)\rX[COMP OFF FRICT] (\xc3\x9c)\rX[COMP ON FRICT] M30\r",
        ),
        (
            b"\xff\xfeg\x000\0 \0X\x001\0\n\0M\x003\x000\0",
            b"\xff\xfeG\x000\0 \0X\x001\0\n\0M\x003\x000\0",
        ),
        (
            b"G0 X1 ; frictcomp: allow FC402 (\xdc)\r\n\r\n\r\nM30\r\n\x03",
            b"G0 X1\r\n\r\n\r\nM30\r\n\x03",
        ),
        (
            b"g0 X1\n(\xdc)\ng1 X2 (\xdc) f100\nm30",
            b"G0 X1\n(\xdc)\nG1 X2 (\xdc) F100\nM30",
        ),
    ];
    for (before, after) in cases {
        let found = fixed(before);
        let shown = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert_eq!(shown(&found), shown(after));
        assert_eq!(found, after);
    }
}

#[test]
fn a_difference_shows_the_changes_and_makes_none() {
    // R9.82
    let text = "N10 G90\r\nN20 X[COMP off FRICT]\r\nN30 X[COMP ON FRICT]\r\nN40 M30\r\n";
    let bench = Bench::new(&[("a.nc", text), ("b.nc", "M30\n")]);
    let (code, shown, said) = status(&bench, &["check", "--diff", "."]);
    assert_eq!(code, Some(1), "{said}");
    assert_eq!(
        shown,
        "--- ./a.nc\n+++ ./a.nc\n@@ -1,4 +1,4 @@\n N10 G90\n-N20 X[COMP off FRICT]\n\
         +N20 X[COMP OFF FRICT]\n N30 X[COMP ON FRICT]\n N40 M30\n"
            .replace(
                "./",
                if shown.starts_with("--- ./") {
                    "./"
                } else {
                    ""
                }
            )
    );
    assert!(
        said.contains("1 change in 1 file (`--fix` applies it)"),
        "{said}"
    );
    assert_eq!(bench.read("a.nc"), text);
    assert_eq!(status(&bench, &["check", "--diff", "b.nc"]).0, Some(0));
    assert_eq!(
        status(&bench, &["check", "--diff", "missing.nc"]).0,
        Some(2)
    );
    for (name, shown) in [("-", "standard input"), ("/dev/null", "`/dev/null`")] {
        if name != "-" && cfg!(windows) {
            continue;
        }
        let (code, _, said) = status(&bench, &["check", "--fix", name]);
        assert_eq!(code, Some(2));
        assert!(
            said.contains(&format!("`--fix` cannot change {shown}")),
            "{said}"
        );
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_be_written_stays_and_is_named() {
    // R9.82, R9.70
    use std::os::unix::fs::PermissionsExt;

    let bench = Bench::new(&[
        ("a.nc", "X[COMP on FRICT]\nM30\n"),
        ("b.nc", "X[COMP on FRICT]\nM30\n"),
    ]);
    let path = bench.folder().join("a.nc");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).expect("read-only");
    let (code, _, said) = status(&bench, &["check", "--fix", "a.nc", "b.nc"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("a.nc"), "{said}");
    assert_eq!(bench.read("a.nc"), "X[COMP on FRICT]\nM30\n");
    assert_eq!(bench.read("b.nc"), "X[COMP ON FRICT]\nM30\n");
}
