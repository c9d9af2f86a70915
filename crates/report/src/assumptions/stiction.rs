//! Assumptions about stiction compensation.

use super::assumption::Assumption;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R8.2",
        sentence: "stiction is compensated at a commanded feed of exactly MP1513, and at every lower one",
        changes: "whether it acts",
        shows: "the last line of `frictcomp stiction`",
        when: &[],
    },
    Assumption {
        rule: "R8.6",
        sentence: "the added feed stays as it is until the servo lag is sampled again, and what was cut off a change is lost",
        changes: "the glitch of a simulated circle, slightly as long as t_C is short",
        shows: "`t_C` in the report of `frictcomp circle`",
        when: &[],
    },
    Assumption {
        rule: "R8.6",
        sentence: "without keys in `[stiction]` MP1511 is 0, MP1512 49, the grating period 20 µm, t_C 3 ms, and MP1513 above every feed",
        changes: "the glitch of a simulated circle",
        shows: "the values in the report of `frictcomp circle`",
        when: &[],
    },
];
