//! A file that must stay as long as it was when it was looked through.

use std::fs::File;
use std::io::{self, Read};

/// Reads a file and fails where it turns out shorter or longer than it was. A program of which a
/// part is missing would leave a state that its whole would not leave.
#[derive(Debug)]
pub(super) struct Steady {
    file: File,
    /// The bytes that are still to come.
    left: u64,
}

impl Steady {
    /// The file, from where it stands, with the bytes that it has from there on.
    pub(super) fn new(file: File, length: u64) -> Self {
        Self { file, left: length }
    }
}

impl Read for Steady {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        let taken = u64::try_from(count).expect("a buffer is smaller than 2^64 bytes");
        let is_early_end = count == 0 && !buffer.is_empty() && self.left > 0;
        match self.left.checked_sub(taken) {
            Some(left) if !is_early_end => {
                self.left = left;
                Ok(count)
            }
            _ => Err(io::Error::other("it changed while it was read")),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_file_that_changed_is_noticed() {
        let path = tempfile::NamedTempFile::new().unwrap();
        path.as_file().write_all(b"N10 X1\n").unwrap();
        for (length, is_steady) in [(7, true), (6, false), (8, false), (0, false)] {
            let mut steady = Steady::new(path.reopen().unwrap(), length);
            let read = steady.read_to_end(&mut Vec::new());
            assert_eq!(read.is_ok(), is_steady, "{length}");
        }
    }
}
