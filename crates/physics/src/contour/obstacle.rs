//! The obstacles to a verdict on a contour.

use std::fmt;

use frictcomp::diagnostic::{Code, Diagnostic};

/// Obstacle to a verdict on, or a comparison of, the whole contour.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ContourObstacle {
    /// No motion at all.
    NotDriven,
    /// No feed move.
    NothingCut,
    /// The number of feed moves that were left out, and the places of the first ones: `part.nc:8`.
    LeftOut(u64, Vec<String>),
    /// A stretch that only the machine decides and that is not driven, with its place and its cause (R14.8).
    Undecided(String, String),
    /// Axis that is cut while its state is not known: its name, the first place, and the seconds.
    UnknownState(String, String, f64),
    /// End of the contour before that of the program, with the code of the message.
    Ended(Code),
    /// Seconds in which positions are not those of the machine.
    NotOfTheMachine(f64),
    /// Share of the cutting time that runs below 80 % of F because of assumed limits (R11.23).
    AssumedLimits(f64),
}

impl fmt::Display for ContourObstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotDriven => f.write_str("no motion could be driven"),
            Self::NothingCut => {
                f.write_str("no feed move is driven, so there is no contour to judge")
            }
            Self::LeftOut(count, at) => {
                let motions = match count {
                    1 => "1 motion is".to_owned(),
                    count => format!("{count} motions are"),
                };
                write!(
                    f,
                    "{motions} left out, whose start, end or feed is not known"
                )?;
                if at.is_empty() {
                    return Ok(());
                }
                let more = if at.len() as u64 == *count {
                    ""
                } else {
                    " …"
                };
                write!(f, ": {}{more}", at.join(", "))
            }
            Self::Undecided(at, cause) => {
                write!(f, "{cause}: what follows from it at {at} is not driven")
            }
            Self::UnknownState(axis, at, seconds) => write!(
                f,
                "the state of {axis} is not known for {seconds:.3} s of cutting, from {at} on"
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

impl ContourObstacle {
    /// Returns it in words that stay the same where lines move or a motion takes longer.
    pub fn without_places(&self) -> String {
        match self {
            Self::LeftOut(count, _) => Self::LeftOut(*count, Vec::new()).to_string(),
            Self::Undecided(_, cause) => format!("{cause}: what follows from it is not driven"),
            Self::UnknownState(axis, ..) => {
                format!("the state of {axis} is not known while it is cut")
            }
            Self::NotOfTheMachine(_) => {
                "some positions are those of the program, not of the machine".to_owned()
            }
            Self::NotDriven | Self::NothingCut | Self::Ended(_) | Self::AssumedLimits(_) => {
                self.to_string()
            }
        }
    }

    /// Returns the obstacle of a message on a stretch that only the machine decides.
    pub(super) fn undecided(said: &Diagnostic) -> Self {
        let cause = said.message.split(';').next().unwrap_or_default();
        Self::Undecided(place_of(said), cause.to_owned())
    }
}

fn place_of(said: &Diagnostic) -> String {
    format!("{}:{}", said.place.file, said.place.start().line)
}
