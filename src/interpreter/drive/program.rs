//! The beginning and the end of a program, and the lines beside its blocks that no run reaches: `%` lines, and comments for
//! this tool that no block follows (R9.24).

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::comp::KindSet;
use crate::diagnostic::{Code, Collected, Diagnostic};
use crate::interpreter::axes::ChannelAxes;
use crate::interpreter::block::{
    AfterError, BlockContext, LastBlock, OwnEnd, ShownBlockLines, ended_by, is_harmless, one,
};
use crate::interpreter::control::{ControlState, ModalCycles, OptionalSection};
use crate::interpreter::drive::host::Interpreter;
use crate::interpreter::drive::joining::MetWays;
use crate::interpreter::drive::lines::MainLines;
use crate::interpreter::events::{Ended, EndedBy, Event, Observer, ProgramEnd};
use crate::interpreter::executor::{Executor, MentionedUnknowns, RunState};
use crate::interpreter::options::{RunOutcome, SourceMode, StopPolicy};
use crate::interpreter::programs::calls::{Finder, WantedCall};
use crate::interpreter::programs::index::{EntryIndex, Index};
use crate::interpreter::programs::store::{Caller, ProgramStore, SourceUnit};
use crate::interpreter::stack::{ControlStep, Request};
use crate::interpreter::values::location::MissingProgram;
use crate::interpreter::ways::others::OtherPaths;
use crate::interpreter::ways::path::RunTrack;
use crate::interpreter::ways::set::WaySet;
use crate::lists::{ChannelSettings, ChannelSwitch};
use crate::machine::Machine;
use crate::syntax::ast::{Block, CallForm, CallScope};
use crate::syntax::{Fault, LineFault, LostRemarks, RawBlock, Remark, allow};
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
        self.source_mode = SourceMode::Whole;
        self.whole(source, finder, observer)
    }

    /// Announces and runs a program whose text is in memory, in a state that is prepared.
    pub(crate) fn whole(
        &mut self,
        source: SourceFile,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let index = Index::new(source, self.here.options.limits.nesting);
        let name = index
            .main
            .and_then(|main| index.sections[main].name.clone());
        self.here.programs.clear();
        self.here.programs.hold(index);
        if self.here.announce(name.as_deref(), observer).is_break() {
            self.here.state.parked = Some(ControlStep::Begin);
            return RunOutcome::Paused;
        }
        self.begin(None, finder, observer)
    }

    /// Runs the announced program from its start: the lines, or the main program in memory.
    pub(crate) fn begin(
        &mut self,
        mut lines: Option<MainLines<'_>>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        if let Some(by) = self.here.end_by_refusal() {
            return self.close(RunOutcome::Ended(by), observer);
        }
        let main = if let Some(lines) = &lines {
            self.here.enter(0, 0);
            Arc::clone(&lines.file)
        } else {
            self.enter_main()
        };
        if let Err(missing) = self.here.start_program(&main, finder) {
            return self.ended(EndedBy::Error, &one(*missing), observer);
        }
        let outcome = self.run(&mut lines, finder, observer);
        self.leave_lines(lines, outcome);
        self.close(outcome, observer)
    }

    /// Enters the main program in memory. Returns the name of its file.
    fn enter_main(&mut self) -> Arc<str> {
        let index = self.here.programs.index(0);
        let name = Arc::clone(index.source.name());
        self.lost.extend(index.no_block());
        match index.main {
            Some(section) => self.here.enter(0, section),
            None => self.lost.extend(index.no_main_program()),
        }
        name
    }

    /// Continues a run that an observer stopped. One whose program is read line by line stays
    /// [`RunOutcome::Stopped`].
    pub fn go_on(&mut self, finder: &mut dyn Finder, observer: &mut dyn Observer) -> RunOutcome {
        if self.source_mode == SourceMode::LineByLine {
            return RunOutcome::Stopped;
        }
        self.here.offered.clear();
        let outcome = match self.here.state.parked.take() {
            Some(ControlStep::Begin) => {
                return self.begin(None, finder, observer);
            }
            Some(step) => match self.take_step(step, &mut None, observer) {
                ControlFlow::Break(outcome) => outcome,
                ControlFlow::Continue(()) => self.run(&mut None, finder, observer),
            },
            None => self.run(&mut None, finder, observer),
        };
        self.close(outcome, observer)
    }

    /// Prepares the state for a program start.
    pub(crate) fn start(&mut self) {
        self.here.start();
        self.others = OtherPaths::default();
        self.lost = Collected::default();
    }
}

impl Executor {
    pub(crate) fn announce(
        &mut self,
        name: Option<&str>,
        observer: &mut dyn Observer,
    ) -> ControlFlow<()> {
        self.show_ways();
        observer.event(Event::Started {
            name,
            possible: &self.shown.possible,
            compensation: &self.state.control.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        })
    }

    fn start(&mut self) {
        self.state.start(&self.machine);
        self.state.control.define_listed_coupling(&self.machine);
        self.begin_search();
        self.is_alone = true;
        self.sides.clear();
        self.programs.clear();
        self.scratch.has_plain_words = false;
        self.scratch.clear();
    }

    /// Returns the end of a run that faults of the main program keep from starting.
    pub(crate) fn end_by_refusal(&self) -> Option<EndedBy> {
        let refused = self.programs.refused();
        let is_refused = !refused.is_empty() && self.options.stop == StopPolicy::FirstError;
        is_refused.then(|| ended_by(&refused.said))
    }

    /// Calls the configured program that runs before every main program (R2.15).
    pub(crate) fn start_program(
        &mut self,
        main: &str,
        finder: &mut dyn Finder,
    ) -> Result<(), Box<Diagnostic>> {
        let Some(name) = self.machine.programs.start.clone() else {
            return Ok(());
        };
        if self.machine.programs.is_external(&name) {
            self.leave_to_machine(&MissingProgram::Named(name.into()));
            return Ok(());
        }
        let place = Place {
            file: name.as_str().into(),
            text: "".into(),
            first_line: 1,
            span: Span::default(),
        };
        let wanted = WantedCall::program(CallScope::Global, name, Span::default());
        let caller = Caller {
            unit: 0,
            file: main,
        };
        match self
            .programs
            .find(&wanted, caller, finder, &self.state.work)
        {
            Ok(Some(found)) => {
                let refused = &self.programs.index(found.unit).refused;
                if let (Some(first), StopPolicy::FirstError) =
                    (refused.said.first(), self.options.stop)
                {
                    return Err(Box::new(first.clone()));
                }
                self.push_call(Request {
                    found,
                    passage: None,
                    own: BTreeMap::new(),
                    form: CallForm::Plain,
                    called_from: place,
                });
                Ok(())
            }
            Ok(None) => Ok(()),
            Err(fault) => {
                // The call is in the configuration, not in a block.
                Err(Box::new(fault.into_diagnostic(place, |_| None)))
            }
        }
    }
}

/// Cause that stops a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ProgramStop {
    /// The end of the program.
    End,
    /// A reset of the channel, after an error, in a loop without an end, or between two programs.
    Reset,
}

impl Interpreter {
    /// Ends a program whose text is in memory.
    pub(crate) fn close(&mut self, outcome: RunOutcome, observer: &mut dyn Observer) -> RunOutcome {
        let RunOutcome::Ended(by) = outcome else {
            return outcome;
        };
        let mut notes = self.here.programs.refused();
        notes.extend(self.here.scratch.ending.over.drain(..));
        if by == EndedBy::EndOfFile && !self.here.state.control.frames.is_empty() {
            notes.extend(self.here.state.missing_end());
        }
        if self.here.options.stop == StopPolicy::CheckAll {
            self.here.check_all_unexecuted(&mut notes);
        }
        self.ended(by, &notes, observer)
    }

    pub(crate) fn ended(
        &mut self,
        by: EndedBy,
        notes: &Collected,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let mut notes = Cow::Borrowed(notes);
        if let Some(open) = self.here.state.control.open_description()
            && matches!(by, EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile)
        {
            notes.to_mut().push(open);
        }
        let beside = self.beside_blocks(by);
        if !beside.is_empty() {
            notes.to_mut().append(&beside);
        }
        let ended = if self.here.state.ended.is_empty() {
            if by == EndedBy::Error {
                self.here.reset_friction();
            }
            let RunState { track, control, .. } = &mut self.here.state;
            track.assumed.undo(&mut control.memory);
            MetWays {
                by,
                ends: Vec::new(),
                stopped: None,
            }
        } else {
            self.others.meet_ended(&mut self.here, by)
        };
        let by = ended.by;
        self.here.let_plc_act();
        notes.to_mut().extend(self.others.joined.drain(..));
        notes
            .to_mut()
            .extend(self.here.scratch.messages.of_some_ways.drain(..));
        notes.to_mut().extend(self.here.missed_search());
        let at = self.here.scratch.ending.at.take();
        let mut ends = self.here.own_end(by, at.as_ref());
        if !ended.ends.is_empty() {
            ends.splice(..1.min(ends.len()), ended.ends);
        }
        // R2.84: only a reset ends a loop without an end.
        if self.here.scratch.ending.endless {
            self.here.reset_friction();
        }
        let mut changes = std::mem::take(&mut self.here.scratch.changes);
        changes.extend(self.here.state.control.compensation.program_end());
        if !changes.is_empty() {
            self.here.version += 1;
        }
        for change in &changes {
            let kinds = KindSet::of(change.kind);
            self.here.state.control.history.close(change.axis, kinds);
        }
        let stop = match by {
            EndedBy::Error => ProgramStop::Reset,
            _ if self.here.scratch.ending.endless => ProgramStop::Reset,
            _ => ProgramStop::End,
        };
        let control = &mut self.here.state.control;
        control.frames.clear();
        control.end_exchange(stop, &self.here.machine.channel);
        control.couplings.end_following();
        // The program ends on all ways.
        self.here.state.track.reach = WaySet::always();
        self.here.version += u64::from(self.here.state.control.history.is_open());
        self.here.show_ways();
        // Whether or not the observer wants more events, the program has ended.
        let _ = observer.event(Event::Ended(Ended {
            seq: self.here.state.seq,
            by,
            endless: std::mem::take(&mut self.here.scratch.ending.endless),
            at: at.as_ref().map(|end| &end.place),
            ends: &ends,
            found: self.here.state.found_states(),
            stopped: ended.stopped.as_ref(),
            failed: self.here.state.track.failed.as_deref(),
            changes: &changes,
            diagnostics: &notes.said,
            unsaid: &notes.unsaid,
            compensation: &self.here.state.control.compensation,
            possible: &self.here.shown.possible,
            occurred: &self.here.state.occurred,
            version: self.here.version,
        }));
        RunOutcome::Ended(by)
    }
}

impl Executor {
    /// Reports P-ERR-21500 to 21502: the text ends while the control skips it for a false `$IF` without `$ENDIF`
    /// (R2.103). Returns whether the run stops there.
    #[cold]
    pub(crate) fn ends_in_open_if(&mut self) -> bool {
        let Some(frame) = self.state.control.frames.running_mut() else {
            return false;
        };
        let (unit, level, is_main) = (frame.unit, frame.level, frame.level == 0);
        let section = frame.section;
        frame.seeking = None;
        let index = self.programs.index(unit);
        let Some(opener) = index.last_unclosed(section) else {
            return false;
        };
        let code = match index.sections.get(section) {
            _ if is_main => Code::PErr21501,
            Some(section) if section.local => Code::PErr21500,
            _ => Code::PErr21502,
        };
        let parsed = self.programs.parsed(unit, opener);
        let shown = ShownBlockLines::default();
        let at = BlockContext::of_parsed(&parsed, level, &shown);
        let span = Span::new(0, at.text.trim_end().len());
        let what = "this `$IF` has no `$ENDIF`: the control skips the rest of the text and stops at its end";
        let mut said = at.diagnostic(*Fault::refused(code, span, what));
        self.state.limit_to_reach(&mut said, None);
        self.scratch.ending.over.push(said);
        if self.options.stop == StopPolicy::FirstError {
            return true;
        }
        self.fail(AfterError::Reset, &at);
        false
    }

    /// Returns the end of the program where all ways reach one.
    fn own_end(&self, by: EndedBy, at: Option<&OwnEnd>) -> Vec<ProgramEnd> {
        let last = self.state.last.as_ref().map(LastBlock::place);
        let place = at.map(|end| end.place.clone()).or(last);
        let reached = place.map(|place| {
            let mut compensation = self.state.control.compensation.clone();
            let _ = compensation.program_end();
            ProgramEnd {
                place,
                by,
                is_passed_into: at.is_some_and(|end| end.is_passed_into),
                cause: None,
                compensation,
            }
        });
        reached.into_iter().collect()
    }

    /// Blocks that no run of the program and of the files that it calls reached, for their syntax.
    pub(crate) fn check_all_unexecuted(&self, notes: &mut Collected) {
        for (number, unit) in self.programs.units().iter().enumerate() {
            let others = unit.index.other_mains().filter(|_| number == 0);
            self.check_unexecuted_of(unit, others, notes);
        }
    }

    /// Reports the messages on the blocks of a file, each program that is never run before its blocks.
    fn check_unexecuted_of(
        &self,
        unit: &SourceUnit,
        never_run: impl Iterator<Item = (EntryIndex, Diagnostic)>,
        notes: &mut Collected,
    ) {
        let mut never_run = never_run.peekable();
        let file = unit.index.source.name();
        let mut unread_up_to = 0;
        for place in 0..unit.index.entries.len() {
            let entry = Span::new(place, place).start;
            while let Some((_, said)) = never_run.next_if(|(start, _)| *start <= entry) {
                notes.push(said);
            }
            if unit.executed[place] {
                // Branches that `#IF` left out are not read at all (R2.73).
                let end = unit.index.interpreted_to(entry);
                unread_up_to = unread_up_to.max(end.unwrap_or_default());
                continue;
            }
            if entry < unread_up_to {
                continue;
            }
            let mut block = Block::default();
            let mut reader = unit.index.reader(entry);
            // A skipped block is also passed over by the run.
            if let Some(raw) = reader.next(&mut block)
                && !self.is_skipped(&block)
            {
                self.check_unexecuted(file, &raw, &block, notes);
            }
        }
    }

    pub(crate) fn check_unexecuted(
        &self,
        file: &Arc<str>,
        raw: &RawBlock<'_>,
        block: &Block,
        notes: &mut Collected,
    ) {
        let shown = ShownBlockLines::default();
        let at = BlockContext::of_raw(file, raw, block, &shown);
        notes.extend(
            block
                .faults
                .iter()
                .filter(|fault| !is_harmless(&self.machine.harmless, fault, raw.text))
                .map(|fault| at.diagnostic(fault.clone())),
        );
    }
}

impl ProgramStore {
    /// Returns the faults that keep the main program from running at all.
    pub(crate) fn refused(&self) -> Collected {
        let main = self.units().first();
        main.map_or(Collected::default(), |unit| unit.index.refused.clone())
    }
}

impl Interpreter {
    /// Returns the messages on the `%` lines of the main file, and on comments for this tool in all
    /// files, or up to where each was reached where the rest is not checked.
    fn beside_blocks(&mut self, by: EndedBy) -> Collected {
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
}

impl Executor {
    /// Returns the last line of a file that was reached, or more than all lines where the rest is checked, too.
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

/// Gathers FC490 or FC491 for each comment, and the faults of lines outside blocks, down to a line.
pub(crate) fn gather(file: &Arc<str>, lost: &LostRemarks, until: u32, said: &mut Collected) {
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

impl RunState {
    fn start(&mut self, machine: &Machine) {
        self.control.start(machine);
        self.track = RunTrack::default();
        self.ended.clear();
        self.asked.clear();
        self.seq = 0;
        self.work.begin_ways();
        self.once.clear();
        self.watching = false;
        self.last = None;
        self.parked = None;
        self.mentioned = MentionedUnknowns::default();
    }
}

impl ControlState {
    fn start(&mut self, machine: &Machine) {
        self.modal = self.modal.next_program(&machine.channel);
        self.memory.start_program(machine.parameters);
        self.history.begin_program();
        self.frames.clear();
        self.cycles = ModalCycles::default();
        self.refused.clear();
        self.ending = None;
        self.named.clear();
        self.optional = OptionalSection::Outside;
        self.described = None;
        let keeps_axes = [ChannelSwitch::KeepAxes, ChannelSwitch::KeepAxesAfterReset];
        if !keeps_axes.into_iter().any(|it| machine.channel.has(it)) {
            self.channel_axes = ChannelAxes::default();
        }
    }

    /// Couplings and exchanged axes end with the program or by a reset, unless the channel list says otherwise (R2.105).
    pub(crate) fn end_exchange(&mut self, stop: ProgramStop, channel: &ChannelSettings) {
        use ChannelSwitch::{KeepAxes, KeepAxesAfterReset, KeepCouplings, KeepCouplingsAfterReset};
        let [keeps_axes, keeps_couplings] = match stop {
            ProgramStop::Reset => [KeepAxesAfterReset, KeepCouplingsAfterReset],
            ProgramStop::End => [KeepAxes, KeepCouplings],
        }
        .map(|switch| channel.has(switch));
        let keeps_configuration = channel.has(KeepAxes);
        if keeps_configuration && stop == ProgramStop::Reset && !keeps_couplings {
            // The effect of the reset by P-CHAN-00460 on couplings is not documented.
            if self.couplings.is_any() {
                self.havoc_couplings();
            }
        } else if !(keeps_couplings || keeps_configuration) {
            self.release_couplings();
        }
        if !keeps_configuration {
            // P-CHAN-00115 decides which of the exchanged axes a reset leaves in the channel.
            let is_exchanged = keeps_axes && !self.channel_axes.are_own();
            self.channel_axes = ChannelAxes::default();
            if is_exchanged {
                self.channel_axes.havoc();
            }
        }
    }
}
