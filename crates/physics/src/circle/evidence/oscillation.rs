//! An oscillation in time (R5.28).

use std::f64::consts::TAU;

use super::series::{AngleSeries, real};

/// The slowest oscillation that counts as one, in Hz.
const SLOWEST_HZ: f64 = 5.0;

/// Steps in the shortest period.
const LEAST_STEPS: f64 = 2.5;

/// Time in s over which an oscillation keeps its phase, above the frequencies that keep it over the turn.
const IN_PHASE_S: f64 = 1.0;

/// Minimum length of a stretch of the path that shows a frequency, in s.
const SHORTEST_S: f64 = 0.1;

/// An oscillation in time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Oscillation {
    pub(crate) hertz: f64,
    /// Mean square that it explains.
    pub(crate) explains: f64,
    pub(crate) amplitude_um: f64,
}

/// A stretch of a path without a gap, and the seconds of its steps.
type GaplessPath<'a> = (&'a [Option<f64>], f64);

impl Oscillation {
    /// Returns the frequency that explains most of paths in coarse and in fine steps.
    pub(crate) fn search(coarse: &[AngleSeries], fine: &[AngleSeries]) -> Option<Self> {
        let durations = coarse.iter().filter_map(|it| it.turn_s);
        let turn_s = durations.reduce(f64::max)?;
        let whole: Option<Vec<GaplessPath<'_>>> = coarse
            .iter()
            .map(|one| Some((one.values.as_slice(), one.step_s()?)))
            .collect();
        let whole = whole?;
        let parts = stretches(fine);
        let highest = |series: &[AngleSeries]| {
            let steps = series.iter().filter_map(AngleSeries::step_s);
            1.0 / (LEAST_STEPS * steps.fold(f64::MIN_POSITIVE, f64::max))
        };
        let [turning, highest] = [highest(coarse), highest(fine)];
        let slow = Self::best(&whole, [SLOWEST_HZ, turning], 0.5 / turn_s);
        let fast = Self::best(&parts, [turning.max(SLOWEST_HZ), highest], 0.5 / IN_PHASE_S);
        Some(if fast.explains > slow.explains {
            fast
        } else {
            slow
        })
    }

    fn best(stretches: &[GaplessPath<'_>], [from, to]: [f64; 2], step: f64) -> Self {
        let mut best = Self::default();
        let mut hertz = from;
        while hertz < to {
            let found = Self::of(stretches, hertz);
            if found.explains > best.explains {
                best = found;
            }
            hertz += step;
        }
        best
    }

    fn of(stretches: &[GaplessPath<'_>], hertz: f64) -> Self {
        let (mut explains, mut all, mut amplitude_um) = (0.0, 0.0, 0.0_f64);
        for (values, step_s) in stretches {
            let (sin, cos) = (TAU * hertz * step_s).sin_cos();
            // The phase advances from step to step.
            let [mut c, mut s] = [1.0_f64, 0.0_f64];
            let [mut real_part, mut imaginary, mut count] = [0.0; 3];
            for value in *values {
                if let Some(value) = value {
                    real_part += value * c;
                    imaginary += value * s;
                    count += 1.0;
                }
                [c, s] = [c * cos - s * sin, s * cos + c * sin];
            }
            let power = real_part * real_part + imaginary * imaginary;
            explains += 2.0 * power / f64::max(count, 1.0);
            all += count;
            amplitude_um = amplitude_um.max(2.0 * power.sqrt() / f64::max(count, 1.0));
        }
        Self {
            hertz,
            explains: explains / f64::max(all, 1.0),
            amplitude_um,
        }
    }
}

/// Returns the paths between their reversals, in stretches in which an oscillation keeps its phase.
fn stretches(series: &[AngleSeries]) -> Vec<GaplessPath<'_>> {
    let mut stretches = Vec::new();
    for one in series {
        let Some(step_s) = one.step_s() else {
            continue;
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most 36000
        let longest = (IN_PHASE_S / step_s).max(1.0) as usize;
        let between = one.values.split(Option::is_none);
        let parts = between.flat_map(|it| it.chunks(longest));
        let tells = |part: &&[Option<f64>]| real(part.len()) * step_s >= SHORTEST_S;
        stretches.extend(parts.filter(tells).map(|part| (part, step_s)));
    }
    stretches
}
