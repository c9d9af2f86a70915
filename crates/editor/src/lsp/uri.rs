//! URIs of editors, and the paths that they name.

use std::path::{Path, PathBuf};

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// Characters of a URI that are escaped.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'/')
    .remove(b':');

/// Form of the paths of a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum System {
    Unix,
    Windows,
}

const HERE: System = if cfg!(windows) {
    System::Windows
} else {
    System::Unix
};

/// Returns the path that a `file:` URI names; `None` for any other URI.
pub(super) fn path_of(uri: &str) -> Option<PathBuf> {
    path_on(uri, HERE).map(PathBuf::from)
}

/// Returns the URI of an absolute path.
pub(super) fn uri_of(path: &Path) -> String {
    uri_on(&path.to_string_lossy(), HERE)
}

fn path_on(uri: &str, system: System) -> Option<String> {
    let (scheme, rest) = uri.split_once(':')?;
    if !scheme.eq_ignore_ascii_case("file") {
        return None;
    }
    let rest = rest.split(['?', '#']).next().unwrap_or_default();
    let (server, path) = match rest.strip_prefix("//") {
        Some(rest) => rest.split_at(rest.find('/').unwrap_or(rest.len())),
        None => ("", rest),
    };
    let decode = |text: &str| percent_decode_str(text).decode_utf8_lossy().into_owned();
    let (server, path) = (decode(server), decode(path));
    if !path.starts_with('/') {
        return None;
    }
    let is_remote = !matches!(server.as_str(), "" | "localhost");
    match system {
        System::Unix if is_remote => None,
        System::Unix => Some(path),
        System::Windows if is_remote => Some(format!(r"\\{server}{path}").replace('/', r"\")),
        System::Windows => {
            let has_drive = path.as_bytes().get(2) == Some(&b':');
            let path = if has_drive { &path[1..] } else { &path };
            Some(path.replace('/', r"\"))
        }
    }
}

fn uri_on(path: &str, system: System) -> String {
    let slashed = match system {
        System::Unix => path.to_owned(),
        System::Windows => path.replace('\\', "/"),
    };
    let plain = slashed.strip_prefix("//?/").unwrap_or(&slashed);
    let escaped = utf8_percent_encode(plain, ESCAPED);
    match (system, plain) {
        (System::Windows, plain) if plain.starts_with("//") => format!("file:{escaped}"),
        (_, plain) if plain.starts_with('/') => format!("file://{escaped}"),
        _ => format!("file:///{escaped}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn editors_escape_paths_each_in_its_way() {
        // R12.2
        let unix = |uri| path_on(uri, System::Unix);
        assert_eq!(unix("file:///a/b%20c.nc").as_deref(), Some("/a/b c.nc"));
        assert_eq!(unix("file:///%C3%9C.nc").as_deref(), Some("/\u{dc}.nc"));
        assert_eq!(unix("FILE:/a.nc").as_deref(), Some("/a.nc"));
        assert_eq!(unix("file://localhost/a%23.nc").as_deref(), Some("/a#.nc"));
        for other in [
            "untitled:Untitled-1",
            "git:/a.nc?x",
            "file://server/a",
            "file:a",
            "",
        ] {
            assert_eq!(unix(other), None, "{other}");
        }
        let windows = |uri| path_on(uri, System::Windows);
        assert_eq!(
            windows("file:///c%3A/N%20C/a.nc").as_deref(),
            Some(r"c:\N C\a.nc")
        );
        assert_eq!(windows("file:///C:/a.nc").as_deref(), Some(r"C:\a.nc"));
        assert_eq!(
            windows("file://nas/prg/a.nc").as_deref(),
            Some(r"\\nas\prg\a.nc")
        );
    }

    #[test]
    fn a_path_comes_back_from_its_uri() {
        // R12.2
        for (system, path, uri) in [
            (
                System::Unix,
                "/a b/\u{dc}#?.nc",
                "file:///a%20b/%C3%9C%23%3F.nc",
            ),
            (System::Windows, r"C:\N C\a.nc", "file:///C:/N%20C/a.nc"),
            (System::Windows, r"\\nas\prg\a.nc", "file://nas/prg/a.nc"),
        ] {
            assert_eq!(uri_on(path, system), uri);
            assert_eq!(path_on(uri, system).as_deref(), Some(path));
        }
        assert_eq!(uri_on(r"\\?\C:\a.nc", System::Windows), "file:///C:/a.nc");
    }
}
