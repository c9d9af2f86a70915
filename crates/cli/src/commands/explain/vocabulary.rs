//! The words that `explain` covers besides codes and parameters: the sections of `docs/words.md`,
//! and the rules and contradictions of `docs/rules`.

use std::fmt::Write as _;

use frictcomp::documents::{RULES, WORDS};
use frictcomp::readings::{Question, QuestionFacts};
use frictcomp_report::wrap;

/// Columns of a rule on its page.
const WIDTH: usize = 80;

/// Offset of the objects of a further axis of the same device.
const PER_CHANNEL: u32 = 0x800;

/// Returns the page about a word, a rule or a contradiction.
pub(crate) fn find(text: &str) -> Option<String> {
    rule(text).or_else(|| word(text))
}

/// Returns every word that has a section.
pub(crate) fn words() -> impl Iterator<Item = &'static str> {
    sections().flat_map(names)
}

/// Returns the sections of the words, each with its title.
fn sections() -> impl Iterator<Item = &'static str> {
    WORDS.split("\n## ").skip(1)
}

/// Returns the names in the title of a section.
fn names(section: &'static str) -> impl Iterator<Item = &'static str> {
    let title = section.lines().next().unwrap_or_default();
    title.split('`').skip(1).step_by(2)
}

/// Returns the section of a word, in whatever form it is written.
fn word(text: &str) -> Option<String> {
    let wanted = canonical(text);
    let section =
        sections().find(|section| names(section).any(|name| canonical(name) == wanted))?;
    Some(format!("# {}\n", section.trim_end()))
}

/// Returns the rule or contradiction with a number: `R1.24`, `c12`.
fn rule(text: &str) -> Option<String> {
    let number = text.to_ascii_uppercase();
    let begins = format!("- **{number}** ");
    let at = RULES.find(&begins)? + begins.len();
    let is_title = number.starts_with(['R', 'C']);
    let rest = RULES[at..].split("\n- ").next().unwrap_or_default();
    let rule = rest.split("\n\n").next().unwrap_or_default();
    let mut lines = rule.trim_end().lines();
    let mut page = format!("# {number}\n\n{}\n", wrap(lines.next()?, WIDTH, 0));
    for (count, line) in lines.enumerate() {
        let point = wrap(line.trim_start_matches([' ', '-']), WIDTH, 2);
        let before = if count == 0 { "\n" } else { "" };
        let _ = writeln!(page, "{before}- {}", point.replace('\n', "\n  "));
    }
    let question = Question::ALL
        .into_iter()
        .find(|it| it.facts().rule == number);
    page.extend(question.map(|it| about(it.facts())));
    is_title.then_some(page)
}

/// Returns the question that the documents leave open, with its readings, what depends on it, and where the answer goes.
fn about(facts: &QuestionFacts) -> String {
    let QuestionFacts {
        rule,
        question,
        depends,
        ..
    } = facts;
    let assumed = facts.assumed_name();
    let readings = facts.readings.iter().zip(facts.meanings);
    let readings = readings.map(|(name, meaning)| {
        let assumed = if *name == assumed { ", assumed" } else { "" };
        format!("- `{name}`{assumed}: {meaning}\n")
    });
    let assumption = match facts.assumed {
        Some(_) => format!("Assumed because {}.", facts.why),
        None => format!("Neither is assumed: {}.", facts.why),
    };
    format!(
        "\nThe documents leave this open: {question}\n\n{}\n{}\n{}\n\n{}\n",
        readings.collect::<String>(),
        wrap(&assumption, WIDTH, 0),
        wrap(&format!("It decides {depends}."), WIDTH, 0),
        wrap(
            &format!(
                "`frictcomp ask write` writes the program that asks the control; the answer stands under \
                 `\"{rule}\"` in `[reading]` of frictcomp.toml."
            ),
            WIDTH,
            0
        ),
    )
}

/// Returns one form for all spellings of a word: a command, a variable of an axis, a machine
/// parameter of an axis, a key with indices, an object or an IDN of a drive.
pub(crate) fn canonical(text: &str) -> String {
    let mut text = text.trim().trim_end_matches(':').to_ascii_uppercase();
    if text.contains("[COMP") {
        return "COMP".to_owned();
    }
    if let Some(variable) = text.strip_prefix("V.A.") {
        let end = variable.find(['.', '[']).unwrap_or(variable.len());
        return format!("V.A.{}", &variable[..end]);
    }
    if text.starts_with("MP") {
        text.truncate(text.find('.').unwrap_or(text.len()));
        return text;
    }
    idn(&text)
        .or_else(|| object(&text))
        .unwrap_or_else(|| without_indices(&text))
}

/// Turns `S_0_81` and `IDN 81` into `S-0-0081`, in every parameter set.
fn idn(text: &str) -> Option<String> {
    let spaced = text.replace(['-', '_'], " ");
    let mut parts = spaced.split_whitespace();
    let number: u16 = match (parts.next()?, parts.next()?, parts.next()) {
        ("S", set, Some(number)) if set.len() == 1 => number.parse().ok()?,
        ("IDN", number, None) => number.parse().ok()?,
        _ => return None,
    };
    Some(format!("S-0-{number:04}"))
}

/// Turns `0x60B2`, `60B2h`, `60B2_00` and `68B2` into `60B2`.
fn object(text: &str) -> Option<String> {
    let digits = text.strip_prefix("0X").or_else(|| text.strip_prefix("#X"));
    let digits = digits.unwrap_or(text);
    let end = digits.find(['_', ':', '.']).unwrap_or(digits.len());
    let is_first = matches!(
        digits[end..].trim_start_matches(['_', ':', '.']),
        "" | "0" | "00"
    );
    let digits = digits[..end].trim_end_matches('H');
    if digits.len() != 4 || !is_first {
        return None;
    }
    let object = u32::from_str_radix(digits, 16).ok()?;
    let firsts = [0x60B2, 0x6077, 0x6071];
    let meant = firsts.into_iter().find(|&first| {
        let channels = (0..8).map(|channel| first + channel * PER_CHANNEL);
        channels.into_iter().any(|it| it == object)
    });
    meant.map(|object| format!("{object:04X}"))
}

/// Returns a key without its indices.
fn without_indices(text: &str) -> String {
    let mut parts = text.split('[');
    let mut key = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        key.push('[');
        match part.split_once(']') {
            Some((index, rest))
                if index == "I" || index.bytes().all(|it| it.is_ascii_digit() || it == b' ') =>
            {
                key.push(']');
                key.push_str(rest);
            }
            _ => key.push_str(part),
        }
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::explain::page_about;
    use frictcomp::comp::Kind;
    use frictcomp::lists::known_keys;

    #[test]
    fn every_word_has_one_section() {
        let mut seen = std::collections::BTreeSet::new();
        for name in words() {
            assert!(seen.insert(canonical(name)), "{name} occurs twice");
            assert!(find(name).is_some(), "{name}");
        }
    }

    #[test]
    fn every_kind_and_every_key_is_known() {
        let is_friction =
            |text: &str| text.starts_with("frict_comp.") || text == "lr_param.frict_comp";
        for key in known_keys().filter(|key| !is_friction(key.pattern)) {
            for word in [key.pattern, key.number] {
                assert!(word.is_empty() || page_about(word).is_ok(), "{word}");
            }
        }
        for kind in Kind::ALL {
            let page = word(kind.as_str()).expect("a kind");
            let facts = kind.facts();
            for fact in [facts.selector, facts.parameter, facts.refusal.as_str()] {
                assert!(page.contains(fact), "{kind}: {fact}");
            }
        }
    }

    #[test]
    fn words_are_found_in_every_form() {
        for (text, title) in [
            ("comp", "`COMP`"),
            ("X[COMP ON FRICT]", "`COMP`"),
            ("off_all", "`OFF_ALL`"),
            ("V.A.FRICT_COMP_ACTIVE.X", "`V.A.FRICT_COMP_ACTIVE`"),
            ("V.A.FRICT_COMP_INIT[0]", "`V.A.FRICT_COMP_INIT`"),
            ("0x60b2", "60B2"),
            ("60B2h", "60B2"),
            ("68B2_00", "60B2"),
            ("6077:00", "6077"),
            ("S_0_0081", "S-0-0081"),
            ("S-1-81", "S-0-0081"),
            ("mp1511.2", "`MP1511`"),
            ("achs_mds[i]", "achs_mds"),
            ("r1.27", "R1.27"),
            ("C12", "C12"),
        ] {
            let page = find(text).unwrap_or_default();
            assert!(
                page.lines().next().is_some_and(|it| it.contains(title)),
                "{text}: {page}"
            );
        }
        for text in ["", "R99.1", "C99", "R", "60B3", "S-0-9999", "COMB", "V.A.X"] {
            assert_eq!(find(text), None, "{text}");
        }
    }
}
