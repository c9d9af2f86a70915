//! The tail of a command whose result is a document.

use std::path::Path;

use clap::ValueEnum;

use super::console::{Console, DataTarget};
use super::failure::Failure;
use super::html::{HtmlArgs, write_page};
use super::outputs::{Outputs, write_picture};
use super::result::{ResultArgs, ResultFormat};
use frictcomp_host::{FileRegistry, OutputFile};
use frictcomp_report::Document;

/// The result of a command, with its page and its picture where they are wanted. If dropped before it is finished,
/// no file is written.
pub(crate) struct Job<F = ResultFormat> {
    pub(crate) outputs: Outputs,
    target: DataTarget,
    format: F,
    page: Option<OutputFile>,
    picture: Option<OutputFile>,
    console: Console,
}

impl<F: ValueEnum + Clone + Copy + Default + Send + Sync + 'static> Job<F> {
    /// Begins a result where the options say.
    pub(crate) fn new(
        result: &ResultArgs<F>,
        registry: &FileRegistry,
        console: Console,
    ) -> Result<Self, Failure> {
        let mut outputs = Outputs::new(registry, console);
        Ok(Self {
            target: outputs.result(result.output.as_deref())?,
            outputs,
            format: result.format,
            page: None,
            picture: None,
            console,
        })
    }

    /// Adds the page, if it is wanted.
    pub(crate) fn with_page(mut self, html: &HtmlArgs) -> Result<Self, Failure> {
        self.page = html.page(&mut self.outputs)?;
        Ok(self)
    }

    /// Adds the picture of the option `--svg`, if it is given.
    pub(crate) fn with_picture(mut self, svg: Option<&Path>) -> Result<Self, Failure> {
        self.picture = self.outputs.optional("--svg", svg)?;
        Ok(self)
    }

    /// Writes the documents in the format of the result: as text, unless `other` has another one. Only a sole document
    /// has a page and a picture.
    pub(crate) fn finish_with(
        mut self,
        documents: &[Document<'_>],
        other: impl FnOnce(F) -> Option<String>,
    ) -> Result<(), Failure> {
        if let [document] = documents {
            write_picture(self.picture, document)?;
            write_page(self.page, document)?;
        }
        self.outputs.check()?;
        let (detail, width) = (self.console.detail, self.target.look.width);
        let text = other(self.format).unwrap_or_else(|| {
            let texts = documents.iter().map(|it| it.text(detail, width));
            texts.collect::<Vec<_>>().join("\n")
        });
        self.target.text(&text)?;
        self.outputs.finish()
    }
}

impl Job {
    /// Writes a document as text or as JSON.
    pub(crate) fn finish(
        self,
        document: &Document<'_>,
        json: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        self.finish_all(std::slice::from_ref(document), json)
    }

    /// Writes the documents of the axes of a recording as text or as JSON.
    pub(crate) fn finish_all(
        self,
        documents: &[Document<'_>],
        json: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        self.finish_with(documents, |format| match format {
            ResultFormat::Text => None,
            ResultFormat::Json => Some(json()),
        })
    }
}
