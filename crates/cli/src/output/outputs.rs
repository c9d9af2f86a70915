//! The outputs of a command: results to standard output or to files, which are put in place at the
//! end (R9.70).

use std::io::Write;
use std::path::Path;

use super::console::{Console, DataTarget};
use super::failure::Failure;
use frictcomp::session::SavedState;
use frictcomp::text::shown_path;
use frictcomp_host::{FileRegistry, OutputFile, OutputFiles, Replaces, StateFile};
use frictcomp_report::Document;

/// The name for standard output.
const STDOUT: &str = "-";

/// The results of a command. If dropped before [`finish`](Self::finish), no file is written.
pub(crate) struct Outputs {
    files: OutputFiles,
    console: Console,
    /// The option or result that goes to standard output.
    printing: Option<&'static str>,
}

impl Outputs {
    /// Creates an empty set of outputs.
    pub(crate) fn new(registry: &FileRegistry, console: Console) -> Self {
        Self {
            files: OutputFiles::new(registry).forced(console.forced),
            console,
            printing: None,
        }
    }

    /// Returns the files among them.
    pub(crate) fn files(&mut self) -> &mut OutputFiles {
        &mut self.files
    }

    /// Returns the destination of the main result: the file after `--output`, or standard output.
    pub(crate) fn result(&mut self, path: Option<&Path>) -> Result<DataTarget, Failure> {
        match path {
            None => {
                self.print("the result")?;
                Ok(self.console.stdout())
            }
            Some(path) if is_stdout(path) => {
                self.print("--output -")?;
                Ok(self.console.stdout())
            }
            Some(path) => Ok(DataTarget {
                writer: Box::new(self.create("--output", path, Replaces::Results)?),
                look: self.console.file_look(),
            }),
        }
    }

    /// Returns the file that an option names; `-` is standard output.
    pub(crate) fn file(
        &mut self,
        option: &'static str,
        path: &Path,
    ) -> Result<OutputFile, Failure> {
        self.place(option, path, Replaces::Results)
    }

    /// Returns the file of a value list.
    pub(crate) fn list(
        &mut self,
        option: &'static str,
        path: &Path,
    ) -> Result<OutputFile, Failure> {
        self.place(option, path, Replaces::Lists)
    }

    /// Returns the file of a value list, and creates its folder if it is missing.
    pub(crate) fn list_in_folder(
        &mut self,
        option: &'static str,
        path: &Path,
    ) -> Result<OutputFile, Failure> {
        Ok(self.files.create_in_folder(option, path, Replaces::Lists)?)
    }

    fn place(
        &mut self,
        option: &'static str,
        path: &Path,
        replaces: Replaces,
    ) -> Result<OutputFile, Failure> {
        if !is_stdout(path) {
            return self.create(option, path, replaces);
        }
        self.print(option)?;
        Ok(OutputFile::open(path, self.console.stdout().writer))
    }

    fn create(
        &mut self,
        option: &'static str,
        path: &Path,
        replaces: Replaces,
    ) -> Result<OutputFile, Failure> {
        Ok(self.files.create(option, path, replaces)?)
    }

    /// Returns the file that an option names, if the option is given.
    pub(crate) fn optional(
        &mut self,
        option: &'static str,
        path: Option<&Path>,
    ) -> Result<Option<OutputFile>, Failure> {
        path.map(|path| self.file(option, path)).transpose()
    }

    /// Notes a file that will be written, before its content is known.
    pub(crate) fn claim(&mut self, option: &'static str, path: &Path) {
        self.files.claim(option, path, Replaces::Results);
    }

    /// Notes the files that hold the state and its lock.
    pub(crate) fn claim_state(&mut self, path: &Path) {
        self.claim("--state", path);
        self.claim("the lock of --state", &StateFile::lock_path(path));
    }

    /// Saves the state when the other files are put in place.
    pub(crate) fn save(&mut self, file: &StateFile, state: &SavedState) -> Result<(), Failure> {
        Ok(file.save(state, &mut self.files)?)
    }

    /// Notes which output goes to standard output; only one may.
    pub(crate) fn print(&mut self, who: &'static str) -> Result<(), Failure> {
        if let Some(other) = self.printing.replace(who) {
            return Err(Failure::new(format!(
                "{other} and `{who}` would both go to standard output"
            ))
            .with_help("name a file for one of them"));
        }
        Ok(())
    }

    /// Reports which output would destroy an input, once the inputs are known and before anything runs.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        Ok(self.files.check()?)
    }

    /// Puts every file in place without naming them, since there are too many.
    pub(crate) fn finish_quietly(self) -> Result<(), Failure> {
        Ok(self.files.finish(|_| ())?)
    }

    /// Puts every file in place and names it on stderr.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let console = self.console;
        let placed = |path: &Path| console.remark(&format!("wrote `{}`", shown_path(path)));
        Ok(self.files.finish(placed)?)
    }
}

/// Draws the picture of a document, if a file is given.
pub(crate) fn write_picture(
    file: Option<OutputFile>,
    document: &Document<'_>,
) -> Result<(), Failure> {
    match (file, document.picture()) {
        (Some(mut file), Some(picture)) => write_text(&mut file, &picture),
        _ => Ok(()),
    }
}

/// Writes a text to a file.
pub(crate) fn write_text(file: &mut OutputFile, text: &str) -> Result<(), Failure> {
    let written = file.write_all(text.as_bytes());
    written.map_err(Failure::output)
}

fn is_stdout(path: &Path) -> bool {
    path == Path::new(STDOUT) || (cfg!(unix) && path == Path::new("/dev/stdout"))
}
