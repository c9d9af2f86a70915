//! The queue of legs between look-ahead and sampling.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::junction::{Junction, Share};
use super::leg::Leg;
use super::limits::AxisLimits;
use super::plan::{Stage, Stretch, plan};
use super::sampler::Sampler;
use super::{Cause, Cycles};

/// How many legs the look-ahead sees at once. The path is planned to a stop behind the last one;
/// half of the plan is kept, the rest is planned anew when more legs are known.
const LOOK_AHEAD: usize = 4096;

/// What is known of the path and not sampled yet.
pub(super) struct Course {
    limits: Vec<AxisLimits>,
    queue: VecDeque<Queued>,
    /// The path velocity at the start of the first leg in the queue.
    velocity: f64,
    /// What is left of the last plan.
    left: Vec<Stretch>,
    sampler: Sampler,
}

/// A leg and the transition into it.
struct Queued {
    leg: Leg,
    entry: Junction,
    share: Share,
}

impl Course {
    pub(super) fn new(limits: Vec<AxisLimits>, sampler: Sampler) -> Self {
        Self {
            limits,
            queue: VecDeque::new(),
            velocity: 0.0,
            left: Vec::new(),
            sampler,
        }
    }

    /// The sampled seconds.
    pub(super) fn time(&self) -> f64 {
        self.sampler.time()
    }

    /// Adds the next leg, which begins where the last one ends.
    pub(super) fn add(&mut self, leg: Leg, cycles: &mut dyn Cycles) -> ControlFlow<()> {
        let cycle = self.sampler.cycle();
        let entry = match self.queue.back() {
            Some(last) => Junction::between(&last.leg, &leg, &self.limits, cycle),
            None => Junction::Stop,
        };
        if entry == Junction::Stop {
            self.drain(cycles)?;
        }
        let mut share = Share::Whole;
        if entry.is_kink() {
            share = Share::BesideKink;
            if let Some(last) = self.queue.back_mut() {
                last.share = share;
            }
        }
        self.queue.push_back(Queued { leg, entry, share });
        if self.queue.len() >= LOOK_AHEAD {
            self.advance(cycles)?;
        }
        ControlFlow::Continue(())
    }

    /// Whether the budget of cycles is used up.
    pub(super) fn is_over(&self) -> bool {
        self.sampler.is_over()
    }

    /// Lets the axes rest.
    pub(super) fn rest(
        &mut self,
        seconds: f64,
        cause: &Arc<Cause>,
        cycles: &mut dyn Cycles,
    ) -> ControlFlow<()> {
        self.drain(cycles)?;
        self.sampler.rest(seconds, cause, cycles)
    }

    /// Follows the path to its end and stops there.
    pub(super) fn stop(&mut self, cycles: &mut dyn Cycles) -> ControlFlow<()> {
        self.drain(cycles)?;
        self.sampler.settle(cycles)
    }

    /// Follows all legs of the queue to a stop.
    fn drain(&mut self, cycles: &mut dyn Cycles) -> ControlFlow<()> {
        if self.queue.is_empty() {
            return ControlFlow::Continue(());
        }
        let stretches = self.plan();
        self.left.clear();
        self.follow(&stretches, cycles)?;
        self.velocity = 0.0;
        ControlFlow::Continue(())
    }

    /// Follows the first half of the legs.
    fn advance(&mut self, cycles: &mut dyn Cycles) -> ControlFlow<()> {
        let mut stretches = self.plan();
        let mut kept = self.cut(&mut stretches);
        if kept == 0 {
            // The path speeds up or slows down over half of the queue: it has to be cut there.
            let middle = &mut self.queue[LOOK_AHEAD / 2].entry;
            *middle = middle.fixed();
            stretches = self.plan();
            kept = self.cut(&mut stretches).max(1);
        }
        self.left = stretches.split_off(kept);
        self.follow(&stretches, cycles)?;
        self.velocity = stretches.last().map_or(0.0, |last| last.end_velocity);
        ControlFlow::Continue(())
    }

    /// How many stretches lie in the first half of the queue; the next one is cut in two where
    /// that changes nothing.
    fn cut(&self, stretches: &mut Vec<Stretch>) -> usize {
        let (mut kept, mut legs) = (0, 0);
        while let Some(stretch) = stretches.get(kept)
            && legs + stretch.legs <= LOOK_AHEAD / 2
        {
            legs += stretch.legs;
            kept += 1;
        }
        let half = self.queue.range(legs..LOOK_AHEAD / 2);
        let lengths = half.map(|queued| queued.leg.length);
        if let Some((first, second)) = stretches.get(kept).and_then(|next| next.cut(lengths)) {
            stretches.splice(kept..=kept, [first, second]);
            kept += 1;
        }
        kept
    }

    /// A plan for the whole queue.
    fn plan(&mut self) -> Vec<Stretch> {
        let stages: Vec<Stage> = self.queue.iter().map(|queued| self.stage(queued)).collect();
        if let Some(stretches) = plan(&stages, self.velocity) {
            return stretches;
        }
        // The transitions of the new legs leave no way from the velocity of the moment: the old
        // plan is followed to its stop, the new legs begin there.
        let mut stretches = std::mem::take(&mut self.left);
        let planned = stretches.iter().map(|stretch| stretch.legs).sum();
        stretches.extend(plan(&stages[planned..], 0.0).unwrap_or_default());
        stretches
    }

    fn stage(&self, queued: &Queued) -> Stage {
        Stage {
            length: queued.leg.length,
            bounds: queued.leg.bounds(&self.limits, queued.share),
            entry: queued.entry,
        }
    }

    fn follow(&mut self, stretches: &[Stretch], cycles: &mut dyn Cycles) -> ControlFlow<()> {
        for stretch in stretches {
            let legs = self.queue.drain(..stretch.legs).map(|queued| queued.leg);
            self.sampler.follow(legs, &stretch.profile, cycles)?;
        }
        ControlFlow::Continue(())
    }
}
