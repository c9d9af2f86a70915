//! Refusals of the control, and the ways that end with them: `#ERROR` (R2.100; PM/207457163), blocks that it may refuse
//! (R2.114), and errors, each with the state that it leaves (R14.5, R18.10). Unknown values that decide are reported
//! with their origins (R2.95).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::block::{AfterError, BlockContext, FailedAt, OwnEnd, stops};
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::{Executor, MentionedUnknowns};
use crate::interpreter::options::StopPolicy;
use crate::interpreter::stack::ControlStep;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::plain::{Asking, ConditionSubject, Writer, reads, text_of};
use crate::interpreter::values::value::{exact, numeric};
use crate::interpreter::ways::path::EndedPath;
use crate::interpreter::ways::possible_state::ways_of;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::limit_to;
use crate::interpreter::words::questions::{Doubt, MachineQuestion, answers};
use crate::language::{ChannelState, Flushes, Group, RefusedIn};
use crate::readings::{Alternative, Question};
use crate::syntax::Fault;
use crate::syntax::ast::{Address, Block, Expression, Hash, Operand, Word};
use crate::text::Span;

/// The remedy class of a system error, after which the control is restarted, or reset (tf5200, 15557035659).
const SYSTEM_ERROR: f64 = 7.0;

/// Knowledge of a remedy class.
enum RemedyClass {
    Known(f64),
    /// Class left out, for which no default is documented.
    LeftOut,
    /// Class that depends on a value known only to the machine.
    Unknown(Expression, Doubt),
}

/// The blocks to which it applies whether an error ends the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum StopScope {
    /// Only this block; each other one is decided anew.
    Block,
    /// This block and all later ones.
    Rest,
    /// This block and all later ones that are refused for the same reason, in the words of FC328.
    Alike(Arc<str>),
}

impl Executor {
    /// Executes an error that the program reports by itself. With the class 0 it goes on.
    pub(crate) fn report_error(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        match self.remedy_class(hash, at)? {
            RemedyClass::Known(0.0) => self.pass_over("#ERROR", hash.span, at),
            RemedyClass::Known(class) => {
                let class_text = match hash.arguments.first() {
                    Some(_) => format!("`RC={class}`"),
                    None => "no `RC`".to_owned(),
                };
                let said = error_with(&class_text, hash.span, at);
                self.scratch.messages.diagnostics.push(said);
                let after = if class == SYSTEM_ERROR {
                    AfterError::ResetOrRestart
                } else {
                    AfterError::Reset
                };
                self.end_with(after, at);
            }
            RemedyClass::LeftOut => {
                let message =
                    "whether the program ends here is not documented: `#ERROR` has no `RC`";
                if self.state.is_new_word(message) {
                    let fault = Fault::new(Code::Fc902, hash.span, message).with_help(
                        "`RC=0` lets the program go on, `RC=2` stops it; without it, \
                         `\"R2.100\"` in `[reading]` of frictcomp.toml decides",
                    );
                    self.say_before_parting(at.diagnostic(fault));
                }
                let question = MachineQuestion {
                    kind: ConditionKind::Stop,
                    span: hash.span,
                    texts: vec!["`#ERROR`".into()],
                    cause: Unknown::RemedyClass,
                    // The control has one answer for all of them.
                    reads: Some(Asking::of_unknown(Writer::Nothing, Unknown::RemedyClass)),
                    kept: None,
                };
                let ways = self.part_at_end(question, at);
                if self.perhaps_end(ways, AfterError::Reset, at) {
                    self.end_with(AfterError::Reset, at);
                }
            }
            RemedyClass::Unknown(expression, doubt) => {
                let (text, span) = text_of(at.block, at.text, expression);
                let reads = reads(at.block, at.text, expression, &self.externals);
                let question = MachineQuestion {
                    kind: ConditionKind::Branch,
                    span,
                    texts: vec![format!("{text} != 0").into()],
                    cause: doubt.cause(),
                    reads: reads.map(|asking| asking.about(ConditionSubject::RemedyClass)),
                    kept: doubt.kept_answer(|value| usize::from(value.number() == Some(0.0))),
                };
                let said = error_with("an `RC` that is not 0", hash.span, at);
                if self.refused_where(question, said, AfterError::ResetOrRestart, at) {
                    self.end_with(AfterError::ResetOrRestart, at);
                }
            }
        }
        Ok(())
    }

    /// Ends the program by an error where the first answer to a question is given. Returns whether it ends on all ways.
    pub(crate) fn refused_where(
        &mut self,
        question: MachineQuestion,
        mut said: Diagnostic,
        after: AfterError,
        at: &BlockContext<'_>,
    ) -> bool {
        let ways = self.part_at_end(question, at);
        let [ends, _] = &ways;
        if !ends.is_never() {
            limit_to(&mut said, &ways_of(ends, &self.state.conditions));
            self.scratch.messages.of_some_ways.push(said);
        }
        self.perhaps_end(ways, after, at)
    }

    /// Reports a message about all ways that lead to a block after which they part.
    pub(crate) fn say_before_parting(&mut self, mut said: Diagnostic) {
        let reach = &self.state.track.reach;
        if !reach.is_always() {
            limit_to(&mut said, &ways_of(reach, &self.state.conditions));
        }
        self.scratch.messages.of_some_ways.push(said);
    }

    fn remedy_class(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<RemedyClass, Box<Fault>> {
        let Some(&class) = hash.arguments.first() else {
            self.state.rests_on.insert(Question::RemedyClass);
            return Ok(match self.machine.readings.of(Question::RemedyClass) {
                Some(Alternative::First) => RemedyClass::Known(0.0),
                Some(Alternative::Second) => RemedyClass::Known(2.0),
                None => RemedyClass::LeftOut,
            });
        };
        let (value, doubt) = self.asked_value(class, at)?;
        Ok(match (doubt, class) {
            (Some(doubt), Operand::Expression(expression)) => {
                RemedyClass::Unknown(expression, doubt)
            }
            _ => RemedyClass::Known(numeric(&value, hash.span)?.unwrap_or_default()),
        })
    }

    /// Follows both ways where only the machine knows whether an error ends the program at the block.
    pub(crate) fn perhaps_stop(
        &mut self,
        (error, scope): (Unknown, StopScope),
        span: Span,
        at: &BlockContext<'_>,
    ) {
        if self.scratch.read.unread.get() {
            return;
        }
        let asking = || Asking::of_unknown(Writer::Nothing, error.clone());
        let reads = match scope {
            StopScope::Block => None,
            StopScope::Rest => Some(asking()),
            StopScope::Alike(reason) => Some(asking().about(ConditionSubject::Refusal(reason))),
        };
        let question = MachineQuestion {
            kind: ConditionKind::Stop,
            span,
            texts: vec![error.to_string().into()],
            reads,
            cause: error,
            kept: None,
        };
        let ways = self.part_at_end(question, at);
        self.perhaps_end(ways, AfterError::Reset, at);
    }

    /// Ends the program here on some ways that lead to the block, and lets it go on on the others. Returns whether it
    /// ends on all ways.
    fn perhaps_end(
        &mut self,
        [ends, goes_on]: [WaySet; 2],
        after: AfterError,
        at: &BlockContext<'_>,
    ) -> bool {
        if ends.is_never() {
            return false;
        }
        if goes_on.is_never() {
            return true;
        }
        self.stop_on(&ends, after, at);
        if self.options.stop != StopPolicy::KeepGoing {
            self.state.go_on_with(goes_on);
        }
        false
    }

    fn end_with(&mut self, after: AfterError, at: &BlockContext<'_>) {
        if self.options.stop == StopPolicy::FirstError {
            self.scratch.ending.after_error = after;
            self.scratch.actions.step = Some(ControlStep::End(EndedBy::Error));
        } else {
            self.fail(after, at);
        }
    }
}

/// Whether a block has G40, G41 or G42.
fn selects_radius(block: &Block) -> bool {
    let is_it = |word: &Word| {
        let number = match word.value {
            Some(Operand::Number(number)) => exact(number),
            _ => None,
        };
        let group = number.and_then(Group::of);
        word.address == Address::Letter(b'G') && group == Some(Group::CutterRadius)
    };
    block.all_words().any(is_it)
}

/// Returns FC318: the program reports an error of its own, with a remedy class that stops it.
fn error_with(class: &str, span: Span, at: &BlockContext<'_>) -> Diagnostic {
    let message = format!("the control stops here: the program reports an error with {class}");
    let fault = Fault::new(Code::Fc318, span, message)
        .with_help("with `RC=0` it is a warning, and the program continues");
    at.diagnostic(fault)
}

/// An error by which the control may refuse a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PossibleRefusal {
    /// Number, where that is public.
    number: Option<u32>,
    /// The question whose readings decide.
    question: Option<Question>,
}

impl From<u32> for PossibleRefusal {
    fn from(number: u32) -> Self {
        Some(number).into()
    }
}

impl From<Option<u32>> for PossibleRefusal {
    fn from(number: Option<u32>) -> Self {
        Self {
            number,
            question: None,
        }
    }
}

impl PossibleRefusal {
    /// Creates a refusal about which the readings of a question decide.
    pub(crate) fn asked(number: impl Into<Option<u32>>, question: Question) -> Self {
        Self {
            number: number.into(),
            question: Some(question),
        }
    }
}

impl Executor {
    /// Reports FC328: the control may refuse the block with an error; once a program for each text.
    #[cold]
    pub(crate) fn may_refuse(
        &mut self,
        refusal: impl Into<PossibleRefusal>,
        what: &str,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let refusal = refusal.into();
        let asked = (Unknown::Refused(refusal.number), StopScope::Block);
        self.may_refuse_with(refusal, what, asked, span, at);
    }

    /// The same for something about which the control has one answer, wherever it is in the program.
    #[cold]
    pub(crate) fn may_refuse_alike(
        &mut self,
        number: u32,
        what: &str,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let asked = (
            Unknown::Refused(Some(number)),
            StopScope::Alike(what.into()),
        );
        self.may_refuse_with(number.into(), what, asked, span, at);
    }

    /// FC328: a word or command in a state in which the control refuses it, or where it must not flush the channel
    /// (R2.111).
    pub(crate) fn check_states(
        &mut self,
        (refused, flushes): (RefusedIn, Flushes),
        name: &str,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        if refused.is_empty() && flushes == Flushes::Never {
            return;
        }
        let control = &self.state.control;
        // Which of two words of a block counts first is not documented: `G17 G40`.
        let counts = |state| state != ChannelState::CutterRadius || !selects_radius(at.block);
        let mut states = refused.iter();
        let found = states.find(|(state, _)| control.is_in(*state) && counts(*state));
        let Some(&(state, number)) = found else {
            return self.check_flush(flushes, name, span, at);
        };
        let what = format!("`{name}` stands {}", state.words());
        self.may_refuse_alike(number, &what, span, at);
    }

    /// Reports FC328: something flushes the channel where the control may refuse that (R2.111).
    pub(crate) fn check_flush(
        &mut self,
        flushes: Flushes,
        name: &str,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let modal = &self.state.control.modal;
        let found = flushes.refused().iter();
        let found = found.copied().find(|(state, _)| modal.is_in(*state));
        let Some((state, number)) = found else {
            return;
        };
        let what = format!("`{name}` flushes the channel {}", state.words());
        // The control has one answer for each command, and for each variable, which is synchronous or not.
        let scope = StopScope::Alike(what.as_str().into());
        let asked = (Unknown::Refused(Some(number)), scope);
        let refusal = PossibleRefusal {
            question: name.starts_with("V.E.").then_some(Question::ReadFlushes),
            ..number.into()
        };
        self.may_refuse_with(refusal, &what, asked, span, at);
    }

    /// Reports FC328 for a variable that no `#VAR` declares: the control has one answer for all of them (R2.102).
    #[cold]
    pub(crate) fn miss_declaration(&mut self, name: &str, span: Span, at: &BlockContext<'_>) {
        let what = format!("`{name}` is written without a declaration in `#VAR`");
        let asked = (Unknown::Undeclared, StopScope::Rest);
        let refusal = PossibleRefusal::asked(None, Question::Undeclared);
        self.may_refuse_with(refusal, &what, asked, span, at);
    }

    fn may_refuse_with(
        &mut self,
        PossibleRefusal { number, question }: PossibleRefusal,
        what: &str,
        asked: (Unknown, StopScope),
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let span = at.in_block(span);
        if let Some(question) = question {
            self.state.rests_on.insert(question);
            match self.machine.readings.of(question) {
                Some(Alternative::First) => return,
                Some(Alternative::Second) => {
                    let message = format!("{what}; the selected reading refuses it");
                    let fault = Fault::new(Code::Fc306, span, message).with_cure(number);
                    return self.scratch.complain(fault, at);
                }
                None => {}
            }
        }
        if self.state.is_new_word(what) {
            let error = number.map_or_else(String::new, |number| format!(" ({number})"));
            let message = format!("{what}; the control may refuse it{error}");
            let fault = Fault::new(Code::Fc328, span, message).with_cure(number);
            self.say_before_parting(at.diagnostic(fault));
        }
        self.perhaps_stop(asked, span, at);
    }
}

impl Executor {
    /// Adds a message about an unknown value once per program (FC902); again only where `what` differs.
    pub(crate) fn tell_once(
        &mut self,
        cause: &Unknown,
        what: &str,
        fault: Fault,
        at: &BlockContext<'_>,
    ) {
        let span = fault.span;
        let said = at.diagnostic(fault);
        let said = self.state.mentioned.with_origin(said, cause, at);
        self.state.mentioned.enter_root(cause, span, at);
        if self
            .state
            .mentioned
            .is_new(cause, [what.to_owned()], &said.place)
        {
            self.scratch.messages.diagnostics.push(said);
        } else {
            self.scratch.aside.withheld.push(said);
        }
    }
}

impl MentionedUnknowns {
    /// Remembers where an unknown value first occurred.
    pub(crate) fn enter_root(&mut self, cause: &Unknown, span: Span, at: &BlockContext<'_>) {
        self.enter(cause, || at.place(at.in_block(span)));
    }

    /// Adds to the message the block where the value first occurred, unless its own block shows it.
    pub(crate) fn with_origin(
        &self,
        said: Diagnostic,
        cause: &Unknown,
        at: &BlockContext<'_>,
    ) -> Diagnostic {
        let is_shown = cause.is_shown_in(at.text) || at.block.skip.is_some();
        let origin = self.origin(cause).filter(|_| !is_shown);
        match origin {
            Some(origin) if (&origin.file, origin.first_line) != (at.file, at.line) => {
                said.with_label(origin.clone(), "the unknown value comes from here")
            }
            _ => said,
        }
    }
}

impl Executor {
    /// Ends some of the ways that lead to the block by an error, and with them the program. With
    /// [`StopPolicy::KeepGoing`] they continue, as if the failing command were not there (R9.20).
    #[cold]
    pub(crate) fn stop_on(&mut self, ways: &WaySet, after: AfterError, at: &BlockContext<'_>) {
        if self.options.stop == StopPolicy::KeepGoing {
            return;
        }
        let is_passed_into = !self.position().may_be_jumped_to(at);
        let sides = self.sides_after(ways, after, at);
        // The states after a reset and after a restart differ, which is reported.
        let is_one_end = sides.len() == 1;
        let here = (self.state.control.clone(), self.state.track.clone());
        for (ways, next) in sides {
            (self.state.control, self.state.track) = here.clone();
            self.state.go_on_with(ways);
            self.doubt_switches();
            match next {
                NextStart::Reset => self.reset_after_stop(),
                NextStart::Restart => {
                    self.restart();
                    self.state.control.history.forget_sites();
                }
            }
            let end = self.scratch.ending.at.replace(OwnEnd {
                place: at.place(Span::new(0, at.text.len())),
                is_passed_into,
            });
            let mut ended = self.ended_path(EndedBy::Error);
            if self.options.stop == StopPolicy::CheckAll {
                // It does not leave the loops in which the run goes on.
                ended.path.parted = 0;
            }
            if is_one_end {
                self.state.end_way(ended);
            } else {
                self.state.ended.push(ended);
            }
            self.scratch.ending.at = end;
        }
        (self.state.control, self.state.track) = here;
        self.version += 1;
    }

    /// Makes the COMP commands of a refused block uncertain: whether the control executes them is not documented
    /// (R1.24).
    fn doubt_switches(&mut self) {
        for change in &self.scratch.changes {
            let kind = KindSet::of(change.kind);
            let control = &mut self.state.control;
            control
                .compensation
                .havoc(change.axis, kind, &mut Vec::new());
            control.history.close(change.axis, kind);
        }
    }

    /// Ends the program by an error on all ways that lead to the block; where the run goes on after errors, what
    /// follows is executed as if the failing command were not there (R9.20).
    #[cold]
    pub(crate) fn fail(&mut self, after: AfterError, at: &BlockContext<'_>) {
        if self.options.stop == StopPolicy::CheckAll && self.state.track.failed.is_none() {
            let ways = self.state.track.reach.clone();
            self.stop_on(&ways, after, at);
            let failed = FailedAt::new(self.state.seq, at, &self.scratch.messages.diagnostics);
            self.state.track.failed = Some(Box::new(failed));
        }
    }

    /// Ends the program in the same way where a message on the block is about an error of the control.
    #[cold]
    pub(crate) fn fail_if_refused(&mut self, at: &BlockContext<'_>) {
        let mut said = self.scratch.messages.diagnostics.iter();
        if said.any(|said| stops(said) && !said.code.is_budget()) {
            self.fail(AfterError::Reset, at);
        }
    }

    /// Returns the way that leads here as one on which the program ends.
    pub(crate) fn ended_path(&mut self, by: EndedBy) -> EndedPath {
        let mut path = self.state.leave_path();
        path.track.assumed.undo(&mut path.control.memory);
        path.control.frames.clear();
        EndedPath {
            path,
            by,
            at: self.scratch.ending.at.take(),
            last: self.state.last.clone(),
        }
    }

    /// Resets the control after an error, without which the next program does not run (R1.28).
    pub(crate) fn reset_after_stop(&mut self) {
        let start_up = self.machine.compensation();
        let compensation = &self.state.control.compensation;
        let is_away = |axis: AxisIndex| {
            compensation.state(axis, Kind::Frict) != start_up.state(axis, Kind::Frict)
        };
        if (0..self.machine.axes.len())
            .map(AxisIndex::new)
            .any(is_away)
        {
            self.state.rests_on.insert(Question::Reset);
        }
        let changes = self.scratch.changes.len();
        self.reset_friction();
        self.scratch.changes.truncate(changes);
    }

    /// Returns the ways on which the channel is reset after the error, and those on which the control is restarted,
    /// where that leaves another state (R1.28, R1.29).
    fn sides_after(
        &mut self,
        ways: &WaySet,
        after: AfterError,
        at: &BlockContext<'_>,
    ) -> Vec<(WaySet, NextStart)> {
        let is_open = after == AfterError::ResetOrRestart
            && self.state.control.compensation != self.machine.compensation()
            && self.state.can_ask();
        if !is_open {
            return vec![(ways.clone(), NextStart::Reset)];
        }
        self.state.rests_on.insert(Question::Restart);
        let condition = self.state.ask_anew(Condition::new(
            ConditionKind::Restart,
            at.place(Span::new(0, at.text.trim_end().len())),
            vec![Arc::from("restarted")],
            Unknown::RemedyClass,
        ));
        let starts = [NextStart::Restart, NextStart::Reset];
        let answers = answers(condition, 2).map(|answer| ways.and(&WaySet::of(answer)));
        answers.zip(starts).collect()
    }
}

/// Action required between an error and the next program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NextStart {
    Reset,
    Restart,
}
