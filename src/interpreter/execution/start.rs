//! The beginning of a program.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::{Collected, Diagnostic};
use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::Index;
use crate::interpreter::programs::store::Caller;
use crate::interpreter::programs::wanted::WantedCall;
use crate::interpreter::run::channel_axes::ChannelAxes;
use crate::interpreter::run::control::OptionalSection;
use crate::interpreter::run::cycles::ModalCycles;
use crate::interpreter::run::event::{EndedBy, Event, Observer};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::mentioned::MentionedUnknowns;
use crate::interpreter::run::options::{RunOutcome, SourceMode, StopPolicy};
use crate::interpreter::run::path::RunTrack;
use crate::interpreter::run::step::{ControlStep, Request};
use crate::interpreter::run::stopping::one;
use crate::interpreter::values::cause::MissingProgram;
use crate::lists::ChannelSwitch;
use crate::syntax::ast::{CallForm, CallScope};
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
        self.here.awaited = None;
        self.here.programs.hold(index);
        if self.announce(name.as_deref(), observer).is_break() {
            self.here.state.parked = Some(ControlStep::Begin);
            return RunOutcome::Paused;
        }
        self.begin(finder, observer)
    }

    /// Runs the announced program from the start of its section.
    pub(crate) fn begin(
        &mut self,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        if self.is_refused() {
            return self.refuse(observer);
        }
        self.lost.extend(self.here.programs.index(0).no_block());
        match self.here.programs.index(0).main {
            Some(section) => self.here.enter(0, section),
            None => self
                .lost
                .extend(self.here.programs.index(0).no_main_program()),
        }
        let main = Arc::clone(self.here.programs.index(0).source.name());
        if let Err(missing) = self.here.start_program(&main, finder) {
            return self.ended(EndedBy::Error, &one(*missing), observer);
        }
        let outcome = self.run(finder, observer);
        self.close(outcome, observer)
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
                return self.begin(finder, observer);
            }
            Some(step) => match self.follow_to_end(step) {
                Some(by) => RunOutcome::Ended(by),
                None => self.run(finder, observer),
            },
            None => self.run(finder, observer),
        };
        self.close(outcome, observer)
    }

    /// Prepares the state for a program start.
    pub(crate) fn start(&mut self) {
        self.here.state.control.modal = self
            .here
            .state
            .control
            .modal
            .next_program(&self.here.machine.channel);
        self.here
            .state
            .control
            .memory
            .start_program(self.here.machine.parameters);
        self.here.state.control.history.begin_program();
        self.here.state.control.frames.clear();
        self.here.state.seq = 0;
        self.here.state.control.cycles = ModalCycles::default();
        self.here.state.watching = false;
        self.here.state.control.refused.clear();
        self.here.state.once.clear();
        self.here.state.control.ending = None;
        self.here.state.last = None;
        self.here.state.parked = None;
        self.here.state.control.named.clear();
        self.here.state.control.optional = OptionalSection::Outside;
        let channel = &self.here.machine.channel;
        let keeps_axes = [ChannelSwitch::KeepAxes, ChannelSwitch::KeepAxesAfterReset];
        if !keeps_axes.into_iter().any(|it| channel.has(it)) {
            self.here.state.control.channel_axes = ChannelAxes::default();
        }
        self.here.define_listed_couplings();
        self.here.state.control.described = None;
        self.here.state.track = RunTrack::default();
        self.here.begin_search();
        self.here.state.work.begin_ways();
        self.others.widened = 0;
        self.others.waiting.clear();
        self.others.loop_heads.clear();
        self.others.call_effects.clear();
        self.here.state.ended.clear();
        self.here.state.asked.clear();
        self.here.sides.clear();
        self.others.joined.clear();
        self.others.joined_withheld.clear();
        self.here.state.mentioned = MentionedUnknowns::default();
        self.here.programs.clear();
        self.here.scratch.changes.clear();
        self.lost = Collected::default();
    }

    pub(crate) fn announce(
        &mut self,
        name: Option<&str>,
        observer: &mut dyn Observer,
    ) -> ControlFlow<()> {
        self.here.show_ways();
        observer.event(Event::Started {
            name,
            possible: &self.here.shown.possible,
            compensation: &self.here.state.control.compensation,
            occurred: &self.here.state.occurred,
            version: self.here.version,
        })
    }
}

impl Executor {
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
