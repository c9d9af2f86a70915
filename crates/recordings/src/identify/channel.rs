//! Torques that were not recorded with the motion: their channel stood still, or was late (R6.21).

use super::doubts::refused;
use super::finding::TraceFinding;
use super::identified::IdentifyError;
use super::segment::Segment;
use super::statistics::{count, moving_average, samples_in, trimmed_mean};
use super::track::AxisSamples;
use frictcomp::diagnostic::{Code, Rounded};

/// Part of the segments above which nothing is identified.
const MOST_HELD: f64 = 0.5;

/// Least number of reversals that show a delay.
const FEWEST: usize = 3;

/// Delay in s below which it is that of drives and filters.
const USUAL_S: f64 = 0.1;

/// Means of the torque that noise does not reverse, in s.
const SMOOTHED_S: f64 = 0.02;

/// Speed below which there is no direction, in mm/s or °/s.
const STANDSTILL: f64 = 0.05;

/// Drops segments in which the torque keeps its last digit over a reversal, which no friction does, and reports them.
pub(super) fn drop_held(
    samples: &AxisSamples,
    segments: &mut Vec<Segment>,
) -> Result<Option<TraceFinding>, IdentifyError> {
    let all = segments.len();
    let mut still = vec![false; all];
    let (mut from, mut value) = (None, 0.0);
    let mut end = 0;
    for run in samples.torques.chunk_by(f64::eq) {
        let start = end;
        end += run.len();
        let first = segments.partition_point(|it| it.samples.end <= start);
        let last = segments.partition_point(|it| it.samples.start < end);
        let goes = |sign: f64| (first..last).any(|at| segments[at].velocity * sign > 0.0);
        if first + 1 < last && goes(1.0) && goes(-1.0) {
            from.get_or_insert(samples.times_s[start]);
            value = run[0];
            still[first..last].fill(true);
        }
    }
    let lost = still.iter().filter(|it| **it).count();
    let Some(from) = from.filter(|_| lost < all) else {
        // A torque that never changes has no friction at all.
        return Ok(None);
    };
    let message = format!(
        "from {} s the torque stays at {} while the axis reverses, in {lost} of {all} segments: its channel was not \
         recorded there",
        Rounded(from, 1),
        Rounded(value, 3)
    );
    let help = "record again, and look whether the channel of the torque goes on";
    if count(lost) > MOST_HELD * count(all) {
        return Err(refused(Code::Fc525, message, help));
    }
    let mut still = still.into_iter();
    segments.retain(|_| !still.next().unwrap_or_default());
    let message = format!("{message}; these segments are left out");
    Ok(Some(TraceFinding::new(Code::Fc525, message, help)))
}

/// Returns FC522 for a torque that reverses later than drives and filters cause: at three quarters of the reversals
/// between segments or more.
pub(super) fn late(samples: &AxisSamples, segments: &[Segment]) -> Option<TraceFinding> {
    let torques = moving_average(&samples.torques, samples_in(SMOOTHED_S, samples.step_s));
    let mean = |segment: &Segment| trimmed_mean(&samples.torques[segment.samples.clone()]);
    let delay = |pair: &[Segment]| {
        let [one, next] = pair else { return None };
        let way = next.velocity.signum();
        if one.velocity * way > 0.0 {
            return None;
        }
        let stands = |&at: &usize| samples.velocities[at] * way <= STANDSTILL;
        let begin = (one.samples.end..next.samples.start).rev().find(stands)?;
        let change = mean(next) - mean(one);
        let middle = mean(one) + change / 2.0;
        let has_turned = |&at: &usize| (torques[at] - middle) * change > 0.0;
        let turned = (one.samples.end..next.samples.end).find(has_turned)?;
        Some(samples.times_s[turned] - samples.times_s[begin])
    };
    let mut delays: Vec<f64> = segments.windows(2).filter_map(delay).collect();
    let quarter = delays.len() / 4;
    if delays.len() < FEWEST {
        return None;
    }
    let (_, delay, _) = delays.select_nth_unstable_by(quarter, f64::total_cmp);
    (*delay > USUAL_S).then(|| {
        TraceFinding::new(
            Code::Fc522,
            format!(
                "the torque reverses {delay:.2} s or more after the axis: it does not belong to this motion"
            ),
            "record both channels with the same times, and the torque without a filter",
        )
    })
}
