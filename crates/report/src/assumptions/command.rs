//! Assumptions about the COMP command.

use super::assumption::Assumption;
use super::assumption::When::{Always, NoMachine, Reported};
use frictcomp::diagnostic::Code;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R1.6",
        sentence: "`NO_MOVE` makes no difference to FRICT",
        changes: "nothing in the state; on the machine at most a motion",
        shows: "nothing; the command acts as it does without the word",
        when: &[],
    },
    Assumption {
        rule: "R1.7",
        sentence: "only blanks and tabs separate tokens",
        changes: "`X[COMP ON FRICT, LEAD]` is an error and switches nothing",
        shows: "FC202 at the comma",
        when: &[Reported(Code::Fc202)],
    },
    Assumption {
        rule: "R1.8",
        sentence: "keywords in lower case are accepted",
        changes: "a control that refuses them would stop there",
        shows: "FC404 at the word",
        when: &[Reported(Code::Fc404)],
    },
    Assumption {
        rule: "R1.9",
        sentence: "in a block with motion words the command takes effect first",
        changes: "whether the motion in this block is compensated",
        shows: "FC405 at the command",
        when: &[Reported(Code::Fc405)],
    },
    Assumption {
        rule: "1.1",
        sentence: "a malformed COMP command is refused as a whole",
        changes: "correctly spelled kinds in it are not switched either",
        shows: "FC201 to FC205 at the place, no change in the block's record",
        when: &[
            Reported(Code::Fc201),
            Reported(Code::Fc202),
            Reported(Code::Fc203),
            Reported(Code::Fc204),
            Reported(Code::Fc205),
        ],
    },
    Assumption {
        rule: "1.1",
        sentence: "spindles have no COMP",
        changes: "the command is an error",
        shows: "FC302",
        when: &[Reported(Code::Fc302)],
    },
    Assumption {
        rule: "R1.24",
        sentence: "a command with FRICT and other kinds is refused as a whole if the axis is not \
            configured for FRICT",
        changes: "the other kinds do not change",
        shows: "P-ERR-70495, no change in the block's record",
        when: &[Reported(Code::PErr70495)],
    },
    Assumption {
        rule: "R1.25",
        sentence: "switching off an axis that is not configured is no error",
        changes: "the program continues",
        shows: "FC402 at the command, unless it is the first for the axis; FC408 if no machine is \
            described",
        when: &[Reported(Code::Fc402), Reported(Code::Fc408)],
    },
    Assumption {
        rule: "R1.26",
        sentence: "switching on without an accepted value list is no error",
        changes: "the program continues, the state is `ineffective`",
        shows: "FC303 says what is missing",
        when: &[Reported(Code::Fc303)],
    },
    Assumption {
        rule: "R1.28",
        sentence: "a reset does not change the state",
        changes: "the state at the start of the next program",
        shows: "the page of FC401; sessions and state files do not reset friction compensation",
        when: &[Reported(Code::Fc401)],
    },
    Assumption {
        rule: "R1.29",
        sentence: "a restart sets the state by P-AXIS-00522",
        changes: "the state at the start of the first program",
        shows: "the session record: each run without `--state` is a restart",
        when: &[Always],
    },
    Assumption {
        rule: "R1.30",
        sentence: "a command acts when its block is executed",
        changes: "programs with loops, branches and subprograms",
        shows: "each executed block has a record with the state after it",
        when: &[Always],
    },
    Assumption {
        rule: "R1.30",
        sentence: "nothing but programs switches compensation while they run: neither the PLC nor an \
            object of the control, as temperature compensation has one (error 70253)",
        changes: "every state after a switch from outside",
        shows: "nothing; a dry run knows programs only",
        when: &[Always],
    },
    Assumption {
        rule: "R1.31",
        sentence: "the commands in a block act from left to right",
        changes: "blocks that switch the same kind twice",
        shows: "FC301",
        when: &[Reported(Code::Fc301)],
    },
    Assumption {
        rule: "R1.36",
        sentence: "FRICT is allowed in P-AXIS-00465 (from the control's data)",
        changes: "whether motion without friction compensation is an error",
        shows: "P-ERR-70435",
        when: &[Reported(Code::PErr70435)],
    },
    Assumption {
        rule: "R1.37",
        sentence: "without a configuration every parameter has its documented default",
        changes: "each `COMP ON FRICT` raises P-ERR-70495",
        shows: "the help lines of P-ERR-70495",
        when: &[NoMachine],
    },
    Assumption {
        rule: "R1.57",
        sentence: "a command for FRICT does not stop the path",
        changes: "whether the current jumps where an axis is switched while it moves on",
        shows: "FC409",
        when: &[Reported(Code::Fc409)],
    },
    Assumption {
        rule: "R1.40",
        sentence: "with manual activation a kind is off at the start of the control (from the control's \
            data)",
        changes: "the first state of CROSS, PLANE, LEAD, TEMP, CROSSTALK; never FRICT",
        shows: "`--kinds all`, first record",
        when: &[],
    },
];
