//! Resources that the system refuses: memory, disk space, permissions, a reader for the output.

use std::fs;
use std::io::{Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::folder::Bench;

const LEAVE_OFF: &str = "X[COMP OFF FRICT]\nM30\n";
const SWITCH_ON: &str = "X[COMP ON FRICT]\nM30\n";
const FORMATS: [&str; 4] = ["text", "ndjson", "json", "csv"];
const LISTINGS: [&str; 6] = ["text", "concise", "json", "ndjson", "github", "sarif"];

/// The user `nobody`, to whom permissions apply even if the tests run as root.
const NOBODY: u32 = 65534;

fn said(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("text")
}

/// Returns a call in a shell that first takes something away: `ulimit …`.
fn limited(bench: &Bench, limit: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.current_dir(bench.folder()).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.args(["-c", &format!("{limit}; exec \"$@\""), "sh"]);
    command.arg(env!("CARGO_BIN_EXE_frictcomp")).args(arguments);
    command
}

/// Writes plain blocks with a COMP command every thousand of them, each with a comment; returns how
/// many bytes they are.
fn write_long_program(path: &Path, blocks: u32, comment: &str) -> u64 {
    let file = fs::File::create(path).expect("a file");
    let mut writer = std::io::BufWriter::new(file);
    for block in 1..blocks {
        let (a, b) = (block % 997, block % 613);
        match block % 2000 {
            0 => writeln!(writer, "N{block} X[COMP ON FRICT] {comment}"),
            1000 => writeln!(writer, "N{block} X[COMP OFF FRICT] {comment}"),
            _ => writeln!(writer, "N{block} G01 X{a}.125 Y-{b}.5 F1500 {comment}"),
        }
        .expect("written");
    }
    writeln!(writer, "M30").expect("written");
    let file = writer.into_inner().expect("written");
    file.metadata().expect("a size").len()
}

/// Runs the tool with an address space of 64 MiB, on a program that is longer.
fn run_in_64_mebibytes(blocks: u32, comment: &str, calls: &[&[&str]]) {
    let bench = Bench::new(&[]);
    let path = bench.folder().join("long.nc");
    let bytes = write_long_program(&path, blocks, comment);
    assert!(bytes > 64 << 20, "{bytes}");
    for call in calls {
        let mut command = limited(&bench, "ulimit -v 65536", call);
        let output = command.stdout(Stdio::null()).output().expect("it starts");
        let (status, said) = (output.status.code(), said(&output));
        assert_eq!(status, Some(0), "{call:?}: {said}");
    }
}

#[test]
fn a_program_may_be_longer_than_the_memory() {
    // R9.40
    let comment = format!("({})", "Schruppen ".repeat(60));
    run_in_64_mebibytes(
        110_000,
        &comment,
        &[
            &["check", "--fail-on", "error", "long.nc"],
            &["run", "--format", "csv", "long.nc"],
        ],
    );
}

#[test]
#[ignore = "ten million blocks take a minute in six formats"]
fn ten_million_blocks_need_no_more_memory() {
    // R9.40
    run_in_64_mebibytes(
        10_000_000,
        "",
        &[
            &["check", "--fail-on", "error", "long.nc"],
            &["run", "--changes", "long.nc"],
            &["run", "long.nc"],
            &["run", "--format", "ndjson", "long.nc"],
            &["run", "--format", "json", "long.nc"],
            &["run", "--format", "csv", "long.nc"],
        ],
    );
}

#[test]
fn too_little_memory_for_a_program_with_flow_leaves_the_state_alone() {
    // R9.31: a program with flow is read as a whole; without memory for it the process is ended.
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    assert_eq!(bench.status(&["run", "--state", "s.json", "a.nc"]), Some(0));
    let good = bench.read("s.json");
    bench.write(
        "b.nc",
        &format!("$IF 1\n$ENDIF\n{}M30\n", "X1 Y2 Z3\n".repeat(8_000_000)),
    );
    let call = ["run", "--changes", "--state", "s.json", "b.nc"];
    let output = limited(&bench, "ulimit -v 60000", &call)
        .output()
        .expect("it starts");
    assert_ne!(output.status.code(), Some(0));
    assert!(said(&output).contains("memory"), "{}", said(&output));
    assert_eq!(bench.read("s.json"), good);
}

#[test]
fn what_is_too_big_to_be_kept_is_refused() {
    // R9.26
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    for (file, start, call, limit) in [
        ("b.nc", "$IF 1\n", vec!["run", "b.nc"], "1 GiB"),
        (
            "x.lis",
            "frict_comp.mode 3\n",
            vec!["lists", "x.lis"],
            "64 MiB",
        ),
        (
            "s.json",
            "{",
            vec!["run", "--state", "s.json", "a.nc"],
            "1 GiB",
        ),
    ] {
        bench.write(file, start);
        let sparse = fs::File::options()
            .write(true)
            .open(bench.folder().join(file));
        sparse
            .and_then(|file| file.set_len((1 << 30) + 1))
            .expect("a sparse file");
        let output = bench.call(&call);
        assert_eq!(output.status.code(), Some(2), "{call:?}");
        let said = said(&output);
        assert!(
            said.contains(file) && said.contains(&format!("larger than {limit}")),
            "{said}"
        );
    }
}

#[test]
fn a_state_is_no_pipe() {
    // R9.30: reading one would wait forever.
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let made = Command::new("mkfifo")
        .arg(bench.folder().join("pipe"))
        .status();
    assert!(made.expect("mkfifo is there").success());
    for (place, why) in [("pipe", "cannot hold a state"), (".", "it is a folder")] {
        let output = bench.call(&["run", "--state", place, "a.nc"]);
        assert_eq!(output.status.code(), Some(2));
        let said = said(&output);
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn budgets_end_what_does_not_end_by_itself() {
    // R2.60, R9.14, R9.91
    let nested = format!("{}{}M30\n", "$IF 1\n".repeat(60), "$ENDIF\n".repeat(60));
    let brackets = format!("P1 = {}1{}\nM30\n", "[".repeat(65), "]".repeat(65));
    let programs = [
        (
            "FC910",
            "--max-blocks",
            "P1=1\n$WHILE P1\nP1=P1*1.0001\n$ENDWHILE\nM30\n",
        ),
        (
            "FC911",
            "--max-calls",
            "%L A\nLL A\nM17\n%MAIN\nLL A\nM30\n",
        ),
        ("FC912", "--max-nesting", &nested),
        ("FC913", "64", &brackets),
        (
            "FC914",
            "--max-macros",
            "\"A\" = \"\\\"A\\\"\"\n\"A\"\nM30\n",
        ),
    ];
    for (code, option, program) in programs {
        let bench = Bench::new(&[("a.nc", program)]);
        let call = ["run", "--changes", "--max-blocks", "10000", "a.nc"];
        let output = bench.call(&call);
        let text = String::from_utf8(output.stdout).expect("text");
        assert_eq!(output.status.code(), Some(1), "{code}: {text}");
        assert!(
            text.contains(code) && text.contains(option),
            "{code}: {text}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_the_output_is_said() {
    // R9.26, R9.31
    let outside = "X=V.E.PART\nM30\n";
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", SWITCH_ON), ("c.nc", outside)]);
    assert_eq!(bench.status(&["run", "--state", "s.json", "a.nc"]), Some(0));
    let good = bench.read("s.json");
    let mut calls = Vec::new();
    for format in FORMATS {
        calls.push(vec!["run", "--state", "s.json", "--format", format, "b.nc"]);
    }
    for format in LISTINGS {
        calls.push(vec!["check", "--format", format, "a.nc"]);
    }
    calls.push(vec!["show", "values", "c.nc"]);
    for call in calls {
        let full = fs::File::options().write(true).open("/dev/full");
        let mut to_stdout = bench.command(&call);
        to_stdout.stdout(full.expect("a full disk"));
        let mut to_file = bench.command(&call);
        to_file.args(["--output", "/dev/full"]);
        for mut command in [to_stdout, to_file] {
            let output = command.output().expect("it starts");
            let said = said(&output);
            assert_eq!(output.status.code(), Some(2), "{call:?}: {said}");
            let reason = "error: the output cannot be written: No space left";
            assert!(said.contains(reason), "{call:?}: {said}");
            assert_eq!(bench.read("s.json"), good);
        }
    }
}

#[test]
fn a_full_disk_under_a_file_leaves_the_old_one() {
    // R9.31
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let calls = [
        (vec!["run", "--state", "s.json", "a.nc"], "s.json"),
        (vec!["golden", "--update", "a.nc"], "a.nc.timeline"),
        (vec!["run", "--html", "r.html", "a.nc"], "r.html"),
    ];
    for (call, _) in &calls {
        assert_eq!(bench.status(call), Some(0));
    }
    bench.write("a.nc", SWITCH_ON);
    let files = || fs::read_dir(bench.folder()).expect("a folder").count();
    for (call, file) in calls {
        let (good, count) = (bench.read(file), files());
        // If ignored, the signal becomes an error of the write; otherwise it ends the process.
        let limit = "trap '' XFSZ; ulimit -f 0";
        let output = limited(&bench, limit, &call).output().expect("it starts");
        assert_eq!(output.status.code(), Some(2), "{call:?}: {}", said(&output));
        assert!(
            said(&output).contains("cannot be written"),
            "{}",
            said(&output)
        );
        assert!(said(&output).contains(file), "{}", said(&output));
        assert_eq!(bench.read(file), good, "{call:?}");
        assert_eq!(files(), count, "nothing half written stays");
        let output = limited(&bench, "ulimit -f 0", &call)
            .output()
            .expect("it starts");
        assert_ne!(output.status.code(), Some(0));
        assert_eq!(bench.read(file), good, "{call:?}");
        assert_eq!(bench.status(&call), Some(0), "room again");
        assert_ne!(bench.read(file), good);
    }
}

#[test]
fn a_closed_pipe_is_quiet_in_every_format() {
    // R9.26
    let bench = Bench::new(&[("a.nc", &"X[COMP ON FRICT]\nG01 X1\n".repeat(5_000))]);
    let mut calls = Vec::new();
    for format in FORMATS {
        calls.push(vec!["run", "--format", format, "a.nc"]);
    }
    calls.push(vec!["run", "--full", "a.nc"]);
    for format in LISTINGS {
        calls.push(vec!["check", "--format", format, "a.nc"]);
    }
    calls.push(vec!["golden", "a.nc"]);
    calls.push(vec!["man"]);
    for call in calls {
        let mut child = bench.command(&call).spawn().expect("it starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        let quiet = !said(&output).contains("error");
        assert!(quiet, "{call:?}: {}", said(&output));
        let status = output.status.code();
        assert!(
            status == Some(0) || call[0] == "golden",
            "{call:?}: {status:?}"
        );
    }
}

#[test]
fn a_closed_pipe_leaves_the_state_alone() {
    // R9.31: a run that was cut short is not a completed run.
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    assert_eq!(bench.status(&["run", "--state", "s.json", "a.nc"]), Some(0));
    let good = bench.read("s.json");
    bench.write("b.nc", &"X[COMP ON FRICT]\n".repeat(50_000));
    let call = ["run", "--format", "csv", "--state", "s.json", "b.nc"];
    let mut child = bench.command(&call).spawn().expect("it starts");
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
    assert_eq!(bench.read("s.json"), good);
}

#[test]
fn a_program_may_vanish_while_it_is_read() {
    let bench = Bench::new(&[("a.nc", &("X1 Y2 Z3\n".repeat(400_000) + "M30\n"))]);
    let path = bench.folder().join("a.nc");
    let mut child = bench
        .command(&["run", "--format", "csv", "a.nc"])
        .spawn()
        .expect("it starts");
    let mut stdout = child.stdout.take().expect("a pipe");
    stdout.read_exact(&mut [0; 4096]).expect("it runs");
    fs::remove_file(&path).expect("removed");
    let rest = std::io::read_to_string(stdout).expect("text");
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
    assert!(
        rest.lines().count() > 399_000,
        "an open file is read to its end"
    );
}

#[test]
fn a_program_that_is_cut_while_it_is_read_is_refused() {
    // R9.26
    let bench = Bench::new(&[("a.nc", &("X1 Y2 Z3\n".repeat(400_000) + "M30\n"))]);
    let path = bench.folder().join("a.nc");
    let call = ["run", "--format", "csv", "--state", "s.json", "a.nc"];
    let mut child = bench.command(&call).spawn().expect("it starts");
    let mut stdout = child.stdout.take().expect("a pipe");
    stdout.read_exact(&mut [0; 4096]).expect("it runs");
    let file = fs::File::options()
        .write(true)
        .open(&path)
        .expect("the program");
    file.set_len(2_000_000).expect("cut");
    drop(std::io::read_to_string(stdout).expect("text"));
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(
        said(&output).contains("changed while it was read"),
        "{}",
        said(&output)
    );
    assert!(!bench.folder().join("s.json").exists());
}

/// Returns a call as a user without permissions; `None` if the tests cannot change the user.
fn as_nobody(bench: &Bench, arguments: &[&str]) -> Option<Output> {
    let mut command = bench.command(arguments);
    let is_root = fs::metadata("/proc/self").is_ok_and(|it| {
        use std::os::unix::fs::MetadataExt;
        it.uid() == 0
    });
    if is_root {
        command.uid(NOBODY).gid(NOBODY);
    }
    let output = command.output();
    if output.is_err() {
        eprintln!("skipped: the tool cannot be started as another user");
    }
    output.ok()
}

fn set_mode(path: &Path, mode: u32) {
    fs::set_permissions(path, fs::Permissions::from_mode(mode)).expect("rights");
}

#[test]
fn a_folder_without_the_right_to_write_is_said() {
    // R9.26, R9.31
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    assert_eq!(bench.status(&["run", "--state", "s.json", "a.nc"]), Some(0));
    let good = bench.read("s.json");
    set_mode(bench.folder(), 0o555);
    let calls = [
        (vec!["run", "--state", "s.json", "a.nc"], "s.json"),
        (vec!["run", "--state", "new.json", "a.nc"], "new.json"),
        (vec!["run", "--output", "out.csv", "a.nc"], "out.csv"),
        (vec!["golden", "--update", "a.nc"], "a.nc.timeline"),
        (vec!["run", "--html", "r.html", "a.nc"], "r.html"),
    ];
    for (call, file) in calls {
        let Some(output) = as_nobody(&bench, &call) else {
            break;
        };
        assert_eq!(output.status.code(), Some(2), "{call:?}");
        assert!(said(&output).contains(file), "{}", said(&output));
        assert!(
            said(&output).contains("cannot be written"),
            "{}",
            said(&output)
        );
    }
    let output = as_nobody(&bench, &["run", "a.nc"]);
    assert!(
        output.is_none_or(|output| output.status.success()),
        "reading needs no more"
    );
    set_mode(bench.folder(), 0o755);
    assert_eq!(bench.read("s.json"), good);
}

#[test]
fn a_program_that_cannot_be_read_hides_no_message_of_the_others() {
    // R9.26
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", "M30\n"), ("c.nc", LEAVE_OFF)]);
    set_mode(&bench.folder().join("b.nc"), 0o000);
    for format in LISTINGS {
        let Some(output) = as_nobody(&bench, &["check", "--format", format, "."]) else {
            break;
        };
        assert_eq!(output.status.code(), Some(2), "{format}");
        let listing = String::from_utf8_lossy(&output.stdout);
        assert!(
            listing.contains("a.nc") && listing.contains("c.nc"),
            "{listing}"
        );
        assert!(said(&output).contains("b.nc"), "{}", said(&output));
    }
}

#[test]
fn a_file_without_the_right_to_read_is_said() {
    // R9.26
    let bench = Bench::new(&[
        ("a.nc", LEAVE_OFF),
        ("sub.nc", "M17\n"),
        ("b.nc", "L sub.nc\nM30\n"),
    ]);
    assert_eq!(bench.status(&["run", "--state", "s.json", "a.nc"]), Some(0));
    set_mode(bench.folder(), 0o777);
    let calls = [
        (vec!["run", "a.nc"], "a.nc"),
        (vec!["check", "a.nc"], "a.nc"),
        (vec!["run", "b.nc"], "frictcomp.toml"),
        (vec!["run", "--state", "s.json", "b.nc"], "s.json"),
    ];
    for (call, file) in calls {
        set_mode(&bench.folder().join(file), 0o000);
        let output = as_nobody(&bench, &call);
        set_mode(&bench.folder().join(file), 0o644);
        let Some(output) = output else { break };
        assert_eq!(output.status.code(), Some(2), "{call:?}: {}", said(&output));
        assert!(said(&output).contains(file), "{call:?}: {}", said(&output));
    }
    // A called program is the responsibility of the program that calls it.
    set_mode(&bench.folder().join("sub.nc"), 0o000);
    if let Some(output) = as_nobody(&bench, &["run", "b.nc"]) {
        let text = String::from_utf8(output.stdout).expect("text");
        assert!(text.contains("FC320"), "{text}");
    }
}

/// Returns the KiB of address space in which the tool just starts; it depends on how the tool was built.
fn least_space(bench: &Bench) -> u32 {
    let starts = |space: &u32| {
        let limit = format!("ulimit -v {space}");
        let output = limited(bench, &limit, &["--version"]).output();
        output.expect("a shell starts").status.success()
    };
    let mut spaces = (8_000..65_536).step_by(1_000);
    spaces.find(starts).expect("64 MiB are enough to start")
}

#[test]
fn where_threads_cannot_start_the_work_goes_on() {
    // R2.60: each thread takes address space for its stack.
    let bench = Bench::new(&[
        ("a.nc", LEAVE_OFF),
        ("b.nc", SWITCH_ON),
        ("c.nc", LEAVE_OFF),
    ]);
    let least = least_space(&bench);
    for space in [8_000, 16_000, 40_000].map(|more| least + more) {
        let limit = format!("ulimit -v {space}");
        let output = limited(
            &bench,
            &limit,
            &[
                "check",
                "-v",
                "-j",
                "64",
                "--fail-on",
                "error",
                "a.nc",
                "b.nc",
                "c.nc",
            ],
        )
        .output()
        .expect("the tool starts");
        assert_eq!(output.status.code(), Some(0), "{space}: {}", said(&output));
        assert!(
            said(&output).contains("3 files checked"),
            "{}",
            said(&output)
        );
    }
}

#[test]
fn a_simulation_without_memory_ends_with_a_message() {
    // R2.60
    let bench = Bench::new(&[]);
    let limit = format!("ulimit -v {}", least_space(&bench) + 8_000);
    for call in [&["circle"][..], &["tune", "--feeds", "1000"]] {
        let output = limited(&bench, &limit, call)
            .output()
            .expect("the tool starts");
        assert_eq!(output.status.code(), Some(2), "{call:?}: {}", said(&output));
        assert!(
            said(&output).contains("not enough memory"),
            "{call:?}: {}",
            said(&output)
        );
    }
}

#[test]
fn more_messages_than_are_said_are_counted_in_little_memory() {
    // R2.85, R9.40: in every format of `run` and `check`.
    let bench = Bench::new(&[]);
    let many = "X[COMP OFF FRICT]\nP1=P9\n".repeat(5_500) + "M30\n";
    fs::write(bench.folder().join("many.nc"), many).expect("written");
    for format in FORMATS {
        let call = ["run", "--keep-going", "--format", format, "many.nc"];
        let output = limited(&bench, "ulimit -v 65536", &call)
            .output()
            .expect("the tool starts");
        assert_eq!(output.status.code(), Some(1), "{format}: {}", said(&output));
    }
    for format in LISTINGS {
        let call = ["check", "-v", "-j", "1", "--format", format, "many.nc"];
        let output = limited(&bench, "ulimit -v 65536", &call)
            .output()
            .expect("the tool starts");
        assert_eq!(output.status.code(), Some(1), "{format}: {}", said(&output));
        let listed = std::str::from_utf8(&output.stdout).expect("text");
        assert!(listed.contains("FC905"), "{format}");
        if format == "text" {
            let total = said(&output);
            assert!(total.contains("5500 errors"), "{total}");
        }
    }
}
