//! The glitch of an axis on a circle, for comparison with a prediction.

use crate::circle::figures::Waveform;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleError};
use crate::circle::recorded::RecordedCircle;
use crate::circle::tune::reversal::AxisAlone;
use crate::current::Reading;
use crate::simulation::{DriveParameters, FrictionModel};
use frictcomp::lists::FrictionList;

/// Returns the recorded glitch of an axis in µm and its standard error: that of the mean of its reversals in all turns,
/// each a mean over 8 ms, without its noise; `None` if the turns have no glitches or no times.
pub fn recorded_height_um(axis: PlaneAxis, turns: &[RecordedCircle]) -> Option<(f64, f64)> {
    let mut reversals: Vec<Waveform> = Vec::new();
    for turn in turns {
        reversals.extend(turn.reversals_of(axis)?.into_iter().flatten());
    }
    let all: Vec<&Waveform> = reversals.iter().collect();
    let noise_um = turns.iter().map(RecordedCircle::mean_noise_um);
    let noise_um = noise_um.reduce(f64::max)?;
    #[allow(clippy::cast_precision_loss)] // a few turns
    let count = reversals.len() as f64;
    let (height_um, error_um) = Waveform::mean(&all).without_noise(noise_um / count.sqrt())?;
    let each = reversals.iter().filter_map(|it| it.without_noise(noise_um));
    let squares: f64 = each.map(|it| (it.0 - height_um).powi(2)).sum();
    let scatter = (squares / (count - 1.0).max(1.0) / count).sqrt();
    Some((height_um, error_um.max(scatter)))
}

/// Returns the predicted glitch of an axis in µm with a list or without one.
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
