//! The glitch of R11.26 by a separate simulation and window, compared with that of the circular test.

#[allow(dead_code)]
use frictcomp_physics::circle::{Circle, CircularTest, Comparison, Direction, LapRun};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{FrictionModel, Preset};

use frictcomp_testing::recorded_circles::{Bench, MID, SOFT, STIFF};

/// Returns the largest glitch in µm at the reversals of a recorded axis: at a reversal the tangent is across the axis,
/// so the deviation along the normal is that of the axis.
fn glitch(bench: &Bench) -> f64 {
    let recorded = bench.record();
    let omega = bench.feed / 60.0 / bench.radius_mm;
    let cycles = |seconds: f64| (seconds / 0.001).round() as usize;
    let before = cycles(8_f64.to_radians() / omega);
    let after = cycles((8_f64.to_radians() / omega).max(0.3));
    // To 20°, or twice the window.
    let side = |window: usize| (cycles(20_f64.to_radians() / omega)).max(2 * window);
    let (first, last) = (side(before), side(after));
    let turns = (1..recorded.v.len()).filter(|&at| recorded.v[at] * recorded.v[at - 1] < 0.0);
    let inside = turns.filter(|&at| at > first && at + last < recorded.error.len());
    let heights = inside.map(|turn| {
        let row = |at: usize| (at as f64 - turn as f64, recorded.error[at] / 10.0);
        let sides: Vec<(f64, f64)> = (turn - first..turn - before)
            .chain(turn + after..turn + last)
            .map(row)
            .collect();
        let count = sides.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| sides.iter().map(of).sum::<f64>() / count;
        let (time, error) = (mean(|it| it.0), mean(|it| it.1));
        let moment = |of: &dyn Fn(&(f64, f64)) -> f64| sides.iter().map(of).sum::<f64>();
        let slope = moment(&|it| (it.0 - time) * (it.1 - error))
            / moment(&|it| (it.0 - time) * (it.0 - time));
        let left = (turn - before..turn + after)
            .map(row)
            .map(|it| it.1 - error - slope * (it.0 - time));
        let [lowest, highest] = left.fold([f64::MAX, f64::MIN], |[lowest, highest], it| {
            [lowest.min(it), highest.max(it)]
        });
        highest - lowest
    });
    heights.fold(0.0, f64::max)
}

#[test]
fn a_glitch_is_what_an_own_simulation_leaves_in_its_window() {
    // R5.22 R11.26
    for (bench, preset) in [
        (STIFF, Preset::Stiff),
        (MID, Preset::Mid),
        (SOFT, Preset::Soft),
    ] {
        for (radius_mm, feed) in [(100.0, 3000.0), (30.0, 1500.0)] {
            let own = glitch(&Bench {
                feed,
                radius_mm,
                share: 0.0,
                turns: 1.3,
                ..bench
            });
            let test = CircularTest {
                circle: Circle {
                    radius_mm,
                    feed_mm_per_min: feed,
                    ..Circle::default()
                },
                plant: preset.plant(),
                model: FrictionModel::Lugre,
                compensation: [None, None],
                reading: Reading::default(),
            };
            let job = LapRun {
                compensation: Switched::Off,
                direction: Direction::Ccw,
            };
            let comparison = Comparison::of([test.run(job).expect("a circle")]);
            let said = comparison.off.figures.glitch_max_um().expect("a glitch");
            assert!(
                (said - own).abs() < 0.05 * own,
                "{preset} R{radius_mm} F{feed}: {said} said, {own} simulated"
            );
        }
    }
}
