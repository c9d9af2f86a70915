//! Console blocks: below each command of a document stands what it prints.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::folder::{command, starting, stderr, stdout};

/// Environment in which the commands of a document are called.
pub(crate) trait Stage {
    /// Takes a heading.
    fn begin(&mut self) {}

    /// Takes a block that is not a console.
    fn take(&mut self, _kind: &str, _text: &str) {}

    /// Returns whether this system has the programs that the commands need.
    fn is_equipped(&self) -> bool {
        true
    }

    /// Returns the folder in which a command is called.
    fn folder(&mut self, command: &str) -> PathBuf;
}

/// Returns the document with the current output below each command.
pub(crate) fn replayed(text: &str, stage: &mut impl Stage) -> String {
    let mut fresh = String::new();
    let mut lines = text.split_inclusive('\n');
    while let Some(line) = lines.next() {
        fresh.push_str(line);
        if line.starts_with("## ") {
            stage.begin();
        }
        let kind = line.trim_start_matches('`');
        let fence = &line[..line.len() - kind.len()];
        if fence.len() < 3 {
            continue;
        }
        let is_inside = |line: &&str| line.trim_end() != fence;
        let block: Vec<&str> = lines.by_ref().take_while(is_inside).collect();
        let kind = kind.trim_end();
        if kind == "console" && stage.is_equipped() {
            let mut below = String::new();
            for command in block.iter().filter_map(|line| line.strip_prefix("$ ")) {
                let _ = write!(fresh, "$ {command}");
                let folder = stage.folder(command).join(&below);
                match command.trim_end().strip_prefix("cd ") {
                    Some(name) => below = words(name).concat(),
                    None => fresh.push_str(&play(command.trim_end(), &folder)),
                }
            }
        } else {
            if kind != "console" {
                stage.take(kind, &block.concat());
            }
            fresh.extend(block);
        }
        let _ = writeln!(fresh, "{fence}");
    }
    fresh
}

/// A command as a shell reads it.
#[derive(Default)]
struct Typed {
    /// Variables of the environment before its name.
    variables: Vec<(String, String)>,
    words: Vec<String>,
    input: Option<String>,
    /// Whether the output and the errors of the command go to `/dev/null`.
    is_silent: [bool; 2],
}

impl Typed {
    fn new(line: &str) -> Self {
        let mut typed = Self::default();
        let mut words = words(line).into_iter();
        while let Some(word) = words.next() {
            match (word.as_str(), word.split_once('=')) {
                ("<", _) => typed.input = words.next(),
                (">/dev/null", _) => typed.is_silent[0] = true,
                ("2>/dev/null", _) => typed.is_silent[1] = true,
                (_, Some((name, value))) if typed.words.is_empty() => {
                    typed.variables.push((name.to_owned(), value.to_owned()));
                }
                _ => typed.words.push(word),
            }
        }
        typed
    }

    /// Returns the output of the tool or git: stdout, stderr, and `? 1` for an exit status other than 0.
    fn printed(&self, folder: &Path, program: fn(&Path, &[&str]) -> Command) -> String {
        let arguments: Vec<&str> = self.words[1..].iter().map(String::as_str).collect();
        let output = starting(|| {
            let mut command = program(folder, &arguments);
            command.envs(self.variables.iter().cloned());
            if let Some(input) = &self.input {
                let file = fs::File::open(folder.join(input)).expect("an input");
                command.stdin(Stdio::from(file));
            }
            command.output()
        });
        let mut text = String::new();
        let printed = [stdout(&output), stderr(&output)];
        for (printed, is_silent) in printed.into_iter().zip(self.is_silent) {
            if !is_silent {
                push(&mut text, &printed);
            }
        }
        match output.status.code() {
            Some(0) => {}
            Some(status) => writeln!(text, "? {status}").expect("text"),
            None => panic!("`{}` was killed", self.words.join(" ")),
        }
        text
    }
}

/// Returns the words of a line; what is quoted has blanks.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut quote = None;
    let mut word: Option<String> = None;
    for letter in line.chars() {
        match (letter, quote) {
            (_, Some(open)) if letter == open => quote = None,
            ('"' | '\'', None) => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (' ', None) => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

/// Returns the command git in a folder, without the settings of the user.
pub(crate) fn git(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new("git");
    command.current_dir(folder).stdin(Stdio::null());
    for setting in [
        "user.name=n",
        "user.email=n@example.org",
        "init.defaultBranch=m",
    ] {
        command.args(["-c", setting]);
    }
    command.env("GIT_CONFIG_NOSYSTEM", "1");
    command.env("GIT_CONFIG_GLOBAL", "/dev/null");
    command.args(arguments);
    command
}

/// Runs a command line and returns its output: the tool, git, or one of the few commands that prepare and show the
/// files of a case.
fn play(line: &str, folder: &Path) -> String {
    let typed = Typed::new(line);
    let [name, files @ ..] = &typed.words[..] else {
        panic!("no command in `{line}`");
    };
    let mut shown = String::new();
    match name.as_str() {
        "frictcomp" => shown = typed.printed(folder, command),
        "git" => shown = typed.printed(folder, git),
        "cat" => {
            for file in files {
                let text = fs::read_to_string(folder.join(file));
                push(
                    &mut shown,
                    &text.unwrap_or_else(|it| format!("{file}: {it}")),
                );
            }
        }
        "rm" => {
            for file in files {
                fs::remove_file(folder.join(file)).expect("a file");
            }
        }
        "ls" => {
            let entries = fs::read_dir(folder).expect("a folder");
            let names = entries.map(|entry| entry.expect("an entry").file_name());
            let mut names: Vec<String> = names.map(|it| it.to_string_lossy().into()).collect();
            names.sort();
            for name in names {
                let _ = writeln!(shown, "{name}");
            }
        }
        _ => panic!("`{line}` is no call of the tool"),
    }
    shown
}

/// Appends what was printed, in whole lines.
fn push(text: &mut String, printed: &str) {
    text.push_str(printed);
    if !printed.is_empty() && !printed.ends_with('\n') {
        text.push('\n');
    }
}
