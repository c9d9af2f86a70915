//! The currents of several axes while their commanded trace is read.

use std::collections::VecDeque;

use super::additive::{Added, AdditiveCurrent, Switched};
use frictcomp::comp::State;

/// Commanded motion of one axis in one cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Commanded {
    /// The position in units of 0.1 µm or 0.0001°.
    pub position_units: f64,
    /// The velocity in units of 1 µm/s or 0.001°/s.
    pub velocity_units: f64,
    /// The friction compensation of the axis.
    pub friction: State,
}

/// One axis in one cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CurrentSample {
    /// Commanded motion.
    pub commanded: Commanded,
    /// Additive current. It is 0 in every state but `active`; in the state `unknown` it is not
    /// known, and this is the value of an axis without compensation.
    pub added: Added,
}

/// Follows several axes at once, in constant memory: the decay before a reversal has to be known
/// some cycles ahead, so that the currents are delayed by as many cycles (R4.2).
pub struct Followers {
    axes: Vec<Follower>,
    /// Lag of the currents in cycles.
    lag: usize,
    samples: Vec<CurrentSample>,
}

struct Follower {
    current: AdditiveCurrent,
    /// The computation before the first cycle.
    fresh: AdditiveCurrent,
    waiting: VecDeque<Commanded>,
    /// Number of cycles given out.
    out: u64,
    /// The cycles in which the commanded direction changes, if they are ahead.
    turns: VecDeque<u64>,
    direction: f64,
}

impl Followers {
    /// Creates followers of axes with these computations, before their first cycle.
    pub fn new(currents: Vec<AdditiveCurrent>) -> Self {
        let lag = currents.iter().map(AdditiveCurrent::lookahead).max();
        Self {
            axes: currents.into_iter().map(Follower::new).collect(),
            lag: lag.unwrap_or_default(),
            samples: Vec::new(),
        }
    }

    /// Takes the commanded values of each axis in the next cycle, and returns the cycle that is ready now.
    pub fn push(
        &mut self,
        commanded: impl IntoIterator<Item = Commanded>,
    ) -> Option<&[CurrentSample]> {
        for (axis, commanded) in self.axes.iter_mut().zip(commanded) {
            axis.push(commanded);
        }
        if self.axes.first()?.waiting.len() > self.lag {
            return self.pop();
        }
        None
    }

    /// Returns the next of the remaining cycles after the end of the trace.
    pub fn pop(&mut self) -> Option<&[CurrentSample]> {
        let samples = self.axes.iter_mut().map_while(Follower::pop);
        self.samples.clear();
        self.samples.extend(samples);
        (!self.samples.is_empty()).then_some(&*self.samples)
    }

    /// Restarts: the next motion is a first start. The remaining cycles are dropped.
    pub fn restart(&mut self) {
        for axis in &mut self.axes {
            axis.waiting.clear();
            axis.turns.clear();
            axis.direction = 0.0;
            axis.out = 0;
            axis.current.restart_as(&axis.fresh);
        }
    }

    /// Returns the number of cycles at standstill in which R4.6 matters, by axis; see [`AdditiveCurrent::at_rest`].
    pub fn at_rest(&self) -> impl Iterator<Item = u64> {
        self.axes.iter().map(|axis| axis.current.at_rest())
    }

    /// Returns the number of outputs of each axis limited to 16 bit so far (R4.11).
    pub fn saturated(&self) -> impl Iterator<Item = u64> {
        self.axes.iter().map(|axis| axis.current.saturated())
    }
}

impl Follower {
    fn new(current: AdditiveCurrent) -> Self {
        Self {
            fresh: current.clone(),
            current,
            waiting: VecDeque::new(),
            out: 0,
            turns: VecDeque::new(),
            direction: 0.0,
        }
    }

    fn push(&mut self, commanded: Commanded) {
        if commanded.velocity_units * self.direction < 0.0 {
            let ahead = u64::try_from(self.waiting.len()).unwrap_or(u64::MAX);
            self.turns.push_back(self.out.saturating_add(ahead));
        }
        if commanded.velocity_units != 0.0 {
            self.direction = commanded.velocity_units.signum();
        }
        self.waiting.push_back(commanded);
    }

    fn pop(&mut self) -> Option<CurrentSample> {
        let commanded = self.waiting.pop_front()?;
        let at = self.out;
        self.out += 1;
        if self.turns.front().is_some_and(|turn| *turn <= at) {
            self.turns.pop_front();
        }
        let cycles = self.turns.front().map(|turn| turn - 1 - at);
        let lookahead = self.current.lookahead();
        let reversal = cycles
            .and_then(|cycles| usize::try_from(cycles).ok())
            .filter(|cycles| *cycles < lookahead);
        self.current.switch(match commanded.friction {
            State::Active => Switched::On,
            _ => Switched::Off,
        });
        let added =
            self.current
                .advance(commanded.position_units, commanded.velocity_units, reversal);
        Some(CurrentSample { commanded, added })
    }
}
