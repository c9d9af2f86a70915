//! A million points on eight hundred columns: what cannot be told apart is not drawn.

/// A line of more points is thinned out however its points lie.
const MAX_POINTS: usize = 20_000;

/// Points of which neighbours in one column become at most four: the first, the least, the
/// greatest and the last, in their order. Nothing that can be seen is lost.
///
/// `column` gives the column of the picture in which a point falls.
pub(super) fn reduce(points: &[[f64; 2]], column: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    for run in points.chunk_by(|&one, &other| column(one).floor() == column(other).floor()) {
        keep(run, &mut kept);
    }
    if kept.len() <= MAX_POINTS {
        return kept;
    }
    // A line that runs to and fro between columns.
    let mut thinned = Vec::with_capacity(MAX_POINTS);
    for run in kept.chunks(kept.len().div_ceil(MAX_POINTS / 4)) {
        keep(run, &mut thinned);
    }
    thinned
}

fn keep(run: &[[f64; 2]], kept: &mut Vec<[f64; 2]>) {
    if run.len() <= 4 {
        kept.extend_from_slice(run);
        return;
    }
    let mut least = 0;
    let mut greatest = 0;
    for (at, point) in run.iter().enumerate() {
        if point[1] < run[least][1] {
            least = at;
        }
        if point[1] > run[greatest][1] {
            greatest = at;
        }
    }
    let mut places = [0, least.min(greatest), least.max(greatest), run.len() - 1].to_vec();
    places.dedup();
    kept.extend(places.into_iter().map(|at| run[at]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_survive() {
        let mut points: Vec<[f64; 2]> = (0..1_000_000).map(|at| [f64::from(at), 0.0]).collect();
        points[123_456][1] = 7.0;
        points[654_321][1] = -3.0;
        let kept = reduce(&points, |point| point[0] / 1250.0);
        assert!(kept.len() <= 4 * 800, "{}", kept.len());
        assert!(kept.contains(&[123_456.0, 7.0]) && kept.contains(&[654_321.0, -3.0]));
        assert_eq!(kept.first(), points.first());
        assert_eq!(kept.last(), points.last());
        assert!(kept.is_sorted_by(|one, other| one[0] <= other[0]));
    }

    #[test]
    fn few_points_stay_as_they_are() {
        let points = [[0.0, 1.0], [0.0, 2.0], [0.5, 3.0]];
        assert_eq!(reduce(&points, |point| point[0]), points);
    }

    #[test]
    fn a_line_to_and_fro_is_bounded() {
        let points: Vec<[f64; 2]> = (0..200_000)
            .map(|at| [f64::from(at % 2) * 9.0, 1.0])
            .collect();
        assert!(reduce(&points, |point| point[0]).len() <= MAX_POINTS);
    }
}
