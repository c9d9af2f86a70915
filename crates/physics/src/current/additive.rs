//! The additive current of one axis, cycle by cycle.

use std::collections::VecDeque;

use super::reading::{Below, Decay, Delay, Reading, Standstill, Start};
use frictcomp::lists::{FrictionList, TablePoint};

/// State of friction compensation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Switched {
    /// Compensation on.
    On,
    /// Off.
    Off,
}

/// Additive current of one CNC cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Added {
    /// Weight of the decay before a reversal, 0 to 1 (R4.2).
    pub w_before: f64,
    /// Weight of the build-up after a reversal, 0 to 1 (R4.3).
    pub w_after: f64,
    /// The additive current in drive units.
    pub current_units: f64,
    /// The integer that the drive gets: rounded half away from zero, saturated to 16 bit (R4.11).
    pub output: i16,
}

/// Computes the additive current of one axis, cycle by cycle.
///
/// ```
/// use frictcomp_physics::current::{AdditiveCurrent, Reading};
/// use frictcomp::lists::{FrictionList, TablePoint};
///
/// let list = FrictionList {
///     position_delay: 0,
///     reversal_lookahead: 2,
///     scaling_factor: 1000,
///     delay_cycles: 0,
///     max_points: 20,
///     table: vec![TablePoint { input: 0.0, output: 10.0 }],
/// };
/// let mut current = AdditiveCurrent::new(&list, Reading::default());
/// // Two cycles before the reversal the current has begun to decay.
/// let added = current.step(50.0, 1000.0, &[1000.0, -1000.0]);
/// assert_eq!((added.w_before, added.current_units), (0.5, 5.0));
/// ```
#[derive(Debug, Clone)]
pub struct AdditiveCurrent {
    table: Vec<TablePoint>,
    /// Number of its points at or below the last speed.
    above: usize,
    /// `scaling_factor` as a factor.
    scaling: f64,
    /// Distance of the build-up in units of the position.
    position_delay: f64,
    lookahead: usize,
    delay_cycles: usize,
    reading: Reading,
    active: bool,
    /// Direction of the last motion: -1, 0 before the first, 1.
    direction: f64,
    last_position: Option<f64>,
    /// Whether the axis was at standstill in the last cycle.
    is_standing: bool,
    build_up: Option<BuildUp>,
    /// Raw values on their way through the dead time, the oldest first.
    line: VecDeque<f64>,
    /// The last positions, if the build-up is postponed.
    positions: VecDeque<f64>,
    /// Factor of the output before it is sent to the drive.
    torque_scale: f64,
    saturated: u64,
    at_rest: u64,
}

/// The build-up after a reversal.
#[derive(Debug, Clone, Copy)]
struct BuildUp {
    /// Position of the reversal.
    from: f64,
    /// Cycles until the build-up begins.
    waits: usize,
}

impl AdditiveCurrent {
    /// Returns a computation with a value list, compensation on, before the first cycle.
    pub fn new(list: &FrictionList, reading: Reading) -> Self {
        let delay_cycles = usize::try_from(list.delay_cycles).unwrap_or_default();
        Self {
            table: list.table.clone(),
            above: 0,
            scaling: f64::from(list.scaling_factor) / 1000.0,
            // R3.25: a negative one counts as 0.
            position_delay: f64::from(list.position_delay.max(0)),
            lookahead: usize::from(list.reversal_lookahead),
            delay_cycles,
            reading,
            active: true,
            direction: 0.0,
            last_position: None,
            is_standing: true,
            build_up: None,
            line: VecDeque::with_capacity(delay_cycles + 1),
            positions: VecDeque::with_capacity(delay_cycles + 1),
            torque_scale: 1.0,
            saturated: 0,
            at_rest: 0,
        }
    }

    /// Scales the torque on its way to the drive, by P-AXIS-00325 over P-AXIS-00326 (R7.8). Only the output
    /// for the drive is scaled.
    pub fn scaled(mut self, torque_scale: f64) -> Self {
        self.torque_scale = torque_scale;
        self
    }

    /// Returns the current at a constant velocity in units of the list, long after the last reversal.
    pub(crate) fn steady(&mut self, speed_units: f64) -> f64 {
        self.friction(speed_units) * self.scaling
    }

    /// Returns the number of later velocities that [`step`](Self::step) needs, P-COMP-00044.
    pub fn lookahead(&self) -> usize {
        self.lookahead
    }

    /// Returns the number of outputs limited to 16 bit so far (R4.11).
    pub fn saturated(&self) -> u64 {
        self.saturated
    }

    /// Returns the number of cycles so far in which the axis was at standstill and the readings of R4.6 differ: `hold`
    /// adds a current there, `zero` adds nothing (C11).
    pub fn at_rest(&self) -> u64 {
        self.at_rest
    }

    /// Replaces everything by `fresh`, except the count of outputs that were limited so far.
    pub(super) fn restart_as(&mut self, fresh: &Self) {
        let (saturated, at_rest) = (self.saturated, self.at_rest);
        self.clone_from(fresh);
        (self.saturated, self.at_rest) = (saturated, at_rest);
    }

    /// Switches as `COMP ON FRICT` and `COMP OFF FRICT` do: off, the output is 0 at once and the
    /// delay line empty; on, the next motion is a first start (R4.10).
    pub fn switch(&mut self, switched: Switched) {
        let on = switched == Switched::On;
        if on == self.active {
            return;
        }
        self.active = on;
        self.line.clear();
        self.positions.clear();
        if on {
            self.direction = 0.0;
            self.build_up = None;
        }
    }

    /// Returns the current of the next cycle (4.1 of the rules).
    ///
    /// `position` is the commanded position in 0.1 µm or 0.0001°, `velocity` the commanded
    /// velocity in µm/s or 0.001°/s, `upcoming` the velocities of the next cycles, as many of the
    /// next [`lookahead`](Self::lookahead) as there are.
    pub fn step(&mut self, position: f64, velocity: f64, upcoming: &[f64]) -> Added {
        let direction = self.direction_at(velocity);
        let mut upcoming = upcoming.iter().take(self.lookahead);
        let reversal = upcoming.position(|velocity| velocity * direction < 0.0);
        self.advance(position, velocity, reversal)
    }

    /// Returns the direction of the next cycle.
    fn direction_at(&self, velocity: f64) -> f64 {
        if velocity == 0.0 {
            self.direction
        } else {
            velocity.signum()
        }
    }

    /// Returns the current of the next cycle, whose direction ends after `reversal` more cycles: `r[k]` of the rules,
    /// `None` if there is no reversal within the look-ahead.
    pub(super) fn advance(
        &mut self,
        position: f64,
        velocity: f64,
        reversal: Option<usize>,
    ) -> Added {
        let before = self.last_position.unwrap_or(position);
        self.last_position = Some(position);
        if velocity != 0.0 {
            let direction = velocity.signum();
            let starts = self.is_standing && self.reading.start == Start::Every;
            if direction * self.direction <= 0.0 || starts {
                let waits = match self.reading.delay {
                    Delay::All => 0,
                    Delay::Reversal => self.delay_cycles,
                };
                self.build_up = Some(BuildUp {
                    from: before,
                    waits,
                });
                self.positions.clear();
            }
            self.direction = direction;
        }
        self.is_standing = velocity == 0.0;
        let w_after = self.weight_after(position);
        let w_before = self.weight_before(reversal);
        let mut raw =
            self.direction * self.friction(velocity.abs()) * self.scaling * w_before.min(w_after);
        if self.is_standing && raw != 0.0 && self.active {
            self.at_rest += 1;
        }
        if self.is_standing && self.reading.standstill == Standstill::Zero {
            raw = 0.0;
        }
        // Adding 0 turns -0 into 0.
        let current = self.delayed(raw) + 0.0;
        Added {
            w_before,
            w_after,
            current_units: current,
            output: self.rounded(current * self.torque_scale),
        }
    }

    /// Returns the currents of a whole trace of positions and velocities of the same length.
    pub fn trace(&mut self, positions: &[f64], velocities: &[f64]) -> Vec<Added> {
        // The first cycle after the current one with the opposite direction; searched once per reversal.
        let mut turn = 0;
        let mut sought = 0.0;
        positions
            .iter()
            .zip(velocities)
            .enumerate()
            .map(|(at, (&position, &velocity))| {
                let direction = self.direction_at(velocity);
                if turn <= at || direction.to_bits() != f64::to_bits(sought) {
                    sought = direction;
                    let later = &velocities[at + 1..];
                    let found = later.iter().position(|later| later * direction < 0.0);
                    turn = found.map_or(usize::MAX, |found| at + 1 + found);
                }
                let reversal = Some(turn - 1 - at).filter(|cycles| *cycles < self.lookahead);
                self.advance(position, velocity, reversal)
            })
            .collect()
    }

    /// Returns the current, linear over the distance since the reversal (R4.3).
    fn weight_after(&mut self, position: f64) -> f64 {
        let Some(build_up) = &mut self.build_up else {
            return 1.0;
        };
        let mut position = position;
        if self.reading.delay == Delay::Reversal && self.delay_cycles > 0 {
            self.positions.push_back(position);
            if build_up.waits > 0 {
                build_up.waits -= 1;
                return 0.0;
            }
            position = self.positions.pop_front().unwrap_or(position);
        }
        let weight = if self.position_delay == 0.0 {
            1.0
        } else {
            ((position - build_up.from).abs() / self.position_delay).min(1.0)
        };
        if weight >= 1.0 {
            self.build_up = None;
        }
        weight
    }

    /// Returns the current, linear over the cycles up to the next reversal, or none in them (R4.2).
    fn weight_before(&self, reversal: Option<usize>) -> f64 {
        match reversal {
            Some(_) if self.reading.decay == Decay::Step => 0.0,
            #[allow(clippy::cast_precision_loss)] // at most 65535 cycles
            Some(cycles) => cycles as f64 / self.lookahead as f64,
            None => 1.0,
        }
    }

    /// Returns the value list: linear between points, held outside (R4.7).
    fn friction(&mut self, speed: f64) -> f64 {
        // Mostly the speed lies between the same points as in the last cycle.
        let below = self
            .above
            .checked_sub(1)
            .map(|below| self.table[below].input);
        let beyond = self.table.get(self.above).map(|point| point.input);
        let same =
            below.is_none_or(|input| input <= speed) && beyond.is_none_or(|input| input > speed);
        if !same {
            self.above = self.table.partition_point(|point| point.input <= speed);
        }
        let above = self.above;
        match (above.checked_sub(1), self.table.get(above)) {
            (None, None) => 0.0,
            (None, Some(first)) => match self.reading.below {
                Below::Hold => first.output,
                Below::Origin => first.output * speed / first.input,
            },
            (Some(last), None) => self.table[last].output,
            (Some(below), Some(next)) => {
                let below = self.table[below];
                let part = (speed - below.input) / (next.input - below.input);
                below.output + part * (next.output - below.output)
            }
        }
    }

    /// Returns the dead time on the whole output (R4.5); 0 while the delay line fills.
    fn delayed(&mut self, raw: f64) -> f64 {
        if !self.active {
            return 0.0;
        }
        if self.reading.delay == Delay::Reversal || self.delay_cycles == 0 {
            return raw;
        }
        self.line.push_back(raw);
        if self.line.len() > self.delay_cycles {
            self.line.pop_front().unwrap_or_default()
        } else {
            0.0
        }
    }

    fn rounded(&mut self, current: f64) -> i16 {
        let bounds = (f64::from(i16::MIN), f64::from(i16::MAX));
        let limited = current.clamp(bounds.0, bounds.1);
        // A call of the mathematical library would cost more than everything else.
        #[allow(clippy::cast_possible_truncation)] // clamped just above
        let whole = limited as i16;
        let rest = limited - f64::from(whole);
        let away = i16::from(rest >= 0.5) - i16::from(rest <= -0.5);
        if current >= bounds.1 + 0.5 || current <= bounds.0 - 0.5 {
            self.saturated += 1;
        }
        whole + away
    }
}
