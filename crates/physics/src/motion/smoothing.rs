//! Short lines as one curve: their vertices without the noise of their decimals (R11.22).
//!
//! The coordinates of a program are rounded, and a curve through rounded vertices has a curvature
//! that is mostly noise: with chords of 0.1 mm the last of four decimals bends the path as much as a
//! radius of 100 mm does. Vertices are therefore weighted means of their neighbours, with weights that keep
//! straight and evenly curved paths unchanged; they are the control points of a cubic B-spline.

use std::collections::VecDeque;

/// Maximum number of vertices weighed on either side.
const WIDEST: usize = 12;

/// The weights of a vertex and its neighbours to one side: a Gaussian times a parabola, whose second
/// moment is 0.
fn weights(half: usize) -> Vec<f64> {
    if half == 0 {
        return vec![1.0];
    }
    #[allow(clippy::cast_precision_loss)] // at most 12
    let far = |at: usize| at as f64;
    let spread = far(half) / 3.0;
    let gauss = |at: usize| (-0.5 * (far(at) / spread).powi(2)).exp();
    let moment = |order: i32| {
        let side: f64 = (1..=half).map(|at| gauss(at) * far(at).powi(order)).sum();
        2.0 * side + if order == 0 { 1.0 } else { 0.0 }
    };
    let [zeroth, second, fourth] = [0, 2, 4].map(moment);
    let scale = zeroth * fourth - second * second;
    let (level, bow) = (fourth / scale, -second / scale);
    (0..=half)
        .map(|at| gauss(at) * (level + bow * far(at).powi(2)))
        .collect()
}

/// Positions of axes.
pub(super) type AxisPositions = Box<[f64]>;

/// The vertices of a run of short lines, from which control points are made as it continues.
#[derive(Debug)]
pub(super) struct SmoothRun {
    weights: Vec<Vec<f64>>,
    /// The vertices that are still needed.
    vertices: VecDeque<AxisPositions>,
    /// The number of the first of them in the run.
    first: usize,
    /// The number of the last vertex, once it is known.
    last: Option<usize>,
    /// The smooth vertices around the newest span.
    smooth: VecDeque<AxisPositions>,
    /// The number of the first of them in the run.
    first_smooth: usize,
}

impl SmoothRun {
    pub(super) fn new() -> Self {
        Self {
            weights: (0..=WIDEST).map(weights).collect(),
            vertices: VecDeque::new(),
            first: 0,
            last: None,
            smooth: VecDeque::new(),
            first_smooth: 0,
        }
    }

    /// Begins a run at its first vertex.
    pub(super) fn begin(&mut self, vertex: AxisPositions) {
        self.vertices.clear();
        self.vertices.push_back(vertex);
        self.smooth.clear();
        (self.first, self.first_smooth, self.last) = (0, 0, None);
    }

    /// Adds the next vertex.
    pub(super) fn push(&mut self, vertex: AxisPositions) {
        self.vertices.push_back(vertex);
    }

    /// The number of the newest vertex.
    pub(super) fn newest(&self) -> usize {
        (self.first + self.vertices.len()).saturating_sub(1)
    }

    /// Ends the run at another place than its newest vertex.
    pub(super) fn end(&mut self, vertex: Option<AxisPositions>) {
        if let (Some(vertex), Some(newest)) = (vertex, self.vertices.back_mut()) {
            *newest = vertex;
        }
        self.last = Some(self.newest());
    }

    /// Whether the span after a vertex can be made: all vertices that it depends on are known and
    /// final, which the newest may not be.
    pub(super) fn is_ready(&self, span: usize) -> bool {
        self.last.is_some() || span + 4 + WIDEST <= self.newest()
    }

    pub(super) fn vertex(&self, number: usize) -> &AxisPositions {
        let at = number.saturating_sub(self.first);
        &self.vertices[at.min(self.vertices.len() - 1)]
    }

    /// The four control points of the span after a vertex, which is never before that of the last call.
    pub(super) fn span(&mut self, number: usize) -> [AxisPositions; 4] {
        self.smooth_around(number);
        let before = match number.checked_sub(1) {
            Some(before) => self.control(before),
            None => mirrored(self.vertex(0), &self.control(1)),
        };
        let after = if self.last == Some(number + 1) {
            mirrored(self.vertex(number + 1), &self.control(number))
        } else {
            self.control(number + 2)
        };
        [
            before,
            self.control(number),
            self.control(number + 1),
            after,
        ]
    }

    /// Forgets the vertices that are not needed for any span from one on.
    pub(super) fn forget_before(&mut self, span: usize) {
        while self.first + WIDEST + 2 < span {
            self.vertices.pop_front();
            self.first += 1;
        }
    }

    /// A control point: the smooth vertex, moved beyond it so that the spline passes through it.
    fn control(&self, number: usize) -> AxisPositions {
        let smooth = |number: usize| &self.smooth[number - self.first_smooth];
        let own = smooth(number);
        let inner = number >= 2 && self.last.is_none_or(|last| number + 2 <= last);
        if !inner {
            return own.clone();
        }
        let (before, after) = (smooth(number - 1), smooth(number + 1));
        let axes = own.iter().zip(before.iter().zip(after.iter()));
        axes.map(|(own, (before, after))| own - (before - 2.0 * own + after) / 6.0)
            .collect()
    }

    /// Makes the smooth vertices that a span depends on, each once.
    fn smooth_around(&mut self, span: usize) {
        while self.first_smooth + 2 < span {
            self.smooth.pop_front();
            self.first_smooth += 1;
        }
        let last = self.last.map_or(span + 3, |last| last.min(span + 3));
        for number in self.first_smooth + self.smooth.len()..=last {
            self.smooth.push_back(self.weighed(number));
        }
    }

    fn weighed(&self, number: usize) -> AxisPositions {
        let rest = self.last.map_or(WIDEST, |last| last.saturating_sub(number));
        let half = WIDEST.min(number).min(rest);
        let own = self.vertex(number);
        let mut smooth: AxisPositions = own.iter().map(|x| x * self.weights[half][0]).collect();
        for (at, weight) in self.weights[half].iter().enumerate().skip(1) {
            let sides = [self.vertex(number - at), self.vertex(number + at)];
            for (axis, sum) in smooth.iter_mut().enumerate() {
                *sum += weight * (sides[0][axis] + sides[1][axis]);
            }
        }
        smooth
    }
}

/// The place beyond the end of a path, at the distance of another one before it.
fn mirrored(end: &AxisPositions, before: &AxisPositions) -> AxisPositions {
    let axes = end.iter().zip(before.iter());
    axes.map(|(end, before)| 2.0 * end - before).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_keep_lines_and_parabolas() {
        // R11.22
        for half in 0..=WIDEST {
            let weights = weights(half);
            let far = |at: usize| f64::from(u32::try_from(at).expect("small"));
            let sum: f64 = weights[1..].iter().sum::<f64>() * 2.0 + weights[0];
            let second: f64 = (1..=half).map(|at| weights[at] * far(at).powi(2)).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{half}");
            assert!(second.abs() < 1e-9, "{half}");
        }
    }
}
