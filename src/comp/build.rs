//! The version of the control's kernel, on which lists and commands depend.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// The version of the control's kernel, `V3.1.3132.0`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CncBuild([u32; 4]);

impl CncBuild {
    /// Creates a build from its four numbers.
    pub const fn new(numbers: [u32; 4]) -> Self {
        Self(numbers)
    }
}

/// A text that is not a CNC build.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{0}` is not a CNC build; write it like `3.1.3132.0`")]
pub struct NoBuild(String);

impl CncBuild {
    /// Whether this build reads real numbers in the friction table: V3.1.3132.0 and later on the
    /// V3 line, V4.29.0 and later on the V4 line (chapter 3.3).
    pub fn reads_real_points(self) -> bool {
        let first = match self.0[0] {
            0..=3 => Self([3, 1, 3132, 0]),
            4 => Self([4, 29, 0, 0]),
            _ => return true,
        };
        self >= first
    }
}

impl FromStr for CncBuild {
    type Err = NoBuild;

    fn from_str(text: &str) -> Result<Self, NoBuild> {
        let no_build = || NoBuild(text.to_owned());
        let mut numbers = [0; 4];
        let mut parts = text.trim_start_matches(['V', 'v']).split('.');
        for (place, number) in numbers.iter_mut().enumerate() {
            match parts.next() {
                Some(part) => *number = part.parse().map_err(|_| no_build())?,
                None if place >= 2 => {}
                None => return Err(no_build()),
            }
        }
        match parts.next() {
            None => Ok(Self(numbers)),
            Some(_) => Err(no_build()),
        }
    }
}

impl fmt::Display for CncBuild {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [line, release, build, patch] = self.0;
        write!(f, "V{line}.{release}.{build}.{patch:02}")
    }
}
