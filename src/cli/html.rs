//! The HTML report of `run`: the story of the session, and its sources read once more.

use std::fs::File;
use std::path::Path;

use super::failure::Failure;
use super::lines::LineReader;
use super::outputs::OutputFile;
use crate::machine::AxisReport;
use crate::report::html::{Given, RunStory, Sources, render_run};
use crate::source::LineSource;
use crate::syntax::KindSet;

/// A report that is written when the session has ended.
pub(super) struct HtmlFile {
    file: OutputFile,
    story: RunStory,
}

impl HtmlFile {
    /// A report on these kinds in a file.
    pub(super) fn new(file: OutputFile, kinds: KindSet) -> Self {
        Self {
            file,
            story: RunStory::new(kinds),
        }
    }

    /// Takes the records of the session.
    pub(super) fn story(&mut self) -> &mut RunStory {
        &mut self.story
    }

    /// Writes the report with what the user gave and the parameters in effect.
    pub(super) fn write(
        mut self,
        settings: &[(String, String)],
        parameters: &[AxisReport],
    ) -> Result<(), Failure> {
        let given = Given {
            settings,
            parameters,
        };
        render_run(&self.story, &given, &mut Files, &mut self.file)
            .map_err(|error| Failure::output(&error))
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
