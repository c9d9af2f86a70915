//! Action and timing of a list in a recording (R6.22): recordings of drives that the tests simulate themselves, with
//! lists that are right, early, late, and others.

use frictcomp::lists::FrictionList;
use frictcomp::lists::TablePoint;
use frictcomp_physics::current::Reading;
use frictcomp_recordings::identify::ActingShare;
use frictcomp_recordings::identify::{Predictor, Timing, Track, Verified, verify, verify_followed};

use frictcomp_testing::recorded_circles::{
    Bench, FAST, MID, Recorded, SLOW, SOFT, STIFF, units_at,
};

/// The parts of a list that act.
const SHARES: [f64; 6] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25];

fn track(recorded: &Recorded) -> Track {
    Track {
        times_s: recorded.t.clone(),
        velocities: Some(recorded.v.clone()),
        positions: Some(recorded.x.clone()),
        torques: recorded.torque.clone(),
        step_s: 0.001,
    }
}

/// Returns the list of the axis, whose whole current is a share of 1.
fn list(bench: &Bench) -> FrictionList {
    // Finer steps at low speeds, where the curve bends.
    let speed = |at: u32| 0.25 * (f64::from(at) / 200.0).powi(3);
    FrictionList {
        reversal_lookahead: u16::try_from(bench.lookahead).expect("a few cycles"),
        delay_cycles: i16::try_from(bench.delay).expect("a few cycles"),
        position_delay: 9,
        scaling_factor: 1000,
        max_points: 201,
        table: (0..=200)
            .map(|at| TablePoint {
                input: speed(at) * 1e6,
                output: units_at(speed(at)),
            })
            .collect(),
    }
}

fn verified(bench: &Bench) -> Verified {
    let (recorded, list) = (bench.record(), list(bench));
    let predictor = Predictor {
        list: &list,
        reading: Reading::default(),
        cycle_s: None,
    };
    verify_followed(&track(&recorded), &recorded.error, &predictor).expect("a verdict")
}

fn share_of(timing: &Timing) -> ActingShare {
    match timing {
        Timing::Off(share)
        | Timing::Other(share)
        | Timing::Unclear(share)
        | Timing::On { share, .. } => *share,
        other => panic!("{other:?}"),
    }
}

/// Asserts that no verdict claims that the list acted, or that nothing did, if a part of it did. A list that is
/// a quarter stronger may pass for it in much noise.
fn assert_no_false_verdict(bench: &Bench, timing: &Timing) {
    let what = format!("{bench:?}: {timing:?}");
    match timing {
        Timing::On { .. } => assert!(bench.share > 0.8, "{what}"),
        Timing::Off(_) => assert!(bench.share < 0.2, "{what}"),
        Timing::Other(_) => assert!(![0.0, 1.0].contains(&bench.share), "{what}"),
        _ => {}
    }
}

#[test]
fn the_exact_list_is_right_on_slow_circles() {
    // R5.36: the contact builds up over a way, which takes long there.
    for bench in [STIFF, MID, SOFT, SLOW] {
        for feed in [300.0, 800.0, 2000.0] {
            for share in [0.0, 1.0] {
                let bench = Bench {
                    feed,
                    share,
                    noise: (0.03, 1.0),
                    ..bench
                };
                let found = verified(&bench);
                let low = found
                    .ranges
                    .iter()
                    .map(|it| it.scale)
                    .fold(f64::MAX, f64::min);
                let high = found
                    .ranges
                    .iter()
                    .map(|it| it.scale)
                    .fold(f64::MIN, f64::max);
                assert!(found.is_away_from_reversals);
                assert!(low > 0.97 && high < 1.03, "{bench:?}: {:?}", found.ranges);
                let said = found.verdict();
                assert!(
                    !said.iter().any(|it| it.contains('%')),
                    "{bench:?}: {said:?}"
                );
            }
        }
    }
}

#[test]
fn the_part_of_a_list_that_acted_is_found() {
    // R6.22: to 0.03, at stiff contacts and soft ones.
    for (bench, feed, share) in [
        (STIFF, 3000.0, 0.0),
        (STIFF, 3000.0, 0.5),
        (STIFF, 1500.0, 1.0),
        (MID, 3000.0, 0.25),
        (SOFT, 3000.0, 1.0),
        (FAST, 3000.0, 0.5),
    ] {
        for noise in [(0.0, 0.0), (0.03, 1.0)] {
            let bench = Bench {
                feed,
                share,
                noise,
                turns: 2.6,
                ..bench
            };
            let timing = verified(&bench).timing;
            let found = share_of(&timing);
            let what = format!("{bench:?}: {timing:?}");
            assert!((found.share - share).abs() < 0.03, "{what}");
            assert!((found.low..=found.high).contains(&share), "{what}");
            assert_no_false_verdict(&bench, &timing);
            let is_said = match timing {
                Timing::Off(_) => share <= 0.0,
                Timing::On { .. } => share >= 1.0,
                Timing::Other(_) => share > 0.0 && share < 1.0,
                _ => false,
            };
            assert!(is_said, "{what}");
        }
    }
}

#[test]
#[ignore = "minutes without optimization"]
fn the_part_is_within_what_is_said_everywhere() {
    // R6.22: plants, gains, feeds, noise and shares; if noise does not allow 0.03, the interval shows that.
    let benches = [STIFF, MID, SOFT, FAST, SLOW];
    let (mut all, mut outside) = (0, 0);
    for noise in [(0.0, 0.0), (0.03, 1.0), (0.1, 3.0)] {
        for bench in benches {
            for feed in [500.0, 1500.0, 3000.0, 5000.0] {
                for (seed, share) in SHARES.into_iter().enumerate() {
                    let bench = Bench {
                        feed,
                        share,
                        noise,
                        turns: 3.2,
                        seed: seed as u64 + 7,
                        ..bench
                    };
                    let timing = verified(&bench).timing;
                    assert_no_false_verdict(&bench, &timing);
                    let found = share_of(&timing);
                    all += 1;
                    outside += u32::from(!(found.low..=found.high).contains(&share));
                }
            }
        }
    }
    assert!(outside * 50 <= all, "{outside} of {all} outside");
}

#[test]
fn the_following_error_tells_early_and_late() {
    // R6.22
    for bench in [STIFF, MID, SOFT] {
        for (lookahead, delay, word) in [(10, 0, "early"), (0, 50, "late")] {
            let bench = Bench {
                feed: 2000.0,
                lookahead,
                delay,
                ..bench
            };
            let found = verified(&bench);
            let what = format!("{bench:?} {word}: {:?}", found.timing);
            assert_eq!(found.timing.early_or_late(), Some(word), "{what}");
            assert!(found.verdict().iter().any(|it| it.contains(word)), "{what}");
            let list = list(&bench);
            let predictor = Predictor {
                list: &list,
                reading: Reading::default(),
                cycle_s: None,
            };
            let open = verify(&track(&bench.record()), &predictor).expect("a verdict");
            assert_eq!(open.timing, Timing::Open);
        }
    }
}
