//! The path in CNC cycles.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::profile::VelocityProfile;
use super::segment::PathSegment;
use super::trace::{Cause, Dwell, Sample, TraceSink};
use frictcomp::comp::AxisIndex;

/// Follows profiles in steps of a CNC cycle.
pub(super) struct Sampler {
    followed: Vec<usize>,
    /// Seconds of a cycle.
    cycle: f64,
    /// Cycles per second, if they are whole: times are decimals then, such as 0.003.
    rate: Option<f64>,
    /// The number of the next cycle.
    next: u64,
    /// End of the planned path, in seconds.
    end: f64,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    path_velocity: f64,
    programmed_velocity: f64,
    /// The last block that was followed.
    last: Option<Arc<Cause>>,
    /// Limit of the cycles.
    budget: u64,
    over: bool,
}

impl Sampler {
    pub(super) fn new(followed: &[AxisIndex], cycle: f64, budget: u64) -> Self {
        Self {
            followed: followed.iter().map(|axis| axis.get()).collect(),
            cycle,
            rate: whole(1.0 / cycle),
            next: 0,
            end: 0.0,
            positions: vec![0.0; followed.len()],
            velocities: vec![0.0; followed.len()],
            path_velocity: 0.0,
            programmed_velocity: 0.0,
            last: None,
            budget,
            over: false,
        }
    }

    pub(super) fn cycle(&self) -> f64 {
        self.cycle
    }

    /// Returns the time of the next cycle, in seconds.
    pub(super) fn time_s(&self) -> f64 {
        #[allow(clippy::cast_precision_loss)] // a trace is shorter than 2^53 cycles
        let next = self.next as f64;
        match self.rate {
            Some(rate) => next / rate,
            None => next * self.cycle,
        }
    }

    /// Follows segments with a profile that spans them.
    pub(super) fn follow(
        &mut self,
        segments: impl Iterator<Item = PathSegment>,
        profile: &VelocityProfile,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let start = self.end;
        self.end = start + profile.duration_s();
        let mut segments = segments.peekable();
        // The distance along the profile at which the segment begins.
        let mut passed = 0.0;
        while let Some(segment) = segments.next() {
            let is_last = segments.peek().is_none();
            self.programmed_velocity = segment.feed;
            while self.time_s() <= self.end {
                let state = profile.at(self.time_s() - start);
                let way = state.distance - passed;
                if way > segment.length && !is_last {
                    break;
                }
                for (place, &axis) in self.followed.iter().enumerate() {
                    let [position, slope] = segment.place(axis, way);
                    self.positions[place] = position;
                    // Adding 0 turns -0 into 0.
                    self.velocities[place] = slope * state.velocity + 0.0;
                }
                self.path_velocity = state.velocity;
                self.emit(&segment.cause, sink)?;
            }
            passed += segment.length;
            if is_last {
                for (place, &axis) in self.followed.iter().enumerate() {
                    self.positions[place] = segment.position(axis, segment.length);
                }
                self.last = Some(segment.cause);
            }
        }
        ControlFlow::Continue(())
    }

    /// Rests at the end of the path.
    pub(super) fn rest(&mut self, dwell: Dwell<'_>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        let Dwell { seconds, cause } = dwell;
        self.end += seconds;
        self.halt();
        self.last = Some(Arc::clone(cause));
        while self.time_s() <= self.end {
            self.emit(cause, sink)?;
        }
        ControlFlow::Continue(())
    }

    /// Adds one more cycle, so that the axes are seen at rest at the end of the path.
    pub(super) fn settle(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.halt();
        if let Some(cause) = self.last.take() {
            self.emit(&cause, sink)?;
            self.end = self.time_s();
        }
        ControlFlow::Continue(())
    }

    /// Stops the axes.
    fn halt(&mut self) {
        self.velocities.fill(0.0);
        self.path_velocity = 0.0;
    }

    /// Returns whether more cycles than the budget were needed.
    pub(super) fn is_over(&self) -> bool {
        self.over
    }

    fn emit(&mut self, cause: &Arc<Cause>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.over = self.next >= self.budget;
        if self.over {
            return ControlFlow::Break(());
        }
        let time_s = self.time_s();
        self.next += 1;
        sink.sample(&Sample {
            time_s,
            positions: &self.positions,
            velocities: &self.velocities,
            path_velocity: self.path_velocity,
            programmed_velocity: self.programmed_velocity,
            cause,
        })
    }
}

/// Returns a number that is whole apart from its rounding.
fn whole(number: f64) -> Option<f64> {
    let near = number.round();
    (near >= 1.0 && (number - near).abs() <= 1e-12 * near).then_some(near)
}
