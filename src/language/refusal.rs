//! Refusals of the control, one row per error number (R2.114).
//!
//! Each row says what is refused, on which page of the TF5200 diagnosis manual, and what a dry run does about it. An
//! error has the number of the control only where the words of the page cover the case; else the message is a warning,
//! and the ways on which the error ends the program are followed beside those on which the program goes on (R2.103).

/// An error of the control that has its cause in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct ControlError {
    /// The number, without `P-ERR-`.
    pub number: u32,
    /// Refused construct.
    pub refused: &'static str,
    /// The page that describes it, by its number; empty where only the number or its title was found.
    pub page: &'static str,
    /// Result of a dry run.
    pub check: ControlErrorCheck,
    /// Replacement to write instead.
    pub cure: &'static str,
}

/// Result of a dry run where the control refuses a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ControlErrorCheck {
    /// An error with the number of the control.
    Error,
    /// A warning, and both ways: the page or a list leaves open whether the case is refused.
    Possible,
    /// Another message of frictcomp, by its code.
    Said(&'static str),
    /// No message, for the given reason.
    Open(&'static str),
}

impl ControlErrorCheck {
    /// Returns the reaction of frictcomp in words.
    pub fn words(self) -> String {
        match self {
            Self::Error => "an error with this number".to_owned(),
            Self::Possible => "FC328, a warning, and both ways are followed".to_owned(),
            Self::Said(code) => code.to_owned(),
            Self::Open(why) => format!("no message: {why}"),
        }
    }
}

macro_rules! refusals {
    ($($number:literal $page:literal $check:expr, $refused:literal, $cure:literal;)+) => {
        &[$(ControlError { number: $number, refused: $refused, page: $page, check: $check, cure: $cure }),+]
    };
}

/// The rows, in the order of their numbers.
static REFUSALS: &[ControlError] = {
    use ControlErrorCheck::{Error, Open, Possible, Said};
    refusals! {
        20008 "250515083" Error, "the first feed move of a program for which neither the program nor the channel list gives a feed",
            "write a feed before the first feed move";
        20013 "250532491" Possible, "G04 with a time and the coordinate of an axis",
            "write only one of them";
        20014 "250536843" Possible, "G04 with the coordinate of another axis than the first main axis",
            "write `G04 X2`, or `#TIME 2`";
        20034 "250602123" Said("FC316"), "a full circle by its radius",
            "give the centre of a full circle with `I`, `J`, `K`";
        20036 "250610827" Possible, "a circle with neither a centre nor a radius under G164",
            "give the centre with `I`, `J`, `K`";
        20037 "250615179" Possible, "`#ACHSE` without G200, G201 or G202",
            "write `G201 #ACHSE [X]`";
        20038 "250619531" Possible, "G201 without an axis",
            "name the axis, `G201 X1`";
        20049 "250645643" Possible, "a measuring motion under G41 or G42",
            "write G40 before it";
        20097 "250750091" Open("lists of external variables are not read"), "reading a `V.E.` variable that may only be written",
            "allow it in the list of external variables";
        20100 "250758795" Error, "writing a variable of the control that can only be read, such as `V.G.BLOCK_NR`",
            "write a variable of your own";
        20112 "250806667" Said("FC313"), "two of G20 to G23 and G351 in one block",
            "write one of them";
        20122 "250850187" Said("FC313"), "two of G96, G97 and G196 in one block",
            "write one of them";
        20131 "206278923" Error, "G80 to G89 and G800 on without a program, and a G function that the control does not know",
            "name the program, `g80_prog_file` or `g800_prog_file[0]` in the channel list";
        20133 "250893707" Possible, "G17, G18 or G19 under G41 or G42",
            "write G40 before it";
        20137 "250902411" Possible, "G74 while a coupling group is active",
            "release all coupling groups first, with `#AX LINK OFF ALL`";
        20155 "250928523" Possible, "two of M3, M4, M5 and M19 in the bracket of a spindle; P-CHAN-00098 may free them",
            "write one of them";
        20160 "diagnosis" Error, "an M function above 1000; how many P-CHAN-00041 allows is a limit of the build and in no list",
            "use a number up to 1000";
        20192 "251050379" Possible, "the program number `O1234`, which is not implemented",
            "write `%1234` for the name of a program";
        20200 "251080843" Error, "an axis that the channel does not have: one that no channel list names, or one of another channel; an axis that a program has given away is FC902",
            "use the axes of one channel, or request the axis first, with `#CALL AX` or `#AX REQUEST`";
        20211 "251111307" Said("FC912"), "control blocks that are nested too deep",
            "nest fewer of them";
        20212 "251115659" Said("FC207"), "further commands after the condition of `$IF`",
            "write them in a block of their own";
        20214 "251124363" Said("FC208"), "`$ELSE` outside an `$IF`",
            "write `$IF` before it";
        20215 "251128715" Said("FC208"), "further commands in the block of `$ELSE`",
            "write them in a block of their own";
        20216 "251133067" Said("FC208"), "`$ELSEIF` outside an `$IF`",
            "write `$IF` before it";
        20217 "251137419" Said("FC207"), "further commands after the condition of `$ELSEIF`",
            "write them in a block of their own";
        20218 "251141771" Said("FC208"), "`$ENDIF` without `$IF`",
            "write `$IF` before it";
        20219 "251146123" Said("FC208"), "further commands in the block of `$ENDIF`",
            "write them in a block of their own";
        20220 "251150475" Said("FC207"), "further commands after the value of `$SWITCH`",
            "write them in a block of their own";
        20221 "251154827" Said("FC208"), "`$CASE` outside a `$SWITCH`",
            "write `$SWITCH` before it";
        20222 "251159179" Said("FC208"), "further commands in the block of `$CASE`",
            "write them in a block of their own";
        20223 "251163531" Said("FC208"), "`$DEFAULT` outside a `$SWITCH`",
            "write `$SWITCH` before it";
        20224 "251167883" Said("FC208"), "further commands in the block of `$DEFAULT`",
            "write them in a block of their own";
        20225 "251172235" Said("FC208"), "`$ENDSWITCH` without `$SWITCH`",
            "write `$SWITCH` before it";
        20227 "251180939" Said("FC207"), "a counter of `$FOR` that is neither a parameter nor a variable",
            "count with a P parameter or a variable";
        20232 "251202699" Said("FC208"), "`$ENDFOR` without `$FOR`",
            "write `$FOR` before it";
        20234 "251211403" Said("FC207"), "a counter of `$FOR` that does not begin with P, V or R",
            "count with a P parameter or a variable";
        20235 "251215755" Said("FC207"), "further commands after the condition of `$WHILE`",
            "write them in a block of their own";
        20237 "251224459" Said("FC208"), "`$ENDWHILE` without `$WHILE`",
            "write `$WHILE` before it";
        20238 "251228811" Said("FC208"), "further commands in the block of `$ENDWHILE`",
            "write them in a block of their own";
        20239 "251233163" Said("FC207"), "further commands in the block of `$DO`",
            "write them in a block of their own";
        20241 "251241867" Said("FC207"), "further commands after the condition of `$ENDDO`",
            "write them in a block of their own";
        20242 "251246219" Said("FC208"), "further commands in the block of `$BREAK`",
            "write them in a block of their own";
        20243 "251250571" Said("FC208"), "`$BREAK` outside a loop and a `$SWITCH`",
            "write it within one";
        20244 "251254923" Said("FC208"), "`$CONTINUE` outside a loop and a `$SWITCH`",
            "write it within one";
        20245 "251259275" Said("FC208"), "further commands in the block of `$CONTINUE`",
            "write them in a block of their own";
        20360 "251402891" Said("FC911"), "calls of global subprograms that are nested too deep",
            "let no subprogram call itself without an end";
        20365 "251420299" Open("the limit is a start-up parameter"), "too many local subprograms in all files that are open",
            "make some of them global subprograms";
        20375 "diagnosis" Said("P-ERR-20375"), "a true `$IF` without `$ENDIF`; this is a warning",
            "write `$ENDIF`";
        20392 "PM/1225681547" Possible, "a `V.I.` variable that no program declares",
            "declare it with `#VAR`";
        20457 "251659659" Possible, "a coupling that is switched under G41 or G42",
            "switch it before G41 or G42, or after G40";
        20461 "251664011" Possible, "the definition of coupling group 0, which is that of the channel list",
            "define a group from 1 on";
        20467 "251681419" Possible, "a slave that is a main axis, with the index 0, 1 or 2 in the channel list",
            "couple an axis with a higher index";
        20470 "251694475" Possible, "a slave that is in manual mode by G201",
            "write G202 before it";
        20472 "251698827" Error, "`#SET AX LINK` of a coupling group that is active",
            "release the group first, with `#DISABLE AX LINK`";
        20475 "251703179" Possible, "an axis that a coupling group couples to itself",
            "couple it to another axis";
        20476 "251707531" Possible, "a slave that a coupling group couples to two axes",
            "give each slave one master";
        20477 "251711883" Possible, "an axis that is master and slave in one coupling group",
            "couple both slaves to the common master";
        20478 "251716235" Possible, "an axis that `#ACHSE` names twice",
            "name it once";
        20545 "251820683" Possible, "the release of an axis in an active coupling",
            "release the coupling group first, with `#DISABLE AX LINK`";
        20590 "251916427" Said("FC912"), "`#IF` that is nested too deep",
            "nest fewer of them";
        20592 "251925131" Said("FC208"), "`#ENDIF` without `#IF`",
            "write `#IF` before it";
        20593 "251929483" Said("FC208"), "something before `#IF`, `#ELSE` or `#ENDIF` in its block",
            "write it first, without a block number";
        20608 "251973003" Possible, "`#PSET` or `#PRESET` under G41 or G42",
            "write G40 before it";
        20612 "251981707" Possible, "`#PSET` or `#PRESET` while coordinates are mirrored",
            "write G20 before it";
        20651 "PM/524821515" Said("FC328"), "a command that flushes the channel under G41 or G42",
            "write it before G41 or G42";
        20663 "252155787" Possible, "some G functions while `#CS` is active, G98 among them",
            "write `#CS OFF` before it";
        20671 "252181899" Possible, "`#TLC ON` under G41 or G42",
            "write it before G41 or G42";
        20687 "252225419" Possible, "`#KIN ID` while a kinematic transformation is active",
            "write `#TRAFO OFF` before it";
        20734 "252355979" Said("FC914"), "macros that are nested too deep",
            "let no macro use itself";
        20747 "252403851" Open("only in manual mode, and the limit is that of the control"), "a call from a manual block with too many open files",
            "nest fewer calls";
        20802 "252599691" Possible, "`#CS`, `#ACS` or `#MCS` under G41 or G42",
            "write it before G41 or G42, or after G40";
        20809 "252621451" Possible, "a slave that takes part in an active kinematic transformation",
            "write `#TRAFO OFF` before it";
        20839 "252734603" Error, "`$GOTO` that neither `[`, nor `N`, nor `V.E.` follows",
            "write `$GOTO N100` or `$GOTO [NAME]`";
        20847 "252765067" Error, "a value outside the type of its variable",
            "declare the variable with a wider type";
        20906 "tccnc/15557118091" Said("FC312"), "an index outside an array",
            "use an index that the declaration allows";
        20909 "252956555" Error, "a variable that is declared twice in one level",
            "declare it once";
        20915 "" Open("no page describes it"), "`#DELETE` of a `V.E.` variable",
            "delete variables of your own only";
        20927 "253017483" Said("FC913"), "brackets of an expression that are nested too deep",
            "write the expression in several blocks";
        20933 "486167307" Error, "`#DELETE` of a `V.CYC.` variable of an outer level",
            "delete it in the cycle that declares it";
        20966 "253121931" Error, "a dimension below 1 in the declaration of an array",
            "declare at least one element";
        20974 "253143691" Said("FC312"), "more indices than an array has dimensions",
            "write one index for each dimension";
        21024 "253243787" Possible, "a circle with a centre and a radius",
            "give the centre with `I`, `J`, `K`, or the radius with `R`";
        21068 "253356939" Possible, "a G function that the bracket of an independent axis does not have",
            "write G00 or G01 with G90 or G91";
        21071 "253361291" Possible, "an independent motion of an axis of an active transformation",
            "switch the transformation off before it";
        21216 "253831307" Error, "an array without an index",
            "write one index for each dimension";
        21256 "diagnosis" Possible, "an axis that one command of axis exchange asks for twice",
            "ask for each axis once";
        21258 "diagnosis" Possible, "a name that one command of axis exchange gives twice",
            "give each axis a name of its own";
        21261 "diagnosis" Possible, "a name that another axis of the channel has",
            "give the axis another name, or release the other axis first";
        21274 "254005387" Error, "`#LOAD CONFIG [AX]` with no saved axes",
            "save them first, with `#SAVE CONFIG [AX]`";
        21275 "254009739" Error, "`#LOAD CONFIG [AXLINK]` with no saved couplings",
            "save them first, with `#SAVE CONFIG [AXLINK]`";
        21277 "254018443" Possible, "`#LOAD CONFIG` while a coupling group is active",
            "release all coupling groups first, with `#AX LINK OFF ALL`";
        21283 "254044555" Possible, "a slave that is a slave in another active coupling group",
            "release the other group first, with `#DISABLE AX LINK`";
        21284 "254048907" Possible, "a slave that is a master in another active coupling group",
            "release the other group first, with `#DISABLE AX LINK`";
        21285 "254053259" Possible, "a master that is a slave in another active coupling group",
            "release the other group first, with `#DISABLE AX LINK`";
        21381 "254436235" Error, "a cycle call while a modal cycle is active",
            "write `#DISABLE MODAL CYCLE` before it";
        21382 "254440587" Open("a cycle that is run by itself looks like a main program"), "an `@P` parameter in a main program",
            "write a variable, and give its value to the cycle in the call";
        21387 "254462347" Error, "`#IF` without `#ENDIF`",
            "write `#ENDIF` in a block of its own";
        21403 "diagnosis" Error, "COMP on an axis in an active coupling",
            "release all couplings first, with `#DISABLE AX LINK ALL`";
        21413 "diagnosis" Error, "`#MACHINE DATA` with WAIT and without SYN",
            "write `SYN`, too";
        21480 "254849675" Error, "`$GOTO` to a label within the same loop",
            "leave the loop, or use `$IF` and `$CONTINUE` within it";
        21481 "254854027" Possible, "an independent motion of an axis in an active coupling",
            "release the coupling group first, with `#DISABLE AX LINK`";
        21500 "diagnosis" Error, "a false `$IF` without `$ENDIF` at the end of a local subprogram",
            "write `$ENDIF`";
        21501 "diagnosis" Error, "a false `$IF` without `$ENDIF` at the end of a main program",
            "write `$ENDIF`";
        21502 "diagnosis" Error, "a false `$IF` without `$ENDIF` at the end of a global subprogram",
            "write `$ENDIF`";
        21525 "255049867" Possible, "`#PTP` under G41 or G42",
            "write G40 before it";
        21544 "255132555" Open("a cycle that is run by itself looks like a main program; the value is unknown there"), "`V.G.@P[i].VALID` outside a cycle",
            "ask for it within the cycle";
        21552 "255167371" Possible, "`#TRAFO ON` while `#PTP` is active",
            "write it before `#PTP ON`";
        21768 "" Said("FC312"), "an index on a variable that is no array",
            "declare it as an array";
        21772 "255959435" Error, "a `V.I.` array that exists with other dimensions",
            "declare it with the dimensions that it has";
        22008 "480201355" Possible, "several implicit calls in one block",
            "write each in a block of its own";
        22073 "782961163" Open("the page that allows commands has no complete list"), "commands within `#RT WHILE`",
            "write COMP commands outside";
        22081 "560182283" Possible, "G303 under G41 or G42",
            "write G40 and a motion before it";
        22101 "777094283" Possible, "commands within `#CONTOUR BEGIN`",
            "write COMP commands outside";
        22132 "diagnosis" Error, "`#OPTIONAL EXECUTION ON [APPROACH SIMULATE]`",
            "leave out `APPROACH SIMULATE`";
        22158 "964625803" Possible, "`#RT WHILE` under G41 or G42",
            "write G40 before it";
        22254 "1097005579" Open("`MACRO_LENGTH` is not followed: FC210"), "`MACRO_LENGTH` of something else than the name of a macro",
            "write the name in quotation marks";
        22276 "1147344395" Open("`MACRO_CONTENT` is not followed: FC210"), "`MACRO_CONTENT` of a macro that does not exist",
            "define the macro before";
        51081 "diagnosis" Error, "`#FLUSH WAIT` within `#OPTIONAL EXECUTION`",
            "write it outside";
        90050 "261738891" Said("FC328"), "a command that flushes the channel after G40, before the next motion",
            "move between G40 and the command";
        90193 "560155915" Possible, "G303 after G40, before the next motion",
            "move between G40 and G303";
        120_102 "264720011" Said("FC328"), "a command that flushes the channel in the spline mode 2 of HSC, or under G151",
            "write it before the spline, or after it";
        120_104 "" Open("no page describes it; 120102 and 120434 do"), "a command that flushes the channel in the spline mode 2 of HSC, or under G151",
            "write it before the spline, or after it";
        120_254 "264515467" Possible, "a circle under a B spline",
            "write `#SPLINE TYPE AKIMA`, or no circles";
        120_255 "264519819" Possible, "G61, G261 or `#HSC ON` under a spline",
            "write G150 or `#SPLINE OFF` before it";
        120_265 "264528523" Possible, "axis exchange under a spline",
            "write G150 or `#SPLINE OFF` before it";
        120_332 "264598155" Possible, "a coupling that is switched under a spline",
            "write G150 or `#SPLINE OFF` before it";
        120_333 "264602507" Possible, "a coupling that is switched while contours are rounded",
            "write G260 before it";
        120_370 "264619915" Possible, "G150, G151 or `#SPLINE` while `#HSC` is active",
            "write `#HSC OFF` before it";
        120_433 "264715659" Possible, "measuring, G33, G61, G261, G95 or G96 under `#HSC ON [OPMODE 2]`",
            "write `#HSC OFF` before it";
        120_434 "264284811" Said("FC328"), "a command that flushes the channel in the spline mode 2 of HSC, or under G151",
            "write it before the spline, or after it";
        120_435 "264724363" Possible, "G04 under `#HSC ON [OPMODE 2]`",
            "write `#HSC OFF` before it";
        120_697 "265468555" Possible, "an independent motion under a spline",
            "switch the spline off before it";
        120_716 "265538187" Possible, "commands within `#STROKE DEF`",
            "write COMP commands outside";
    }
};

impl ControlError {
    /// Returns its page: what is refused, what frictcomp does, and the source.
    pub fn explanation(&self) -> String {
        let Self {
            number,
            refused,
            cure,
            ..
        } = self;
        format!(
            "# P-ERR-{number}\n\nThe control refuses {refused}.\n\nfrictcomp: {}. {}{}.\n\nSource: {} (R2.114).\n",
            self.check.words(),
            cure[..1].to_uppercase(),
            &cure[1..],
            self.source(),
        )
    }

    /// Returns the document that describes it.
    pub fn source(&self) -> String {
        match self.page {
            "" => "error texts of the control".to_owned(),
            "diagnosis" => format!("TF5200 Diagnosis, error {}", self.number),
            page => match page.split_once('/') {
                Some(("PM", page)) => format!("TF5200 Programming manual, page {page}"),
                Some((document, page)) => format!("{document}, page {page}"),
                None => format!("TF5200 Diagnosis, error {}, page {page}", self.number),
            },
        }
    }

    /// Returns all rows in the order of their numbers.
    pub fn all() -> &'static [Self] {
        REFUSALS
    }

    /// Returns the one with a number.
    pub fn of(number: u32) -> Option<&'static Self> {
        let place = REFUSALS.binary_search_by_key(&number, |row| row.number);
        REFUSALS.get(place.ok()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

    #[test]
    fn each_number_has_a_row_in_the_document() {
        // R2.114
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/refusals.md");
        let rows = REFUSALS.iter().map(|row| {
            let (check, source) = (row.check.words(), row.source());
            format!(
                "| {} | {} | {check} | {source} |\n",
                row.number, row.refused
            )
        });
        let count = |is_it: fn(&ControlErrorCheck) -> bool| {
            REFUSALS.iter().filter(|row| is_it(&row.check)).count()
        };
        let ranges = RANGES.map(|(from, to, subject, looked)| {
            let numbers = REFUSALS.iter().map(|row| row.number);
            let found = numbers.filter(|it| (from..=to).contains(it)).count();
            format!("| {from} to {to} | {subject} | {looked} | {found} |\n")
        });
        let fresh = format!(
            "{HEAD}\nOf {} numbers {} are errors here, {} are warnings with both ways, {} have another message, {} are \
             not looked at.\n\n{SEARCH}\n| numbers | subject | what was looked through | rows |\n|---|---|---|---|\n{}\n| number | what the control refuses | frictcomp | source |\n|---|---|---|---|\n{}",
            REFUSALS.len(),
            count(|it| *it == ControlErrorCheck::Error),
            count(|it| *it == ControlErrorCheck::Possible),
            count(|it| matches!(it, ControlErrorCheck::Said(_))),
            count(|it| matches!(it, ControlErrorCheck::Open(_))),
            ranges.concat(),
            rows.collect::<String>()
        );
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(path, &fresh).expect("written");
        }
        assert_eq!(std::fs::read_to_string(path).expect("the document"), fresh);
    }

    /// Beginning of the document.
    const HEAD: &str = "# What the control refuses\n\n\
        Error numbers of the control that have their cause in a program, without those of COMP commands and of lists, \
        which have [pages of their own](codes). `frictcomp explain 21480` shows one of them. An error is given only where the words \
        of the page cover the case; where the page, or a list of the machine, leaves that open, the warning FC328 says so, and the \
        ways on which the program ends there are followed beside those on which it goes on.\n";

    /// Extent of the search for error numbers.
    const SEARCH: &str = "How many numbers the control has cannot be counted from what is public: the overview of the diagnosis \
        manual names ranges, and each number has a page of its own, of which not all can be read. These ranges are those of the \
        overview; in those that concern programs, pages were looked for by the words of the language and by the numbers beside \
        those that were found.\n";

    /// The ranges of the diagnosis manual, with what was looked through.
    const RANGES: [(u32, u32, &str, &str); 18] = {
        const BY_WORDS: &str = "by the words of the language, and the numbers beside those found";
        const BY_COMMANDS: &str = "by the commands that move or couple axes";
        const NOT: &str = "nothing: no error of a program";
        [
            (
                1000,
                12_999,
                "general, start-up",
                "nothing: the start-up lists have codes of their own",
            ),
            (
                13_000,
                19_999,
                "cycles",
                "nothing: errors that cycles of the vendor report themselves",
            ),
            (
                20_000,
                29_999,
                "decoding: syntax and meaning of programs",
                BY_WORDS,
            ),
            (
                30_000,
                39_999,
                "configuration",
                "nothing: lists have codes of their own",
            ),
            (40_000, 49_999, "function blocks of the PLC", NOT),
            (50_000, 59_999, "path interpolator", BY_COMMANDS),
            (60_000, 69_999, "spindle interpolator", NOT),
            (
                70_000,
                79_999,
                "position controller",
                "those of COMP and of compensation values, which have pages of their own",
            ),
            (80_000, 89_999, "axis filters", NOT),
            (
                90_000,
                99_999,
                "tool radius compensation",
                "what flushes the channel",
            ),
            (110_000, 119_999, "management of axes", BY_COMMANDS),
            (
                120_000,
                129_999,
                "preparation of the path",
                "splines, contours, strokes",
            ),
            (130_000, 139_999, "communication", NOT),
            (140_000, 149_999, "management of drives", NOT),
            (150_000, 159_999, "manual operation", NOT),
            (220_000, 229_999, "utilities", NOT),
            (230_000, 239_999, "utilities", NOT),
            (240_000, 249_999, "utilities", NOT),
        ]
    };

    #[test]
    fn the_rows_are_in_order_and_say_by_which_code() {
        // R2.114
        assert!(REFUSALS.is_sorted_by(|one, next| one.number < next.number));
        for row in REFUSALS {
            let code = match row.check {
                ControlErrorCheck::Error => format!("P-ERR-{}", row.number),
                ControlErrorCheck::Possible => "FC328".to_owned(),
                ControlErrorCheck::Said(code) => code.to_owned(),
                ControlErrorCheck::Open(_) => continue,
            };
            assert!(code.parse::<Code>().is_ok(), "{}: {code}", row.number);
        }
    }
}
