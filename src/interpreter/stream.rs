//! Programs whose lines come one after another and are forgotten.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::{At, EndedBy, Finder, Interpreter, Observer, Outlook, StopPolicy};
use crate::source::LineSource;
use crate::syntax::{BlockReader, Stretch};

impl Interpreter {
    /// Runs a main program whose lines come one after another and are forgotten. Such a program
    /// has no flow; [`crate::source::FlowScan`] tells which has.
    pub fn stream(
        &mut self,
        file: &str,
        lines: &mut dyn LineSource,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Outlook {
        self.start();
        let file: Arc<str> = file.into();
        let mut reader = BlockReader::new(lines, 1, self.options.fast_path);
        let mut block = std::mem::take(&mut self.work.block);
        let mut announced = false;
        let mut beyond = false;
        let mut by = None;
        let mut notes = Vec::new();
        while let Some(raw) = reader.next(&mut block) {
            if let Stretch::Program { name, .. } = raw.stretch {
                if announced {
                    // Another program of the file: never executed, as where the text is whole.
                    if self.options.stop != StopPolicy::CheckAll {
                        break;
                    }
                    beyond = true;
                    continue;
                }
                announced = true;
                if self.announce(Some(name.of(raw.text)), observer).is_break() {
                    return Outlook::Paused;
                }
                continue;
            }
            if beyond || by.is_some() {
                Self::check_unexecuted(&file, (raw.line, raw.text), &block, &mut notes);
                continue;
            }
            if !announced {
                announced = true;
                if self.announce(None, observer).is_break() {
                    return Outlook::Paused;
                }
                if let Err(missing) = self.start_program(finder) {
                    return self.ended(EndedBy::Error, &[*missing], observer);
                }
                if let Some(outlook) = self.run_called(finder, observer) {
                    return outlook;
                }
            }
            let at = At {
                file: &file,
                text: raw.text,
                line: raw.line,
                remark: raw.remark,
                level: 0,
                called_from: None,
                macro_depth: 0,
            };
            if let Some(over) = self.over_budget(&at) {
                return self.ended(EndedBy::Budget, &[over], observer);
            }
            if self.is_skipped(&block) {
                continue;
            }
            let step = match self.execute(&block, &at, finder, observer) {
                ControlFlow::Continue(step) => step,
                ControlFlow::Break(()) => return Outlook::Paused,
            };
            match self.follow(step) {
                ControlFlow::Continue(()) => match self.run_called(finder, observer) {
                    None => {}
                    Some(outlook) => return outlook,
                },
                ControlFlow::Break(ended) => {
                    by = Some(ended);
                    if self.options.stop != StopPolicy::CheckAll {
                        break;
                    }
                }
            }
        }
        self.work.block = block;
        if !announced && self.announce(None, observer).is_break() {
            return Outlook::Paused;
        }
        let by = by.unwrap_or_else(|| {
            notes.splice(0..0, self.missing_end());
            EndedBy::EndOfFile
        });
        self.ended(by, &notes, observer)
    }

    /// Runs called programs until the one that called them goes on; `None` when it does.
    fn run_called(
        &mut self,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Option<Outlook> {
        if self.state.frames.is_empty() {
            return None;
        }
        match self.run(finder, observer) {
            Outlook::Ended(EndedBy::EndOfFile) => None,
            Outlook::Ended(by) => {
                let notes: Vec<_> = self.work.over.take().into_iter().collect();
                Some(self.ended(by, &notes, observer))
            }
            Outlook::Paused => Some(Outlook::Paused),
        }
    }
}
