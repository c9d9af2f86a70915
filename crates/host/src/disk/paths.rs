//! Paths as they are written, and the files to which they lead.

use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

/// Entry of a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FolderEntry {
    /// A file, or a text that stands in for one.
    File,
    /// A folder.
    Folder,
    /// A pipe, a device.
    Special,
}

/// Returns `.` for the current folder, whose path is empty.
pub(crate) fn or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    }
}

/// Returns the path without `.` and with `..` resolved by name; `..` beyond a relative path's start
/// stays.
pub(crate) fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => match normal.components().next_back() {
                Some(Component::Normal(_)) => {
                    normal.pop();
                }
                Some(Component::RootDir | Component::Prefix(_)) => {}
                Some(Component::CurDir | Component::ParentDir) | None => normal.push(part),
            },
            part => normal.push(part),
        }
    }
    normal
}

/// Returns the path with its last parts spelt as on the disk, as its real path shows them: where
/// a disk does not distinguish upper from lower case, any spelling leads to the file.
pub(crate) fn spelt_as(path: &Path, real: &Path) -> PathBuf {
    let mut parts: Vec<&OsStr> = path.iter().collect();
    let lower = |part: &OsStr| part.to_string_lossy().to_lowercase();
    for (part, on_disk) in parts.iter_mut().rev().zip(real.iter().rev()) {
        if lower(part) != lower(on_disk) {
            break;
        }
        *part = on_disk;
    }
    parts.iter().collect()
}

/// Returns a path relative to a folder, so that no output contains an absolute path (R9.16).
pub(crate) fn relative(path: &Path, folder: &Path) -> PathBuf {
    let shared = path
        .components()
        .zip(folder.components())
        .take_while(|(one, other)| one == other)
        .count();
    if shared == 0 {
        return path.to_owned();
    }
    let up = folder
        .components()
        .skip(shared)
        .map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_has_the_letters_of_the_disk() {
        // R13.1
        for (path, real, wanted) in [
            ("CYCLES/SUB.NC", "/mill/cycles/Sub.nc", "cycles/Sub.nc"),
            ("../Mill/a.nc", "/mill/a.nc", "../mill/a.nc"),
            ("link.nc", "/mill/a.nc", "link.nc"),
        ] {
            let spelt = spelt_as(Path::new(path), Path::new(real));
            assert_eq!(spelt, Path::new(wanted), "{path}");
        }
    }

    #[test]
    fn paths_are_made_normal_by_name() {
        for (path, wanted) in [
            ("a/./b", "a/b"),
            ("a/../b", "b"),
            ("../a", "../a"),
            ("../../a/../b", "../../b"),
            ("/../a", "/a"),
            ("a/b/../../../c", "../c"),
        ] {
            assert_eq!(normal(Path::new(path)), Path::new(wanted), "{path}");
        }
    }
}
