//! The true glitches of a run, from its places without noise.

use std::f64::consts::TAU;

use super::machine::Run;

/// The largest glitches in µm, each a mean over 8 ms: of X and of Y, counter-clockwise and clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrueGlitches {
    /// Glitches of X and Y, each counter-clockwise and clockwise.
    pub um: [[f64; 2]; 2],
}

impl TrueGlitches {
    /// Returns the larger of each with those of another run.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        Self {
            um: [0, 1].map(|axis: usize| {
                [0, 1].map(|way: usize| self.um[axis][way].max(other.um[axis][way]))
            }),
        }
    }

    /// Returns the largest of an axis.
    pub fn of_axis(&self, axis: usize) -> f64 {
        self.um[axis][0].max(self.um[axis][1])
    }

    /// Returns the largest glitch of both axes.
    pub fn largest(&self) -> f64 {
        self.of_axis(0).max(self.of_axis(1))
    }
}

/// Returns the glitches of all crossings that are at least 40° from the ends of each arc: from the least to the largest
/// radial deviation from 8° before the crossing to 8° and 0.3 s after it, less the straight line through 12° before and
/// as much after that window.
pub fn true_glitches(run: &Run) -> TrueGlitches {
    const APART: f64 = 40.0 / 360.0 * TAU;
    let mut found = TrueGlitches::default();
    for ([from, to], middle) in &run.commanded.arcs {
        let polar = |places: &[Vec<f64>; 2], at: usize| {
            let [x, y] = [places[0][at] - middle[0], places[1][at] - middle[1]];
            (x.hypot(y), y.atan2(x))
        };
        let mut angles = Vec::new();
        let mut turned = 0.0_f64;
        let mut before = polar(&run.commanded.places, *from).1;
        let begin = before;
        for at in *from..=*to {
            let now = polar(&run.commanded.places, at).1;
            let step = now - before;
            turned += step - TAU * (step / TAU).round();
            before = now;
            angles.push(turned);
        }
        let whole = turned.abs();
        let way = usize::from(turned < 0.0);
        let radii: Vec<f64> = (*from..=*to).map(|at| polar(&run.load_mm, at).0).collect();
        let half = (0.004 / run.cycle_s).round() as usize;
        let smooth: Vec<f64> = (0..radii.len())
            .map(|at| {
                let part = &radii[at.saturating_sub(half)..(at + half + 1).min(radii.len())];
                part.iter().sum::<f64>() / part.len() as f64
            })
            .collect();
        let sign = turned.signum();
        let first = (begin / (TAU / 4.0)).round() as i32;
        for number in 0..64 {
            let crossing =
                f64::from(number) * TAU / 4.0 + sign * (f64::from(first) * TAU / 4.0 - begin);
            if crossing < APART || crossing > whole - APART {
                continue;
            }
            let axis = usize::try_from((first + number * sign as i32).rem_euclid(2)).unwrap_or(0);
            let place = |angle: f64| angles.partition_point(|it| it.abs() < angle);
            let at = place(crossing);
            let settled = place(crossing + 8.0 / 360.0 * TAU)
                .max(at + (0.3 / run.cycle_s) as usize)
                .min(radii.len() - 1);
            let inside = place(crossing - 8.0 / 360.0 * TAU)..settled;
            let wide = settled - at;
            let sides = [
                place(crossing - 20.0 / 360.0 * TAU)..inside.start,
                settled
                    ..(settled + wide.max(place(crossing + 20.0 / 360.0 * TAU) - at))
                        .min(smooth.len()),
            ];
            let mean = |part: &std::ops::Range<usize>| {
                let count = part.len().max(1) as f64;
                let sum: f64 = smooth[part.clone()].iter().sum();
                (
                    f64::midpoint(part.start as f64, part.end as f64),
                    sum / count,
                )
            };
            let [(t0, r0), (t1, r1)] = [mean(&sides[0]), mean(&sides[1])];
            let deviation = |at: usize| smooth[at] - r0 - (r1 - r0) * (at as f64 - t0) / (t1 - t0);
            let [low, high] = inside.fold([f64::MAX, f64::MIN], |[low, high], at| {
                [low.min(deviation(at)), high.max(deviation(at))]
            });
            let um = (high - low) * 1000.0;
            found.um[axis][way] = found.um[axis][way].max(um);
        }
    }
    found
}
