//! Places on the part where compensation is missing (chapter 11 of the rules).
//!
//! The path of an executed program is driven by simulated axes three times: with friction
//! compensation as the program switches it, with all of it on, and with all of it off. A
//! [`ProgramContour`] takes the records of a session, measures the distance of the axes from the path,
//! and gives a [`ContourSink`] every reversal with the glitch that it leaves.
//!
//! Memory does not grow with the length of a program, except for what a sink keeps. Deviations are
//! in µm, positions in mm, times in s.

mod axes;
mod blocks;
mod feed;
mod figures;
mod fit;
mod glitch;
mod measured;
mod obstacle;
mod options;
mod path;
mod per_run;
mod program;
mod report;
mod reversals;
mod run;
mod verdict;

pub use axes::{MovingAxes, NoContour, parameterise};
pub use blocks::{BlockDeviation, BlockDeviations, BlockReversal, WorstPlace};
pub use feed::FeedReached;
pub use figures::{ContourSummary, Deviations, Due};
pub use fit::ListFit;
pub use obstacle::ContourObstacle;
pub use options::{ContourAxis, ContourOptions, ListSource, MOST_AXES};
pub use per_run::PerRun;
pub use program::{ContourPoint, ContourSink, ProgramContour};
pub use report::{ContourCompensation, ContourReport};
pub use reversals::{ContourReversal, GlitchFigure};
pub use verdict::{ContourLimits, ContourVerdict, ExceededLimit, LimitedFigure};
