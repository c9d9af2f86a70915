//! The HTML report of `run`: the story of the session, and its sources read once more.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::console::Console;
use super::failure::Failure;
use super::lines::LineReader;
use super::sheet::Sheet;
use crate::machine::AxisReport;
use crate::report::html::{Given, RunStory, Sources, render_run};
use crate::source::LineSource;
use crate::syntax::KindSet;

/// A report that is written when the session has ended.
pub(super) struct HtmlFile {
    sheet: Sheet,
    path: PathBuf,
    story: RunStory,
}

impl HtmlFile {
    /// A report in a file, which must not be one of the programs.
    pub(super) fn create(
        (path, kinds): (&Path, KindSet),
        programs: &[PathBuf],
        console: Console,
    ) -> Result<Self, Failure> {
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
            sheet: Sheet::create(Some(path), console)?,
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
        mut self,
        settings: &[(String, String)],
        parameters: &[AxisReport],
    ) -> Result<(), Failure> {
        let given = Given {
            settings,
            parameters,
        };
        render_run(&self.story, &given, &mut Files, &mut self.sheet)
            .and_then(|()| self.sheet.finish())
            .map_err(|error| Failure::writing(&self.path, &error))
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
