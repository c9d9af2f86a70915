//! The place of a picture, and its style.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::LazyLock;

/// The place of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frame<'a> {
    /// A separate file, which carries its style.
    Alone,
    /// Part of a page that has [`style`] in its own; the name makes the identifiers of the picture unique there.
    Inside(&'a str),
}

/// The colours of all pictures, pages and views, as custom properties: light, dark, print.
pub(crate) const COLOURS: &str = include_str!("../colours.css");

/// The rules of pictures, with the names of colours.
const RULES: &str = include_str!("style.css");

/// Returns the style of all pictures. It has only class rules and no custom property: viewers without `@media` draw them
/// on a light ground, and those without `var` in their colours.
pub fn style() -> &'static str {
    static STYLE: LazyLock<String> = LazyLock::new(resolved);
    &STYLE
}

/// Returns the rules with light colours, and those of other media with the colours that differ there.
fn resolved() -> String {
    let mut media = COLOURS.split("@media ");
    let light = properties(media.next().unwrap_or_default());
    let mut style = String::new();
    for rule in RULES.lines() {
        let _ = writeln!(style, "{}", with_colours(rule, &light));
    }
    for block in media {
        let (condition, block) = block.split_once('{').unwrap_or_default();
        let own = properties(block);
        let names_own = |rule: &&str| {
            own.keys()
                .any(|name| rule.contains(&format!("var({name})")))
        };
        let mut all = light.clone();
        all.extend(&own);
        let _ = writeln!(style, "@media {condition}{{");
        for rule in RULES.lines().filter(names_own) {
            let _ = writeln!(style, "{}", with_colours(rule, &all));
        }
        style.push_str("}\n");
    }
    style
}

/// Returns the custom properties of a block.
fn properties(block: &'static str) -> BTreeMap<&'static str, &'static str> {
    let lines = block.lines().map(str::trim);
    let pairs = lines.filter_map(|line| line.strip_suffix(';')?.split_once(": "));
    pairs.filter(|(name, _)| name.starts_with("--")).collect()
}

fn with_colours(rule: &str, colours: &BTreeMap<&str, &str>) -> String {
    let mut text = rule.to_owned();
    for (name, value) in colours {
        text = text.replace(&format!("var({name})"), value);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_of_a_picture_is_in_the_table() {
        // R18.25
        assert!(!RULES.contains('#'));
        let style = style();
        assert!(!style.contains("var("), "{style}");
        assert_eq!(style.matches("@media").count(), 3);
        let dark = style
            .split("prefers-color-scheme: dark")
            .nth(1)
            .expect("dark");
        assert!(dark.contains(".fc-active{fill:#16344d;stroke:#58b4f0}"));
    }
}
