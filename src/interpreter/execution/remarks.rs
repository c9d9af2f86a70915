//! Lines that no run reaches: `%` lines, and comments for this tool that no block follows (R9.24).

use std::sync::Arc;

use crate::diagnostic::{Code, Collected};
use crate::interpreter::programs::unit::SourceUnit;
use crate::interpreter::run::event::EndedBy;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::StopPolicy;
use crate::syntax::{LineFault, LostRemarks, Remark, allow};
use crate::text::Place;

impl Interpreter {
    /// Returns the messages on the `%` lines of the main file, and on comments for this tool in all
    /// files, or up to where each was reached where the rest is not checked.
    pub(crate) fn beside_blocks(&mut self, by: EndedBy) -> Collected {
        let mut said = std::mem::take(&mut self.lost);
        for (number, unit) in self.here.programs.units().iter().enumerate() {
            let until = self.here.reached_line(number, unit, by);
            let openings = &unit.index.openings;
            match (number, until) {
                (0, u32::MAX) => said.append(openings),
                (0, _) => {
                    let reached = openings.said.iter();
                    said.extend(reached.filter(|it| it.place.first_line <= until).cloned());
                }
                _ => said.extend(unit.index.no_block()),
            }
            gather(unit.index.source.name(), &unit.index.lost, until, &mut said);
        }
        said
    }

    /// Keeps the messages about lines that are not kept.
    pub(crate) fn note_lost(&mut self, file: &Arc<str>, lost: &LostRemarks) {
        gather(file, lost, u32::MAX, &mut self.lost);
    }
}

impl Executor {
    /// The last line of a file that was reached, or more than all lines where the rest is checked, too.
    fn reached_line(&self, number: usize, unit: &SourceUnit, by: EndedBy) -> u32 {
        if self.options.stop == StopPolicy::CheckAll {
            return u32::MAX;
        }
        let has_fallen_through = self.state.last.is_some() || unit.high == 0;
        if number == 0 && by == EndedBy::EndOfFile && has_fallen_through {
            return unit.index.end_of_main();
        }
        let last = unit.high.checked_sub(1);
        let last = last.and_then(|last| unit.index.entries.get(last as usize));
        last.map_or(0, |last| last.line)
    }
}

/// FC490 or FC491 for each comment, and the faults of lines outside blocks, down to a line.
fn gather(file: &Arc<str>, lost: &LostRemarks, until: u32, said: &mut Collected) {
    let lines = lost.remarks.iter().flat_map(Remark::lines);
    for (text, line) in lines.take_while(|(_, line)| *line <= until) {
        let Some(fault) = allow::lost(text) else {
            continue;
        };
        let place = Place {
            file: file.clone(),
            text: text.into(),
            first_line: line,
            span: fault.span,
        };
        said.push(fault.into_diagnostic(place, |_| None));
    }
    for LineFault { text, line, fault } in lost.faults.iter().filter(|it| it.line <= until) {
        let place = Place {
            file: file.clone(),
            text: text.as_str().into(),
            first_line: *line,
            span: fault.span,
        };
        said.push(fault.clone().into_diagnostic(place, |_| None));
    }
    if until == u32::MAX {
        for (code, more) in &lost.more_faults {
            *said.unsaid.entry(*code).or_default() += more;
        }
    }
    if lost.more > 0 && until == u32::MAX {
        *said.unsaid.entry(Code::Fc490).or_default() += lost.more;
    }
}
