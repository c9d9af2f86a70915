//! A single reversal of one axis: evaluated by the search in place of whole circles.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::UM_PER_M;
use crate::circle::geometry::{Circle, CircleArc, CircleError};
use crate::circle::simulated::Method;
use crate::circle::simulated::{AxesSimulation, AxisRun};
use crate::current::Reading;
use crate::simulation::{DriveParameters, FrictionModel};
use frictcomp::lists::FrictionList;

/// Half the least window of the glitch (R5.22), in radians.
const WINDOW: f64 = 8.0 * PI / 180.0;

/// Minimum time from the start of the drives to the window, in s.
const SETTLING: f64 = 0.15;

/// Maximum time from the start of the window to the reversal, in s. With the settling that
/// is 0.6 s in which the slow points of a list act before the reversal, too (R5.25). On fast circles the window
/// is shorter, and outside it an axis is too fast for those points.
const BEFORE: f64 = 0.45;

/// Minimum length of the window after the reversal, in s.
const AFTER: f64 = 0.3;

/// Maximum length of the window after the reversal, in s: by then the peak has decayed.
const LONGEST: f64 = 0.5;

/// CNC cycles of reserve.
const SPARE: usize = 4;

/// CNC cycles at both ends of the window through which the undisturbed path runs.
const ENDS: usize = 20;

/// One axis, and the computation of its friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisAlone<'a> {
    pub(crate) axis: PlaneAxis,
    pub(crate) drive: &'a DriveParameters,
    pub(crate) model: FrictionModel,
    pub(crate) reading: Reading,
    /// Delay of the reversal within its CNC cycle relative to a whole run, in cycles.
    pub(crate) phase: f64,
}

/// Returns the commanded angle of one reversal of an axis in the turn that a whole run evaluates, which begins half a
/// turn after X+.
fn reversal(axis: PlaneAxis) -> f64 {
    match axis {
        PlaneAxis::X => 2.0 * PI,
        PlaneAxis::Y => 3.0 * FRAC_PI_2,
    }
}

/// Returns the delay in cycles with which the reversal of an axis is at this place within its CNC cycle, 0 to 1.
pub(super) fn phase_at(place: f64, axis: PlaneAxis, circle: &Circle) -> f64 {
    let cycles = reversal(axis) / (circle.angular_velocity() * circle.cycle_time_s);
    (place - cycles).rem_euclid(1.0)
}

impl AxisAlone<'_> {
    /// Returns the glitch in µm at a reversal, with or without compensation, peak to peak, less the straight line from
    /// one end of the window to the other. The cycles are those of a whole run, so that the reversal falls at the same
    /// place within its cycle.
    ///
    /// # Errors
    /// A drive that is unstable.
    pub(super) fn glitch_um(
        &self,
        circle: Circle,
        compensation: Option<&Method>,
    ) -> Result<f64, CircleError> {
        let extremes = self.extremes(circle, compensation)?;
        let least = extremes.iter().map(|it| it[0]).fold(f64::MAX, f64::min);
        let most = extremes.iter().map(|it| it[1]).fold(f64::MIN, f64::max);
        Ok(most - least)
    }

    /// Returns the least and the largest deviation outwards in µm of each CNC cycle in the window of a reversal, less
    /// the straight line from one end of the window to the other.
    ///
    /// # Errors
    /// A drive that is unstable.
    pub(super) fn extremes(
        &self,
        circle: Circle,
        compensation: Option<&Method>,
    ) -> Result<Vec<[f64; 2]>, CircleError> {
        Ok(self.path(circle, compensation)?.straightened())
    }

    /// Returns the deviation outwards at a reversal: for each CNC cycle the time of its middle since the reversal in s,
    /// and the middle between its least and its largest deviation in m.
    ///
    /// # Errors
    /// A drive that is unstable.
    pub(crate) fn deviations(
        &self,
        circle: Circle,
        compensation: Option<&Method>,
    ) -> Result<Vec<(f64, f64)>, CircleError> {
        let path = self.path(circle, compensation)?;
        let window = CycleWindow::of(&circle, self.axis);
        let reversal = reversal(self.axis) / circle.angular_velocity();
        let middle = |(at, [least, most]): (usize, &[f64; 2])| {
            let time = (real(window.from + at) + 0.5 - self.phase) * circle.cycle_time_s;
            (time - reversal, f64::midpoint(*least, *most))
        };
        Ok(path.cycles.iter().enumerate().map(middle).collect())
    }

    /// Returns the same for several compensations: simulated side by side, they take little longer than one.
    ///
    /// # Errors
    /// A drive that is unstable.
    pub(super) fn extremes_of_each<const N: usize>(
        &self,
        circle: Circle,
        compensations: [&Method; N],
    ) -> Result<[Vec<[f64; 2]>; N], CircleError> {
        let paths = self.paths(circle, compensations.map(Some))?;
        Ok(paths.map(|path| path.straightened()))
    }

    /// Returns the path of the axis in the window of a reversal.
    fn path(&self, circle: Circle, compensation: Option<&Method>) -> Result<Path, CircleError> {
        let [path] = self.paths(circle, [compensation])?;
        Ok(path)
    }

    /// Returns the paths of the axis with each of these compensations.
    fn paths<const N: usize>(
        &self,
        circle: Circle,
        compensations: [Option<&Method>; N],
    ) -> Result<[Path; N], CircleError> {
        let window = CycleWindow::of(&circle, self.axis);
        let lists = compensations.iter().flatten().filter_map(|it| it.list());
        let leads = lists.map(|list| window.lead(&circle, list));
        let first = window.begin.saturating_sub(leads.max().unwrap_or_default());
        let turning = circle.angular_velocity() * circle.cycle_time_s;
        let stretch = CircleArc {
            start: (real(first) - self.phase) * turning,
            length: real(window.end - first) * turning,
            lead: window.begin - first,
            direction: Direction::Ccw,
        };
        let run = AxesSimulation {
            circle,
            model: self.model,
            reading: self.reading,
            axes: compensations.map(|compensation| AxisRun {
                axis: self.axis,
                drive: self.drive,
                compensation,
            }),
        };
        let mut paths = compensations.map(|_| Path {
            circle,
            stretch,
            axis: self.axis,
            cycle: usize::MAX,
            chord: [0.0; 2],
            steps: 0,
            cycles: Vec::with_capacity(window.end - window.from),
        });
        run.simulate(stretch, |cycle, places| {
            if (window.from..window.end).contains(&(first + cycle)) {
                for (path, place) in paths.iter_mut().zip(places) {
                    path.take(cycle, place);
                }
            }
        })?;
        Ok(paths)
    }
}

/// The deviation of one axis from the commanded position, outwards in m.
struct Path {
    circle: Circle,
    stretch: CircleArc,
    axis: PlaneAxis,
    cycle: usize,
    /// Commanded positions at the ends of the cycle.
    chord: [f64; 2],
    /// Simulation steps since the cycle began.
    steps: u32,
    /// The least and the largest deviation of each cycle.
    cycles: Vec<[f64; 2]>,
}

impl Path {
    fn take(&mut self, cycle: usize, place: f64) {
        if cycle != self.cycle {
            let at = |k| {
                let [x, y] = self.circle.at(self.stretch, k);
                match self.axis {
                    PlaneAxis::X => x.0,
                    PlaneAxis::Y => y.0,
                }
            };
            self.chord = [at(cycle), at(cycle + 1)];
            self.cycle = cycle;
            self.steps = 0;
            self.cycles.push([f64::MAX, f64::MIN]);
        }
        self.steps += 1;
        let [from, to] = self.chord;
        let share = f64::from(self.steps) * self.circle.step_in_cycle();
        let commanded = from + share * (to - from);
        let deviation = (place - commanded) * commanded.signum();
        if let Some([least, most]) = self.cycles.last_mut() {
            *least = least.min(deviation);
            *most = most.max(deviation);
        }
    }

    /// Returns the least and the largest deviation of each cycle in µm, less the line through both ends.
    fn straightened(&self) -> Vec<[f64; 2]> {
        let ends = ENDS.min(self.cycles.len() / 2).max(1);
        let mean = |cycles: &[[f64; 2]]| {
            let middles = cycles
                .iter()
                .map(|[least, most]| f64::midpoint(*least, *most));
            middles.sum::<f64>() / real(cycles.len())
        };
        let [first, last] = [
            mean(&self.cycles[..ends]),
            mean(&self.cycles[self.cycles.len() - ends..]),
        ];
        let slope = (last - first) / real((self.cycles.len() - ends).max(1));
        let straight = |(at, extremes): (usize, &[f64; 2])| {
            let line = first + slope * real(at);
            extremes.map(|it| (it - line) * UM_PER_M)
        };
        self.cycles.iter().enumerate().map(straight).collect()
    }
}

/// CNC cycles of a whole run around a reversal.
struct CycleWindow {
    /// The angle in radians from the start of the drives to the reversal.
    ahead: f64,
    /// First cycle of the drives.
    begin: usize,
    /// First cycle of the glitch.
    from: usize,
    /// Last cycle of both.
    end: usize,
}

impl CycleWindow {
    fn of(circle: &Circle, axis: PlaneAxis) -> Self {
        let turning = circle.angular_velocity();
        let cycle = |time: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // in a checked run
            let cycle = (time / circle.cycle_time_s).floor() as usize;
            cycle
        };
        let reversal = reversal(axis) / turning;
        let window = WINDOW / turning;
        let from = cycle(reversal - window.min(BEFORE));
        let ahead_s = (window.min(BEFORE) + SETTLING).min(reversal);
        Self {
            ahead: ahead_s * turning,
            begin: cycle(reversal - ahead_s),
            from,
            end: cycle(reversal + window.clamp(AFTER, LONGEST)).max(from + 2),
        }
    }
}

/// Returns the number of CNC cycles in the window of a reversal.
pub(super) fn cycles_of_window(circle: &Circle, axis: PlaneAxis) -> usize {
    let window = CycleWindow::of(circle, axis);
    window.end - window.from
}

impl CycleWindow {
    /// Returns the number of CNC cycles before the drives begin after which the additive current of a list equals that
    /// of a whole run: its dead time has passed, and before that the axis has moved by more than its `position_delay`.
    /// A quarter of a turn is enough for any list.
    fn lead(&self, circle: &Circle, list: &FrictionList) -> usize {
        let quarter = circle.cycles(FRAC_PI_2);
        let dead = usize::try_from(list.delay_cycles).unwrap_or_default() + SPARE;
        let turning = circle.angular_velocity() * circle.cycle_time_s;
        let near = self.ahead + real(dead) * turning;
        let way = f64::from(list.position_delay.max(0)) * 1e-7;
        // The axis is at R·cos of the angle before its reversal.
        let far = near.cos() - way / circle.radius_m();
        if near >= FRAC_PI_2 || far <= 0.0 {
            return quarter;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most a quarter
        let moving = ((far.acos() - near) / turning).ceil() as usize;
        (dead + moving + SPARE).min(quarter)
    }
}

fn real(cycles: usize) -> f64 {
    #[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
    let real = cycles as f64;
    real
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Preset;

    #[test]
    fn a_short_lead_is_as_good_as_a_quarter_of_a_turn() {
        // R5.25: the additive current long before the drives begin makes no difference.
        let circle = Circle {
            feed_mm_per_min: 3000.0,
            ..Circle::default()
        };
        let drive = Preset::Mid.plant().x;
        for (delay_cycles, position_delay) in [(0, 0), (30, 10), (248, 2000)] {
            let list = FrictionList {
                position_delay,
                delay_cycles,
                ..crate::simulation::plant_list(&drive)
            };
            let window = CycleWindow::of(&circle, PlaneAxis::X);
            let lead = window.lead(&circle, &list);
            assert!(lead < circle.cycles(FRAC_PI_2) / 3, "{lead}");
            let currents = |lead: usize| {
                let turning = circle.angular_velocity() * circle.cycle_time_s;
                let mut current = crate::current::AdditiveCurrent::new(&list, Reading::default());
                let mut added = 0.0;
                for before in (0..lead).rev() {
                    let angle = window.ahead + real(before) * turning;
                    let position = circle.radius_m() * 1e7 * angle.cos();
                    let velocity = 1e3 * circle.feed_mm_per_min / 60.0 * angle.sin();
                    added = current.step(position, velocity, &[]).current_units;
                }
                added
            };
            let [short, long] = [lead, circle.cycles(FRAC_PI_2)].map(currents);
            assert!(
                (short - long).abs() < 1e-9,
                "{delay_cycles}: {short} {long}"
            );
        }
    }
}
