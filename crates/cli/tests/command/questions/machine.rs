//! A small independent machine: it moves one axis as the programs of `frictcomp ask` command, adds a current
//! under either reading of a question, and is recorded. It does not use the dry run.

/// The CNC cycle in seconds.
pub(crate) const CYCLE_S: f64 = 0.001;

/// Acceleration in mm/s².
const ACCELERATION: f64 = 500.0;

/// The value list: build-up distance in mm, cycles of the decay and of the delay, and points in mm/s
/// and drive units.
pub(crate) const LIST: &str = "[axis.value]\nmode = 3\nposition_delay = 10\nreversal_lookahead = 4\n\
    delay_cycles = 9\ntable = [[100, 200], [1000, 300], [20000, 380]]\n";
const BUILD_UP: f64 = 0.001;
const DECAY: usize = 4;
const DELAY: usize = 9;
const POINTS: [(f64, f64); 3] = [(0.1, 200.0), (1.0, 300.0), (20.0, 380.0)];

/// The motion of the axis in a cycle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cycle {
    /// Position in mm.
    pub(crate) x: f64,
    /// Velocity in mm/s.
    pub(crate) v: f64,
    pub(crate) is_on: bool,
    /// Current in drive units.
    pub(crate) current: f64,
}

/// A machine that follows the second reading of one question, if any.
pub(crate) struct Machine<'a> {
    pub(crate) second: Option<&'a str>,
}

/// A move, or a wait of a number of seconds without motion.
#[derive(Debug, Clone, Copy)]
struct Step {
    by: f64,
    feed: f64,
    waits_s: f64,
    /// The state during it.
    is_on: bool,
    /// Whether the path stops before the step, whatever follows.
    stands_before: bool,
}

impl Machine<'_> {
    fn follows_second(&self, rule: &str) -> bool {
        self.second == Some(rule)
    }

    /// Runs a program, and adds the current.
    pub(crate) fn run(&self, program: &str) -> Vec<Cycle> {
        let mut cycles = drive(&self.steps(program));
        self.add(&mut cycles);
        cycles
    }

    fn steps(&self, program: &str) -> Vec<Step> {
        let (mut feed, mut is_on, mut commanded) = (0.0, true, false);
        let wait = |is_on, waits_s| Step {
            by: 0.0,
            feed: 1.0,
            waits_s,
            is_on,
            stands_before: true,
        };
        let mut steps = vec![wait(true, 0.1)];
        for line in program.lines().filter(|line| line.starts_with('N')) {
            let mut block = line.split_once(' ').map_or("", |it| it.1).to_owned();
            let mut own = is_on;
            for (command, on) in [("X[COMP ON FRICT]", true), ("X[COMP OFF FRICT]", false)] {
                if block.contains(command) {
                    block = block.replace(command, "");
                    (is_on, commanded) = (on, true);
                    if !self.follows_second("R1.9") || !block.contains('X') {
                        own = on;
                    }
                }
            }
            let mut by = None;
            for word in block.split_whitespace() {
                if let Some(value) = word.strip_prefix('F') {
                    feed = value.parse::<f64>().expect("a feed") / 60.0;
                } else if let Some(value) = word.strip_prefix('X') {
                    by = Some(value.parse().expect("a distance"));
                }
            }
            if block.contains("G04") {
                steps.push(wait(is_on, 1.0));
            } else if let Some(by) = by {
                steps.push(Step {
                    by,
                    feed,
                    waits_s: 0.0,
                    is_on: own,
                    stands_before: commanded && self.follows_second("R1.57"),
                });
                commanded = false;
            }
        }
        steps.push(wait(is_on, 0.2));
        steps
    }

    /// Adds the current of each cycle, computed from all cycles at once.
    fn add(&self, cycles: &mut [Cycle]) {
        let count = cycles.len();
        let mut direction = vec![0.0; count];
        let mut build_up = vec![1.0_f64; count];
        let mut begun: Option<(f64, usize)> = None;
        for k in 0..count {
            let before = if k == 0 || !cycles[k - 1].is_on {
                0.0
            } else {
                direction[k - 1]
            };
            let v = cycles[k].v;
            direction[k] = if v == 0.0 { before } else { v.signum() };
            let stood = k == 0 || cycles[k - 1].v == 0.0;
            let starts = direction[k] != before || self.follows_second("R4.3") && stood && v != 0.0;
            if starts && v != 0.0 {
                begun = Some((cycles[k.saturating_sub(1)].x, k));
            }
            if let Some((from, since)) = begun {
                let late = if self.follows_second("R4.5") {
                    DELAY
                } else {
                    0
                };
                build_up[k] = if k < since + late {
                    0.0
                } else {
                    ((cycles[k - late].x - from).abs() / BUILD_UP).min(1.0)
                };
                if build_up[k] >= 1.0 {
                    begun = None;
                }
            }
        }
        let raw: Vec<f64> = (0..count)
            .map(|k| {
                let v = cycles[k].v;
                if v == 0.0 && self.follows_second("R4.6") {
                    return 0.0;
                }
                let turn = (1..=DECAY).find(|ahead| {
                    let later = cycles.get(k + ahead);
                    later.is_some_and(|it| it.v * direction[k] < 0.0)
                });
                let decay = match turn {
                    Some(_) if self.follows_second("R4.2") => 0.0,
                    Some(ahead) => (ahead - 1) as f64 / DECAY as f64,
                    None => 1.0,
                };
                direction[k] * self.friction(v.abs()) * decay.min(build_up[k])
            })
            .collect();
        let delay = if self.follows_second("R4.5") {
            0
        } else {
            DELAY
        };
        for k in 0..count {
            let from = k
                .checked_sub(delay)
                .filter(|from| (*from..=k).all(|it| cycles[it].is_on));
            cycles[k].current = from.map_or(0.0, |from| raw[from]);
        }
    }

    fn friction(&self, speed: f64) -> f64 {
        let [first, .., last] = POINTS;
        if speed <= first.0 {
            let part = if self.follows_second("R4.7") {
                speed / first.0
            } else {
                1.0
            };
            return first.1 * part;
        }
        let pair = POINTS.windows(2).find(|pair| speed <= pair[1].0);
        pair.map_or(last.1, |pair| {
            let part = (speed - pair[0].0) / (pair[1].0 - pair[0].0);
            pair[0].1 + part * (pair[1].1 - pair[0].1)
        })
    }
}

/// Moves one step after the other, within the acceleration; a cycle may begin in one and end in the next.
fn drive(steps: &[Step]) -> Vec<Cycle> {
    let mut cycles: Vec<Cycle> = Vec::new();
    let (mut x, mut v, mut over) = (0.0_f64, 0.0_f64, 0.0_f64);
    let change = ACCELERATION * CYCLE_S;
    let slowest = |feed: f64| feed.min(change / 4.0);
    for (at, step) in steps.iter().enumerate() {
        let mut cycle = Cycle {
            x,
            is_on: step.is_on,
            ..Cycle::default()
        };
        if step.by == 0.0 {
            v = 0.0;
            let count = (step.waits_s / CYCLE_S).round() as usize;
            cycles.extend(vec![cycle; count]);
            continue;
        }
        // Speed at the end of the step: that of the next one if the path continues.
        let next = steps.get(at + 1);
        let next = next.filter(|next| next.by * step.by > 0.0 && !next.stands_before);
        let end = next.map_or(0.0, |next| next.feed.min(step.feed));
        let (sign, mut rest) = (step.by.signum(), step.by.abs() - over);
        over = 0.0;
        while rest > 1e-9 {
            let brakes = (end * end + 2.0 * ACCELERATION * rest).sqrt() - change / 2.0;
            let wanted = step.feed.min(brakes.max(end)).min(v + change);
            v = wanted.max(v - change).max(slowest(step.feed));
            let way = if next.is_some() {
                v * CYCLE_S
            } else {
                (v * CYCLE_S).min(rest)
            };
            v = way / CYCLE_S;
            rest -= way;
            x += sign * way;
            (cycle.x, cycle.v) = (x, sign * v);
            cycles.push(cycle);
        }
        match next {
            Some(_) => over = -rest,
            None => v = 0.0,
        }
    }
    cycles
}
