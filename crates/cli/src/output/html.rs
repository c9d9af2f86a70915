//! Results as HTML pages: a document, or for `run` the digest of the session, with its sources read once more.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::outputs::Outputs;
use frictcomp::comp::KindSet;
use frictcomp::text::LineSource;
use frictcomp_host::{LoadedMachine, OutputFile, reopen};
use frictcomp_report::Document;
use frictcomp_report::html::{
    GivenForRun, RunDigest, RunInputs, Sources, render_document, render_run,
};

/// The page of a result.
#[derive(Debug, Clone, Args)]
pub(crate) struct HtmlArgs {
    /// Write the result with its pictures as an HTML page to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
}

impl HtmlArgs {
    /// Returns whether a page is asked for.
    pub(crate) fn is_given(&self) -> bool {
        self.html.is_some()
    }

    /// Returns the file of the page, if there is one.
    pub(crate) fn page(&self, outputs: &mut Outputs) -> Result<Option<OutputFile>, Failure> {
        outputs.optional("--html", self.html.as_deref())
    }
}

/// Writes a document as a page, if a file is given.
pub(crate) fn write_page(file: Option<OutputFile>, document: &Document<'_>) -> Result<(), Failure> {
    let written = file.map(|mut file| render_document(document, &mut file));
    written.unwrap_or(Ok(())).map_err(Failure::output)
}

/// A report that is written at the end of the session.
pub(crate) struct HtmlFile {
    file: OutputFile,
    digest: RunDigest,
}

impl HtmlFile {
    /// Creates a report on these kinds in a file.
    pub(crate) fn new(file: OutputFile, kinds: KindSet) -> Self {
        Self {
            file,
            digest: RunDigest::new(kinds),
        }
    }

    /// Returns the digest that takes the records of the session.
    pub(crate) fn digest(&mut self) -> &mut RunDigest {
        &mut self.digest
    }

    /// Writes the report with the user's options and the parameters in effect.
    pub(crate) fn write(
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
pub(crate) struct Files;

impl Sources for Files {
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>> {
        reopen(name)
    }
}
