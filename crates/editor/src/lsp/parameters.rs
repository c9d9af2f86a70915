//! Parameters of lists and keys of `frictcomp.toml`, each with a description for the user
//! (R12.3, R12.6).

use std::fmt::Write as _;

use frictcomp::comp::Kind;
use frictcomp::config::{self, CONFIG_FORMS, Form, KeyForm};
use frictcomp::lists::{AxisType, Field};

/// Head of the table of a parameter.
const TABLE_HEAD: &str = "| unit | range | default |\n|---|---|---|\n";

/// A parameter of a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Page {
    /// The key in the list.
    pub(super) key: String,
    /// Text in Markdown.
    pub(super) text: String,
}

/// Returns the meaning of a parameter of the value list; chapter 3 of the rules has the sources.
fn meaning(field: Field) -> &'static str {
    match field {
        Field::Mode => "0 switches friction compensation off, 3 on",
        Field::MaxPoints => {
            "the reserved size of the table; a change needs a restart of the control"
        }
        Field::TableEntries => "how many points of the table are used",
        Field::PositionDelay => "the distance after a reversal over which the current is built up",
        Field::ReversalLookahead => "the CNC cycles before a reversal in which the current decays",
        Field::ScalingFactor => "scales all outputs",
        Field::DelayCycles => "the dead time of the output",
    }
}

/// Returns the parameters of lists that concern compensation.
pub(super) fn pages() -> Vec<Page> {
    let fields = Field::ALL.into_iter().map(|field| {
        let unit = match (field.unit(AxisType::Linear), field.unit(AxisType::Rotary)) {
            ("", _) => "none".to_owned(),
            (one, other) if one == other => one.to_owned(),
            (one, other) => format!("{one}, on rotary axes {other}"),
        };
        let range = match field {
            Field::Mode => "0 or 3".to_owned(),
            field => {
                let range = field.range();
                format!("{} to {}", range.start(), range.end())
            }
        };
        Page {
            key: format!("frict_comp.{}", field.name()),
            text: format!(
                "**{}** {}\n\n{TABLE_HEAD}| {unit} | {range} | {} |\n",
                field.number(),
                meaning(field),
                field.default()
            ),
        }
    });
    let points = [
        (
            "in",
            "**P-COMP-00046** the velocity of a point of the friction curve",
            "\u{b5}m/s, on rotary axes 0.001\u{b0}/s | from 0, each greater than the one before",
        ),
        (
            "out",
            "**P-COMP-00047** the additive current at the velocity of the point",
            "that of the drive | that of the type, without its ends",
        ),
    ];
    let points = points.map(|(end, meaning, facts)| Page {
        key: format!("frict_comp.table[i].{end}"),
        text: format!("{meaning}\n\n{TABLE_HEAD}| {facts} | 0 |\n"),
    });
    let selectors = Kind::ALL.into_iter().flat_map(|kind| {
        let facts = kind.facts();
        let selector = Page {
            key: facts.selector.to_owned(),
            text: format!(
                "**{}** 1 configures the compensation `{kind}` of the axis, 0 does not; the control reads it at its start\n\n{TABLE_HEAD}| none | 0 or 1 | 0 |\n",
                facts.parameter
            ),
        };
        let manual = facts.manual_activation.map(|key| Page {
            key: key.to_owned(),
            text: format!(
                "**{}** 1: `{kind}` is switched by the program only; it is off at the start of the control, at program end and after a reset\n\n{TABLE_HEAD}| none | 0 or 1 | 0 |\n",
                facts.manual_parameter.unwrap_or("manual activation")
            ),
        });
        std::iter::once(selector).chain(manual)
    });
    fields.chain(points).chain(selectors).collect()
}

/// Returns the page of the parameter that a line of a list sets.
pub(super) fn page_of(line: &str) -> Option<Page> {
    let key = line.split([' ', '\t', '(']).find(|word| !word.is_empty())?;
    let plain = without_index(key);
    pages().into_iter().find(|page| page.key == plain)
}

/// Returns the parameters that the beginning of a line of a list may mean. A point of the curve has the typed index,
/// otherwise the first one that the list does not have.
pub(super) fn pages_for(typed: &str, list: &str) -> Vec<Page> {
    let first_free = || {
        let used = list.lines().filter_map(|line| {
            let key = line.split_whitespace().next()?;
            index_of(key.strip_suffix(".out")?)?.parse().ok()
        });
        let next: u64 = used.max().map_or(0, |last: u64| last.saturating_add(1));
        next.to_string()
    };
    let index = index_of(typed).map_or_else(first_free, str::to_owned);
    let pages = pages().into_iter().map(|page| Page {
        key: page.key.replace("[i]", &format!("[{index}]")),
        ..page
    });
    pages.collect()
}

/// Returns the text in the first bracket of a key.
fn index_of(key: &str) -> Option<&str> {
    let (_, rest) = key.split_once('[')?;
    Some(rest.split(']').next().unwrap_or(rest).trim())
}

/// Returns a key with `[i]` in place of each index.
fn without_index(key: &str) -> String {
    let mut plain = String::new();
    let mut is_index = false;
    for letter in key.chars() {
        match letter {
            '[' => {
                plain.push_str("[i]");
                is_index = true;
            }
            ']' => is_index = false,
            letter if !is_index => plain.push(letter),
            _ => {}
        }
    }
    plain
}

/// Returns the keys of a table of `frictcomp.toml`, by its header; an empty header is that of the file itself.
pub(super) fn keys_of(header: &str) -> Vec<Page> {
    let tables = CONFIG_FORMS.iter().enumerate();
    let mut found = tables.filter(|(at, table)| match header {
        "" => *at == 0,
        header => table.header == header,
    });
    let keys = found.next().map_or(&[][..], |(_, table)| table.keys);
    keys.iter().map(page_of_key).collect()
}

/// Returns the page of a key: its meaning, the form of its value, an example, and the parameter that it gives.
fn page_of_key(key: &KeyForm) -> Page {
    let mut text = format!("{}: {}\n", key.meaning, in_words(key.form));
    if let Some(example) = config::example(key.key) {
        let _ = writeln!(text, "\n{example}");
    }
    let is_it = |page: &Page| page.key.rsplit('.').next() == Some(key.key);
    if let Some(parameter) = pages().into_iter().find(is_it) {
        let _ = write!(text, "\n{}", parameter.text);
    }
    Page {
        key: key.key.to_owned(),
        text,
    }
}

fn in_words(form: Form) -> String {
    match form {
        Form::Text => "a text".to_owned(),
        Form::OneOf(words) => format!("one of `{}`", words.join("`, `")),
        Form::Texts => "a list of texts".to_owned(),
        Form::Kinds => format!("a list of {}", Kind::ALL.map(Kind::as_str).join(", ")),
        Form::Truth => "`true` or `false`".to_owned(),
        Form::TruthOrTexts => "`true`, `false` or a list of texts".to_owned(),
        Form::WholeNumber => "a whole number from 0 to 65535".to_owned(),
        Form::Positive => "a number above 0".to_owned(),
        Form::Number => "a number".to_owned(),
        Form::Within([from, to]) => format!("a number from {from} to {to}"),
        Form::NumberOrText => "a number or a text".to_owned(),
        Form::SkipLevels => "skip levels".to_owned(),
        Form::Points(None) => "a list of pairs of numbers".to_owned(),
        Form::Points(Some(most)) => format!("a list of at most {most} pairs of numbers"),
        Form::Level => "a severity".to_owned(),
        Form::Table(header) | Form::Tables(header) => format!("a table, `{header}`"),
    }
}

/// Returns the page of the key of a `frictcomp.toml` around an offset of a line, in the table with a header.
pub(super) fn page_of_toml(line: &str, offset: usize, header: &str) -> Option<Page> {
    let is_key = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let (before, after) = line.split_at_checked(offset)?;
    let start = before.trim_end_matches(is_key);
    let rest = after.trim_start_matches(is_key);
    let word = &line[start.len()..line.len() - rest.len()];
    let begins_a_key =
        |text: &str| text.trim_end().is_empty() || text.trim_end().ends_with(['{', ',']);
    let is_header = line.trim_start().starts_with('[');
    let is_of_a_value = begins_a_key(start) && rest.trim_start().starts_with('=');
    if !is_header && !is_of_a_value {
        return None;
    }
    let inner = start.contains('{').then_some("[axis.value]");
    let own = keys_of(inner.unwrap_or(header));
    let own = own.into_iter().filter(|_| !is_header);
    let tables = CONFIG_FORMS.iter().filter(|_| is_header);
    let tables = tables.flat_map(|table| table.keys).map(page_of_key);
    own.chain(tables).find(|page| page.key == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_a_list_has_the_page_of_its_parameter() {
        // R12.3
        let page = page_of("frict_comp.position_delay   4 ( 0.4 um )").expect("a page");
        assert!(
            page.text.contains("P-COMP-00043") && page.text.contains("| 0 to 10 | 0 |"),
            "{page:?}"
        );
        let page = page_of("  frict_comp.table[12].in 100").expect("a page");
        assert_eq!(page.key, "frict_comp.table[i].in");
        let page = page_of("lr_param.frict_comp 1").expect("a page");
        assert!(page.text.starts_with("**P-AXIS-00522**"));
        assert_eq!(page_of("kopf.achs_nr 1"), None);
        assert_eq!(page_of(""), None);
    }

    #[test]
    fn a_point_of_the_curve_has_its_index() {
        // R12.17
        let list =
            "frict_comp.table[0].in 0\nfrict_comp.table[0].out 0\nfrict_comp.table[1].in 5\n";
        let keys = |typed: &str| {
            let pages = pages_for(typed, list).into_iter();
            let keys: Vec<String> = pages.map(|page| page.key).collect();
            keys.into_iter()
                .filter(|key| key.starts_with(typed))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            keys("frict_comp.tab"),
            [
                "frict_comp.table_entries",
                "frict_comp.table[1].in",
                "frict_comp.table[1].out"
            ]
        );
        assert_eq!(keys("frict_comp.table[7].o"), ["frict_comp.table[7].out"]);
    }

    #[test]
    fn keys_come_with_an_example() {
        // R12.6
        let keys = keys_of("[[axis]]");
        let name = keys
            .iter()
            .find(|page| page.key == "axis_list")
            .expect("a key");
        assert!(name.text.contains("lists/axis_x.lis"));
        assert!(keys_of("[nothing]").is_empty() && !keys_of("").is_empty());
    }

    #[test]
    fn a_key_of_a_configuration_has_its_page_where_it_stands() {
        // R12.21
        let text = |line: &str, at: usize, header: &str| {
            page_of_toml(line, at, header)
                .map(|page| page.text)
                .unwrap_or_default()
        };
        assert!(text("frict_comp = true", 3, "[[axis]]").contains("**P-AXIS-00522**"));
        let value = "value = { mode = 3, position_delay = 4 }";
        let delay = text(value, 24, "[[axis]]");
        assert!(
            delay.contains("**P-COMP-00043**") && delay.contains("| 0 to 10 | 0 |"),
            "{delay}"
        );
        assert!(text("[axis.value]", 8, "[[axis]]").contains("[axis.value]"));
        for (line, at) in [
            ("frict_comp = true", 14),
            ("# frict_comp", 5),
            ("nothing = 1", 2),
            ("", 0),
            ("a", 9),
        ] {
            assert_eq!(text(line, at, "[[axis]]"), "", "{line}");
        }
        let page = page_of("frict_comp.table[3].in 5").expect("a page");
        assert!(page.text.contains("**P-COMP-00046**") && page.text.contains("| 0 |"));
    }
}
