//! Facts about each question: the one table.

use super::question::Alternative::{self, First};
use Way::{Note, Program, Recording};

crate::words! {
    /// Way to put a question to a control (R15.1).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Way {
        /// An NC program that writes the answer to a file on the control.
        Program = "program",
        /// A recording of a motion.
        Recording = "recording",
        /// A written observation of an operator.
        Note = "note",
    }
}

/// Facts about a question. The texts put program words in backquotes.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct QuestionFacts {
    /// The rule of `docs/rules` that depends on the answer.
    pub rule: &'static str,
    /// The question in plain words.
    pub question: &'static str,
    /// The names of the two readings.
    pub readings: [&'static str; 2],
    /// Meaning of each reading.
    pub meanings: [&'static str; 2],
    /// The assumed reading; `None` if neither is assumed, so that the differences are unknown.
    pub assumed: Option<Alternative>,
    /// The reason for assuming it.
    pub why: &'static str,
    /// Results that depend on the answer.
    pub depends: &'static str,
    /// Way to put the question.
    pub way: Way,
    /// Source of the answer: the command, the channel, or the operator's note.
    pub how: &'static str,
}

impl QuestionFacts {
    /// Returns the name of the reading assumed without an answer, `unknown` if neither is.
    pub fn assumed_name(&self) -> &'static str {
        self.assumed
            .map_or("unknown", |reading| self.readings[reading as usize])
    }
}

/// Facts on the questions, in the order of [`Question::ALL`](super::Question::ALL).
pub(super) static FACTS: [QuestionFacts; 30] = [
    QuestionFacts {
        rule: "R1.8",
        question: "Does the control take keywords of a COMP command in lower case?",
        readings: ["accepted", "refused"],
        meanings: [
            "`X[comp off frict]` switches",
            "`X[comp off frict]` is an error",
        ],
        assumed: Some(First),
        why: "programs in lower case exist; every document prints upper case",
        depends: "programs with such keywords stop or continue (FC404, FC306)",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after the command; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R1.9",
        question: "Does a COMP command act before the motion of its own block?",
        readings: ["before", "after"],
        meanings: [
            "the motion of a block with COMP is made in the new state",
            "the motion of a block with COMP is made in the old state",
        ],
        assumed: Some(First),
        why: "technology functions of a block act before its motion",
        depends: "which motion is compensated where COMP shares a block (FC405, P-ERR-70435)",
        way: Recording,
        how: "`frict_comp.f_is_active` with the commanded position in a block with both",
    },
    QuestionFacts {
        rule: "R1.24",
        question: "Does a syntax check on the control find P-ERR-70495?",
        readings: ["reported", "passed"],
        meanings: [
            "the syntax check reports it",
            "only the run reports it; the syntax check passes",
        ],
        assumed: None,
        why: "no document says which mode of the decoder knows the axis parameters",
        depends: "whether a syntax check on the control replaces this tool; no state",
        way: Note,
        how: "the error number that the syntax check shows, or none",
    },
    QuestionFacts {
        rule: "R1.25",
        question: "Is `COMP OFF FRICT` an error on an axis whose P-AXIS-00522 is 0?",
        readings: ["accepted", "refused"],
        meanings: [
            "`COMP OFF` without P-AXIS-00522 does nothing",
            "`COMP OFF` without P-AXIS-00522 is an error",
        ],
        assumed: Some(First),
        why: "the documents tie P-ERR-70495 to switching on",
        depends: "programs that switch off an axis without 00522 stop or continue (FC402, FC306)",
        way: Program,
        how: "whether the program reaches its last message; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R1.26",
        question: "Is `COMP ON FRICT` an error on an axis without an accepted value list?",
        readings: ["ineffective", "refused"],
        meanings: [
            "`COMP ON` without a value list selects without effect",
            "`COMP ON` without a value list is an error",
        ],
        assumed: Some(First),
        why: "the documents say when it is active and name no error",
        depends: "whether such programs stop (FC303, FC306)",
        way: Program,
        how: "whether the program reaches its last message; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R1.28",
        question: "Does a reset of the channel keep what COMP switched?",
        readings: ["kept", "start-up"],
        meanings: [
            "a reset keeps the state",
            "a reset restores the state at the start of the control",
        ],
        assumed: Some(First),
        why: "the state outlives the program, and no document names reset",
        depends: "what the program after a reset finds (FC401, FC403, FC910)",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after a reset between two programs",
    },
    QuestionFacts {
        rule: "R1.29",
        question: "Does a restart of the control set the state by P-AXIS-00522 again?",
        readings: ["start-up", "kept"],
        meanings: [
            "a restart sets the state by P-AXIS-00522",
            "a restart keeps the state",
        ],
        assumed: Some(First),
        why: "with P-AXIS-00522 it is active directly after controller start-up",
        depends: "the first state of every session without a state file",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after a restart between two programs",
    },
    QuestionFacts {
        rule: "R1.31",
        question: "Which of two opposite COMP commands for one axis in one block wins?",
        readings: ["last", "first"],
        meanings: [
            "the last of two opposite commands wins",
            "the first of two opposite commands wins",
        ],
        assumed: Some(First),
        why: "words of a block are read from left to right",
        depends: "the state after such a block (FC301)",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after the block",
    },
    QuestionFacts {
        rule: "R1.36",
        question: "Does an axis that misses a compensation of P-AXIS-00465 raise P-ERR-70435 while homing?",
        readings: ["free", "monitored"],
        meanings: ["G74 is not monitored", "G74 is monitored like other motion"],
        assumed: Some(First),
        why: "the page of the parameter speaks of automatic mode and excepts homing",
        depends: "P-ERR-70435 at G74",
        way: Note,
        how: "the error number that homing shows, or none, with FRICT in P-AXIS-00465 and off",
    },
    QuestionFacts {
        rule: "R1.40",
        question: "Is a kind with manual activation off at the start of the control?",
        readings: ["off", "on"],
        meanings: [
            "a kind with manual activation is off until a program switches it on",
            "on like any other; off only after program end",
        ],
        assumed: Some(First),
        why: "the control's data call it an activation by the program",
        depends: "the first state of LEAD, CROSS, PLANE, TEMP and CROSSTALK; never of FRICT",
        way: Program,
        how: "`V.A.LEAD_COMP_ACTIVE` in the first program after a restart",
    },
    QuestionFacts {
        rule: "R1.57",
        question: "Does a COMP command for FRICT between two moves stop the path, and with it the look-ahead?",
        readings: ["runs-on", "stops"],
        meanings: [
            "the path continues at its feed after a COMP command",
            "a COMP command stops the path",
        ],
        assumed: Some(First),
        why: "no document says that the command flushes the channel; a mark on the part is the worse case",
        depends: "whether the additive current jumps at a moving axis (FC409)",
        way: Recording,
        how: "the commanded velocity at a COMP command between two moves in one direction",
    },
    QuestionFacts {
        rule: "R2.40",
        question: "What does `$CONTINUE` do in a `$SWITCH` outside a loop?",
        readings: ["leaves", "nothing"],
        meanings: [
            "`$CONTINUE` leaves the `$SWITCH`",
            "`$CONTINUE` is passed over",
        ],
        assumed: None,
        why: "error 20244 allows it there, and no page says what it does",
        depends: "which blocks of the `$SWITCH` are executed (FC901)",
        way: Program,
        how: "whether the block after `$CONTINUE` is executed",
    },
    QuestionFacts {
        rule: "R2.70",
        question: "Does an axis keep its compensation when it is released and requested again?",
        readings: ["kept", "start-up"],
        meanings: [
            "an axis that is requested again comes back as it went",
            "an axis that is requested again comes back in its state at the start of the control",
        ],
        assumed: Some(First),
        why: "the compensation belongs to the axis, not to the channel",
        depends: "the state after `#CALL AX` and its neighbours",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after `#PUT AX` and `#CALL AX`",
    },
    QuestionFacts {
        rule: "R2.90",
        question: "Does a skip level that is switched while a program runs act at once?",
        readings: ["at-once", "at-start"],
        meanings: [
            "a level acts as soon as it is switched",
            "a level is read when the program starts",
        ],
        assumed: None,
        why: "one public page says at once, another at the start: both are possible until tested",
        depends: "whether ways on which a level was switched in between count (FC901)",
        way: Program,
        how: "a `V.S.` variable that a block with a skip mark writes after the level is switched on at M00",
    },
    QuestionFacts {
        rule: "R2.92",
        question: "Does `#MACHINE DATA` on P-AXIS-00522 take back what COMP switched?",
        readings: ["start-up", "kept"],
        meanings: [
            "the axis list is taken over again, and with it its selection",
            "what COMP switched stays",
        ],
        assumed: None,
        why: "the page says that the whole list is transferred again, not what becomes of selections",
        depends: "the state after such a command (FC314)",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after the command",
    },
    QuestionFacts {
        rule: "R2.96",
        question: "Does a block search execute the COMP commands that it passes?",
        readings: ["executed", "decoded"],
        meanings: [
            "commands before the searched block act",
            "commands before the searched block are only read",
        ],
        assumed: None,
        why: "the pages on block search do not mention axis commands",
        depends: "the states after `run --from` (FC413)",
        way: Program,
        how: "`V.A.FRICT_COMP_ACTIVE` after a block search past a COMP command",
    },
    QuestionFacts {
        rule: "R2.100",
        question: "Does `#ERROR` without `RC` end the program?",
        readings: ["goes-on", "stops"],
        meanings: [
            "`#ERROR` without `RC` is a warning, and the program goes on",
            "`#ERROR` without `RC` stops the program",
        ],
        assumed: None,
        why: "the page of the command calls `RC` optional and names no default",
        depends: "whether what follows such a command is executed (FC902)",
        way: Program,
        how: "whether the program reaches its last message; a stop is noted by hand",
    },
    QuestionFacts {
        rule: "R2.101",
        question: "Which whole number does a variable of an integer type keep of a fraction?",
        readings: ["cut", "rounded"],
        meanings: [
            "the digits after the point are cut off",
            "the value is rounded to the nearest whole number",
        ],
        assumed: None,
        why: "the page of the types calls the value whole and says no more",
        depends: "the value of such a variable, and what is computed from it (FC328)",
        way: Program,
        how: "the value of a variable of the type SGN16 after 0.5 is assigned to it",
    },
    QuestionFacts {
        rule: "R2.102",
        question: "Does the control take local variables and elements of arrays that no `#VAR` declares?",
        readings: ["accepted", "refused"],
        meanings: [
            "a variable that is written without a declaration comes into being",
            "writing a variable without a declaration is an error",
        ],
        assumed: None,
        why: "the manual shows declarations only and names no error",
        depends: "whether such programs stop (FC328, FC306)",
        way: Program,
        how: "whether the program reaches its last message; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R2.103",
        question: "Is a jump into a loop or a `$SWITCH` from outside refused?",
        readings: ["accepted", "refused"],
        meanings: [
            "`$GOTO` may enter a loop or a `$SWITCH`",
            "`$GOTO` into a loop or a `$SWITCH` is an error",
        ],
        assumed: None,
        why: "error 21480 names jumps within a loop, and the manual allows those into `$IF`",
        depends: "whether such programs stop (FC328, FC306)",
        way: Program,
        how: "whether the program reaches its last message; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R2.104",
        question: "Are two words that call programs refused in one block, `T3 M6`?",
        readings: ["accepted", "refused"],
        meanings: ["both programs run", "the block is an error"],
        assumed: None,
        why: "of error 22008 only the title is public",
        depends: "whether such programs stop (FC328, FC306)",
        way: Note,
        how: "whether the control shows error 22008 where both words of a block have a program",
    },
    QuestionFacts {
        rule: "R2.109",
        question: "Is a COMP command refused within the description of a contour or a stroke?",
        readings: ["accepted", "refused"],
        meanings: [
            "COMP switches within `#CONTOUR BEGIN` and `#STROKE DEF BEGIN`",
            "COMP is an error there",
        ],
        assumed: None,
        why: "the pages of errors 22101 and 120716 list no command of an axis bracket",
        depends: "whether such programs stop (FC328, FC306)",
        way: Program,
        how: "whether the program reaches its last message; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R2.111",
        question: "Is the reading of a `V.E.` variable refused under G41, G42 and in a spline?",
        readings: ["accepted", "refused"],
        meanings: [
            "a `V.E.` variable may be read there",
            "reading a `V.E.` variable is an error there",
        ],
        assumed: None,
        why: "a synchronous variable (P-EXTV-00005) flushes the channel, and the list of external variables is not read",
        depends: "whether such programs stop (FC328, FC306)",
        way: Note,
        how: "whether the control shows error 20651 where a program reads the variable under G41",
    },
    QuestionFacts {
        rule: "R2.112",
        question: "Are numbers equal that differ only by the rounding of a computation, 0.1 + 0.2 and 0.3?",
        readings: ["equal", "different"],
        meanings: ["comparisons have a tolerance", "comparisons are exact"],
        assumed: None,
        why: "the manual recommends a tolerance for the end of a loop and says no more",
        depends: "which branch such a comparison takes (FC901)",
        way: Program,
        how: "whether `$IF` takes 0.1 + 0.2 for 0.3",
    },
    QuestionFacts {
        rule: "R2.113",
        question: "Is the program number `O1234` refused?",
        readings: ["accepted", "refused"],
        meanings: ["`O1234` has no effect", "`O1234` is an error"],
        assumed: None,
        why: "error 20192 calls it not implemented; the grammar of the language has it",
        depends: "whether such programs stop (FC328, FC306)",
        way: Program,
        how: "whether the program reaches its last message; an error is noted by hand",
    },
    QuestionFacts {
        rule: "R4.2",
        question: "Does the current decay linearly over the cycles before a reversal?",
        readings: ["linear", "step"],
        meanings: [
            "the current decays by the same part in each of the cycles",
            "the current is zero from the first of the cycles on",
        ],
        assumed: Some(First),
        why: "the documents call the build-up linear and the figure shows a ramp on both sides",
        depends: "the current in the last cycles before a reversal",
        way: Recording,
        how: "`frict_comp.output` before a reversal, with the velocity",
    },
    QuestionFacts {
        rule: "R4.3",
        question: "Does the current build up at every start, also after a stop in the same direction?",
        readings: ["first", "every"],
        meanings: [
            "the current builds up after a reversal and at the first start",
            "the current builds up after every standstill",
        ],
        assumed: Some(First),
        why: "the weighting is described for reversals; one manual speaks of starting",
        depends: "the current after a stop without a reversal",
        way: Recording,
        how: "`frict_comp.output` at a start in the direction of the motion before",
    },
    QuestionFacts {
        rule: "R4.5",
        question: "Does `delay_cycles` delay the whole output?",
        readings: ["all", "reversal"],
        meanings: [
            "`delay_cycles` is a dead time of every value",
            "`delay_cycles` delays only the build-up after a reversal",
        ],
        assumed: Some(First),
        why: "the description of the parameter says all values; its title names the reversal",
        depends: "the current after every change of velocity",
        way: Recording,
        how: "`frict_comp.output` with the velocity at a change of feed",
    },
    QuestionFacts {
        rule: "R4.6",
        question: "Is the current held at standstill?",
        readings: ["hold", "zero"],
        meanings: [
            "the last value is held at standstill",
            "nothing is added at standstill",
        ],
        assumed: Some(First),
        why: "a servo at rest needs the value; the documents say that it compensates path motion",
        depends: "the current of an axis at rest (C11)",
        way: Recording,
        how: "`frict_comp.output` at standstill after a motion",
    },
    QuestionFacts {
        rule: "R4.7",
        question: "Is the first output of the list held at lower velocities?",
        readings: ["hold", "origin"],
        meanings: [
            "the first output is held below the first point",
            "the output falls to zero below the first point",
        ],
        assumed: Some(First),
        why: "friction does not vanish at low velocity",
        depends: "the current at velocities below the first point",
        way: Recording,
        how: "`frict_comp.output` at a constant velocity below the first point",
    },
];
