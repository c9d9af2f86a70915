//! Programs from a pipe: they run while they arrive, with the same output as from a file.

use crate::folder::command;
use crate::workspace::{files, root};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};

/// No program of the tests needs more blocks; some never end.
const BUDGET: [&str; 2] = ["--max-blocks", "2000"];

fn tool() -> Command {
    let mut command = command(root(), &[]);
    command.stdin(Stdio::piped()).stderr(Stdio::null());
    command
}

/// The output of a call with a text on standard input.
fn output(arguments: &[&str], input: &[u8]) -> String {
    let mut child = tool()
        .args(arguments)
        .args(BUDGET)
        .spawn()
        .expect("the tool starts");
    let mut stdin = child.stdin.take().expect("it is piped");
    let input = input.to_vec();
    // A program that ended reads no further; the pipe is closed then.
    let writer = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let mut text = String::new();
    let mut stdout = child.stdout.take().expect("it is piped");
    stdout.read_to_string(&mut text).expect("UTF-8");
    child.wait().expect("it ends");
    writer.join().expect("it wrote or was refused");
    text
}

#[test]
fn records_go_out_while_the_program_still_comes() {
    // R9.40
    for format in ["ndjson", "text"] {
        let mut child = tool()
            .args([
                "run",
                "--isolated",
                "--enable",
                "X",
                "--changes",
                "--format",
                format,
                "-",
            ])
            .spawn()
            .expect("the tool starts");
        let mut stdin = child.stdin.take().expect("it is piped");
        let mut lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        for word in ["OFF", "ON", "OFF"] {
            writeln!(stdin, "X[COMP {word} FRICT]").expect("it listens");
            stdin.flush().expect("it listens");
            // If the record were held back, this would wait for ever.
            let found = lines
                .by_ref()
                .map(|line| line.expect("UTF-8"))
                .find(|line| line.contains(&format!("X[COMP {word} FRICT]")));
            assert!(found.is_some(), "{format} {word}");
        }
        drop(stdin);
        assert!(child.wait().expect("it ends").success());
    }
}

#[test]
fn a_program_from_a_pipe_says_what_it_says_from_a_file() {
    // R9.40. Without a described machine, a pipe shows no axis beforehand (R9.74).
    let folder = tempfile::tempdir().expect("a folder");
    let machine = folder.path().join("machine.toml");
    let axes = ["X", "Y", "Z"].map(|axis| format!("[[axis]]\nname = \"{axis}\"\nenable = true\n"));
    std::fs::write(&machine, axes.concat()).expect("written");
    let machine = machine.to_str().expect("UTF-8");
    let mut compared = 0;
    for path in files("programs/ok", &["nc"])
        .into_iter()
        .chain(files("programs/err", &["nc"]))
    {
        let input = std::fs::read(&path).expect("a program");
        let shown = path.strip_prefix(root()).expect("below the root");
        let name = &shown.to_str().expect("UTF-8").replace('\\', "/");
        let arguments = ["run", "--config", machine, "--format", "ndjson"];
        let run = |file| [&arguments[..], &[file]].concat();
        let from_file = output(&run(name), b"");
        // A refused program runs up to where a pipe shows why; called files are next to a file.
        let refused = from_file.contains("\"seq\":0,\"by\":\"error\"");
        let calls = from_file.contains("FC320") || from_file.contains("\"level\"");
        if refused || calls {
            continue;
        }
        compared += 1;
        let from_pipe = output(&run("-"), &input);
        assert_eq!(from_pipe.replace("<stdin>", name), from_file, "{name}");
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn every_main_program_but_the_one_that_runs_is_named() {
    // R2.11
    let bench = tempfile::tempdir().expect("a folder");
    let path = bench.path().join("part.nc");
    let file = &path.to_str().expect("UTF-8").replace('\\', "/");
    for (program, never_run) in [
        ("%A\nM30\n", &[][..]),
        ("%A\nM30\n%B\nM30\n%L C\nM17\n%D\nX1\n", &["B", "D"]),
        ("X1\n%A\nM30\n", &["A"]),
        ("%L A\nM17\n%B\nM30\n%C\nM30\n", &["C"]),
        // A `%` alone ends a file, as on tape.
        ("%A\nM30\n%\n", &[]),
        ("%A\nM30\n%L B\nM17\n%\n", &[]),
        ("%A\nM30\n%B\n%C\nM30\n", &["C"]),
        // Flow: the text is in memory, from there on or from the start.
        ("%A\nM30\n%B\n$IF 1 == 1\n$ENDIF\nM30\n", &["B"]),
        ("%A\nX1\n$IF 1 == 1\n$ENDIF\n%B\nM30\n", &["B"]),
        ("$IF 1 == 1\n$ENDIF\n%B\nM30\n", &["B"]),
        ("%A\n%B\n$IF 1 == 1\n$ENDIF\nM30\n", &["B"]),
    ] {
        std::fs::write(&path, program).expect("written");
        let check = |input| {
            output(
                &["check", "--isolated", "--format", "concise", input],
                program.as_bytes(),
            )
        };
        let from_file = check(file);
        assert_eq!(check("-").replace("<stdin>", file), from_file, "{program}");
        let named: Vec<&str> = from_file
            .lines()
            .filter(|line| line.contains("FC324"))
            .map(|line| line.split('`').nth(1).expect("a name"))
            .collect();
        assert_eq!(named, never_run, "{program}: {from_file}");
    }
}

#[test]
fn a_jump_back_behind_streamed_blocks_is_taken() {
    // R9.40, R2.42
    let program = b"N1 X1\nN2 X[COMP OFF FRICT]\nP1 = 0\nN10: P1 = P1 + 1\nN20 Y1\n$IF P1 < 3 $GOTO N10\nM30\n";
    let text = output(
        &["run", "--isolated", "--enable", "X", "--format", "csv", "-"],
        program,
    );
    let again = text.lines().filter(|line| line.contains("N20 Y1")).count();
    assert_eq!(again, 3, "{text}");
    assert!(text.contains("<stdin>,5,20,N20 Y1,"), "{text}");
}

#[test]
fn a_check_prints_the_same_on_any_number_of_processors() {
    // R9.16
    for format in ["text", "ndjson", "sarif"] {
        let check = |jobs| {
            output(
                &["check", "--format", format, "--jobs", jobs, "programs"],
                b"",
            )
        };
        let one = check("1");
        assert!(!one.is_empty());
        assert_eq!(check("4"), one, "{format}");
    }
}
