//! Assumptions about the additive current.

use super::assumption::Assumption;
use super::assumption::When::Reported;
use frictcomp::diagnostic::Code;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R4.2",
        sentence: "before a reversal the current decays linearly over time; the documents call only the \
            build-up linear",
        changes: "the current in the last cycles before a reversal",
        shows: "the column `w_before`",
        when: &[],
    },
    Assumption {
        rule: "R4.3",
        sentence: "the current builds up after a reversal and at the first start, not at every start in \
            the same direction; between two points of the list it is linear",
        changes: "the current after a stop without a reversal; the curve",
        shows: "`--reading start=every`; the column `w_after`",
        when: &[],
    },
    Assumption {
        rule: "R4.5",
        sentence: "delay_cycles delays the whole output",
        changes: "the current after every change of velocity",
        shows: "`--reading delay=reversal`; `current` prints its reading",
        when: &[],
    },
    Assumption {
        rule: "R4.6, C11",
        sentence: "the current is held at standstill",
        changes: "the current of an axis at standstill",
        shows: "C11 on stderr, with the cycles in which it matters; `--reading standstill=zero`",
        when: &[],
    },
    Assumption {
        rule: "R4.6",
        sentence: "where a recorded velocity changes sign twice within 5 cycles and 1 µm, the axis \
            stands still",
        changes: "how many reversals a recorded trace has",
        shows: "the count on stderr; `--dead-band`",
        when: &[],
    },
    Assumption {
        rule: "R4.7",
        sentence: "the first output is held below the first point",
        changes: "the current at low velocity",
        shows: "`--reading below=origin`",
        when: &[],
    },
    Assumption {
        rule: "R4.8",
        sentence: "the smaller of the two weights applies",
        changes: "short moves between two reversals",
        shows: "the columns `w_before`, `w_after`",
        when: &[],
    },
    Assumption {
        rule: "R4.9, C12",
        sentence: "`out` values have the sign of the torque at positive velocity",
        changes: "the sign of the current",
        shows: "C12 on stderr; the column `current`",
        when: &[],
    },
    Assumption {
        rule: "R4.10",
        sentence: "COMP ON is a first start",
        changes: "the current builds up with the first motion after it",
        shows: "the column `w_after`",
        when: &[],
    },
    Assumption {
        rule: "R4.11",
        sentence: "outputs are rounded half away from zero and limited to 16 bit",
        changes: "the integer for the drive",
        shows: "the column `output`, FC137 on stderr",
        when: &[Reported(Code::Fc137)],
    },
];
