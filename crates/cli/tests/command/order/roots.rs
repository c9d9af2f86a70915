//! Mending by one block in a file that many programs call (R10.8).

use std::fs;

use super::bench;
use crate::folder::Bench;

const HOME: &str = "X[COMP ON FRICT]";

/// Returns the output and the messages of `audit`.
fn audited(bench: &Bench, arguments: &[&str]) -> (String, String) {
    let output = bench.call(&[&["audit"], arguments].concat());
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("text");
    (text(&output.stdout), text(&output.stderr))
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
