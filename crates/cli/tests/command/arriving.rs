//! Programs from a pipe: they run while they arrive, with the same output as from a file.

use crate::folder::command;
use crate::workspace::{files, root};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};

/// Budget of blocks: enough for every program of the tests that ends.
const BUDGET: [&str; 2] = ["--max-blocks", "2000"];

fn tool() -> Command {
    let mut command = command(root(), &[]);
    command.stdin(Stdio::piped()).stderr(Stdio::null());
    command
}

/// Returns the output of a call with a text on standard input.
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
