//! The words and commands of a block that shape its motion, its pace, and what a motion requires: a feed (R2.110; TF5200 Diagnosis,
//! error 20008), and the compensations of P-AXIS-00465 (R1.36).

use std::sync::Arc;

use crate::comp::{AxisIndex, Coupling, Kind, State};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::axes::AxisLookup;
use crate::interpreter::block::{AfterError, BlockContext, Feed};
use crate::interpreter::coupling::gear_of;
use crate::interpreter::events::RefusedMotion;
use crate::interpreter::executor::Executor;
use crate::interpreter::motion::block::{BlockMotion, MotionSetting};
use crate::interpreter::motion::form::MovedAxis;
use crate::interpreter::motion::modal::Leaving;
use crate::interpreter::motion::pace::{Factors, SlopeSelection};
use crate::interpreter::options::StopPolicy;
use crate::interpreter::programs::calls::{Configured, FunctionWord};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::history::Split;
use crate::interpreter::ways::possible_state::ways_of;
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::limit_to;
use crate::interpreter::words::refusal::StopScope;
use crate::language::{
    AxisAction, AxisCommand, AxisWords, ChannelState, GFunction, Group, HashAction, Holds, Mode,
    Moves, Simplification,
};
use crate::readings::Question;
use crate::syntax::Fault;
use crate::syntax::ast::{
    Address, Argument, Block, BracketArguments, Hash, Item, Operand, SpindleWord, Word,
};
use crate::text::Span;

impl Executor {
    /// Executes a command in the bracket of an axis.
    pub(crate) fn move_by_bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let Some(axis) = self.axes().named(bracket.name) else {
            return;
        };
        let span = bracket.span;
        if bracket.command.action == AxisAction::EndFollowing {
            self.state.control.couplings.unfollow(&gear_of(axis));
        }
        let Some(row) = bracket.command.motion else {
            return;
        };
        self.check_alone(axis, bracket, at);
        self.see(axis);
        self.state.control.modal.havoc_position(axis);
        if row.moves == Moves::Follower {
            self.gear_in(axis, bracket.arguments, at);
            return;
        }
        self.scratch.moves.also_move(MovedAxis {
            axis,
            span,
            kind: row.kind,
            certainty: row.certainty,
        });
    }

    /// FC328: an axis moves by itself where the control does not admit it, or with a G function that it does not have
    /// there (TF5200 Diagnosis, page 253356939).
    fn check_alone(&mut self, axis: AxisIndex, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let AxisBracket { command, span, .. } = bracket;
        let takes_part = |state| match state {
            ChannelState::Coupling => self.state.control.couplings.of(axis) != Coupling::None,
            ChannelState::Frame => self.axes().xyz().contains(&axis),
            _ => true,
        };
        let mut states = command.refused.iter();
        let found = states
            .find(|(state, _)| self.state.control.is_in(*state) && takes_part(*state))
            .copied();
        if let Some((state, number)) = found {
            let what = format!("`{}` moves by itself {}", bracket.name, state.words());
            self.may_refuse_alike(number, &what, span, at);
        }
        let mut words = bracket.arguments.words(at.text);
        let other = words.find(|word| {
            let number = word.strip_prefix(['G', 'g']).and_then(|it| it.parse().ok());
            number.is_some_and(|number| !command.functions.contains(&number))
        });
        if let Some(function) = other
            && !command.functions.is_empty()
        {
            let what = format!("`{function}` is no function of an axis that moves by itself");
            self.may_refuse_alike(21068, &what, span, at);
        }
    }

    /// FC328: two of M3, M4, M5, M19 in the bracket of a spindle (TF5200 Diagnosis, page 250928523); others may be free
    /// (P-CHAN-00098).
    fn check_spindle(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let is_of_spindle = |word: &&SpindleWord| matches!(word, SpindleWord::M(3 | 4 | 5 | 19));
        if bracket.spindle.iter().filter(is_of_spindle).count() > 1 {
            let what = format!(
                "the bracket of `{}` has two functions of a spindle",
                bracket.name
            );
            self.may_refuse_alike(20155, &what, bracket.span, at);
        }
    }

    /// Executes a `#` command that moves axes at once.
    pub(crate) fn command_motion(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let row = hash.command.motion;
        let Some(row) = row.filter(|row| row.moves == Moves::NamedOrAll) else {
            return;
        };
        let named = self.axes().given(&hash.brackets, at.text);
        let axes = if named.is_empty() {
            self.axes().path()
        } else {
            named
        };
        for axis in axes {
            self.scratch.moves.also_move(MovedAxis {
                axis,
                span: hash.span,
                kind: row.kind,
                certainty: row.certainty,
            });
        }
    }

    /// Executes `#ROTATION ON [ANGLE=30]`: determines whether a motion along one axis of the plane certainly moves the
    /// other one, too.
    pub(crate) fn rotate(&mut self, arguments: &BracketArguments, at: &BlockContext<'_>) {
        let angle = arguments.after("ANGLE", at.text);
        let angle = angle.and_then(|angle| self.argument_number(angle, at));
        self.state.control.modal.skewed = angle.is_some_and(|angle| angle % 90.0 != 0.0);
    }

    /// Returns the motion of the block and the state it depends on.
    fn moves(&mut self) -> (&mut BlockMotion, MotionSetting<'_>) {
        let control = &self.state.control;
        let axes = AxisLookup {
            machine: &self.machine,
            own: &self.names,
            channel: &control.channel_axes,
        };
        let modal = &control.modal;
        (&mut self.scratch.moves, MotionSetting { axes, modal })
    }

    /// Notes the axes that move along with those that the block moves.
    #[inline]
    pub(crate) fn carry_along(&mut self, words: AxisWords) {
        let control = &self.state.control;
        let carries = control.couplings.carry()
            || !control.modal.transformed.is_empty()
            || control.modal.leaving != Leaving::Done
            || !control.modal.punched().is_empty()
            || self.scratch.moves.row().is_some();
        if carries && control.described.is_none() {
            self.carry(words);
        }
    }

    #[inline(never)]
    fn carry(&mut self, words: AxisWords) {
        let (moves, setting) = self.moves();
        if words.move_axes() {
            moves.punch(setting.modal.punched());
        }
        let is_leaving = setting.modal.leaving != Leaving::Done;
        if is_leaving && !setting.modal.modes.has(Mode::LeavesWithMotion) {
            // The control inserts a motion at G40 with G237; what it does with G238 and G239 is not documented.
            let plane = setting.axes.plane(setting.modal);
            for axis in plane {
                moves.perhaps_move(axis);
            }
        }
        moves.move_others(words, setting);
        let couplings = &self.state.control.couplings;
        if couplings.carry() && self.scratch.moves.leads(words) {
            let links = couplings.links();
            // R2.60: groups may be many.
            self.state.work.charge(ITEM * links.len());
            self.scratch.moves.move_followers(words, &links);
        }
    }

    /// Executes I, J, K or R of a circle.
    pub(crate) fn circle_word(&mut self, letter: u8, value: Option<f64>, span: Span) {
        let metric = self.state.control.modal.is_known(Group::Unit);
        let inch = self.state.control.modal.functions.inch;
        let value = value.filter(|_| metric);
        let value = value.map(|value| if inch { value * 25.4 } else { value });
        let geometry = self.scratch.moves.geometry();
        geometry.span.get_or_insert(span);
        match letter {
            b'R' => geometry.radius = Some(value),
            _ => geometry.centre[usize::from(letter.saturating_sub(b'I')).min(2)] = Some(value),
        }
    }

    /// Notes the axes that a circle moves.
    #[inline]
    pub(crate) fn move_around(&mut self, words: AxisWords) {
        let turns = self.state.control.modal.functions.is_arc();
        if (turns || self.scratch.moves.has_geometry()) && words == AxisWords::Motion {
            let (moves, setting) = self.moves();
            let added = moves.move_around(turns, setting);
            added.into_iter().flatten().for_each(|axis| self.see(axis));
        }
    }

    /// Executes `G04 P1`: the parameter holds the seconds (PM/206132747).
    pub(crate) fn dwell_parameter(&mut self, index: Option<f64>) {
        let index = index
            .and_then(rounded)
            .and_then(|index| u32::try_from(index).ok());
        let value = index.and_then(|index| self.state.control.memory.parameter(index));
        let seconds = value.and_then(|value| value.number());
        self.scratch.moves.geometry().dwell = Some(seconds);
    }

    /// Creates the motion of the block, which started at `from`.
    pub(crate) fn take_motion(&mut self, from: Option<Vec<Option<f64>>>, words: AxisWords) {
        if let Some(radius) = self.scratch.moves.radius() {
            // The radius is modal (PM, radius programming).
            self.state.control.modal.radius = radius;
        }
        let is_taken = self.options.takes_motions();
        let (moves, setting) = self.moves();
        moves.travel(from, words, setting, is_taken);
    }
}

/// An override in percent, where it is in the documented range (PM/207625099).
const OVERRIDE: std::ops::RangeInclusive<f64> = 0.1..=200.0;

/// The keywords of an override.
const FEED: &str = "FEED_FACT";
const RAPID: &str = "RAPID_FACT";

/// A command in the bracket of an axis or spindle.
#[derive(Clone, Copy)]
pub(crate) struct AxisBracket<'a> {
    /// The name before the bracket.
    pub(crate) name: &'a str,
    pub(crate) command: AxisCommand,
    pub(crate) arguments: &'a BracketArguments,
    pub(crate) spindle: &'a [SpindleWord],
    /// The whole of it.
    pub(crate) span: Span,
}

impl Executor {
    /// Notes a command that a commanded trace does not follow in full.
    pub(crate) fn simplify(&mut self, what: Simplification, holds: Holds) {
        if holds == Holds::Once {
            let geometry = self.scratch.moves.geometry();
            geometry.simplified = geometry.simplified.union(what.into());
        } else {
            self.state.control.modal.simplify(what, holds);
        }
    }

    /// Executes `G163=50`: the radius of circles, as R (R2.45). Returns whether there is a value.
    pub(crate) fn radius_word(&mut self, span: Span, at: &BlockContext<'_>) -> bool {
        let Some(value) = at.block.second_value(span) else {
            return false;
        };
        let radius = self.operand_number(value, at);
        self.circle_word(b'R', radius, span);
        true
    }

    /// Executes `G129=70` (PM/206578955).
    pub(crate) fn weigh_rapid(&mut self, span: Span, at: &BlockContext<'_>) {
        let value = at.block.second_value(span);
        let percent = value.and_then(|value| self.operand_number(value, at));
        let weight = percent.filter(|it| *it > 0.0).map(|it| it / 100.0);
        self.state.control.modal.pace.weigh_rapid(weight);
    }

    /// Applies a `#` command that changes the velocity of paths.
    pub(crate) fn pace_command(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let (command, arguments) = (hash.command, &hash.brackets);
        match command.action {
            HashAction::Override => {
                let change = self.factors_in(arguments, at);
                self.state.control.modal.pace.override_path(change);
            }
            HashAction::SelectSpindle => self.state.control.modal.pace.havoc_spindle(),
            HashAction::Round(command) => {
                let before = *self.state.control.modal.contouring_of(command);
                let number = |argument: &Argument| self.argument_number(argument, at);
                let next = command.parameters(before, (arguments, at.text), number);
                *self.state.control.modal.contouring_of(command) = next;
            }
            HashAction::SelectSlope(form) => {
                let number = |argument: &Argument| self.argument_number(argument, at);
                let selected = SlopeSelection::of(form, (arguments, at.text), number);
                if let Some(selected) = selected {
                    self.state.control.modal.select_slope(selected);
                    return;
                }
            }
            _ => {}
        }
        if let Some((what, holds)) = command.simplification() {
            self.simplify(what, holds);
        }
    }

    /// Executes a command in the bracket of an axis or spindle, `X[OVERRIDE FEED_FACT=20]`, `S[REV1200 M3]`.
    pub(crate) fn bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let AxisBracket { name, command, .. } = bracket;
        let axis = self.axes().named(name);
        if name.starts_with('S') && axis.is_none() {
            self.check_spindle(bracket, at);
            if self.axes().is_main_spindle(name) {
                self.spindle_words(bracket.spindle, at);
            } else if self.machine.channel.main_spindle.is_empty() {
                // It may be the main spindle under its own name.
                self.state.control.modal.pace.havoc_spindle();
            }
            return;
        }
        let Some(axis) = axis else {
            return;
        };
        if command.action == AxisAction::Override {
            let change = self.factors_in(bracket.arguments, at);
            self.state.control.modal.pace.override_axis(axis, change);
        }
        if let Some(what) = command.simplifies {
            self.simplify(what, Holds::On);
        }
    }

    /// Executes the words in the bracket of the main spindle.
    fn spindle_words(&mut self, words: &[SpindleWord], at: &BlockContext<'_>) {
        for word in words {
            match *word {
                SpindleWord::Speed(speed) => {
                    let speed = speed.and_then(|speed| self.operand_number(speed, at));
                    self.state.control.modal.pace.speed(speed);
                }
                SpindleWord::M(number) => self.state.control.modal.pace.m(number),
            }
        }
    }

    /// Returns the factors in the bracket of an override.
    fn factors_in(
        &mut self,
        arguments: &BracketArguments,
        at: &BlockContext<'_>,
    ) -> impl FnOnce(&mut Factors) + use<> {
        let [feed, rapid] = [FEED, RAPID].map(|key| {
            let percent = self.argument_number(arguments.after(key, at.text)?, at);
            let known = percent.filter(|it| OVERRIDE.contains(it));
            Some(known.map(|it| it / 100.0))
        });
        let is_understood = feed.is_some() || rapid.is_some();
        move |factors| {
            factors.feed = feed.unwrap_or(factors.feed.filter(|_| is_understood));
            factors.rapid = rapid.unwrap_or(factors.rapid.filter(|_| is_understood));
        }
    }
}

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

    /// Reports an F word of the block that is 0 or negative.
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

    /// Reports a block without F word whose mode of F may have no feed.
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

    /// Reports FC327: the feed in force is 0.
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

    /// Returns whether the block moves along its axis words at the feed in force.
    fn moves_at_feed(&self) -> bool {
        self.scratch.actions.axis_words == AxisWords::Motion
            && self.state.control.described.is_none()
            && self.scratch.moves.is_at_feed(&self.state.control.modal)
            && !self.is_halted()
    }

    /// Returns whether a block that comes next, or a program that it calls, may be a feed move without a feed: what the
    /// control does then depends on how the text ends.
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

/// Returns the place of the F word of a block.
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

    /// Returns the state in which the block moves an axis (R1.9).
    fn state_in_motion(&self, axis: AxisIndex, kind: Kind) -> State {
        let mut changes = self.scratch.changes.iter();
        let first = changes.find(|change| (change.axis, change.kind) == (axis, kind));
        let is_after = self.machine.readings.takes_second(Question::WithMotion);
        match first.filter(|_| is_after) {
            Some(change) => change.from,
            None => self.state.control.compensation.state(axis, kind),
        }
    }

    /// Reports P-ERR-70435: an axis moves without a compensation that it requires.
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
            let reach = self.state.track.reach.clone();
            self.note_refused((axis, kind), &reach);
        }
    }

    /// Notes that a motion is refused on some ways that lead to the block, where the program did not switch the
    /// compensation that it lacks.
    #[cold]
    fn note_refused(&mut self, (axis, lacks): (AxisIndex, Kind), ways: &WaySet) {
        let control = &self.state.control;
        let found = control.history.found((axis, lacks), ways).and(ways);
        if !found.is_never() {
            self.scratch.aside.refused.push(RefusedMotion {
                axis,
                lacks,
                motion: self.scratch.moves.kind_of(axis, &control.modal),
                ways: ways_of(&found, &self.state.conditions),
            });
        }
    }

    /// Reports P-ERR-70435 on some ways only: they end, and the others continue (R14.5). Returns whether that is so.
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
        self.note_refused((axis, kind), &off);
        self.stop_on(&off, AfterError::Reset, at);
        if self.options.stop != StopPolicy::KeepGoing {
            self.state.go_on_with(on);
        }
        true
    }
}

/// Returns P-ERR-70435: an axis moves without a compensation that it requires.
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
