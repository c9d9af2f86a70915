//! Whole files, and their fingerprints.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::decode::decode;
use crate::error::HostError;

/// Size above which files are not kept in memory.
pub(crate) const MOST_KEPT: usize = 1 << 30;

/// Opens a regular file only: a pipe would block, a device has no end.
///
/// # Errors
/// It does not exist, cannot be read, or is not a regular file.
pub(crate) fn open_regular(path: &Path) -> io::Result<(File, Metadata)> {
    // Checked before it is opened: opening a pipe waits for its other end.
    let metadata = std::fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !metadata.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    Ok((file, metadata))
}

/// Reads and decodes a whole file.
///
/// # Errors
/// It does not exist, cannot be read, is a folder, or is too big to be kept.
pub fn read_text(path: &Path) -> Result<String, HostError> {
    read_bytes(path)
        .map(decode)
        .map_err(|error| HostError::read(path, error))
}

/// Reads a whole file.
///
/// # Errors
/// It does not exist, cannot be read, is a folder, or is too big to be kept.
pub(crate) fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let (file, metadata) = open_regular(path)?;
    read_whole(file, metadata.len())
}

/// Reads a file whose length fits in memory.
pub(crate) fn read_whole(reader: impl Read, length: u64) -> io::Result<Vec<u8>> {
    let most = u64::try_from(MOST_KEPT).expect("1 GiB is below 2^64");
    if length > most {
        return Err(too_big());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(length).expect("at most 1 GiB"));
    reader.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() > MOST_KEPT {
        return Err(too_big());
    }
    Ok(bytes)
}

/// Returns the error for a text that is too big to be kept in memory.
pub(crate) fn too_big() -> io::Error {
    let reason = "it is larger than 1 GiB, which is too much to keep in memory";
    io::Error::new(io::ErrorKind::FileTooLarge, reason)
}

/// Number of bytes read at a time.
const PIECE: usize = 1 << 16;

/// Returns the SHA-256 of a file in hexadecimal digits.
///
/// # Errors
/// It cannot be read, or is not a regular file.
pub fn sha256_of(path: &Path) -> Result<String, HostError> {
    let failed = |error| HostError::read(path, error);
    let (mut file, _) = open_regular(path).map_err(failed)?;
    let mut digest = Sha256::new();
    let mut piece = vec![0; PIECE];
    loop {
        match file.read(&mut piece).map_err(failed)? {
            0 => break,
            length => digest.update(&piece[..length]),
        }
    }
    Ok(format!("{:x}", digest.finalize()))
}

/// Returns the SHA-256 of data, by which a result is kept as long as they are the same.
///
/// # Panics
/// Data that are no JSON, such as a map whose keys are not texts.
pub(crate) fn sha256_of_data(data: &impl Serialize) -> String {
    sha256_of_text(&serde_json::to_string(data).expect("data of keys are fields and lists"))
}

/// Returns the SHA-256 of a text in hexadecimal digits.
pub(crate) fn sha256_of_text(text: &str) -> String {
    format!("{:x}", Sha256::digest(text))
}
