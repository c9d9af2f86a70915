//! The best possible accuracy of the offset of a recording: the Cramér–Rao bound for the samples that R6.10
//! leaves.

use frictcomp_testing::recorded_drive::Bench;

/// The 95th percentile of the errors of a normal distribution, in standard deviations.
const OF_95_PERCENT: f64 = 1.96;

/// The period of the ripple in mm.
const PERIOD: f64 = 10.0;

/// A sample as a row of the regression: the parameters that it depends on, with their weights.
type Row = Vec<(usize, f64)>;

/// Returns the Cramér–Rao bound of the offset in N: no unbiased estimate has a smaller 95th percentile, even if it
/// knows the period of the ripple and the colour of the noise.
pub(crate) fn offset_bound(bench: &Bench) -> f64 {
    let (speeds, commanded) = (bench.speeds.len(), bench.commanded());
    let (offset, parameters) = (speeds, speeds + 3);
    let kept = match bench.colour_s {
        0.0 => 0.0,
        colour => (-0.001 / colour).exp(),
    };
    let new = (1.0 - kept * kept).sqrt();
    let mut information = vec![vec![0.0; parameters]; parameters];
    let mut position = 0.0;
    for run in commanded.chunk_by(|one, other| one == other) {
        let speed = run[0];
        let length = run.len() as f64;
        let known = bench.speeds.iter().position(|it| *it == speed.abs());
        let used = (0.15 * length).max(150.0) as usize..(0.9 * length) as usize;
        let mut before: Option<Row> = None;
        for sample in 0..run.len() {
            position += speed * 0.001;
            let Some(index) = known.filter(|_| run.len() > 300 && used.contains(&sample)) else {
                continue;
            };
            let (sine, cosine) = (std::f64::consts::TAU * position / PERIOD).sin_cos();
            let row = vec![
                (index, speed.signum()),
                (offset, 1.0),
                (offset + 1, sine),
                (offset + 2, cosine),
            ];
            // What a sample adds to the one before it.
            let fresh: Row = match &before {
                None => row.clone(),
                Some(before) => row
                    .iter()
                    .zip(before)
                    .map(|(one, other)| (one.0, (one.1 - kept * other.1) / new))
                    .collect(),
            };
            for (one, factor) in &fresh {
                for (other, by) in &fresh {
                    information[*one][*other] += factor * by / bench.noise_n.powi(2);
                }
            }
            before = Some(row);
        }
    }
    OF_95_PERCENT * inverse_at(information, offset).sqrt()
}

/// Returns an element of the diagonal of the inverse of a positive definite matrix.
fn inverse_at(mut rows: Vec<Vec<f64>>, wanted: usize) -> f64 {
    // The wanted one last, so that elimination leaves its inverse alone in the corner.
    let last = rows.len() - 1;
    rows.swap(wanted, last);
    for row in &mut rows {
        row.swap(wanted, last);
    }
    for pivot in 0..last {
        let from = rows[pivot].clone();
        for row in &mut rows[pivot + 1..] {
            let factor = row[pivot] / from[pivot];
            for (value, above) in row.iter_mut().zip(&from) {
                *value -= factor * above;
            }
        }
    }
    1.0 / rows[last][last]
}
