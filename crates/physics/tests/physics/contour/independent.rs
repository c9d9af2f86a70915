//! An independent simulation, straight from the equations of chapter 5.2: its motion in time, its drives
//! in small steps, its distance from the path. It shares nothing with that of the library except the
//! additive current of chapter 4.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use frictcomp::lists::FrictionList;
use frictcomp_physics::current::{AdditiveCurrent, Reading, Switched};

use super::driven::{SETTLING_S, widened};
use super::shape::{Line, Piece, Shape};

const CYCLE_S: f64 = 0.001;
const POSITION_LOOP_S: f64 = 250e-6;
const SPEED_LOOP_S: f64 = 125e-6;

/// The duration of a feed ramp.
const RAMP_S: f64 = 0.05;

/// The maximum distance along the path of the nearest point from the commanded one, in mm.
const NEAR: f64 = 0.5;

/// The acceleration of a rapid motion, in mm/s².
const RAPID: f64 = 2000.0;

/// The drive of chapter 5.2 with a contact of some stiffness.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Equations {
    pub(crate) stiffness: f64,
    /// Newtons of a drive unit.
    pub(crate) unit: f64,
    /// Steps of the mechanics in a cycle of the speed loop; the rules have 2.
    pub(crate) steps: u32,
}

const MASS: f64 = 1300.0;
const KV: f64 = 33.3;
const TI: f64 = 0.012;
const TT: f64 = 0.0006;
const COULOMB: f64 = 500.0;
const BREAKAWAY: f64 = 620.0;
const STRIBECK: f64 = 0.003;
const VISCOUS: f64 = 4000.0;
const DAMPING: f64 = 0.002;

/// One axis.
#[derive(Debug, Clone, Copy, Default)]
struct Axis {
    x: f64,
    v: f64,
    z: f64,
    force: f64,
    integral: f64,
    asked: f64,
}

impl Equations {
    /// Returns the friction at a steady speed in m/s, in drive units: the content of a fitting value list.
    pub(crate) fn units_at(&self, speed: f64) -> f64 {
        (level(speed) + VISCOUS * speed) / self.unit
    }

    /// Advances an axis by 250 µs towards a place with a velocity and an additive current.
    fn tick(&self, axis: &mut Axis, (place, velocity, added): (f64, f64, f64)) {
        let kp = MASS * TAU * 45.0;
        let target = KV * (place - axis.x) + velocity;
        for _ in 0..2 {
            let error = target - axis.v;
            let command = axis.asked;
            axis.asked = kp * error + axis.integral + self.unit * added;
            axis.integral += kp / TI * error * SPEED_LOOP_S;
            let step = SPEED_LOOP_S / f64::from(self.steps);
            for _ in 0..self.steps {
                self.step(axis, command, step);
            }
        }
    }

    fn step(&self, axis: &mut Axis, command: f64, step: f64) {
        let v = axis.v;
        axis.force = command + (axis.force - command) * (-step / TT).exp();
        // The bristle bends towards its steady state as long as the speed does not change.
        let loss = self.stiffness * v.abs() / level(v);
        let steady = level(v) / self.stiffness * v.signum();
        if v != 0.0 {
            axis.z = steady + (axis.z - steady) * (-loss * step).exp();
        }
        let rate = v - loss * axis.z;
        let damping = 0.6 * (self.stiffness * MASS).sqrt() * (-(v / DAMPING).powi(2)).exp();
        let friction = self.stiffness * axis.z + damping * rate + VISCOUS * v;
        axis.v += (axis.force - friction) / MASS * step;
        axis.x += axis.v * step;
    }
}

/// Returns the friction at which the contact slips at a speed.
fn level(v: f64) -> f64 {
    COULOMB + (BREAKAWAY - COULOMB) * (-v.abs() / STRIBECK).exp()
}

/// The commanded values at the beginning of a CNC cycle, in mm and mm/s.
#[derive(Debug, Clone, Copy)]
struct Command {
    place: [f64; 2],
    velocity: [f64; 2],
    line: u32,
    /// The number of the piece of the path that is cut, if any, and the distance along it in mm.
    piece: Option<(usize, f64)>,
    compensated: [bool; 2],
}

/// The motion of a shape in time.
#[derive(Debug, Default)]
struct Motion {
    commands: Vec<Command>,
    pieces: Vec<Piece>,
    judged: Vec<u32>,
}

/// Returns the distance and speed of a motion from rest to rest: ramps like half a turn of a cosine.
fn pace(length: f64, feed: f64, ramp: f64, time: f64) -> Option<(f64, f64)> {
    let steady = length / feed - ramp;
    assert!(steady >= 0.0, "{length} mm at {feed} mm/s are too short");
    let rising = |t: f64| {
        let turn = PI * t / ramp;
        (
            feed / 2.0 * (t - ramp / PI * turn.sin()),
            feed / 2.0 * (1.0 - turn.cos()),
        )
    };
    if time < ramp {
        Some(rising(time))
    } else if time < ramp + steady {
        Some((feed * (time - ramp / 2.0), feed))
    } else if time < 2.0 * ramp + steady {
        let (left, velocity) = rising(2.0 * ramp + steady - time);
        Some((length - left, velocity))
    } else {
        None
    }
}

impl Motion {
    fn of(shape: &Shape) -> Self {
        let mut motion = Self {
            judged: shape.judged(),
            ..Self::default()
        };
        let mut stand = shape.start;
        let mut compensated = [true; 2];
        let mut stroke: Vec<(u32, Piece)> = Vec::new();
        for (line, number) in shape.lines.iter().zip(2..) {
            if let Line::Cut { piece, .. } = line {
                stroke.push((number, *piece));
                continue;
            }
            motion.stroke(&stroke, (shape.feed / 60.0, compensated));
            if let Some((_, last)) = stroke.last() {
                stand = last.at(last.length()).0;
            }
            stroke.clear();
            match line {
                Line::Cut { .. } => {}
                Line::Command(words) => {
                    let axis = usize::from(words.starts_with('Y'));
                    compensated[axis] = words.contains("ON");
                }
                Line::Dwell(seconds) => motion.rest(number, (stand, *seconds, compensated)),
                Line::Rapid { to } => {
                    motion.rapid(number, ([stand, *to], compensated));
                    stand = *to;
                }
            }
        }
        motion.stroke(&stroke, (shape.feed / 60.0, compensated));
        if let Some(last) = motion.commands.last() {
            let (place, line, compensated) = (last.place, last.line, last.compensated);
            motion.rest(line, (place, 0.005, compensated));
        }
        motion
    }

    fn rest(&mut self, line: u32, (place, seconds, compensated): ([f64; 2], f64, [bool; 2])) {
        let mut time = 0.0;
        while time < seconds {
            self.commands.push(Command {
                place,
                velocity: [0.0; 2],
                line,
                piece: None,
                compensated,
            });
            time += CYCLE_S;
        }
    }

    fn rapid(&mut self, line: u32, ([from, to], compensated): ([[f64; 2]; 2], [bool; 2])) {
        let piece = Piece::Line { from, to };
        let length = piece.length();
        let feed = (RAPID * length / 4.0).sqrt();
        let ramp = length / feed;
        let mut time = 0.0;
        while let Some((gone, speed)) = pace(length, feed, ramp, time) {
            let (place, along) = piece.at(gone);
            self.commands.push(Command {
                place,
                velocity: along.map(|share| share * speed),
                line,
                piece: None,
                compensated,
            });
            time += CYCLE_S;
        }
    }

    fn stroke(&mut self, stroke: &[(u32, Piece)], (feed, compensated): (f64, [bool; 2])) {
        let length: f64 = stroke.iter().map(|(_, piece)| piece.length()).sum();
        if stroke.is_empty() {
            return;
        }
        let first = self.pieces.len();
        self.pieces.extend(stroke.iter().map(|(_, piece)| *piece));
        let mut time = 0.0;
        while let Some((gone, speed)) = pace(length, feed, RAMP_S, time) {
            let (mut at, mut rest) = (0, gone);
            while at + 1 < stroke.len() && rest >= stroke[at].1.length() {
                rest -= stroke[at].1.length();
                at += 1;
            }
            let (place, along) = stroke[at].1.at(rest);
            self.commands.push(Command {
                place,
                velocity: along.map(|share| share * speed),
                line: stroke[at].0,
                piece: Some((first + at, rest)),
                compensated,
            });
            time += CYCLE_S;
        }
    }

    /// Returns the additive current of an axis, cycle by cycle, with compensation as switched.
    fn currents(
        &self,
        axis: usize,
        list: &FrictionList,
        on: impl Fn(&Command) -> bool,
    ) -> Vec<f64> {
        let mut current = AdditiveCurrent::new(list, Reading::default());
        let velocities: Vec<f64> = self
            .commands
            .iter()
            .map(|it| it.velocity[axis] * 1000.0)
            .collect();
        let cycle = |(at, command): (usize, &Command)| {
            current.switch(if on(command) {
                Switched::On
            } else {
                Switched::Off
            });
            let end = velocities.len().min(at + 1 + current.lookahead());
            let position = command.place[axis] * 10_000.0;
            current
                .step(position, velocities[at], &velocities[at + 1..end])
                .current_units
        };
        self.commands.iter().enumerate().map(cycle).collect()
    }

    /// Returns the time that the line of a cycle has lasted, up to the relevant limit.
    fn seconds_in_line(&self, at: usize) -> f64 {
        let line = self.commands[at].line;
        let before = self.commands[..at].iter().rev().take(10);
        let cycles = before.take_while(|it| it.line == line).count();
        CYCLE_S * f64::from(u32::try_from(cycles).expect("ten"))
    }

    /// Returns the signed deviation of a place in µm, positive on the outside of a curve.
    fn deviation(&self, (piece, gone): (usize, f64), place: [f64; 2]) -> f64 {
        let before = piece.saturating_sub(usize::from(gone < NEAR));
        let left = self.pieces[piece].length() - gone;
        let after = (piece + usize::from(left < NEAR)).min(self.pieces.len() - 1);
        let feet = (before..=after).map(|at| (at, self.pieces[at].distance(place)));
        let nearest = feet.min_by(|one, other| one.1.0.total_cmp(&other.1.0));
        let (at, (_, left)) = nearest.expect("a piece");
        let mut sides = self.pieces[..=at].iter().rev();
        let side = sides.find_map(Piece::side).unwrap_or(1.0);
        -left * side * 1000.0
    }
}

/// A reversal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reversal {
    pub(crate) line: u32,
    pub(crate) axis: usize,
}

/// The result of a run.
#[derive(Debug, Default)]
pub(crate) struct Simulated {
    /// The innermost and the outermost deviation by line, in µm.
    pub(crate) lines: BTreeMap<u32, [f64; 2]>,
    pub(crate) reversals: Vec<Reversal>,
}

/// Axes that are compensated.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Compensation {
    Programmed,
    On,
    Off,
}

/// Drives a shape.
pub(crate) fn simulate(
    shape: &Shape,
    (equations, list): (&Equations, &FrictionList),
    compensation: Compensation,
) -> Simulated {
    let motion = Motion::of(shape);
    let added = [0, 1].map(|axis| {
        motion.currents(axis, list, |command| match compensation {
            Compensation::Programmed => command.compensated[axis],
            Compensation::On => true,
            Compensation::Off => false,
        })
    });
    let mut axes = motion.commands[0].place.map(|mm| Axis {
        x: mm / 1000.0,
        ..Axis::default()
    });
    let mut found = Simulated::default();
    let mut directions = [0.0; 2];
    for (at, pair) in motion.commands.windows(2).enumerate() {
        let [command, next] = [pair[0], pair[1]];
        let turned = (0..2).filter(|&axis| directions[axis] * command.velocity[axis] < 0.0);
        found.reversals.extend(turned.map(|axis| Reversal {
            line: command.line,
            axis,
        }));
        for (direction, velocity) in directions.iter_mut().zip(command.velocity) {
            if velocity != 0.0 {
                *direction = velocity.signum();
            }
        }
        let velocity =
            [0, 1].map(|axis| (next.place[axis] - command.place[axis]) / CYCLE_S / 1000.0);
        for tick in 0..4_u32 {
            let gone = f64::from(tick) * POSITION_LOOP_S;
            for (axis, state) in axes.iter_mut().enumerate() {
                let place = command.place[axis] / 1000.0 + gone * velocity[axis];
                equations.tick(state, (place, velocity[axis], added[axis][at]));
            }
            let Some(piece) = command.piece else {
                continue;
            };
            let deviation = motion.deviation(piece, axes.map(|axis| axis.x * 1000.0));
            let is_settled = motion.seconds_in_line(at) >= SETTLING_S;
            if is_settled && motion.judged.contains(&command.line) {
                let line = found.lines.entry(command.line).or_insert([deviation; 2]);
                *line = widened(*line, deviation);
            }
        }
    }
    found
        .reversals
        .retain(|it| motion.judged.contains(&it.line));
    found
}
