//! Commissioning: the measuring programs, and the recognition of their recordings (chapter 16 of the
//! rules).
//!
//! [`Plan`] holds programs as steps within the travel of the axes. Lengths are in mm or degrees, feeds in mm
//! or degrees a minute. Each program begins with a [`signature`](signature_in) that its recording carries.

mod actual;
mod at_feed;
mod compared;
mod error;
mod following;
mod found;
mod judged;
mod learned;
mod plan;
mod plan_file;
mod plant_found;
mod program;
mod request;
mod results;
mod room;
mod runs;
mod signature;
mod strokes;
mod switched;

pub use actual::{FollowedPosition, recorded_apart, recorded_otherwise};
pub use compared::{BeforeAfter, PlaceCompared, before_after};
pub use error::PlanError;
pub use following::{NotFollowed, actual_elsewhere};
pub use found::{CirclesFound, DirectionGlitches, FrictionFound, IsoFigures, MOST_CURRENT};
pub use judged::{JudgedRound, feeds_against};
pub use learned::{LEAST_FEEDS, LearnError, LearnedCircles, RecordedTurn};
pub use plan::{Plan, Stage};
pub use plan_file::{PlanFile, ValueListUsed};
pub use plant_found::{
    ComparedGlitch, MissedPrediction, PlantAxis, PlantFound, PredictedGlitch, RecordedGlitch,
    TunedList, against_plant, held_out, with_friction,
};
pub use program::{Measurement, MeasuringProgram, PlanStep, Turning};
pub use request::{Dynamics, FreeTravel, Installed, MeasuredAxis, PlanRequest};
pub use results::{RecordingOutcome, RecordingResult, refuse_strangers};
pub use signature::{Signature, signature_in};
pub use strokes::{FeedReversals, RecordedStrokes, StrokesFound};
pub use switched::{
    CompensationShown, ShareOfList, Shows, StagesOfAxis, SwitchedAs, TorqueOfList, torque_of_list,
};
