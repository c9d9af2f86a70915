//! What a motion requires: a feed (R2.110; TF5200 Diagnosis, error 20008), and the compensations of P-AXIS-00465 (R1.36).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::block::{AfterError, BlockContext, Feed};
use crate::interpreter::executor::Executor;
use crate::interpreter::options::StopPolicy;
use crate::interpreter::programs::calls::{Configured, FunctionWord};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::value::rounded;
use crate::interpreter::ways::history::Split;
use crate::interpreter::ways::possible_state::ways_of;
use crate::interpreter::ways::words::limit_to;
use crate::interpreter::words::refusal::StopScope;
use crate::language::{AxisWords, GFunction};
use crate::readings::Question;
use crate::syntax::Fault;
use crate::syntax::ast::{Address, Block, Item, Operand, Word};
use crate::text::Span;

/// Last sentence on a feed move without a feed (PM/206811147).
const PLC: &str = "unless the PLC gives the feed";

impl Executor {
    /// Looks for a feed move that has no feed, or the feed 0, and for a negative feed.
    #[inline]
    pub(crate) fn check_feed(&mut self, at: &BlockContext<'_>) {
        match self.scratch.actions.feed {
            Feed::Absent if self.state.control.modal.functions.may_lack_feed() => {
                self.move_without_feed(at);
            }
            Feed::Given(Some(feed)) if feed <= 0.0 => self.feed_not_positive(feed, at),
            Feed::Absent | Feed::Given(_) => {}
        }
    }

    /// The F word of the block is 0 or negative.
    #[cold]
    fn feed_not_positive(&mut self, feed: f64, at: &BlockContext<'_>) {
        let span = feed_word(at.block).unwrap_or(Span::new(0, at.text.trim_end().len()));
        if feed < 0.0 {
            let message = format!(
                "the feed `{feed}` is negative; what the control does with it is not documented"
            );
            let fault = Fault::new(Code::Fc327, at.in_block(span), message);
            self.scratch
                .messages
                .diagnostics
                .push(at.diagnostic(fault.with_help("write a feed above 0")));
        } else if self.moves_at_feed() {
            self.refuse_feed_of_zero(span, at);
        }
    }

    /// The block has no F word, and its mode of F may have no feed.
    #[cold]
    fn move_without_feed(&mut self, at: &BlockContext<'_>) {
        if !self.moves_at_feed() {
            return;
        }
        let first = self.scratch.moves.words().first();
        let span = first.map_or(Span::default(), |word| word.span);
        let functions = &self.state.control.modal.functions;
        if functions.programmed_feed().is_some() {
            self.refuse_feed_of_zero(span, at);
        } else if !self.position().runs_main_program() {
            // A subprogram runs with the feed of its caller.
            self.state.control.modal.functions.perhaps_give_feeds();
            return;
        } else {
            let is_certain = self.machine.channel.lacks_feed && functions.is_first_without_feed();
            let fault = if is_certain {
                let message = format!(
                    "the first feed move of the program has no feed: neither an `F` word nor the channel list \
                     gives one, and the control stops here {PLC}"
                );
                Fault::new(Code::PErr20008, span, message)
            } else {
                let message = format!(
                    "this feed move has no feed in the program; the control may refuse it (20008) {PLC}"
                );
                Fault::new(Code::Fc327, span, message)
            };
            let said = at.diagnostic(fault.with_help(
                "write `F` in this block or before it, or give the channel list a `prog_start.feedrate`",
            ));
            if is_certain {
                self.scratch.messages.diagnostics.push(said);
            } else {
                self.say_before_parting(said);
                self.perhaps_stop(
                    (Unknown::Refused(Some(20008)), StopScope::Rest),
                    at.in_block(span),
                    at,
                );
            }
        }
        self.state.control.modal.functions.give_feed();
    }

    /// FC327: the feed in force is 0.
    fn refuse_feed_of_zero(&mut self, span: Span, at: &BlockContext<'_>) {
        let message =
            format!("the feed of this move is 0; the control may refuse it (20008) {PLC}");
        let fault = Fault::new(Code::Fc327, at.in_block(span), message);
        self.say_before_parting(at.diagnostic(fault.with_help("write a feed above 0")));
        self.perhaps_stop(
            (Unknown::Refused(Some(20008)), StopScope::Rest),
            at.in_block(span),
            at,
        );
    }

    /// Whether the block moves along its axis words at the feed in force.
    fn moves_at_feed(&self) -> bool {
        self.scratch.actions.axis_words == AxisWords::Motion
            && self.state.control.described.is_none()
            && self.scratch.moves.is_at_feed(&self.state.control.modal)
            && !self.is_halted()
    }

    /// Whether a block that comes next, or a program that it calls, may be a feed move without a feed: what the control
    /// does then depends on how the text ends.
    #[inline]
    pub(crate) fn may_begin_without_feed(&self, block: &Block) -> bool {
        self.state.control.modal.functions.has_no_feed() && self.may_move_or_call(block)
    }

    #[inline(never)]
    fn may_move_or_call(&self, block: &Block) -> bool {
        if feed_word(block).is_some() {
            return false;
        }
        let moves = self.state.control.modal.functions.motion != 0;
        let is_feed_move = |it: i64| u32::try_from(it).is_ok_and(GFunction::is_feed_move);
        let is_call = |item: &Item| {
            matches!(item, Item::Call(_) | Item::Sequence(_) | Item::GCall(_))
                || moves && matches!(item, Item::Hash(_))
        };
        let calls = block.items.iter().any(is_call);
        calls
            || block.all_words().any(|word| {
                let number = match word.value {
                    Some(Operand::Number(number)) => rounded(number),
                    _ => None,
                };
                match word.address {
                    Address::Letter(b'G') if number.is_none_or(is_feed_move) => true,
                    Address::Letter(letter @ (b'G' | b'M' | b'T' | b'D')) => {
                        let word = FunctionWord { letter, number };
                        self.calls_by_words() && !matches!(self.configured(word), Configured::None)
                    }
                    Address::Letter(letter) => moves && self.axes().letter(letter).is_some(),
                    Address::Name(_) | Address::Main(_) => moves,
                    Address::Lower(_) => false,
                }
            })
    }
}

/// The place of the F word of a block.
fn feed_word(block: &Block) -> Option<Span> {
    let is_feed = |word: &&Word| word.address == Address::Letter(b'F');
    block.all_words().find(is_feed).map(|word| word.span)
}

impl Executor {
    /// Notes that it matters whether homing is monitored: G74 moves an axis without a compensation that it
    /// requires.
    fn note_homing(&mut self, words: AxisWords) {
        let compensation = &self.state.control.compensation;
        let lacks = |axis: AxisIndex| {
            let mut required = self.machine.axis(axis).monitored().iter();
            required.any(|kind| compensation.state(axis, kind) != State::Active)
        };
        if self.scratch.moves.homed(words).any(lacks) {
            self.state.rests_on.insert(Question::Homing);
        }
    }

    /// Notes that it matters whether a command acts before the motion of its block (R1.9).
    pub(crate) fn note_command_with_motion(&mut self) {
        let is_taken = self.scratch.outcomes.iter().any(|it| it.result.is_ok());
        if is_taken && !self.scratch.moves.words().is_empty() {
            self.state.rests_on.insert(Question::WithMotion);
        }
    }

    /// The state in which the block moves an axis (R1.9).
    fn state_in_motion(&self, axis: AxisIndex, kind: Kind) -> State {
        let mut changes = self.scratch.changes.iter();
        let first = changes.find(|change| (change.axis, change.kind) == (axis, kind));
        let is_after = self.machine.readings.takes_second(Question::WithMotion);
        match first.filter(|_| is_after) {
            Some(change) => change.from,
            None => self.state.control.compensation.state(axis, kind),
        }
    }

    /// P-ERR-70435: an axis moves without a compensation that it requires.
    pub(crate) fn check_required(&mut self, words: AxisWords, at: &BlockContext<'_>) {
        if !self.any_required {
            return;
        }
        let machine = Arc::clone(&self.machine);
        self.note_homing(words);
        let homing_counts = machine.readings.takes_second(Question::Homing);
        for (axis, span) in self.scratch.moves.certain(words, homing_counts) {
            let state = |kind| self.state_in_motion(axis, kind);
            let required = machine.axis(axis).monitored();
            let missing = required
                .iter()
                .find(|kind| !matches!(state(*kind), State::Active | State::Unknown));
            let name = &machine.axis(axis).name;
            let Some(kind) = missing else {
                if let Some(kind) = required.iter().find(|kind| state(*kind) == State::Unknown) {
                    if self.end_ways_without((axis, kind), span, at) {
                        continue;
                    }
                    let keyword = kind.as_str();
                    let message = format!(
                        "whether axis `{name}` moves with `{keyword}`, which P-AXIS-00465 requires, \
                         is not known offline; the rest assumes that it does"
                    );
                    let help = format!("set it before, with `{name}[COMP ON {keyword}]`");
                    let fault = Fault::new(Code::Fc902, span, message).with_help(help);
                    let diagnostic = at.diagnostic(fault).with_axis(name.clone());
                    self.scratch.messages.diagnostics.push(diagnostic);
                }
                continue;
            };
            let refused = moves_without(name, kind, span, at);
            self.scratch.messages.diagnostics.push(refused);
        }
    }

    /// P-ERR-70435 on some ways only: they end, and the others continue (R14.5). Returns whether that is so.
    #[cold]
    fn end_ways_without(
        &mut self,
        (axis, kind): (AxisIndex, Kind),
        span: Span,
        at: &BlockContext<'_>,
    ) -> bool {
        let mut changes = self.scratch.changes.iter();
        let is_switched = changes.any(|change| (change.axis, change.kind) == (axis, kind));
        let history = &self.state.control.history;
        let reach = &self.state.track.reach;
        let split = history.states(axis, kind).filter(|_| !is_switched);
        let Some(Split { on, off }) = split.map(|split| split.and(reach)) else {
            return false;
        };
        if on.is_never() || off.is_never() {
            return false;
        }
        let mut refused = moves_without(&self.machine.axis(axis).name, kind, span, at);
        limit_to(&mut refused, &ways_of(&off, &self.state.conditions));
        self.scratch.messages.of_some_ways.push(refused);
        self.stop_on(&off, AfterError::Reset, at);
        if self.options.stop != StopPolicy::KeepGoing {
            self.state.go_on_with(on);
        }
        true
    }
}

/// P-ERR-70435: an axis moves without a compensation that it requires.
fn moves_without(name: &str, kind: Kind, span: Span, at: &BlockContext<'_>) -> Diagnostic {
    let keyword = kind.as_str();
    let fault = Fault::new(
        Code::PErr70435,
        span,
        format!("axis `{name}` moves without `{keyword}`, which P-AXIS-00465 requires"),
    )
    .with_help(format!(
        "switch it on first, with `{name}[COMP ON {keyword}]`"
    ));
    at.diagnostic(fault).with_axis(name)
}
