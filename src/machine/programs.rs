//! The programs that the configuration names, and those that exist only on the machine (R2.14,
//! R2.15, R2.75, R2.83).

use crate::lists::{ChannelPrograms, ProgramRole};

/// Programs that the configuration names (R2.14, R2.15).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct ConfiguredPrograms {
    /// Runs before the first block of every main program, P-CHAN-00119.
    pub start: Option<String>,
    /// Runs before M02 or M30 of every main program, P-CHAN-00252.
    pub end: Option<String>,
    /// Words and the programs that they call: `G80`, `M6`, `T`.
    pub words: Vec<(String, String)>,
    /// The macros of the channel list: name and code.
    pub macros: Vec<(String, String)>,
    /// Whether a T word also has the effect of a D word, P-CHAN-00014.
    pub data_with_tool: bool,
    /// Patterns of programs that exist only on the machine (R2.83).
    pub external: Vec<String>,
    /// Patterns of those that do not change the compensation.
    pub keep_compensation: Vec<String>,
    /// Patterns of those that do not change the axis positions.
    pub keep_positions: Vec<String>,
    /// Patterns of those that write neither parameters nor variables.
    pub keep_parameters: Vec<String>,
}

/// The part of the state that a program on the machine leaves unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Keeps {
    /// The compensation of all axes.
    pub compensation: bool,
    /// Positions of all axes.
    pub positions: bool,
    /// P parameters and variables.
    pub parameters: bool,
}

impl ConfiguredPrograms {
    /// Adds the programs of the channel list; those already configured take precedence (R2.75).
    pub(super) fn add_channel(&mut self, channel: &ChannelPrograms) {
        for (role, name) in channel.programs() {
            let name = name.to_owned();
            match role {
                ProgramRole::Start => _ = self.start.get_or_insert(name),
                ProgramRole::End => _ = self.end.get_or_insert(name),
                ProgramRole::Word(word) if self.word(word).is_none() => {
                    self.words.push((word.clone(), name));
                }
                ProgramRole::Word(_) => {}
            }
        }
        let macros = channel.macros();
        self.macros
            .extend(macros.map(|(name, code)| (name.to_owned(), code.to_owned())));
        self.data_with_tool |= channel.data_with_tool();
    }

    /// Returns whether a role has a program.
    pub(super) fn has(&self, role: &ProgramRole) -> bool {
        match role {
            ProgramRole::Start => self.start.is_some(),
            ProgramRole::End => self.end.is_some(),
            ProgramRole::Word(word) => self.word(word).is_some(),
        }
    }

    /// Returns the program that a word calls; the word has its canonical form, such as `M6`.
    pub fn word(&self, word: &str) -> Option<&str> {
        let found = self
            .words
            .iter()
            .find(|(configured, _)| canonical_word(configured) == word);
        found.map(|(_, program)| program.as_str())
    }

    /// Returns whether a program exists only on the machine.
    pub fn is_external(&self, name: &str) -> bool {
        any_matches(&self.external, name)
    }

    /// Returns the part of the state that a program on the machine leaves unchanged.
    pub fn keeps(&self, name: &str) -> Keeps {
        Keeps {
            compensation: any_matches(&self.keep_compensation, name),
            positions: any_matches(&self.keep_positions, name),
            parameters: any_matches(&self.keep_parameters, name),
        }
    }
}

/// Returns a word in upper case with a number without leading zeros: `m06` is `M6`.
pub(crate) fn canonical_word(word: &str) -> String {
    let upper = word.trim().to_ascii_uppercase();
    let (letter, number) = upper.split_at(upper.len().min(1));
    match number.trim_start_matches('0') {
        "" if number.is_empty() => upper,
        "" => format!("{letter}0"),
        digits if digits.bytes().all(|byte| byte.is_ascii_digit()) => format!("{letter}{digits}"),
        _ => upper,
    }
}

/// Returns whether one of the patterns matches a program's name, without its folders unless the pattern has any.
fn any_matches(patterns: &[String], name: &str) -> bool {
    let name = name.replace('\\', "/").to_lowercase();
    let last = name.rsplit('/').next().unwrap_or(&name);
    patterns.iter().any(|pattern| {
        let pattern = pattern.replace('\\', "/").to_lowercase();
        let name = if pattern.contains('/') { &name } else { last };
        matches(&pattern, name)
    })
}

/// Returns whether a name matches a pattern: `*` matches any letters, `?` matches one. Both texts are scanned from the
/// left; the match of the last `*` grows if the rest does not fit, so the work is bounded by the product of both
/// lengths.
fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) =
        (pattern.chars().collect(), name.chars().collect());
    let (mut at, mut in_name) = (0, 0);
    let mut star = None;
    while in_name < name.len() {
        match pattern.get(at) {
            Some('*') => {
                star = Some((at, in_name));
                at += 1;
            }
            Some(letter) if *letter == '?' || *letter == name[in_name] => {
                at += 1;
                in_name += 1;
            }
            _ => {
                let Some((place, taken)) = star else {
                    return false;
                };
                star = Some((place, taken + 1));
                at = place + 1;
                in_name = taken + 1;
            }
        }
    }
    pattern[at..].iter().all(|letter| *letter == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_compared_by_their_numbers() {
        // R2.75
        for (word, wanted) in [
            ("m06", "M6"),
            ("G080", "G80"),
            ("t", "T"),
            ("M00", "M0"),
            ("MSG", "MSG"),
            ("", ""),
        ] {
            assert_eq!(canonical_word(word), wanted);
        }
    }

    #[test]
    fn patterns_name_programs() {
        // R2.83
        let programs = ConfiguredPrograms {
            external: ["*.ecy", "SysCycle*.cyc", "plc/?.nc", "**"].map(str::to_owned)[..3].to_vec(),
            ..ConfiguredPrograms::default()
        };
        for name in [
            "a.ecy",
            "A.ECY",
            r"C:\CNC\x.ecy",
            "syscycleDrill.cyc",
            "SysCycle.cyc",
            "plc/a.nc",
        ] {
            assert!(programs.is_external(name), "{name}");
        }
        for name in [
            "a.nc",
            "ecy",
            "MySysCycle.cyc",
            "a.nc/plc",
            "a.nc",
            "plc/ab.nc",
            "",
        ] {
            assert!(!programs.is_external(name), "{name}");
        }
        assert!(!matches(&"*a".repeat(200), &"a".repeat(150)));
        assert!(matches("**", "") && matches("*", "abc") && !matches("?", ""));
    }
}
