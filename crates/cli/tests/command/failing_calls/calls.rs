//! The calls of the tool that write, and the files after one of them fails.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use crate::folder::{Bench, one_line};

/// Kinds of faults that a command meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Range {
    /// All kinds.
    Whole,
    /// A disk that is full from one call on, for commands that take long.
    FullDisk,
}

impl Range {
    fn faults(self) -> &'static [Fault] {
        match self {
            Self::Whole => &FAULTS,
            Self::FullDisk => &FAULTS[..1],
        }
    }
}

/// The value that a call returns instead of its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Fault {
    /// The number of the error; 0 makes a write take half of its bytes.
    number: i32,
    /// The words of the system, in any case of letters.
    cause: &'static str,
    /// Whether all later calls fail, too.
    lasts: bool,
}

const fn fault(number: i32, cause: &'static str, lasts: bool) -> Fault {
    Fault {
        number,
        cause,
        lasts,
    }
}

/// Faults with their numbers on Linux.
const FAULTS: [Fault; 7] = [
    fault(28, "no space left on device", true),
    fault(28, "no space left on device", false),
    fault(5, "input/output error", false),
    fault(5, "input/output error", true),
    fault(4, "interrupted", false),
    fault(13, "permission denied", false),
    fault(0, "", false),
];

/// The shim, built once; `None` where there is no C compiler.
static SHIM: LazyLock<Option<(tempfile::TempDir, PathBuf)>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let shim = folder.path().join("shim.so");
    let built = Command::new("cc")
        .args([
            "-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-o",
        ])
        .arg(&shim)
        .arg(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/command/failing_calls/shim.c"
        ))
        .arg("-ldl")
        .status();
    match built {
        Ok(status) => {
            assert!(status.success(), "the shim does not compile");
            Some((folder, shim))
        }
        Err(error) => {
            eprintln!("skipped: there is no C compiler `cc` ({error})");
            None
        }
    }
});

/// The files below a folder, by their names in it.
type Files = BTreeMap<String, Vec<u8>>;

fn files(folder: &Path) -> Files {
    let mut found = Files::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).expect("below it");
            let name = name.to_str().expect("a name").to_owned();
            found.insert(name, fs::read(path).expect("a file"));
        }
    }
    found
}

/// Restores a folder.
fn restore(folder: &Path, before: &Files) {
    for name in files(folder).keys() {
        fs::remove_file(folder.join(name)).expect("removed");
    }
    for entry in fs::read_dir(folder).expect("a folder") {
        fs::remove_dir_all(entry.expect("an entry").path()).expect("removed");
    }
    for (name, bytes) in before {
        let path = folder.join(name);
        let folder = path.parent().expect("a folder");
        fs::create_dir_all(folder).expect("made");
        fs::write(&path, bytes).expect("written");
    }
}

/// A command that writes, in a folder with the files that it needs.
struct Trial<'a> {
    bench: &'a Bench,
    shim: &'a Path,
    call: &'a [&'a str],
    before: Files,
}

impl Trial<'_> {
    fn command(&self) -> Command {
        let root = self.bench.folder().canonicalize().expect("a folder");
        let mut command = self.bench.command(self.call);
        command.env("LD_PRELOAD", self.shim).env("FAULT_ROOT", root);
        command
    }

    /// Returns the effect of the command if nothing fails, and the calls that write.
    fn undisturbed(&self) -> (Output, Files, Vec<String>) {
        let log = tempfile::NamedTempFile::new().expect("a file");
        let mut command = self.command();
        command.env("FAULT_LOG", log.path());
        let output = command.output().expect("it starts");
        let calls = fs::read_to_string(log.path()).expect("text");
        let after = files(self.bench.folder());
        (output, after, calls.lines().map(str::to_owned).collect())
    }

    fn with(&self, number: usize, fault: Fault) -> (Output, Files) {
        restore(self.bench.folder(), &self.before);
        let mut command = self.command();
        command.env("FAULT_AT", number.to_string());
        command.env("FAULT_RESULT", fault.number.to_string());
        if fault.lasts {
            command.env("FAULT_LASTS", "1");
        }
        let output = command.output().expect("it starts");
        (output, files(self.bench.folder()))
    }
}

/// Makes each call of a command that writes fail in each way. Each file is completely the old one or the new
/// one; nothing else is left; failures are reported with the file, the cause and what to do.
#[track_caller]
pub(crate) fn survives(bench: &Bench, range: Range, call: &[&str]) {
    let Some((_, shim)) = &*SHIM else {
        return;
    };
    let trial = Trial {
        bench,
        shim,
        call,
        before: files(bench.folder()),
    };
    let (usual, after, calls) = trial.undisturbed();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(
        matches!(usual.status.code(), Some(0 | 1)),
        "{call:?}: {}",
        text(&usual.stderr)
    );
    assert!(after != trial.before, "{call:?} writes nothing");
    assert!(calls.iter().any(|it| it.starts_with("write")), "{calls:?}");
    let mut wrong = Vec::new();
    for (at, which) in calls.iter().enumerate() {
        for &fault in range.faults() {
            if fault.number == 0 && !which.starts_with("write") {
                continue;
            }
            let (output, left) = trial.with(at + 1, fault);
            let said = text(&output.stderr);
            let mut complain = |what: &str| {
                wrong.push(format!("{which}, {fault:?}: {what}\n{said}"));
            };
            for (name, bytes) in &left {
                let is_whole = [&trial.before, &after]
                    .iter()
                    .any(|files| files.get(name) == Some(bytes));
                if !is_whole {
                    complain(&format!("`{name}` is neither old nor new"));
                }
            }
            if trial.before.keys().any(|name| !left.contains_key(name)) {
                complain("a file is gone");
            }
            match output.status.code() {
                status if status == usual.status.code() => {
                    if left != after || output.stdout != usual.stdout {
                        complain("it does not say that something failed");
                    }
                }
                Some(2) => {
                    let lower = one_line(&said);
                    let lower = lower.to_lowercase();
                    // A folder that cannot be made is named in place of the files in it.
                    let named = |it: &String| {
                        let folder = Path::new(it).parent().and_then(Path::to_str);
                        let folder = folder.filter(|folder| !folder.is_empty());
                        said.contains(it)
                            || folder.is_some_and(|folder| said.contains(&format!("`{folder}`")))
                    };
                    let is_named = left.keys().chain(after.keys()).any(named);
                    let is_named = is_named || said.contains("the output");
                    if !(said.contains("error: ") && is_named) {
                        complain("no file is named");
                    }
                    if !lower.contains(fault.cause) || fault.number == 0 {
                        complain("the cause is not said");
                    }
                    for (name, bytes) in &left {
                        let is_result = Path::new(name).extension() != Some(OsStr::new("lock"));
                        let is_new = trial.before.get(name) != Some(bytes);
                        if is_result && is_new && !said.contains(name.as_str()) {
                            complain(&format!("`{name}` is written, and is not named"));
                        }
                    }
                    if !said.contains("help: ") {
                        complain("nothing is advised");
                    }
                }
                _ => complain(&format!("{}", output.status)),
            }
        }
    }
    restore(bench.folder(), &trial.before);
    assert!(
        wrong.is_empty(),
        "{call:?}: {} of {} calls:\n{}",
        wrong.len(),
        calls.len(),
        wrong.join("\n")
    );
}
