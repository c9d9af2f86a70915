//! The times at which channels were sampled.

/// Properties of a column of times.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Clock {
    /// The usual time between two samples.
    pub step_s: Option<f64>,
    /// The first time.
    pub first_s: f64,
    /// The last time.
    pub last_s: f64,
    /// Places where samples are missing.
    pub gaps: u64,
    /// The longest time without a sample, if there are gaps.
    pub longest_gap_s: f64,
    /// Start of the longest gap.
    pub gap_at_s: f64,
    /// Rows whose time is not after the one before.
    pub backwards: u64,
}

/// A step longer than the usual one by this factor is a gap.
const GAP: f64 = 1.5;

impl Clock {
    /// Finds the properties of the times of a clock; `None` without any.
    pub fn of(times_s: &[f64]) -> Option<Self> {
        let (&first_s, &last_s) = (times_s.first()?, times_s.last()?);
        let pairs = || times_s.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
        let step_s = median(pairs().map(|(_, step)| step).filter(|&step| step > 0.0));
        let mut clock = Self {
            step_s,
            first_s,
            last_s,
            gaps: 0,
            longest_gap_s: 0.0,
            gap_at_s: first_s,
            backwards: 0,
        };
        for (at, step) in pairs() {
            if step <= 0.0 {
                clock.backwards += 1;
            } else if step_s.is_some_and(|usual| step > usual * GAP) {
                clock.gaps += 1;
                if step > clock.longest_gap_s {
                    clock.longest_gap_s = step;
                    clock.gap_at_s = at;
                }
            }
        }
        Some(clock)
    }
}

/// Returns the median of some numbers.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_jumps_are_counted() {
        // R6.3
        let clock = Clock::of(&[0.0, 0.001, 0.002, 0.007, 0.008, 0.0075, 0.0085]).unwrap();
        assert_eq!((clock.gaps, clock.backwards), (1, 1));
        assert!((clock.longest_gap_s - 0.005).abs() < 1e-12);
        assert!((clock.gap_at_s - 0.002).abs() < 1e-12);
        assert!((clock.step_s.unwrap() - 0.001).abs() < 1e-9);
        assert_eq!(Clock::of(&[]), None);
        assert_eq!(Clock::of(&[1.0]).unwrap().step_s, None);
    }
}
