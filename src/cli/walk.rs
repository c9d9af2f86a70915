//! The programs below the paths that the user names.

use std::path::{Path, PathBuf};

use ignore::WalkBuilder;

use super::failure::Failure;
use super::files::Input;

/// Extensions of NC programs, in lower case.
const EXTENSIONS: [&str; 9] = ["nc", "cnc", "mpf", "spf", "sub", "cyc", "iso", "ngc", "tap"];

/// The programs in a fixed order: files as the user named them, folders walked by name. What a
/// repository ignores is passed over; a file that is named counts whatever its extension.
pub(super) fn programs(paths: &[PathBuf]) -> Result<Vec<Input>, Failure> {
    let mut found: Vec<Input> = Vec::new();
    for path in paths {
        if !path.is_dir() {
            let input = Input::new(path);
            input.probe()?;
            found.push(input);
            continue;
        }
        let before = found.len();
        for entry in WalkBuilder::new(path)
            .sort_by_file_name(std::ffi::OsStr::cmp)
            .build()
        {
            let entry = entry.map_err(|error| {
                Failure::new(format!("`{}` cannot be walked: {error}", path.display()))
            })?;
            let is_file = entry.file_type().is_some_and(|kind| kind.is_file());
            if is_file && is_program(entry.path()) {
                found.push(Input::File(shown(entry.path())));
            }
        }
        if found.len() == before {
            return Err(
                Failure::new(format!("there is no program below `{}`", path.display()))
                    .with_help(format!("programs end in .{}", EXTENSIONS.join(", ."))),
            );
        }
    }
    let mut seen = std::collections::BTreeSet::new();
    found.retain(|input| seen.insert(input.clone()));
    Ok(found)
}

fn is_program(path: &Path) -> bool {
    path.extension()
        .and_then(|extension| extension.to_str())
        .is_some_and(|extension| {
            EXTENSIONS
                .iter()
                .any(|known| known.eq_ignore_ascii_case(extension))
        })
}

/// `./a.nc` is `a.nc`.
fn shown(path: &Path) -> PathBuf {
    path.strip_prefix(".").unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_walked_by_name() {
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        for name in ["b.NC", "a.mpf", "c.txt", "sub/z.cyc"] {
            std::fs::write(path(name), "").unwrap();
        }
        let found = programs(&[path(""), path("c.txt"), path("b.NC")]).unwrap();
        let names: Vec<String> = found
            .iter()
            .map(|input| input.name(super::super::files::Naming::FileName))
            .collect();
        assert_eq!(names, ["a.mpf", "b.NC", "z.cyc", "c.txt"]);
        std::fs::create_dir(path("empty")).unwrap();
        assert!(programs(&[path("empty")]).is_err());
        assert!(programs(&[path("missing.nc")]).is_err());
    }
}
