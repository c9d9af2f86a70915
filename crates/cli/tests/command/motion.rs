//! R5.1 on the command line: `frictcomp current PROGRAM`.

use crate::folder::call;
use crate::workspace::root;
use std::io::Write as _;
use std::path::Path;
use std::process::Output;

const PROGRAM: &str = "\
N10 G01 X0 Y0 F600
N20 X1
N30 X[COMP OFF FRICT]
N40 X2 Y0.5
N50 X[COMP ON FRICT]
N60 X0 Y0
N70 M30
";

const MACHINE: &str = r#"
[[axis]]
name = "X"
frict_comp = true
max_velocity = 12000
max_acceleration = 2
max_jerk = 50
[axis.value]
mode = 3
position_delay = 9
reversal_lookahead = 4
delay_cycles = 2
table_entries = 2
table = [[0.0, 12.0], [1800.0, 10.5]]
[[axis]]
name = "Y"
"#;

/// Runs `frictcomp current` in a folder with the program and the machine.
fn current(folder: &Path, arguments: &[&str]) -> Output {
    std::fs::write(folder.join("a.nc"), PROGRAM).expect("a program");
    std::fs::write(folder.join("frictcomp.toml"), MACHINE).expect("a machine");
    call(folder, &[&["current"], arguments].concat())
}

fn rows(output: &Output) -> Vec<Vec<String>> {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows = text
        .lines()
        .map(|row| row.split(',').map(str::to_owned).collect());
    rows.collect()
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

#[test]
fn the_current_follows_the_state_of_the_axis() {
    // R5.1 R4.10
    let folder = tempfile::tempdir().expect("a folder");
    let output = current(
        folder.path(),
        &["a.nc", "-v", "--axis", "X", "--columns", "comp,line"],
    );
    let rows = rows(&output);
    assert_eq!(
        rows[0].join(","),
        "t,x,v,w_before,w_after,current,output,comp,line"
    );
    for row in &rows[1..] {
        let (state, line) = (row[7].as_str(), row[8].as_str());
        assert_eq!(state, if line == "4" { "inactive" } else { "active" });
        if state == "inactive" {
            assert_eq!((number(&row[5]), number(&row[6])), (0.0, 0.0));
        }
    }
    assert!(rows[1..].iter().any(|row| number(&row[5]) > 11.0));
    assert!(rows[1..].iter().any(|row| number(&row[5]) < -11.0));
    assert_eq!(rows.last().expect("a row")[1], "0");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("limits assumed for Y: 10000 mm/min, 1 m/s², 20 m/s³"),
        "{said}"
    );
    assert!(
        said.contains("X: while its state is `inactive`, its current is 0"),
        "{said}"
    );
    assert!(
        said.contains("reading: standstill=hold,below=hold,delay=all"),
        "{said}"
    );
}

#[test]
fn a_program_and_its_recorded_trace_have_the_same_current() {
    // R5.1 R4.2
    let folder = tempfile::tempdir().expect("a folder");
    let program = current(folder.path(), &["a.nc", "--axis", "X", "--columns", "comp"]);
    let program = rows(&program);
    let mut trace = std::fs::File::create(folder.path().join("t.csv")).expect("a file");
    writeln!(trace, "t,x,v,comp").expect("written");
    for row in &program[1..] {
        let comp = if row[7] == "active" { "on" } else { "off" };
        writeln!(trace, "{},{},{},{comp}", row[0], row[1], row[2]).expect("written");
    }
    let list = "frict_comp.mode 3\nfrict_comp.table_entries 2\nfrict_comp.position_delay 9\nfrict_comp.reversal_lookahead 4\nfrict_comp.delay_cycles 2\nfrict_comp.table[0].in 0\nfrict_comp.table[0].out 12.0\nfrict_comp.table[1].in 1800\nfrict_comp.table[1].out 10.5\nEnde\n";
    std::fs::write(folder.path().join("v.lis"), list).expect("a list");
    let recorded = current(
        folder.path(),
        &["--recording", "t.csv", "--value-list", "v.lis"],
    );
    let recorded = rows(&recorded);
    assert_eq!(recorded.len(), program.len());
    for (recorded, program) in recorded.iter().zip(&program) {
        assert_eq!(recorded[..], program[..7]);
    }
}

#[test]
fn several_axes_stand_side_by_side() {
    // R5.1: columns by axis, a complete file, another value list and cycle.
    let folder = tempfile::tempdir().expect("a folder");
    // Without `--axis` those that have a value list.
    let [every, listed] =
        [&["a.nc"][..], &["a.nc", "--axis", "X"]].map(|it| rows(&current(folder.path(), it)));
    assert_eq!(every, listed);
    let arguments = [
        "a.nc",
        "--axis",
        "X,Y",
        "-o",
        "out.csv",
        "--cycle-time",
        "2000us",
    ];
    let output = current(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0));
    let text = std::fs::read_to_string(folder.path().join("out.csv")).expect("the result");
    let mut lines = text.lines();
    let header = "t,x.X,v.X,w_before.X,w_after.X,current.X,output.X,x.Y,v.Y,w_before.Y,w_after.Y,current.Y,output.Y";
    assert_eq!(lines.next(), Some(header));
    assert_eq!(
        lines.nth(1).and_then(|row| row.split(',').next()),
        Some("0.002")
    );
    // Nothing else is left in the folder.
    assert_eq!(
        std::fs::read_dir(folder.path()).expect("a folder").count(),
        3
    );
}

#[test]
fn what_cannot_be_done_is_said() {
    // R5.1
    let folder = tempfile::tempdir().expect("a folder");
    for (arguments, status, said) in [
        (
            vec!["a.nc", "--axis", "Q"],
            2,
            "the machine has no axis `Q`",
        ),
        (
            vec!["a.nc", "--axis", "X", "--cycle-time", "0"],
            2,
            "a CNC cycle of 0 ms",
        ),
        (
            vec!["a.nc", "--axis", "X", "--isolated", "--enable", "X"],
            2,
            "--value-list",
        ),
        (
            vec!["a.nc", "--axis", "X", "--isolated"],
            1,
            "`unconfigured`, its current is 0",
        ),
        (
            vec!["a.nc", "--axis", "X", "--max-cycles", "10"],
            1,
            "error[FC915]",
        ),
        (vec!["b.nc", "--axis", "X"], 2, "there is no file `b.nc`"),
        (vec!["a.nc", "--isolated"], 2, "no axis has an accepted"),
    ] {
        let output = current(folder.path(), &arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {text}");
        assert!(text.contains(said), "{arguments:?}: {text}");
    }
}

#[test]
fn a_start_is_given_and_proposed() {
    // R5.1 R9.74
    let folder = tempfile::tempdir().expect("a folder");
    let run = |arguments: &[&str]| {
        let output = current(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), rows(&output), said)
    };
    let (status, without, said) = run(&["a.nc", "--axis", "X"]);
    assert_eq!(status, Some(0));
    assert!(
        said.contains("info[FC906]") && said.contains("`--start X0,Y0`"),
        "{said}"
    );
    let (status, with, said) = run(&["a.nc", "--axis", "X", "--start", "X-3,Y=0"]);
    assert_eq!((status, with[1][1].as_str()), (Some(0), "-30000"));
    assert!(
        with.len() > without.len() && !said.contains("FC906"),
        "{said}"
    );
    for (start, wanted) in [
        ("Q0", "the machine has no axis `Q`"),
        ("X0,X1", "gives the position of axis `X` twice"),
        ("X", "write axes with their positions"),
    ] {
        let (status, _, said) = run(&["a.nc", "--axis", "X", "--start", start]);
        assert_eq!(status, Some(2), "{said}");
        assert!(said.contains(wanted), "{said}");
    }
    let (_, simplified, _) = run(&["a.nc", "--axis", "X", "--columns", "simplified"]);
    assert_eq!(simplified[0][7], "simplified");
}

#[test]
fn every_demo_has_currents_from_the_start_that_is_proposed() {
    // R5.1: what FC906 proposes is accepted, and then it proposes nothing more.
    let demo = root().join("programs/demo");
    let sets = ["--set", "V.E.WARM_UP=1", "--set", "V.E.SERVICE=0"];
    for (program, axes, more) in [
        ("friction.nc", "X,Y", &[][..]),
        ("next.nc", "X,Y", &[]),
        ("current/reversal.nc", "X", &[]),
        ("five_axis/milling.nc", "X,Y", &[]),
        ("five_axis/turning.nc", "X,Z", &[]),
        ("five_axis/startup.nc", "X", &sets),
    ] {
        let run = |more: &[&str]| {
            let output = call(
                &demo,
                &[&["current", program, "--axis", axes], more].concat(),
            );
            (
                String::from_utf8_lossy(&output.stderr).into_owned(),
                rows(&output).len(),
            )
        };
        let (mut said, mut cycles) = run(more);
        if let Some((_, proposal)) = said.split_once("--start ") {
            let start = proposal.split('`').next().expect("a proposal").to_owned();
            (said, cycles) = run(&[more, &["--start", &start]].concat());
        }
        assert!(!said.contains("--start"), "{program}: {said}");
        assert!(cycles > 50, "{program}: {cycles} rows, {said}");
    }
}

/// R6.20, R9.26: a list that does not fit the recorded torque ends `verify` with status 1.
#[test]
fn a_list_that_does_not_fit_has_its_status() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = "X[COMP ON FRICT]\nG01 X0 F300\nX20\nX0\nX20 F1000\nX0\nX20 F3000\nX0\nM30\n";
    std::fs::write(folder.path().join("v.nc"), program).expect("a program");
    let list = root().join("programs/demo/lists/comp_x.lis");
    std::fs::copy(list, folder.path().join("v.lis")).expect("a list");
    let arguments = "v.nc --isolated --enable X --axis X --value-list v.lis --cycle-time 1";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let driven = rows(&current(folder.path(), &arguments));
    for (factor, expected, words) in [
        (
            1.0,
            0,
            "v.lis fits the recorded torque from 3.40 to 50.00 mm/s\n",
        ),
        (1.0, 0, "not judged: 50.00 to 166.67 mm/s"),
        (0.8, 1, "the list is 25 to 26 % high from"),
        (-1.0, 1, "the sign of the list is inverted"),
    ] {
        let recorded = driven[1..].iter().map(|row| {
            let torque = factor * number(&row[5]);
            format!("{},{},{torque}", row[0], row[2])
        });
        let recorded: Vec<String> = recorded.collect();
        let recording = format!("t,v,torque\n{}\n", recorded.join("\n"));
        std::fs::write(folder.path().join("t.csv"), recording).expect("a recording");
        let arguments = [
            "verify",
            "t.csv",
            "--value-list",
            "v.lis",
            "--cycle-time",
            "1",
            "--torque-kind",
            "actual",
        ];
        let output = call(folder.path(), &arguments);
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(expected), "{factor}: {text}");
        assert!(text.contains(words), "{factor}: {text}");
    }
}
