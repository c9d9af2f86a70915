//! The form of the value of each key, for editors of TOML (R17.6).

use super::file::{CHECK, LINT, ROOT, VARIABLES};
use super::machine::{
    AXIS, CONFIRMATION, CONFIRMED, EXTERNAL_KEEPS, MACHINE, READING, VALUE, WORDS,
};
use super::section::Shape;

/// The form of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// A text.
    Text,
    /// One of the given texts.
    OneOf(&'static [&'static str]),
    /// A list of texts.
    Texts,
    /// A list of kinds of compensation.
    Kinds,
    /// `true` or `false`, also as 1 or 0.
    Truth,
    /// `true`, `false`, or a list of texts.
    TruthOrTexts,
    /// A whole number from 0 to 65535.
    WholeNumber,
    /// A number above 0.
    Positive,
    /// A number.
    Number,
    /// A number from the first to the second.
    Within([f64; 2]),
    /// A number or a text.
    NumberOrText,
    /// Skip levels.
    SkipLevels,
    /// A list of pairs of numbers, with the maximum number of pairs.
    Points(Option<usize>),
    /// The severity of a code.
    Level,
    /// A table, by its header.
    Table(&'static str),
    /// An array of tables, by its header.
    Tables(&'static str),
}

/// A key with the form of its value.
#[derive(Debug, Clone, Copy)]
pub struct KeyForm {
    /// The key.
    pub key: &'static str,
    /// The form of its value.
    pub form: Form,
    /// Meaning, in a few words.
    pub meaning: &'static str,
}

/// A table with the forms of its values.
#[derive(Debug, Clone, Copy)]
pub struct TableForm {
    /// Header, `[[axis]]`; the file itself is named after it.
    pub header: &'static str,
    /// Keys, except those that the user chooses.
    pub keys: &'static [KeyForm],
    /// The form of the values of keys that the user chooses.
    pub free: Option<Form>,
    /// The keys that it must have.
    pub required: &'static [&'static str],
}

const fn key(key: &'static str, form: Form, meaning: &'static str) -> KeyForm {
    KeyForm { key, form, meaning }
}

const fn table(shape: &Shape, keys: &'static [KeyForm]) -> TableForm {
    TableForm {
        header: shape.name,
        keys,
        free: None,
        required: &[],
    }
}

/// The tables of `frictcomp.toml`, the file itself first.
pub static CONFIG_FORMS: [TableForm; 12] = [
    table(
        &ROOT,
        &[
            key(
                "machine",
                Form::Table(MACHINE.name),
                "the machine and its control",
            ),
            key(
                "axis",
                Form::Tables(AXIS.name),
                "the axes, in the order of the machine",
            ),
            key(
                "variables",
                Form::Table(VARIABLES.name),
                "values that only the machine knows",
            ),
            key(
                "lint",
                Form::Table(LINT.name),
                "severities of the messages of frictcomp",
            ),
            key("check", Form::Table(CHECK.name), "what is a program"),
            key(
                "reading",
                Form::Table(READING.name),
                "how open questions of the documents are read, by their rules",
            ),
            key(
                "confirmed",
                Form::Table(CONFIRMED.name),
                "which build of the control answered them, by their rules",
            ),
        ],
    ),
    table(
        &MACHINE,
        &[
            key(
                "startup",
                Form::Text,
                "the start-up list of the control, from this folder",
            ),
            key(
                "project",
                Form::Text,
                "the TwinCAT project that holds the lists, from this folder",
            ),
            key("cycle_time_ms", Form::Positive, "the CNC cycle in ms"),
            key(
                "cnc_build",
                Form::Text,
                "the build of the control, `3.1.3132.0`",
            ),
            key(
                "program_dirs",
                Form::Texts,
                "further folders with called programs",
            ),
            key(
                "start_program",
                Form::Text,
                "runs before every main program, P-CHAN-00119",
            ),
            key(
                "end_program",
                Form::Text,
                "runs before M02 and M30, P-CHAN-00252",
            ),
            key(
                "keep_parameters",
                Form::Truth,
                "whether P parameters outlive a program",
            ),
            key("skip", Form::SkipLevels, "the skip levels that are on"),
            key(
                "programs",
                Form::Table(WORDS.name),
                "the programs that words call",
            ),
            key(
                "external",
                Form::Texts,
                "programs that only the machine has",
            ),
            key(
                "external_keeps",
                Form::Table(EXTERNAL_KEEPS.name),
                "what those do not change",
            ),
            key(
                "harmless",
                Form::Texts,
                "commands and functions that change nothing here, and cycles that keep the states",
            ),
        ],
    ),
    table(
        &EXTERNAL_KEEPS,
        &[
            key(
                "compensation",
                Form::TruthOrTexts,
                "the states of compensation",
            ),
            key("positions", Form::TruthOrTexts, "the positions of the axes"),
            key(
                "parameters",
                Form::TruthOrTexts,
                "P parameters and variables",
            ),
        ],
    ),
    TableForm {
        free: Some(Form::Text),
        ..table(&WORDS, &[])
    },
    TableForm {
        required: &["name"],
        ..table(
            &AXIS,
            &[
                key("name", Form::Text, "the name in programs"),
                key(
                    "type",
                    Form::OneOf(&["T", "R", "S"]),
                    "T linear, R rotary, S spindle",
                ),
                key(
                    "number",
                    Form::WholeNumber,
                    "the number of the axis, kopf.achs_nr",
                ),
                key("frict_comp", Form::Truth, "P-AXIS-00522"),
                key(
                    "enable",
                    Form::Truth,
                    "assume P-AXIS-00522 = 1 and an accepted value list",
                ),
                key("axis_list", Form::Text, "the axis list, from this folder"),
                key(
                    "value_list",
                    Form::Text,
                    "the compensation value list, from this folder",
                ),
                key(
                    "value",
                    Form::Table(VALUE.name),
                    "the value list, written here",
                ),
                key(
                    "compensations",
                    Form::Kinds,
                    "other kinds that are configured",
                ),
                key(
                    "manual_activation",
                    Form::Kinds,
                    "kinds that only a program switches on",
                ),
                key(
                    "required",
                    Form::Kinds,
                    "kinds that must be active, P-AXIS-00465",
                ),
                key("max_velocity", Form::Positive, "in mm/min or \u{b0}/min"),
                key(
                    "max_acceleration",
                    Form::Positive,
                    "in m/s\u{b2} or \u{b0}/s\u{b2}",
                ),
                key("max_jerk", Form::Positive, "in m/s\u{b3} or \u{b0}/s\u{b3}"),
                key(
                    "lead",
                    Form::Positive,
                    "mm in a turn of the motor, for recordings",
                ),
            ],
        )
    },
    table(
        &VALUE,
        &[
            key("mode", Form::Number, "P-COMP-00041: 0 off, 3 on"),
            key("max_points", Form::Number, "P-COMP-00062, reserved points"),
            key(
                "table_entries",
                Form::Number,
                "P-COMP-00042, points that are used",
            ),
            key(
                "position_delay",
                Form::Number,
                "P-COMP-00043, in 0.1 \u{b5}m",
            ),
            key(
                "reversal_lookahead",
                Form::Number,
                "P-COMP-00044, in CNC cycles",
            ),
            key("scaling_factor", Form::Number, "P-COMP-00045, in 0.1 %"),
            key("delay_cycles", Form::Number, "P-COMP-00058, in CNC cycles"),
            key(
                "table",
                Form::Points(None),
                "points: velocity in \u{b5}m/s, current in drive units",
            ),
        ],
    ),
    TableForm {
        free: Some(Form::NumberOrText),
        ..table(
            &VARIABLES,
            &[
                key(
                    "stable",
                    Form::Texts,
                    "variables that keep their value while a program runs",
                ),
                key(
                    "own",
                    Form::Texts,
                    "V.E. variables that only programs write",
                ),
            ],
        )
    },
    TableForm {
        free: Some(Form::Level),
        ..table(&LINT, &[])
    },
    TableForm {
        free: Some(Form::Text),
        ..table(&READING, &[])
    },
    TableForm {
        free: Some(Form::Table(CONFIRMATION.name)),
        ..table(&CONFIRMED, &[])
    },
    TableForm {
        required: &["build", "date"],
        ..table(
            &CONFIRMATION,
            &[
                key("build", Form::Text, "the build of the control"),
                key("date", Form::Text, "the date of the answer"),
            ],
        )
    },
    table(
        &CHECK,
        &[
            key(
                "extensions",
                Form::Texts,
                "of programs in folders, in place of the usual ones",
            ),
            key(
                "exclude",
                Form::Texts,
                "files and folders that are left out, by patterns as in a `.gitignore`",
            ),
        ],
    ),
];

#[cfg(test)]
mod tests {
    use super::super::section::keys;
    use super::*;

    #[test]
    fn every_key_that_is_read_has_a_form() {
        // R17.6
        for table in &CONFIG_FORMS {
            let header = if table.header == ROOT.name {
                ""
            } else {
                table.header
            };
            let Some(read) = keys(header) else {
                assert!(table.free.is_some(), "{header}");
                continue;
            };
            let mut read = read.to_vec();
            let mut formed: Vec<&str> = table.keys.iter().map(|it| it.key).collect();
            read.sort_unstable();
            formed.sort_unstable();
            assert_eq!(read, formed, "{header}");
        }
    }
}
