//! The currents of several axes while their commanded trace comes in.

use std::collections::VecDeque;

use super::{AdditiveCurrent, Cycle, Switched};
use crate::compensation::State;

/// What is commanded to one axis in one cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// In 0.1 µm or 0.0001°.
    pub position: f64,
    /// In µm/s or 0.001°/s.
    pub velocity: f64,
    /// The friction compensation of the axis.
    pub friction: State,
}

/// One axis in one cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// What was commanded.
    pub input: Input,
    /// What is added. Only in the state `active` it is not 0; in the state `unknown` nobody knows
    /// it, and this is what an axis without compensation gets.
    pub cycle: Cycle,
}

/// Follows several axes at once, in constant memory: the decay before a reversal has to be known
/// some cycles ahead, so that the currents come out as many cycles later (R4.2).
pub struct Followers {
    axes: Vec<Follower>,
    /// How many cycles the currents lag behind.
    lag: usize,
    moments: Vec<Moment>,
}

struct Follower {
    current: AdditiveCurrent,
    /// As it was before the first cycle.
    fresh: AdditiveCurrent,
    waiting: VecDeque<Input>,
    /// How many cycles went out.
    out: u64,
    /// The cycles in which the commanded direction changes, as far as they are ahead.
    turns: VecDeque<u64>,
    direction: f64,
}

impl Followers {
    /// Followers of axes with these computations, before their first cycle.
    pub fn new(currents: Vec<AdditiveCurrent>) -> Self {
        let lag = currents.iter().map(AdditiveCurrent::lookahead).max();
        Self {
            axes: currents.into_iter().map(Follower::new).collect(),
            lag: lag.unwrap_or_default(),
            moments: Vec::new(),
        }
    }

    /// Takes the next cycle, one input an axis, and gives back the cycle that is ready now.
    pub fn push(&mut self, inputs: impl IntoIterator<Item = Input>) -> Option<&[Moment]> {
        for (axis, input) in self.axes.iter_mut().zip(inputs) {
            axis.push(input);
        }
        if self.axes.first()?.waiting.len() > self.lag {
            return self.pop();
        }
        None
    }

    /// The next of the cycles that are left when no more come.
    pub fn pop(&mut self) -> Option<&[Moment]> {
        let moments = self.axes.iter_mut().map_while(Follower::pop);
        self.moments.clear();
        self.moments.extend(moments);
        (!self.moments.is_empty()).then_some(&*self.moments)
    }

    /// Begins anew: whatever moves next is a first start. The cycles that are left are forgotten.
    pub fn restart(&mut self) {
        for axis in &mut self.axes {
            axis.waiting.clear();
            axis.turns.clear();
            axis.direction = 0.0;
            axis.out = 0;
            let saturated = axis.current.saturated;
            axis.current.clone_from(&axis.fresh);
            axis.current.saturated = saturated;
        }
    }

    /// How many outputs of each axis were cut to 16 bit so far (R4.11).
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

    fn push(&mut self, input: Input) {
        if input.velocity * self.direction < 0.0 {
            let ahead = u64::try_from(self.waiting.len()).unwrap_or(u64::MAX);
            self.turns.push_back(self.out.saturating_add(ahead));
        }
        if input.velocity != 0.0 {
            self.direction = input.velocity.signum();
        }
        self.waiting.push_back(input);
    }

    fn pop(&mut self) -> Option<Moment> {
        let input = self.waiting.pop_front()?;
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
        self.current.switch(match input.friction {
            State::Active => Switched::On,
            _ => Switched::Off,
        });
        let cycle = self
            .current
            .advance(input.position, input.velocity, reversal);
        Some(Moment { input, cycle })
    }
}
