//! A control: from the moves of a program to a commanded place in each cycle.

use super::program::{Move, Program};
use super::ramp::Ramp;

/// A control with ramps of its own.
#[derive(Debug, Clone, Copy)]
pub struct Control {
    /// The bounds of the motion along the path.
    pub ramp: Ramp,
    /// The cycle in s.
    pub cycle_s: f64,
    /// The override: 1 for 100 %.
    pub part: f64,
    /// The time in s at which the motion begins within its first cycle.
    pub phase_s: f64,
}

/// Commanded values in each cycle.
#[derive(Debug, Clone, Default)]
pub struct Commanded {
    /// The place of each axis in mm.
    pub places: [Vec<f64>; 2],
    /// The velocity of each axis in mm/s.
    pub velocities: [Vec<f64>; 2],
    /// Whether compensation of each axis is on.
    pub is_on: [Vec<bool>; 2],
    /// The arcs: the first cycle, the last one, and the centre in mm.
    pub arcs: Vec<([usize; 2], [f64; 2])>,
}

/// A path without a stop.
struct Path {
    pieces: Vec<Piece>,
    feed: f64,
}

/// A line or an arc with its start.
enum Piece {
    Line([f64; 2], [f64; 2]),
    Arc {
        middle: [f64; 2],
        radius: f64,
        from: f64,
        angle: f64,
    },
}

impl Piece {
    fn length(&self) -> f64 {
        match self {
            Self::Line(from, to) => (to[0] - from[0]).hypot(to[1] - from[1]),
            Self::Arc { radius, angle, .. } => radius * angle.abs(),
        }
    }

    /// Returns the place and the direction after a distance.
    fn at(&self, way: f64) -> ([f64; 2], [f64; 2]) {
        match *self {
            Self::Line(from, to) => {
                let length = self.length().max(1e-12);
                let along = [0, 1].map(|it| (to[it] - from[it]) / length);
                ([0, 1].map(|it| from[it] + way * along[it]), along)
            }
            Self::Arc {
                middle,
                radius,
                from,
                angle,
            } => {
                let way_round = angle.signum();
                let (y, x) = (from + way_round * way / radius).sin_cos();
                (
                    [middle[0] + radius * x, middle[1] + radius * y],
                    [-way_round * y, way_round * x],
                )
            }
        }
    }
}

impl Control {
    /// Returns the commanded values of a program that begins at a place in mm.
    pub fn run(&self, program: &Program, start: [f64; 2]) -> Commanded {
        let mut found = Commanded::default();
        let mut place = start;
        let mut is_on = [true; 2];
        let mut path: Option<Path> = None;
        // A cycle before all, so that each velocity has a place before it.
        self.rest(&mut found, (place, is_on), 0.0);
        for step in &program.moves {
            let feed = match step {
                Move::Line(_, feed) | Move::Arc { feed, .. } => *feed,
                _ => 0.0,
            };
            let joins = matches!(step, Move::Arc { angle, .. } if path.as_ref().is_some_and(|it| it.continues(*angle, feed)));
            if !joins && let Some(path) = path.take() {
                self.drive(&mut found, &path, is_on);
            }
            match *step {
                Move::Dwell(seconds) => self.rest(&mut found, (place, is_on), seconds),
                Move::Switch(axis, on) => is_on[axis] = on,
                Move::Line(to, feed) => {
                    let pieces = vec![Piece::Line(place, to)];
                    path = Some(Path { pieces, feed });
                    place = to;
                }
                Move::Arc {
                    centre,
                    angle,
                    feed,
                } => {
                    let piece = Piece::Arc {
                        middle: [place[0] + centre[0], place[1] + centre[1]],
                        radius: centre[0].hypot(centre[1]),
                        from: (-centre[1]).atan2(-centre[0]),
                        angle,
                    };
                    place = piece.at(piece.length()).0;
                    match &mut path {
                        Some(path) => path.pieces.push(piece),
                        None => {
                            path = Some(Path {
                                pieces: vec![piece],
                                feed,
                            });
                        }
                    }
                }
            }
        }
        if let Some(path) = path {
            self.drive(&mut found, &path, is_on);
        }
        self.rest(&mut found, (place, is_on), 0.2);
        found
    }

    fn rest(&self, found: &mut Commanded, (place, is_on): ([f64; 2], [bool; 2]), seconds: f64) {
        let cycles = (seconds / self.cycle_s).round() as usize + 1;
        for _ in 0..cycles {
            found.take(place, [0.0; 2], is_on);
        }
    }

    fn drive(&self, found: &mut Commanded, path: &Path, is_on: [bool; 2]) {
        let length: f64 = path.pieces.iter().map(Piece::length).sum();
        if length < 1e-9 {
            return;
        }
        let motion = self.ramp.motion(length, path.feed / 60.0 * self.part);
        let first = found.places[0].len();
        let cycles = (motion.seconds() / self.cycle_s).ceil() as usize + 1;
        for cycle in 0..=cycles {
            let time = cycle as f64 * self.cycle_s - self.phase_s;
            let (mut way, speed) = motion.at(time);
            let mut at = 0;
            while at + 1 < path.pieces.len() && way > path.pieces[at].length() {
                way -= path.pieces[at].length();
                at += 1;
            }
            let (place, along) = path.pieces[at].at(way);
            found.take(place, along.map(|it| it * speed), is_on);
        }
        if let Some(Piece::Arc { middle, .. }) = path.pieces.first() {
            found
                .arcs
                .push(([first, found.places[0].len() - 1], *middle));
        }
    }
}

impl Path {
    /// Returns whether an arc goes on with a path of arcs.
    fn continues(&self, angle: f64, feed: f64) -> bool {
        let is_same = |it: &Piece| matches!(it, Piece::Arc { angle: own, .. } if own * angle > 0.0);
        (self.feed - feed).abs() < 1e-9 && self.pieces.iter().all(is_same)
    }
}

impl Commanded {
    fn take(&mut self, place: [f64; 2], velocity: [f64; 2], is_on: [bool; 2]) {
        for axis in 0..2 {
            self.places[axis].push(place[axis]);
            self.velocities[axis].push(velocity[axis]);
            self.is_on[axis].push(is_on[axis]);
        }
    }
}
