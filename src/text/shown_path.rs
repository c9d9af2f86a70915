//! Paths as they are shown.

use std::path::Path;

/// The name of a file in messages and records: on every system with `/` between its parts, as git
/// writes them, so that a report or an agreed result does not depend on where it was made.
pub fn shown_path(path: &Path) -> String {
    let written = path.to_string_lossy();
    if cfg!(windows) {
        slashed(&written)
    } else {
        written.into_owned()
    }
}

/// A path of Windows with `/` between its parts and without `\\?\`, which lifts limits of the system and
/// was not written by the user.
fn slashed(path: &str) -> String {
    let plain = match path.strip_prefix(r"\\?\UNC\") {
        Some(share) => format!("//{share}"),
        None => path.strip_prefix(r"\\?\").unwrap_or(path).to_owned(),
    };
    plain.replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_of_windows_have_one_kind_of_slash() {
        // R13.1
        for (path, shown) in [
            (r"programs\mill/a.nc", "programs/mill/a.nc"),
            (r"C:\CNC\a.nc", "C:/CNC/a.nc"),
            (r"\\server\share\a.nc", "//server/share/a.nc"),
            (r"\\?\C:\CNC\a.nc", "C:/CNC/a.nc"),
            (r"\\?\UNC\server\share\a.nc", "//server/share/a.nc"),
            ("a.nc", "a.nc"),
        ] {
            assert_eq!(slashed(path), shown);
        }
    }

    #[test]
    fn a_backslash_is_a_letter_where_it_does_not_part() {
        // R13.1
        let shown = if cfg!(windows) { "a/b.nc" } else { r"a\b.nc" };
        assert_eq!(shown_path(Path::new(r"a\b.nc")), shown);
    }
}
