//! Windows resources of `frictcomp.exe`: its icon, and version and product among its properties.

#![allow(
    clippy::print_stdout,
    reason = "Cargo reads what a build script prints"
)]

use std::env;

/// Puts them into an executable for Windows. Without a resource compiler it has none, and runs all the same.
fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=frictcomp.ico");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("windows") {
        return;
    }
    let mut resource = winresource::WindowsResource::new();
    resource
        .set_icon("frictcomp.ico")
        .set("ProductName", "frictcomp")
        .set("FileDescription", "frictcomp")
        .set("OriginalFilename", "frictcomp.exe")
        .set("LegalCopyright", "MIT or Apache 2.0");
    if let Err(error) = resource.compile() {
        println!("cargo::warning=frictcomp.exe has neither icon nor version: {error}");
    }
}
