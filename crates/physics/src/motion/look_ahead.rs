//! The queue of segments between planning and sampling.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use super::junction::Junction;
use super::limits::{AxisLimits, MachineLimits};
use super::plan::{PlanInput, ProfileSpan, plan};
use super::profile::{Bounds, RampForm};
use super::sampler::Sampler;
use super::segment::PathSegment;
use super::share::Share;
use super::trace::{Dwell, Movement, TraceSink};
use frictcomp::interpreter::BlockEnd;
use frictcomp::lists::SlopeProfile;

/// Number of segments planned together. The path is planned to a stop after the last one; half of
/// the plan is kept, the rest is planned again when more segments are known.
const CAPACITY: usize = 4096;

/// Known path that has not been sampled yet.
pub(super) struct LookAhead {
    limits: MachineLimits,
    queue: VecDeque<Queued>,
    /// The path velocity at the start of the first segment in the queue.
    velocity: f64,
    /// Rest of the last plan.
    left: Vec<ProfileSpan>,
    sampler: Sampler,
    slow_kinks: u64,
}

/// The share of F below which a kink is slow (R11.23).
const REACHED: f64 = 0.8;

/// A segment and the transition into it.
struct Queued {
    segment: PathSegment,
    entry: Junction,
    share: Share,
}

impl LookAhead {
    pub(super) fn new(limits: MachineLimits, sampler: Sampler) -> Self {
        Self {
            limits,
            queue: VecDeque::new(),
            velocity: 0.0,
            left: Vec::new(),
            sampler,
            slow_kinks: 0,
        }
    }

    /// Returns the path velocity along a segment at which one axis moves at its limit.
    pub(super) fn fastest(&self, segment: &PathSegment) -> f64 {
        segment.fastest(self.limits_of(segment))
    }

    fn limits_of(&self, segment: &PathSegment) -> &[AxisLimits] {
        self.limits.during(segment.cause.movement, segment.slope)
    }

    fn ramps_of(&self, segment: &PathSegment) -> RampForm {
        match self.limits.profile(segment.slope) {
            SlopeProfile::Sin2 => RampForm::SineSquared,
            _ => RampForm::Linear,
        }
    }

    /// Returns the sampled seconds.
    pub(super) fn time_s(&self) -> f64 {
        self.sampler.time_s()
    }

    /// Returns the number of kinks between feed moves that are passed below 80 % of F.
    pub(super) fn slow_kinks(&self) -> u64 {
        self.slow_kinks
    }

    /// Adds the next segment, which begins where the last one ends.
    pub(super) fn add(
        &mut self,
        segment: PathSegment,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let cycle = self.sampler.cycle();
        let entry = match self.queue.back() {
            Some(last) => {
                let limits = self.limits_of(&segment);
                let junction = Junction::between(&last.segment, &segment, limits, cycle);
                // Each stretch of the path has one form of ramps.
                if self.ramps_of(&last.segment) == self.ramps_of(&segment) {
                    junction
                } else {
                    junction.fixed()
                }
            }
            None => Junction::Stop,
        };
        self.slow_kinks += u64::from(self.is_slow(entry, &segment));
        if entry == Junction::Stop {
            self.drain(sink)?;
        }
        let mut share = Share::Whole;
        if entry.is_kink() {
            share = Share::BesideKink;
            if let Some(last) = self.queue.back_mut() {
                last.share = share;
            }
        }
        self.queue.push_back(Queued {
            segment,
            entry,
            share,
        });
        if self.queue.len() >= CAPACITY {
            self.advance(sink)?;
        }
        ControlFlow::Continue(())
    }

    /// Returns whether a kink between feed moves slows the path down, rather than the program.
    fn is_slow(&self, entry: Junction, next: &PathSegment) -> bool {
        let Some(Queued { segment: last, .. }) = self.queue.back() else {
            return false;
        };
        let is_feed = |segment: &PathSegment| segment.cause.movement == Movement::Feed;
        let is_kink = entry.is_kink() || entry == Junction::Stop;
        is_kink
            && last.end == BlockEnd::Through
            && is_feed(last)
            && is_feed(next)
            && entry.velocity() < REACHED * next.feed.min(last.end_velocity)
    }

    /// Returns whether the budget of cycles is used up.
    pub(super) fn is_over(&self) -> bool {
        self.sampler.is_over()
    }

    /// Holds the axes at rest.
    pub(super) fn rest(&mut self, dwell: Dwell<'_>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.drain(sink)?;
        self.sampler.rest(dwell, sink)
    }

    /// Follows the path to its end and stops there.
    pub(super) fn stop(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.drain(sink)?;
        self.sampler.settle(sink)
    }

    /// Follows all segments of the queue to a stop.
    fn drain(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        if self.queue.is_empty() {
            return ControlFlow::Continue(());
        }
        let stretches = self.plan();
        self.left.clear();
        self.follow(&stretches, sink)?;
        self.velocity = 0.0;
        ControlFlow::Continue(())
    }

    /// Follows the first half of the segments.
    fn advance(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        let mut stretches = self.plan();
        let mut kept = self.cut(&mut stretches);
        if kept == 0 {
            // The path speeds up or slows down over half of the queue: it has to be cut there.
            let middle = &mut self.queue[CAPACITY / 2].entry;
            *middle = middle.fixed();
            stretches = self.plan();
            kept = self.cut(&mut stretches).max(1);
        }
        self.left = stretches.split_off(kept);
        self.follow(&stretches, sink)?;
        self.velocity = stretches.last().map_or(0.0, |last| last.end_velocity);
        ControlFlow::Continue(())
    }

    /// Returns the number of stretches in the first half of the queue; the next one is cut in two if that
    /// changes nothing.
    fn cut(&self, stretches: &mut Vec<ProfileSpan>) -> usize {
        let (mut kept, mut segments) = (0, 0);
        while let Some(stretch) = stretches.get(kept)
            && segments + stretch.segments <= CAPACITY / 2
        {
            segments += stretch.segments;
            kept += 1;
        }
        let half = self.queue.range(segments..CAPACITY / 2);
        let lengths = half.map(|queued| queued.segment.length);
        if let Some((first, second)) = stretches.get(kept).and_then(|next| next.cut(lengths)) {
            stretches.splice(kept..=kept, [first, second]);
            kept += 1;
        }
        kept
    }

    /// Returns a plan for the whole queue.
    fn plan(&mut self) -> Vec<ProfileSpan> {
        let stages: Vec<PlanInput> = self.queue.iter().map(|queued| self.stage(queued)).collect();
        if let Some(stretches) = plan(&stages, self.velocity) {
            return stretches;
        }
        // The transitions of the new segments cannot be reached from the present velocity: the old plan
        // is followed to its stop, the new segments begin there.
        let mut stretches = std::mem::take(&mut self.left);
        let planned = stretches.iter().map(|stretch| stretch.segments).sum();
        stretches.extend(plan(&stages[planned..], 0.0).unwrap_or_default());
        stretches
    }

    fn stage(&self, queued: &Queued) -> PlanInput {
        let segment = &queued.segment;
        PlanInput {
            length: segment.length,
            bounds: Bounds {
                ramps: self.ramps_of(segment),
                ..segment.bounds(self.limits_of(segment), queued.share)
            },
            entry: queued.entry,
        }
    }

    fn follow(&mut self, stretches: &[ProfileSpan], sink: &mut dyn TraceSink) -> ControlFlow<()> {
        for stretch in stretches {
            let segments = self
                .queue
                .drain(..stretch.segments)
                .map(|queued| queued.segment);
            self.sampler.follow(segments, &stretch.profile, sink)?;
        }
        ControlFlow::Continue(())
    }
}
