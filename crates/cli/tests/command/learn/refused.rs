//! Invalid rounds, and files that changed since.

use std::f64::consts::TAU;

use super::{Bench, PresetMachine, Row, SMALL, plain};
use frictcomp_physics::circle::{LearnedRound, LearningProgress, RecordedCircle, RecordedTrace};
use frictcomp_recordings::commission::{LearnedCircles, RecordedTurn};

/// Returns a recorded circle about a centre with a bulge of so many µm after each crossing.
fn circle(feed: f64, bulge_um: f64, place: (f64, u64)) -> Vec<Row> {
    turns(feed, &[bulge_um], place)
}

/// Returns a recorded circle with the bulges of each turn, and a fifth of a turn more.
fn turns(feed: f64, of_turns_um: &[f64], (centre, seed): (f64, u64)) -> Vec<Row> {
    let mut random = fastrand::Rng::with_seed(seed);
    let turning = feed / 60.0 / 40.0;
    let count = ((of_turns_um.len() as f64 + 0.2) * TAU / turning * 1000.0) as usize;
    let row = |at: usize| {
        let way = turning * at as f64 / 1000.0;
        let angle = way - 0.5;
        let after = angle.rem_euclid(TAU / 4.0) / turning;
        let bulge_um = of_turns_um[((way / TAU) as usize).min(of_turns_um.len() - 1)];
        let bulge = 1e-3 * bulge_um * (-(after / 0.03 - 1.0).powi(2)).exp();
        let radius = 40.0 + bulge + 3e-4 * (random.f64() - 0.5);
        let [x, y] = [radius * angle.cos(), radius * angle.sin()];
        [at as f64 / 1000.0, centre + x, centre + y]
    };
    (0..count).map(row).collect()
}

/// Returns the round of X with bulges of so many µm.
fn round(bulge_um: f64) -> LearnedRound {
    let mut turns = Vec::new();
    for (at, feed) in SMALL.into_iter().enumerate() {
        for take in [0, 1] {
            let seed = (bulge_um * 1000.0) as u64 + 10 * at as u64 + take;
            let rows = circle(feed, bulge_um, (0.0, seed));
            let trace = RecordedTrace {
                points_mm: rows.iter().map(|row| [row[1], row[2]]).collect(),
                times_s: rows.iter().map(|row| row[0]).collect(),
            };
            let found = RecordedCircle::find(&trace, None).expect("a circle");
            turns.extend(found.into_iter().map(|circle| RecordedTurn {
                assumed: None,
                file: format!("F{feed}-{take}.csv"),
                circle,
            }));
        }
    }
    let [circles, _] = LearnedCircles::of(&turns, &turns[0], 0.001)
        .expect("a round")
        .0;
    let list = frictcomp_physics::simulation::plant_list(&PresetMachine::small().plant.x);
    LearnedRound { list, circles }
}

/// R16.4: a round counts if it gains more than the spread; otherwise the step is halved and the best remains; two
/// such rounds end it.
#[test]
fn only_what_gains_more_than_the_spread_is_accepted() {
    let rounds = [6.0, 4.0, 3.99, 2.5, 4.5, 2.49].map(round);
    for (round, bulge) in rounds.iter().zip([6.0, 4.0, 3.99, 2.5, 4.5, 2.49]) {
        let worst = round.worst_um();
        assert!((0.75..1.1).contains(&(worst / bulge)), "{worst} of {bulge}");
        assert!(
            (0.001..0.15).contains(&round.spread_um()),
            "{}",
            round.spread_um()
        );
    }
    let at = |count: usize| {
        let it = LearningProgress::of(&rounds[..count]);
        (it.best, it.idle, it.step, it.is_over())
    };
    assert_eq!(at(1), (0, 0, 1.0, false));
    assert_eq!(at(2), (1, 0, 1.0, false));
    assert_eq!(at(3), (1, 1, 0.5, false));
    assert_eq!(at(4), (3, 0, 0.5, false));
    assert_eq!(at(5), (3, 1, 0.25, false));
    assert_eq!(at(6), (3, 2, 0.125, true));
    let judged = LearningProgress::of(&rounds).verdicts;
    let accepted: Vec<bool> = judged.iter().map(|it| it.is_accepted).collect();
    assert_eq!(accepted, [true, true, false, true, false, false]);
}

/// Returns a bench whose first round was recorded with circles that nothing drives.
fn recorded() -> Bench {
    let bench = Bench::new(PresetMachine::small(), &SMALL);
    let (status, text) = bench.begin(&[]);
    assert_eq!(status, Some(1), "{text}");
    for feed in SMALL {
        for take in [0, 1] {
            let rows = circle(feed, 5.0, (0.0, feed as u64 + take));
            bench.put(&take_of(feed, take), &plain(&rows));
        }
    }
    bench
}

fn take_of(feed: f64, take: u64) -> String {
    format!("learning/round-1/F{feed}-{take}.csv")
}

/// Each wrong input, its change to a recorded round, and the expected message.
#[test]
fn recordings_that_are_no_round_are_refused() {
    // R16.4, R16.17: a missing second recording, too few feeds, no positions, another axis, another list, two machines, no
    // times, coarse samples, a copy.
    type Wrong = (&'static str, fn(&Bench), &'static [&'static str]);
    let wrong: [Wrong; 10] = [
        (
            "one recording",
            |bench| std::fs::remove_file(bench.path(&take_of(2100.0, 1))).expect("removed"),
            &["F2100 ccw was recorded once", "record it a second time"],
        ),
        (
            "five feeds",
            |bench| {
                for take in [0, 1] {
                    std::fs::remove_file(bench.path(&take_of(1200.0, take))).expect("removed");
                }
            },
            &["recorded feeds: 5, of at least 6", "1.8 µm"],
        ),
        (
            "no positions",
            |bench| bench.put(&take_of(1200.0, 0), "t,v\n0,0\n0.001,100\n"),
            &["no columns `x` and `y`"],
        ),
        (
            "another axis",
            |bench| {
                let mut rows = circle(1200.0, 5.0, (0.0, 1));
                for row in &mut rows {
                    row[2] = 12.5;
                }
                bench.put(&take_of(1200.0, 0), &plain(&rows));
            },
            &["F1200-0.csv", "the points are not on a circle"],
        ),
        (
            "another list",
            |bench| {
                let list = bench.read("learning/round-1/Y.lis");
                bench.put("learning/round-1/Y.lis", &format!("{list}# tried\n"));
            },
            &["Y.lis` is not the list that was handed out", "SHA-256"],
        ),
        (
            "two places",
            |bench| {
                let rows = circle(1600.0, 5.0, (250.0, 3));
                bench.put(&take_of(1600.0, 1), &plain(&rows));
            },
            &["the centre of", "353.6 mm", "another machine"],
        ),
        (
            "two machines",
            |bench| {
                let rows = circle(1600.0, 15.0, (0.0, 3));
                bench.put(&take_of(1600.0, 1), &plain(&rows));
            },
            &["at F1600 X", "one recording leaves", "another machine"],
        ),
        (
            "no times",
            |bench| {
                let text = plain(&circle(1600.0, 5.0, (0.0, 9)));
                let rows = text.lines().filter_map(|line| line.split_once(','));
                let rows: Vec<&str> = rows.map(|it| it.1).collect();
                bench.put(&take_of(1600.0, 1), &rows.join("\n"));
            },
            &["has no times, so its feed is not known"],
        ),
        (
            "a row every 4 ms",
            |bench| {
                let rows: Vec<Row> = circle(1600.0, 5.0, (0.0, 9))
                    .into_iter()
                    .step_by(4)
                    .collect();
                bench.put(&take_of(1600.0, 1), &plain(&rows));
            },
            &["a sample every 4.0 ms does not show", "with every cycle"],
        ),
        (
            "a copy",
            |bench| bench.put(&take_of(2800.0, 1), &bench.read(&take_of(2800.0, 0))),
            &["is a copy of", "record each circle twice"],
        ),
    ];
    for (name, change, words) in wrong {
        let bench = recorded();
        let before = bench.read("learning/learning.json");
        change(&bench);
        let (status, text) = bench.learn(&[]);
        assert_eq!(status, Some(2), "{name}: {text}");
        for word in words {
            assert!(text.contains(word), "{name}: {text}");
        }
        assert_eq!(bench.read("learning/learning.json"), before, "{name}");
        assert!(!bench.path("learning/round-2").exists(), "{name}");
    }
}

/// R16.9: no list adds more than 1.3 times the measured friction, the first one included; nothing begins without
/// it or twice.
#[test]
fn a_beginning_that_is_not_safe_is_refused() {
    let bench = Bench::new(PresetMachine::small(), &SMALL);
    let (status, text) = bench.learn(&[]);
    assert_eq!(status, Some(2), "{text}");
    assert!(text.contains("begin with the measured friction"), "{text}");
    let strong = bench.read("friction-X.lis");
    bench.put(
        "strong.lis",
        &strong.replace("scaling_factor       1000", "scaling_factor       1400"),
    );
    let (status, text) = bench.begin(&["--value-list", "strong.lis"]);
    assert_eq!(status, Some(2), "{text}");
    assert!(text.contains("1.40 times the measured friction"), "{text}");
    assert!(!bench.path("learning/learning.json").exists());
    assert_eq!(bench.begin(&[]).0, Some(1));
    let (status, text) = bench.begin(&[]);
    assert_eq!(status, Some(2), "{text}");
    assert!(text.contains("learning has begun"), "{text}");
}

/// R16.9: results from a recording are dropped with it.
pub(crate) fn changed_after_a_round(bench: &Bench) {
    let name = take_of(1200.0, 0);
    let rows = bench.read(&name);
    bench.put(&name, &format!("{rows}\n"));
    let (status, text) = bench.learn(&[]);
    assert_eq!(status, Some(2), "{text}");
    assert!(
        text.contains("F1200-0.csv` was added, changed or removed"),
        "{text}"
    );
    assert!(text.contains("remove the folder of round 2"), "{text}");
    bench.put(&name, &rows);
    assert_eq!(bench.learn(&[]).0, Some(1));
}
