//! The repository as a whole: the direction of imports, bindings, editors, releases, dependencies.

mod architecture;
mod bindings;
mod editors;
mod release;
mod supply_chain;

use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The text of a file of the repository.
fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}
