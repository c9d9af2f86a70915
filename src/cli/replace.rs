//! Files that are replaced in one step: whether the tool is killed or the disk is full, the old or
//! the new file is there, whole.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use super::failure::Failure;

/// Lets `fill` write a file beside the old one, syncs it and lets it take the old one's place. It
/// keeps the rights of the old one; a link stays a link. What is no file, a device or a pipe, is
/// written as it is.
///
/// # Errors
/// The file cannot be written. The old one is as it was.
pub(super) fn replace_with(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    let target = std::fs::canonicalize(path);
    let target = target.as_deref().unwrap_or(path);
    let written = match std::fs::metadata(target) {
        Ok(old) if !old.is_file() => File::options()
            .write(true)
            .open(target)
            .and_then(|mut file| fill(&mut file)),
        _ => write(target, fill),
    };
    written.map_err(|error| Failure::writing(path, &error))
}

/// Writes a picture.
///
/// # Errors
/// The file cannot be written. The old one is as it was.
pub(super) fn write_picture(path: &Path, svg: &str) -> Result<(), Failure> {
    replace_with(path, |out| out.write_all(svg.as_bytes()))
}

/// Says before the work begins why a file could not be written at its end.
pub(super) fn probe(path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    if path.is_dir() {
        return Err(Failure::new(format!("`{shown}` is a folder, not a file")));
    }
    if !folder(path).is_dir() {
        let missing = folder(path).display();
        return Err(Failure::new(format!(
            "`{shown}` cannot be written: there is no folder `{missing}`"
        ))
        .with_help("make the folder first"));
    }
    Ok(())
}

fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let folder = folder(path);
    let mut prefix = OsString::from(".");
    prefix.push(path.file_name().unwrap_or_default());
    prefix.push("-");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(new_file_permissions());
    let mut file = builder.tempfile_in(folder)?;
    if let Ok(old) = std::fs::metadata(path) {
        file.as_file().set_permissions(old.permissions())?;
    }
    fill(&mut file)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    #[cfg(unix)]
    File::open(folder)?.sync_all()?;
    Ok(())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// What a new file gets; the user's mask takes away from it.
#[cfg(unix)]
fn new_file_permissions() -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    std::fs::Permissions::from_mode(0o666)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_writer_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.html");
        replace_with(&path, |out| out.write_all(b"old")).unwrap();
        let failed = replace_with(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(failed.unwrap_err().message.contains("the disk is full"));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_that_could_not_be_written_is_said_before() {
        let folder = tempfile::tempdir().unwrap();
        assert!(
            probe(folder.path())
                .unwrap_err()
                .message
                .contains("is a folder")
        );
        let lost = folder.path().join("no/report.html");
        assert!(
            probe(&lost)
                .unwrap_err()
                .message
                .contains("there is no folder")
        );
        assert!(probe(&folder.path().join("report.html")).is_ok());
    }
}
