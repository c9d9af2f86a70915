//! The glitch of an axis on a circle, for comparison with a prediction.

use crate::circle::crossing::PlaneAxis;
use crate::circle::recorded::RecordedCircle;
use crate::circle::reference::{Circle, CircleError};
use crate::circle::tune::reversal::AxisAlone;
use crate::circle::waveform::Waveform;
use crate::current::Reading;
use crate::simulation::{DriveParameters, FrictionModel};
use frictcomp::lists::FrictionList;

/// The recorded glitch of an axis in µm: that of the mean of its reversals, each a mean over 8 ms; `None` if
/// the turns have no glitches or no times.
pub fn recorded_height_um(axis: PlaneAxis, turns: &[RecordedCircle]) -> Option<f64> {
    let reversals = turns
        .iter()
        .map(|it| Waveform::reversals(axis, &it.profile, it.direction));
    let reversals: Vec<[Waveform; 2]> = reversals.collect::<Option<_>>()?;
    let all: Vec<&Waveform> = reversals.iter().flatten().collect();
    (!all.is_empty()).then(|| Waveform::mean(&all).height_um())
}

/// The predicted glitch of an axis in µm with a list or without one.
///
/// # Errors
/// A circle that cannot be simulated, or a drive that is unstable on it.
pub fn predicted_height_um(
    (axis, drive): (PlaneAxis, &DriveParameters),
    circle: Circle,
    list: Option<&FrictionList>,
    reading: Reading,
) -> Result<f64, CircleError> {
    let alone = AxisAlone {
        axis,
        drive,
        model: FrictionModel::default(),
        reading,
        phase: 0.0,
    };
    let list = list.cloned().map(Into::into);
    let deviations = alone.deviations(circle, list.as_ref())?;
    Ok(Waveform::sampled(&deviations).levelled().height_um())
}
