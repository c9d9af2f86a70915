//! No circle of imports inside a room: a type that two files need belongs in a third. If the methods of a type are
//! spread over several files, a call of one from another file counts as an import, also through fields:
//! `self.run.step()`.

use std::collections::{BTreeMap, BTreeSet};

use super::{File, code, sources};

/// The files of a room by their module path, `friction::gms`; the room itself is the empty one.
type Modules<'a> = BTreeMap<Vec<&'a str>, &'a File>;

/// The modules that each module imports.
type Imports<'a> = BTreeMap<Vec<&'a str>, BTreeSet<Vec<&'a str>>>;

/// Returns the module path of a file inside its room.
fn module_path(file: &File) -> Vec<&str> {
    let below = file.path.strip_suffix(".rs").expect("a Rust file");
    let mut path: Vec<&str> = below.split('/').skip(1).collect();
    if path.last() == Some(&"mod") {
        path.pop();
    }
    path
}

/// Returns the code of a file as one text, without visibility paths.
fn text_of(file: &File) -> String {
    let lines: Vec<&str> = code(file).map(|(_, line)| line).collect();
    let mut text = lines.join("\n");
    while let Some(start) = text.find("pub(in ") {
        let end = text[start..].find(')').expect("a bracket that closes");
        text.replace_range(start..=start + end, "pub");
    }
    text
}

/// Returns the name at the beginning of a text, and the rest.
fn split_name(text: &str) -> (&str, &str) {
    let end = text.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    text.split_at(end.unwrap_or(text.len()))
}

/// Returns the modules of the room that a path leads to after its beginning has led to `module`. A group in braces
/// leads to several.
fn targets<'a>(modules: &Modules<'a>, module: &[&'a str], path: &str) -> BTreeSet<Vec<&'a str>> {
    let path = path.trim_start();
    if let Some(group) = path.strip_prefix('{') {
        return parts(group)
            .into_iter()
            .flat_map(|part| targets(modules, module, part))
            .collect();
    }
    let (name, rest) = split_name(path);
    if name == "super" && !module.is_empty() {
        let rest = rest.strip_prefix("::").unwrap_or_default();
        return targets(modules, &module[..module.len() - 1], rest);
    }
    let child = modules.keys().find(|candidate| {
        let split = candidate.split_last();
        split.is_some_and(|(last, parent)| parent == module && *last == name)
    });
    match child {
        Some(child) => targets(modules, child, rest.strip_prefix("::").unwrap_or_default()),
        None => BTreeSet::from([module.to_vec()]),
    }
}

/// Returns the parts of a group, given the text after the opening brace.
fn parts(group: &str) -> Vec<&str> {
    let (mut depth, mut begin) = (0, 0);
    let mut parts = Vec::new();
    for (at, letter) in group.char_indices() {
        match letter {
            '{' => depth += 1,
            ',' if depth == 0 => {
                parts.push(&group[begin..at]);
                begin = at + 1;
            }
            '}' if depth == 0 => {
                parts.push(&group[begin..at]);
                break;
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    parts.retain(|part| !part.trim().is_empty());
    parts
}

/// Returns the modules of its room that a file imports, by any path.
fn imported<'a>(modules: &Modules<'a>, own: &[&'a str], file: &File) -> BTreeSet<Vec<&'a str>> {
    let text = text_of(file);
    let children: Vec<&str> = modules
        .keys()
        .filter(|path| path.len() == own.len() + 1 && path.starts_with(own))
        .filter_map(|path| path.last().copied())
        .collect();
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices("::") {
        // The first name of the path, without anything before it.
        let head = &text[..at];
        let begin = head.rfind(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
        let begin = begin.map_or(0, |begin| begin + 1);
        if head[..begin].ends_with("::") {
            continue;
        }
        let (name, path) = (&head[begin..], &text[at + 2..]);
        match name {
            "crate" if file.is_whole => found.extend(targets(modules, &[], path)),
            "crate" => {
                let (room, rest) = split_name(path);
                if room == file.room {
                    let rest = rest.strip_prefix("::").unwrap_or_default();
                    found.extend(targets(modules, &[], rest));
                }
            }
            "self" => found.extend(targets(modules, own, path)),
            "super" if !own.is_empty() => {
                found.extend(targets(modules, &own[..own.len() - 1], path));
            }
            child if children.contains(&child) => {
                found.extend(targets(modules, own, &text[begin..]));
            }
            _ => {}
        }
    }
    found.remove(own);
    found
}

/// Returns the bodies of the inherent `impl` blocks in a text.
fn methods(text: &str) -> Vec<(&str, &str)> {
    let blocks = text.split("\nimpl").skip(1);
    let own = blocks.filter_map(|block| {
        let (head, body) = block.split_once(" {\n")?;
        let end = body.find("\n}").unwrap_or(body.len());
        let subject = head.rsplit(' ').next()?;
        let name = subject.split('<').next()?;
        (!head.contains(" for ")).then_some((name, &body[..end]))
    });
    own.collect()
}

/// Returns the names that follow some words in a text, up to the bracket of a call.
fn names_after<'a>(text: &'a str, words: &[&str], call: &str) -> BTreeSet<&'a str> {
    let ends = |word: &str| -> Vec<usize> {
        let found = text.match_indices(word);
        found.map(|(at, word)| at + word.len()).collect()
    };
    let found = words.iter().flat_map(|word| ends(word));
    let named = found.map(|end| split_name(text[end..].trim_start()));
    let called = named.filter(|(_, rest)| rest.starts_with(call));
    called.map(|(name, _)| name).collect()
}

/// Returns the fields of the structs in a text: the struct, the field, and the names in its type.
fn fields(text: &str) -> Vec<(&str, &str, Vec<&str>)> {
    let structs = text.match_indices("struct ").filter_map(|(at, word)| {
        let (name, rest) = split_name(&text[at + word.len()..]);
        let (head, body) = rest.split_once('{')?;
        let is_plain = !head.contains([';', '(', '}']);
        let end = body.find("\n}").unwrap_or(body.len());
        is_plain.then_some((name, &body[..end]))
    });
    structs
        .flat_map(|(name, body)| {
            body.lines().filter_map(move |line| {
                let (left, types) = line.split_once(": ")?;
                let field = left.rsplit(' ').next()?;
                let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let names = types.split(|c| !is_name(c)).filter(|it| !it.is_empty());
                Some((name, field, names.collect()))
            })
        })
        .collect()
}

/// Returns the calls in a text that go from `self` through fields: the fields, then the method.
fn calls_through_fields(text: &str) -> Vec<(Vec<&str>, &str)> {
    let found = text.match_indices("self").filter_map(|(at, word)| {
        let is_whole = !text[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        let mut rest = &text[at + word.len()..];
        let mut names = Vec::new();
        while let Some(after) = rest.trim_start().strip_prefix('.') {
            let (name, left) = split_name(after);
            names.push(name);
            rest = left;
        }
        let method = names.pop()?;
        (is_whole && rest.starts_with('(') && !names.is_empty()).then_some((names, method))
    });
    found.collect()
}

/// Returns the files whose methods are called by methods of the same type in another file.
fn called<'a>(modules: &Modules<'a>) -> Imports<'a> {
    let texts: Vec<(&Vec<&str>, String)> = modules
        .iter()
        .map(|(path, file)| (path, text_of(file)))
        .collect();
    let mut homes: BTreeMap<(&str, &str), &Vec<&str>> = BTreeMap::new();
    for (path, text) in &texts {
        for (subject, body) in methods(text) {
            for name in names_after(body, &["fn "], "") {
                homes.entry((subject, name)).or_insert(path);
            }
        }
    }
    let mut types: BTreeMap<(&str, &str), &Vec<&str>> = BTreeMap::new();
    let found: Vec<_> = texts.iter().flat_map(|(_, text)| fields(text)).collect();
    for (subject, field, names) in &found {
        types.entry((subject, field)).or_insert(names);
    }
    let mut calls = Imports::new();
    for (path, text) in &texts {
        for (subject, body) in methods(text) {
            for (through, method) in calls_through_fields(body) {
                let mut subjects = vec![subject];
                for field in through {
                    let types = subjects.iter().filter_map(|it| types.get(&(*it, field)));
                    subjects = types.flat_map(|names| names.iter().copied()).collect();
                }
                let homes = subjects.iter().filter_map(|it| homes.get(&(*it, method)));
                let others = homes.filter(|home| *home != path);
                let to: Vec<_> = others.map(|home| (*home).clone()).collect();
                calls.entry((*path).clone()).or_default().extend(to);
            }
            for name in names_after(body, &["self.", "self\n            .", "Self::"], "(") {
                if let Some(home) = homes.get(&(subject, name)).filter(|home| *home != path) {
                    calls
                        .entry((*path).clone())
                        .or_default()
                        .insert((*home).clone());
                }
            }
        }
    }
    calls
}

/// Returns the imports inside a room that are part of a circle: those that remain after repeatedly removing files that
/// import none of the rest, or that none of the rest imports.
fn circles<'a>(modules: &Modules<'a>) -> Imports<'a> {
    let mut left: Imports<'a> = modules
        .iter()
        .map(|(path, file)| (path.clone(), imported(modules, path, file)))
        .collect();
    for (path, calls) in called(modules) {
        left.entry(path).or_default().extend(calls);
    }
    loop {
        let before = left.len();
        let importers: BTreeSet<_> = left.keys().cloned().collect();
        let used: BTreeSet<_> = left.values().flatten().cloned().collect();
        left.retain(|path, imports| {
            imports.retain(|import| importers.contains(import));
            !imports.is_empty() && used.contains(path)
        });
        if left.len() == before {
            return left;
        }
    }
}

/// Returns the circles of each room, as lines.
fn circles_of_rooms() -> BTreeMap<String, Vec<String>> {
    let files = sources();
    let mut rooms: BTreeMap<&str, Modules> = BTreeMap::new();
    for file in &files {
        let room = rooms.entry(&file.room).or_default();
        room.insert(module_path(file), file);
    }
    let lines = |modules: &Modules| {
        let left = circles(modules);
        let name = |path: &Vec<&str>| modules[path].shown();
        let line = |(path, imports): (&Vec<&str>, &BTreeSet<Vec<&str>>)| {
            let names: Vec<String> = imports.iter().map(name).collect();
            format!("{} imports {}", name(path), names.join(", "))
        };
        left.iter().map(line).collect()
    };
    rooms
        .iter()
        .map(|(room, modules)| ((*room).to_owned(), lines(modules)))
        .collect()
}

#[test]
fn no_room_has_a_circle_inside() {
    let wrong: Vec<String> = circles_of_rooms().into_values().flatten().collect();
    assert!(
        wrong.is_empty(),
        "files import each other in a circle; code that both need belongs in a third:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn every_way_to_write_an_import_is_seen() {
    let file = |path: &str, text: &str| File {
        package: ".",
        room: "room".to_owned(),
        is_whole: false,
        path: path.to_owned(),
        text: text.to_owned(),
    };
    let files = [
        file("room/mod.rs", "mod a;\npub use a::A;"),
        file("room/a.rs", "use super::{b::{B, C}, d};"),
        file(
            "room/b.rs",
            "use crate::room::d::inner;\nuse crate::other::a;",
        ),
        file("room/d/mod.rs", "fn f() { inner::g(); }"),
        file(
            "room/d/inner.rs",
            "// use super::super::a;\nlet a = super::super::b::B;",
        ),
        file(
            "room/e.rs",
            "pub(in crate::room) use super::A;\n#[cfg(test)]\nuse super::d;",
        ),
    ];
    let modules: Modules = files.iter().map(|file| (module_path(file), file)).collect();
    let imports = |path: &[&str]| -> Vec<String> {
        let found = imported(&modules, path, modules[path]);
        found.iter().map(|import| import.join("::")).collect()
    };
    assert_eq!(imports(&[]), ["a"]);
    assert_eq!(imports(&["a"]), ["b", "d"]);
    assert_eq!(imports(&["b"]), ["d::inner"]);
    assert_eq!(imports(&["d"]), ["d::inner"]);
    assert_eq!(imports(&["d", "inner"]), ["b"]);
    assert_eq!(imports(&["e"]), [""]);
    let left: Vec<String> = circles(&modules)
        .keys()
        .map(|path| path.join("::"))
        .collect();
    assert_eq!(left, ["b", "d::inner"]);
}

#[test]
fn a_call_of_a_method_in_another_file_is_seen() {
    let file = |path: &str, text: &str| File {
        package: ".",
        room: "room".to_owned(),
        is_whole: false,
        path: path.to_owned(),
        text: text.to_owned(),
    };
    let files = [
        file("room/kind.rs", "pub struct Run;\n"),
        file(
            "room/a.rs",
            "use super::kind::Run;\nimpl Run {\n    fn a(&self) {\n        self.b();\n    }\n}\n",
        ),
        file(
            "room/b.rs",
            "use super::kind::Run;\nimpl Run {\n    fn b(&self) {\n        Self::c();\n    }\n}\n",
        ),
        file(
            "room/c.rs",
            "use super::kind::Run;\nimpl Run {\n    fn c() {}\n}\nimpl Other {\n    fn a(&self) {\n        self.b();\n    }\n}\n",
        ),
        file(
            "room/d.rs",
            "pub struct Holder<'a> {\n    run: Option<&'a mut Inner>,\n}\nstruct Inner {\n    pub(super) run: Box<Run>,\n}\nimpl Holder<'_> {\n    fn a(&self) {\n        self\n            .run\n            .run\n            .a();\n        self.run.c;\n    }\n}\n",
        ),
    ];
    let modules: Modules = files.iter().map(|file| (module_path(file), file)).collect();
    let calls = called(&modules);
    let of = |path: &str| {
        calls
            .get(&vec![path])
            .map(|found| found.iter().flatten().copied().collect::<Vec<_>>())
    };
    assert_eq!(of("a"), Some(vec!["b"]));
    assert_eq!(of("b"), Some(vec!["c"]));
    assert_eq!(of("c"), None);
    assert_eq!(of("d"), Some(vec!["a"]));
    assert!(circles(&modules).is_empty());
}
