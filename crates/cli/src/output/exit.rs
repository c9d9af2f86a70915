//! The meaning of the exit status (R9.26).

/// Success: no message at or above `--fail-on`.
pub(crate) const CLEAN: u8 = 0;

/// A message at or above `--fail-on`, or a comparison that found a difference.
pub(crate) const FOUND: u8 = 1;

/// The tool could not do its work: usage, a file, the configuration.
pub(crate) const FAILED: u8 = 2;
