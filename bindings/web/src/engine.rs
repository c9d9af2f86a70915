//! The engine: the dropped files and the run that is shown.

use std::path::Path;

use frictcomp::diagnostic::Code;

use crate::dropped::Dropped;
use crate::questions::PageQuestion;
use crate::refusal::Refusal;
use crate::run::{ShownRun, json};
use crate::{audits, circle, contour, current, parameters, recording, run, tuning};

/// The dropped files and the run that is shown.
#[derive(Debug, Default)]
pub(crate) struct Engine {
    dropped: Dropped,
    shown: Option<ShownRun>,
}

impl Engine {
    /// Accepts a file.
    pub(crate) fn put(&mut self, path: &str, content: Vec<u8>, named: bool) {
        self.dropped.put(path, content, named);
    }

    /// Answers a question.
    pub(crate) fn ask(&mut self, question: &[u8]) -> Result<Vec<u8>, Refusal> {
        let question: PageQuestion = serde_json::from_slice(question)
            .map_err(|error| Refusal::new(format!("the question is not understood: {error}")))?;
        let dropped = &mut self.dropped;
        Ok(match question {
            PageQuestion::Clear => {
                dropped.clear();
                self.shown = None;
                Vec::new()
            }
            PageQuestion::Files => json(&dropped.files()),
            PageQuestion::Text { path } => {
                let disk = dropped.disk();
                let text = disk.text(Path::new(&path));
                let text =
                    text.ok_or_else(|| Refusal::new(format!("there is no file `{path}`")))?;
                text.as_bytes().to_vec()
            }
            PageQuestion::Run { program, settings } => {
                // Releases the memory of the last run for the next one.
                self.shown = None;
                let (shown, overview) = run::run(dropped, &program, &settings)?;
                self.shown = Some(shown);
                overview
            }
            PageQuestion::Items { view, from, count } => self.shown()?.items(view, from, count),
            PageQuestion::Place { view, block } => json(&self.shown()?.place(view, block)),
            PageQuestion::Notable { block, forward } => {
                json(&self.shown()?.notable(block, forward))
            }
            PageQuestion::BlockOfLine { line } => json(&self.shown()?.block_of_line(line)),
            PageQuestion::Records { program, settings } => {
                run::records(dropped, &program, &settings)?
            }
            PageQuestion::Report { program, settings } => {
                run::report(dropped, &program, &settings)?
            }
            PageQuestion::Audit { enable } => audits::answer(dropped, &enable),
            PageQuestion::AuditReport { enable } => audits::report(dropped, &enable)?,
            PageQuestion::Current {
                program,
                start,
                settings,
            } => current::answer(dropped, &program, start, &settings)?,
            PageQuestion::Contour(settings) => contour::answer(dropped, &settings)?,
            PageQuestion::ContourReport(settings) => contour::report(dropped, &settings)?,
            PageQuestion::Tune(settings) => tuning::answer(&settings)?,
            PageQuestion::Parameters { program, enable } => {
                parameters::answer(dropped, &program, &enable)?
            }
            PageQuestion::Recording(settings) => recording::answer(dropped, &settings)?,
            PageQuestion::Verify(settings) => recording::verify(dropped, &settings)?,
            PageQuestion::Explain { code } => {
                let code: Result<Code, _> = code.parse();
                let code = code.map_err(|_| Refusal::new("there is no page about this code"))?;
                code.page().into()
            }
            PageQuestion::Circle(settings) => circle::answer(dropped, &settings)?,
            PageQuestion::CircleReport(settings) => circle::report(dropped, &settings)?,
        })
    }

    fn shown(&mut self) -> Result<&mut ShownRun, Refusal> {
        self.shown
            .as_mut()
            .ok_or_else(|| Refusal::new("no program is shown"))
    }
}
