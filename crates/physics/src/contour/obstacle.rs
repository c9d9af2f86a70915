//! The obstacles to a verdict on a contour.

use std::fmt;

use frictcomp::diagnostic::Code;

/// Obstacle to a verdict on, or a comparison of, the whole contour.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ContourObstacle {
    /// Nothing was driven.
    NotDriven,
    /// No feed move was driven.
    NothingCut,
    /// The number of feed moves that were left out.
    LeftOut(u64),
    /// It ends before the program does.
    Ended(Code),
    /// Seconds in which positions are not those of the machine.
    NotOfTheMachine(f64),
    /// This share of the cutting time runs below 80 % of F because of assumed limits (R11.23).
    AssumedLimits(f64),
}

impl fmt::Display for ContourObstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotDriven => f.write_str("no motion could be driven"),
            Self::NothingCut => {
                f.write_str("no feed move is driven, so there is no contour to judge")
            }
            Self::LeftOut(1) => {
                f.write_str("1 motion is left out, whose start, end or feed is not known")
            }
            Self::LeftOut(count) => write!(
                f,
                "{count} motions are left out, whose start, end or feed is not known"
            ),
            Self::Ended(code) => write!(f, "it ends before the program does, with {code}"),
            Self::NotOfTheMachine(seconds) => write!(
                f,
                "for {seconds:.3} s positions are those of the program, not of the machine"
            ),
            Self::AssumedLimits(share) => write!(
                f,
                "{:.0} % of the cutting time runs below 80 % of F because of assumed limits",
                share * 100.0
            ),
        }
    }
}
