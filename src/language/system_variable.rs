//! The variables of the control that a program may only read (R2.102).
//!
//! TF5200 Programming manual, pages 207902603 (`V.A.`) and 207916683 (`V.G.`). A variable that is not listed here may be
//! one that can be written: the pages list those of options elsewhere.

/// Variables of an axis, without `V.A.` and without the axis.
const OF_AXIS: &[&str] = &[
    "ABS",
    "ACS",
    "ACT_POS",
    "MENT",
    "MODE",
    "MODULO_VALUE",
    "PROG",
];

/// Variables of the channel, without `V.G.`.
const OF_CHANNEL: &[&str] = &[
    "BLOCK_NR",
    "FEEDRATE",
    "FEEDRATE_MODE",
    "I",
    "J",
    "K",
    "MASS_360",
    "MASS_MM",
    "PROG_NR",
    "PROG_SA",
    "R",
    "SATZ_NR",
];

/// Returns whether a program may only read the variable, whose name has its family in upper case.
pub(crate) fn is_read_only(name: &str) -> bool {
    let is_in = |prefix: &str, rows: &[&str]| {
        let rest = name.strip_prefix(prefix);
        let word = rest.and_then(|rest| rest.split(['.', '[']).next());
        word.is_some_and(|word| rows.contains(&word))
    };
    is_in("V.A.", OF_AXIS) || is_in("V.G.", OF_CHANNEL)
}
