//! The HTML report of `run`: the digest of the session, and its sources read once more.

use super::failure::Failure;
use frictcomp::comp::KindSet;
use frictcomp::text::LineSource;
use frictcomp_host::{LoadedMachine, OutputFile, reopen};
use frictcomp_report::html::{GivenForRun, RunDigest, RunInputs, Sources, render_run};

/// A report that is written at the end of the session.
pub(super) struct HtmlFile {
    file: OutputFile,
    digest: RunDigest,
}

impl HtmlFile {
    /// Creates a report on these kinds in a file.
    pub(super) fn new(file: OutputFile, kinds: KindSet) -> Self {
        Self {
            file,
            digest: RunDigest::new(kinds),
        }
    }

    /// Returns the digest that takes the records of the session.
    pub(super) fn digest(&mut self) -> &mut RunDigest {
        &mut self.digest
    }

    /// Writes the report with the user's options and the parameters in effect.
    pub(super) fn write(
        mut self,
        given: GivenForRun<'_>,
        loaded: &LoadedMachine,
    ) -> Result<(), Failure> {
        let inputs = RunInputs {
            given,
            parameters: &loaded.reports,
            programs: &loaded.programs,
        };
        render_run(&self.digest, &inputs, &mut Files, &mut self.file).map_err(Failure::output)
    }
}

/// The programs on the disk. Programs that can be read only once, from a pipe, are not read again.
pub(super) struct Files;

impl Sources for Files {
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>> {
        reopen(name)
    }
}
