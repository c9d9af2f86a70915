//! What is assumed about stiction compensation.

use super::assumption::Assumption;

pub(super) const ASSUMED: &[Assumption] = &[Assumption {
    rule: "R8.2",
    sentence: "stiction is compensated at a commanded feed of exactly MP1513, and at every lower one",
    changes: "whether it acts",
    shows: "the last line of `frictcomp stiction`",
    when: &[],
}];
