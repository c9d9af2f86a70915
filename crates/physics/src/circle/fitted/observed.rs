//! The reversals of an axis on a recorded circle.

use crate::circle::figures::Waveform;
use crate::circle::geometry::Circle;
use crate::circle::geometry::PlaneAxis;
use crate::circle::recorded::RecordedCircle;
use crate::current::Reading;
use crate::simulation::DriveParameters;
use frictcomp::lists::FrictionList;

/// An axis on a recorded circle, with compensation off or on.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ObservedCircle {
    /// The driven circle.
    pub circle: Circle,
    /// The list that was on.
    pub list: Option<FrictionList>,
    /// A list of which a part may have been on although it should not (R16.13).
    pub may_be_on: Option<FrictionList>,
    /// Whether less or more of the list may have been on (R16.13).
    pub is_doubted: bool,
    /// The recorded deviation at each reversal.
    pub(super) reversals: Vec<Waveform>,
}

/// An axis on recorded circles, and the drive that is assumed before they are evaluated.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct DriveFit {
    /// The axis.
    pub axis: PlaneAxis,
    /// Mass, position loop and measured friction; the rest is where the search starts.
    pub drive: DriveParameters,
    /// Reading of the documents.
    pub reading: Reading,
    /// The circles, with compensation off and on.
    pub circles: Vec<ObservedCircle>,
}

impl ObservedCircle {
    /// Returns the reversals of an axis on all turns of one circle; `None` if it has no glitches.
    pub fn of(
        axis: PlaneAxis,
        (circle, list): (Circle, Option<FrictionList>),
        turns: &[RecordedCircle],
    ) -> Option<Self> {
        let reversals = turns.iter().map(|it| it.reversals_of(axis));
        let reversals: Vec<Vec<[Waveform; 2]>> = reversals.collect::<Option<_>>()?;
        (!reversals.is_empty()).then(|| Self {
            circle,
            list,
            may_be_on: None,
            is_doubted: false,
            reversals: reversals.into_iter().flatten().flatten().collect(),
        })
    }
}
