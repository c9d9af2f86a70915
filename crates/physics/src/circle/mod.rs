//! The circular test: two simulated feed drives on a circle, with friction compensation off and
//! on, and the figures of ISO 230-4 (chapter 5.3 of the rules).
//!
//! A [`CircularTest`] sends the drives of a [`Plant`](crate::simulation::Plant) round a [`Circle`]
//! in both directions; their [`RadialProfile`]s give the [`Figures`]. A [`RecordedCircle`] gives
//! those of a real machine, and [`tune`] searches the parameters of a value list. The shape of a path
//! at its [`Crossing`]s and its permanent part is its [`PathShape`], from which
//! [`diagnose`] names friction, backlash and axes that do not match.

mod centre;
mod cma_es;
mod compare;
mod crossing;
mod diagnosis;
mod direction;
mod drift;
mod evidence;
mod evidence_shape;
mod figures;
mod fitted;
mod glitch;
mod lap;
mod learn;
mod method;
mod oscillation;
mod periodic;
mod pitch;
mod profile;
mod quality;
mod quiet;
mod recorded;
mod reference;
mod series;
mod shapes;
mod simulate;
mod swings;
mod tail_search;
mod tails;
mod test;
mod tune;
mod turning;
mod waveform;
mod window;
mod zone;

pub use centre::{PathCentre, UnknownPathCentre};
pub use compare::{Comparison, Side};
pub use crossing::{Crossing, PlaneAxis};
pub use diagnosis::{
    Diagnosis, DiagnosisGrounds, Finding, FoundAt, NOTICEABLE_UM, diagnose, diagnose_comparison,
};
pub use direction::Direction;
pub use evidence::CircleEvidence;
pub use evidence_shape::{OtherShape, ShapeTerm, Term};
pub use figures::{Figures, PathFigures, Paths};
pub use fitted::{
    DriveFit, Extent, FittedDrive, ObservedCircle, SharesOn, predicted_height_um,
    recorded_height_um,
};
pub use glitch::{AxisShape, Bulge, Glitch, PathShape};
pub use lap::{Lap, LapRun};
pub use learn::{
    LearnedCircle, LearnedRound, Learner, LearningProgress, Proposal, RecordedTwice, RoundVerdict,
    TooMuchCurrent,
};
pub use method::Method;
pub use profile::{ANGLES, RadialProfile, UM_PER_M};
pub use recorded::{
    CommandedCircle, GlitchOrder, LeftOut, MIN_POINTS, MeasuredGlitch, RecordedCircle,
    RecordedError, RecordedTrace, Recording, WholeTurns, WorseTurn,
};
pub use reference::{Circle, CircleError, MAX_STEPS, MIN_CYCLES, TURNS};
pub use test::CircularTest;
pub use tune::{
    Candidate, FeedResult, FreeParameter, Ranges, RemainingGlitch, Robust, Shaping, Simulations,
    Task, Tuned, TunedAxis, TuningAim, tune, tune_with,
};
pub use waveform::Waveform;
