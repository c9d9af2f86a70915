//! The extension for VS Code as described by its manifest, and the settings of other editors.

use serde_json::Value;

use crate::read;

fn manifest() -> Value {
    serde_json::from_str(&read("editors/vscode/package.json")).expect("JSON")
}

#[test]
fn the_extension_stands_beside_that_of_isg() {
    // R12.8, R12.12: highlighting needs neither the binary nor a trusted folder.
    let manifest = manifest();
    let languages = &manifest["contributes"]["languages"];
    let grammars = &manifest["contributes"]["grammars"];
    for (at, id, endings) in [
        (
            0,
            "frictcomp-nc",
            [".nc", ".cnc", ".cyc", ".sub", ".plc"].as_slice(),
        ),
        (1, "frictcomp-list", &[".lis"]),
    ] {
        assert_eq!(languages[at]["id"], id);
        assert_eq!(languages[at]["extensions"], serde_json::json!(endings));
        assert_eq!(grammars[at]["language"], id);
    }
    let server = read("editors/vscode/src/server.ts");
    assert!(server.contains("\"isg-cnc.vscode-isg-cnc\""));
    let stand_in = read("editors/vscode/test/browser/session.mjs");
    assert!(
        stand_in.contains("publisher: \"isg-cnc\"")
            && stand_in.contains("name: \"vscode-isg-cnc\"")
    );
    let breakpoints = manifest["contributes"]["breakpoints"]
        .as_array()
        .expect("languages");
    let programs: Vec<&Value> = breakpoints.iter().map(|it| &it["language"]).collect();
    assert_eq!(programs, ["isg-cnc", "frictcomp-nc"]);
}

#[test]
fn the_extension_and_the_server_have_commands_of_their_own() {
    // R12.8: VS Code registers the server's commands, and refuses a name that is already
    // registered.
    let manifest = manifest();
    let commands = manifest["contributes"]["commands"]
        .as_array()
        .expect("commands");
    let server = read("crates/editor/src/lsp/commands.rs");
    assert!(server.contains("\"frictcomp.showTimeline\""));
    for command in commands {
        assert!(
            !server.contains(&command["command"].to_string()),
            "{command}"
        );
    }
}

#[test]
fn the_extension_is_quiet_and_can_be_published() {
    // R12.13: nothing in a folder starts it, and it has each field that the Marketplace shows.
    let manifest = manifest();
    let events = manifest["activationEvents"].as_array().expect("events");
    let names = events.iter().filter_map(Value::as_str);
    assert!(names.clone().all(|it| !it.starts_with("workspaceContains")));
    for key in [
        "repository",
        "bugs",
        "homepage",
        "galleryBanner",
        "icon",
        "license",
    ] {
        assert!(manifest.get(key).is_some(), "{key}");
    }
    assert!(manifest.get("private").is_none());
    let steps = manifest["contributes"]["walkthroughs"][0]["steps"].as_array();
    for step in steps.expect("a walkthrough") {
        let page = step["media"]["markdown"].as_str().expect("a page");
        assert!(!read(&format!("editors/vscode/{page}")).is_empty());
    }
    for key in ["untrustedWorkspaces", "virtualWorkspaces"] {
        assert!(manifest["capabilities"].get(key).is_some(), "{key}");
    }
    let release = read(".github/workflows/release.yml");
    for publisher in ["@vscode/vsce@", "ovsx@"] {
        assert!(
            release.contains(publisher),
            "a job publishes it: {publisher}"
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
    let neovim = read("docs/assets/neovim.lua");
    assert!(
        neovim.contains(r#"cmd = { "frictcomp", "lsp" }"#),
        "{neovim}"
    );
    let documents = read("docs/editors.md");
    // R12.14, R18.5
    assert!(documents.contains("plc = \"isg-cnc\"") && !documents.contains("ecy"));
    assert!(documents.contains("command = \"frictcomp\"\nargs = [\"lsp\"]"));
    let endings = read("editors/vscode/package.json");
    for ending in ["nc", "cnc", "cyc", "sub", "plc", "lis"] {
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
