//! Assumptions about the lists.

use super::assumption::Assumption;
use super::assumption::When::Reported;
use frictcomp::diagnostic::Code;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R3.5",
        sentence: "if a key is given twice, the last line applies",
        changes: "the value that is used",
        shows: "FC121 with both places",
        when: &[Reported(Code::Fc121)],
    },
    Assumption {
        rule: "R3.12",
        sentence: "how paths in a start-up list are resolved (from the control's data)",
        changes: "which list is read",
        shows: "FC123 if none is found, FC125 if it is a list of another kind; `frictcomp lists \
            --show` shows the origin of each value",
        when: &[Reported(Code::Fc123), Reported(Code::Fc125)],
    },
    Assumption {
        rule: "R3.14",
        sentence: "axis lists with a different axis number are refused, as value lists are",
        changes: "the axis has no parameters from that list",
        shows: "P-ERR-110229",
        when: &[Reported(Code::PErr110229)],
    },
    Assumption {
        rule: "R3.23",
        sentence: "a list with more entries than max_points is rejected",
        changes: "`ineffective` instead of `active`",
        shows: "FC131",
        when: &[Reported(Code::Fc131)],
    },
    Assumption {
        rule: "R3.24",
        sentence: "a list with a value outside its type is rejected",
        changes: "`ineffective` instead of `active`",
        shows: "FC130",
        when: &[Reported(Code::Fc130)],
    },
    Assumption {
        rule: "R3.25, C1",
        sentence: "a value outside its documented range is used as given",
        changes: "the additive current, never the state",
        shows: "FC132; `--strict` makes it an error",
        when: &[Reported(Code::Fc132)],
    },
    Assumption {
        rule: "R3.26",
        sentence: "a list with missing table lines is rejected, surplus lines are not used",
        changes: "`ineffective` instead of `active`; the curve",
        shows: "FC133, FC134",
        when: &[Reported(Code::Fc133), Reported(Code::Fc134)],
    },
    Assumption {
        rule: "R3.29",
        sentence: "the torque object has 16 bits",
        changes: "the largest additive current",
        shows: "FC137",
        when: &[Reported(Code::Fc137)],
    },
    Assumption {
        rule: "C2",
        sentence: "the sample has 3 table entries",
        changes: "the sample in the tests",
        shows: "the sample loads with FC132 and FC136",
        when: &[],
    },
    Assumption {
        rule: "C3",
        sentence: "the key of P-COMP-00041 is `frict_comp.mode`",
        changes: "whether a list has a mode",
        shows: "FC122 for another spelling",
        when: &[Reported(Code::Fc122)],
    },
    Assumption {
        rule: "C4",
        sentence: "the first velocity may be 0",
        changes: "lists that begin with 0 are accepted",
        shows: "no P-ERR-110591",
        when: &[],
    },
    Assumption {
        rule: "C5",
        sentence: "equal velocities do not ascend",
        changes: "a list with two equal velocities in a row is rejected",
        shows: "P-ERR-110591",
        when: &[Reported(Code::PErr110591)],
    },
    Assumption {
        rule: "C6",
        sentence: "table_entries may equal max_points",
        changes: "a full table is accepted",
        shows: "no FC131",
        when: &[],
    },
    Assumption {
        rule: "C7",
        sentence: "the limit of 20 is the default of max_points",
        changes: "tables of more than 20 points are accepted if max_points allows them",
        shows: "FC131 otherwise",
        when: &[Reported(Code::Fc131)],
    },
    Assumption {
        rule: "C8",
        sentence: "modes other than 0 and 3 are errors",
        changes: "a list with mode 1 or 2 is rejected",
        shows: "P-ERR-110592",
        when: &[Reported(Code::PErr110592)],
    },
    Assumption {
        rule: "C9",
        sentence: "velocities of linear axes are in µm/s",
        changes: "the curve",
        shows: "units in `frictcomp lists --show`",
        when: &[],
    },
    Assumption {
        rule: "C10",
        sentence: "max_points exists since V3.1.3079.06",
        changes: "nothing in the state",
        shows: "the page of P-COMP-00062",
        when: &[],
    },
];
