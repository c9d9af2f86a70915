//! The meaning of the exit status (R9.26).

/// Nothing at or above `--fail-on` was said.
pub(super) const CLEAN: u8 = 0;

/// Something at or above `--fail-on` was said, or a comparison found a difference.
pub(super) const FOUND: u8 = 1;

/// The tool could not do its work: usage, a file, the configuration.
pub(super) const FAILED: u8 = 2;
