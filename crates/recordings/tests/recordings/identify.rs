//! Friction is recovered from recordings of a drive whose friction is known.

mod bound;
mod circles;

use std::fmt::Write as _;

use frictcomp::diagnostic::Code;
use frictcomp::lists::TablePoint;
use frictcomp_physics::current::Reading;
use frictcomp_recordings::identify::{
    FrictionCurve, Identified, IdentifyError, IdentifyOptions, Predictor, RequestedPoints, Track,
    TrackError, identify, verify,
};
use frictcomp_testing::recorded_drive::{ASYMMETRY, Bench, FC, FV, Recorded, UNIT, VS, WEIGHT};

fn track(recorded: Recorded) -> Track {
    Track {
        times_s: recorded.t,
        velocities: Some(recorded.v),
        positions: Some(recorded.x),
        torques: recorded.torque,
        step_s: 0.001,
    }
}

fn identified(bench: &Bench) -> Identified {
    identify(&track(bench.record()), &IdentifyOptions::default()).expect("friction")
}

/// Returns the value of a list at a speed in mm/s.
fn along(points: &[TablePoint], speed: f64) -> f64 {
    let at = points.partition_point(|point| point.input < speed * 1000.0);
    match (at.checked_sub(1).map(|at| &points[at]), points.get(at)) {
        (Some(one), Some(other)) => {
            let share = (speed * 1000.0 - one.input) / (other.input - one.input);
            one.output + share * (other.output - one.output)
        }
        (Some(end), None) | (None, Some(end)) => end.output,
        (None, None) => f64::NAN,
    }
}

/// Errors of a list in per cent of Fc: rms, greatest, and that at standstill; then that of the offset
/// in N.
fn errors(bench: &Bench, found: &Identified) -> [f64; 4] {
    let (low, high) = (bench.speeds[0], bench.speeds[bench.speeds.len() - 1]);
    let percent = |speed: f64, value: f64| (value * UNIT - bench.friction(speed)) / FC * 100.0;
    let off: Vec<f64> = (0..400)
        .map(|at| low * (high / low).powf(f64::from(at) / 399.0))
        .map(|speed| percent(speed, along(&found.points, speed)))
        .collect();
    let squares: f64 = off.iter().map(|it| it * it).sum();
    let greatest = off.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    [
        (squares / 400.0).sqrt(),
        greatest,
        percent(low, found.points[0].output).abs(),
        (found.offset * UNIT - WEIGHT - ASYMMETRY).abs(),
    ]
}

/// A case of the acceptance with the permitted errors.
struct Case {
    name: &'static str,
    bench: Bench,
    limits: [f64; 4],
}

/// Permitted error of the offset, in N.
const OFFSET: f64 = 2.0;

/// Permitted 95th percentile of the error of the offset in N: 1.2 times the Cramér–Rao bound from the samples of R6.10,
/// which is 2.24 N for coloured noise and 1.78 N for white noise of 5 %. The median of the pairs comes within a fifth
/// of it, of which forty recordings alone explain 15 %.
const COLOURED: f64 = 1.2 * 2.24;
const LOUD: f64 = 1.2 * 1.78;

fn cases() -> Vec<Case> {
    let case = |name, bench, limits| Case {
        name,
        bench,
        limits,
    };
    let plain = Bench::default;
    vec![
        case("white noise 2 %", plain(), [0.6, 1.5, 0.5, OFFSET]),
        case(
            "coloured noise, 5 ms",
            Bench {
                colour_s: 0.005,
                ..plain()
            },
            [1.5, 4.0, 1.0, COLOURED],
        ),
        case(
            "white noise 5 %",
            Bench {
                noise_n: 250.0,
                ..plain()
            },
            [1.0, 3.0, 0.8, LOUD],
        ),
        case(
            "ripple 100 N",
            Bench {
                ripple_n: 100.0,
                ..plain()
            },
            [1.8, 2.5, 1.1, OFFSET],
        ),
        case(
            "drift -10 %, up and down",
            Bench {
                drift: -0.1,
                is_up_and_down: true,
                ..plain()
            },
            [0.6, 1.2, 0.5, OFFSET],
        ),
        case(
            "actual velocity",
            Bench {
                velocity_noise: Some(1.0),
                ..plain()
            },
            [0.8, 1.6, 0.7, OFFSET],
        ),
        case(
            "concave",
            Bench {
                is_concave: true,
                ..plain()
            },
            [0.9, 2.5, f64::INFINITY, OFFSET],
        ),
    ]
}

/// Returns the 95th percentile.
fn percentile(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(values.len() * 95).div_ceil(100) - 1]
}

/// Runs every case with a number of seeds; returns the table.
fn accept(seeds: u64) -> String {
    let mut table =
        String::from("case                        rms        max        f(0+)     offset N\n");
    let mut worse = Vec::new();
    for case in cases() {
        let runs: Vec<[f64; 4]> = (1..=seeds)
            .map(|seed| {
                let bench = Bench {
                    seed,
                    ..case.bench.clone()
                };
                errors(&bench, &identified(&bench))
            })
            .collect();
        let _ = write!(table, "{:<24}", case.name);
        for (at, limit) in case.limits.into_iter().enumerate() {
            let found = percentile(runs.iter().map(|run| run[at]).collect());
            let _ = write!(table, " {found:>5.2}/{limit:<4}");
            if found > limit {
                worse.push(format!("{}: {found} is more than {limit}", case.name));
            }
        }
        table += "\n";
    }
    assert!(worse.is_empty(), "{table}\n{worse:?}");
    table
}

#[test]
fn the_offset_of_coloured_noise_cannot_be_known_better() {
    // R6.12: what the limits of the acceptance are measured by.
    let bounds = cases()
        .into_iter()
        .take(3)
        .map(|it| bound::offset_bound(&it.bench));
    let bounds: Vec<String> = bounds.map(|bound| format!("{bound:.2}")).collect();
    assert_eq!(bounds, ["0.71", "2.24", "1.78"]);
}

#[test]
fn friction_is_found_within_the_limits() {
    // R6.10 R6.11 R6.12 R6.13 R6.15 R6.17
    accept(1);
}

#[test]
#[ignore = "forty recordings of every case"]
fn friction_is_found_within_the_limits_of_the_acceptance() {
    // R6.10 R6.12 R6.15
    // The table is its purpose.
    #[allow(clippy::print_stdout)]
    {
        println!("{}", accept(40));
    }
}

#[test]
fn parameters_and_offset_are_those_of_the_plant() {
    // R6.12 R6.15
    for seed in 1..=2 {
        let found = identified(&Bench {
            seed,
            ..Bench::default()
        });
        let fit = found.used_fit().expect("a fit");
        let off = |found: f64, wanted: f64| (found / wanted - 1.0).abs() * 100.0;
        assert!(off(fit.coulomb * UNIT, FC) < 1.0, "{fit:?}");
        assert!(off(fit.viscous * UNIT, FV) < 2.5, "{fit:?}");
        assert!((fit.stribeck - VS).abs() < 0.3, "{fit:?}");
        let offset = found.offset * UNIT;
        assert!((offset - WEIGHT - ASYMMETRY).abs() < 2.0, "{offset}");
    }
}

#[test]
fn the_sign_is_that_of_the_torque_at_positive_velocity() {
    // R6.14
    let recorded = Bench::default().record();
    let mut turned = track(recorded);
    for torque in &mut turned.torques {
        *torque = -*torque;
    }
    let found = identify(&turned, &IdentifyOptions::default()).expect("friction");
    assert!(found.points.iter().all(|point| point.output < 0.0));
    let fit = found.used_fit().expect("a fit");
    assert!(
        fit.coulomb < 0.0 && fit.breakaway < fit.coulomb && fit.viscous < 0.0,
        "{fit:?}"
    );
}

#[test]
fn few_points_stay_close_to_the_curve() {
    // R6.17
    let bench = Bench {
        noise_n: 5.0,
        ripple_n: 0.0,
        ..Bench::default()
    };
    let track = track(bench.record());
    for (points, limit) in [(4, 1.7), (5, 0.9), (8, 0.3), (20, 0.04)] {
        let options = with(RequestedPoints::Points(points));
        let found = identify(&track, &options).expect("friction");
        assert!(found.points.len() <= points);
        assert_eq!(found.points[0].input, 0.0);
        assert!(
            found
                .points
                .windows(2)
                .all(|pair| pair[0].input < pair[1].input)
        );
        let last = found.points.last().expect("points").input / 1000.0;
        assert!((last / 200.0 - 1.0).abs() < 0.01, "{last}");
        assert!(
            found.point_error * UNIT / FC * 100.0 < limit,
            "{points}: {}",
            found.point_error
        );
    }
    let found = identify(
        &track,
        &with(RequestedPoints::Error {
            part: 0.01,
            most: 20,
        }),
    )
    .expect("friction");
    assert!(found.points.len() <= 5, "{}", found.points.len());
    assert!(found.point_error * UNIT / FC <= 0.01);
}

fn with(wanted: RequestedPoints) -> IdentifyOptions {
    IdentifyOptions {
        wanted,
        ..IdentifyOptions::default()
    }
}

fn codes(found: &Identified) -> Vec<Code> {
    found.findings.iter().map(|finding| finding.code).collect()
}

#[test]
fn below_the_slowest_speed_nothing_is_extrapolated() {
    // R6.16
    let bench = Bench {
        speeds: vec![5.0, 8.0, 12.0, 20.0, 50.0, 100.0],
        ..Bench::default()
    };
    let found = identified(&bench);
    assert!(codes(&found).contains(&Code::Fc511), "{:?}", found.findings);
    let held = found.points[0].output;
    assert!((held - found.curve.at(found.pairs[0].speed)).abs() < 1e-9);
    assert!(
        (held * UNIT / bench.friction(5.0) - 1.0).abs() < 0.02,
        "{held}"
    );
}

#[test]
fn what_a_recording_lacks_is_said() {
    // R6.12 R6.13 R6.15 R6.16
    let short = |bench: Bench| Bench {
        length_s: 20.0,
        ..bench
    };
    let slow = short(Bench {
        speeds: vec![0.2, 1.0, 3.0, 10.0],
        ..Bench::default()
    });
    assert!(codes(&identified(&slow)).contains(&Code::Fc512));
    let three = short(Bench {
        speeds: vec![0.2, 5.0, 50.0],
        ..Bench::default()
    });
    assert!(codes(&identified(&three)).contains(&Code::Fc514));
    let noisy = Bench {
        noise_n: 1500.0,
        ..Bench::default()
    };
    assert!(codes(&identified(&noisy)).contains(&Code::Fc515));
    let ripple = identified(&Bench {
        ripple_n: 100.0,
        ..Bench::default()
    });
    assert!(codes(&ripple).contains(&Code::Fc513));
    let period = ripple.ripple.expect("ripple").period;
    assert!((period - 10.0).abs() < 0.1, "{period}");
    let drifting = identified(&Bench {
        drift: -0.1,
        is_up_and_down: true,
        ..Bench::default()
    });
    assert!(
        codes(&drifting).contains(&Code::Fc516),
        "{:?}",
        drifting.drift
    );
    let part = drifting.drift.expect("visits").part;
    assert!((part + 0.1).abs() < 0.02, "{part}");
    let concave = identified(&Bench {
        is_concave: true,
        noise_n: 20.0,
        ..Bench::default()
    });
    assert!(codes(&concave).contains(&Code::Fc517));
    assert!(matches!(concave.curve, FrictionCurve::Lines(_)));
    // There are no remarks if nothing is odd.
    let good = identified(&Bench {
        ripple_n: 0.0,
        ..Bench::default()
    });
    assert!(codes(&good).is_empty(), "{:?}", good.findings);
}

#[test]
fn a_speed_in_one_direction_is_kept_less_the_offset() {
    // R6.12
    let bench = Bench::default();
    let mut recorded = bench.record();
    // The last speed backwards is cut off.
    let until = recorded.v.iter().rposition(|v| *v > 0.0).expect("forwards");
    recorded.t.truncate(until);
    recorded.v.truncate(until);
    recorded.x.truncate(until);
    recorded.torque.truncate(until);
    let found = identify(&track(recorded), &IdentifyOptions::default()).expect("friction");
    assert!(codes(&found).contains(&Code::Fc518));
    let last = found.pairs.last().expect("pairs");
    assert_eq!(last.offset, None);
    assert!(
        (last.friction * UNIT / bench.friction(200.0) - 1.0).abs() < 0.01,
        "{last:?}"
    );
}

#[test]
fn recordings_without_friction_are_refused() {
    // R6.10 R6.12
    let refused =
        |track: &Track| identify(track, &IdentifyOptions::default()).expect_err("no friction");
    let forwards = Bench {
        is_both: false,
        length_s: 20.0,
        ..Bench::default()
    };
    assert_eq!(
        refused(&track(forwards.record())),
        IdentifyError::OneDirection
    );
    let good = || {
        track(
            Bench {
                length_s: 30.0,
                ..Bench::default()
            }
            .record(),
        )
    };
    let still = Track {
        velocities: Some(vec![0.0; good().times_s.len()]),
        positions: None,
        ..good()
    };
    assert_eq!(refused(&still), IdentifyError::NoSegments);
    let mut constant = good();
    constant.torques.fill(7.0);
    assert!(matches!(
        refused(&constant),
        IdentifyError::NoFriction { .. }
    ));
    let mut metres = good();
    for velocity in metres.velocities.iter_mut().flatten() {
        *velocity /= 1000.0;
    }
    assert!(matches!(
        refused(&metres),
        IdentifyError::Track(TrackError::Apart { .. })
    ));
    for absurd in [f64::NAN, f64::INFINITY, 1e308] {
        let mut track = good();
        track.torques[100] = absurd;
        assert!(matches!(
            refused(&track),
            IdentifyError::Track(TrackError::Absurd { .. })
        ));
    }
    assert!(matches!(
        refused(&Track::default()),
        IdentifyError::Track(TrackError::Short { .. })
    ));
    let slow = Track {
        step_s: 1.0,
        ..good()
    };
    assert!(matches!(
        refused(&slow),
        IdentifyError::Track(TrackError::Slow { .. })
    ));
}

#[test]
fn friction_above_the_rated_torque_at_any_speed_is_no_list() {
    // R6.21
    let track = track(Bench::default().record());
    let found = identify(&track, &IdentifyOptions::default()).expect("friction");
    let frictions = found.pairs.iter().map(|pair| pair.friction.abs());
    let most = frictions.fold(0.0, f64::max);
    let with = |rated: f64| {
        let mut options = IdentifyOptions::default();
        options.measured.rated = Some(rated);
        identify(&track, &options)
    };
    assert!(with(1.1 * most).is_ok());
    let error = with(0.9 * most).expect_err("one speed above it");
    assert!(error.to_string().contains("of the rated torque"), "{error}");
}

#[test]
fn friction_that_differs_by_direction_fits_no_list() {
    // R6.20 R6.25: an offset, such as a weight, is no such difference.
    let even = track(Bench::default().record());
    let list = identify(&even, &IdentifyOptions::default())
        .expect("friction")
        .list();
    let verified = |torque: fn(f64, f64) -> f64| {
        let mut changed = even.clone();
        let velocities = even.velocities.as_ref().expect("velocities");
        for (value, velocity) in changed.torques.iter_mut().zip(velocities) {
            *value = torque(*value, *velocity);
        }
        let predictor = Predictor {
            list: &list,
            reading: Reading::default(),
            cycle_s: None,
        };
        verify(&changed, &predictor).expect("a verdict")
    };
    for torque in [|value, _| value, |value, _| value + 60.0] {
        let fits = verified(torque);
        assert!(fits.one_sided.is_none(), "{:?}", fits.one_sided);
    }
    let found = verified(|value, velocity| value * if velocity > 0.0 { 1.5 } else { 0.5 });
    assert!(!found.agrees(), "{:?}", found.ranges);
    let said = found.verdict().join("; ");
    assert!(said.contains("friction differs by direction"), "{said}");
}

#[test]
fn a_position_alone_is_enough() {
    // R6.10
    let bench = Bench::default();
    let track = Track {
        velocities: None,
        ..track(bench.record())
    };
    let found = identify(&track, &IdentifyOptions::default()).expect("friction");
    let [rms, greatest, ..] = errors(&bench, &found);
    assert!(rms < 0.8 && greatest < 2.0, "{rms} {greatest}");
}
