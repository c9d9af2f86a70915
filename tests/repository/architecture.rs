//! The direction of imports, and the words that are forbidden in rooms.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::{root, rust_files};

/// The rooms that each room of a package may import from. Rooms are listed in the order of the data; an import never
/// goes down. The packages that a package may use are in its `Cargo.toml`.
const ROOMS: [(&str, &[&str]); 31] = [
    ("text", &[]),
    ("diagnostic", &["text"]),
    ("comp", &["text", "diagnostic"]),
    ("readings", &["comp"]),
    ("language", &["readings"]),
    (
        "syntax",
        &["text", "diagnostic", "comp", "readings", "language"],
    ),
    (
        "lists",
        &["text", "diagnostic", "comp", "language", "syntax"],
    ),
    ("drive_interface", &["text", "diagnostic", "lists"]),
    (
        "config",
        &["text", "diagnostic", "comp", "readings", "syntax", "lists"],
    ),
    (
        "machine",
        &[
            "text",
            "diagnostic",
            "comp",
            "readings",
            "language",
            "syntax",
            "lists",
            "drive_interface",
            "config",
        ],
    ),
    (
        "interpreter",
        &[
            "text",
            "diagnostic",
            "comp",
            "readings",
            "language",
            "syntax",
            "lists",
            "machine",
        ],
    ),
    (
        "lint",
        &[
            "text",
            "diagnostic",
            "comp",
            "readings",
            "syntax",
            "machine",
            "interpreter",
        ],
    ),
    (
        "timeline",
        &[
            "text",
            "diagnostic",
            "comp",
            "readings",
            "syntax",
            "machine",
            "interpreter",
            "lint",
        ],
    ),
    (
        "session",
        &[
            "text",
            "diagnostic",
            "comp",
            "readings",
            "syntax",
            "lists",
            "machine",
            "interpreter",
            "lint",
            "timeline",
        ],
    ),
    (
        "audit",
        &[
            "text",
            "diagnostic",
            "comp",
            "readings",
            "syntax",
            "machine",
            "interpreter",
            "timeline",
        ],
    ),
    (
        "facade",
        &["text", "machine", "interpreter", "timeline", "session"],
    ),
    ("motion", &[]),
    ("current", &["motion"]),
    ("currents", &["current"]),
    ("stiction", &[]),
    ("simulation", &["stiction"]),
    ("linear", &[]),
    ("circle", &["current", "linear", "stiction", "simulation"]),
    ("contour", &["motion", "current", "simulation"]),
    ("compare", &["contour"]),
    ("trace", &[]),
    ("identify", &["trace"]),
    ("commission", &["trace", "identify"]),
    ("evidence", &[]),
    ("replay", &[]),
    ("value_lists", &[]),
];

/// A package: its folder, and the name of its single room if it has no rooms.
const PACKAGES: [(&str, Option<&str>); 7] = [
    (".", None),
    ("crates/physics", None),
    ("crates/recordings", None),
    ("crates/report", Some("report")),
    ("crates/host", Some("host")),
    ("crates/editor", None),
    ("crates/cli", Some("cli")),
];

/// Packages that touch no file, no terminal and no environment.
const PURE: [&str; 3] = [".", "crates/physics", "crates/recordings"];

/// The folders of a room that each of its folders may import from; the files beside the folders are `""`.
const FOLDERS: [(&str, &str, &[&str]); 35] = [
    ("interpreter", "", &["motion", "programs", "values", "ways"]),
    (
        "interpreter",
        "drive",
        &["motion", "programs", "values", "ways", "words"],
    ),
    ("interpreter", "programs", &["values"]),
    ("interpreter", "values", &["ways"]),
    ("interpreter", "ways", &["programs", "values"]),
    (
        "interpreter",
        "words",
        &["motion", "programs", "values", "ways"],
    ),
    ("syntax", "", &["lower"]),
    (
        "circle",
        "",
        &["evidence", "figures", "geometry", "simulated"],
    ),
    ("circle", "evidence", &["geometry"]),
    ("circle", "figures", &["evidence", "geometry"]),
    (
        "circle",
        "fitted",
        &["figures", "geometry", "recorded", "tune"],
    ),
    (
        "circle",
        "learn",
        &["figures", "geometry", "recorded", "simulated", "tune"],
    ),
    ("circle", "recorded", &["figures", "geometry", "simulated"]),
    ("circle", "simulated", &["figures", "geometry"]),
    ("circle", "tune", &["geometry", "simulated"]),
    ("simulation", "", &["friction"]),
    ("host", "", &["ask", "commission", "outputs", "recordings"]),
    ("host", "archive", &["disk", "machines", "outputs", "run"]),
    (
        "host",
        "ask",
        &["disk", "machines", "outputs", "recordings", "replay"],
    ),
    (
        "host",
        "commission",
        &["disk", "machines", "outputs", "recordings"],
    ),
    ("host", "machines", &["disk"]),
    ("host", "outputs", &["disk"]),
    ("host", "recordings", &["disk"]),
    ("host", "replay", &["disk", "machines", "recordings", "run"]),
    ("host", "run", &["disk", "machines", "outputs"]),
    ("report", "document", &["svg", "wording"]),
    (
        "report",
        "html",
        &[
            "assumptions",
            "document",
            "pictures",
            "results",
            "svg",
            "wording",
        ],
    ),
    ("report", "messages", &["document", "timeline", "wording"]),
    ("report", "pictures", &["results", "svg", "wording"]),
    (
        "report",
        "results",
        &["assumptions", "document", "pictures", "svg", "wording"],
    ),
    ("report", "svg", &["wording"]),
    (
        "report",
        "timeline",
        &["assumptions", "document", "wording"],
    ),
    ("report", "wording", &["document"]),
    ("cli", "args", &["output"]),
    ("cli", "commands", &["args", "output"]),
];

/// A source file: its package, its room, its path inside the room, its text.
struct File {
    package: &'static str,
    room: String,
    /// Whether the whole package is the room.
    is_whole: bool,
    /// The path beginning with the room: `motion/plan.rs`, `report/csv.rs`.
    path: String,
    text: String,
}

impl File {
    /// Returns the path from the root of the repository.
    fn shown(&self) -> String {
        let below = match self.path.split_once('/') {
            Some((_, below)) if self.is_whole => below,
            _ => &self.path,
        };
        format!("{}/src/{below}", self.package)
    }
}

fn sources() -> Vec<File> {
    let packages = PACKAGES.iter();
    packages
        .flat_map(|(folder, room)| sources_of(folder, *room))
        .collect()
}

/// Returns the sources of a package.
fn sources_of(package: &'static str, whole: Option<&str>) -> Vec<File> {
    let root = root().join(package).join("src");
    let paths = rust_files(&format!("{package}/src"));
    let files = paths.into_iter().map(|path| {
        let below = path.strip_prefix(&root).expect("below src");
        let within = below.to_string_lossy().replace('\\', "/");
        let name = match whole {
            Some(folder) if within == "lib.rs" => format!("{folder}/mod.rs"),
            Some(folder) => format!("{folder}/{within}"),
            None => within,
        };
        let first = name.split('/').next().expect("a name");
        File {
            package,
            room: first.trim_end_matches(".rs").to_owned(),
            is_whole: whole.is_some(),
            text: fs::read_to_string(&path).expect("text"),
            path: name,
        }
    });
    files.collect()
}

/// Returns the lines of code with their numbers, without comments and without everything after the first
/// `#[cfg(test)]`, with which the files of this crate end.
fn code(file: &File) -> impl Iterator<Item = (usize, &str)> {
    let all_tests = file.path.contains("/tests/");
    file.text
        .lines()
        .enumerate()
        .take_while(move |(_, line)| !all_tests && line.trim() != "#[cfg(test)]")
        .map(|(number, line)| (number + 1, line.split("//").next().unwrap_or_default()))
}

/// Returns the rooms that a line of code names after `crate::`.
fn named_rooms(line: &str) -> Vec<&str> {
    line.match_indices("crate::")
        .filter_map(|(at, found)| {
            let rest = &line[at + found.len()..];
            let end = rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
            let word = &rest[..end.unwrap_or(rest.len())];
            (!word.is_empty() && !line[..at].ends_with('$')).then_some(word)
        })
        .collect()
}

/// Fails for every line of code that contains a forbidden word.
fn assert_absent(words: &[&str], concerned: impl Fn(&File) -> bool) {
    let mut found = Vec::new();
    for file in sources().iter().filter(|file| concerned(file)) {
        for (number, line) in code(file) {
            for word in words.iter().filter(|word| line.contains(**word)) {
                found.push(format!("{}:{number}: `{word}`", file.shown()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn the_table_itself_never_turns_round() {
    let position = |name: &str| ROOMS.iter().position(|(room, _)| *room == name);
    for (at, (room, imports)) in ROOMS.iter().enumerate() {
        for import in *imports {
            let other = position(import).expect("a room of the table");
            assert!(other < at, "{room} imports {import}");
        }
    }
}

#[test]
fn imports_go_one_way() {
    let table: BTreeMap<_, _> = ROOMS.into_iter().collect();
    let mut wrong = Vec::new();
    for file in sources() {
        if file.is_whole
            || ["lib", "lsp", "dap", "documents", "words"].contains(&file.room.as_str())
        {
            continue;
        }
        let Some(allowed) = table.get(file.room.as_str()) else {
            wrong.push(format!("{}: the room has no row in ROOMS", file.shown()));
            continue;
        };
        for (number, line) in code(&file) {
            for import in named_rooms(line) {
                let macros_and_features = !table.contains_key(import);
                if import != file.room && !macros_and_features && !allowed.contains(&import) {
                    wrong.push(format!("{}:{number}: imports `{import}`", file.shown()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn only_syntax_knows_the_parser() {
    assert_absent(&["pest", "Pairs"], |file| file.room != "syntax");
}

#[test]
fn commands_are_named_by_their_tables() {
    // The meaning of a `#` command is in its row; elsewhere it is named only by messages, and by names in the state.
    let mut files: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    let sources = sources();
    for file in sources.iter().filter(|file| file.package == ".") {
        for (_, line) in code(file) {
            for (at, _) in line.match_indices("\"#") {
                let name = &line[at + 1..];
                let end =
                    name[1..].find(|it: char| !(it.is_ascii_uppercase() || it == ' ' || it == '_'));
                let name = &name[..end.map_or(name.len(), |end| end + 1)];
                if name.len() > 2 {
                    files.entry(name).or_default().insert(file.shown());
                }
            }
        }
    }
    let is_in_several = |(_, files): &(&&str, &BTreeSet<String>)| files.len() > 1;
    let several: Vec<_> = files.iter().filter(is_in_several).collect();
    assert!(several.len() < 15, "{several:#?}");
}

#[test]
fn the_slice_knows_no_interpreter_and_no_files() {
    let strangers = [
        "interpreter",
        "crate::machine",
        "pest",
        "std::fs",
        "std::io",
        "std::path",
    ];
    assert_absent(&strangers, |file| file.room == "comp");
}

#[test]
fn the_library_touches_nothing_outside() {
    let outside = [
        "std::fs",
        "std::env",
        "std::io",
        "std::net",
        "std::process",
        "std::thread",
        "SystemTime",
        "Instant",
        "print!",
        "println!",
        "dbg!",
    ];
    assert_absent(&outside, |file| PURE.contains(&file.package));
}

#[test]
fn reports_compute_nothing_and_open_nothing() {
    assert_absent(
        &["std::fs", "std::env", "Interpreter::", "Session::"],
        |file| file.room == "report",
    );
}

#[test]
fn a_host_prints_nothing_and_knows_no_option() {
    let of_the_command_line = [
        "print!", "println!", "stdout(", "stderr(", "clap", "\"--", "`--",
    ];
    // The options of git are not those of the tool.
    let is_host = |file: &File| file.room == "host" && !file.path.ends_with("git.rs");
    assert_absent(&of_the_command_line, is_host);
}

#[test]
fn the_library_names_no_option() {
    // Advice is data; the words of the command line are in `report/wording` and in `cli`.
    let mut found = Vec::new();
    for file in sources() {
        if ["cli", "report"].contains(&file.room.as_str()) {
            continue;
        }
        let lines = file.text.lines().enumerate();
        for (at, line) in lines.take_while(|(_, line)| line.trim() != "#[cfg(test)]") {
            if line.contains("`--") {
                found.push(format!("{}:{}: {}", file.shown(), at + 1, line.trim()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn paths_are_shown_in_one_way() {
    // R13.1: `text/shown_path.rs` writes one kind of slash.
    assert_absent(&[".display()"], |_| true);
}

/// Returns the module path of a file, beginning with its room: `["motion", "plan"]`.
fn module_path(file: &File) -> Vec<&str> {
    let below = file.path.strip_suffix(".rs").expect("a Rust file");
    let below = below.strip_suffix("/mod").unwrap_or(below);
    below.split('/').collect()
}

/// Returns the first names after a path in a text, also those of a group in braces.
fn names_after<'a>(text: &'a str, path: &str) -> BTreeSet<&'a str> {
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut names = BTreeSet::new();
    for (at, _) in text.match_indices(path) {
        let rest = &text[at + path.len()..];
        let Some(group) = rest.strip_prefix('{') else {
            names.extend(rest.split(|letter| !is_name(letter)).next());
            continue;
        };
        let mut depth = 0;
        let mut begins = true;
        for (at, letter) in group.char_indices() {
            if begins && depth == 0 && is_name(letter) {
                names.extend(group[at..].split(|letter| !is_name(letter)).next());
            }
            begins = match letter {
                ' ' | '\n' => begins,
                letter => letter == ',',
            };
            match letter {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                _ => {}
            }
        }
    }
    names
}

#[test]
fn folders_of_a_room_import_what_their_row_says() {
    let files = sources();
    let mut folders: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for file in &files {
        let path: Vec<&str> = file.path.split('/').collect();
        if let [room, folder, _, ..] = path[..] {
            folders.entry(room).or_default().insert(folder);
        }
    }
    let mut found: BTreeMap<(&str, &str), BTreeSet<&str>> = BTreeMap::new();
    for file in files
        .iter()
        .filter(|file| folders.contains_key(&*file.room))
    {
        let module = module_path(file);
        let beside = &folders[&*file.room];
        let own = module.get(1).filter(|name| beside.contains(**name));
        let text: Vec<&str> = code(file).map(|(_, line)| line).collect();
        let text = text.join("\n").replace("pub(in ", "");
        let home = if file.is_whole {
            "crate::".to_owned()
        } else {
            format!("crate::{}::", file.room)
        };
        let mut imports = names_after(&text, &home);
        // The path that leads up to the room, and the path of a file beside the folders to a folder.
        let up = "super::".repeat(module.len().saturating_sub(1));
        let up = if up.is_empty() { "self::" } else { &up };
        imports.extend(names_after(&text, up));
        let others = imports.into_iter().filter(|name| Some(name) != own);
        let others = others.filter_map(|name| beside.get(name).copied());
        let row = (module[0], own.copied().unwrap_or_default());
        found.entry(row).or_default().extend(others);
    }
    found.retain(|_, imports| !imports.is_empty());
    let rows = FOLDERS.iter();
    let table =
        rows.map(|(room, folder, imports)| ((*room, *folder), imports.iter().copied().collect()));
    assert_eq!(found, table.collect());
}

#[test]
fn a_type_name_means_one_thing() {
    // A package defines a name only once, and no name that is public in another package.
    let mut definitions: BTreeMap<String, Vec<(&str, String, bool)>> = BTreeMap::new();
    let bindings = ["bindings/c", "bindings/python", "bindings/web"];
    let bindings = bindings.map(|folder| sources_of(folder, Some("binding")));
    for file in sources().iter().chain(bindings.iter().flatten()) {
        for (_, line) in code(file) {
            if let Some((name, is_public)) = defined_type(line) {
                let definition = (file.package, file.shown(), is_public);
                definitions
                    .entry(name.to_owned())
                    .or_default()
                    .push(definition);
            }
        }
    }
    let mut found = Vec::new();
    for (name, mut places) in definitions {
        places.sort();
        // The same item for different systems.
        places.dedup_by(|one, other| one.1 == other.1);
        let is_public = places.iter().any(|(_, _, is_public)| *is_public);
        let is_twice = places.windows(2).any(|pair| pair[0].0 == pair[1].0);
        if places.len() > 1 && (is_public || is_twice) {
            let files: Vec<String> = places.into_iter().map(|(_, file, _)| file).collect();
            found.push(format!("`{name}`: {}", files.join(", ")));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn an_item_of_the_library_has_one_public_path() {
    let sources = sources_of(".", None);
    let lib = sources.iter().find(|file| file.path == "lib.rs");
    let modules =
        code(lib.expect("the library")).filter_map(|(_, line)| line.strip_prefix("pub mod "));
    let modules: BTreeSet<&str> = modules.map(|name| name.trim_end_matches(';')).collect();
    assert!(modules.contains("machine"));
    let mut found = Vec::new();
    for file in &sources {
        for (number, line) in code(file) {
            let shown = line
                .trim_start()
                .strip_prefix("pub use ")
                .unwrap_or_default();
            let path = shown.strip_prefix("crate::");
            let path = path
                .or((file.path == "lib.rs").then_some(shown))
                .unwrap_or_default();
            if modules.contains(path.split("::").next().unwrap_or_default()) {
                found.push(format!("{}:{number}: {line}", file.shown()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Returns the type that an unindented line defines, and whether it is public.
fn defined_type(line: &str) -> Option<(&str, bool)> {
    let rest = line.strip_prefix("pub ").unwrap_or(line);
    let is_public = rest.len() < line.len();
    let rest = match rest.strip_prefix("pub(") {
        Some(within) => within.split_once(") ")?.1,
        None => rest,
    };
    let kinds = ["struct ", "enum ", "trait ", "type "];
    let name = kinds.iter().find_map(|kind| rest.strip_prefix(kind))?;
    let end = name.find(|letter: char| !letter.is_alphanumeric());
    Some((&name[..end.unwrap_or(name.len())], is_public))
}

#[test]
fn a_crate_path_is_found_in_a_line() {
    assert_eq!(named_rooms("use crate::diagnostic::Code;"), ["diagnostic"]);
    assert_eq!(named_rooms("f(crate::a::B, crate::c_d)"), ["a", "c_d"]);
    assert_eq!(named_rooms("let krate = 1;"), [""; 0]);
}
