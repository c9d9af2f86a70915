//! The circular test: two simulated feed drives on a circle, with friction compensation off and
//! on, and the figures of ISO 230-4 (chapter 5.3 of the rules).
//!
//! A [`CircularTest`] sends the drives of a [`Plant`](crate::simulation::Plant) round a [`Circle`]
//! in both directions; their [`RadialProfile`]s give the [`Figures`]. A [`RecordedCircle`] gives
//! those of a real machine, and [`tune`] searches the parameters of a value list. The shape of a path
//! at its [`Crossing`]s and its permanent part is its [`PathShape`], from which
//! [`diagnose`] names friction, backlash and axes that do not match.

mod diagnosis;
mod evidence;
mod figures;
mod fitted;
mod geometry;
mod learn;
mod recorded;
mod simulated;
mod tune;

pub use diagnosis::{
    Diagnosis, DiagnosisGrounds, Finding, FoundAt, NOTICEABLE_UM, diagnose, diagnose_comparison,
};
pub use evidence::{CircleEvidence, OtherShape, ShapeTerm, Term};
pub use figures::{AxisShape, Bulge, Figures, Glitch, PathFigures, PathShape, Paths, Waveform};
pub use fitted::{
    DriveFit, Extent, FittedDrive, ObservedCircle, SharesOn, predicted_height_um,
    recorded_height_um,
};
pub use geometry::{
    ANGLES, Circle, CircleError, Crossing, Direction, MAX_STEPS, MIN_CYCLES, PathCentre, PlaneAxis,
    RadialProfile, TURNS, UM_PER_M, UnknownPathCentre,
};
pub use learn::{
    LearnedCircle, LearnedRound, Learner, LearningProgress, Proposal, RecordedTwice, RoundVerdict,
    TooMuchCurrent,
};
pub use recorded::{
    CommandedCircle, GlitchOrder, LeftOut, MIN_POINTS, MeasuredGlitch, RecordedCircle,
    RecordedError, RecordedTrace, Recording, WholeTurns, WorseTurn,
};
pub use simulated::{CircularTest, Comparison, Lap, LapRun, Method, Side};
pub use tune::{
    Candidate, FeedResult, FreeParameter, Ranges, RemainingGlitch, Robust, Shaping, Simulations,
    Task, Tuned, TunedAxis, TuningAim, tune, tune_with,
};
