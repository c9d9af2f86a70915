//! A result in a file: written beside the old one, it takes its place in one step, so that an
//! interrupted run leaves no half of it.

use std::io::{self, Write};
use std::path::Path;

use super::console::Console;
use super::failure::Failure;

impl Console {
    /// Writes a text into the file that the user named, or to stdout.
    pub(super) fn deliver(self, file: Option<&Path>, text: &str) -> Result<(), Failure> {
        match file {
            None => self.print(text),
            Some(path) => replace(path, text).map_err(|error| Failure::writing(path, &error)),
        }
    }
}

fn replace(path: &Path, text: &str) -> io::Result<()> {
    let old = std::fs::metadata(path).ok();
    // A device or a pipe cannot be replaced.
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        return std::fs::write(path, text);
    }
    // A link stays a link: the file that it names is replaced.
    let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".frictcomp-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions({
        use std::os::unix::fs::PermissionsExt;
        std::fs::Permissions::from_mode(0o666)
    });
    let mut file = builder.tempfile_in(folder)?;
    if let Some(old) = old {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.write_all(text.as_bytes())?;
    file.persist(&path).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.lis");
        replace(&path, "old").unwrap();
        replace(&path, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(replace(&folder.path().join("no/v.lis"), "x").is_err());
    }
}
