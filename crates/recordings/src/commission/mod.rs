//! Commissioning: the measuring programs, and the recognition of their recordings (chapter 16 of the
//! rules).
//!
//! [`Plan`] holds programs as steps within the travel of the axes. Lengths are in mm or degrees, feeds in mm
//! or degrees a minute. Each program begins with a [`signature`](signature_in) that its recording carries.

mod actual;
mod compared;
mod error;
mod evaluated;
mod following;
mod found;
mod judged;
mod learned;
mod learning;
mod plan;
mod plan_file;
mod plant_found;
mod plants;
mod program;
mod request;
mod results;
mod round;
mod runs;
mod signature;
mod strokes;
mod switched;

pub use actual::{FollowedPosition, recorded_apart};
pub use compared::{BeforeAfter, PlaceCompared};
pub use error::PlanError;
pub use evaluated::{AxisVerdict, InputFile, Results, ResultsReport, source_of};
pub use following::{NotFollowed, actual_elsewhere};
pub use found::{CirclesFound, DirectionGlitches, FrictionFound, IsoFigures, MOST_CURRENT};
pub use learned::{LEAST_FEEDS, LearnError, LearnedCircles, RecordedTurn};
pub use learning::{
    LearnReport, LearnedAxis, LearningFile, LearningRound, MeasuredFriction, NextStep, Prediction,
    RecordedFile,
};
pub use plan::{Plan, Stage};
pub use plan_file::{PlanFile, PlanReport, ValueListUsed};
pub use plant_found::{
    ComparedGlitch, MissedPrediction, PlantAxis, PlantFound, PredictedGlitch, RecordedGlitch,
    TunedList, against_plant, held_out, with_friction,
};
pub use plants::{PlantVerdict, Plants};
pub use program::{Measurement, MeasuringProgram, PlanStep, Turning};
pub use request::{Dynamics, FreeTravel, Installed, MeasuredAxis, PlanRequest};
pub use results::{RecordingOutcome, RecordingResult, refuse_strangers};
pub use round::{RecordedRound, Round};
pub use signature::{Signature, signature_in};
pub use strokes::{FeedReversals, RecordedStrokes, StrokesFound};
pub use switched::{CompensationShown, ShareOfList, Shows, TorqueOfList, torque_of_list};
