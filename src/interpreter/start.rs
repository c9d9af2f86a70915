//! The beginning and the end of a program.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::cycles::ModalCycles;
use super::event::{Ended, EndedBy, Event, Observer};
use super::exchange::ChannelAxes;
use super::finder::Finder;
use super::options::{Handed, RunOutcome, StopPolicy};
use super::program::Index;
use super::run::Interpreter;
use super::state::{Frame, Retains, Step};
use super::unit::Unit;
use super::ways::Ways;
use crate::diagnostic::{Code, Collected, Diagnostic, Severity};
use crate::syntax::ast::Block;
use crate::text::{Place, SourceFile, Span};

impl Interpreter {
    /// Runs a main program whose text is in memory.
    pub fn program(
        &mut self,
        source: SourceFile,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        self.start();
        self.handed = Handed::Whole;
        self.whole(source, finder, observer)
    }

    /// Announces and runs a program whose text is in memory, in a state that is prepared.
    pub(super) fn whole(
        &mut self,
        source: SourceFile,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let index = Index::new(source, self.options.limits.nesting);
        let main = index.main();
        let name = main.and_then(|main| index.sections[main].name.clone());
        self.units.clear();
        self.numbers.clear();
        self.sought = None;
        self.unit_names.clear();
        self.hold(index);
        if self.announce(name.as_deref(), observer).is_break() {
            self.state.parked = Some(Step::Begin);
            return RunOutcome::Paused;
        }
        self.begin(main, finder, observer)
    }

    /// Runs the program that was announced, from the start of a section on.
    pub(super) fn begin(
        &mut self,
        main: Option<usize>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        if self.is_refused() {
            return self.refuse(observer);
        }
        if let Some(section) = main {
            self.enter(0, section);
        }
        let main = Arc::clone(self.units[0].index.source.name());
        if let Err(missing) = self.start_program(&main, finder) {
            return self.ended(EndedBy::Error, &one(*missing), observer);
        }
        let outcome = self.run(finder, observer);
        self.close(outcome, observer)
    }

    /// Whether what is wrong with the main program keeps it from running.
    pub(super) fn is_refused(&self) -> bool {
        !self.refused().is_empty() && self.options.stop == StopPolicy::FirstError
    }

    /// Ends a program that does not run.
    pub(super) fn refuse(&mut self, observer: &mut dyn Observer) -> RunOutcome {
        let refused = self.refused();
        self.ended(ended_by(&refused.said), &refused, observer)
    }

    /// What keeps the main program from running at all.
    pub(super) fn refused(&self) -> Collected {
        let main = self.units.first();
        main.map_or(Collected::default(), |unit| unit.index.refused.clone())
    }

    /// Goes on with a run that an observer stopped. One whose program is read line by line stays
    /// [`RunOutcome::Stopped`].
    pub fn go_on(&mut self, finder: &mut dyn Finder, observer: &mut dyn Observer) -> RunOutcome {
        if self.handed == Handed::LineByLine {
            return RunOutcome::Stopped;
        }
        let outcome = match self.state.parked.take() {
            Some(Step::Begin) => {
                let main = self.units[0].index.main();
                return self.begin(main, finder, observer);
            }
            Some(step) => match self.follow(step) {
                ControlFlow::Break(by) => RunOutcome::Ended(by),
                ControlFlow::Continue(()) => self.run(finder, observer),
            },
            None => self.run(finder, observer),
        };
        self.close(outcome, observer)
    }

    /// Prepares the state for a program start.
    pub(super) fn start(&mut self) {
        self.state.modal = self.state.modal.next_program();
        self.state.memory.start_program(self.machine.parameters);
        self.state.frames.clear();
        self.state.seq = 0;
        self.state.cycles = ModalCycles::default();
        self.state.loops.clear();
        self.state.left_loops.clear();
        self.state.watching = false;
        self.state.refused.clear();
        self.state.ending = None;
        self.state.last = None;
        self.state.parked = None;
        self.state.named.clear();
        self.state.channel_axes = ChannelAxes::default();
        self.state.described = None;
        self.state.ways = Ways::default();
        self.units.clear();
        self.found.clear();
        self.missing.clear();
        self.unit_names.clear();
        self.compared = 0;
        self.pending.clear();
        self.departing.clear();
        self.work.changes.clear();
        self.regions.clear();
        self.lost = Collected::default();
        self.journal.begin_anew();
        self.kept = 0;
        self.held_text = 0;
    }

    /// Takes a file into the run; returns its number.
    pub(super) fn hold(&mut self, index: Index) -> usize {
        let bytes = u64::try_from(index.source.text().len()).unwrap_or(u64::MAX);
        self.held_text = self.held_text.saturating_add(bytes);
        let unit = self.units.len();
        let name = index.source.name().clone();
        self.unit_names.entry(name).or_insert(unit);
        self.units.push(Unit::new(index));
        unit
    }

    /// The main program takes the place that was kept for it. The programs that were called so far
    /// stay where they are: a modal cycle and the calls that were found name them by their places.
    pub(super) fn hold_first(&mut self, index: Index) {
        self.unit_names.retain(|_, unit| *unit != 0);
        let held = self.hold(index);
        let name = self.units[held].index.source.name().clone();
        self.units.swap_remove(0);
        self.unit_names.insert(name, 0);
    }

    pub(super) fn announce(
        &mut self,
        name: Option<&str>,
        observer: &mut dyn Observer,
    ) -> ControlFlow<()> {
        observer.event(Event::Started {
            name,
            compensation: &self.state.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        })
    }

    pub(super) fn enter(&mut self, unit: usize, section: usize) {
        let next = self.units[unit].index.sections[section].start;
        self.state.frames.push(Frame {
            unit,
            section,
            next,
            level: 0,
            own: BTreeMap::new(),
            seeking: None,
            called_from: None,
            restores: None,
            retains: Retains::Nothing,
            waiting: Vec::new(),
            passage: None,
        });
    }

    /// Ends a program whose text is in memory.
    pub(super) fn close(&mut self, outcome: RunOutcome, observer: &mut dyn Observer) -> RunOutcome {
        let RunOutcome::Ended(by) = outcome else {
            return outcome;
        };
        let mut notes = self.refused();
        notes.extend(self.work.over.take());
        if by == EndedBy::EndOfFile && !self.state.frames.is_empty() {
            notes.extend(self.missing_end());
        }
        if self.options.stop == StopPolicy::CheckAll {
            self.check_all_unexecuted(&mut notes);
        }
        self.ended(by, &notes, observer)
    }

    /// FC310 at the last executed block; a program without any block needs no M30 (R2.8).
    pub(super) fn missing_end(&self) -> Option<Diagnostic> {
        let last = self.state.last.as_ref()?;
        let place = Place {
            file: last.file.clone(),
            text: last.text.as_str().into(),
            first_line: last.line,
            span: Span::new(0, last.text.len()),
        };
        let message = "the program ends here without M30 or M02";
        Some(Diagnostic::new(Code::Fc310, place, message).with_help("end it with `M30`"))
    }

    pub(super) fn ended(
        &mut self,
        by: EndedBy,
        notes: &Collected,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let mut notes = Cow::Borrowed(notes);
        if let Some(open) = self.open_description()
            && matches!(by, EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile)
        {
            notes.to_mut().push(open);
        }
        let lost = self.lost_remarks();
        if !lost.is_empty() {
            notes.to_mut().append(&lost);
        }
        let mut changes = std::mem::take(&mut self.work.changes);
        changes.extend(self.state.compensation.program_end());
        if !changes.is_empty() {
            self.version += 1;
        }
        self.state.frames.clear();
        self.release_couplings();
        // The observer wants no more, or it does not: the program has ended either way.
        let _ = observer.event(Event::Ended(Ended {
            seq: self.state.seq,
            by,
            endless: std::mem::take(&mut self.work.endless),
            at: self.work.end.take().as_ref(),
            changes: &changes,
            diagnostics: &notes.said,
            unsaid: &notes.unsaid,
            compensation: &self.state.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        }));
        RunOutcome::Ended(by)
    }

    pub(super) fn is_skipped(&self, block: &Block) -> bool {
        block
            .skip
            .is_some_and(|level| self.options.skip & (1 << level.min(15)) != 0)
    }
}

/// A single message.
pub(super) fn one(diagnostic: Diagnostic) -> Collected {
    let mut notes = Collected::default();
    notes.push(diagnostic);
    notes
}

/// Whether a diagnostic stops the control.
pub(super) fn stops(diagnostic: &Diagnostic) -> bool {
    diagnostic.code.severity() == Severity::Error
}

/// What ends a program that one of these diagnostics keeps from going on.
pub(super) fn ended_by(said: &[Diagnostic]) -> EndedBy {
    let bound = |diagnostic: &Diagnostic| diagnostic.code.is_budget();
    match said.iter().find(|diagnostic| stops(diagnostic)) {
        Some(diagnostic) if bound(diagnostic) => EndedBy::Budget,
        _ => EndedBy::Error,
    }
}
