//! Questions that only the machine answers: the run parts there (R14.1). One of them is at which block a program is started (R2.96);
//! others are about what it shares with the PLC: variables (R2.99), and programs that only the machine has (R2.83).
//!
//! The PLC may write `V.E.` variables at any time. Until a block in which it acts by design, what the program wrote
//! answers conditions, and the other answer needs the variable to change in between. From that block on only the
//! machine knows the variable.

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, KindSet, Membership, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::block::{BlockContext, LastBlock};
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::options::Branches;
use crate::interpreter::programs::calls::WantedCall;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::stack::Seeking;
use crate::interpreter::values::externals::{HeldValues, SetAt};
use crate::interpreter::values::location::{Location, MissingProgram, Unknown};
use crate::interpreter::values::plain::{Asking, ConditionMeaning, Writer, read_of_machine};
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::history::HistorySide;
use crate::interpreter::ways::path::{AskedCondition, BranchSide, EarlierStates};
use crate::interpreter::ways::possible_state::ways_of;
use crate::interpreter::ways::question::{
    Condition, ConditionKind, ImpliedValues, KeptAnswer, MAX_ANSWERS, RememberedCondition,
    is_compared,
};
use crate::interpreter::ways::set::{WayAnswer, WaySet};
use crate::readings::{Alternative, Question};
use crate::syntax::ast::{CallScope, Operand};
use crate::syntax::{Fault, VariableName};
use crate::text::Span;

/// Most ways that are open at a time; beyond them they are joined (FC908).
pub(crate) const MAX_OPEN: usize = 400;

/// Most conditions that ways may name; beyond them a way does not tell its answers.
pub(crate) const MAX_CONDITIONS: usize = 4096;

/// Most conditions on values of the program whose answers are remembered; older ones are asked again.
const MAX_ASKED: usize = 64;

/// Number of questions at a place before its earlier answers are dropped.
const MAX_ROUNDS: u8 = 4;

/// A question to the machine.
pub(crate) struct MachineQuestion {
    pub(crate) kind: ConditionKind,
    pub(crate) span: Span,
    /// Text of the condition for each answer but the last.
    pub(crate) texts: Vec<Arc<str>>,
    pub(crate) cause: Unknown,
    /// Values that it reads, where that is plain.
    pub(crate) reads: Option<Asking>,
    /// The answer that what the program set gives.
    pub(crate) kept: Option<KeptAnswer>,
}

impl MachineQuestion {
    /// Returns the key of equal questions, if only the program writes the values that it reads.
    fn key(&self) -> Option<&Arc<ConditionMeaning>> {
        let asking = self.reads.as_ref();
        let asking = asking.filter(|asking| asking.writer == Writer::Nothing)?;
        Some(&asking.meaning)
    }
}

/// Block at which a way continues.
#[derive(Clone)]
pub(crate) struct Goal {
    pub(crate) to: EntryIndex,
    pub(crate) seeking: Option<Seeking>,
    /// Values that follow from the answer.
    pub(crate) values: Vec<(Location, Value)>,
    /// Values that the answer rules out.
    pub(crate) ruled_out: Vec<(Location, Value)>,
    /// The jump labels at which the way continues, where it may be any of them.
    pub(crate) labels: Option<Arc<[EntryIndex]>>,
}

impl Goal {
    fn says(&self) -> ImpliedValues {
        ImpliedValues {
            is: self.values.clone(),
            is_not: self.ruled_out.clone(),
        }
    }

    pub(crate) fn side(self, ways: WaySet) -> BranchSide {
        BranchSide {
            seeking: self.seeking,
            values: self.values,
            labels: self.labels,
            ..BranchSide::to(ways, self.to)
        }
    }

    /// Returns a block.
    pub(crate) fn block(to: EntryIndex) -> Self {
        Self {
            to,
            seeking: None,
            values: Vec::new(),
            ruled_out: Vec::new(),
            labels: None,
        }
    }

    /// Continues the way at any of the jump labels, which stand in the order of the text; `None` without a label.
    pub(crate) fn any(labels: Vec<EntryIndex>) -> Option<Self> {
        let first = *labels.first()?;
        Some(Self {
            labels: Some(labels.into()),
            ..Self::block(first)
        })
    }
}

/// Returns the answers to a condition, by their number.
pub(crate) fn answers(condition: u32, count: usize) -> impl Iterator<Item = WayAnswer> {
    let of = u8::try_from(count).unwrap_or(u8::MAX);
    (0..count).map(move |place| WayAnswer {
        condition,
        sides: 1 << place,
        of,
    })
}

impl Executor {
    /// Parts the run at a question: one way for each answer. A further question of a block is asked where the answers
    /// to those before it let the run go on. Returns whether it parts; it does not where one way is followed that the
    /// program itself decides, unless the PLC interferes.
    pub(crate) fn part(
        &mut self,
        question: MachineQuestion,
        mut goals: Vec<Goal>,
        at: &BlockContext<'_>,
    ) -> bool {
        if self.options.follows_one_way() && question.kept.is_some() {
            return false;
        }
        let is_unread = self.scratch.read.unread.get();
        let frames = &self.state.control.frames;
        if let Some((frame, entry)) = frames.running().zip(frames.entry()).filter(|_| is_unread)
            && self.programs.index(frame.unit).is_linked(entry)
        {
            self.pass_over_part(question.cause, question.span, at);
            return true;
        }
        self.offered.clear();
        let offers = self.options.branches == Branches::OneFollowed;
        if let Some(kept) = &question.kept
            && let Some(own) = goals.get_mut(kept.sides.trailing_zeros() as usize)
        {
            own.values.clear();
        }
        if offers && question.key().is_none() {
            // The next block that reads the value asks anew.
            for goal in &mut goals {
                goal.values.clear();
            }
        }
        if question.kind == ConditionKind::Loop {
            self.note_open_loop();
        }
        let answers = self.answers_to(question, &goals, at);
        let chosen = offers.then(|| self.chosen_among(&answers)).flatten();
        let own = self.state.control.frames.running().map(|frame| frame.next);
        let before = self.sides.iter().position(|side| Some(side.to) == own);
        let before = match before {
            Some(place) => self.sides.remove(place),
            None if self.sides.is_empty() => BranchSide::to(WaySet::always(), 0),
            None => return true,
        };
        let sides = goals.into_iter().zip(answers);
        let sides = sides.filter(|(_, ways)| chosen.as_ref().is_none_or(|chosen| chosen == ways));
        let sides = sides.map(|(goal, ways)| {
            let mut side = goal.side(before.ways.and(&ways));
            side.values.extend(before.values.iter().cloned());
            side
        });
        self.sides.extend(sides);
        true
    }

    /// Returns the ways on which each goal is reached. Beyond the number of answers that a question may have, the last
    /// one stands for all others; beyond that of conditions, the ways are not told apart.
    fn answers_to(
        &mut self,
        question: MachineQuestion,
        goals: &[Goal],
        at: &BlockContext<'_>,
    ) -> Vec<WaySet> {
        let count = goals.len().min(MAX_ANSWERS);
        if count < 2 || self.scratch.read.unread.get() || !self.state.can_ask() {
            return vec![WaySet::always(); goals.len()];
        }
        let question = MachineQuestion {
            texts: question.texts.into_iter().take(count - 1).collect(),
            ..question
        };
        // It is compared with those that were asked before.
        let known = 20 * self.state.conditions.len() as u64;
        self.state.work.charge_ways(known);
        let says = goals.iter().take(count).map(Goal::says).collect();
        let condition = self.ask(question, says, at);
        let mut ways: Vec<WaySet> = answers(condition, count).map(WaySet::of).collect();
        let last = ways.last().cloned().unwrap_or_else(WaySet::always);
        ways.resize(goals.len(), last);
        ways
    }

    /// Joins a loop whose own condition is not known at its head from the second pass on.
    fn note_open_loop(&mut self) {
        let frames = &self.state.control.frames;
        if let Some(program) = frames.program()
            && let Some(entry) = frames.entry()
        {
            let opener = self.programs.index(program.unit).links(entry).opener;
            let place = (frames.depth(), program.unit, opener);
            self.state.track.open_loops.insert(place);
        }
    }

    /// Returns the ways on which the program ends at the block, and those on which it goes on.
    pub(crate) fn part_at_end(
        &mut self,
        question: MachineQuestion,
        at: &BlockContext<'_>,
    ) -> [WaySet; 2] {
        self.state
            .work
            .charge_ways(1_000 + 20 * self.machine.axes.len() as u64);
        let reach = self.state.track.reach.clone();
        if !self.state.can_ask() {
            return [reach.clone(), reach];
        }
        let condition = self.ask(question, vec![ImpliedValues::default(); 2], at);
        let [ends, goes_on] = [1, 2].map(|sides| WayAnswer {
            condition,
            sides,
            of: 2,
        });
        let reach = &self.state.track.reach;
        [ends, goes_on].map(|answer| reach.and(&WaySet::of(answer)))
    }

    /// Returns the answer that was chosen beforehand, or that an earlier one implies; without either, offers the
    /// answers.
    fn chosen_among(&mut self, answers: &[WaySet]) -> Option<WaySet> {
        if self.state.track.is_shadow() {
            return None;
        }
        let reach = &self.state.track.reach;
        let mut possible = answers.iter().filter(|it| !reach.and(it).is_never());
        if let Some(only) = possible.next().filter(|_| possible.next().is_none()) {
            return Some(only.clone());
        }
        let chosen = self.chosen.pop_front();
        if let Some(chosen) = chosen.and_then(|place| answers.get(place)) {
            return Some(chosen.clone());
        }
        let ways = answers.iter().map(|it| ways_of(it, &self.state.conditions));
        self.offered = ways.flatten().flatten().collect();
        None
    }

    /// Returns the number of the condition that a question asks for.
    fn ask(
        &mut self,
        question: MachineQuestion,
        answers: Vec<ImpliedValues>,
        at: &BlockContext<'_>,
    ) -> u32 {
        let key = question.key().cloned();
        if let Some(key) = &key {
            let mut asked = self.state.track.asked.iter();
            if let Some(asked) = asked.find(|asked| asked.meaning == *key) {
                return asked.condition;
            }
            let mut asked = self.state.asked.iter();
            if let Some(asked) = asked.find(|asked| *asked.meaning == **key) {
                self.state.track.asked.push(asked.clone());
                return asked.condition;
            }
        }
        let condition = self.state.ask_anew(Condition::new(
            question.kind,
            at.place(question.span),
            question.texts,
            question.cause,
        ));
        self.keep_answer(condition, question.kept.as_ref());
        let track = &mut self.state.track;
        track.asked.retain(|asked| asked.condition != condition);
        if let Some(meaning) = key {
            if track.asked.len() >= MAX_ASKED {
                track.asked.remove(0);
            }
            let asked = AskedCondition { condition, meaning };
            if asked.reads_nothing() && self.state.asked.len() < MAX_ASKED {
                self.state.asked.push(asked.clone());
            }
            track.asked.push(asked);
        } else {
            self.compare(condition, (question.kind, question.reads), answers);
        }
        condition
    }

    /// Notes the answer that what the program set gives. Other ways may name the same condition as it was asked
    /// before.
    fn keep_answer(&mut self, condition: u32, kept: Option<&KeptAnswer>) {
        let is_alone = self.is_alone && self.state.ended.is_empty();
        let conditions = &mut self.state.conditions;
        if let Some(known) = conditions.get_mut(condition as usize) {
            let is_it = known.time == 0 || is_alone || known.kept.as_ref() == kept;
            known.kept = kept.filter(|_| is_it).cloned();
        }
    }

    /// Finds the answers that contradict earlier ones, unless the machine changes a value in between.
    fn compare(
        &mut self,
        condition: u32,
        (kind, asking): (ConditionKind, Option<Asking>),
        answers: Vec<ImpliedValues>,
    ) {
        let place = condition as usize;
        let is_own =
            |target: &Location| matches!(target, Location::Variable(name) if self.is_own(name));
        let asking = asking.as_ref();
        let asking = asking.filter(|asking| !asking.meaning.reads.iter().any(is_own));
        let is_again = self.state.is_asked_again(place);
        let RunState {
            track,
            conditions,
            ended,
            ..
        } = &mut self.state;
        let Some(known) = conditions.get_mut(place) else {
            return;
        };
        known.time = known.time.saturating_add(1);
        known.clashes.clear();
        if is_again || !is_compared(kind) {
            track.readings.wait_for(asking);
        }
        // Other ways may name the same condition as it was asked before.
        let is_alone = known.time == 1 || (self.is_alone && ended.is_empty());
        if let Some(asking) = asking.filter(|_| is_alone && is_compared(kind)) {
            let reading = RememberedCondition::of((condition, known.time), asking, answers);
            known.clashes = track.readings.ask(reading);
        }
    }

    /// Parts the states of a kind on the ways that lead here: a test of it tells them apart (R14.1).
    pub(crate) fn part_by_state(
        &mut self,
        (axis, kind): (AxisIndex, Kind),
        goals: [Goal; 2],
    ) -> bool {
        let Some(split) = self.state.control.history.states(axis, kind) else {
            return false;
        };
        let ways = [split.on.clone(), split.off.clone()];
        let states = [Membership::In, Membership::Out];
        let sides = goals.into_iter().zip(ways).zip(states);
        let sides = sides.map(|((goal, ways), state)| BranchSide {
            seeking: goal.seeking,
            values: goal.values,
            state: Some((axis, kind, state)),
            ..BranchSide::to(ways, goal.to)
        });
        self.sides = sides.collect();
        true
    }
}

impl RunState {
    /// Returns whether ways may name a further condition.
    pub(crate) fn can_ask(&self) -> bool {
        self.conditions.len() + 1 < MAX_CONDITIONS
    }

    /// Returns whether the condition was asked before at the same place, and its value not written since.
    fn is_asked_again(&self, place: usize) -> bool {
        let RunState {
            track, conditions, ..
        } = self;
        let Some(condition) = conditions.get(place) else {
            return false;
        };
        let mut asked = track.readings.conditions();
        asked.any(|it| {
            let other = conditions.get(it as usize);
            other.is_some_and(|other| other.is_like(condition))
        })
    }

    /// Returns the number of a condition of which no way knows the answer yet.
    pub(crate) fn ask_anew(&mut self, wanted: Condition) -> u32 {
        let condition = self.condition_at(wanted);
        self.track.reach.havoc(condition);
        self.control.history.havoc(condition);
        condition
    }

    /// Returns the condition of a question: a new one, or one of this place that no way names any more.
    fn condition_at(&mut self, mut wanted: Condition) -> u32 {
        let mut last = None;
        for (number, known) in (0..).zip(&self.conditions) {
            if !known.is_like(&wanted) {
                continue;
            }
            last = Some(number);
            wanted.round = wanted.round.max(known.round.saturating_add(1));
            let mut named = self.track.reach.conditions();
            let mut switched = self.control.history.conditions();
            let is_it = |it| it == number;
            if !(named.any(is_it) || switched.any(is_it)) {
                return number;
            }
        }
        if let Some(last) = last.filter(|_| wanted.round >= MAX_ROUNDS) {
            return last;
        }
        let number = u32::try_from(self.conditions.len()).unwrap_or(u32::MAX);
        self.conditions.push(wanted);
        number
    }
}

impl Executor {
    /// Returns whether the block at which the program is to be started was not reached yet.
    pub(crate) fn is_searching(&self) -> bool {
        self.state.track.searching.is_some()
    }

    /// Returns FC413: the program ended before the block at which it was to be started.
    pub(crate) fn missed_search(&self) -> Option<Diagnostic> {
        let wanted = self.options.search.filter(|_| self.is_searching())?;
        let start = || {
            let main = self.programs.units().first()?;
            Some(main.index.source.place(Span::new(0, 0)))
        };
        let last = self.state.last.as_ref().map(LastBlock::place);
        let place = last.or_else(start)?;
        let message = format!(
            "the program ends here without reaching {wanted}, at which it is to be started"
        );
        let said = Diagnostic::new(Code::Fc413, place, message).raised(Severity::Error);
        Some(said.with_help(
            "name a block that the main program executes, by its number or by its first line",
        ))
    }

    pub(crate) fn begin_search(&mut self) {
        if self.options.search.is_some() {
            let earlier = self.state.control.earlier_states();
            self.state.track.searching = Some(Box::new(earlier));
        }
    }

    /// Ends the search if the block is the searched one.
    #[cold]
    pub(crate) fn search(&mut self, at: &BlockContext<'_>) {
        if !self.options.search.is_some_and(|wanted| wanted.is(at)) {
            return;
        }
        let Some(before) = self.state.track.searching.take() else {
            return;
        };
        if !self.differing_since(&before).is_empty() {
            self.state.rests_on.insert(Question::BlockSearch);
        }
        match self.machine.readings.of(Question::BlockSearch) {
            Some(Alternative::First) => {}
            Some(Alternative::Second) => {
                let control = &mut self.state.control;
                control.compensation = before.compensation;
                control.history = before.history;
                self.version += 1;
            }
            None => self.search_either_way(&before, at),
        }
    }

    /// Continues with both readings of a block search.
    fn search_either_way(&mut self, before: &EarlierStates, at: &BlockContext<'_>) {
        let differing = self.differing_since(before);
        if differing.is_empty() {
            return;
        }
        for (axis, kind) in &differing {
            let said = self.open_search((*axis, *kind), before, at);
            self.scratch.messages.diagnostics.push(said);
        }
        self.version += 1;
        if !self.state.can_ask() {
            for (axis, kind) in differing {
                self.havoc(axis, KindSet::of(kind));
            }
            return;
        }
        let condition = self.state.ask_anew(Condition::new(
            ConditionKind::Search,
            at.place(Span::new(0, at.text.trim_end().len())),
            vec![Arc::from("executed")],
            Unknown::Search,
        ));
        self.join_earlier(condition, before);
    }

    /// Joins the states of an earlier block where a condition does not hold.
    pub(crate) fn join_earlier(&mut self, condition: u32, earlier: &EarlierStates) {
        let reach = &self.state.track.reach;
        let mut sides = answers(condition, 2).map(|answer| reach.and(&WaySet::of(answer)));
        let (Some(holds), Some(fails)) = (sides.next(), sides.next()) else {
            return;
        };
        let control = &mut self.state.control;
        let theirs = HistorySide {
            compensation: &earlier.compensation,
            history: &earlier.history,
            reach: &fails,
        };
        control
            .history
            .join(&mut control.compensation, &holds, &theirs);
        self.version += 1;
    }

    fn differing_since(&self, before: &EarlierStates) -> Vec<(AxisIndex, Kind)> {
        let now = &self.state.control.compensation;
        let axes = (0..self.machine.axes.len()).map(AxisIndex::new);
        let of_axis = |axis: AxisIndex| {
            let kinds = now.differing(&before.compensation, axis);
            let kinds = kinds.intersection(self.machine.axis(axis).configured);
            kinds
                .iter()
                .map(move |kind| (axis, kind))
                .collect::<Vec<_>>()
        };
        axes.flat_map(of_axis).collect()
    }

    /// Returns FC413: a state that depends on what the block search does.
    fn open_search(
        &self,
        (axis, kind): (AxisIndex, Kind),
        before: &EarlierStates,
        at: &BlockContext<'_>,
    ) -> Diagnostic {
        let name = &self.machine.axis(axis).name;
        let states = [&self.state.control.compensation, &before.compensation];
        let [executed, decoded]: [State; 2] = states.map(|it| it.state(axis, kind));
        let message = format!(
            "`{kind}` of axis `{name}` is {executed} here if the block search executes the COMP commands \
             that it passes, and {decoded} if it only decodes them"
        );
        let to = if matches!(executed, State::Active | State::Ineffective) {
            "ON"
        } else {
            "OFF"
        };
        Diagnostic::new(Code::Fc413, at.place(Span::new(0, at.text.trim_end().len())), message).with_help(format!(
            "the control's documents leave this open; repeat `{name}[COMP {to} {kind}]` after this block, or \
             check `V.A.{kind}_COMP_ACTIVE.{name}` before the start"
        ))
    }
}

/// A value that the program set and that decides a condition.
#[derive(Debug, Clone)]
pub(crate) struct KeptValue {
    /// The variables.
    pub(crate) names: Arc<[VariableName]>,
    /// The block that set it.
    pub(crate) set: SetAt,
    /// The value of the condition.
    pub(crate) value: Value,
}

/// Reason why a condition has more than one answer.
#[derive(Debug, Clone)]
pub(crate) enum Doubt {
    /// A value that only the machine knows.
    Unknown(Unknown),
    /// A value that the program set and that the PLC may change.
    Kept(KeptValue),
}

impl Doubt {
    /// Returns the doubt about a value that is not known.
    pub(crate) fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Unknown(cause) => Some(Self::Unknown(cause.clone())),
            Value::Number(_) | Value::Text(_) => None,
        }
    }

    /// Returns the value that decides.
    pub(crate) fn cause(&self) -> Unknown {
        match self {
            Self::Unknown(cause) => cause.clone(),
            Self::Kept(kept) => {
                let name = kept.names.first().map(ToString::to_string);
                Unknown::text(name.unwrap_or_default())
            }
        }
    }

    /// Returns the answer that the program set, by its place among the answers.
    pub(crate) fn kept_answer(&self, place: impl FnOnce(&Value) -> usize) -> Option<KeptAnswer> {
        let Self::Kept(kept) = self else {
            return None;
        };
        Some(KeptAnswer {
            names: kept.names.clone(),
            set: kept.set.clone(),
            sides: 1_u64.checked_shl(u32::try_from(place(&kept.value)).ok()?)?,
        })
    }
}

impl Executor {
    /// Returns whether the PLC may have to acknowledge an M or H function: all of which no list says that it does not,
    /// P-CHAN-00041, P-CHAN-00027.
    pub(crate) fn may_acknowledge(&self, letter: u8, number: Option<i64>) -> bool {
        let number = number.and_then(|number| u32::try_from(number).ok());
        let Some(number) = number.filter(|_| self.state.control.memory.holds_any()) else {
            return true;
        };
        let silent = &self.machine.channel.unacknowledged;
        let is_silent = silent.contains(&(letter, number)) && !(letter == b'M' && number < 2);
        // A program may set the kind of synchronisation (tf5200_m_and_h_func/285949579).
        let set = format!("V.G.{}_FCT[{number}].SYNCH", char::from(letter));
        let set = VariableName::read(&set);
        !is_silent || self.state.control.memory.variable(&set).is_some()
    }

    /// Returns whether the PLC acts by design at a word that may be executed: an M or H function but an end, a dwell.
    pub(crate) fn lets_plc_act_at(&self, letter: u8, number: Option<i64>) -> bool {
        match letter {
            b'M' if matches!(number, Some(2 | 17 | 29 | 30)) => false,
            b'M' | b'H' => self.may_acknowledge(letter, number),
            b'G' => number.is_none_or(|number| number == 4),
            _ => false,
        }
    }

    /// Lets the PLC act by design: every value that the program shares with it may be another one.
    #[inline]
    pub(crate) fn let_plc_act(&mut self) {
        let RunState { control, track, .. } = &self.state;
        if control.memory.holds_any() || !track.assumed.is_empty() {
            self.let_plc_write(|_| true);
            self.state.control.memory.end_initialisation();
        }
    }

    /// Lets the PLC write variables.
    #[cold]
    pub(crate) fn let_plc_write(&mut self, is_it: impl Fn(&VariableName) -> bool) {
        let RunState { control, track, .. } = &mut self.state;
        track.assumed.undo_external(&is_it, &mut control.memory);
        let changed = control.memory.let_change(is_it);
        let is_changed = |target: &Location| matches!(target, Location::Variable(name) if changed.contains(name));
        if !changed.is_empty() {
            track.readings.havoc(is_changed);
        }
    }

    /// Returns the value of a condition, and what the program set that decides it.
    pub(crate) fn asked_value(
        &mut self,
        condition: Operand,
        at: &BlockContext<'_>,
    ) -> Result<(Value, Option<Doubt>), Box<Fault>> {
        self.ask_anew(condition, at);
        let (value, mut relied) = self.value_with_reads(condition, at)?;
        if let Some(doubt) = Doubt::of(&value) {
            return Ok((value, Some(doubt)));
        }
        relied.retain(|name| self.state.control.memory.set_at(name).is_some());
        relied.sort_unstable();
        relied.dedup();
        let set = relied
            .iter()
            .filter_map(|name| self.state.control.memory.set_at(name));
        let Some(set) = set.min().cloned() else {
            return Ok((value, None));
        };
        let said = self.scratch.messages.diagnostics.len();
        self.scratch.read.held = HeldValues::Doubted;
        let doubted = self.value(condition, at);
        self.scratch.read.held = HeldValues::Taken;
        self.scratch.messages.diagnostics.truncate(said);
        let is_open = matches!(doubted, Ok(Value::Unknown(_)));
        let kept = is_open.then(|| {
            Doubt::Kept(KeptValue {
                names: relied.into(),
                set,
                value: value.clone(),
            })
        });
        Ok((value, kept))
    }

    /// Returns the value of the condition of a loop: the PLC may write the variables that it asks for.
    pub(crate) fn loop_value(
        &mut self,
        condition: Operand,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        if let Operand::Number(number) = condition {
            return Ok(Value::Number(number));
        }
        self.ask_anew(condition, at);
        let (value, relied) = self.value_with_reads(condition, at)?;
        if relied.is_empty() {
            return Ok(value);
        }
        self.state.control.memory.hold_initial(&relied);
        self.let_plc_write(|name| relied.iter().any(|it| it == name));
        self.value(condition, at)
    }

    /// Asks a condition on a value of the machine anew, which has another answer each time: what earlier conditions
    /// said of the values that this one asks for does not decide it (R14.1).
    fn ask_anew(&mut self, condition: Operand, at: &BlockContext<'_>) {
        let RunState { control, track, .. } = &mut self.state;
        if let Operand::Expression(expression) = condition
            && !track.assumed.is_empty()
        {
            let names = read_of_machine(at.block, at.text, expression, &self.externals);
            track.assumed.undo_of(&names, &mut control.memory);
        }
    }

    fn value_with_reads(
        &mut self,
        operand: Operand,
        at: &BlockContext<'_>,
    ) -> Result<(Value, Vec<VariableName>), Box<Fault>> {
        self.scratch.read.relied.get_mut().clear();
        let value = self.value(operand, at)?;
        Ok((value, self.scratch.read.relied.take()))
    }
}

impl Executor {
    /// Returns whether only the machine has the program.
    pub(crate) fn is_external(&self, wanted: &WantedCall) -> bool {
        wanted.word.is_some()
            || wanted.scope == CallScope::Global && self.machine.programs.is_external(&wanted.name)
    }

    /// Makes unknown what a program that only the machine has does not keep.
    pub(crate) fn leave_to_machine(&mut self, program: &MissingProgram) {
        let name = program.to_string();
        let keeps = self.machine.programs.keeps(&name);
        self.scratch.read.plc_acts = true;
        if !keeps.compensation {
            self.state.control.havoc_couplings();
            self.havoc_compensation();
        }
        if !keeps.parameters {
            // It writes the P parameters and variables of its caller (R2.33, R2.52).
            self.havoc_memory(&Unknown::Program(program.clone()));
        }
        self.state.control.modal.functions.perhaps_give_feeds();
        if !keeps.positions {
            self.state.control.modal.havoc_positions();
            self.perhaps_move_all();
            self.state.control.modal.note_transformed(&name);
        }
    }
}
