//! The extension for VS Code as far as its manifest says it, and the settings of other editors.

use std::fs;
use std::path::Path;

use serde_json::Value;

fn file(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    fs::read_to_string(path).expect(name)
}

fn manifest() -> Value {
    serde_json::from_str(&file("editors/vscode/package.json")).expect("JSON")
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
fn the_extension_and_the_server_have_commands_of_their_own() {
    // R12.8: VS Code registers those of the server, and refuses a name that is registered already.
    let manifest = manifest();
    let commands = manifest["contributes"]["commands"]
        .as_array()
        .expect("commands");
    let server = file("src/lsp/commands.rs");
    assert!(server.contains("\"frictcomp.showTimeline\""));
    for command in commands {
        assert!(
            !server.contains(&command["command"].to_string()),
            "{command}"
        );
    }
}

#[test]
fn the_extension_has_the_version_of_the_command() {
    // R12.8
    assert_eq!(manifest()["version"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn other_editors_start_the_same_server_for_the_same_files() {
    // R12.10: `scripts/neovim-test` opens a program with the first of these.
    let neovim = file("docs/neovim.lua");
    assert!(
        neovim.contains(r#"cmd = { "frictcomp", "lsp" }"#),
        "{neovim}"
    );
    let documents = file("docs/editors.md");
    assert!(documents.contains("command = \"frictcomp\"\nargs = [\"lsp\"]"));
    let endings = file("editors/vscode/src/languages.ts");
    for ending in ["nc", "cnc", "cyc", "ecy", "sub", "plc", "lis"] {
        assert!(documents.contains(&format!("\"{ending}\"")), "{ending}");
        assert!(endings.contains(&format!("\".{ending}\"")), "{ending}");
    }
}

#[test]
fn a_folder_that_is_not_trusted_chooses_no_program() {
    // R12.8
    let manifest = manifest();
    let settings = &manifest["contributes"]["configuration"]["properties"];
    assert_eq!(settings["frictcomp.path"]["scope"], "machine");
    let untrusted = &manifest["capabilities"]["untrustedWorkspaces"];
    assert_eq!(untrusted["supported"], "limited");
    assert_eq!(untrusted["restrictedConfigurations"][0], "frictcomp.path");
}
