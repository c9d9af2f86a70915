//! The HTML report of `run`: the story of the session, and its sources read once more.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::lines::LineReader;
use super::replace;
use crate::machine::AxisReport;
use crate::report::html::{Given, RunStory, Sources, render_run};
use crate::source::LineSource;
use crate::syntax::KindSet;

/// A report that is written when the session has ended.
pub(super) struct HtmlFile {
    path: PathBuf,
    story: RunStory,
}

impl HtmlFile {
    /// A report in a file, which must not be one of the programs.
    pub(super) fn new(path: &Path, programs: &[PathBuf], kinds: KindSet) -> Result<Self, Failure> {
        replace::probe(path)?;
        let same = |program: &PathBuf| match (program.canonicalize(), path.canonicalize()) {
            (Ok(program), Ok(report)) => program == report,
            _ => false,
        };
        if programs.iter().any(same) {
            return Err(Failure::new(format!(
                "the report would overwrite the program `{}`",
                path.display()
            ))
            .with_help("name another file behind `--html`"));
        }
        Ok(Self {
            path: path.to_owned(),
            story: RunStory::new(kinds),
        })
    }

    /// Takes the records of the session.
    pub(super) fn story(&mut self) -> &mut RunStory {
        &mut self.story
    }

    /// Writes the report with what the user gave and the parameters in effect.
    pub(super) fn write(
        &self,
        settings: &[(String, String)],
        parameters: &[AxisReport],
    ) -> Result<(), Failure> {
        let given = Given {
            settings,
            parameters,
        };
        replace::replace_with(&self.path, |out| {
            render_run(&self.story, &given, &mut Files, out)
        })
    }
}

/// The programs on the disk. What can be read only once, a pipe, is not read again.
struct Files;

impl Sources for Files {
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>> {
        let path = Path::new(name);
        if !path.is_file() {
            return None;
        }
        let file = File::open(path).ok()?;
        Some(Box::new(LineReader::new(file)))
    }
}
