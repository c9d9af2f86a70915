//! Recorded circles of machines that share no code with the plants of this package (R16.10, R16.11, R16.15).

use frictcomp_physics::circle::{Direction, PlaneAxis, RecordedCircle, RecordedTrace};
use frictcomp_testing::{
    Axis, Control, Guide, Machine, Move, Presliding, Program, Ramp, Random, Run, TrueGlitches,
    true_glitches,
};

/// A table with a bristle or with springs.
fn axis(presliding: Presliding) -> Axis {
    Axis {
        mass_kg: 900.0,
        coupling: None,
        guide: Guide {
            sliding_n: 420.0,
            sticking_n: 560.0,
            fading_mm_per_s: 4.0,
            viscous_n_s_per_mm: 3.0,
            presliding,
            asymmetry: 0.0,
        },
        kv: 28.0,
        forward: 1.0,
        bandwidth_hz: 40.0,
        reset_s: 0.015,
        current_loop_s: 0.0008,
        dead_cycles: 1,
        unit_n: 4.0,
        weight_n: 0.0,
        cogging: (0.0, 10.0),
        backlash_um: 0.0,
        most_n: 20_000.0,
    }
}

fn machine(presliding: &Presliding, ramp: Ramp, phase_s: f64) -> Machine {
    let mut y = axis(presliding.clone());
    y.mass_kg *= 1.3;
    Machine {
        name: "table",
        axes: [axis(presliding.clone()), y],
        control: Control {
            ramp,
            cycle_s: 0.001,
            part: 1.0,
            phase_s,
        },
    }
}

/// Three turns in each direction from X+, each from rest to rest, as a measuring program drives them.
fn circles(radius: f64, feed: f64) -> Program {
    let arc = |angle: f64| Move::Arc {
        centre: [-radius, 0.0],
        angle,
        feed,
    };
    let turns = 3.0 * std::f64::consts::TAU;
    Program {
        moves: vec![Move::Dwell(1.0), arc(turns), Move::Dwell(1.0), arc(-turns)],
    }
}

/// The positions of a run as an encoder shows them.
fn recorded(run: &Run, noise_um: f64, seed: u64) -> RecordedTrace {
    let mut random = Random::new(seed);
    let mut place = |mm: f64| {
        let noisy = mm + 1e-3 * noise_um * random.normal();
        (noisy * 1e4).round() * 1e-4
    };
    let rows = run.load_mm[0].iter().zip(&run.load_mm[1]);
    let points_mm: Vec<[f64; 2]> = rows.map(|(x, y)| [place(*x), place(*y)]).collect();
    let mut times_s = Vec::new();
    let mut time = 0.0;
    for _ in &points_mm {
        times_s.push(time);
        time += run.cycle_s;
    }
    RecordedTrace { points_mm, times_s }
}

/// The figures of a recording: of X and Y, counter-clockwise and clockwise.
fn figures(circles: &[RecordedCircle]) -> TrueGlitches {
    let mut um = [[0.0; 2]; 2];
    for circle in circles {
        let way = usize::from(circle.direction == Direction::Cw);
        let [x_plus, y_plus, x_minus, y_minus] = circle.glitches().expect("glitches");
        um[0][way] = x_plus.larger(x_minus).um;
        um[1][way] = y_plus.larger(y_minus).um;
    }
    TrueGlitches { um }
}

const BRISTLE: Presliding = Presliding::Bristle {
    um: 1.6,
    damping: 0.3,
    damped_to_mm_per_s: 2.0,
};

/// R16.10, R16.15: machines that start softly or hard are evaluated within 8 % + 0.6 µm of their true glitch, the
/// largest over the phases within the cycle, each axis and direction for itself, and the feed within 0.1 %.
#[test]
fn the_turns_in_the_middle_count() {
    let springs = Presliding::Springs(vec![[0.6, 0.3], [1.8, 0.4], [6.0, 0.3]]);
    let mut worst: f64 = 0.0;
    let ramps = [[2000.0, 50.0], [2000.0, 1000.0], [500.0, 5.0]];
    for (ramp, radius, feed, presliding) in [
        (2, 40.0, 500.0, &BRISTLE),
        (0, 40.0, 1600.0, &springs),
        (0, 40.0, 5000.0, &BRISTLE),
        (1, 40.0, 5000.0, &springs),
        (2, 40.0, 5000.0, &springs),
        (1, 100.0, 2500.0, &BRISTLE),
        (0, 100.0, 5000.0, &springs),
        (2, 100.0, 5000.0, &BRISTLE),
    ] {
        let [acceleration, jerk] = ramps[ramp];
        {
            let ramp = Ramp {
                acceleration,
                jerk: jerk * 1000.0,
            };
            let program = circles(radius, feed);
            let runs = [0.0, 0.0004, 0.0007].map(|phase_s| {
                let machine = machine(presliding, ramp, phase_s);
                machine.run(&program, [radius, 0.0], [None, None])
            });
            let truth = runs.iter().map(true_glitches);
            let truth = truth.reduce(TrueGlitches::larger).expect("runs");
            let trace = recorded(&runs[1], 0.3, 7);
            let found = RecordedCircle::find(&trace, Some(radius)).expect("circles");
            assert_eq!(found.len(), 2);
            for circle in &found {
                let part = circle.feed_mm_per_min().expect("a feed") / feed;
                assert!((part - 1.0).abs() < 0.001, "{radius} {feed}: {part}");
            }
            let figures = figures(&found);
            for axis in PlaneAxis::ALL {
                let at = usize::from(axis == PlaneAxis::Y);
                for way in 0..2 {
                    let [own, seen] = [truth.um[at][way], figures.um[at][way]];
                    let allowed = 0.08 * own + 0.6;
                    worst = worst.max((own - seen).abs() / allowed);
                    assert!(
                        own > 3.0 && (own - seen).abs() < allowed,
                        "{acceleration} {jerk} R{radius} F{feed} {axis:?} {way}: {seen:.2} for {own:.2}"
                    );
                }
            }
        }
    }
    assert!(worst > 0.0);
}
