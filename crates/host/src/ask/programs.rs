//! The program of each question.

use std::fmt::Write as _;
use std::hash::Hasher;

use fnv::FnvHasher;

use super::control::AskedAxis;
use super::motion::motion;
use frictcomp::readings::{Question, Way};

/// The word with which each line of an answer begins.
pub(super) const TAG: &str = "frictcomp-ask";

/// Mark for a build that was not given.
const NO_BUILD: &str = "?";

/// A program that asks a question.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AskedFile {
    /// Question.
    pub(super) question: Question,
    /// Name.
    pub(super) name: String,
    /// Text.
    pub(super) text: String,
}

/// Instructions for a question, in plain words.
pub(super) struct Script {
    /// Conditions before the run.
    before: String,
    /// Motion.
    moves: String,
    /// The programs; if there are two, `between` is what to do in between.
    parts: Vec<String>,
    between: &'static str,
    /// Instructions for reading the answer.
    read: String,
}

/// Returns the programs for a question, none where there is nothing to run. The last one restores
/// the state at the start of the control.
pub(super) fn ask(question: Question, axis: &AskedAxis) -> Vec<AskedFile> {
    let Some(script) = script(question, axis) else {
        return Vec::new();
    };
    let fingerprint = fingerprint(question, axis);
    let several = script.parts.len() > 1;
    let rule = question.facts().rule;
    let texts = script.parts.iter().zip(1..);
    let files = texts.map(|(part, number)| AskedFile {
        question,
        name: if several {
            format!("ask-{rule}-{number}.nc")
        } else {
            format!("ask-{rule}.nc")
        },
        text: head(question, &script, (number, script.parts.len()))
            + &filled(part, question, axis, &fingerprint),
    });
    files.collect()
}

/// Returns the fingerprint of the programs of a question on an axis, whatever its travel and build.
pub(super) fn fingerprint(question: Question, axis: &AskedAxis) -> String {
    let plain = AskedAxis {
        travel: 10.0,
        build: None,
        ..axis.clone()
    };
    let mut hasher = FnvHasher::default();
    let parts = script(question, &plain).map_or(Vec::new(), |script| script.parts);
    for part in &parts {
        hasher.write(filled(part, question, &plain, "").as_bytes());
    }
    format!("{:08x}", hasher.finish() & 0xffff_ffff)
}

/// Returns the comment at the head of a program.
fn head(question: Question, script: &Script, (part, parts): (usize, usize)) -> String {
    let facts = question.facts();
    let mut lines = vec![
        format!("{}: {}", facts.rule, facts.question),
        format!("If {}: {}.", facts.readings[0], facts.meanings[0]),
        format!("If {}: {}.", facts.readings[1], facts.meanings[1]),
        format!("Moves: {}", script.moves),
        format!("Before: {}", script.before),
    ];
    if parts > 1 {
        lines.push(format!(
            "Part {part} of {parts}. Between them: {}",
            script.between
        ));
    }
    lines.push(format!("After: {}", script.read));
    let mut text = String::new();
    for line in lines {
        let _ = writeln!(text, "; {}", line.replace('`', ""));
    }
    text
}

/// Returns the blocks of a part: `>NAME EXPRESSION` leaves an answer, `@` is the axis.
fn filled(part: &str, question: Question, axis: &AskedAxis, fingerprint: &str) -> String {
    let rule = question.facts().rule;
    let build = axis
        .build
        .map_or_else(|| NO_BUILD.to_owned(), |build| build.to_string());
    let name = &axis.name;
    let tag = format!("{TAG} {rule} {fingerprint} {name} {build}");
    let state = format!("V.A.FRICT_COMP_ACTIVE.{name}");
    let mut text = String::new();
    for line in part.lines() {
        let Some(answer) = line.strip_prefix('>') else {
            let _ = writeln!(text, "{}", line.replace('@', name));
            continue;
        };
        let (word, value) = answer.split_once(' ').unwrap_or((answer, ""));
        let value = value.replace('@', name);
        // Waits until everything before it is executed.
        let _ = writeln!(text, "P1 = {state}");
        let _ = match value.as_str() {
            "" => writeln!(text, "#MSG SAVE EXCLUSIVE [\"{tag} {word}\"]"),
            _ => writeln!(text, "#MSG SAVE EXCLUSIVE [\"{tag} {word} %d\", {value}]"),
        };
    }
    text
}

const STATE: &str = "V.A.FRICT_COMP_ACTIVE.@";

/// Comment on the blocks that switch an axis both on and off.
const OPPOSITE: &str = " ; frictcomp: allow FC301 the question";

const NOTHING_MOVES: &str = "nothing";

/// Precondition where the state of the axis itself is examined.
const ACTIVE: &str = "the axis has P-AXIS-00522 = 1 and a value list that the control took; nothing has \
    switched it since the start of the control; message.txt is empty";

fn by_itself(before: &str, part: String, read: &str) -> Script {
    Script {
        before: before.to_owned(),
        moves: NOTHING_MOVES.to_owned(),
        parts: vec![part],
        between: "",
        read: read.to_owned(),
    }
}

const RESTS: &str = "the axis stands still";

/// Returns the instructions for blocks that the control takes or refuses; the block that it may refuse ends in braces,
/// or is the last one.
fn refusable(blocks: &str) -> Script {
    let allow = " ; frictcomp: allow FC328 the question";
    let mut blocks = blocks.replacen("{}", allow, 1);
    if !blocks.contains(allow) {
        blocks.push_str(allow);
    }
    let part = format!(">begin\n{blocks}\n>answer {STATE}\nN99 M30\n");
    by_itself(RESTS, part, READ_ERROR)
}

const READ: &str = "give message.txt to frictcomp ask read";

const READ_ERROR: &str = "give message.txt to frictcomp ask read; where the control showed an error, add \
    a copy of the begin line with error and the number in place of begin";

/// Returns the blocks that switch an axis off, query its state, and switch it on again.
fn off_and_on(between: &str) -> String {
    format!(
        ">begin\n>start {STATE}\nN10 @[COMP OFF FRICT]\n>off {STATE}\n{between}>answer {STATE}\n\
         N90 @[COMP ON FRICT]\nN99 M30\n"
    )
}

fn spanning(between: &'static str) -> Script {
    Script {
        parts: vec![
            format!(
                ">begin\n>start {STATE}\n\
                 N10 @[COMP OFF FRICT] ; frictcomp: allow FC401 the second program reads this state\n\
                 >off {STATE}\nN99 M30\n"
            ),
            format!(">answer {STATE}\nN90 @[COMP ON FRICT]\nN99 M30\n"),
        ],
        between,
        ..by_itself(ACTIVE, String::new(), READ)
    }
}

/// Returns the instructions for a question that a recording of motion answers.
fn recorded(question: Question, axis: &AskedAxis) -> Script {
    let (part, moves) = motion(question, axis);
    Script {
        moves,
        ..by_itself(
            &format!(
                "the axis has P-AXIS-00522 = 1, a value list that the control took, and room to move; \
                 recorded in every CNC cycle are its commanded position or velocity and the objects {}",
                objects(axis)
            ),
            format!(">begin\n{part}M30\n"),
            "export the recording as CSV, and give it to frictcomp ask read, with message.txt",
        )
    }
}

/// Returns the instructions for a question; `None` where there is nothing to run.
fn script(question: Question, axis: &AskedAxis) -> Option<Script> {
    if question.facts().way == Way::Recording {
        return Some(recorded(question, axis));
    }
    Some(match question {
        Question::Reset => spanning("press reset"),
        Question::Restart => spanning("restart the control"),
        Question::LowerCase => by_itself(
            ACTIVE,
            format!(
                ">begin\n>start {STATE}\nN10 @[comp off frict]\n>answer {STATE}\nN90 @[COMP ON FRICT]\n\
                 N99 M30\n"
            ),
            READ_ERROR,
        ),
        Question::OrderInBlock => by_itself(
            ACTIVE,
            format!(
                ">begin\n>start {STATE}\nN10 @[COMP OFF FRICT] @[COMP ON FRICT]{OPPOSITE}\n>answer {STATE}\n\
                 N20 @[COMP ON FRICT] @[COMP OFF FRICT]{OPPOSITE}\n>other {STATE}\nN90 @[COMP ON FRICT]\nN99 M30\n"
            ),
            READ,
        ),
        Question::OffUnconfigured => by_itself(
            "the axis has P-AXIS-00522 = 0, in the axis list that the control took",
            ">begin\n>init V.A.FRICT_COMP_INIT.@\nN10 @[COMP OFF FRICT]\n\
             >answer V.A.FRICT_COMP_INIT.@\nN99 M30\n"
                .to_owned(),
            READ_ERROR,
        ),
        Question::OnWithoutList => by_itself(
            "the axis has P-AXIS-00522 = 1 and a value list with mode 0, or none",
            format!(
                ">begin\n>init V.A.FRICT_COMP_INIT.@\nN10 @[COMP ON FRICT]\n>answer {STATE}\nN99 M30\n"
            ),
            READ_ERROR,
        ),
        Question::ManualActivation => by_itself(
            "the axis has leadscrew compensation with its table, and P-COMP-00028 = 1; the control was \
             restarted, and this is the first program",
            ">begin\n>init V.A.LEAD_COMP_INIT.@\n>answer V.A.LEAD_COMP_ACTIVE.@\nN99 M30\n"
                .to_owned(),
            READ,
        ),
        Question::AxisExchange => {
            let (number, index) = (axis.number?, axis.index);
            by_itself(
                ACTIVE,
                off_and_on(&format!(
                    "N20 #PUT AX [@]\nN30 #CALL AX [@, {number}, {index}]\n"
                )),
                READ,
            )
        }
        Question::SkipLevel => by_itself(
            "skip level 2 is off",
            ">begin\nN10 #VAR\nV.S.FRICTASK : UNS32 = 0\nN20 #ENDVAR\nN25 V.S.FRICTASK = 0\n\
             ; Turn skip level 2 on now, then press start.\nN30 M00\nN40 #FLUSH WAIT\n\
             /2 N50 V.S.FRICTASK = 1 ; frictcomp: allow FC901 the question\n>answer V.S.FRICTASK\nN99 M30\n"
                .to_owned(),
            "turn skip level 2 off again; give message.txt to frictcomp ask read",
        ),
        Question::MachineData => by_itself(
            ACTIVE,
            off_and_on("N20 #MACHINE DATA [AX=@ P-AXIS-00522=1] ; frictcomp: allow FC314 the question\n"),
            READ,
        ),
        Question::BlockSearch => by_itself(
            ACTIVE,
            format!(
                ">begin\nN100 @[COMP OFF FRICT]\nN200 G04 1\n>answer {STATE}\nN290 @[COMP ON FRICT]\n\
                 N299 M30\n"
            ),
            "it is started by a block search for N200, not from its first block; add a copy of the begin \
             line with searched 1 in place of begin to message.txt, and give it to frictcomp ask read",
        ),
        Question::RemedyClass => by_itself(
            RESTS,
            format!(
                ">begin\nN10 #ERROR [ID=1] ; frictcomp: allow FC902 the question\n>answer {STATE}\nN99 M30\n"
            ),
            READ_ERROR,
        ),
        Question::SyntaxCheck => by_itself(
            "the axis has P-AXIS-00522 = 0; the program is only checked for its syntax, not started",
            "N10 @[COMP ON FRICT]\nN99 M30\n".to_owned(),
            "write down whether P-ERR-70495 was shown, as README.txt says",
        ),
        question => return of_language(question),
    })
}

/// Returns the instructions for a question about a block that switches nothing.
fn of_language(question: Question) -> Option<Script> {
    Some(match question {
        Question::ContinueInSwitch => by_itself(
            RESTS,
            ">begin\nN10 P1 = 1\nN20 $SWITCH P1\nN30 $CASE 1\n\
             N40 $CONTINUE ; frictcomp: allow FC901 the question\nN50 P1 = 0\nN60 $BREAK\nN70 $ENDSWITCH\n\
             >answer P1\nN99 M30\n"
                .to_owned(),
            READ,
        ),
        Question::WholeNumber => by_itself(
            RESTS,
            ">begin\nN10 #VAR\nV.P.FRICTASK : SGN16 = 0\nN20 #ENDVAR\nN30 V.P.FRICTASK = 0.5\n\
             >answer V.P.FRICTASK\nN99 M30\n"
                .to_owned(),
            READ,
        ),
        Question::Undeclared => refusable("N10 V.L.FRICTASK = 1"),
        Question::JumpInto => refusable(
            "N10 P1 = 0\nN20 $GOTO [FRICTASK]{}\nN30 $WHILE P1 == 1\n[FRICTASK]\nN40 $ENDWHILE",
        ),
        Question::Described => refusable(
            "N10 #CONTOUR BEGIN [ID1]\nN20 @[COMP ON FRICT]{}\nN30 #CONTOUR END",
        ),
        Question::NearlyEqual => by_itself(
            RESTS,
            ">begin\nN10 P1 = 0.1 + 0.2\nN20 P2 = 0\nN30 $IF P1 == 0.3\nN40 P2 = 1\nN50 $ENDIF\n\
             >answer P2\nN99 M30\n"
                .to_owned(),
            READ,
        ),
        Question::ProgramNumber => refusable("N10 O1234"),
        _ => return None,
    })
}

/// Returns the objects of an axis that are recorded: its state, and its additive current.
fn objects(axis: &AskedAxis) -> String {
    let number = axis
        .number
        .map_or_else(|| "<axis>".to_owned(), |number| format!("{number:X}"));
    format!(
        "0x120300:0x{number}0221 (frict_comp.f_is_active) and 0x120300:0x{number}010B (frict_comp.output)"
    )
}

/// Returns the text to go with the programs: the whole procedure, and the notes that need no program.
pub(super) fn readme(axis: &AskedAxis) -> String {
    let mut text = String::from(
        "Programs that test on the control what its documents leave open.\n\n\
         The head of each program says what it tests, what moves, and what to do before and after.\n\
         Programs leave their answers in message.txt, in the folder of the control's start-up list with\n\
         type 0x04, else in its main folder. Collect it, or several of them, and run\n\n\
         \u{20}   frictcomp ask read message.txt\n\n\
         The last program of a question brings the axis back to its state at the start of the control.\n\
         Where a program stopped with an error, run the last one of its question, or restart the control.\n\n\
         Where only you see the answer, copy one of the two lines of its question below into a text file,\n\
         which is read in the same way:\n\n",
    );
    for question in Question::ALL {
        let facts = question.facts();
        if facts.way == Way::Program {
            continue;
        }
        let _ = writeln!(text, "{}: {}", facts.rule, facts.question.replace('`', ""));
        for (name, meaning) in facts.readings.iter().zip(facts.meanings) {
            let _ = writeln!(
                text,
                "    {} reading {name}\n        {}",
                tag(question, axis),
                meaning.replace('`', "")
            );
        }
        let _ = writeln!(
            text,
            "    What answers it: {}\n",
            facts.how.replace('`', "")
        );
    }
    if axis.number.is_none() {
        text.push_str(
            "R2.70 is not asked: frictcomp.toml does not give the logical number of the axis.\n",
        );
    }
    text
}

/// Returns the start of each answer line for a question.
pub(super) fn tag(question: Question, axis: &AskedAxis) -> String {
    let build = axis
        .build
        .map_or_else(|| NO_BUILD.to_owned(), |build| build.to_string());
    format!(
        "{TAG} {} {} {} {build}",
        question.facts().rule,
        fingerprint(question, axis),
        axis.name
    )
}
