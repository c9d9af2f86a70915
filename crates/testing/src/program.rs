//! Measuring programs as text.

/// The motion of a block.
#[derive(Debug, Clone, PartialEq)]
pub enum Move {
    /// Standstill in s.
    Dwell(f64),
    /// A straight line: the place of each axis in mm at its end, and the feed in mm/min.
    Line([f64; 2], f64),
    /// An arc about a centre in mm from the start, over an angle in radians, positive counter-clockwise.
    Arc {
        /// The centre from the start.
        centre: [f64; 2],
        /// The angle.
        angle: f64,
        /// The feed in mm/min.
        feed: f64,
    },
    /// Switch of the compensation of an axis: on or off.
    Switch(usize, bool),
}

/// A program of two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Moves in their order.
    pub moves: Vec<Move>,
}

impl Program {
    /// Reads a program of two axes, which begins at a place in mm.
    ///
    /// # Panics
    /// A word that this reader does not know.
    pub fn parse(text: &str, axes: [&str; 2], start: [f64; 2]) -> Self {
        let mut moves = Vec::new();
        let mut place = start;
        let mut feed = 0.0;
        let mut motion = 1;
        for line in text.lines() {
            let line = line.split(['(', ';', '%']).next().unwrap_or_default();
            for (axis, name) in axes.iter().enumerate() {
                let switch = |word: &str| line.contains(&format!("{name}[COMP {word}"));
                if switch("ON") || switch("OFF") {
                    moves.push(Move::Switch(axis, switch("ON")));
                }
            }
            let words = line.split_whitespace();
            let words: Vec<&str> = words.take_while(|it| !it.contains(['[', '#'])).collect();
            let value = |name: &str| {
                let mut values = words.iter().filter_map(|it| it.strip_prefix(name));
                values.find_map(|it| it.trim_start_matches('=').parse::<f64>().ok())
            };
            let codes = words.iter().filter_map(|it| it.strip_prefix('G'));
            let codes: Vec<i32> = codes.filter_map(|it| it.parse().ok()).collect();
            feed = value("F").unwrap_or(feed);
            if codes.contains(&4) {
                let seconds = words.iter().filter_map(|it| {
                    it.trim_start_matches(axes[0])
                        .trim_start_matches('#')
                        .parse::<f64>()
                        .ok()
                });
                moves.extend(seconds.map(Move::Dwell).next_back());
                continue;
            }
            motion = codes
                .iter()
                .copied()
                .find(|it| (0..4).contains(it))
                .unwrap_or(motion);
            let end = [0, 1].map(|at| value(axes[at]));
            if end == [None, None] && value("I").is_none() && value("J").is_none() {
                continue;
            }
            let end = [0, 1].map(|at| end[at].unwrap_or(place[at]));
            if motion < 2 {
                moves.push(Move::Line(end, feed));
            } else {
                let centre = [value("I").unwrap_or(0.0), value("J").unwrap_or(0.0)];
                moves.push(arc(place, end, (centre, motion == 3), feed));
            }
            place = end;
        }
        Self { moves }
    }
}

fn arc(from: [f64; 2], to: [f64; 2], (centre, is_ccw): ([f64; 2], bool), feed: f64) -> Move {
    let middle = [from[0] + centre[0], from[1] + centre[1]];
    let angle = |place: [f64; 2]| (place[1] - middle[1]).atan2(place[0] - middle[0]);
    let turn = std::f64::consts::TAU;
    let sign = if is_ccw { 1.0 } else { -1.0 };
    let mut way = (sign * (angle(to) - angle(from))).rem_euclid(turn);
    if way < 1e-6 {
        way = turn;
    }
    Move::Arc {
        centre,
        angle: sign * way,
        feed,
    }
}
