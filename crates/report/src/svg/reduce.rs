//! A million points on eight hundred columns: what cannot be told apart is not drawn.

/// A curve in the making, whose points come in the direction of x: many neighbours are kept as the
/// first, the least, the greatest and the last of them, in bounded memory.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    groups: Vec<Neighbours>,
    /// Number of times that groups have been joined in pairs: each holds 2 to that power of points.
    joined: u32,
    /// Number of points in the last group.
    filled: u64,
}

/// Number of groups before they are joined in pairs.
const MAX_GROUPS: usize = 8192;

/// Neighbours of a curve.
#[derive(Debug, Clone, Copy)]
struct Neighbours {
    first: [f64; 2],
    least: [f64; 2],
    greatest: [f64; 2],
    last: [f64; 2],
    /// Continuation of the curve after them.
    end: CurveEnd,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CurveEnd {
    Open,
    Interrupted,
}

impl Neighbours {
    fn of(point: [f64; 2]) -> Self {
        Self {
            first: point,
            least: point,
            greatest: point,
            last: point,
            end: CurveEnd::Open,
        }
    }

    fn join(&mut self, next: &Self) {
        if next.least[1] < self.least[1] {
            self.least = next.least;
        }
        if next.greatest[1] > self.greatest[1] {
            self.greatest = next.greatest;
        }
        self.last = next.last;
        self.end = next.end;
    }
}

impl Curve {
    /// Takes the next point.
    pub fn push(&mut self, point: [f64; 2]) {
        let group = Neighbours::of(point);
        match self.groups.last_mut() {
            Some(last) if last.end == CurveEnd::Open && self.filled < 1 << self.joined => {
                last.join(&group);
                self.filled += 1;
            }
            _ => {
                self.groups.push(group);
                self.filled = 1;
            }
        }
        if self.groups.len() > MAX_GROUPS {
            self.join_by_two();
        }
    }

    /// Interrupts the curve after the last point.
    pub fn interrupt(&mut self) {
        if let Some(last) = self.groups.last_mut() {
            last.end = CurveEnd::Interrupted;
        }
    }

    /// Returns the points that are kept, in their order.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::with_capacity(self.groups.len() * 2);
        for group in &self.groups {
            let mut kept = [group.first, group.least, group.greatest, group.last].to_vec();
            kept.sort_by(|one, other| one[0].total_cmp(&other[0]));
            kept.dedup();
            points.extend(kept);
            if group.end == CurveEnd::Interrupted {
                points.push([f64::NAN, f64::NAN]);
            }
        }
        points
    }

    fn join_by_two(&mut self) {
        let pairs = self.groups.chunks(2).map(|pair| {
            let mut group = pair[0];
            if let [_, next] = pair {
                group.join(next);
            }
            group
        });
        self.groups = pairs.collect();
        self.joined += 1;
        // The last group may hold fewer; the difference is not visible.
        self.filled = 1 << self.joined;
    }
}

/// Number of points above which a line is thinned out however its points lie.
const MAX_POINTS: usize = 20_000;

/// Points of which neighbours in one column become at most four: the first, the least, the
/// greatest and the last, in their order. Nothing that can be seen is lost.
///
/// `column` returns the column of the picture for a point.
pub(super) fn reduce(points: &[[f64; 2]], column: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    let same = |one, other| {
        column(one)
            .floor()
            .total_cmp(&column(other).floor())
            .is_eq()
    };
    for run in points.chunk_by(|&one, &other| same(one, other)) {
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
    fn a_curve_that_comes_in_is_bounded_and_keeps_its_peaks() {
        let mut curve = Curve::default();
        for at in 0..1_000_000 {
            let value = if at == 123_457 { 9.0 } else { 0.0 };
            curve.push([f64::from(at), value]);
        }
        let points = curve.points();
        assert!(points.len() <= 4 * MAX_GROUPS);
        assert!(points.contains(&[123_457.0, 9.0]));
        assert_eq!(points.last(), Some(&[999_999.0, 0.0]));
        assert!(points.is_sorted_by(|one, other| one[0] <= other[0]));
        // Evenly along the whole curve.
        let early = points.iter().filter(|point| point[0] < 500_000.0).count();
        assert!((early * 2).abs_diff(points.len()) < points.len() / 10);
    }

    #[test]
    fn a_curve_of_few_points_is_kept_exactly() {
        let mut curve = Curve::default();
        curve.push([0.0, 1.0]);
        curve.push([1.0, 2.0]);
        curve.interrupt();
        curve.push([2.0, 3.0]);
        let points = curve.points();
        assert_eq!(points[..2], [[0.0, 1.0], [1.0, 2.0]]);
        assert!(points[2][0].is_nan());
        assert_eq!(points[3..], [[2.0, 3.0]]);
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
