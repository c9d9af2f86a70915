//! Help texts, their examples and the manual pages.

use std::fs;

use super::{LEAVE_OFF, bare, stderr};
use crate::folder::Bench;
use crate::workspace::root;

#[test]
fn a_run_says_once_where_more_is_said() {
    // R9.79
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    for command in ["run", "check"] {
        let said = stderr(&bench.call(&[command, "a.nc"]));
        assert_eq!(
            said.matches("`frictcomp explain FC401`").count(),
            1,
            "{said}"
        );
    }
}

#[test]
fn every_help_ends_with_two_examples_that_work() {
    // R9.79
    let commands = [
        "run",
        "check",
        "audit",
        "golden",
        "diff",
        "show",
        "show files",
        "show calls",
        "show values",
        "show passed-over",
        "lists",
        "drive",
        "current",
        "circle",
        "contour",
        "tune",
        "stiction",
        "conformance",
        "trace",
        "identify",
        "verify",
        "replay",
        "commission",
        "commission plan",
        "commission run",
        "commission learn",
        "commission trend",
        "ask",
        "ask write",
        "ask read",
        "ask list",
        "explain",
        "lsp",
        "dap",
        "config",
        "config schema",
        "config show",
        "init",
        "completions",
        "man",
        "",
    ];
    let help = bare(&[]).stdout(&["--help"]);
    let (list, _) = help.split_once("\nOptions:").expect("a list");
    let named = list.lines().filter_map(|line| line.strip_prefix("  "));
    for name in named.filter_map(|rest| rest.split_whitespace().next()) {
        let is_known = commands.contains(&name) || name == "help";
        assert!(is_known, "`{name}` has no examples");
    }
    for command in commands {
        let bench = example_folder();
        let mut arguments: Vec<&str> = command.split_whitespace().collect();
        arguments.push("--help");
        let help = bench.stdout(&arguments);
        let lines: Vec<&str> = help.lines().collect();
        let [.., title, first, second] = lines[..] else {
            panic!("{help}");
        };
        assert_eq!(title, "Examples:", "{command}");
        for example in [first, second] {
            let words: Vec<&str> = example.split_whitespace().collect();
            assert_eq!(words[0], "frictcomp", "{command}");
            let output = bench.call(&words[1..]);
            assert!(
                matches!(output.status.code(), Some(0 | 1)),
                "{example}: {}",
                stderr(&output)
            );
        }
    }
}

/// Returns the files that the examples name.
fn example_folder() -> Bench {
    let bench = bare(&[
        (
            "mill.nc",
            "N10 X[COMP OFF FRICT]\nN20 G1 X0 Y0 F1000\nN30 X10\nN40 M30\n",
        ),
        ("mill-old.nc", "N10 G90\nN20 M30\n"),
        ("next.nc", "N10 X[COMP ON FRICT]\nN20 M30\n"),
        (
            "network.xml",
            "<EtherCATConfig><Config><Slave><Info><Name>Drive1</Name></Info></Slave></Config></EtherCATConfig>",
        ),
        ("trace.csv", "t,x,v\n0,0,0\n0.001,1,100\n"),
    ]);
    bench.write(
        "frictcomp.toml",
        "[[axis]]\nname = \"X\"\nmax_velocity = 12000\nmax_acceleration = 2\n\
         [[axis]]\nname = \"Y\"\nmax_velocity = 12000\nmax_acceleration = 2\n\
         [[axis]]\nname = \"Z\"\n",
    );
    let friction = fs::read_to_string(root().join("programs/demo/recordings/friction_x.csv"));
    let friction = friction.expect("a recording").replace("SetVelo", "v");
    fs::create_dir_all(bench.folder().join("measuring/recordings")).expect("a folder");
    bench.write(
        "measuring/plan-1.json",
        r#"{"schema":1,"plan":{"stage":"off","axes":[],"approach":1000,"programs":[]},"lists":[]}"#,
    );
    let friction = friction.replace("ActTorque", "torque");
    bench.write("friction.csv", &friction);
    bench.write("states.csv", "t,active_X\n0,1\n0.1,1\n");
    fs::create_dir(bench.folder().join("recordings")).expect("a folder");
    // A copy would not be a second recording (R18.9).
    let shorter = friction.trim_end().rsplit_once('\n').expect("rows").0;
    bench.write("recordings/x-2026-03-01.csv", &friction);
    bench.write("recordings/x-2027-03-01.csv", shorter);
    let machine = root().join("programs/machines/mill3");
    for list in fs::read_dir(machine).expect("a machine") {
        let list = list.expect("a list").path();
        if list.extension().is_some_and(|it| it == "lis") {
            let name = list.file_name().expect("a name");
            fs::copy(&list, bench.folder().join(name)).expect("copied");
        }
    }
    for folder in ["programs", "machine"] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
    }
    bench.write("programs/a.nc", LEAVE_OFF);
    bench.stdout(&["ask", "write", "--into", "asked"]);
    let asked = bench.read("asked/README.txt");
    let mut lines = asked.lines().map(str::trim);
    let answer = lines.find(|line| line.starts_with("frictcomp-ask R"));
    bench.write("message.txt", answer.expect("an answer to copy"));
    fs::create_dir_all(bench.folder().join("conformance/1")).expect("a folder");
    let case = fs::read_to_string(root().join("conformance/1/off.toml"));
    bench.write("conformance/1/off.toml", &case.expect("a case"));
    for (name, turn) in [("ccw.csv", 1.0), ("cw.csv", -1.0)] {
        let mut text = "x,y\n".to_owned();
        for step in 0..1440 {
            let angle = turn * f64::from(step) * std::f64::consts::PI / 360.0;
            let (x, y) = (50.0 * angle.cos(), 50.0 * angle.sin());
            text.extend([
                x.to_string(),
                ",".to_owned(),
                y.to_string(),
                "\n".to_owned(),
            ]);
        }
        bench.write(name, &text);
    }
    bench
}

#[test]
fn every_command_has_a_manual_page() {
    // R9.79
    let bench = bare(&[]);
    assert_eq!(bench.status(&["man", "--into", "pages"]), Some(0));
    let entries = fs::read_dir(bench.folder().join("pages")).expect("pages");
    let mut names: Vec<String> = entries
        .map(|it| {
            it.expect("a page")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    for name in [
        "frictcomp.1",
        "frictcomp-run.1",
        "frictcomp-config-show.1",
        "frictcomp-tune.1",
    ] {
        assert!(names.iter().any(|it| it == name), "{names:?}");
    }
    let page = bench.read("pages/frictcomp-run.1");
    assert!(
        page.contains("frictcomp run mill.nc") && page.contains("keep"),
        "{page}"
    );
}
