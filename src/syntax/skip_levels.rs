//! The levels of skipped blocks.

use std::fmt;
use std::str::FromStr;

/// The skip levels whose switch is on: their blocks are not executed, those of all others are (R2.90).
///
/// ```
/// use frictcomp::syntax::SkipLevels;
///
/// let levels: SkipLevels = "1,3-5".parse()?;
/// assert!(levels.has(4) && !levels.has(2));
/// assert_eq!("none".parse(), Ok(SkipLevels::NONE));
/// # Ok::<(), frictcomp::syntax::NoSkipLevels>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct SkipLevels(u16);

impl SkipLevels {
    /// Set without levels.
    pub const NONE: Self = Self(0);

    /// Set of all levels.
    pub const ALL: Self = Self(((1 << Self::HIGHEST) - 1) << 1);

    /// The highest level.
    pub const HIGHEST: u8 = 10;

    /// Adds a level; `None` where there is no such level.
    pub fn with(self, level: u8) -> Option<Self> {
        (1..=Self::HIGHEST)
            .contains(&level)
            .then_some(Self(self.0 | 1 << level))
    }

    /// Returns whether blocks of a level are skipped.
    pub fn has(self, level: u8) -> bool {
        self.0 & (1 << level.min(15)) != 0
    }
}

impl fmt::Display for SkipLevels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let on = (1..=Self::HIGHEST).filter(|level| self.has(*level));
        let on: Vec<String> = on.map(|level| level.to_string()).collect();
        f.pad(&match on.len() {
            0 => "none".to_owned(),
            10 => "all".to_owned(),
            _ => on.join(","),
        })
    }
}

/// A text that names no skip levels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoSkipLevels(String);

impl fmt::Display for NoSkipLevels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NoSkipLevels {}

impl FromStr for SkipLevels {
    type Err = NoSkipLevels;

    /// Reads `none`, `all` or levels, `1,3-5`.
    fn from_str(text: &str) -> Result<Self, NoSkipLevels> {
        match text.trim() {
            word if word.eq_ignore_ascii_case("none") => return Ok(Self::NONE),
            word if word.eq_ignore_ascii_case("all") => return Ok(Self::ALL),
            _ => {}
        }
        let mut levels = Self::NONE;
        for part in text.split(',') {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let (first, last) = (level(first)?, level(last)?);
            if first > last {
                return Err(NoSkipLevels(format!("`{part}` runs backwards")));
            }
            levels =
                (first..=last).fold(levels, |levels, level| levels.with(level).unwrap_or(levels));
        }
        Ok(levels)
    }
}

fn level(text: &str) -> Result<u8, NoSkipLevels> {
    let level = text.trim().parse().ok();
    level
        .filter(|level| (1..=SkipLevels::HIGHEST).contains(level))
        .ok_or_else(|| {
            NoSkipLevels(format!(
                "`{text}` is not a level from 1 to {}; write `1,3-5`, `all` or `none`",
                SkipLevels::HIGHEST
            ))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_numbers_and_ranges() {
        // R2.90
        let levels = |text: &str| text.parse::<SkipLevels>();
        let on = |text| levels(text).map(|levels| levels.to_string());
        assert_eq!(on("1, 3-5").as_deref(), Ok("1,3,4,5"));
        assert_eq!(levels("ALL"), Ok(SkipLevels::ALL));
        assert_eq!(levels("1-10"), Ok(SkipLevels::ALL));
        assert_eq!(levels("None"), Ok(SkipLevels::NONE));
        assert!(SkipLevels::ALL.has(10) && !SkipLevels::NONE.has(1));
        for wrong in ["", "0", "11", "5-3", "1,,2", "-1", "x", "all,1"] {
            assert!(levels(wrong).is_err(), "{wrong}");
        }
    }
}
