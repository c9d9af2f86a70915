//! What the documents of the bindings promise is what the bindings have; their own tests run them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The functions that a text names.
fn functions(text: &str) -> BTreeSet<&str> {
    let words = text.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    words
        .filter(|word| word.starts_with("frictcomp_"))
        .collect()
}

#[test]
fn the_c_manual_names_every_function_of_the_header() {
    // R13.5
    let (header, manual) = (read("bindings/c/include/frictcomp.h"), read("docs/c.md"));
    let mut named = functions(&manual);
    named.remove("frictcomp_c"); // The name of the library.
    assert_eq!(functions(&header), named);
}

#[test]
fn no_panic_crosses_the_border_to_c() {
    // R13.5
    let library = read("bindings/c/src/lib.rs");
    assert!(library.contains("#[cfg(panic = \"abort\")]\ncompile_error!"));
    assert!(read("bindings/c/build").contains("--profile binding"));
    // One file alone touches pointers.
    assert!(read("bindings/c/Cargo.toml").contains("unsafe_code = \"deny\""));
    for file in ["lib", "machine", "compensation", "failure"] {
        let source = read(&format!("bindings/c/src/{file}.rs"));
        assert!(!source.contains("unsafe"), "{file}");
    }
}
