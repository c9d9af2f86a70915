//! Strokes of a single axis: the following error after reversals, off and on (R16.1, R16.9).

use std::fmt::Write as _;
use std::path::Path;

use frictcomp_testing::{Machine, Program, Random, ValueList};

use super::{AXIS, ZERO, call, provisional, put, run};
use crate::folder::succeeded;
use frictcomp_testing::recorded_drive::Recorded;

/// A rotary and a linear axis, whose plans differ only in the unit.
const MACHINE: [(&str, &str); 2] = [("C", "type = \"R\"\n"), ("U", "")];

const FEEDS: [f64; 5] = [500.0, 1000.0, 2000.0, 3000.0, 4000.0];

/// Returns a folder with the plan of one axis in `m`.
fn planned(axis: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    machine(folder.path(), "zero.lis");
    std::fs::write(folder.path().join("zero.lis"), ZERO).expect("a list");
    plan(folder.path(), axis, &[]);
    std::fs::create_dir(folder.path().join("m/recordings")).expect("a folder");
    folder
}

/// Writes the machine, with one list for each axis.
fn machine(folder: &Path, list: &str) {
    let axes = MACHINE.map(|(name, kind)| {
        let rest = AXIS.replace("zero.lis", list);
        let rest = if kind.is_empty() {
            rest
        } else {
            rest.replace("acceleration = 2\n", "acceleration = 2000\n")
                .replace("jerk = 50\n", "jerk = 50000\n")
        };
        format!("[[axis]]\nname = \"{name}\"\n{kind}{rest}")
    });
    std::fs::write(folder.join("frictcomp.toml"), axes.concat()).expect("a machine");
}

fn plan(folder: &Path, axis: &str, more: &[&str]) {
    let travel = format!("{axis}0..150");
    let arguments = [
        "commission",
        "plan",
        "--axis",
        axis,
        "--travel",
        &travel,
        "--feeds",
        "500,1000,2000,3000,4000",
        "--slowest",
        "1",
        "--into",
        "m",
    ];
    succeeded(folder, &[&arguments[..], more].concat());
}

/// Returns the recording of a machine in a program of the axis, with a list that the program switches.
fn driven(folder: &Path, axis: &str, (program, list): (&str, Option<&str>)) -> Recorded {
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a file");
    let start = [0.0; 2];
    let list = list.map(|name| ValueList::parse(&read(name)));
    let program = Program::parse(&read(program), [axis, "B"], start);
    let run = Machine::bristle().run(&program, start, [list.as_ref(), None]);
    let mut random = Random::new(7);
    let mut measured = |values: &[f64], (factor, noise): (f64, f64)| {
        let each = values.iter();
        each.map(|it| it * factor + noise * random.normal())
            .collect()
    };
    let commanded: Vec<f64> = measured(&run.commanded.places[0], (1e4, 0.0));
    Recorded {
        t: (0..commanded.len())
            .map(|at| at as f64 * run.cycle_s)
            .collect(),
        v: measured(&run.commanded.velocities[0], (1000.0, 0.0)),
        x: measured(&run.load_mm[0], (1e4, 3.0)),
        torque: measured(&run.units[0], (1.0, 1.0)),
        commanded,
    }
}

/// Returns a recording of commanded and actual positions.
fn text(recorded: &Recorded) -> String {
    let mut text = String::from("t,v,x,x_act,torque\n");
    for at in 0..recorded.t.len() {
        writeln!(
            text,
            "{:.3},{:.3},{:.2},{:.2},{:.0}",
            recorded.t[at],
            recorded.v[at],
            recorded.commanded[at],
            recorded.x[at],
            recorded.torque[at]
        )
        .expect("text");
    }
    text
}

/// A change that turns a recording into that of another machine.
type Change = fn(&mut Recorded);

/// Changes that make strokes those of another machine, with the words that report them.
const OF_ANOTHER_MACHINE: [(Change, &str); 2] = [
    (
        // Its loops answer 12 ms later.
        |it| {
            let samples = it.x.len();
            it.x.copy_within(..samples - 12, 12);
        },
        "they are of another machine",
    ),
    (
        |it| it.torque.iter_mut().for_each(|torque| *torque *= 1.3),
        "have less friction than those on, by 23 %: another machine",
    ),
];

/// R16.1, R16.2, R16.13, R16.18: the strokes of a single axis are judged by the following error after reversals, off and on; the
/// result is called motor side, not contour, and has the unit of the axis.
#[test]
fn strokes_are_judged_by_their_following_error() {
    for (axis, unit) in [("C", "0.001°"), ("U", "µm")] {
        let folder = planned(axis);
        let folder = folder.path();
        put(
            folder,
            "a.csv",
            &text(&driven(
                folder,
                axis,
                (&format!("m/01-friction-{axis}.nc"), None),
            )),
        );
        put(
            folder,
            "b.csv",
            &text(&driven(
                folder,
                axis,
                (&format!("m/02-strokes-{axis}.nc"), None),
            )),
        );
        let (status, said) = run(folder, &[]);
        assert_eq!(status, Some(1), "{said}");
        assert!(
            said.contains("motor side, not contour")
                && said.contains(&format!("{unit} after a reversal"))
                && !said.contains("not used"),
            "{said}"
        );
        let list = provisional(folder, axis);
        plan(folder, axis, &["--value-list", &format!("{axis}={list}")]);
        machine(folder, &list);
        let kind = ["--torque-kind", "actual", "--html", "report.html"];
        let friction = driven(
            folder,
            axis,
            (&format!("m/64-friction-{axis}.nc"), Some(&list)),
        );
        put(folder, "c.csv", &text(&friction));
        let recorded = driven(
            folder,
            axis,
            (&format!("m/65-strokes-{axis}.nc"), Some(&list)),
        );
        put(folder, "d.csv", &text(&recorded));
        let (status, said) = run(folder, &kind);
        assert!(
            said.contains("following error after reversals; motor side, not contour"),
            "{said}"
        );
        assert_eq!(status, Some(0), "{said}");
        put(folder, "d.csv", &text(&recorded).replace("torque", "other"));
        let (status, without) = run(folder, &kind);
        assert_eq!(status, Some(1), "{without}");
        let words = "not proven, the earlier lists stay";
        assert!(without.contains(words), "{without}");
        for (change, words) in OF_ANOTHER_MACHINE {
            let mut other = recorded.clone();
            change(&mut other);
            put(folder, "d.csv", &text(&other));
            let (status, said) = run(folder, &kind);
            assert_eq!(status, Some(1), "{said}");
            assert!(
                said.contains("not accepted") && said.contains(words),
                "{words}: {said}"
            );
        }
        put(folder, "d.csv", &text(&recorded));
        let (status, said) = run(folder, &kind);
        assert!(
            said.contains("accepted: ")
                && said.contains("Other feeds were not recorded, and no contour"),
            "{said}"
        );
        assert_eq!(status, Some(0), "{said}");
        let output = call(
            folder,
            &[&["commission", "run", "m", "--format", "json"], &kind[..2]].concat(),
        );
        let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("a record");
        let round = &record["rounds"][0];
        assert_eq!(round["shows"], "following_error");
        assert_eq!(round["unit"], unit);
        let recorded = round["recorded"].as_array().expect("feeds");
        assert_eq!(recorded.len(), FEEDS.len());
        for feed in recorded {
            let [off, on] = ["off", "on"].map(|key| feed[key].as_f64().expect("a number"));
            assert!(off > 5.0 && on < 0.9 * off, "{feed}");
        }
        let page = std::fs::read_to_string(folder.join("report.html")).expect("a report");
        assert!(
            page.contains("motor side, not contour") && page.contains(unit),
            "{page}"
        );
    }
}

/// R16.9: the actual position has to follow the commanded one; strokes that end early, are too coarse, or whose
/// following error is missing or belongs to another axis show nothing.
#[test]
fn strokes_that_show_nothing_are_refused() {
    let folder = planned("U");
    let folder = folder.path();
    let recorded = driven(folder, "U", ("m/02-strokes-U.nc", None));
    let changed = |change: &dyn Fn(&mut Recorded)| {
        let mut other = recorded.clone();
        change(&mut other);
        text(&other)
    };
    let still = changed(&|it| {
        for (at, x) in it.x.iter_mut().enumerate() {
            *x = (at % 5) as f64;
        }
    });
    let inverted = changed(&|it| it.x.iter_mut().for_each(|x| *x = -*x));
    let in_um = changed(&|it| it.x.iter_mut().for_each(|x| *x /= 10.0));
    let early = text(&recorded);
    let early: Vec<&str> = early.lines().take(recorded.t.len() * 3 / 4).collect();
    let whole = text(&recorded);
    let coarse = whole
        .lines()
        .enumerate()
        .filter(|(at, _)| *at == 0 || at % 4 == 1);
    let coarse: Vec<&str> = coarse.map(|it| it.1).collect();
    let lonely = whole.replace("x_act", "other");
    let quiet = whole.replace("x_act", "e");
    let quiet = quiet.lines().enumerate().map(|(at, line)| {
        let cells: Vec<&str> = line.split(',').collect();
        let e = if at == 0 {
            "e".to_owned()
        } else {
            ((at * 7) % 3).to_string()
        };
        format!("{},{},{},{e},{}", cells[0], cells[1], cells[2], cells[4])
    });
    let quiet = quiet.collect::<Vec<String>>().join("\n");
    for (text, words) in [
        (
            still,
            "the actual position does not follow the commanded one",
        ),
        (
            inverted,
            "the actual position does not follow the commanded one",
        ),
        (
            in_um,
            "the channels of two axes are swapped, or a unit is wrong",
        ),
        (early.join("\n"), "reversals: it ends early"),
        (coarse.join("\n"), "a sample every 4.0 ms does not show"),
        (
            lonely,
            "neither the following error nor the actual position",
        ),
        (quiet, "no reversal shows in the following error"),
    ] {
        put(folder, "s.csv", &text);
        let (status, said) = run(folder, &[]);
        assert_eq!(status, Some(1), "{words}: {said}");
        assert!(
            said.contains(words) && said.contains("missing: a recording of 02-strokes-U.nc"),
            "{words}: {said}"
        );
    }
}
