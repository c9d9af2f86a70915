//! What every host may rely on: the names that are public, and that all of it can be sent to another
//! thread.

#[path = "public/sent.rs"]
mod sent;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The text of a source file without comments.
fn code(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(path);
    let text = fs::read_to_string(&path).expect("a source file");
    let lines = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(line));
    lines.collect::<Vec<_>>().join("\n")
}

/// What the statements of a file make public.
struct Public {
    name: String,
    /// The feature that it needs, or nothing.
    feature: String,
    is_room: bool,
}

fn public(code: &str) -> Vec<Public> {
    let mut found = Vec::new();
    let mut feature = "";
    for statement in code.split_inclusive([';', ']']) {
        let statement = statement.trim();
        if let Some(rest) = statement.strip_prefix("#[cfg(feature = \"") {
            feature = rest.trim_end_matches("\")]");
            continue;
        }
        let names = statement
            .strip_prefix("pub use ")
            .or_else(|| statement.strip_prefix("pub mod "));
        if let Some(names) = names.map(|names| names.trim_end_matches(';')) {
            let names = names.split_once('{').map_or_else(
                || names.rsplit("::").next().unwrap_or(names),
                |(_, names)| names.trim_end_matches('}'),
            );
            for name in names
                .split(',')
                .map(str::trim)
                .filter(|name| !name.is_empty())
            {
                let name = name.rsplit(" as ").next().unwrap_or(name);
                found.push(Public {
                    name: name.to_owned(),
                    feature: feature.to_owned(),
                    is_room: statement.starts_with("pub mod "),
                });
            }
        }
        feature = "";
    }
    found
}

/// Every public name with its room and the feature that it needs, sorted.
fn items() -> Vec<String> {
    let mut items = Vec::new();
    gather("", "", &mut items);
    items.sort();
    items
}

/// Appends what the face of a room makes public, and the rooms in it.
fn gather(room: &str, needed: &str, items: &mut Vec<String>) {
    let face = if room.is_empty() {
        "lib.rs".to_owned()
    } else {
        format!("{room}/mod.rs")
    };
    for item in public(&code(&face)) {
        let feature = match item.feature.as_str() {
            "" => needed,
            feature => feature,
        };
        let path = format!("{room}/{}", item.name);
        let path = path.trim_start_matches('/');
        if item.is_room && has_face(path) {
            gather(path, feature, items);
            continue;
        }
        let path = path.replace('/', "::");
        items.push(if feature.is_empty() {
            path
        } else {
            format!("{path} ({feature})")
        });
    }
}

fn has_face(path: &str) -> bool {
    let face = format!("src/{path}/mod.rs");
    Path::new(env!("CARGO_MANIFEST_DIR")).join(face).is_file()
}

#[test]
fn the_public_names_change_on_purpose() {
    // `INSTA_UPDATE=always cargo test --test public` takes a change over.
    insta::assert_snapshot!("public_items", items().join("\n"));
}

#[test]
fn a_type_has_a_name_of_its_own() {
    let mut rooms: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for item in items() {
        // The nodes of the tree are named within it.
        if item.ends_with("(unstable)") {
            continue;
        }
        let item = item.split(' ').next().expect("a path");
        let Some((room, name)) = item.rsplit_once("::") else {
            continue;
        };
        let face = code(&format!("{}/mod.rs", room.replace("::", "/")));
        let is_word = |statement: &str| {
            let mut words = statement.split(|c: char| !c.is_alphanumeric() && c != '_');
            words.any(|word| word == name)
        };
        // What a room shows of another one is the same thing.
        let mut shown = face
            .split(';')
            .filter(|statement| statement.contains("pub use crate::"));
        if name.starts_with(|c: char| c.is_uppercase()) && !shown.any(is_word) {
            rooms
                .entry(name.to_owned())
                .or_default()
                .push(room.to_owned());
        }
    }
    rooms.retain(|_, rooms| rooms.len() > 1);
    assert_eq!(rooms, BTreeMap::new());
}

/// Whether a public name is that of a trait.
fn is_trait(name: &str) -> bool {
    const TRAITS: [&str; 12] = [
        "ContourSink",
        "CurrentSink",
        "Finder",
        "LineSource",
        "ListFiles",
        "Observer",
        "Report",
        "Simulations",
        "Sources",
        "Sink",
        "TraceSink",
        "Watcher",
    ];
    TRAITS.contains(&name)
}

#[test]
fn every_public_type_is_checked_to_be_send() {
    let is_type = |item: &String| {
        let name = item.rsplit("::").next().unwrap_or(item);
        item.contains("::")
            && name.starts_with(|c: char| c.is_ascii_uppercase())
            && name.contains(|c: char| c.is_ascii_lowercase())
            && !is_trait(name)
    };
    let public = items().into_iter().map(|item| {
        let path = item.split(' ').next().unwrap_or_default();
        path.to_owned()
    });
    // They borrow what flushes the output of the thread that runs the programs.
    let is_at_home = |item: &String| item == "host::Surroundings";
    let public: Vec<String> = public
        .filter(|item| is_type(item) && !is_at_home(item))
        .collect();
    let sent: Vec<String> = sent::SENT
        .iter()
        .map(|name| name.split('<').next().unwrap_or(name).replace(' ', ""))
        .collect();
    assert_eq!(sent, public, "the list in tests/public/sent.rs");
}
