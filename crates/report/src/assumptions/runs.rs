//! Assumptions about runs as a whole.

use super::assumption::Assumption;
use super::assumption::When::Stopped;

pub(super) const ASSUMED: &[Assumption] = &[Assumption {
    rule: "R9.20",
    sentence: "an error ends the session, because the channel stays in the error state",
    changes: "programs after the failing one do not run",
    shows: "the end record says `error`; `--keep-going` continues",
    when: &[Stopped],
}];
