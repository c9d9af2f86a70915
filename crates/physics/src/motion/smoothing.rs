//! Short lines as one curve: their vertices without the noise of their decimals (R11.22).
//!
//! The coordinates of a program are rounded, and a curve through rounded vertices has a curvature
//! that is mostly noise: with chords of 0.1 mm the last of four decimals bends the path as much as a
//! radius of 100 mm does. Vertices are therefore weighted means of their neighbours, with weights that keep
//! straight and evenly curved paths unchanged; they are the control points of a cubic B-spline. A vertex at
//! which the path bends by more than its decimals do is not weighed, and no weights reach across it.

use super::turns::{AHEAD, AxisCourse, RunVertices, Window};

/// Maximum number of vertices weighed on either side.
const WIDEST: usize = 12;

/// Returns the weights of a vertex and its neighbours to one side: a Gaussian times a parabola, whose second moment is
/// 0.
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

/// The share of the tolerance by which the weights may move a vertex.
const MOVED: f64 = 1.0 / 3.0;

/// A vertex of a run.
#[derive(Debug)]
struct Vertex {
    place: AxisPositions,
    /// The greatest distance in mm by which it may be moved along an axis.
    room: f64,
}

/// Bend of the path at a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bend {
    /// A bend no larger than the decimals of the program explain.
    Fine,
    /// A larger bend.
    Coarse,
}

/// The vertices of a run of short lines, from which control points are made as it continues.
#[derive(Debug)]
pub(super) struct SmoothRun {
    weights: Vec<Vec<f64>>,
    /// The vertices that are still needed.
    vertices: Window<Vertex>,
    /// The number of the last vertex, once it is known.
    last: Option<usize>,
    /// The vertices without the noise of their decimals.
    smooth: Window<AxisPositions>,
    /// The control points of a spline through them.
    wanted: Window<AxisPositions>,
    /// The control points, which turn where the vertices do.
    control: Window<AxisPositions>,
    /// Courses by axis.
    courses: Vec<AxisCourse>,
    /// The last vertex with a coarse bend.
    coarse: usize,
}

impl SmoothRun {
    pub(super) fn new() -> Self {
        Self {
            weights: (0..=WIDEST).map(weights).collect(),
            vertices: Window::default(),
            last: None,
            smooth: Window::default(),
            wanted: Window::default(),
            control: Window::default(),
            courses: Vec::new(),
            coarse: 0,
        }
    }

    /// Begins a run at its first vertex.
    pub(super) fn begin(&mut self, place: AxisPositions) {
        self.courses = vec![AxisCourse::default(); place.len()];
        self.vertices.clear();
        for points in [&mut self.smooth, &mut self.wanted, &mut self.control] {
            points.clear();
        }
        (self.last, self.coarse) = (None, 0);
        self.vertices.push(Vertex { place, room: 0.0 });
    }

    /// Adds the next vertex.
    pub(super) fn push(&mut self, place: AxisPositions) {
        self.vertices.push(Vertex { place, room: 0.0 });
    }

    /// Adds the next vertex, after one with this bend and tolerance in mm.
    pub(super) fn join(&mut self, place: AxisPositions, (bend, tolerance): (Bend, f64)) {
        if let Some(newest) = self.vertices.newest_mut() {
            newest.room = match bend {
                Bend::Fine => MOVED * tolerance,
                Bend::Coarse => 0.0,
            };
        }
        self.push(place);
    }

    /// Returns the number of the newest vertex.
    pub(super) fn newest(&self) -> usize {
        self.vertices.newest()
    }

    /// Ends the run at another place than its newest vertex.
    pub(super) fn end(&mut self, place: Option<AxisPositions>) {
        if let (Some(place), Some(newest)) = (place, self.vertices.newest_mut()) {
            newest.place = place;
        }
        self.last = Some(self.newest());
    }

    /// Returns whether the span after a vertex can be made: all vertices that it depends on are known and final, which
    /// the newest may not be.
    pub(super) fn is_ready(&self, span: usize) -> bool {
        self.last.is_some() || span + 4 + WIDEST + AHEAD <= self.newest()
    }

    pub(super) fn vertex(&self, number: usize) -> &AxisPositions {
        &self.vertices.at(number).place
    }

    /// Returns the four control points of the span after a vertex, which is never before that of the last call.
    pub(super) fn span(&mut self, number: usize) -> [AxisPositions; 4] {
        self.turn_as_vertices(self.within(number + 2));
        let control = |number: usize| self.control.at(number).clone();
        let before = match number.checked_sub(1) {
            Some(before) => control(before),
            None => mirrored(self.vertex(0), &control(1)),
        };
        let after = if self.last == Some(number + 1) {
            mirrored(self.vertex(number + 1), &control(number))
        } else {
            control(number + 2)
        };
        [before, control(number), control(number + 1), after]
    }

    /// Forgets what is not needed for any span from one on.
    pub(super) fn forget_before(&mut self, span: usize) {
        self.vertices.forget_before(span.saturating_sub(WIDEST + 1));
        self.smooth.forget_before(span.saturating_sub(1));
        self.wanted.forget_before(span.saturating_sub(1));
        self.control.forget_before(span.saturating_sub(1));
    }

    /// Returns a number of a vertex, which is not after the last one.
    fn within(&self, number: usize) -> usize {
        self.last.map_or(number, |last| last.min(number))
    }

    /// Makes the control points up to one, which turn where the vertices do.
    fn turn_as_vertices(&mut self, to: usize) {
        for number in self.control.next()..=to {
            let last = self.within(number + AHEAD);
            self.want(last);
            let is_end = self.last == Some(number);
            let mut point = self.wanted.at(number).clone();
            for (axis, to) in point.iter_mut().enumerate().filter(|_| !is_end) {
                let (vertices, wanted) = (&self.vertices, &self.wanted);
                let run = AxisOfRun {
                    vertices,
                    wanted,
                    axis,
                    last,
                };
                *to = self.courses[axis].next(number, &run);
            }
            self.control.push(point);
        }
    }

    /// Makes the control points up to one of a spline through the smooth vertices.
    fn want(&mut self, to: usize) {
        for number in self.wanted.next()..=to {
            for vertex in self.smooth.next()..=self.within(number + 1) {
                let smooth = self.weighed(vertex);
                self.smooth.push(smooth);
            }
            let wanted = self.through(number);
            self.wanted.push(wanted);
        }
    }

    /// Returns the smooth vertex, moved beyond it so that the spline passes through it.
    fn through(&self, number: usize) -> AxisPositions {
        let own = self.smooth.at(number);
        let rest = self.last.map_or(WIDEST, |last| last.saturating_sub(number));
        let is_coarse = self.vertices.at(number).room == 0.0;
        // Next to an end, where the spline does not bend, it would bend more than a fine curve does.
        let nearest = if is_coarse { 1 } else { 2 };
        if number.min(rest) < nearest {
            return own.clone();
        }
        let (before, after) = (self.smooth.at(number - 1), self.smooth.at(number + 1));
        let axes = own.iter().zip(before.iter().zip(after.iter()));
        axes.map(|(own, (before, after))| own - ((before - own) + (after - own)) / 6.0)
            .collect()
    }

    fn weighed(&mut self, number: usize) -> AxisPositions {
        let rest = self.last.map_or(WIDEST, |last| last.saturating_sub(number));
        let room = self.vertices.at(number).room;
        if room == 0.0 {
            self.coarse = number;
        }
        let most = WIDEST.min(number - self.coarse).min(rest);
        let is_fine = |far: &usize| self.vertices.at(number + far).room > 0.0;
        let half = (1..=most).take_while(is_fine).count();
        // The weights may reach a coarse vertex, but not across it.
        let half = most.min(half + 1);
        let own = self.vertex(number);
        let mut moved: AxisPositions = vec![0.0; own.len()].into();
        for (at, weight) in self.weights[half].iter().enumerate().skip(1) {
            let sides = [self.vertex(number - at), self.vertex(number + at)];
            for (axis, sum) in moved.iter_mut().enumerate() {
                *sum += weight * ((sides[0][axis] - own[axis]) + (sides[1][axis] - own[axis]));
            }
        }
        let axes = own.iter().zip(&moved);
        axes.map(|(own, moved)| own + moved.clamp(-room, room))
            .collect()
    }
}

/// A run as one axis sees it.
struct AxisOfRun<'a> {
    vertices: &'a Window<Vertex>,
    wanted: &'a Window<AxisPositions>,
    axis: usize,
    last: usize,
}

impl RunVertices for AxisOfRun<'_> {
    fn step(&self, vertex: usize) -> f64 {
        let [from, to] = [vertex, vertex + 1].map(|number| &self.vertices.at(number).place);
        to[self.axis] - from[self.axis]
    }

    fn wanted(&self, vertex: usize) -> f64 {
        self.wanted.at(vertex)[self.axis]
    }

    fn last(&self) -> usize {
        self.last
    }
}

/// Returns the place beyond the end of a path, at the distance of another one before it.
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
