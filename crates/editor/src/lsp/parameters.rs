//! Parameters of lists and keys of `frictcomp.toml`, each with a description for the user
//! (R12.3, R12.6).

use frictcomp::comp::Kind;
use frictcomp::config;
use frictcomp::lists::{AxisType, Field};

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

/// The parameters of lists that concern compensation.
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
                "**{}** {}\n\n| unit | range | default |\n|---|---|---|\n| {unit} | {range} | {} |\n",
                field.number(),
                meaning(field),
                field.default()
            ),
        }
    });
    let points = [
        ("in", "a velocity, in \u{b5}m/s or 0.001\u{b0}/s"),
        ("out", "the additive current at this velocity"),
    ];
    let points = points.map(|(end, meaning)| Page {
        key: format!("frict_comp.table[i].{end}"),
        text: format!("a point of the friction curve: {meaning}\n"),
    });
    let selectors = Kind::ALL.into_iter().flat_map(|kind| {
        let facts = kind.facts();
        let selector = Page {
            key: facts.selector.to_owned(),
            text: format!(
                "**{}** 1 configures the compensation `{kind}` of the axis, 0 does not; the control reads it at its start\n\n| unit | range | default |\n|---|---|---|\n| none | 0 or 1 | 0 |\n",
                facts.parameter
            ),
        };
        let manual = facts.manual_activation.map(|key| Page {
            key: key.to_owned(),
            text: format!(
                "**{}** 1: `{kind}` is switched by the program only; it is off at the start of the control, at program end and after a reset\n",
                facts.manual_parameter.unwrap_or("manual activation")
            ),
        });
        std::iter::once(selector).chain(manual)
    });
    fields.chain(points).chain(selectors).collect()
}

/// The page of the parameter that a line of a list sets.
pub(super) fn page_of(line: &str) -> Option<Page> {
    let key = line.split([' ', '\t', '(']).find(|word| !word.is_empty())?;
    let plain = without_index(key);
    pages().into_iter().find(|page| page.key == plain)
}

/// The parameters that the beginning of a line of a list may mean. A point of the curve has the typed
/// index, otherwise the first one that the list does not have.
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

/// The keys of a table of `frictcomp.toml`, each with an example; the tables themselves above the
/// first one.
pub(super) fn keys_of(table: &str) -> Vec<Page> {
    let keys = config::keys(table).into_iter().flatten();
    let pages = keys.map(|key| Page {
        key: (*key).to_owned(),
        text: config::example(key).unwrap_or_default().to_owned(),
    });
    pages.collect()
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
}
