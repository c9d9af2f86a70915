//! The outputs of commands, also when something is in the way.

use std::fs;

use crate::folder::{Bench, stderr};
use crate::workspace::root;

const PROGRAM: &str = "N10 X[COMP OFF FRICT]\nN20 X1\nN30 M30\n";
const VALUES: &str = "frict_comp.mode 3\nfrict_comp.table_entries 1\n\
                      frict_comp.table[0].in 0\nfrict_comp.table[0].out 10\n";
const TRACE: &str = "t,x,v\n0,0,0\n0.001,1,100\n";

fn bench() -> Bench {
    let bench = Bench::new(&[("part.nc", PROGRAM), ("v.lis", VALUES), ("t.csv", TRACE)]);
    bench.write(
        "plant.toml",
        &fs::read_to_string(root().join("docs/assets/plant.toml")).expect("a plant"),
    );
    bench
}

/// Returns the message of a call that must end with 2 and leave every file as it was.
fn refused(bench: &Bench, arguments: &[&str]) -> String {
    let before = contents(bench);
    let output = bench.call(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert_eq!(contents(bench), before, "{arguments:?}");
    said
}

/// Returns the contents of all files except locks.
fn contents(bench: &Bench) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(bench.folder()).expect("a folder");
    let mut files: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_file() && path.extension().is_none_or(|it| it != "lock"))
        .map(|path| (path.display().to_string(), fs::read(&path).expect("read")))
        .collect();
    files.sort();
    files
}

#[test]
fn no_output_destroys_an_input() {
    // R9.70
    let bench = bench();
    bench.write("s.lis", "zahl_mds 1\nachs_mds[0] x.lis\n");
    bench.write("x.lis", "kopf.achs_nr 1\nkopf.log_achs_name X\n");
    bench.write("call.nc", "L part.nc\nM30\n");
    fs::hard_link(bench.folder().join("part.nc"), bench.folder().join("hard")).expect("a link");
    let both = |arguments: &[&str], input: &str| {
        let said = refused(&bench, arguments);
        assert!(said.contains("would overwrite the "), "{said}");
        assert!(said.contains(input), "{said}");
    };
    both(&["check", "part.nc", "-o", "part.nc"], "part.nc");
    both(&["check", "part.nc", "-o", "./part.nc"], "part.nc");
    both(&["check", "part.nc", "-o", "hard"], "part.nc");
    both(&["check", ".", "-o", "part.nc"], "part.nc");
    both(
        &["check", "part.nc", "-o", "frictcomp.toml"],
        "frictcomp.toml",
    );
    both(&["run", "part.nc", "-o", "part.nc"], "part.nc");
    both(&["run", "part.nc", "--html", "part.nc"], "part.nc");
    both(&["run", "part.nc", "--state", "part.nc"], "part.nc");
    both(
        &["run", "part.nc", "--startup", "s.lis", "-o", "s.lis"],
        "s.lis",
    );
    // The calls of a program are known only when it has made them.
    both(&["run", "call.nc", "-o", "part.nc", "--force"], "part.nc");
    both(&["run", "call.nc", "--html", "hard"], "part.nc");
    both(&["lists", "v.lis", "-o", "v.lis"], "v.lis");
    both(&["lists", "v.lis", "--svg", "v.lis"], "v.lis");
    let trace = ["current", "--recording", "t.csv", "--value-list", "v.lis"];
    both(&[&trace[..], &["-o", "t.csv"]].concat(), "t.csv");
    both(&[&trace[..], &["--svg", "v.lis"]].concat(), "v.lis");
    let program = ["current", "part.nc", "--axis", "X"];
    both(&[&program[..], &["--svg", "part.nc"]].concat(), "part.nc");
    both(
        &[&program[..], &["-o", "frictcomp.toml"]].concat(),
        "frictcomp.toml",
    );
    both(
        &["circle", "--plant", "plant.toml", "--svg", "plant.toml"],
        "plant.toml",
    );
    both(&["circle", "--value-list", "v.lis", "-o", "v.lis"], "v.lis");
    both(
        &["circle", "--recording", "t.csv", "--html", "t.csv"],
        "t.csv",
    );
    both(
        &[
            "tune",
            "--plant",
            "plant.toml",
            "--write-list",
            "plant.toml",
        ],
        "plant.toml",
    );
}

#[test]
fn what_users_write_is_replaced_only_when_they_say_so() {
    // R9.93: also programs, lists and configurations that this call does not read.
    let bench = bench();
    bench.write("other.nc", PROGRAM);
    bench.write("OTHER.MPF", PROGRAM);
    let run = ["run", "part.nc"];
    let with = |more: &[&'static str]| [&run[..], more].concat();
    for more in [
        ["-o", "other.nc"],
        ["-o", "OTHER.MPF"],
        ["-o", "v.lis"],
        ["--html", "other.nc"],
        ["--html", "frictcomp.toml"],
        ["-o", "sub/../frictcomp.toml"],
    ] {
        fs::create_dir_all(bench.folder().join("sub")).expect("a folder");
        let said = refused(&bench, &with(&more));
        let is_input = said.contains("would overwrite the configuration");
        assert!(
            is_input || said.contains("would take the place of a"),
            "{said}"
        );
        assert!(is_input || said.contains("`--force`"), "{said}");
    }
    let forced = with(&["-o", "other.nc", "--force"]);
    assert_eq!(bench.status(&forced), Some(0));
    assert!(bench.read("other.nc").contains("end by M30"));
    // An input remains an input.
    assert!(refused(&bench, &with(&["-o", "part.nc", "--force"])).contains("would overwrite"));
    // A file that does not exist is not replaced, but a configuration would count from then on.
    fs::create_dir(bench.folder().join("below")).expect("a folder");
    let said = refused(&bench, &with(&["--isolated", "-o", "below/frictcomp.toml"]));
    assert!(said.contains("take the place of a configuration"), "{said}");
    assert_eq!(bench.status(&with(&["-o", "new.nc"])), Some(0));
}

#[cfg(unix)]
#[test]
fn no_link_leads_an_output_to_what_users_write() {
    // R9.93
    use std::os::unix::fs::symlink;
    let bench = bench();
    bench.write("other.nc", PROGRAM);
    let link = |to: &str, name: &str| {
        symlink(bench.folder().join(to), bench.folder().join(name)).expect("a link");
    };
    link("other.nc", "part.nc.timeline");
    link("v.lis", "list.txt");
    link("frictcomp.toml", "page.html");
    for call in [
        &["golden", "--update", "part.nc"][..],
        &["golden", "--update", "."],
        &["run", "part.nc", "-o", "list.txt"],
        &["run", "part.nc", "-o", "list.txt", "--force"],
        &["run", "--isolated", "part.nc", "--html", "page.html"],
    ] {
        let said = refused(&bench, call);
        let is_input = said.contains("would overwrite the ");
        assert!(
            is_input || said.contains("is a link to the "),
            "{call:?}: {said}"
        );
    }
    // A link to another result remains one.
    bench.write("report.html", "old");
    link("report.html", "latest.html");
    assert_eq!(
        bench.status(&["run", "part.nc", "--html", "latest.html"]),
        Some(0)
    );
    assert!(bench.read("report.html").starts_with("<!DOCTYPE html>"));
}

#[test]
fn a_dash_is_standard_output() {
    // R9.70
    let bench = bench();
    let plain = bench.stdout(&["run", "part.nc"]);
    assert_eq!(bench.stdout(&["run", "part.nc", "-o", "-"]), plain);
    let page = bench.stdout(&["run", "part.nc", "-o", "a.txt", "--html", "-"]);
    assert!(page.starts_with("<!doctype html>") || page.starts_with("<!DOCTYPE html>"));
    assert_eq!(bench.read("a.txt"), plain);
    assert!(!bench.folder().join("-").exists());
}

#[test]
fn what_is_written_is_named() {
    // R9.70
    let bench = bench();
    let output = bench.call(&[
        "run", "part.nc", "-o", "a.txt", "--html", "a.html", "--state", "s",
    ]);
    let said = stderr(&output);
    for name in ["wrote `a.txt`", "wrote `a.html`", "wrote `s`"] {
        assert!(said.lines().any(|line| line == name), "{said}");
    }
}

#[test]
fn runs_beside_each_other_leave_each_other_alone() {
    // R9.31
    let bench = bench();
    bench.write(".mill-backup.tmp", "mine");
    for _ in 0..3 {
        let mill = [
            "run",
            "part.nc",
            "--state",
            "mill",
            "--html",
            "mill-report.html",
        ];
        assert_eq!(bench.status(&mill), Some(0));
    }
    assert_eq!(bench.read(".mill-backup.tmp"), "mine");
    let children: Vec<_> = (0..12)
        .map(|at| {
            let state = if at % 2 == 0 { "st" } else { "st-2" };
            let mut command = bench.command(&["run", "part.nc", "--state", state]);
            command.spawn().expect("the tool starts")
        })
        .collect();
    for child in children {
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

#[cfg(unix)]
mod unix {
    use std::io::Write;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};
    use std::thread::sleep;
    use std::time::Duration;

    use super::*;

    fn unfinished(bench: &Bench) -> usize {
        let entries = fs::read_dir(bench.folder()).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        names
            .filter(|name| name.to_string_lossy().starts_with(".frictcomp-"))
            .count()
    }

    /// Returns a run that waits for more of its program, with an output begun.
    fn waiting(bench: &Bench) -> std::process::Child {
        let mut command = bench.command(&["run", "-", "-o", "a.txt", "--html", "a.html"]);
        let mut child = command
            .stdin(Stdio::piped())
            .spawn()
            .expect("the tool starts");
        let stdin = child.stdin.as_mut().expect("a pipe");
        stdin.write_all(b"N10 X1\n").expect("written");
        while unfinished(bench) < 2 {
            sleep(Duration::from_millis(5));
        }
        child
    }

    fn signal(child: &std::process::Child, name: &str) {
        let pid = child.id().to_string();
        let killed = Command::new("kill").args(["-s", name, &pid]).status();
        assert!(killed.expect("kill starts").success());
    }

    /// Returns whether these tests run with a signal ignored, as under `nohup` and in background jobs of a shell; the
    /// tool does not change that.
    fn is_ignored(signal: i32) -> bool {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status
            .lines()
            .find_map(|line| line.strip_prefix("SigIgn:"))
            .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.unwrap_or_default() >> (signal - 1) & 1 == 1
    }

    #[test]
    fn a_stopped_run_leaves_nothing() {
        // R9.31
        for (name, number) in [("INT", 2), ("TERM", 15), ("HUP", 1), ("QUIT", 3)] {
            if is_ignored(number) {
                continue;
            }
            let bench = bench();
            let mut child = waiting(&bench);
            signal(&child, name);
            let status = child.wait().expect("it ends");
            assert_eq!(status.signal(), Some(number), "{name}");
            assert_eq!(unfinished(&bench), 0, "{name}");
            assert!(!bench.folder().join("a.txt").exists());
        }
    }

    #[test]
    fn what_a_killed_run_left_goes_with_the_next() {
        // R9.31
        let bench = bench();
        let mut killed = waiting(&bench);
        signal(&killed, "KILL");
        killed.wait().expect("it ends");
        assert_eq!(unfinished(&bench), 2);
        assert_eq!(bench.status(&["run", "part.nc", "-o", "a.txt"]), Some(0));
        assert_eq!(unfinished(&bench), 0);
    }

    #[test]
    fn links_are_seen_through() {
        // R9.70
        let bench = bench();
        let path = |name: &str| bench.folder().join(name);
        symlink("part.nc", path("link")).expect("a link");
        let said = refused(&bench, &["run", "part.nc", "-o", "link"]);
        assert!(
            said.contains("`--output link` would overwrite the program `part.nc`"),
            "{said}"
        );
        symlink("nowhere", path("dangling")).expect("a link");
        for option in ["-o", "--state", "--html"] {
            let said = refused(&bench, &["run", "part.nc", option, "dangling"]);
            assert!(
                said.contains("a link to a file that does not exist"),
                "{said}"
            );
        }
        // A link to an output remains one.
        bench.write("real.txt", "old");
        symlink("real.txt", path("out")).expect("a link");
        assert_eq!(bench.status(&["run", "part.nc", "-o", "out"]), Some(0));
        assert!(path("out").is_symlink());
        assert_ne!(bench.read("real.txt"), "old");
    }

    #[test]
    fn what_is_read_only_stays() {
        let bench = bench();
        assert_eq!(bench.status(&["run", "part.nc", "--state", "s"]), Some(0));
        let rights = fs::Permissions::from_mode(0o444);
        fs::set_permissions(bench.folder().join("s"), rights).expect("set");
        let said = refused(&bench, &["run", "part.nc", "--state", "s"]);
        assert!(said.contains("read-only"), "{said}");
    }

    #[test]
    fn devices_are_written_and_full_ones_said() {
        // R9.26, R9.70
        let bench = bench();
        assert_eq!(
            bench.status(&["run", "part.nc", "-o", "/dev/null"]),
            Some(0)
        );
        let plain = bench.stdout(&["check", "part.nc"]);
        assert_eq!(
            bench.stdout(&["check", "part.nc", "-o", "/dev/stdout"]),
            plain
        );
        let said = refused(&bench, &["run", "part.nc", "-o", "/dev/full"]);
        assert!(said.contains("/dev/full"), "{said}");
        for arguments in [
            &["--help"][..],
            &["run", "--help"],
            &["--version"],
            &["explain"],
        ] {
            let full = fs::File::options()
                .write(true)
                .open("/dev/full")
                .expect("a device");
            let status = bench.command(arguments).stdout(full).status();
            assert_eq!(status.expect("it ends").code(), Some(2), "{arguments:?}");
        }
    }

    #[test]
    fn a_limit_of_the_size_of_files_is_said() {
        // R9.26
        let bench = bench();
        bench.write("long.nc", &"N10 X1\n".repeat(50_000));
        bench.write("old.txt", "old");
        let tool = env!("CARGO_BIN_EXE_frictcomp");
        for call in [
            "run --full long.nc -o old.txt",
            "run --full long.nc > new.txt",
            "run --format ndjson long.nc -o old.txt",
        ] {
            let script = format!("ulimit -f 8; exec {tool} {call}");
            let mut command = Command::new("sh");
            command.args(["-c", &script]).current_dir(bench.folder());
            let output = command.output().expect("sh starts");
            assert_eq!(output.status.code(), Some(2), "{call}: {}", stderr(&output));
            assert_eq!(bench.read("old.txt"), "old", "{call}");
            assert_eq!(unfinished(&bench), 0);
        }
    }

    #[test]
    fn only_programs_may_be_no_regular_files() {
        // R9.26
        let bench = bench();
        let fifo = |name: &str| {
            let made = Command::new("mkfifo")
                .arg(bench.folder().join(name))
                .status();
            assert!(made.expect("mkfifo starts").success());
        };
        for name in ["f.lis", "f.csv", "f.toml", "s.lock", "part.nc.timeline"] {
            fifo(name);
        }
        for arguments in [
            &["lists", "f.lis"][..],
            &["run", "--startup", "f.lis", "part.nc"],
            &["run", "--config", "f.toml", "part.nc"],
            &["run", "--state", "s", "part.nc"],
            &["golden", "part.nc"],
            &["golden", "--update", "part.nc"],
            &["current", "--recording", "f.csv", "--value-list", "v.lis"],
            &[
                "current",
                "--recording",
                "/dev/zero",
                "--value-list",
                "v.lis",
            ],
            &["circle", "--recording", "/dev/zero"],
            &["circle", "--plant", "f.toml"],
        ] {
            let said = refused(&bench, arguments);
            assert!(said.contains("not a regular file"), "{arguments:?}: {said}");
        }
    }

    #[test]
    fn golden_stays_in_its_tree() {
        let bench = bench();
        let outside = tempfile::tempdir().expect("a folder");
        let secret = outside.path().join("secret");
        fs::write(&secret, "secret\n").expect("written");
        symlink(&secret, bench.folder().join("part.nc.timeline")).expect("a link");
        for arguments in [&["golden", "."][..], &["golden", "--update", "."]] {
            let output = bench.call(arguments);
            assert_eq!(output.status.code(), Some(2));
            let said = stderr(&output);
            assert!(said.contains("leads out of the given folders"), "{said}");
            assert!(!String::from_utf8_lossy(&output.stdout).contains("secret\n"));
        }
        assert_eq!(fs::read_to_string(&secret).expect("read"), "secret\n");
    }
}

#[test]
fn golden_writes_all_or_nothing_of_a_folder() {
    // R9.77
    let bench = bench();
    for folder in ["good", "bad", "later"] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
        bench.write(&format!("{folder}/a.nc"), PROGRAM);
    }
    bench.write("bad/frictcomp.toml", "[machin]\n");
    let output = bench.call(&["golden", "--update", "good", "bad", "later"]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("wrote `good/a.nc.timeline`"), "{said}");
    assert!(said.contains("wrote `later/a.nc.timeline`"), "{said}");
    assert!(said.contains("left out `bad`"), "{said}");
    assert!(said.contains("2 of 3 timelines written"), "{said}");
    assert!(!bench.folder().join("bad/a.nc.timeline").exists());
    // A folder in which one file cannot be written.
    bench.write("later/b.nc", PROGRAM);
    fs::create_dir(bench.folder().join("later/b.nc.timeline")).expect("a folder");
    bench.write("later/a.nc", "N10 M30\n");
    let before = bench.read("later/a.nc.timeline");
    assert_eq!(bench.status(&["golden", "--update", "later"]), Some(2));
    assert_eq!(bench.read("later/a.nc.timeline"), before);
}
