//! Rounds of learning on machines that share no code with the plants (R16.17).

use std::fmt::Write as _;
use std::path::Path;

use frictcomp_testing::{Machine, Program, Random, Recorder, ValueList, true_glitches};

use super::{FEEDS, answer};

const AXES: [&str; 2] = ["X", "Y"];
const START: [f64; 2] = [40.0, 0.0];

/// The channels of the recordings.
const CHANNELS: [&str; 4] = ["--position", "X=X.ActPos", "--position", "Y=Y.ActPos"];

/// Returns a circle about the origin: a turn and a half in each direction.
fn program(feed: f64) -> Program {
    let turn = |word: &str| format!("{word} X40 Y0 I-40 J0 F{feed}\n{word} X-40 Y0 I-40 J0\n");
    let back = |word: &str| format!("{word} X-40 Y0 I40 J0\n{word} X40 Y0 I40 J0\n");
    let text = format!("G4 X0.5\n{}G4 X0.5\n{}G4 X0.5\n", turn("G3"), back("G2"));
    Program::parse(&text, AXES, START)
}

/// Returns the measured friction of an axis as a list.
fn friction(machine: &Machine, axis: usize) -> String {
    const SPEEDS: [f64; 8] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 83.0];
    let mut text = format!(
        "frict_comp.mode 3\nfrict_comp.position_delay 0\nfrict_comp.reversal_lookahead 0\n\
         frict_comp.scaling_factor 1000\nfrict_comp.table_entries {}\n",
        SPEEDS.len()
    );
    for (at, speed) in SPEEDS.into_iter().enumerate() {
        writeln!(
            text,
            "frict_comp.table[{at}].in {:.0}\nfrict_comp.table[{at}].out {:.0}",
            speed * 1000.0,
            machine.axes[axis].friction_units(speed)
        )
        .expect("text");
    }
    text
}

/// Records a round, each circle twice; friction differs by up to 1 % each time. Returns the largest true glitches.
fn record(machine: &Machine, folder: &Path, random: &mut Random) -> [f64; 2] {
    let lists = AXES.map(|axis| {
        let text = std::fs::read_to_string(folder.join(format!("{axis}.lis"))).expect("a list");
        ValueList::parse(&text)
    });
    let mut left = [0.0_f64; 2];
    for feed in FEEDS {
        for take in [0, 1] {
            let mut machine = machine.clone();
            let factor = random.between(0.99, 1.01);
            machine.axes = machine.axes.map(|it| it.with_friction(factor));
            let run = machine.run(&program(feed), START, lists.each_ref().map(Some));
            let recorder = Recorder {
                seed: (random.uniform() * 1e9) as u64,
                ..Recorder::default()
            };
            let table = recorder.table(&run, AXES);
            std::fs::write(folder.join(format!("F{feed}-{take}.csv")), table).expect("written");
            let glitches = true_glitches(&run);
            left = [0, 1].map(|at| left[at].max(glitches.of_axis(at)));
        }
    }
    left
}

/// Drives five rounds on a machine; whatever is refused ends the test. Returns the true glitches of each round.
fn rounds(machine: &Machine) -> Vec<[f64; 2]> {
    let folder = tempfile::tempdir().expect("a folder");
    for (at, axis) in AXES.into_iter().enumerate() {
        let name = format!("friction-{axis}.lis");
        std::fs::write(folder.path().join(name), friction(machine, at)).expect("written");
    }
    let first = ["commission", "learn", "learning", "--plant", "mid"];
    let learn = |more: &[&str]| answer(folder.path(), &[&first[..], &CHANNELS[..], more].concat());
    let [x, y] = AXES.map(|axis| format!("{axis}=friction-{axis}.lis"));
    let (status, text) = learn(&["--friction", &x, "--friction", &y]);
    assert_eq!(status, Some(1), "{}: {text}", machine.name);
    let mut random = Random::new(5);
    let mut left = Vec::new();
    for round in 1..=5 {
        let rounds = folder.path().join(format!("learning/round-{round}"));
        left.push(record(machine, &rounds, &mut random));
        let (status, text) = learn(&[]);
        assert!(
            matches!(status, Some(0 | 1)),
            "{}, round {round}: {text}",
            machine.name
        );
        if status == Some(0) {
            break;
        }
    }
    left
}

/// R16.17: good recordings of six machines run five rounds, or until both axes are done, without a refusal.
#[test]
#[ignore = "minutes"]
#[allow(clippy::print_stdout, reason = "the table is what it is for")]
fn good_recordings_of_six_machines_are_never_refused() {
    for machine in Machine::stand_ins().into_iter().take(6) {
        let left = rounds(&machine);
        println!("| {} | {} | {left:.1?} |", machine.name, left.len());
        assert!(left.len() > 2, "{}: {left:?}", machine.name);
    }
}
