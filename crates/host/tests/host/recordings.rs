//! The recordings of the demo: made by the tool's own plant, and what the tool finds in them.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use frictcomp::diagnostic::Code;
use frictcomp_host::{Disk, read_axis};
use frictcomp_physics::simulation::{
    Drive, FrictionModel, POSITION_LOOP_S, Preset, SPEED_LOOP_S, STEP_S, Setpoint,
};
use frictcomp_recordings::identify::{IdentifyOptions, identify};
use frictcomp_recordings::trace::{ChannelSelection, Unit};

pub(crate) const FRICTION: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../programs/demo/recordings/friction_x.csv"
);

/// The time between two rows in s.
const ROW_S: f64 = 0.004;

/// Speeds in mm/s, each back and forth, increasing, then decreasing.
const SPEEDS: [f64; 7] = [0.2, 0.6, 1.8, 5.0, 15.0, 45.0, 120.0];

/// Returns the commanded velocities, in m/s every 250 µs.
fn commanded() -> Vec<f64> {
    const ACCELERATION: f64 = 1.0;
    const STEADY_S: f64 = 1.2;
    const PAUSE_S: f64 = 0.12;
    let steps = |seconds: f64| (seconds / POSITION_LOOP_S).round() as usize;
    let mut velocities = vec![0.0; steps(0.2)];
    for speed in SPEEDS.iter().chain(SPEEDS.iter().rev()) {
        for sign in [1.0, -1.0] {
            let top = sign * speed / 1000.0;
            let ramp = steps(speed / 1000.0 / ACCELERATION).max(1);
            let rising: Vec<f64> = (0..ramp).map(|at| top * at as f64 / ramp as f64).collect();
            velocities.extend(&rising);
            velocities.extend(vec![top; steps(STEADY_S)]);
            velocities.extend(rising.iter().rev());
            velocities.extend(vec![0.0; steps(PAUSE_S)]);
        }
    }
    velocities
}

/// Returns the recording as TwinCAT Scope exports it.
fn recording() -> String {
    let plant = Preset::Stiff.plant();
    let drive = &plant.x;
    let mut axis = Drive::settled(drive, FrictionModel::Lugre, Setpoint::default());
    let mut text = "Name\tfriction_x\nFile\tmade by frictcomp with its plant `stiff`: no machine was recorded\n\
                    Starttime of export\t133000000000000000\nEndtime of export\t133000000500000000\n\n\n\
                    Name\tSetVelo\tActTorque\n\
                    SymbolComment\tcommanded velocity of X\tactual torque of X\n\
                    Data-Type\tINT32\tINT16\nSampleTime[ms]\t4\t4\n\
                    IndexGroup\t1180416\t1180416\nIndexOffset\t65541\t65559\n\
                    SymbolName\tX.SetVelo\tX.ActTorque\nUnit\tµm/s\t0.1%\n\n"
        .to_owned();
    let mut position = 0.0;
    let every = (ROW_S / POSITION_LOOP_S).round() as usize;
    let mut noise = 1_u64;
    for (at, velocity) in commanded().into_iter().enumerate() {
        if at % every == 0 {
            // Two drive units of noise, the same in every run.
            noise = noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let part = (noise >> 33) as f64 / (1_u64 << 31) as f64 - 0.5;
            let torque = axis.force_n() / drive.force_per_unit_n + 5.0 * part;
            let _ = writeln!(
                text,
                "{}\t{}\t{}",
                at / every * 4,
                (velocity * 1e6).round(),
                torque.round()
            );
        }
        position += velocity * POSITION_LOOP_S;
        axis.follow(Setpoint {
            position_m: position,
            velocity_m_per_s: velocity,
            ..Setpoint::default()
        });
        for step in 0..(POSITION_LOOP_S / STEP_S).round() as usize {
            if step % (SPEED_LOOP_S / STEP_S).round() as usize == 0 {
                axis.control();
            }
            axis.step();
        }
    }
    text.push_str("EOF\n");
    text
}

#[test]
#[ignore = "writes the recording again"]
fn the_recording_is_made() {
    fs::create_dir_all(Path::new(FRICTION).parent().expect("a folder")).expect("a folder");
    fs::write(FRICTION, recording()).expect("written");
}

#[test]
fn the_recording_is_that_of_the_plant() {
    // R6.18
    let length = fs::metadata(FRICTION).expect("a recording").len();
    assert!(length < 300_000, "{length}");
    let selection = ChannelSelection {
        velocity: Some("SetVelo".to_owned()),
        torque: Some("0x10017".to_owned()),
        ..ChannelSelection::default()
    };
    let axis = read_axis(Path::new(FRICTION), &selection, None, &Disk::default()).expect("an axis");
    assert!(axis.findings.is_empty(), "{:?}", axis.findings);
    let found = identify(&axis.track, &IdentifyOptions::default()).expect("friction");
    let friction = &Preset::Stiff.plant().x.friction;
    for pair in &found.pairs {
        let wanted = friction.steady_n(pair.speed / 1000.0) / 5.0;
        assert!(
            (pair.friction / wanted - 1.0).abs() < 0.01,
            "{pair:?}: {wanted}"
        );
    }
    assert_eq!(found.pairs.len(), SPEEDS.len());
}

#[test]
fn a_unit_that_nobody_names_is_said() {
    // R6.3
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("trace.csv");
    fs::write(&file, "t;Speed;Current\n0;1;2\n0,001;1;2\n0,002;1;2\n").expect("written");
    let mut selection = ChannelSelection {
        velocity: Some("Speed".to_owned()),
        torque: Some("Current".to_owned()),
        ..ChannelSelection::default()
    };
    let said = |selection: &ChannelSelection| {
        let axis = read_axis(&file, selection, None, &Disk::default()).expect("an axis");
        let findings = axis.findings.into_iter();
        findings.map(|it| (it.code, it.message)).collect::<Vec<_>>()
    };
    // With the assumed unit the axis hardly moves, which is reported, too (R6.21).
    let codes: Vec<Code> = said(&selection).iter().map(|(code, _)| *code).collect();
    assert_eq!(codes, [Code::Fc524, Code::Fc519, Code::Fc519]);
    for (name, unit) in [("Speed", "mm/s"), ("Current", "%")] {
        let unit = Unit::parse(unit).expect("a unit");
        selection.units.push((name.to_owned(), unit));
    }
    assert_eq!(said(&selection), []);
    // An ampere is not a drive unit.
    let ampere = Unit::parse("A").expect("a unit");
    selection.units.push(("Current".to_owned(), ampere));
    assert_eq!(said(&selection).len(), 1);
}
