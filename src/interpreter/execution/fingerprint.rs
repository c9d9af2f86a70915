//! Fingerprints: short numbers that show whether a text or saved data has changed.

use std::fmt;
use std::hash::Hasher as _;

use fnv::FnvHasher;
use postcard::ser_flavors::Flavor;
use serde::{Deserialize, Serialize};

/// The fingerprint of a text or of saved data: the same for the same bytes, on every machine and in
/// every version. It shows what changed by mistake; it does not protect against forgery.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub(crate) struct Fingerprint(u64);

/// A text that is not a fingerprint.
#[derive(Debug, thiserror::Error)]
#[error("a fingerprint has 16 hexadecimal digits")]
pub(crate) struct NoFingerprint;

impl Fingerprint {
    /// The fingerprint of a text.
    pub(crate) fn of_text(text: &str) -> Self {
        let mut hasher = FnvHasher::default();
        hasher.write(text.as_bytes());
        Self(hasher.finish())
    }

    /// The fingerprint of data, computed over its serialised bytes. `None` for data that cannot be
    /// serialised.
    pub(crate) fn of_data(data: &impl Serialize) -> Option<Self> {
        let bytes = Bytes(FnvHasher::default());
        postcard::serialize_with_flavor(data, bytes).ok()
    }
}

/// Takes the bytes of data one after another without keeping them.
struct Bytes(FnvHasher);

impl Flavor for Bytes {
    type Output = Fingerprint;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.0.write_u8(byte);
        Ok(())
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.0.write(bytes);
        Ok(())
    }

    fn finalize(self) -> postcard::Result<Fingerprint> {
        Ok(Fingerprint(self.0.finish()))
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl From<Fingerprint> for String {
    fn from(fingerprint: Fingerprint) -> Self {
        fingerprint.to_string()
    }
}

impl TryFrom<String> for Fingerprint {
    type Error = NoFingerprint;

    fn try_from(text: String) -> Result<Self, NoFingerprint> {
        let is_written_so = |number: &u64| format!("{number:016x}") == text;
        let number = u64::from_str_radix(&text, 16).ok();
        number.filter(is_written_so).map(Self).ok_or(NoFingerprint)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fingerprint_is_the_same_everywhere() {
        let text = Fingerprint::of_text("N10 M30\n");
        assert_eq!(text.to_string(), "cb1b80c8f84f73ea");
        assert_ne!(text, Fingerprint::of_text("N10 M30"));
        let data = Fingerprint::of_data(&(1_u32, "X", [Some(1.5), None]));
        assert_eq!(data.map(String::from).as_deref(), Some("39a203fb83b150d3"));
    }

    #[test]
    fn only_its_own_digits_are_one() {
        let read = |text: &str| Fingerprint::try_from(text.to_owned()).is_ok();
        assert!(read("00000000000000ff"));
        assert!(!read("ff") && !read("00000000000000FF") && !read("+0000000000000ff"));
    }
}
