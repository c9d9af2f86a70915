//! A file that must stay as long as it was when it was opened.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};

/// Reads a file and fails at its end where that is not the end that it had. A program of which a
/// part is missing would leave a state that its whole would not leave.
#[derive(Debug)]
pub(super) struct Steady {
    file: File,
    /// The length that it had, where it has one.
    length: Option<u64>,
}

impl Steady {
    /// An open file with what is known of it. Pipes have no length, and files that the system
    /// makes up while they are read say 0.
    pub(super) fn new(file: File, metadata: &Metadata) -> Self {
        let has_length = metadata.is_file() && metadata.len() > 0;
        Self {
            file,
            length: has_length.then_some(metadata.len()),
        }
    }
}

impl Read for Steady {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        if count == 0
            && !buffer.is_empty()
            && let Some(length) = self.length
            && self.file.stream_position()? != length
        {
            return Err(io::Error::other("it changed while it was read"));
        }
        Ok(count)
    }
}

impl Seek for Steady {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_file_that_changed_is_noticed() {
        for (length, is_steady) in [(9, true), (8, false), (10, false), (0, false)] {
            let named = tempfile::NamedTempFile::new().unwrap();
            named.as_file().write_all(b"N10 X1.5\n").unwrap();
            let file = named.reopen().unwrap();
            let mut steady = Steady::new(file, &named.as_file().metadata().unwrap());
            named.as_file().set_len(length).unwrap();
            for _ in 0..2 {
                steady.rewind().unwrap();
                let read = steady.read_to_end(&mut Vec::new());
                assert_eq!(read.is_ok(), is_steady, "{length}");
            }
        }
    }
}
