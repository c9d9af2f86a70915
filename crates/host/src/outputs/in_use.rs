//! Reasons why only Windows refuses a file: another program has it open, so that it cannot be replaced, or its name
//! belongs to a device.

use std::io;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

/// Time for which a file may be in use: virus scanners and the Windows search open new files for
/// moments, spreadsheets for longer.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between attempts.
const PAUSE: Duration = Duration::from_millis(20);

/// Windows error codes: another program has the file open without sharing it, or has locked a part of it.
const IN_USE: [i32; 2] = [32, 33];

/// Windows error code for denied access, also returned when a file is to be replaced that another program has open.
const ACCESS_DENIED: i32 = 5;

/// Replaces or moves a file; where another program blocks this, tries again for some time.
pub(crate) fn patiently<T>(attempt: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    let may_pass = |code| cfg!(windows) && (IN_USE.contains(&code) || code == ACCESS_DENIED);
    repeated(attempt, may_pass, PATIENCE)
}

fn repeated<T>(
    mut attempt: impl FnMut() -> io::Result<T>,
    may_pass: impl Fn(i32) -> bool,
    patience: Duration,
) -> io::Result<T> {
    let start = Instant::now();
    loop {
        match attempt() {
            // A signal came in between.
            Err(error)
                if error.kind() == io::ErrorKind::Interrupted && start.elapsed() < patience => {}
            Err(error)
                if error.raw_os_error().is_some_and(&may_pass) && start.elapsed() < patience =>
            {
                thread::sleep(PAUSE);
            }
            result => return result,
        }
    }
}

/// Checks beforehand, to the extent possible, that a file can be replaced: on Windows a program that has it
/// open may prevent that.
#[cfg(windows)]
pub(crate) fn check_replaceable(path: &Path) -> io::Result<()> {
    use std::os::windows::fs::OpenOptionsExt;

    /// The right to replace a file, which all who have it open must grant.
    const DELETE: u32 = 0x0001_0000;
    let open = || std::fs::File::options().access_mode(DELETE).open(path);
    match patiently(open) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(told_of_replacing(error)),
        _ => Ok(()),
    }
}

#[cfg(not(windows))]
#[allow(
    clippy::unnecessary_wraps,
    reason = "elsewhere an open file can be replaced"
)]
pub(crate) fn check_replaceable(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Returns the error, with a separate kind where another program has the file open.
pub(crate) fn told(error: io::Error) -> io::Error {
    let code = error.raw_os_error();
    if cfg!(windows) && code.is_some_and(|code| IN_USE.contains(&code)) {
        return io::ErrorKind::ResourceBusy.into();
    }
    error
}

/// Returns the error for a file that cannot be replaced although a new one could be written next to it: then
/// another program has it open.
pub(crate) fn told_of_replacing(error: io::Error) -> io::Error {
    if cfg!(windows) && error.raw_os_error() == Some(ACCESS_DENIED) {
        return io::ErrorKind::ResourceBusy.into();
    }
    told(error)
}

/// Returns the device that a path means on Windows, whatever its folder and its extension: `aux.nc` cannot
/// be written.
pub(crate) fn device(path: &Path) -> Option<&'static str> {
    const DEVICES: [&str; 26] = [
        "CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$", "COM0", "COM1", "COM2", "COM3", "COM4",
        "COM5", "COM6", "COM7", "COM8", "COM9", "LPT0", "LPT1", "LPT2", "LPT3", "LPT4", "LPT5",
        "LPT6", "LPT7", "LPT8", "LPT9",
    ];
    let name = path.file_name()?.to_str()?;
    let stem = name.split(['.', ':']).next()?.trim_end();
    DEVICES.into_iter().find(|it| it.eq_ignore_ascii_case(stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_is_tried_again() {
        // R13.1
        let mut left = 3;
        let mut attempt = || {
            left -= 1;
            match left {
                0 => Ok(()),
                _ => Err(io::Error::from_raw_os_error(32)),
            }
        };
        assert!(repeated(&mut attempt, |code| code == 32, PATIENCE).is_ok());
        let mut count = 0;
        let mut attempt = || -> io::Result<()> {
            count += 1;
            Err(io::Error::from_raw_os_error(2))
        };
        assert!(repeated(&mut attempt, |code| code == 32, PATIENCE).is_err());
        assert_eq!(count, 1, "what does not pass is said at once");
        let mut attempt = || -> io::Result<()> { Err(io::Error::from_raw_os_error(32)) };
        assert!(repeated(&mut attempt, |_| true, Duration::ZERO).is_err());
    }

    #[test]
    fn names_of_devices_are_known_in_any_form() {
        // R13.1
        for (path, found) in [
            ("con", Some("CON")),
            ("out/aux.nc", Some("AUX")),
            ("Nul.tar.gz", Some("NUL")),
            ("lpt1 .txt", Some("LPT1")),
            ("com1:", Some("COM1")),
            ("console.nc", None),
            ("aux-1.nc", None),
            ("aux/a.nc", None),
            ("com10", None),
        ] {
            assert_eq!(device(Path::new(path)), found, "{path}");
        }
    }
}
