//! Limits of axes from the control's lists.

use std::collections::BTreeMap;

use frictcomp::lists::SlopeProfile;
use frictcomp::machine::{Configuration, ListFiles, NoList};
use frictcomp::text::SourceFile;
use frictcomp_physics::motion::{AssumedLimits, AxisLimits, PlannerOptions};

use super::{Trace, follow};

/// Lists by their names.
struct Lists(BTreeMap<&'static str, String>);

impl ListFiles for Lists {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let text = self.0.get(path).ok_or(NoList::Missing)?;
        Ok(SourceFile::new(path, text.clone()))
    }
}

fn machine(axis: &str, channel: &str) -> Configuration {
    let start = "sda_mds[0] ch.lis\r\nachs_mds[0] x.lis\r\nzahl_mds 1\r\nEnde\r\n";
    let channel = format!(
        "gruppe[0].achs_anzahl 1\ngruppe[0].achse[0].bezeichnung X\n\
         gruppe[0].achse[0].log_achs_nr 1\n{channel}\nEnde\n"
    );
    let axis = format!("kopf.achs_nr 1\nkenngr.achs_typ 1\n{axis}\nEnde\n");
    let mut lists = Lists([("ch.lis", channel), ("x.lis", axis)].into());
    Configuration::from_startup(SourceFile::new("hochlauf.lis", start), &mut lists)
}

/// 2 m/s² in 100 ms, with a reference and a build-up that is longer than the removal.
const AXIS: &str = "getriebe[0].dynamik.a_max 2000\n\
    getriebe[0].slope_profil.a_beschl P-AXIS-00008.0\n\
    getriebe[0].slope_profil.a_brems 2500 (above a_max)\n\
    getriebe[0].slope_profil.tr_beschl_zu 100000\n\
    getriebe[0].slope_profil.tr_beschl_ab 50000\n\
    getriebe[0].dynamik.vb_max 250000\n\
    getriebe[0].vb_eilgang 500000\n\
    getriebe[0].slope_profil.a_grenz 1500\n\
    getriebe[0].slope_profil.tr_grenz 75000\n\
    getriebe[1].dynamik.vb_max 1\n\
    getriebe[0].lslope_profil.a_stufe_1 700";

#[test]
fn limits_are_those_of_the_axis_list() {
    // R11.20
    let found = machine(AXIS, "prog_start.slope.profile 1");
    assert!(found.diagnostics.is_empty(), "{:?}", found.diagnostics);
    let axis = &found.machine.axes[0];
    let limits = AxisLimits::of(axis);
    assert!((limits.velocity_per_s - 250.0).abs() < 1e-9);
    assert!((limits.acceleration_per_s2 - 2000.0).abs() < 1e-9);
    assert!((limits.jerk_per_s3 - 20_000.0).abs() < 1e-6);
    assert_eq!(AssumedLimits::of(axis), None);
    assert_eq!(found.machine.channel.slope, Some(SlopeProfile::Trapez));
    let shown: Vec<&str> = found.reports[0]
        .parameters
        .iter()
        .map(|it| it.number)
        .collect();
    for number in [
        "P-AXIS-00001",
        "P-AXIS-00196",
        "P-AXIS-00212",
        "P-AXIS-00011",
    ] {
        assert!(shown.contains(&number), "{shown:?}");
    }
    assert!(found.programs.iter().any(|it| it.number == "P-CHAN-00071"));
}

/// Returns the trace of a program on X.
fn traced(found: Configuration, program: &str) -> Trace {
    follow(
        found.machine,
        program,
        (&["X"], &[("X", 0.0)]),
        PlannerOptions::default(),
    )
}

/// Returns the seconds of a program on X, and its top speed.
fn timed(found: Configuration, program: &str) -> (f64, f64) {
    let trace = traced(found, program);
    (trace.seconds(), trace.top_speed(0))
}

#[test]
fn the_trace_keeps_the_limits_of_the_lists() {
    // R11.20: twice the root of v/j, or v/a + tr, in addition to the travel at full speed; rapid has its own.
    let (seconds, _) = timed(machine(AXIS, ""), "G01 X400 F6000\nM30\n");
    let expected = 4.0 + 2.0 * (100.0_f64 / 20_000.0).sqrt();
    assert!((seconds - expected).abs() < 0.003, "{seconds}");
    let (seconds, top) = timed(machine(AXIS, ""), "G00 X1000\nM30\n");
    assert!((top - 500.0).abs() < 1e-6, "{top}");
    let expected = 2.0 + 500.0 / 1500.0 + 0.075;
    assert!((seconds - expected).abs() < 0.003, "{seconds} {expected}");
    // Steps take the acceleration of the stages, without ramps.
    let steps = machine(AXIS, "prog_start.slope.profile 0");
    let (seconds, _) = timed(steps, "G01 X400 F6000\nM30\n");
    let expected = 4.0 + 100.0 / 700.0;
    assert!((seconds - expected).abs() < 0.004, "{seconds} {expected}");
}

#[test]
fn the_channel_list_names_the_main_spindle_and_the_unit_of_the_feed() {
    // R2.105, R3.13: 0.2 mm/rev at 3000 1/min; the other spindle turns at 100 1/min.
    let program = "S1[REV3000 M3] S2[REV100 M3]\nG95 F0.2 G01 X50\nM30\n";
    let spindles = "spindel[0].bezeichnung S1\n\
        spindel[0].log_achs_nr 6\n\
        spindel[1].bezeichnung S2\n\
        spindel[1].log_achs_nr 11\n";
    for main in ["main_spindle_ax_nr 6", "main_spindle_name S1"] {
        let (_, top) = timed(machine(AXIS, &format!("{spindles}{main}")), program);
        assert!((top - 10.0).abs() < 1e-6, "{main}: {top}");
    }
    let metres = machine(AXIS, "prog_start.feedrate_factor 0.1");
    let (_, top) = timed(metres, "G01 X50 F6\nM30\n");
    assert!((top - 100.0).abs() < 1e-6, "{top}");
}

#[test]
fn a_program_selects_the_profile() {
    // R11.20: steps of 0.7 m/s² from line 1 on; from line 3 on the ramps of the list again.
    let program = "#SLOPE [TYPE=STEP]\nG01 X100 F6000\n#SLOPE DEFAULT\nG60 X300\nX400\nM30\n";
    let trace = traced(machine(AXIS, "prog_start.slope.profile 1"), program);
    assert!(trace.said.is_empty(), "{:?}", trace.said);
    let ramp = 2.0 * (100.0_f64 / 20_000.0).sqrt();
    let expected = 1.0 + 100.0 / 700.0 / 2.0 + 2.0 + ramp / 2.0 + 1.0 + ramp;
    let seconds = trace.seconds();
    assert!((seconds - expected).abs() < 0.004, "{seconds} {expected}");
}

#[test]
fn ramps_may_be_squared_sines() {
    // R11.20: a·sin²(πt / 2tr) with 2 m/s² and 100 ms; ways and times are those of constant jerk.
    let channel = "prog_start.slope.profile 2";
    let program = "G01 X400 F15000\nM30\n";
    let squared = traced(machine(AXIS, channel), program);
    let linear = traced(machine(AXIS, "prog_start.slope.profile 1"), program);
    assert_eq!(squared.positions.len(), linear.positions.len());
    assert_eq!(squared.end(), [400.0]);
    let ramp = 0.1;
    for cycle in (0..100_u8).map(usize::from) {
        let time = f64::from(u8::try_from(cycle).expect("a cycle")) * 0.001;
        let angle = std::f64::consts::PI * time / ramp;
        let expected = 1000.0 * (time - time / angle.max(1e-9) * angle.sin());
        let found = squared.velocities[cycle][0];
        assert!(
            (found - expected).abs() < 1e-6,
            "{time} s: {found} {expected}"
        );
    }
    let gentler = (1..50).all(|cycle| squared.velocities[cycle][0] < linear.velocities[cycle][0]);
    assert!(gentler, "a squared sine begins more gently");
    let selected = "#SLOPE [TYPE=SIN2]\nG01 X400 F15000\nM30\n";
    let by_program = traced(machine(AXIS, ""), selected);
    assert_eq!(by_program.positions, squared.positions);
}

#[test]
fn what_a_list_does_not_give_is_assumed_and_said() {
    // R11.20
    let found = machine("getriebe[0].slope_profil.a_beschl 3000", "");
    let assumed = AssumedLimits::of(&found.machine.axes[0]).expect("assumed limits");
    assert_eq!(assumed.max_acceleration, None);
    assert_eq!(assumed.max_velocity, Some(10_000.0));
    assert_eq!(assumed.max_jerk, Some(20.0));
    let wrong = machine("getriebe[0].slope_profil.a_beschl -1", "");
    let codes: Vec<&str> = wrong
        .diagnostics
        .iter()
        .map(|it| it.code.as_str())
        .collect();
    assert_eq!(codes, ["FC130"]);
}
