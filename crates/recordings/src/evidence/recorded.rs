//! The recording of an axis.

use frictcomp_physics::current::{
    CommandedRow, CommandedTrace, CyclesError, Resampling, Switched, TraceColumns, TraceOptions,
};

/// The longest CNC cycle that is taken from the step of a recording.
const LONGEST_CYCLE_S: f64 = 0.0045;

/// The CNC cycle if neither the user nor the recording gives it.
const USUAL_CYCLE_S: f64 = 0.001;

/// Maximum number of cycles in a step that still counts as one sample per cycle.
const ONE_CYCLE: f64 = 1.25;

/// Number of usual steps from which a step is a gap.
const GAP: f64 = 5.5;

/// Samples with their times in seconds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    /// The times, rising.
    pub times_s: Vec<f64>,
    /// The values.
    pub values: Vec<f64>,
}

/// The recording of one axis, in the units of lists and traces.
#[derive(Debug, Clone, Default)]
pub struct EvidenceRecording {
    /// The times of the commanded motion.
    pub times_s: Vec<f64>,
    /// Commanded positions in 0.1 µm or 0.0001°.
    pub positions: Option<Vec<f64>>,
    /// Commanded velocities in µm/s or 0.001°/s.
    pub velocities: Option<Vec<f64>>,
    /// The additive current in drive units, on its own clock.
    pub current: Option<Samples>,
    /// State of friction compensation, 0 or 1, on its own clock.
    pub state: Option<Samples>,
    /// The CNC cycle, if it is known.
    pub cycle_s: Option<f64>,
    /// The factor that multiplies the recorded current on its way to the drive (R7.8); 1 before it.
    pub torque_scale: f64,
}

/// The motion of the axis in CNC cycles.
pub(super) struct CycleMotion {
    pub(super) trace: CommandedTrace,
    pub(super) rows: Vec<CommandedRow>,
    pub(super) cycle_s: f64,
}

impl Samples {
    /// Returns the value at a time: that of the last sample up to it.
    pub(super) fn at(&self, time_s: f64) -> Option<f64> {
        let after = self.times_s.partition_point(|it| *it <= time_s);
        self.values.get(after.checked_sub(1)?).copied()
    }
}

impl EvidenceRecording {
    /// Returns the motion in CNC cycles, compensation switched as recorded.
    ///
    /// # Errors
    /// The times are not those of a recording, or have a gap.
    pub(super) fn motion(&self) -> Result<CycleMotion, String> {
        let clocks = [
            Some(&self.times_s),
            self.current.as_ref().map(|it| &it.times_s),
        ];
        for times in clocks.into_iter().flatten() {
            if let Some(time) = gap(times) {
                return Err(format!("the recording has a gap at {time:.3} s"));
            }
        }
        let cycle_s = self.cycle_s();
        let switched = |time: &f64| match self.state.as_ref().and_then(|it| it.at(*time)) {
            Some(0.0) => Switched::Off,
            _ => Switched::On,
        };
        let columns = TraceColumns {
            switched: self.times_s.iter().map(switched).collect(),
            times_s: Some(self.times_s.clone()),
            positions: self.positions.clone(),
            velocities: self.velocities.clone(),
        };
        let options = TraceOptions::default()
            .with_cycle_s(Some(cycle_s))
            .with_resampling(Resampling::Done);
        let trace = CommandedTrace::new(columns, options);
        let trace = trace.map_err(|error: CyclesError| error.to_string())?;
        Ok(CycleMotion {
            rows: trace.rows().collect(),
            trace,
            cycle_s,
        })
    }

    fn cycle_s(&self) -> f64 {
        let of_motion = step(&self.times_s).filter(|step| *step <= LONGEST_CYCLE_S);
        self.cycle_s.or(of_motion).unwrap_or(USUAL_CYCLE_S)
    }

    /// Returns the step of the slower of motion and current.
    pub(super) fn step_s(&self) -> f64 {
        let current = self.current.as_ref().and_then(|it| step(&it.times_s));
        let motion = step(&self.times_s);
        motion.into_iter().chain(current).fold(0.0, f64::max)
    }

    /// Returns whether each CNC cycle was recorded.
    pub(super) fn has_every_cycle(&self) -> bool {
        self.step_s() <= ONE_CYCLE * self.cycle_s()
    }
}

/// Returns the usual step of times.
pub(super) fn step(times_s: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return None;
    }
    Some(*steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Returns the time at which a gap begins.
fn gap(times_s: &[f64]) -> Option<f64> {
    let usual = step(times_s)?;
    let mut pairs = times_s.windows(2);
    pairs
        .find(|pair| pair[1] - pair[0] > GAP * usual)
        .map(|pair| pair[0])
}
