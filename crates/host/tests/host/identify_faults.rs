//! Faulty recordings: each fault is named before any list (R6.21).

mod faults;

use std::path::Path;
use std::sync::LazyLock;

use crate::recordings::FRICTION;
use frictcomp::diagnostic::Code;
use frictcomp_host::{Disk, read_axis};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_recordings::identify::{
    AxisRecording, Identified, IdentifyError, IdentifyOptions, Measured, Predictor, TorqueKind,
    Track, identify, verify_recording,
};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_testing::recorded_drive::Bench;

/// Returns the recording of the demo.
fn demo() -> Track {
    let selection = ChannelSelection {
        velocity: Some("SetVelo".to_owned()),
        torque: Some("ActTorque".to_owned()),
        ..ChannelSelection::default()
    };
    let axis = read_axis(Path::new(FRICTION), &selection, None, &Disk::default()).expect("an axis");
    assert_eq!(axis.measured.kind, Some(TorqueKind::Actual));
    axis.track
}

/// Returns a recording of a simulation that is independent of the crate; up and down.
fn simulated() -> Track {
    static TRACK: LazyLock<Track> = LazyLock::new(simulate);
    TRACK.clone()
}

fn simulate() -> Track {
    let bench = Bench {
        speeds: vec![0.2, 0.6, 2.0, 6.0, 20.0, 60.0, 160.0],
        noise_n: 40.0,
        is_up_and_down: true,
        length_s: 40.0,
        ..Bench::default()
    };
    let recorded = bench.record();
    Track {
        times_s: recorded.t,
        velocities: Some(recorded.v),
        positions: Some(recorded.x),
        torques: recorded.torque,
        step_s: 0.001,
    }
}

/// Returns both recordings.
fn both() -> [(&'static str, Track); 2] {
    [("demo", demo()), ("simulation", simulated())]
}

fn found(track: &Track) -> Result<Identified, IdentifyError> {
    identify(track, &IdentifyOptions::default())
}

/// Returns the code and the message that come first: of the refusal, or before the list.
fn first(track: &Track) -> Option<(Code, String)> {
    said(&found(track))
}

fn said(result: &Result<Identified, IdentifyError>) -> Option<(Code, String)> {
    match result {
        Err(IdentifyError::Refused(finding)) => Some((finding.code, finding.message.clone())),
        Err(other) => panic!("{other}"),
        Ok(found) => {
            let finding = found.findings.first()?;
            Some((finding.code, finding.message.clone()))
        }
    }
}

fn is_refused(track: &Track) -> bool {
    matches!(found(track), Err(IdentifyError::Refused(_)))
}

/// Puts a fault into both recordings; the code that comes first, and words of its message.
fn names(fault: impl Fn(&mut Track), code: Code, words: &str) {
    for (name, mut track) in both() {
        fault(&mut track);
        let (first, message) = first(&track).unwrap_or_else(|| panic!("{name}: silent"));
        assert_eq!(first, code, "{name}: {message}");
        assert!(message.contains(words), "{name}: {message}");
    }
}

fn velocities(track: &mut Track) -> &mut Vec<f64> {
    track.velocities.as_mut().expect("velocities")
}

/// The codes of faulty recordings.
const DOUBTS: [Code; 7] = [
    Code::Fc520,
    Code::Fc521,
    Code::Fc522,
    Code::Fc523,
    Code::Fc524,
    Code::Fc525,
    Code::Fc526,
];

#[test]
fn a_list_is_not_verified_by_what_identifies_none() {
    // R6.20, R6.21
    let track = simulated();
    let list = found(&track).expect("friction").list();
    let predictor = Predictor {
        list: &list,
        reading: Reading::default(),
        cycle_s: None,
    };
    let verified = |change: &dyn Fn(&mut Track)| {
        let mut changed = track.clone();
        change(&mut changed);
        let mut recording = AxisRecording::from(changed);
        let verified = verify_recording(&mut recording, &predictor);
        (verified, recording.findings)
    };
    let (right, findings) = verified(&|_| ());
    assert!(right.expect("a verdict").fits(), "{findings:?}");
    let (lacking, findings) = verified(&|track| {
        for values in [&mut track.times_s, &mut track.torques] {
            values.drain(20_000..20_500);
        }
        for values in [&mut track.velocities, &mut track.positions] {
            values.as_mut().expect("motion").drain(20_000..20_500);
        }
    });
    let lacking = lacking.expect("a verdict");
    assert!(lacking.is_doubted && !lacking.fits(), "{findings:?}");
    assert!(findings.iter().any(|it| it.code == Code::Fc525));
    let (none, _) = verified(&|track| track.torques.fill(0.0));
    assert!(
        matches!(none, Err(IdentifyError::NoFriction { .. })),
        "{none:?}"
    );
    let (absolute, _) = verified(&|track| {
        let torques = track.torques.iter_mut();
        torques.for_each(|torque| *torque = torque.abs());
    });
    assert!(absolute.is_err(), "{absolute:?}");
}

#[test]
fn good_recordings_are_not_doubted() {
    // R6.21
    for (name, track) in both() {
        let found = found(&track).expect(name);
        let doubted = found.findings.iter().find(|it| DOUBTS.contains(&it.code));
        assert_eq!(doubted, None, "{name}");
    }
    // Without noise, without quantised torque, at speeds that reach the greatest torque at last.
    for noise_n in [0.0, 2.0, 300.0] {
        let recorded = Bench {
            noise_n,
            ripple_n: 60.0,
            length_s: 10.0,
            speeds: vec![0.5, 2.0, 10.0, 40.0, 120.0],
            ..Bench::default()
        }
        .record();
        let track = Track {
            times_s: recorded.t,
            velocities: Some(recorded.v),
            positions: Some(recorded.x),
            torques: recorded.torque,
            step_s: 0.001,
        };
        let found = found(&track).expect("friction");
        let doubted = found.findings.iter().find(|it| DOUBTS.contains(&it.code));
        assert_eq!(doubted, None, "{noise_n}");
    }
}

#[test]
fn friction_alone_without_noise_is_not_clipped() {
    // R6.21: a made-up torque with no acceleration reaches its greatest value at the fastest speed.
    let speeds = [0.5_f64, 2.0, 10.0, 40.0, 120.0];
    let mut track = Track {
        step_s: 0.001,
        ..Track::default()
    };
    let mut velocities = Vec::new();
    for (at, speed) in speeds.iter().flat_map(|it| [*it, -*it]).enumerate() {
        for sample in 0..1500 {
            track.times_s.push((at * 1500 + sample) as f64 * 0.001);
            velocities.push(speed * 1000.0);
            track.torques.push(speed.signum() * (100.0 + speed.abs()));
        }
    }
    track.velocities = Some(velocities);
    assert_eq!(first(&track).filter(|it| DOUBTS.contains(&it.0)), None);
    // The same friction at all speeds.
    for torque in &mut track.torques {
        *torque = 100.0 * torque.signum();
    }
    assert_eq!(first(&track).filter(|it| DOUBTS.contains(&it.0)), None);
}

#[test]
fn clipped_torque_is_named() {
    // R6.21: at one speed its segments are left out, at more the recording is refused.
    for (name, track) in both() {
        let whole = found(&track).expect(name);
        let last = whole.pairs.len() - 1;
        let limit = f64::midpoint(whole.pairs[last].friction, whole.pairs[last - 1].friction);
        let limit = (limit + whole.offset.abs()).round();
        let mut clipped = track.clone();
        for torque in &mut clipped.torques {
            *torque = torque.clamp(-limit, limit);
        }
        let result = found(&clipped);
        let (code, message) = said(&result).expect("a fault");
        assert_eq!(code, Code::Fc520, "{name}: {message}");
        assert!(message.contains("1 of 7 speeds"), "{name}: {message}");
        let left = result.expect("a list of the others");
        assert!(left.pairs.len() >= last, "{name}");
        for (one, other) in left.pairs.iter().zip(&whole.pairs) {
            assert!((one.friction / other.friction - 1.0).abs() < 0.01, "{name}");
        }
        for limit in [0.98, 0.7].map(|part| (part * whole.pairs[last - 2].friction).round()) {
            for torque in &mut clipped.torques {
                *torque = torque.clamp(-limit, limit);
            }
            let (code, message) = first(&clipped).expect("a fault");
            assert_eq!(code, Code::Fc520, "{name}: {message}");
            assert!(is_refused(&clipped), "{name}: {message}");
        }
    }
}

#[test]
fn compensation_that_was_on_is_named() {
    // R6.21: the torque minus what a list adds, too low, right, too high.
    for (name, track) in both() {
        let curve = found(&track).expect(name).curve;
        for part in [0.9, 1.0, 1.3] {
            let mut compensated = track.clone();
            let speeds = compensated.velocities.clone().expect("velocities");
            for (torque, speed) in compensated.torques.iter_mut().zip(&speeds) {
                if *speed != 0.0 {
                    *torque -= part * curve.at(speed.abs() / 1000.0) * speed.signum();
                }
            }
            let (code, message) = first(&compensated).expect("a fault");
            assert_eq!(code, Code::Fc521, "{name} {part}: {message}");
            assert!(is_refused(&compensated), "{name} {part}");
        }
        // A list with one value for all speeds.
        let mut compensated = track.clone();
        let speeds = compensated.velocities.clone().expect("velocities");
        let level = curve.at(5.0);
        for (torque, speed) in compensated.torques.iter_mut().zip(&speeds) {
            if *speed != 0.0 {
                *torque -= level * 0.92 * speed.signum();
            }
        }
        let (code, message) = first(&compensated).expect("a fault");
        assert_eq!(code, Code::Fc521, "{name}: {message}");
    }
}

#[test]
fn what_the_torque_holds_is_asked() {
    // R6.21: a list only from a torque that contains what is added, or if nothing was added.
    let track = demo();
    let options = |kind, compensation| IdentifyOptions {
        measured: Measured {
            kind,
            compensation,
            ..Measured::default()
        },
        ..IdentifyOptions::default()
    };
    let said = |kind, compensation| said(&identify(&track, &options(kind, compensation)));
    let loop_output = Some(TorqueKind::Loop);
    assert_eq!(said(Some(TorqueKind::Actual), Some(Switched::On)), None);
    assert_eq!(said(loop_output, Some(Switched::Off)), None);
    assert_eq!(said(None, Some(Switched::Off)), None);
    for (kind, compensation, refused) in [
        (loop_output, None, true),
        (loop_output, Some(Switched::On), true),
        (None, Some(Switched::On), true),
        (None, None, false),
        (Some(TorqueKind::Command), None, false),
    ] {
        let result = identify(&track, &options(kind, compensation));
        assert_eq!(result.is_err(), refused, "{kind:?} {compensation:?}");
        let (code, _) = self::said(&result).expect("a doubt");
        assert_eq!(code, Code::Fc521, "{kind:?} {compensation:?}");
    }
}

#[test]
fn a_statement_that_the_recording_contradicts_gives_no_list() {
    // R6.21: a loop that is compensated to 60 % looks like one with less friction.
    let mut compensated = demo();
    let curve = found(&compensated).expect("a curve").curve;
    let speeds = compensated.velocities.clone().expect("velocities");
    for (torque, speed) in compensated.torques.iter_mut().zip(&speeds) {
        if *speed != 0.0 {
            *torque -= 0.6 * curve.at(speed.abs() / 1000.0) * speed.signum();
        }
    }
    let [actual, loop_output] = [TorqueKind::Actual, TorqueKind::Loop].map(Some);
    let [on, off] = [Switched::On, Switched::Off].map(Some);
    // What the recording shows, the message, and whether there is no list.
    for (shown, said, refused) in [
        ((loop_output, None), (actual, None), true),
        ((loop_output, on), (actual, None), true),
        ((loop_output, off), (actual, None), false),
        ((loop_output, on), (None, off), true),
        ((None, on), (None, off), true),
        ((actual, on), (None, off), false),
    ] {
        let (kind, compensation) = shown;
        let recorded = Measured {
            kind,
            compensation,
            ..Measured::default()
        };
        let options = IdentifyOptions {
            measured: recorded.stated(said.0, said.1),
            ..IdentifyOptions::default()
        };
        let result = identify(&compensated, &options);
        assert_eq!(result.is_err(), refused, "{shown:?} {said:?}");
        let (code, message) = self::said(&result).expect("a doubt");
        assert_eq!(code, Code::Fc521, "{message}");
        assert!(message.contains(" given as "), "{message}");
    }
    // A statement that agrees with the recording raises no doubt.
    let agreed = Measured::default().stated(actual, off);
    assert_eq!(agreed.contradiction, None);
}

#[test]
fn inverted_signs_are_named() {
    // R6.21
    let invert = |values: &mut Vec<f64>| values.iter_mut().for_each(|it| *it = -*it);
    names(|it| invert(&mut it.torques), Code::Fc522, "inverted");
    names(
        |it| {
            invert(velocities(it));
            it.positions = None;
        },
        Code::Fc522,
        "inverted",
    );
    let mut opposite = simulated();
    invert(velocities(&mut opposite));
    let (code, message) = first(&opposite).expect("a fault");
    assert_eq!(code, Code::Fc522);
    assert!(
        message.contains("the position goes against the velocity"),
        "{message}"
    );
    assert!(is_refused(&opposite));
}

#[test]
fn absolute_values_are_named() {
    // R6.21
    let absolute = |values: &mut Vec<f64>| values.iter_mut().for_each(|it| *it = it.abs());
    names(
        |it| absolute(&mut it.torques),
        Code::Fc523,
        "absolute value",
    );
    names(|it| absolute(velocities(it)), Code::Fc523, "absolute value");
    names(
        |it| {
            absolute(velocities(it));
            it.positions = None;
        },
        Code::Fc523,
        "absolute value",
    );
    // A vertical axis that is heavier than its friction never pulls downwards.
    let mut heavy = simulated();
    heavy.torques.iter_mut().for_each(|it| *it += 900.0);
    let found = found(&heavy).expect("friction");
    assert!(found.findings.iter().all(|it| it.code != Code::Fc523));
}

#[test]
fn a_factor_of_ten_is_named() {
    // R6.21
    let times = |factor: f64| {
        move |it: &mut Track| it.torques.iter_mut().for_each(|torque| *torque *= factor)
    };
    names(times(10.0), Code::Fc524, "% of the rated torque");
    names(times(0.1), Code::Fc521, "the unit is ten times as large");
    for factor in [0.1, 10.0] {
        let mut track = demo();
        times(factor)(&mut track);
        assert!(is_refused(&track));
        // It is not known how many newton metres the drive has.
        let mut options = IdentifyOptions::default();
        options.measured.rated = None;
        assert!(identify(&track, &options).is_ok());
    }
}

#[test]
fn missing_rows_are_counted() {
    // R6.21
    let drop = |it: &mut Track| {
        let kept = |at: usize| !(3000..3037).contains(&at) && !(7000..7004).contains(&at);
        let rows: Vec<usize> = (0..it.times_s.len()).filter(|&at| kept(at)).collect();
        let pick = |values: &[f64]| rows.iter().map(|&at| values[at]).collect::<Vec<f64>>();
        it.times_s = pick(&it.times_s);
        it.torques = pick(&it.torques);
        it.velocities = it.velocities.as_deref().map(pick);
        it.positions = it.positions.as_deref().map(pick);
    };
    names(drop, Code::Fc525, "41 rows are missing at 2 places");
}

#[test]
fn a_tight_spot_is_named_with_its_place() {
    // R6.21: 12 % more between 30 and 45 % of the travel, in both directions.
    let tighten = |it: &mut Track| {
        let speeds = it.velocities.clone().expect("velocities");
        let mut place = 0.0;
        let places: Vec<f64> = speeds
            .iter()
            .map(|speed| {
                place += speed / 1000.0 * it.step_s;
                place
            })
            .collect();
        let most = places.iter().fold(0.0_f64, |most, it| most.max(*it));
        for ((torque, speed), place) in it.torques.iter_mut().zip(&speeds).zip(&places) {
            if *speed != 0.0 && (0.3 * most..0.45 * most).contains(place) {
                *torque += 14.0 * speed.signum();
            }
        }
    };
    names(tighten, Code::Fc526, "in both directions");
}
