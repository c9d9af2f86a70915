//! The differences between the files of a folder and a revision of its git repository, from the
//! command `git` (R17.4).

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;

use crate::disk::{MOST_KEPT, decode, too_big};
use crate::error::HostError;

/// The start of a revision's content for a file that Git LFS stores elsewhere.
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// A revision of the git repository in which a folder lies.
#[derive(Debug, Clone)]
pub struct Revision {
    /// The top folder of the work tree.
    top: PathBuf,
    /// The hash of the commit, or of the empty tree.
    commit: String,
}

/// A file that differs between a revision and the work tree.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ChangedFile {
    /// The file in the work tree, from the root on; `None` where it was deleted.
    pub new: Option<PathBuf>,
    /// The file in the revision; `None` where it is new.
    pub old: Option<OldFile>,
}

/// A file of a revision.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OldFile {
    /// Path in the work tree, from the root on.
    pub path: PathBuf,
    /// The hash of its content.
    blob: String,
}

impl ChangedFile {
    /// Creates the change of a file that was saved, or that does not exist any more.
    pub fn saved(path: PathBuf) -> Self {
        if path.exists() {
            return Self {
                new: Some(path),
                old: None,
            };
        }
        let blob = String::new();
        Self {
            new: None,
            old: Some(OldFile { path, blob }),
        }
    }
}

impl Revision {
    /// Looks up a revision by its name, in the repository of a folder. Before the first commit `HEAD` has no files.
    ///
    /// # Errors
    /// The command `git` is missing, the folder is not in a repository, or there is no such revision.
    pub fn new(folder: &Path, name: &str) -> Result<Self, HostError> {
        let top = git(folder, &["rev-parse", "--show-toplevel"])?;
        if !top.status.success() {
            let is_current = folder.as_os_str().is_empty();
            let folder = if is_current { Path::new(".") } else { folder };
            return Err(HostError::NoRepository {
                folder: folder.to_owned(),
                reason: said(&top),
            });
        }
        let commit = format!("{name}^{{commit}}");
        let verify = ["rev-parse", "--verify", "--quiet", "--end-of-options"];
        let mut found = git(folder, &[&verify[..], &[&commit]].concat())?;
        if !found.status.success() {
            let is_unborn = name == "HEAD"
                && git(folder, &["symbolic-ref", "--quiet", "HEAD"])?
                    .status
                    .success();
            if !is_unborn {
                return Err(HostError::NoRevision(name.to_owned()));
            }
            // Empty standard input gives the tree without files.
            found = git(folder, &["hash-object", "-t", "tree", "--stdin"])?;
        }
        Ok(Self {
            top: PathBuf::from(os(line(&top.stdout))),
            commit: String::from_utf8_lossy(line(&found.stdout)).into_owned(),
        })
    }

    /// Returns the files that differ from those of the work tree, untracked ones included; links and
    /// submodules are left out.
    ///
    /// # Errors
    /// The command `git` fails.
    pub fn changes(&self) -> Result<Vec<ChangedFile>, HostError> {
        let diff = [
            "diff",
            "--raw",
            "-z",
            "-M",
            "--no-abbrev",
            "--no-ext-diff",
            "--no-relative",
            "--ignore-submodules=all",
            &self.commit,
            "--",
        ];
        let listed = self.git(&diff)?;
        let mut changes = self.parsed(&listed);
        let untracked = ["ls-files", "--others", "--exclude-standard", "-z"];
        for path in self.git(&untracked)?.split(|byte| *byte == 0) {
            if !path.is_empty() {
                changes.push(ChangedFile {
                    new: Some(self.top.join(os(path))),
                    old: None,
                });
            }
        }
        Ok(changes)
    }

    /// Returns the files of the work tree that git tracks.
    ///
    /// # Errors
    /// The command `git` fails.
    pub fn files(&self) -> Result<BTreeSet<PathBuf>, HostError> {
        let listed = self.git(&["ls-files", "-z"])?;
        let paths = listed.split(|byte| *byte == 0);
        let paths = paths.filter(|path| !path.is_empty());
        Ok(paths.map(|path| self.top.join(os(path))).collect())
    }

    /// Parses the rows of `git diff --raw -z`.
    fn parsed(&self, listed: &[u8]) -> Vec<ChangedFile> {
        let mut fields = listed.split(|byte| *byte == 0);
        let mut changes = Vec::new();
        while let Some(row) = fields.next().and_then(|row| row.strip_prefix(b":")) {
            let row = String::from_utf8_lossy(row);
            let parts: Vec<&str> = row.split(' ').collect();
            let [old_mode, new_mode, blob, _, status] = parts[..] else {
                break;
            };
            let Some(first) = fields.next() else { break };
            let is_renamed = status.starts_with(['R', 'C']);
            let second = if is_renamed { fields.next() } else { None };
            let path = |path: &[u8]| self.top.join(os(path));
            let is_file = |mode: &str| mode.starts_with("100");
            let old = is_file(old_mode).then(|| OldFile {
                path: path(first),
                blob: blob.to_owned(),
            });
            let new = is_file(new_mode).then(|| path(second.unwrap_or(first)));
            // A copy does not change its source file.
            let old = old.filter(|_| !status.starts_with('C'));
            if old.is_some() || new.is_some() {
                changes.push(ChangedFile { new, old });
            }
        }
        changes
    }

    /// Returns the texts that files have in the revision, by their paths.
    ///
    /// # Errors
    /// The command `git` fails, or a file is too big to be kept.
    pub fn texts<'a>(
        &self,
        files: impl Iterator<Item = &'a OldFile>,
    ) -> Result<BTreeMap<PathBuf, String>, HostError> {
        let files: Vec<&OldFile> = files.collect();
        let mut texts = BTreeMap::new();
        if files.is_empty() {
            return Ok(texts);
        }
        let mut child = self
            .command(&["cat-file", "--batch"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| no_git(&error))?;
        let read = self.read_all(&mut child, &files, &mut texts);
        // Its pipes are closed, and its output has been read.
        let _ = child.wait();
        read?;
        Ok(texts)
    }

    fn read_all(
        &self,
        child: &mut Child,
        files: &[&OldFile],
        texts: &mut BTreeMap<PathBuf, String>,
    ) -> Result<(), HostError> {
        let (Some(mut names), Some(contents)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(HostError::Git("the connection to git failed".to_owned()));
        };
        thread::scope(|scope| {
            // Closed where the reading ends early, so that git ends, too.
            let mut contents = BufReader::new(contents);
            // Both pipes may be full: names are written while contents are read.
            scope.spawn(move || {
                for file in files {
                    if writeln!(names, "{}", file.blob).is_err() {
                        break;
                    }
                }
            });
            for file in files {
                let bytes = next_content(&mut contents)
                    .map_err(|error| HostError::read(&file.path, error))?;
                let bytes = if bytes.starts_with(LFS_POINTER) {
                    self.smudged(file)?
                } else {
                    bytes
                };
                texts.insert(file.path.clone(), decode(bytes));
            }
            Ok(())
        })
    }

    /// Returns a file as the filters of the repository produce it.
    fn smudged(&self, file: &OldFile) -> Result<Vec<u8>, HostError> {
        let path = file.path.strip_prefix(&self.top).unwrap_or(&file.path);
        let mut option = std::ffi::OsString::from("--path=");
        option.push(path);
        let mut command = self.command(&["cat-file", "--filters"]);
        let output = command.arg(option).arg(&file.blob).output();
        succeeded(output.map_err(|error| no_git(&error))?)
    }

    fn git(&self, arguments: &[&str]) -> Result<Vec<u8>, HostError> {
        succeeded(
            self.command(arguments)
                .output()
                .map_err(|error| no_git(&error))?,
        )
    }

    fn command(&self, arguments: &[&str]) -> Command {
        command(&self.top, arguments)
    }
}

/// Reads the next content from `git cat-file --batch`.
fn next_content(contents: &mut impl BufRead) -> io::Result<Vec<u8>> {
    let mut header = String::new();
    contents.read_line(&mut header)?;
    let size = header.split_whitespace().nth(2);
    let size = size.and_then(|size| size.parse::<usize>().ok());
    let missing = || io::Error::new(io::ErrorKind::NotFound, "git does not have its content");
    let size = size.ok_or_else(missing)?;
    if size > MOST_KEPT {
        return Err(too_big());
    }
    let mut bytes = vec![0; size];
    contents.read_exact(&mut bytes)?;
    // The line end after it.
    contents.read_exact(&mut [0])?;
    Ok(bytes)
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new("git");
    if !folder.as_os_str().is_empty() {
        command.current_dir(folder);
    }
    // git only reads, and answers in English.
    command.env("GIT_OPTIONAL_LOCKS", "0").env("LC_ALL", "C");
    command.args(arguments).stdin(Stdio::null());
    command
}

fn git(folder: &Path, arguments: &[&str]) -> Result<Output, HostError> {
    command(folder, arguments)
        .output()
        .map_err(|error| no_git(&error))
}

fn succeeded(output: Output) -> Result<Vec<u8>, HostError> {
    if output.status.success() {
        Ok(output.stdout)
    } else {
        Err(HostError::Git(said(&output)))
    }
}

fn no_git(error: &io::Error) -> HostError {
    match error.kind() {
        io::ErrorKind::NotFound => HostError::NoGit,
        _ => HostError::Git(error.to_string()),
    }
}

/// Returns the first line of git's stderr, without its `fatal: `.
fn said(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    let line = text.lines().next().unwrap_or("git failed");
    line.strip_prefix("fatal: ").unwrap_or(line).to_owned()
}

/// Returns the only line of an output.
fn line(output: &[u8]) -> &[u8] {
    let line = output.strip_suffix(b"\n").unwrap_or(output);
    line.strip_suffix(b"\r").unwrap_or(line)
}

#[cfg(unix)]
fn os(bytes: &[u8]) -> &OsStr {
    std::os::unix::ffi::OsStrExt::from_bytes(bytes)
}

/// Reads bytes as UTF-8, which git uses on other systems.
#[cfg(not(unix))]
fn os(bytes: &[u8]) -> &OsStr {
    OsStr::new(std::str::from_utf8(bytes).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_git_are_understood() {
        // R17.4
        let revision = Revision {
            top: PathBuf::from("/w"),
            commit: String::new(),
        };
        let listed = b":100644 100644 a1 0 M\0a b.nc\0:100644 100755 a2 0 R090\0old.nc\0n\xc3\xbc.nc\0\
            :000000 100644 0 0 A\0new.nc\0:100644 000000 a3 0 D\0gone.nc\0\
            :120000 120000 a4 0 M\0link\0:160000 160000 a5 0 M\0module\0:100644 000000 a6 0 U\0torn.nc\0";
        let shown: Vec<String> = revision
            .parsed(listed)
            .iter()
            .map(|it| {
                let name = |path: &PathBuf| path.display().to_string().replace('\\', "/");
                let old = it
                    .old
                    .as_ref()
                    .map_or("-".into(), |it| name(&it.path) + "@" + &it.blob);
                format!("{old} {}", it.new.as_ref().map_or("-".into(), name))
            })
            .collect();
        assert_eq!(
            shown,
            [
                "/w/a b.nc@a1 /w/a b.nc",
                "/w/old.nc@a2 /w/n\u{fc}.nc",
                "- /w/new.nc",
                "/w/gone.nc@a3 -",
                "/w/torn.nc@a6 -",
            ]
        );
        assert!(revision.parsed(b"nonsense").is_empty());
    }

    #[test]
    fn contents_are_taken_one_by_one() {
        // R17.4
        let mut contents: &[u8] = b"a1 blob 3\nX1\n\na2 missing\n";
        assert_eq!(next_content(&mut contents).unwrap(), b"X1\n");
        assert!(next_content(&mut contents).is_err());
    }
}
