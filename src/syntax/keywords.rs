//! Words that are known by name (R2.70): those that a dry run passes over without a message are listed
//! here, one per row. Everything else that looks like them is FC210.
//!
//! PM/n is page n of the TF5200 programming manual.

use super::ast::{Address, Block, Item, Operand, Word};

/// Effect of a `#` command on the followed state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Touches {
    /// Neither flow nor values; its effect on coordinates belongs to the modal state.
    Nothing,
    /// It writes the parameters and variables that its brackets name.
    Values,
    /// It says which axes the channel has, and under which names.
    Axes,
    /// It moves axes to places that are not followed.
    Motion,
    /// It moves the axes of the plane to places that are not followed.
    Plane,
    /// Friction compensation of the axes that it names, of all where it names none, in a way that no
    /// public page describes (R2.93).
    Friction,
}

use Touches::{Axes, Friction, Motion, Nothing, Plane, Values};

/// PM, appendix, overview of additional functions.
const APPENDIX: &str = "PM/5252011631026770315";

/// The commands that the vendor's editor for NC programs supports (isg-stuttgart/vscode-isg-cnc,
/// syntaxes and snippets).
const EDITOR: &str = "vscode-isg-cnc";

/// The texts of the kernel's messages.
const KERNEL: &str = "kernel messages";

/// The `#` commands: the words that identify each, its effect, where it is described.
const HASH_COMMANDS: &[(&str, Touches, &str)] = &[
    ("#ACHSE", Nothing, "tccncprogramming/15557317259"),
    ("#ACHSTAUSCH", Axes, EDITOR),
    ("#ACS", Nothing, APPENDIX),
    ("#ADD", Nothing, APPENDIX),
    ("#AKIMA ENDVECTOR", Nothing, APPENDIX),
    ("#AKIMA STARTVECTOR", Nothing, APPENDIX),
    ("#AKIMA TRANS", Nothing, APPENDIX),
    ("#ANG", Plane, "PM/206123787"),
    ("#ASPLINE", Nothing, EDITOR),
    ("#AX DEF", Axes, APPENDIX),
    ("#AX LINK", Nothing, APPENDIX),
    ("#AX LOCK", Nothing, APPENDIX),
    ("#AX RELEASE", Axes, APPENDIX),
    ("#AX REQUEST", Axes, APPENDIX),
    ("#AX UNLOCK", Nothing, APPENDIX),
    ("#BACKWARD STORAGE CLEAR", Nothing, APPENDIX),
    ("#BCS", Nothing, APPENDIX),
    ("#BLOCKSEARCH LOCKED", Nothing, APPENDIX),
    ("#BLOCKSEARCH RELEASED", Nothing, APPENDIX),
    ("#BSPLINE", Nothing, EDITOR),
    ("#CACHE", Nothing, APPENDIX),
    ("#CALL AX", Axes, APPENDIX),
    ("#CAX", Nothing, APPENDIX),
    ("#CAXTRACK", Nothing, APPENDIX),
    ("#CHANNEL INIT", Nothing, APPENDIX),
    ("#CHANNEL INTERFACE", Nothing, APPENDIX),
    ("#CHANNEL SET", Nothing, APPENDIX),
    ("#CHF", Nothing, EDITOR),
    ("#CHR", Nothing, EDITOR),
    ("#CLAMP", Nothing, EDITOR),
    ("#CLEAR CONFIG", Nothing, EDITOR),
    ("#COMMAND WAIT", Nothing, EDITOR),
    ("#COMMAND WR", Nothing, EDITOR),
    ("#COMMENT", Nothing, "PM/205979659"),
    ("#CONTOUR BEGIN", Nothing, EDITOR),
    ("#CONTOUR END", Nothing, EDITOR),
    ("#CONTOUR MODE", Nothing, "tccncprogramming/15557317259"),
    ("#CONTROL AREA", Nothing, "tccncprogramming/15557317259"),
    ("#CORNER PARAM", Nothing, EDITOR),
    ("#CS", Nothing, EDITOR),
    ("#CYL", Nothing, EDITOR),
    ("#DB INFO", Nothing, EDITOR),
    ("#DCC", Nothing, EDITOR),
    ("#DEL DIST2GO", Nothing, EDITOR),
    ("#DELETE", Nothing, "PM/207960587"),
    ("#DISABLE AX LINK", Nothing, "PM/207133579"),
    ("#DISABLE MODAL CYCLE", Nothing, "PM/206859019"),
    ("#DIST CTRL", Nothing, EDITOR),
    ("#DIST TO GO", Nothing, EDITOR),
    ("#DISTANCE PROG START", Nothing, EDITOR),
    ("#DRIVE RD", Values, EDITOR),
    ("#DRIVE WAIT", Nothing, EDITOR),
    ("#DRIVE WR", Nothing, EDITOR),
    ("#DYN WEIGHT", Nothing, EDITOR),
    ("#DYNAMIC WEIGHT", Nothing, EDITOR),
    ("#DYN_WEIGHT", Nothing, EDITOR),
    ("#ECS", Nothing, EDITOR),
    ("#EDGE MACHINING", Nothing, EDITOR),
    ("#EDM", Nothing, EDITOR),
    ("#ENABLE AX LINK", Nothing, "PM/207133579"),
    ("#ENDVAR", Nothing, "PM/207960587"),
    ("#ERROR", Nothing, EDITOR),
    ("#EXPL SYN", Nothing, EDITOR),
    ("#EXPORT VE", Nothing, EDITOR),
    ("#EXTCOMP", Nothing, EDITOR),
    ("#FACE", Nothing, EDITOR),
    ("#FF", Nothing, EDITOR),
    ("#FGROUP", Nothing, EDITOR),
    ("#FILE DELETE", Nothing, "FCT-C18"),
    ("#FILE EXIST", Nothing, "FCT-C18"),
    ("#FILE NAME", Nothing, "FCT-C18"),
    ("#FILENAME", Nothing, "FCT-C18"),
    ("#FILE RENAME", Nothing, "FCT-C18"),
    ("#FILTER", Nothing, EDITOR),
    ("#FLUSH", Nothing, EDITOR),
    ("#FRC", Nothing, EDITOR),
    ("#FREE TOOL CHANGE", Nothing, EDITOR),
    // Named only by the kernel's messages 21721, 50758, 70496 and 70497.
    ("#FRICTION", Friction, KERNEL),
    ("#GANTRY", Nothing, EDITOR),
    ("#GEAR LINK", Nothing, "PM/546229387"),
    ("#GEO", Nothing, EDITOR),
    ("#GET ACTPOS", Values, EDITOR),
    ("#GET CMDPOS", Values, EDITOR),
    ("#GET IPO OFFSET", Values, EDITOR),
    ("#GET MANUAL OFFSETS", Values, EDITOR),
    ("#GET WCS POSLIMIT", Values, EDITOR),
    ("#HANDWHEEL", Nothing, EDITOR),
    ("#HSC", Nothing, EDITOR),
    ("#IDENT RD", Values, EDITOR),
    ("#IDENT WR", Nothing, EDITOR),
    ("#INFO", Nothing, EDITOR),
    ("#INIT", Values, EDITOR),
    ("#INIT MACRO TAB", Nothing, EDITOR),
    ("#INIT V", Values, EDITOR),
    ("#JOG CONT", Nothing, EDITOR),
    ("#JOG INCR", Nothing, EDITOR),
    ("#KIN DATA", Nothing, EDITOR),
    ("#KIN ID", Nothing, EDITOR),
    ("#KIN TCP", Nothing, EDITOR),
    ("#LAH", Nothing, EDITOR),
    ("#LASER", Nothing, EDITOR),
    ("#LIMIT LOAD", Nothing, EDITOR),
    ("#LIMIT REFRESH", Nothing, EDITOR),
    ("#LOAD CONFIG", Axes, EDITOR),
    ("#LOCK", Nothing, EDITOR),
    ("#MACHINE DATA", Nothing, EDITOR),
    ("#MAIN SPINDLE", Nothing, EDITOR),
    ("#MANUAL LIMITS", Nothing, EDITOR),
    ("#MARK", Nothing, EDITOR),
    ("#MC_MOVEPATH", Motion, EDITOR),
    ("#MCS", Nothing, EDITOR),
    ("#MCS TO WCS", Values, "PM/208525707"),
    ("#MEAS", Nothing, EDITOR),
    ("#MICROJOINT", Nothing, EDITOR),
    ("#MSG", Nothing, EDITOR),
    ("#NIBBLE", Nothing, EDITOR),
    ("#OPTIONAL EXECUTION", Nothing, EDITOR),
    ("#ORI MODE", Nothing, EDITOR),
    ("#ORIMODE", Nothing, EDITOR),
    ("#OTC", Nothing, EDITOR),
    ("#OVERRIDE", Nothing, EDITOR),
    ("#PRESET", Nothing, EDITOR),
    ("#PSET", Nothing, EDITOR),
    ("#PTP", Nothing, EDITOR),
    ("#PUNCH", Nothing, EDITOR),
    ("#PUT AX", Axes, EDITOR),
    ("#RETAIN CYCLE CHANGES", Nothing, "PM/206859019"),
    ("#RND", Nothing, EDITOR),
    ("#ROTATION", Nothing, EDITOR),
    ("#RT CYCLE", Nothing, EDITOR),
    ("#RT ENDWHILE", Nothing, EDITOR),
    ("#RT WHILE", Nothing, EDITOR),
    ("#RTCP", Nothing, EDITOR),
    ("#SAVE CONFIG", Nothing, EDITOR),
    ("#SCALE", Nothing, EDITOR),
    ("#SCENE", Nothing, EDITOR),
    ("#SEGMENTATION", Nothing, EDITOR),
    ("#SET ASPLINE", Nothing, EDITOR),
    ("#SET AX", Axes, EDITOR),
    ("#SET AX LINK", Nothing, EDITOR),
    ("#SET CORNER PARAM", Nothing, EDITOR),
    ("#SET DEC LR SOLL", Nothing, EDITOR),
    ("#SET HR", Nothing, EDITOR),
    ("#SET IPO SOLLPOS", Nothing, EDITOR),
    ("#SET JOG", Nothing, EDITOR),
    ("#SET OFFSET", Nothing, EDITOR),
    ("#SET PATH SMOOTH", Nothing, EDITOR),
    ("#SET SLOPE", Nothing, EDITOR),
    ("#SET SLOPE PROFIL", Nothing, EDITOR),
    ("#SET SPLINE", Nothing, EDITOR),
    ("#SET SPLINETYPE", Nothing, EDITOR),
    ("#SET TANGFEED RMIN", Nothing, EDITOR),
    ("#SET TIP", Nothing, EDITOR),
    ("#SET UEBERSCH_PARAM", Nothing, EDITOR),
    ("#SHIFT", Nothing, EDITOR),
    ("#SIGNAL", Nothing, EDITOR),
    ("#SIGNAL READ", Values, "PM/913718283"),
    ("#SINGLE STEP", Nothing, EDITOR),
    ("#SLOPE", Nothing, EDITOR),
    ("#SPLINE", Nothing, EDITOR),
    ("#START", Nothing, EDITOR),
    ("#STOP REVERSIBLE", Nothing, EDITOR),
    ("#STROKE DEF", Nothing, EDITOR),
    ("#SUPPRESS OFFSETS", Nothing, EDITOR),
    ("#SURFACE", Nothing, EDITOR),
    // With the conveyor all axes follow it (965255691).
    ("#SYNC", Motion, EDITOR),
    ("#TANGFEED", Nothing, EDITOR),
    ("#TGC", Nothing, EDITOR),
    ("#TIME", Nothing, "PM/206602507"),
    ("#TIMER", Values, EDITOR),
    ("#TLAX", Nothing, EDITOR),
    ("#TLC", Nothing, EDITOR),
    ("#TOOL AX", Nothing, EDITOR),
    ("#TOOL DATA", Nothing, EDITOR),
    ("#TOOL DEF", Nothing, EDITOR),
    ("#TOOL LIFE DEF", Nothing, EDITOR),
    ("#TOOL LIFE READ", Values, EDITOR),
    ("#TOOL LIFE REMOVE", Nothing, EDITOR),
    ("#TOOL ORI CS", Nothing, EDITOR),
    ("#TOOL PREP", Nothing, EDITOR),
    ("#TOOL REFRESH", Nothing, EDITOR),
    ("#TRACK CHAN", Nothing, EDITOR),
    ("#TRACK CS", Nothing, EDITOR),
    ("#TRAFO", Nothing, EDITOR),
    ("#TRANSFORM", Nothing, EDITOR),
    ("#TRANSVELMIN", Nothing, EDITOR),
    ("#TRC", Nothing, EDITOR),
    ("#TURN", Nothing, EDITOR),
    ("#UNLOCK", Nothing, EDITOR),
    ("#VAR", Nothing, "PM/207960587"),
    ("#VECTOR LIMIT", Nothing, EDITOR),
    ("#VECTOR OFFSET", Nothing, EDITOR),
    ("#VECTORACC", Nothing, EDITOR),
    ("#VECTORVEL", Nothing, EDITOR),
    ("#VIB GUARD", Nothing, EDITOR),
    ("#VIRTUAL AX", Nothing, EDITOR),
    ("#VOLCOMP", Nothing, EDITOR),
    ("#VOLKOMP", Nothing, EDITOR),
    ("#WAIT", Values, "PM/207421579"),
    ("#WAIT FOR", Nothing, EDITOR),
    ("#WAIT INDP", Nothing, EDITOR),
    ("#WAIT MC_STATUS", Nothing, "ISG/1139940235"),
    ("#WCS TO MCS", Values, "PM/208525707"),
];

/// Returns the effect of a `#` command; `None` where no row names it. The name has its words in upper case
/// with one blank between them; a row applies to its continuations.
pub(crate) fn hash_command(name: &str) -> Option<Touches> {
    row_of(name).map(|(_, touches)| touches)
}

fn row_of(name: &str) -> Option<(&'static str, Touches)> {
    let begins = |words: &str| {
        name.strip_prefix(words)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let rows = HASH_COMMANDS.iter();
    let row = rows.filter(|(words, ..)| begins(words));
    row.max_by_key(|(words, ..)| words.len())
        .map(|(words, touches, _)| (*words, *touches))
}

/// Words that follow the name of a `#` command or its bracket, `#MSG SAVE EXCLUSIVE […]`,
/// `#SET AX […] FAST` (vscode-isg-cnc; PM, chapters of the commands).
const FURTHER_WORDS: [&str; 55] = [
    "ABS",
    "ACK",
    "ACT",
    "ADAPT",
    "ADD",
    "AKIMA",
    "ALL",
    "BEGIN",
    "BSPLINE",
    "CLEAR",
    "CONTINUE",
    "DEF",
    "DEFAULT",
    "DEL",
    "DELAY",
    "DELETE",
    "DISABLE",
    "ENABLE",
    "END",
    "EX",
    "EXCLUSIVE",
    "FAST",
    "FEED",
    "GET",
    "HMI",
    "IDX",
    "IN",
    "INFO",
    "INIT",
    "LATERAL",
    "LOAD",
    "MODE",
    "NAM",
    "NBR",
    "OFF",
    "OFFSETS",
    "ON",
    "ORI",
    "OUT",
    "PCS",
    "PROFILE",
    "READ",
    "REMOVE",
    "ROT",
    "SAVE",
    "SELECT",
    "SET",
    "START",
    "STOP",
    "SYN",
    "SYN_ACK",
    "TOOL",
    "TYPE",
    "WAIT",
    "WAXIS",
];

/// Commands that take coordinates without a bracket, `#PSET X10 Y20`.
const WITH_COORDINATES: [&str; 3] = ["#PRESET", "#PSET", "#SHIFT"];

/// Whether a word follows the name of a `#` command or its bracket.
pub(super) fn is_further_word(word: &str) -> bool {
    FURTHER_WORDS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(word))
}

/// Whether a `#` command takes coordinates without a bracket.
pub(super) fn takes_coordinates(name: &str) -> bool {
    WITH_COORDINATES.contains(&name)
}

/// Returns how many words of a name belong to a known `#` command; 0 where none is known.
pub(super) fn command_words(name: &str) -> usize {
    let Some((row, _)) = row_of(name) else {
        return 0;
    };
    let further = name[row.len()..].split_ascii_whitespace();
    row.split(' ').count() + further.take_while(|word| is_further_word(word)).count()
}

/// Whether a name is that of a known `#` command.
pub(crate) fn is_command(name: &str) -> bool {
    hash_command(name).is_some()
}

/// The `#` commands by name, for "did you mean".
pub(super) fn hash_commands() -> impl Iterator<Item = &'static str> {
    HASH_COMMANDS.iter().map(|(words, ..)| *words)
}

/// The `$` statements.
pub(super) const FLOW_WORDS: [&str; 19] = [
    "$IF",
    "$ELSEIF",
    "$ELSE",
    "$ENDIF",
    "$SWITCH",
    "$CASE",
    "$DEFAULT",
    "$ENDSWITCH",
    "$FOR",
    "$ENDFOR",
    "$WHILE",
    "$ENDWHILE",
    "$DO",
    "$ENDDO",
    "$REPEAT",
    "$UNTIL",
    "$BREAK",
    "$CONTINUE",
    "$GOTO",
];

/// First keywords in an axis bracket after which nothing touches the compensation (R2.23; PM,
/// chapters on independent axes, oscillation, distance control, lifting, polynomials; PM/5252363631026771979).
const AXIS_COMMANDS: [&str; 11] = [
    "INDP_SYN",
    "INDP_ASYN",
    "OSC",
    "DIST_CTRL",
    "OVERRIDE",
    "DYNAMIC",
    "LIFT",
    "LIFT_START",
    "LIFT_END",
    "SYNC",
    "POLY",
];

/// Keywords in the bracket of a spindle, in addition to M, H and G with their numbers (PM/208178187).
const SPINDLE_COMMANDS: [&str; 10] = [
    "REV",
    "POS",
    "CALLAX",
    "PUTAX",
    "GET_DYNAMIC_DATA",
    "GET_DYNAMIK_DATA",
    "FEED_LINK",
    "OVERRIDE",
    "SLOPE_TYPE",
    "SYN",
];

/// Letters of words that are not axes and touch neither flow, parameters, calls nor COMP by themselves,
/// or are followed here (PM/205952267): tool data, feed, G and M functions, H functions, centre and
/// radius of circles, block numbers, spindle speed, tools.
const LETTERS: &[u8] = b"DEFGHIJKMNRST";

/// Words after `S.` (PM/208038923).
const SPINDLE_WORDS: [&str; 2] = ["POS", "OFFSET"];

/// Whether a keyword of an axis bracket opens a command that is passed over.
pub(super) fn is_axis_command(word: &str) -> bool {
    let upper = word.to_ascii_uppercase();
    numbered(&upper, &['M', 'H'])
        || upper.starts_with("MC_")
        || AXIS_COMMANDS.contains(&head(&upper))
}

/// Whether a keyword of a spindle's bracket opens a command that is passed over. A number, a
/// parameter or a variable may follow it at once.
pub(super) fn is_spindle_command(word: &str) -> bool {
    let upper = word.to_ascii_uppercase();
    let begins = |known: &str| {
        let rest = upper.strip_prefix(known);
        rest.is_some_and(|rest| {
            !rest.starts_with(|c: char| matches!(c, 'A'..='O' | 'Q'..='U' | 'W'..='Z' | '_'))
        })
    };
    is_axis_command(word)
        || numbered(&upper, &['G'])
        || SPINDLE_COMMANDS.iter().any(|known| begins(known))
}

/// The commands of an axis bracket, for "did you mean".
pub(super) fn axis_commands() -> impl Iterator<Item = &'static str> {
    AXIS_COMMANDS.into_iter()
}

/// Whether a block is a program number, `O1234`, and nothing else (R2.93): with other words an O is a
/// typing mistake for a zero.
pub(crate) fn is_program_number(block: &Block) -> bool {
    #[allow(clippy::float_cmp)] // whole numbers are exact
    let is_number = |value: f64| value >= 0.0 && value.fract() == 0.0;
    let is_opening = |word: &Word| {
        word.address == Address::Letter(b'O')
            && matches!(word.value, Some(Operand::Number(number)) if is_number(number))
    };
    match (block.words.as_slice(), block.items.as_slice()) {
        ([word], []) | ([], [Item::Word(word)]) => is_opening(word),
        _ => false,
    }
}

/// Whether a letter begins words that are known.
pub(crate) fn is_letter(letter: u8) -> bool {
    LETTERS.contains(&letter) || matches!(letter, b'A'..=b'C' | b'Q' | b'U'..=b'Z')
}

/// Whether `S.WORD` is known.
pub(super) fn is_spindle_word(word: &str) -> bool {
    SPINDLE_WORDS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(word))
}

/// Whether a statement begins with a word of the language, and not with a misspelt one.
pub(crate) fn is_statement(text: &str) -> bool {
    let letters = text.get(1..).unwrap_or_default();
    let length = letters.find(|c: char| !c.is_ascii_alphabetic());
    let word = &letters[..length.unwrap_or(letters.len())];
    FLOW_WORDS
        .iter()
        .any(|known| known[1..].eq_ignore_ascii_case(word))
}

/// The command word, which the text after it may touch: `OVERRIDE=50`, `SYNC[1]`.
fn head(upper: &str) -> &str {
    let end = upper.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    &upper[..end.unwrap_or(upper.len())]
}

/// A letter with a number, `M3`.
fn numbered(upper: &str, letters: &[char]) -> bool {
    let number = upper.strip_prefix(letters);
    number.is_some_and(|digits| digits.starts_with(|c: char| c.is_ascii_digit()))
}
