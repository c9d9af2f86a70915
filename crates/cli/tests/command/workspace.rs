//! The programs and documents that tests read, and those that they make.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the root of the repository.
pub(crate) fn root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).expect("the workspace")
}

/// Returns the files below a folder with one of the extensions, or with any if none is given, sorted.
pub(crate) fn files(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let mut folders = vec![root().join(folder)];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let extension = path.extension().and_then(|it| it.to_str());
            if path.is_dir() {
                folders.push(path);
            } else if extensions.is_empty() || extension.is_some_and(|it| extensions.contains(&it))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Compares a file with a fresh text, or writes that with `UPDATE_DOCS=1`.
pub(crate) fn agree(path: &Path, fresh: &str) {
    let text = comparable(&fs::read_to_string(path).unwrap_or_default());
    let shown = comparable(fresh);
    if text == shown {
        return;
    }
    if env::var_os("UPDATE_DOCS").is_some() {
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, fresh).expect("written");
        return;
    }
    let same = text.lines().zip(shown.lines());
    let same = same.take_while(|(old, new)| old == new).count();
    let part = |text: &str, mark: &str| {
        let lines = text.lines().skip(same).take(5);
        let lines: Vec<String> = lines.map(|line| format!("{mark} {line}\n")).collect();
        lines.concat()
    };
    panic!(
        "{} is old, see CONTRIBUTING.md: line {}\n{}{}",
        path.display(),
        same + 1,
        part(&text, "-"),
        part(&shown, "+")
    );
}

/// Returns a text as it is compared: on Windows with 12 of the 16 digits of figures, since sines and roots of another
/// library differ in the last ones.
fn comparable(text: &str) -> String {
    if !cfg!(windows) {
        return text.to_owned();
    }
    let is_outside = |letter: char| !letter.is_ascii_digit() && letter != '.';
    let pieces = text.split_inclusive(is_outside).map(|piece| {
        let figure = piece.trim_end_matches(is_outside);
        match figure.parse::<f64>() {
            Ok(value) if figure.len() > 12 => format!("{value:.11e}{}", &piece[figure.len()..]),
            _ => piece.to_owned(),
        }
    });
    pieces.collect()
}

/// Copies a folder of the tree to its place below another folder.
pub(crate) fn copy(folder: &str, below: &Path) {
    for path in files(folder, &[]) {
        let to = below.join(path.strip_prefix(root()).expect("in the tree"));
        fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        fs::copy(&path, to).expect("copied");
    }
}
