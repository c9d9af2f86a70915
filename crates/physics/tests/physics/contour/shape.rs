//! A path of lines and arcs, as a program and as a motion in time.

use std::f64::consts::PI;
use std::fmt::Write as _;

/// A piece of the path.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Piece {
    Line {
        from: [f64; 2],
        to: [f64; 2],
    },
    /// About a centre, from an angle on, by a turn to the left or to the right.
    Arc {
        centre: [f64; 2],
        radius: f64,
        from: f64,
        turn: f64,
    },
}

impl Piece {
    pub(crate) fn length(&self) -> f64 {
        match self {
            Self::Line { from, to } => (to[0] - from[0]).hypot(to[1] - from[1]),
            Self::Arc { radius, turn, .. } => radius * turn.abs(),
        }
    }

    /// Returns the place after so many mm, and the direction there.
    pub(crate) fn at(&self, gone: f64) -> ([f64; 2], [f64; 2]) {
        match self {
            Self::Line { from, to } => {
                let length = self.length();
                let along = [0, 1].map(|axis| (to[axis] - from[axis]) / length);
                ([0, 1].map(|axis| from[axis] + gone * along[axis]), along)
            }
            Self::Arc {
                centre,
                radius,
                from,
                turn,
            } => {
                let angle = from + gone / radius * turn.signum();
                let (sin, cos) = angle.sin_cos();
                let side = turn.signum();
                (
                    [centre[0] + radius * cos, centre[1] + radius * sin],
                    [-sin * side, cos * side],
                )
            }
        }
    }

    /// Returns the distance of a place from the piece in mm, and the signed distance to its left.
    pub(crate) fn distance(&self, place: [f64; 2]) -> (f64, f64) {
        match self {
            Self::Line { .. } => {
                let (from, along) = self.at(0.0);
                let offset = [place[0] - from[0], place[1] - from[1]];
                let gone = offset[0] * along[0] + offset[1] * along[1];
                let beyond = (gone - gone.clamp(0.0, self.length())).abs();
                let left = along[0] * offset[1] - along[1] * offset[0];
                (left.hypot(beyond), left)
            }
            Self::Arc {
                centre,
                radius,
                from,
                turn,
            } => {
                let offset = [place[0] - centre[0], place[1] - centre[1]];
                let angle = offset[1].atan2(offset[0]);
                let side = turn.signum();
                let gone = ((angle - from) * side).rem_euclid(2.0 * PI);
                // Before its beginning and after its end the nearer end counts.
                let after = gone - turn.abs();
                let before = 2.0 * PI - gone;
                let beyond = after.min(before).max(0.0) * radius;
                let left = (radius - offset[0].hypot(offset[1])) * side;
                (left.hypot(beyond), left)
            }
        }
    }

    /// Returns the side to which it turns.
    pub(crate) fn side(&self) -> Option<f64> {
        match self {
            Self::Line { .. } => None,
            Self::Arc { turn, .. } => Some(turn.signum()),
        }
    }
}

/// The function of a line of the program.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Line {
    /// The pieces join smoothly; what is judged is compared.
    Cut { piece: Piece, judged: bool },
    /// A rapid motion, from rest to rest.
    Rapid { to: [f64; 2] },
    /// A dwell in s.
    Dwell(f64),
    /// A word for the control.
    Command(&'static str),
}

/// A path with its program.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    pub(crate) start: [f64; 2],
    pub(crate) feed: f64,
    pub(crate) lines: Vec<Line>,
}

impl Shape {
    pub(crate) fn new(start: [f64; 2], feed: f64) -> Self {
        Self {
            start,
            feed,
            lines: Vec::new(),
        }
    }

    /// Returns the end of the path.
    pub(crate) fn end(&self) -> [f64; 2] {
        let ends = self.lines.iter().rev().find_map(|line| match line {
            Line::Cut { piece, .. } => Some(piece.at(piece.length()).0),
            Line::Rapid { to } => Some(*to),
            _ => None,
        });
        ends.unwrap_or(self.start)
    }

    pub(crate) fn line(&mut self, to: [f64; 2], judged: bool) {
        let from = self.end();
        let piece = Piece::Line { from, to };
        self.lines.push(Line::Cut { piece, judged });
    }

    /// Adds an arc about a centre by an angle in degrees, to the left if it is positive.
    pub(crate) fn arc(&mut self, centre: [f64; 2], degrees: f64, judged: bool) {
        let from = self.end();
        let offset = [from[0] - centre[0], from[1] - centre[1]];
        let piece = Piece::Arc {
            centre,
            radius: offset[0].hypot(offset[1]),
            from: offset[1].atan2(offset[0]),
            turn: degrees.to_radians(),
        };
        self.lines.push(Line::Cut { piece, judged });
    }

    /// Returns the program; line 1 sets the feed.
    pub(crate) fn program(&self) -> String {
        let mut text = format!("G90 F{}\n", self.feed);
        for line in &self.lines {
            match line {
                Line::Cut { piece, .. } => {
                    let [x, y] = piece.at(piece.length()).0;
                    match piece {
                        Piece::Line { .. } => {
                            let _ = writeln!(text, "G01 X{x:.7} Y{y:.7}");
                        }
                        Piece::Arc { centre, turn, .. } => {
                            let from = piece.at(0.0).0;
                            let (i, j) = (centre[0] - from[0], centre[1] - from[1]);
                            let word = if *turn > 0.0 { "G03" } else { "G02" };
                            let _ = writeln!(text, "{word} X{x:.7} Y{y:.7} I{i:.7} J{j:.7}");
                        }
                    }
                }
                Line::Rapid { to } => {
                    let _ = writeln!(text, "G00 X{:.7} Y{:.7}", to[0], to[1]);
                }
                Line::Dwell(seconds) => {
                    let _ = writeln!(text, "G04 {seconds}");
                }
                Line::Command(words) => {
                    let _ = writeln!(text, "{words}");
                }
            }
        }
        text + "M30\n"
    }

    /// Returns the numbers of the lines that are judged.
    pub(crate) fn judged(&self) -> Vec<u32> {
        let lines = self.lines.iter().zip(2..);
        let judged = lines.filter(|(line, _)| matches!(line, Line::Cut { judged: true, .. }));
        judged.map(|(_, number)| number).collect()
    }
}
