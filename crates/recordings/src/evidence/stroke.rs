//! The stroke of a question: out, and back to where it began.

use super::recorded::{CycleMotion, EvidenceRecording, step};

/// Part of the stroke below which the axis counts as turned back.
const BACK: f64 = 0.95;

/// Maximum distance of samples, as a part of the stroke.
const NEAR: f64 = 0.015;

/// Part of the stroke within which cycles are around a place.
const AROUND: f64 = 0.03;

/// A switch of the state, as a part of the stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StrokeSwitch {
    pub(super) is_on: bool,
    pub(super) part: f64,
}

/// The way out of a stroke.
pub(super) struct StrokeOut {
    /// Time, part of the stroke and speed of each cycle until the axis moves back.
    out: Vec<(f64, f64, f64)>,
    /// Whether compensation was on at the beginning of the stroke.
    pub(super) begins_on: bool,
    pub(super) switches: Vec<StrokeSwitch>,
}

impl StrokeOut {
    /// Returns the stroke of a recording.
    ///
    /// # Errors
    /// Nothing moves, no state was recorded, or too rarely.
    pub(super) fn of(recorded: &EvidenceRecording) -> Result<Self, String> {
        let state = recorded.state.as_ref().ok_or(
            "the recording has no channel with the state of friction compensation, `frict_comp.f_is_active`",
        )?;
        let motion: CycleMotion = recorded.motion()?;
        let begin = motion.rows.first().map_or(0.0, |row| row.position);
        let far = |one: &f64, other: &f64| (one - begin).abs().total_cmp(&(other - begin).abs());
        let length = motion.rows.iter().map(|row| row.position).max_by(far);
        let length = length.map_or(0.0, |it| it - begin);
        if length == 0.0 {
            return Err("the axis does not move while it is recorded".to_owned());
        }
        let rows = motion.rows.iter();
        let all = rows.map(|row| {
            (
                row.time_s,
                (row.position - begin) / length,
                row.velocity.abs(),
            )
        });
        let mut was_far = false;
        let out: Vec<_> = all
            .take_while(|(_, part, _)| {
                was_far |= *part > 0.999;
                !was_far || *part >= BACK
            })
            .collect();
        let fastest = out
            .iter()
            .fold(0.0, |most: f64, (.., speed)| most.max(*speed));
        let usual = [&state.times_s, &recorded.times_s].map(|times| step(times));
        let step_s = usual
            .iter()
            .fold(0.0_f64, |most, it| most.max(it.unwrap_or(f64::INFINITY)));
        // Velocities are in µm/s, positions in 0.1 µm.
        if fastest * step_s * 10.0 > NEAR * length.abs() {
            return Err(format!(
                "it is sampled every {:.1} ms, too rarely for this motion: record every cycle",
                step_s * 1000.0
            ));
        }
        let end_s = out.last().map_or(0.0, |it| it.0);
        let part_at = |time_s: f64| {
            let after = out.partition_point(|it| it.0 < time_s);
            out.get(after).map_or(1.0, |it| it.1)
        };
        let is_on = |at: usize| state.values[at] != 0.0;
        let changes = (1..state.values.len()).filter(|at| is_on(*at) != is_on(at - 1));
        let switches = changes.filter(|at| state.times_s[*at] <= end_s);
        let switches = switches.map(|at| StrokeSwitch {
            is_on: is_on(at),
            part: part_at(state.times_s[at]),
        });
        Ok(Self {
            begins_on: state.values.first().is_some_and(|it| *it != 0.0),
            switches: switches.collect(),
            out,
        })
    }

    /// Returns the lowest speed around a part of the stroke, as a part of its usual speed.
    pub(super) fn slowest_at(&self, part: f64) -> f64 {
        let around = self.out.iter().filter(|it| (it.1 - part).abs() <= AROUND);
        let slowest = around.fold(f64::INFINITY, |least, it| least.min(it.2));
        let mut speeds: Vec<f64> = self
            .out
            .iter()
            .map(|it| it.2)
            .filter(|it| *it > 0.0)
            .collect();
        speeds.sort_by(f64::total_cmp);
        slowest
            / speeds
                .get(speeds.len() / 2)
                .copied()
                .unwrap_or(f64::INFINITY)
    }
}
