//! The engine: the dropped files and the run that is shown.

use std::path::Path;

use frictcomp::diagnostic::Code;

use crate::dropped::Dropped;
use crate::questions::Question;
use crate::refusal::Refusal;
use crate::run::{Shown, json};
use crate::{audits, circle, contour, current, parameters, run, tuning};

/// The dropped files and the run that is shown.
#[derive(Debug, Default)]
pub(crate) struct Engine {
    dropped: Dropped,
    shown: Option<Shown>,
}

impl Engine {
    /// Takes a file.
    pub(crate) fn put(&mut self, path: &str, content: Vec<u8>, named: bool) {
        self.dropped.put(path, content, named);
    }

    /// Answers a question.
    pub(crate) fn ask(&mut self, question: &[u8]) -> Result<Vec<u8>, Refusal> {
        let question: Question = serde_json::from_slice(question)
            .map_err(|error| Refusal::new(format!("the question is not understood: {error}")))?;
        let dropped = &mut self.dropped;
        Ok(match question {
            Question::Clear => {
                dropped.clear();
                self.shown = None;
                Vec::new()
            }
            Question::Files => json(&dropped.files()),
            Question::Text { path } => {
                let disk = dropped.disk();
                let text = disk.text(Path::new(&path));
                let text =
                    text.ok_or_else(|| Refusal::new(format!("there is no file `{path}`")))?;
                text.as_bytes().to_vec()
            }
            Question::Run { program, settings } => {
                // The memory of the last run is there for the next one.
                self.shown = None;
                let (shown, overview) = run::run(dropped, &program, &settings)?;
                self.shown = Some(shown);
                overview
            }
            Question::Items { view, from, count } => self.shown()?.items(view, from, count),
            Question::Place { view, block } => json(&self.shown()?.place(view, block)),
            Question::Notable { block, forward } => json(&self.shown()?.notable(block, forward)),
            Question::BlockOfLine { line } => json(&self.shown()?.block_of_line(line)),
            Question::Records { program, settings } => run::records(dropped, &program, &settings)?,
            Question::Report { program, settings } => run::report(dropped, &program, &settings)?,
            Question::Audit { enable } => audits::answer(dropped, &enable),
            Question::AuditReport { enable } => audits::report(dropped, &enable)?,
            Question::Current {
                program,
                start,
                settings,
            } => current::answer(dropped, &program, start, &settings)?,
            Question::Contour(settings) => contour::answer(dropped, &settings)?,
            Question::ContourReport(settings) => contour::report(dropped, &settings)?,
            Question::Tune(settings) => tuning::answer(&settings)?,
            Question::Parameters { program, enable } => {
                parameters::answer(dropped, &program, &enable)?
            }
            Question::Explain { code } => {
                let code: Result<Code, _> = code.parse();
                let code = code.map_err(|_| Refusal::new("there is no page about this code"))?;
                code.page().into()
            }
            Question::Circle(settings) => circle::answer(dropped, &settings)?,
            Question::CircleReport(settings) => circle::report(dropped, &settings)?,
        })
    }

    fn shown(&mut self) -> Result<&mut Shown, Refusal> {
        self.shown
            .as_mut()
            .ok_or_else(|| Refusal::new("no program is shown"))
    }
}
