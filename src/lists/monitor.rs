//! P-AXIS-00465, the kinds without which an axis must not move (R1.36).

use std::fmt;

use super::entry::{Entry, Given, Number};
use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, nearest};

/// The key of P-AXIS-00465.
pub(super) const REQUIRED: &str = "lr_param.prog_movement_requires_compensations";

/// The kinds that must be active while an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Monitor {
    /// The kinds that are named or whose bit is set.
    pub kinds: KindSet,
    /// The bits for which no kind is documented; their requirement is not judged.
    pub open: u64,
}

impl Monitor {
    /// Creates a monitor of these kinds.
    pub fn of_kinds(kinds: KindSet) -> Self {
        Self { kinds, open: 0 }
    }

    /// Reads words joined by `|`, or a bit code in any form of number. Reports once which of them
    /// are not judged.
    pub(super) fn of(entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> Given<Self> {
        let mut monitor = Self::default();
        for word in entry.words() {
            if let Ok(kind) = word.value.parse::<Kind>() {
                monitor.kinds.insert(kind);
            } else if let Some(bits) = bit_code(word.value) {
                let open = monitor.add(bits);
                if open != 0 {
                    diagnostics.push(undocumented(&word, open));
                }
            } else if !word.value.eq_ignore_ascii_case("NONE") {
                diagnostics.push(no_kind(&word));
            }
        }
        entry.word().with(monitor)
    }

    /// Adds the kinds of a bit code and returns the bits that no document explains.
    fn add(&mut self, bits: u64) -> u64 {
        let mut open = bits;
        for kind in Kind::ALL {
            if let Some(bit) = kind.facts().monitor_bit
                && bits & bit != 0
            {
                self.kinds.insert(kind);
                open &= !bit;
            }
        }
        self.open |= open;
        open
    }
}

/// The words of an axis list, followed by a bit code for what is not judged.
impl fmt::Display for Monitor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut words: Vec<String> = self.kinds.iter().map(|kind| kind.to_string()).collect();
        if self.open != 0 {
            words.push(format!("{:#x} (not judged)", self.open));
        }
        f.write_str(&words.join(" | "))
    }
}

/// Reads a bit code: `2`, `0x02`, `'16#2'`, `2#10`.
fn bit_code(word: &str) -> Option<u64> {
    let word = word.trim_matches('\'');
    if let Some((base, digits)) = word.split_once('#') {
        let base = base.parse().ok().filter(|base| (2..=36).contains(base))?;
        return u64::from_str_radix(digits, base).ok();
    }
    match Number::parse(word)? {
        Number::Integer(bits) => u64::try_from(bits).ok(),
        Number::Real(_) => None,
    }
}

/// Returns FC124 for bits without a documented kind.
fn undocumented(word: &Given<&str>, bits: u64) -> Diagnostic {
    let message = format!(
        "no document says which compensation the bits {bits:#x} of `{REQUIRED}` require; whether \
         the axis moves without it is not judged"
    );
    Diagnostic::new(Code::Fc124, word.place(), message)
        .with_help("name the kinds in words: `LEAD | FRICT`")
}

/// Returns FC124 for a word that is not a kind.
fn no_kind(word: &Given<&str>) -> Diagnostic {
    let message = format!(
        "`{}` is not a kind of compensation; whether the axis moves without it is not judged",
        word.value
    );
    let near = nearest(word.value, Kind::ALL.map(Kind::as_str));
    Diagnostic::new(Code::Fc124, word.place(), message).with_near(word.value, &near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_codes_have_any_form_of_number() {
        // R1.36
        for word in ["3", "0x3", "0X03", "16#3", "'16#3'", "2#11", "'8#3'"] {
            assert_eq!(bit_code(word), Some(3), "{word}");
        }
        for word in ["", "'", "-1", "1.0", "16#", "16#G", "LEAD", "0x", "40#1"] {
            assert_eq!(bit_code(word), None, "{word}");
        }
    }
}
