//! Wildcards, which `cmd` and PowerShell leave to the called program.

use std::ffi::OsString;
use std::path::PathBuf;

use glob::{MatchOptions, glob_with};

/// Options that match file names as Windows does: upper and lower case are the same, and a wildcard does not match a
/// path separator.
const AS_WINDOWS: MatchOptions = MatchOptions {
    case_sensitive: false,
    require_literal_separator: true,
    require_literal_leading_dot: false,
};

/// The option whose value is itself a pattern.
const TAKES_A_PATTERN: &str = "--exclude";

/// Expands each argument with a `*` or a `?` to the files that match. An argument without a match
/// stays, and is reported as a missing file.
pub(crate) fn expanded(arguments: Vec<OsString>) -> Vec<OsString> {
    let mut expanded = Vec::with_capacity(arguments.len());
    for argument in arguments {
        if expanded.last().is_some_and(|it| it == TAKES_A_PATTERN) {
            expanded.push(argument);
        } else {
            expanded.extend(matching(argument));
        }
    }
    expanded
}

fn matching(argument: OsString) -> Vec<OsString> {
    let pattern = argument.to_str().filter(|text| is_pattern(text));
    // A name can contain `[`, unlike the others, so it means itself.
    let pattern = pattern.map(|text| text.replace('[', "[[]"));
    let Some(paths) = pattern.and_then(|it| glob_with(&it, AS_WINDOWS).ok()) else {
        return vec![argument];
    };
    let found: Result<Vec<OsString>, _> = paths
        .map(|path| path.map(PathBuf::into_os_string))
        .collect();
    match found {
        Ok(found) if !found.is_empty() => found,
        // A folder that cannot be read may contain a program.
        _ => vec![argument],
    }
}

fn is_pattern(argument: &str) -> bool {
    argument.contains(['*', '?']) && !argument.starts_with('-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wildcards_are_the_files_that_match() {
        // R13.1
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        for name in ["b.NC", "a.nc", "a[1].nc", "a1.nc", "c.txt", "sub/d.nc"] {
            std::fs::write(path(name), "").unwrap();
        }
        let found = |pattern: &str| -> Vec<PathBuf> {
            let found = expanded(vec![path(pattern).into_os_string()]);
            found.into_iter().map(PathBuf::from).collect()
        };
        let all = ["a.nc", "a1.nc", "a[1].nc", "b.NC"].map(path);
        assert_eq!(found("*.nc"), all);
        assert_eq!(found("s*/?.NC"), [path("sub/d.nc")]);
        assert_eq!(found("a[1].nc"), [path("a[1].nc")]);
        assert_eq!(found("?[1].nc"), [path("a[1].nc")]);
        assert_eq!(found("*.mpf"), [path("*.mpf")], "nothing is passed over");
        let of_an_option = ["--columns=*", "--exclude"].map(OsString::from);
        let kept = [&of_an_option[..], &[path("*.nc").into()]].concat();
        assert_eq!(expanded(kept.clone()), kept);
    }
}
