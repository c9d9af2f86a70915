//! Fingerprints of files.

use std::io::Read;
use std::path::Path;

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::read::open_regular;
use crate::error::HostError;

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
