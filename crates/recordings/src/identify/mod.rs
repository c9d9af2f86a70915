//! Computation of a value list from recorded torque (chapter 6 of the rules).
//!
//! [`identify`] finds constant speeds in a [`Track`], takes friction and offset from the torques in both
//! directions, draws a curve through them and chooses the points of a value list.
//! Speeds are in mm/s or °/s, torque and friction in drive units.

mod around;
mod branches;
mod channel;
mod circles;
mod clipped;
mod curve;
mod doubts;
mod finding;
mod identified;
mod measured;
mod pair;
mod recorded;
mod request;
mod ripple;
mod segment;
mod share;
mod speeds;
mod states;
mod statistics;
mod support;
mod tight;
mod timing;
mod track;
mod trend;
mod unit_doubts;
mod verify;
mod warnings;

pub use branches::{BranchPoint, DirectionBranches};
pub use circles::{OnCircles, identify_circles};
pub(crate) use curve::along;
pub use curve::{Fit, FrictionCurve};
pub use finding::TraceFinding;
pub use identified::{Identified, IdentifyError, IdentifyOptions};
pub use measured::{Contradiction, Measured, TorqueKind};
pub use pair::{Drift, Pair, Visit};
pub use recorded::{
    AxisChannels, AxisRecording, StatedAxis, state_channel, stated_axis, unit_finding,
};
pub use request::{ListRequest, ListRequestError};
pub use ripple::Ripple;
pub use segment::Segment;
pub use speeds::identify;
pub use states::{ComparedStates, StateRow};
pub(crate) use statistics::{count, median, moving_average, noise_of, samples_in};
pub use support::RequestedPoints;
pub use timing::{ActingShare, Timing};
pub use track::{Track, TrackError, check_motion};
pub use trend::{
    DatedFriction, FrictionChange, FrictionLevels, FrictionParameter, Level, TrendReport,
    friction_changes,
};
pub use verify::{
    CONTACT_MM, Predictor, Reversal, ScaleRange, Verified, verify, verify_followed,
    verify_recording,
};
