//! The header that C hosts compile with is the one that the functions give.

use std::fs;
use std::path::Path;

#[test]
fn the_header_is_that_of_the_functions() {
    // R13.5
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_root_or_default(root);
    let made = cbindgen::generate_with_config(root, config).expect("the functions are readable");
    let mut header = Vec::new();
    made.write(&mut header);
    let header = String::from_utf8(header).expect("text");
    let path = root.join("include/frictcomp.h");
    if std::env::var_os("UPDATE_HEADER").is_some() {
        fs::write(&path, &header).expect("written");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == header,
        "the header is not that of the functions: `UPDATE_HEADER=1 cargo test -p frictcomp-c`"
    );
}

#[test]
fn the_header_has_the_version_of_the_library() {
    // R13.14
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let header = fs::read_to_string(root.join("include/frictcomp.h")).expect("the header");
    for (name, value) in [
        (
            "FRICTCOMP_VERSION_MAJOR",
            env!("CARGO_PKG_VERSION_MAJOR").to_owned(),
        ),
        (
            "FRICTCOMP_VERSION_MINOR",
            env!("CARGO_PKG_VERSION_MINOR").to_owned(),
        ),
        (
            "FRICTCOMP_VERSION_PATCH",
            env!("CARGO_PKG_VERSION_PATCH").to_owned(),
        ),
        (
            "FRICTCOMP_VERSION",
            format!("\"{}\"", env!("CARGO_PKG_VERSION")),
        ),
    ] {
        assert!(
            header.contains(&format!("#define {name} {value}\n")),
            "{name}"
        );
    }
}
