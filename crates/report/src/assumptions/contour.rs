//! Assumptions about contours.

use super::assumption::Assumption;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R11.1",
        sentence: "the second axis of the plane has the drive Y of the plant, and every other driven \
            axis its drive X",
        changes: "deviation and glitches of further axes",
        shows: "a plant file whose X is the drive of that axis, with `--plane`",
        when: &[],
    },
    Assumption {
        rule: "R11.1",
        sentence: "where the machine has no value list that the control takes, the compensation that \
            the program switches is the friction curve of the plant",
        changes: "the run as programmed; on the control nothing is added without a list",
        shows: "the report names the source of each list",
        when: &[],
    },
];
