//! The recorded current, compared with the currents of all combinations of readings.

use super::recorded::{CycleMotion, EvidenceRecording};
use frictcomp::lists::FrictionList;
use frictcomp_physics::current::{AdditiveCurrent, Reading, Switched};

/// Cycles by which current and motion of a recording may be apart.
const SHIFTS: [isize; 5] = [0, 1, -1, 2, -2];

/// Cycles around a switch of the state that do not count.
const AROUND: usize = 3;

/// The samples of the current that count, on the cycles of the motion.
pub(super) struct Counted {
    /// The cycle and the current of each.
    pub(super) samples: Vec<(usize, f64)>,
}

/// A combination of readings, and the number of cycles by which the current follows the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hypothesis {
    pub(super) reading: Reading,
    pub(super) shift: isize,
}

/// A hypothesis with the current that it gives for each sample.
#[derive(Debug, Clone)]
pub(super) struct Explained {
    pub(super) hypothesis: Hypothesis,
    pub(super) currents: Vec<f64>,
}

/// The currents of a value list for a recorded motion.
pub(super) struct Model<'a> {
    pub(super) motion: &'a CycleMotion,
    pub(super) list: &'a FrictionList,
    pub(super) torque_scale: f64,
}

impl Counted {
    /// Returns the samples in which the current does not depend on anything before the recording, or before
    /// compensation was switched on.
    pub(super) fn of(
        recorded: &EvidenceRecording,
        motion: &CycleMotion,
        list: &FrictionList,
    ) -> Self {
        let counts = settled(motion, list);
        let begin_s = motion.rows.first().map_or(0.0, |row| row.time_s);
        let cycle = |time_s: f64| {
            let cycles = ((time_s - begin_s) / motion.cycle_s).round();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 0, of a file
            (cycles >= 0.0).then_some(cycles as usize)
        };
        let current = recorded.current.iter();
        let pairs = current.flat_map(|it| it.times_s.iter().zip(&it.values));
        let samples = pairs.filter_map(|(time_s, value)| {
            let cycle = cycle(*time_s)?;
            (counts.get(cycle) == Some(&true) && value.is_finite()).then_some((cycle, *value))
        });
        Self {
            samples: samples.collect(),
        }
    }
}

/// Returns for each cycle whether its current is known from the recorded motion alone.
fn settled(motion: &CycleMotion, list: &FrictionList) -> Vec<bool> {
    let rows = &motion.rows;
    let lookahead = usize::from(list.reversal_lookahead);
    let delay = usize::try_from(list.delay_cycles).unwrap_or_default();
    let distance = f64::from(list.position_delay.max(0));
    let mut counts = vec![false; rows.len()];
    let mut begin: Option<f64> = None;
    let mut waits = usize::MAX;
    for (at, row) in rows.iter().enumerate() {
        if row.switched == Switched::Off {
            (begin, waits) = (None, usize::MAX);
            continue;
        }
        let from = *begin.get_or_insert(row.position);
        let moved = (row.position - from).abs();
        if waits == usize::MAX && row.velocity != 0.0 && moved > distance {
            waits = delay + lookahead + AROUND;
        }
        match waits {
            0 => counts[at] = true,
            usize::MAX => {}
            _ => waits -= 1,
        }
    }
    // A reversal after the end is not known, nor are the cycles around a switch.
    let ahead = lookahead + AROUND;
    for (at, counts) in counts.iter_mut().enumerate() {
        let later = rows.get(at + ahead);
        let stays_on = later.is_some_and(|row| row.switched == Switched::On);
        *counts &= stays_on;
    }
    counts
}

impl Model<'_> {
    fn cycles(&self, reading: Reading) -> Vec<f64> {
        let mut current = AdditiveCurrent::new(self.list, reading);
        let currents = self.motion.trace.currents(&mut current);
        currents
            .map(|(_, added)| added.current_units * self.torque_scale)
            .collect()
    }

    /// Returns the currents of a reading at the samples, for each shift.
    pub(super) fn explain(
        &self,
        reading: Reading,
        counted: &Counted,
    ) -> impl Iterator<Item = Explained> {
        let cycles = self.cycles(reading);
        SHIFTS.into_iter().map(move |shift| {
            let last = cycles.len().saturating_sub(1);
            let at = |cycle: usize| cycles[cycle.saturating_add_signed(-shift).min(last)];
            Explained {
                hypothesis: Hypothesis { reading, shift },
                currents: counted
                    .samples
                    .iter()
                    .map(|(cycle, _)| at(*cycle))
                    .collect(),
            }
        })
    }
}

impl Explained {
    /// Returns the sum of the unexplained currents.
    pub(super) fn cost(&self, counted: &Counted) -> f64 {
        self.rests(counted).sum()
    }

    /// Returns the unexplained current in each sample.
    pub(super) fn rests<'a>(&'a self, counted: &'a Counted) -> impl Iterator<Item = f64> + 'a {
        let pairs = self.currents.iter().zip(&counted.samples);
        pairs.map(|(current, (_, recorded))| (recorded - current).abs())
    }

    /// Returns the largest current.
    pub(super) fn amplitude(&self) -> f64 {
        let currents = self.currents.iter();
        currents.fold(0.0, |most, current| most.max(current.abs()))
    }
}
