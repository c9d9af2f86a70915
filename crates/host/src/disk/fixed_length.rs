//! A file that must keep the length that it had when it was opened.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};

/// Reads a file up to its original end, and fails if the file does not end there. A program with a missing
/// or an added part would leave a state other than that of the whole program.
#[derive(Debug)]
pub(crate) struct FixedLengthReader {
    file: File,
    /// The original length, if the file has one.
    length: Option<u64>,
    /// Number of bytes read.
    at: u64,
}

impl FixedLengthReader {
    /// Takes an open file with its metadata. Pipes have no length, and files that the system generates
    /// while they are read report 0.
    pub(crate) fn new(mut file: File, metadata: &Metadata) -> Self {
        let has_length = metadata.is_file() && metadata.len() > 0;
        let at = file.stream_position().unwrap_or_default();
        Self {
            file,
            length: has_length.then_some(metadata.len()),
            at,
        }
    }
}

impl Read for FixedLengthReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let Some(length) = self.length else {
            return self.file.read(buffer);
        };
        let left = usize::try_from(length.saturating_sub(self.at)).unwrap_or(usize::MAX);
        let is_at_end = left == 0;
        // One byte after the end shows that the file has grown.
        let most = buffer.len().min(left.max(1));
        let count = self.file.read(&mut buffer[..most])?;
        if most > 0 && (count == 0) != is_at_end {
            return Err(io::Error::other("it changed while it was read"));
        }
        self.at += u64::try_from(count).unwrap_or_default();
        Ok(count)
    }
}

impl Seek for FixedLengthReader {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.at = self.file.seek(position)?;
        Ok(self.at)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn what_is_added_to_a_file_is_not_read() {
        // R2.12 R9.26
        let named = tempfile::NamedTempFile::new().unwrap();
        named.as_file().write_all(b"N10 X1.5\n").unwrap();
        let file = named.reopen().unwrap();
        let mut steady = FixedLengthReader::new(file, &named.as_file().metadata().unwrap());
        named.as_file().write_all(b"M30\n").unwrap();
        let mut read = Vec::new();
        assert!(steady.read_to_end(&mut read).is_err());
        assert_eq!(read, b"N10 X1.5\n");
    }

    #[test]
    fn a_file_that_changed_is_noticed() {
        for (length, is_steady) in [(9, true), (8, false), (10, false), (0, false)] {
            let named = tempfile::NamedTempFile::new().unwrap();
            named.as_file().write_all(b"N10 X1.5\n").unwrap();
            let file = named.reopen().unwrap();
            let mut steady = FixedLengthReader::new(file, &named.as_file().metadata().unwrap());
            named.as_file().set_len(length).unwrap();
            for _ in 0..2 {
                steady.rewind().unwrap();
                let read = steady.read_to_end(&mut Vec::new());
                assert_eq!(read.is_ok(), is_steady, "{length}");
            }
        }
    }
}
