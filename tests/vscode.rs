//! The extension for VS Code, as far as its manifest says it.

use std::fs;
use std::path::Path;

use serde_json::Value;

fn manifest() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("editors/vscode/package.json");
    let text = fs::read_to_string(path).expect("a manifest");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn the_extension_stands_beside_that_of_isg() {
    // R12.8: a file ending or a name of ISG's would be declared twice.
    let manifest = manifest();
    let languages = manifest["contributes"]["languages"]
        .as_array()
        .expect("languages");
    for language in languages {
        for key in ["extensions", "filenames", "filenamePatterns", "firstLine"] {
            assert!(language.get(key).is_none(), "{language}");
        }
        let id = language["id"].as_str().expect("an id");
        assert!(id.starts_with("frictcomp-"), "{id}");
    }
    let breakpoints = manifest["contributes"]["breakpoints"]
        .as_array()
        .expect("languages");
    let programs: Vec<&Value> = breakpoints.iter().map(|it| &it["language"]).collect();
    assert_eq!(programs, ["isg-cnc", "frictcomp-nc"]);
}

#[test]
fn the_extension_has_the_version_of_the_command() {
    // R12.8
    assert_eq!(manifest()["version"], env!("CARGO_PKG_VERSION"));
}
