//! The documents about rules, words and parameters that tools show.

/// The rules that the library follows, chapter by chapter. Each begins a line, `- **R1.24** …`; its points are a list
/// below it.
pub const RULES: &str = concat!(
    include_str!("../docs/rules/01-comp.md"),
    include_str!("../docs/rules/02-language.md"),
    include_str!("../docs/rules/03-lists.md"),
    include_str!("../docs/rules/04-current.md"),
    include_str!("../docs/rules/05-motion.md"),
    include_str!("../docs/rules/06-recordings.md"),
    include_str!("../docs/rules/07-drive-interface.md"),
    include_str!("../docs/rules/08-stiction.md"),
    include_str!("../docs/rules/09-output.md"),
    include_str!("../docs/rules/10-order.md"),
    include_str!("../docs/rules/11-contour.md"),
    include_str!("../docs/rules/12-editor.md"),
    include_str!("../docs/rules/13-systems.md"),
    include_str!("../docs/rules/14-conditions.md"),
    include_str!("../docs/rules/15-questions.md"),
    include_str!("../docs/rules/16-machine.md"),
    include_str!("../docs/rules/17-causes.md"),
    include_str!("../docs/rules/18-verdicts.md"),
);

/// The technical words, one section each; its title names them in backquotes.
pub const WORDS: &str = include_str!("../docs/words.md");

/// A parameter of the lists that has a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct ParameterPage {
    /// Number in the manuals, `P-COMP-00041`.
    pub number: &'static str,
    /// Key in the lists.
    pub key: &'static str,
    /// The page.
    pub page: &'static str,
}

macro_rules! parameters {
    ($($number:literal $key:literal;)+) => {
        [$(ParameterPage {
            number: $number,
            key: $key,
            page: include_str!(concat!("../docs/codes/", $number, ".md")),
        },)+]
    };
}

/// The parameters that have a page (chapter 3).
pub static PARAMETER_PAGES: [ParameterPage; 11] = parameters! {
    "P-AXIS-00465" "lr_param.prog_movement_requires_compensations";
    "P-AXIS-00522" "lr_param.frict_comp";
    "P-COMP-00041" "frict_comp.mode";
    "P-COMP-00042" "frict_comp.table_entries";
    "P-COMP-00043" "frict_comp.position_delay";
    "P-COMP-00044" "frict_comp.reversal_lookahead";
    "P-COMP-00045" "frict_comp.scaling_factor";
    "P-COMP-00046" "frict_comp.table[i].in";
    "P-COMP-00047" "frict_comp.table[i].out";
    "P-COMP-00058" "frict_comp.delay_cycles";
    "P-COMP-00062" "frict_comp.max_points";
};
