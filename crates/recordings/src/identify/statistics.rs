//! Means, medians and spreads of samples.

use std::collections::VecDeque;

/// Factor from the median of deviations to a standard deviation.
const NORMAL: f64 = 1.4826;

/// Returns the middle value; the mean of the two middle ones of an even number.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    if sorted.is_empty() {
        return None;
    }
    let (below, upper, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    let upper = *upper;
    if values.len() % 2 == 1 {
        return Some(upper);
    }
    let lower = below.iter().copied().max_by(f64::total_cmp)?;
    Some(f64::midpoint(lower, upper))
}

/// Returns the standard deviation of the noise on a signal, from its second differences: a signal that rises evenly has
/// none.
pub(crate) fn noise_of(values: &[f64]) -> f64 {
    let second = values
        .windows(3)
        .map(|it| (it[0] - 2.0 * it[1] + it[2]).abs());
    let second: Vec<f64> = second.collect();
    // The variances of three samples with the weights 1, -2, 1 add up to 6.
    median(&second).unwrap_or(0.0) * NORMAL / 6.0_f64.sqrt()
}

/// Returns the mean of the values between the 5th and the 95th percentile.
pub(super) fn trimmed_mean(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let cut = sorted.len() / 20;
    let kept = &sorted[cut..sorted.len() - cut];
    kept.iter().sum::<f64>() / count(kept.len())
}

/// Returns the standard error of a mean, from the means of blocks: neighbours may be alike.
pub(super) fn standard_error(values: &[f64], block: usize) -> f64 {
    let block = block.min(values.len() / 4).max(1);
    let means: Vec<f64> = values
        .chunks_exact(block)
        .map(|it| it.iter().sum::<f64>() / count(block))
        .collect();
    if means.len() < 2 {
        return 0.0;
    }
    let mean = means.iter().sum::<f64>() / count(means.len());
    let squares: f64 = means.iter().map(|it| (it - mean) * (it - mean)).sum();
    (squares / count(means.len() - 1) / count(means.len())).sqrt()
}

/// Returns the smallest step between two values: the resolution of the drive.
pub(super) fn resolution(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let least = steps
        .filter(|&step| step > 0.0)
        .fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Returns the number of samples in a time, at least one.
pub(crate) fn samples_in(seconds: f64, step_s: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1 to some thousands
    let samples = (seconds / step_s).round().max(1.0) as usize;
    samples
}

#[allow(clippy::cast_precision_loss)] // samples of a recording
pub(crate) fn count(samples: usize) -> f64 {
    samples as f64
}

/// Returns the mean of the samples around each one.
pub(crate) fn moving_average(values: &[f64], width: usize) -> Vec<f64> {
    // Running sums, as far back as a mean still needs them.
    let mut sums = VecDeque::from([0.0]);
    let (mut sum, mut first) = (0.0, 0);
    (0..values.len())
        .map(|at| {
            let from = at.saturating_sub(width / 2);
            let to = (from + width).min(values.len());
            for value in &values[first + sums.len() - 1..to] {
                sum += value;
                sums.push_back(sum);
            }
            sums.drain(..from - first);
            first = from;
            (sums[to - first] - sums[0]) / count(to - from)
        })
        .collect()
}
