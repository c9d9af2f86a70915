//! The dependencies of the crate: each has its reason, and none needs a newer Rust than the crate
//! promises.

use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::root;

/// Returns the major and minor number of a Rust version, `1.89` or `1.89.0`.
fn rust_version(text: &str) -> (u32, u32) {
    let mut numbers = text.split('.').map(|part| part.parse().expect("a number"));
    let mut next = || numbers.next().expect("two numbers");
    (next(), next())
}

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("cargo starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn no_dependency_needs_a_younger_rust() {
    // Dependencies of other systems are not downloaded here.
    let version = cargo(&["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.expect("cargo names the host");
    // `--locked`: the lock file must match the manifest.
    let options = ["--format-version=1", "--locked", "--filter-platform", host];
    let metadata = cargo(&[&["metadata"], &options[..]].concat());
    let metadata: Value = serde_json::from_str(&metadata).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let promised = rust_version(env!("CARGO_PKG_RUST_VERSION"));
    let younger: Vec<_> = packages
        .iter()
        .filter_map(|package| {
            let version = package["rust_version"].as_str()?;
            (rust_version(version) > promised)
                .then(|| format!("{} needs {version}", package["name"]))
        })
        .collect();
    assert!(younger.is_empty(), "{younger:?}");
}

#[test]
fn every_dependency_has_its_reason() {
    let parents = ["bindings", "crates"].map(|parent| root().join(parent));
    let packages = parents
        .iter()
        .flat_map(|parent| fs::read_dir(parent).expect("a folder"));
    let folders = packages.map(|entry| entry.expect("an entry").path());
    for folder in folders.chain([root().to_owned()]) {
        let path = folder.join("Cargo.toml");
        let manifest = fs::read_to_string(&path).expect("a manifest");
        let bare = without_reason(&manifest);
        let manifest = path.display();
        assert!(
            bare.is_empty(),
            "{manifest}: no reason is given for {bare:?}"
        );
    }
}

/// Returns the dependencies of a manifest that have no comment above them.
fn without_reason(manifest: &str) -> Vec<&str> {
    let mut section = "";
    let mut reasoned = false;
    let mut bare = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line;
            reasoned = false;
        } else if line.starts_with('#') {
            reasoned = true;
        } else if line.is_empty() {
            reasoned = false;
        } else if section == "[dependencies]" && !reasoned {
            bare.push(line);
        }
    }
    bare
}
