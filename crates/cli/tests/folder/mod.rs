//! A folder with a machine and programs, and the tool called in it.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::{fs, io};

use serde_json::Value;

/// X and Y with a value list, Z not configured.
pub(crate) const MACHINE: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
value = { mode = 3, max_points = 20, table = [[0, 12], [1800, 10]] }
[[axis]]
name = \"Y\"
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = \"Z\"
frict_comp = false
";

/// A folder with a machine and programs.
pub(crate) struct Bench(tempfile::TempDir);

impl Bench {
    pub(crate) fn new(programs: &[(&str, &str)]) -> Self {
        let bench = Self(tempfile::tempdir().expect("a folder"));
        bench.write("frictcomp.toml", MACHINE);
        for (name, text) in programs {
            bench.write(name, text);
        }
        bench
    }

    pub(crate) fn folder(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.folder().join(name), text).expect("written");
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder().join(name)).expect("text")
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        command(self.folder(), arguments)
    }

    pub(crate) fn call(&self, arguments: &[&str]) -> Output {
        call(self.folder(), arguments)
    }

    pub(crate) fn status(&self, arguments: &[&str]) -> Option<i32> {
        self.call(arguments).status.code()
    }

    pub(crate) fn stdout(&self, arguments: &[&str]) -> String {
        String::from_utf8(self.call(arguments).stdout).expect("text")
    }

    /// Returns the lines of `run --format ndjson` with further arguments.
    pub(crate) fn records(&self, arguments: &[&str]) -> Vec<String> {
        let mut all = vec!["run", "--format", "ndjson"];
        all.extend(arguments);
        self.stdout(&all).lines().map(str::to_owned).collect()
    }

    /// Returns the block records, as JSON.
    pub(crate) fn blocks(&self, arguments: &[&str]) -> Vec<Value> {
        let records = self.records(arguments);
        let values = records.iter().map(|line| json(line));
        values.filter(|it| it["record"] == "block").collect()
    }
}

/// Returns the command in a folder, without an input.
pub(crate) fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frictcomp"));
    command.current_dir(folder).args(arguments);
    command.stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Returns the result of the command in a folder.
pub(crate) fn call(folder: &Path, arguments: &[&str]) -> Output {
    starting(|| command(folder, arguments).output())
}

/// Returns the result of a call that must succeed.
pub(crate) fn succeeded(folder: &Path, arguments: &[&str]) -> Output {
    let output = call(folder, arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {}",
        said(&output).1
    );
    output
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// Returns the exit status of the command in a folder, and both outputs in one line.
pub(crate) fn answer(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    said(&call(folder, arguments))
}

/// Returns the JSON document that the command prints in a folder.
pub(crate) fn document(folder: &Path, arguments: &[&str]) -> Value {
    let output = call(folder, arguments);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", said(&output).1))
}

/// Returns the exit status, and both outputs in one line.
pub(crate) fn said(output: &Output) -> (Option<i32>, String) {
    let both = stdout(output) + &stderr(output);
    (output.status.code(), one_line(&both))
}

/// Returns a text with its blanks and line breaks merged: lines are broken wherever they are too long.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns the result of starting the tool. When it starts many processes at once, Wine refuses a start now and then
/// with `ERROR_INTERNAL_ERROR`, before the tool has run at all; such a start is tried again.
pub(crate) fn starting<T>(mut start: impl FnMut() -> io::Result<T>) -> T {
    const ERROR_INTERNAL_ERROR: i32 = 1359;
    for _ in 0..3 {
        match start() {
            Err(error) if cfg!(windows) && error.raw_os_error() == Some(ERROR_INTERNAL_ERROR) => {}
            started => return started.expect("the tool starts"),
        }
    }
    start().expect("the tool starts")
}

pub(crate) fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Returns a state as a file of schema 2, which has no checksum and can be edited.
pub(crate) fn of_schema_2(state: &str) -> String {
    let (content, _) = state.split_once(",\n  \"checksum\"").expect("a checksum");
    let content = content.replacen("\"schema\": 4", "\"schema\": 2", 1);
    format!("{content}\n}}\n")
}
