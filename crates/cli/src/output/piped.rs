//! Standard output whose reader may go away.

use std::io::{self, Write};

/// Windows: no process has the other end of the pipe. The standard library knows only 109 and 232 as a broken pipe.
const NOT_CONNECTED: i32 = 233;

/// A writer whose reader may go away.
pub(crate) struct Piped<W>(pub(crate) W);

impl<W: Write> Write for Piped<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes).map_err(broken_pipe)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush().map_err(broken_pipe)
    }
}

/// Returns an error of a pipe without a reader as a broken pipe (R13.19).
pub(crate) fn broken_pipe(error: io::Error) -> io::Error {
    if cfg!(windows) && error.raw_os_error() == Some(NOT_CONNECTED) {
        return io::ErrorKind::BrokenPipe.into();
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_that_goes_away_is_a_broken_pipe() {
        // R13.19
        for code in [109, 232, NOT_CONNECTED] {
            let kind = broken_pipe(io::Error::from_raw_os_error(code)).kind();
            assert_eq!(kind == io::ErrorKind::BrokenPipe, cfg!(windows), "{code}");
        }
    }
}
