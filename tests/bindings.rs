//! What the documents of the bindings promise is what the bindings have; their own tests run them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use frictcomp::report::{Csv, Positions, View};
use frictcomp::{Machine, SourceFile};

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

/// The names in the first column of the first table after a heading.
fn first_column<'a>(manual: &'a str, heading: &str) -> Vec<&'a str> {
    let (_, part) = manual.split_once(heading).expect("the heading");
    let rows = part.lines().skip_while(|line| !line.starts_with("| `"));
    let rows = rows.take_while(|line| line.starts_with('|'));
    rows.map(|row| row.split('`').nth(1).expect("a name"))
        .collect()
}

#[test]
fn the_python_manual_has_the_columns_of_the_timeline() {
    // R13.4
    let mut machine = Machine::enabled(["X"]);
    machine.axes.truncate(1);
    let program = SourceFile::new("a.nc", "N10 X1\nN20 M30\n");
    let mut csv = Vec::new();
    let mut sink = Csv::new(&mut csv, View::default()).with_positions(Positions::Shown);
    let _ = frictcomp::run(program, machine, &mut sink);
    drop(sink);
    let csv = String::from_utf8(csv).expect("text");
    let header: Vec<&str> = csv.lines().next().expect("a header").split(',').collect();
    let manual = read("docs/python.md");
    let mut promised = first_column(&manual, "## The columns of a timeline");
    promised.retain(|name| *name != "level"); // As in NDJSON.
    assert_eq!(promised, header);
    // The columns are made with the same names.
    let rows = read("bindings/python/src/timeline/rows.rs");
    for name in promised.iter().filter(|name| !name.starts_with('X')) {
        assert!(rows.contains(&format!("\"{name}\"")), "{name}");
    }
}

#[test]
fn the_python_manual_names_everything_that_is_exported() {
    // R13.4
    let (module, manual) = (
        read("bindings/python/python/frictcomp/__init__.py"),
        read("docs/python.md"),
    );
    let (_, exported) = module.split_once("__all__ = [").expect("names");
    let exported = exported.split('"').skip(1).step_by(2);
    let (_, names) = manual.split_once("## Names").expect("the heading");
    for name in exported {
        assert!(names.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn the_wheel_has_the_version_of_the_command() {
    // R13.4
    let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    for manifest in ["Cargo.toml", "pyproject.toml"] {
        let manifest = read(&format!("bindings/python/{manifest}"));
        assert!(manifest.contains(&version), "{manifest}");
    }
    assert!(read("bindings/python/pyproject.toml").contains("profile = \"binding\""));
}
