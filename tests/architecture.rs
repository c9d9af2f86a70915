//! The direction of imports, and what the rooms must not know.

#[path = "architecture/circles.rs"]
mod circles;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What each room may import. Rooms stand in the order of the data; an import never goes down.
const ROOMS: [(&str, &[&str]); 28] = [
    ("text", &[]),
    ("diagnostic", &["text"]),
    ("comp", &["text", "diagnostic"]),
    ("syntax", &["text", "diagnostic", "comp"]),
    ("lists", &["text", "diagnostic", "comp", "syntax"]),
    ("drive_interface", &["text", "diagnostic", "lists"]),
    ("config", &["text", "diagnostic", "comp", "syntax", "lists"]),
    (
        "machine",
        &[
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "lists",
            "drive_interface",
            "config",
        ],
    ),
    (
        "interpreter",
        &["text", "diagnostic", "comp", "syntax", "lists", "machine"],
    ),
    (
        "audit",
        &[
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "machine",
            "interpreter",
        ],
    ),
    (
        "lint",
        &[
            "text",
            "diagnostic",
            "comp",
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
            "syntax",
            "lists",
            "machine",
            "interpreter",
            "lint",
            "timeline",
        ],
    ),
    (
        "motion",
        &[
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "machine",
            "interpreter",
            "timeline",
        ],
    ),
    (
        "current",
        &[
            "diagnostic",
            "comp",
            "lists",
            "machine",
            "timeline",
            "motion",
        ],
    ),
    ("stiction", &[]),
    (
        "simulation",
        &["text", "diagnostic", "lists", "config", "stiction"],
    ),
    (
        "circle",
        &["diagnostic", "lists", "current", "stiction", "simulation"],
    ),
    ("trace", &["diagnostic"]),
    ("identify", &["diagnostic", "lists", "current", "trace"]),
    (
        "facade",
        &["text", "machine", "timeline", "session", "current"],
    ),
    (
        "contour",
        &[
            "text",
            "diagnostic",
            "comp",
            "lists",
            "machine",
            "interpreter",
            "timeline",
            "motion",
            "current",
            "simulation",
        ],
    ),
    ("versions", &["diagnostic", "comp", "timeline", "contour"]),
    (
        "report",
        &[
            "motion",
            "contour",
            "audit",
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "lists",
            "drive_interface",
            "machine",
            "interpreter",
            "timeline",
            "current",
            "simulation",
            "stiction",
            "circle",
            "trace",
            "identify",
            "versions",
        ],
    ),
    (
        "host",
        &[
            "audit",
            "contour",
            "interpreter",
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "lists",
            "machine",
            "timeline",
            "session",
            "motion",
            "current",
            "simulation",
            "circle",
            "trace",
            "identify",
        ],
    ),
    (
        "lsp",
        &[
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "lists",
            "config",
            "machine",
            "interpreter",
            "timeline",
            "session",
            "audit",
            "report",
            "host",
        ],
    ),
    (
        "dap",
        &[
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "machine",
            "interpreter",
            "host",
        ],
    ),
    (
        "cli",
        &[
            "contour",
            "audit",
            "text",
            "diagnostic",
            "comp",
            "syntax",
            "lists",
            "drive_interface",
            "machine",
            "timeline",
            "session",
            "current",
            "motion",
            "simulation",
            "stiction",
            "circle",
            "trace",
            "identify",
            "versions",
            "report",
            "host",
            "lsp",
            "dap",
        ],
    ),
];

/// Rooms that may touch files, the terminal and the environment.
const OUTER: [&str; 6] = ["cli", "dap", "host", "lsp", "report", "main"];

/// A file above this many lines is split.
const MAX_LINES: usize = 600;

/// A source file: its path below `src`, its room, its text.
struct File {
    path: String,
    room: String,
    text: String,
}

fn sources() -> Vec<File> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut folders = vec![root.clone()];
    let mut paths: Vec<PathBuf> = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    let files = paths.into_iter().map(|path| {
        let below = path.strip_prefix(&root).expect("below src");
        let name = below.to_string_lossy().replace('\\', "/");
        let first = name.split('/').next().expect("a name");
        File {
            room: first.trim_end_matches(".rs").to_owned(),
            text: fs::read_to_string(&path).expect("text"),
            path: name,
        }
    });
    files.collect()
}

/// The lines of code with their numbers: no comments, and nothing after the first
/// `#[cfg(test)]`, by which files of this crate end.
fn code(file: &File) -> impl Iterator<Item = (usize, &str)> {
    let all_tests = file.path.contains("/tests/");
    file.text
        .lines()
        .enumerate()
        .take_while(move |(_, line)| !all_tests && line.trim() != "#[cfg(test)]")
        .map(|(number, line)| (number + 1, line.split("//").next().unwrap_or_default()))
}

/// The rooms that a line of code names after `crate::`.
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

/// Complains about every line of code in which a forbidden word stands.
fn assert_absent(words: &[&str], concerned: impl Fn(&File) -> bool) {
    let mut found = Vec::new();
    for file in sources().iter().filter(|file| concerned(file)) {
        for (number, line) in code(file) {
            for word in words.iter().filter(|word| line.contains(**word)) {
                found.push(format!("src/{}:{number}: `{word}`", file.path));
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
        if ["lib", "main"].contains(&file.room.as_str()) {
            continue;
        }
        let Some(allowed) = table.get(file.room.as_str()) else {
            wrong.push(format!("src/{}: the room has no row in ROOMS", file.path));
            continue;
        };
        for (number, line) in code(&file) {
            for import in named_rooms(line) {
                let macros_and_features = !table.contains_key(import);
                if import != file.room && !macros_and_features && !allowed.contains(&import) {
                    wrong.push(format!("src/{}:{number}: imports `{import}`", file.path));
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
    assert_absent(&outside, |file| !OUTER.contains(&file.room.as_str()));
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
    assert_absent(&of_the_command_line, |file| file.room == "host");
}

#[test]
fn the_library_names_no_option() {
    // What to do is data; the words of the command line are in `report/wording.rs` and in `cli`.
    let mut found = Vec::new();
    for file in sources() {
        if ["cli", "report", "main"].contains(&file.room.as_str()) {
            continue;
        }
        let lines = file.text.lines().enumerate();
        for (at, line) in lines.take_while(|(_, line)| line.trim() != "#[cfg(test)]") {
            if line.contains("`--") {
                found.push(format!("src/{}:{}: {}", file.path, at + 1, line.trim()));
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

#[test]
fn files_stay_short() {
    let long: Vec<String> = sources()
        .iter()
        .map(|file| (file, file.text.lines().count()))
        .filter(|(_, lines)| *lines > MAX_LINES)
        .map(|(file, lines)| format!("src/{}: {lines} lines", file.path))
        .collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn a_crate_path_is_found_in_a_line() {
    assert_eq!(named_rooms("use crate::diagnostic::Code;"), ["diagnostic"]);
    assert_eq!(named_rooms("f(crate::a::B, crate::c_d)"), ["a", "c_d"]);
    assert_eq!(named_rooms("let krate = 1;"), [""; 0]);
}
