//! Assumptions about the NC language.

use super::assumption::Assumption;
use super::assumption::When::{NoMachine, PassedOver, Reported};
use frictcomp::diagnostic::Code;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R2.1",
        sentence: "a file that is not UTF-8 is CP1252",
        changes: "the text of comments in the output",
        shows: "FC101 for such characters outside comments and strings",
        when: &[Reported(Code::Fc101)],
    },
    Assumption {
        rule: "R2.5",
        sentence: "address letters in lower case are accepted",
        changes: "a control that refuses them would stop there",
        shows: "FC404",
        when: &[Reported(Code::Fc404)],
    },
    Assumption {
        rule: "R2.8",
        sentence: "a file without a block is no error",
        changes: "the state passes through it unchanged",
        shows: "a program without block records",
        when: &[],
    },
    Assumption {
        rule: "R2.11",
        sentence: "a local subprogram may follow the main program (from the control's data)",
        changes: "whether a call finds it",
        shows: "FC320 if it is not found",
        when: &[Reported(Code::Fc320)],
    },
    Assumption {
        rule: "R2.12",
        sentence: "a main program without M30 ends with its file",
        changes: "the run continues with the next program",
        shows: "FC310",
        when: &[Reported(Code::Fc310)],
    },
    Assumption {
        rule: "R2.12",
        sentence: "M17 and M29 also end a program that was not called",
        changes: "a subprogram can be run and checked on its own",
        shows: "`end-of-file` without FC310",
        when: &[],
    },
    Assumption {
        rule: "R2.13",
        sentence: "global subprograms are searched for beside the caller, then in `program_dirs`",
        changes: "which file is executed if there are two",
        shows: "the `file` of the records",
        when: &[],
    },
    Assumption {
        rule: "R2.13",
        sentence: "a cycle called by `L CYCLE` restores G functions and feed at its end, unless it \
            contains `#RETAIN CYCLE CHANGES`; a plain call does not",
        changes: "positions after the call",
        shows: "`--columns position`",
        when: &[],
    },
    Assumption {
        rule: "R2.15",
        sentence: "start and end programs run where the configuration says (from the \
            control's data)",
        changes: "their commands count",
        shows: "their blocks have records, with `level`",
        when: &[],
    },
    Assumption {
        rule: "R2.16",
        sentence: "only programs in the project are called: the caller's folder, that of \
            `frictcomp.toml`, `program_dirs`, and below",
        changes: "which calls are errors",
        shows: "FC321",
        when: &[Reported(Code::Fc321)],
    },
    Assumption {
        rule: "R2.16",
        sentence: "a call of a program that is not found is an error",
        changes: "the run stops, or continues as if the call were not there",
        shows: "FC320",
        when: &[Reported(Code::Fc320)],
    },
    Assumption {
        rule: "R2.20",
        sentence: "without a configuration X Y Z A B C U V W exist as they occur",
        changes: "P-ERR-21947 is raised only for other names",
        shows: "the session record lists the axes",
        when: &[NoMachine],
    },
    Assumption {
        rule: "R2.23",
        sentence: "which words after `X[` begin a command, and which an expression",
        changes: "what is an error and what is passed over",
        shows: "P-ERR-21301; the summary counts what was passed over",
        when: &[PassedOver, Reported(Code::PErr21301)],
    },
    Assumption {
        rule: "R2.24",
        sentence: "`V.` begins a variable",
        changes: "the axis V needs a different character after it",
        shows: "the block's record",
        when: &[],
    },
    Assumption {
        rule: "R2.33",
        sentence: "the parameters `@P` of a cycle that runs without a call are unknown",
        changes: "branches of a cycle that is checked on its own",
        shows: "FC901 names `@P1`",
        when: &[Reported(Code::Fc901)],
    },
    Assumption {
        rule: "R2.35",
        sentence: "a quoted name of a defined macro stands for its code, in expressions too; macros \
            outlive the program",
        changes: "the meaning of a text",
        shows: "FC207 at a macro that is not defined",
        when: &[Reported(Code::Fc207)],
    },
    Assumption {
        rule: "R2.37",
        sentence: "an expression without a value stops the program",
        changes: "the run stops there",
        shows: "FC312",
        when: &[Reported(Code::Fc312)],
    },
    Assumption {
        rule: "R2.40",
        sentence: "a `$CASE` without `$BREAK` continues with the next case",
        changes: "which commands are executed",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.41",
        sentence: "the end and the step of `$FOR` are computed again at each `$ENDFOR`",
        changes: "how often the loop runs if its blocks change them",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.43",
        sentence: "unbalanced control blocks are an error of the whole program",
        changes: "the program is not executed as written",
        shows: "FC208 at the opener",
        when: &[Reported(Code::Fc208)],
    },
    Assumption {
        rule: "R2.45",
        sentence: "the control refuses two words of one G group",
        changes: "the run stops there",
        shows: "FC313",
        when: &[Reported(Code::Fc313)],
    },
    Assumption {
        rule: "R2.47",
        sentence: "`#` commands that are not modelled do not affect compensation",
        changes: "programs that change parameters or coordinates in this way",
        shows: "the summary counts them; FC314 for friction parameters; positions are marked as not \
            those of the machine",
        when: &[PassedOver, Reported(Code::Fc314)],
    },
    Assumption {
        rule: "R2.47",
        sentence: "coordinates before and after a transformation belong to different systems",
        changes: "positions are unknown until they are programmed again",
        shows: "`--columns position`, column `frame`",
        when: &[],
    },
    Assumption {
        rule: "R2.50",
        sentence: "an unknown value stays unknown and is never guessed",
        changes: "results that depend on it may be `unknown`",
        shows: "state `unknown`, FC901, FC902",
        when: &[Reported(Code::Fc901), Reported(Code::Fc902)],
    },
    Assumption {
        rule: "R2.51",
        sentence: "after a control block with an unknown condition, everything that one of its branches \
            could change is unknown",
        changes: "the state of the axes named there",
        shows: "FC901 names the value and how to give it",
        when: &[Reported(Code::Fc901)],
    },
    Assumption {
        rule: "R2.52",
        sentence: "after a jump with an unknown condition or target the run goes on with the next block; a \
            call of an unknown name is passed over",
        changes: "which blocks are shown; what may differ is `unknown` from where the other way \
            meets, at the latest at program end; every axis is `unknown` after such a call",
        shows: "FC902 names the value and how to give it",
        when: &[Reported(Code::Fc902)],
    },
    Assumption {
        rule: "R2.90",
        sentence: "a block with a skip mark may or may not be executed while the switches of the machine are \
            not given; `/` is level 1",
        changes: "the state of the axes named there",
        shows: "FC901 names the level and how to give it",
        when: &[Reported(Code::Fc901)],
    },
    Assumption {
        rule: "R2.91",
        sentence: "`$GOTO` beside G100 to G102, G106 or G108 waits for the probe as it does beside G310",
        changes: "what differs between both ways is `unknown` where they meet",
        shows: "FC902",
        when: &[Reported(Code::Fc902)],
    },
    Assumption {
        rule: "R2.92",
        sentence: "a list that `#MACHINE DATA` transfers again may take back what NC commands selected",
        changes: "the state of the axis is `unknown`",
        shows: "FC314",
        when: &[Reported(Code::Fc314)],
    },
    Assumption {
        rule: "R2.93",
        sentence: "`#FRICTION` is not described; it may change friction compensation of the axes that it \
            names, or of all",
        changes: "the states after it are unknown",
        shows: "FC902",
        when: &[],
    },
    Assumption {
        rule: "R2.96",
        sentence: "a block search moves nothing; whether it executes the COMP commands that it passes is open",
        changes: "the states after `run --from`",
        shows: "FC413",
        when: &[],
    },
    Assumption {
        rule: "R2.95",
        sentence: "an unknown value is not spoken of where nothing that matters here can differ",
        changes: "FC901 and FC902 are left out there",
        shows: "FC901 and FC902 elsewhere; `check --unknowns` lists every value",
        when: &[Reported(Code::Fc901), Reported(Code::Fc902)],
    },
    Assumption {
        rule: "R2.60",
        sentence: "the budgets are frictcomp's; the control has others",
        changes: "a program beyond a budget is cut off",
        shows: "FC910 to FC914, FC918, FC919, the end record says `budget`",
        when: &[
            Reported(Code::Fc918),
            Reported(Code::Fc919),
            Reported(Code::Fc910),
            Reported(Code::Fc911),
            Reported(Code::Fc912),
            Reported(Code::Fc913),
            Reported(Code::Fc914),
        ],
    },
    Assumption {
        rule: "R2.70",
        sentence: "text that no form of the language explains would stop the control; text of a known \
            form without a known meaning could change whatever such a text can change",
        changes: "the run stops there, or values, positions and states after it are unknown",
        shows: "FC207, FC210",
        when: &[Reported(Code::Fc207), Reported(Code::Fc210)],
    },
    Assumption {
        rule: "R2.70",
        sentence: "an axis that axis exchange gives to another channel keeps its compensation; an axis \
            without a configured number keeps its own name",
        changes: "its states after it came back, and which axis a name means",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.70",
        sentence: "`#ERROR` without a remedy class that is known is a warning, and the program goes on",
        changes: "whether the program stops there",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.71",
        sentence: "a control statement with an unreadable condition still opens its control block, a \
            misspelt one as the statement that it resembles",
        changes: "which blocks are its branches; what they could change is unknown",
        shows: "FC207, FC210",
        when: &[Reported(Code::Fc207), Reported(Code::Fc210)],
    },
    Assumption {
        rule: "R2.73",
        sentence: "`#IF` and `#ENDIF` are paired as `$IF` and `$ENDIF` are",
        changes: "which blocks are executed",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.75",
        sentence: "several words in a block call their programs in the order of the block",
        changes: "which program runs first",
        shows: "the order of the records",
        when: &[],
    },
    Assumption {
        rule: "R2.77",
        sentence: "`L SEQUENCE` whose last block stands before the first runs to the end of the \
            program",
        changes: "which blocks are executed",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.79",
        sentence: "the values of `@X`, `@S` and similar in a call of a cycle are those of the \
            machine",
        changes: "branches of a cycle that depend on them",
        shows: "FC901 names the value",
        when: &[Reported(Code::Fc901)],
    },
    Assumption {
        rule: "R2.80",
        sentence: "`P1 += 1` and similar assign the result, `MIN` and `MAX` take more than two values, \
            and a sign may precede the name of an axis variable",
        changes: "values and what depends on them",
        shows: "the block records",
        when: &[],
    },
    Assumption {
        rule: "R2.81",
        sentence: "the documents do not say whether G functions and feeds of a contour description \
            remain active after it",
        changes: "positions and feeds after it are unknown until they are programmed",
        shows: "`?` in positions, FC903",
        when: &[Reported(Code::Fc903)],
    },
    Assumption {
        rule: "R2.82",
        sentence: "functions that are not listed may move the origin",
        changes: "positions after them are those of the program",
        shows: "FC904",
        when: &[Reported(Code::Fc904)],
    },
    Assumption {
        rule: "R2.82",
        sentence: "with G91 two values of one axis in a block add up",
        changes: "positions",
        shows: "`--columns position`",
        when: &[],
    },
    Assumption {
        rule: "R2.83",
        sentence: "a program that only the machine has may change everything",
        changes: "every axis is unknown after it",
        shows: "FC902",
        when: &[Reported(Code::Fc902)],
    },
    Assumption {
        rule: "R2.84",
        sentence: "a loop whose passes change nothing that a later pass can see never ends, and only a \
            reset ends it",
        changes: "the run stops there; what is left away from its start-up state is judged as after a reset",
        shows: "FC910",
        when: &[Reported(Code::Fc910)],
    },
    Assumption {
        rule: "R2.85",
        sentence: "the same message counts once per place, and at most 10 000 are given per file",
        changes: "how many messages are listed, never the exit status",
        shows: "FC905, `repeated` in the end record",
        when: &[Reported(Code::Fc905)],
    },
    Assumption {
        rule: "R2.94",
        sentence: "a word that calls a program, and whose program is not known, keeps every compensation as it is",
        changes: "the states after `G80` to `G89` and `G800` onwards without a configured program",
        shows: "FC325, once for each word and program",
        when: &[Reported(Code::Fc325)],
    },
];
