//! The JSON schemas of `frictcomp.toml` and of plant files, checked against the reader (R17.6).

use std::fs;
use std::path::{Path, PathBuf};

use crate::folder::{Bench, json};
use crate::workspace::{agree, files, root};
use frictcomp::machine::{Configuration, NoLists};
use frictcomp::text::SourceFile;
use frictcomp_physics::simulation::Plant;
use jsonschema::Validator;
use serde_json::Value;

fn validator(of: &str) -> Validator {
    let bench = Bench::new(&[]);
    let schema = json(&bench.stdout(&["config", "schema", of]));
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    jsonschema::meta::validate(&schema).expect("a schema");
    jsonschema::validator_for(&schema).expect("a schema")
}

fn fits(validator: &Validator, text: &str) -> bool {
    let value: Option<Value> = toml::from_str(text).ok();
    value.is_some_and(|value| validator.is_valid(&value))
}

fn is_configuration(text: &str) -> bool {
    Configuration::from_toml(SourceFile::new("frictcomp.toml", text), &mut NoLists).is_ok()
}

fn is_plant(text: &str) -> bool {
    Plant::from_toml(SourceFile::new("plant.toml", text)).is_ok()
}

/// Returns the TOML files of programs and documents.
fn configurations() -> Vec<PathBuf> {
    let mut found = files("programs", &["toml"]);
    found.extend(files("docs", &["toml"]));
    found
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("text")
}

/// Returns the example of the documents, which has every key.
fn whole() -> String {
    let page = read(&root().join("docs/configuration.md"));
    let (_, rest) = page.split_once("```toml\n").expect("an example");
    rest.split_once("```").expect("its end").0.to_owned()
}

#[test]
fn every_configuration_of_the_tree_fits_as_it_is_read() {
    // R17.6
    let validator = validator("config");
    let files = configurations();
    let mut refused = 0;
    let mut machines = 0;
    for path in files {
        let name = path.to_string_lossy().into_owned();
        let text = read(&path);
        if name.contains("plant") || is_plant(&text) && !is_configuration(&text) {
            continue;
        }
        machines += 1;
        refused += usize::from(!is_configuration(&text));
        assert_eq!(fits(&validator, &text), is_configuration(&text), "{name}");
    }
    assert!(machines > 10 && refused > 0, "{machines} {refused}");
    assert!(is_configuration(&whole()) && fits(&validator, &whole()));
}

#[test]
fn every_plant_of_the_tree_fits_as_it_is_read() {
    // R17.6
    let validator = validator("plant");
    let mut plants = 0;
    for path in configurations() {
        let text = read(&path);
        if is_configuration(&text) && !is_plant(&text) {
            continue;
        }
        if is_plant(&text) {
            plants += 1;
            assert!(fits(&validator, &text), "{}", path.display());
        }
    }
    assert!(plants >= 2, "{plants}");
    for text in [
        "m = 0",
        "m = \"a\"",
        "mass = 1",
        "[x]\nname = \"a\"",
        "base = \"soggy\"",
        "[stiction]\ntc = 1",
        "gms = 7",
        "gms = [[1]]",
        "[x.stiction]\nmp1511 = -1",
        "gms_C = 0",
    ] {
        assert!(!is_plant(text) && !fits(&validator, text), "{text}");
    }
    for text in [
        "",
        "m = 500\n[x]\nFs = 300\nFc = 200",
        "base = \"mid\"\n[y.stiction]\nmp1511 = 8000",
    ] {
        assert!(is_plant(text) && fits(&validator, text), "{text}");
    }
}

#[test]
fn a_wrong_value_is_refused_by_both() {
    // R17.6: each line of the example with values of every other form.
    let validator = validator("config");
    let whole = whole();
    let lines: Vec<&str> = whole.lines().collect();
    let mut refused = 0;
    for (at, line) in lines.iter().enumerate() {
        let Some((key, _)) = line.split_once(" = ") else {
            continue;
        };
        for value in [
            "\"text\"",
            "-1",
            "7.5",
            "true",
            "[1]",
            "[\"a\"]",
            "[[1, 2]]",
            "{ a = 1 }",
            "3",
        ] {
            let changed = format!("{key} = {value}");
            let mut text = lines.clone();
            text[at] = &changed;
            let text = text.join("\n");
            let (is_read, fits) = (is_configuration(&text), fits(&validator, &text));
            refused += usize::from(!is_read);
            // Only the reader can judge some texts: names, builds, severities of codes.
            let is_text = value.contains('"');
            assert!(
                is_read == fits || (fits && is_text),
                "{changed}: read {is_read}"
            );
        }
        let unknown = format!("{line}\nno_such_key = 1");
        let mut text = lines.clone();
        text[at] = &unknown;
        let text = text.join("\n");
        assert_eq!(
            fits(&validator, &text),
            is_configuration(&text),
            "{unknown}"
        );
    }
    assert!(refused > 100, "{refused}");
}

#[test]
fn words_are_taken_in_the_case_that_the_reader_takes() {
    // R17.6
    let validator = validator("config");
    for (text, is_right) in [
        ("[lint]\nfc402 = \"off\"", true),
        ("[lint]\nFC402 = \"OFF\"", false),
        ("[lint]\n\"P-ERR-70495\" = \"off\"", false),
        ("[lint]\nFC999 = \"off\"", false),
        (
            "[[axis]]\nname = \"X\"\ncompensations = [\"lead\", \"TEMP\"]",
            true,
        ),
        ("[[axis]]\nname = \"X\"\ncompensations = [\"LEAF\"]", false),
        ("[[axis]]\nname = \"X\"\ntype = \"t\"", false),
        ("[[axis]]\ntype = \"T\"", false),
        ("axis = [{ name = \"X\" }]", true),
        ("[axis]\nname = \"X\"", false),
        ("[machine]\nskip = [1, 11]", false),
        ("[machine]\nskip = 3\nkeep_parameters = 1", true),
        ("[variables]\n\"V.E.A\" = true", false),
        ("[variables]\n\"V.E.A\" = 1\n\"V.E.B\" = \"x\"", true),
    ] {
        assert_eq!(is_configuration(text), is_right, "{text}");
        assert_eq!(fits(&validator, text), is_right, "{text}");
    }
}

#[test]
fn the_extension_names_the_schema_that_the_command_prints() {
    // R17.6
    let bench = Bench::new(&[]);
    let manifest = json(&read(&root().join("editors/vscode/package.json")));
    let named = manifest["contributes"]["tomlValidation"]
        .as_array()
        .expect("schemas");
    for (at, of) in ["config", "plant"].iter().enumerate() {
        let url = named[at]["url"].as_str().expect("a file");
        let path = root().join("editors/vscode").join(url);
        let printed = bench.stdout(&["config", "schema", of]);
        agree(&path, &printed);
    }
}
