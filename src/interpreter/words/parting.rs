//! The questions of blocks to the machine, and the target of each answer (R14.1); one of them is the signal of a probe (R2.91).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind};
use crate::diagnostic::Code;
use crate::interpreter::block::{AfterError, BlockContext, ShownBlockLines};
use crate::interpreter::control::ControlState;
use crate::interpreter::events::{Note, NoteKind, Notes};
use crate::interpreter::executor::Executor;
use crate::interpreter::programs::index::{EntryIndex, JumpAcross, LabelName, Links};
use crate::interpreter::programs::store::Parsed;
use crate::interpreter::stack::Seeking;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::plain::{
    Asking, ConditionSubject, Truth, Writer, conclusions, is_one_comparison, reads, text_of,
    variable,
};
use crate::interpreter::values::value::{Value, same_case};
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::path::Marked;
use crate::interpreter::ways::question::{ConditionKind, MAX_ANSWERS};
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::words::flow::{is_reported, missing_label};
use crate::interpreter::words::questions::{Doubt, Goal, MachineQuestion};
use crate::interpreter::words::refusal::StopScope;
use crate::language::GFunction;
use crate::readings::Question as Open;
use crate::syntax::Fault;
use crate::syntax::ast::{Address, Block, BlockReference, Expression, Flow, Item, Operand};
use crate::text::{Place, Span};

/// Target of the jump of a condition.
enum ConditionalJump {
    /// No jump, or one that is reported before the program begins.
    Nowhere,
    /// Jump to a label that does not exist.
    Missing(LabelName, Span),
    To(Goal, Span),
}

impl Executor {
    /// Parts the run at a condition: where it holds and where it does not. Returns whether it can be parted.
    pub(crate) fn part_at(
        &mut self,
        condition: Operand,
        doubt: &Doubt,
        (kind, span): (ConditionKind, Span),
        goals: [Goal; 2],
        at: &BlockContext<'_>,
    ) -> bool {
        let Operand::Expression(expression) = condition else {
            return false;
        };
        let tested = self.tested_state(condition, at);
        if let Some((of, truth)) = tested {
            let sides = match truth {
                Truth::Holds => goals.clone(),
                Truth::Fails => {
                    let [yes, no] = goals.clone();
                    [no, yes]
                }
            };
            if self.part_by_state(of, sides) {
                return true;
            }
        }
        let [mut yes, mut no] = goals;
        for (goal, truth) in [(&mut yes, Truth::Holds), (&mut no, Truth::Fails)] {
            let found = conclusions(at.block, at.text, expression, truth);
            goal.values.extend(
                found
                    .into_iter()
                    .filter(|(target, _)| self.may_conclude(target)),
            );
        }
        if is_one_comparison(at.block, at.text, expression) {
            yes.ruled_out.clone_from(&no.values);
            no.ruled_out.clone_from(&yes.values);
        }
        let question = self.question_of(expression, doubt, (kind, span), at);
        self.part(question, vec![yes, no], at)
    }

    /// Returns the question whether a condition holds.
    fn question_of(
        &self,
        condition: Expression,
        doubt: &Doubt,
        (kind, span): (ConditionKind, Span),
        at: &BlockContext<'_>,
    ) -> MachineQuestion {
        let (text, place) = text_of(at.block, at.text, condition);
        MachineQuestion {
            kind,
            span: if kind == ConditionKind::Loop {
                span
            } else {
                place
            },
            texts: vec![text.into()],
            cause: doubt.cause(),
            reads: reads(at.block, at.text, condition, &self.externals),
            kept: doubt.kept_answer(|value| match value.truth() {
                Some(true) => 0,
                _ => 1,
            }),
        }
    }

    /// Returns the state that a condition asks for, where it is unknown because ways differ.
    fn tested_state(
        &self,
        condition: Operand,
        at: &BlockContext<'_>,
    ) -> Option<((AxisIndex, Kind), Truth)> {
        let Operand::Expression(expression) = condition else {
            return None;
        };
        for truth in [Truth::Holds, Truth::Fails] {
            if let [(Location::Variable(name), Value::Number(number))] =
                conclusions(at.block, at.text, expression, truth).as_slice()
                && let Some(of) = self.active_variable(name)
                && self.state.control.is_effective(of)
                && let Some(says) = Truth::of_switch(*number)
            {
                return Some((
                    of,
                    if truth == Truth::Holds {
                        says
                    } else {
                        says.turned()
                    },
                ));
            }
        }
        None
    }

    /// Returns whether a condition may say what a value is: one that the program and the machine hold, and that does
    /// not follow from something else.
    fn may_conclude(&self, target: &Location) -> bool {
        match target {
            Location::Variable(name) => !name.family().is_of_level() && !self.is_own(name),
            Location::Parameter(owner, _) => *owner == crate::syntax::ast::Owner::Program,
            Location::Elements(_) | Location::Parameters => false,
        }
    }

    /// Parts the run in the same way where the counter of a `$FOR` decides.
    pub(crate) fn part_at_count(
        &mut self,
        (cause, statement): (&Unknown, &str),
        span: Span,
        goals: [Goal; 2],
        at: &BlockContext<'_>,
    ) -> bool {
        let question = MachineQuestion {
            kind: ConditionKind::Loop,
            span,
            texts: vec![statement.into()],
            cause: cause.clone(),
            reads: None,
            kept: None,
        };
        self.part(question, goals.into(), at)
    }

    /// Parts the run at `$IF … $GOTO`.
    pub(crate) fn part_at_jump(
        &mut self,
        condition: Operand,
        doubt: &Doubt,
        place: Span,
        at: &BlockContext<'_>,
    ) -> bool {
        let next = self.position().next_block();
        let (goal, span) = match self.jump_after(place, at) {
            ConditionalJump::To(goal, span) => (goal, span),
            ConditionalJump::Missing(label, span) => {
                if let Operand::Expression(condition) = condition {
                    let asked = (ConditionKind::Branch, span);
                    let question = self.question_of(condition, doubt, asked, at);
                    let said = at.diagnostic(missing_label(&label, span));
                    self.refused_where(question, said, AfterError::Reset, at);
                }
                return true;
            }
            ConditionalJump::Nowhere => return true,
        };
        let asked = (ConditionKind::Branch, span);
        let across = if goal.labels.is_none() {
            self.position().jump_across(goal.to)
        } else {
            JumpAcross::Nothing
        };
        match (across, condition) {
            (JumpAcross::WithinLoop, Operand::Expression(condition)) => {
                let question = self.question_of(condition, doubt, asked, at);
                let what = "this jump stays within its loop, which the control refuses";
                let said = at.diagnostic(*Fault::refused(Code::PErr21480, span, what));
                self.refused_where(question, said, AfterError::Reset, at);
                return true;
            }
            (JumpAcross::Nothing, _) => {}
            _ => _ = self.check_jump(goal.to, span, at),
        }
        self.part_at(condition, doubt, asked, [goal, Goal::block(next)], at)
    }

    /// Parts the run at a `$IF … $GOTO` whose condition cannot be computed.
    pub(crate) fn part_at_undecided_jump(
        &mut self,
        (cause, place): (Unknown, Span),
        at: &BlockContext<'_>,
    ) {
        if let Some((goal, span)) = self.possible_jump(place, at) {
            let goals = vec![goal, Goal::block(self.position().next_block())];
            let texts = vec![span.of(at.text).trim().into()];
            self.part_by_cause(ConditionKind::Branch, (cause, span), (goals, texts), at);
        }
    }

    /// Parts the run at a question of which only the value that decides is known.
    fn part_by_cause(
        &mut self,
        kind: ConditionKind,
        (cause, span): (Unknown, Span),
        (goals, texts): (Vec<Goal>, Vec<Arc<str>>),
        at: &BlockContext<'_>,
    ) {
        let question = MachineQuestion {
            kind,
            span,
            texts,
            cause,
            reads: None,
            kept: None,
        };
        self.part(question, goals, at);
    }

    /// Parts the run at a `$SWITCH` whose cases are not known, or at such a case: it may go on at each of them.
    pub(crate) fn part_at_unknown_case(
        &mut self,
        flow: &Flow,
        (cause, span): (Unknown, Span),
        at: &BlockContext<'_>,
    ) {
        let next = self.position().next_block();
        let entry = next.saturating_sub(1);
        let Some(unit) = self.state.control.frames.running().map(|frame| frame.unit) else {
            return;
        };
        let links = self.programs.index(unit).links(entry);
        let sides = match flow {
            Flow::Case(_) => {
                let mut other = Goal::block(links.next);
                let frame = self.state.control.frames.running_mut();
                other.seeking = frame.and_then(|frame| frame.seeking.take());
                let wanted = match &other.seeking {
                    Some(Seeking::Case(wanted)) => wanted.as_written(),
                    _ => String::new(),
                };
                let text = compared(&wanted, flow, (at.block, at.text));
                (vec![Goal::block(next), other], vec![text])
            }
            Flow::Switch(_, operand) => {
                let subject = operand_text(*operand, (at.block, at.text));
                self.each_case(unit, links, &subject)
            }
            _ => return,
        };
        self.part_by_cause(ConditionKind::Case, (cause, span), sides, at);
    }

    /// Returns the blocks of the cases of a `$SWITCH`, whichever values they have, each with its name, and the block
    /// after it.
    fn each_case(
        &mut self,
        unit: usize,
        switch: Links,
        subject: &str,
    ) -> (Vec<Goal>, Vec<Arc<str>>) {
        let mut goals = Vec::new();
        let mut texts = Vec::new();
        let mut entry = switch.next;
        let mut after = switch.end;
        while entry < switch.end {
            let parsed = self.programs.parsed(unit, entry);
            let mut items = parsed.block.items.iter();
            let flow = items.find_map(|item| match item {
                Item::Flow(flow, _) => Some(flow),
                _ => None,
            });
            let Some(case @ Flow::Case(_)) = flow else {
                after = entry;
                break;
            };
            goals.push(Goal::block(entry + 1));
            texts.push(compared(subject, case, (&parsed.block, &parsed.text)));
            let next = self.programs.index(unit).links(entry).next;
            if next <= entry {
                break;
            }
            entry = next;
        }
        goals.push(Goal::block(after));
        (goals, texts)
    }

    /// Returns whether the jump after a condition goes back, so that its condition is that of a loop.
    pub(crate) fn jumps_back(&mut self, place: Span, at: &BlockContext<'_>) -> bool {
        let next = self.position().next_block();
        let jump = self.jump_after(place, at);
        matches!(jump, ConditionalJump::To(goal, _) if goal.labels.is_none() && goal.to < next)
    }

    /// Parts the run where a jump computes its target: one way for each label that it may mean.
    pub(crate) fn part_at_target(
        &mut self,
        target: &BlockReference,
        cause: &Unknown,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let expression = match *target {
            BlockReference::Number(Operand::Expression(number)) => number,
            BlockReference::Variable(variable) => variable,
            BlockReference::Number(Operand::Number(_)) | BlockReference::Label(_) => return,
        };
        let Some(frame) = self.state.control.frames.running() else {
            return;
        };
        let index = self.programs.index(frame.unit);
        let Some(mut labels) = index.few_labels(frame.section, MAX_ANSWERS) else {
            if let Some(goal) = Goal::any(index.labels(frame.section).collect()) {
                self.sides.push(goal.side(WaySet::always()));
                self.tell_any_label(cause, span, at);
            }
            return;
        };
        if labels.is_empty() {
            return;
        }
        self.state.work.charge_reading(ITEM * labels.len());
        if matches!(target, BlockReference::Number(_)) {
            labels.retain(|(name, _)| matches!(name, LabelName::Number(_)));
        }
        let (subject, place) = text_of(at.block, at.text, expression);
        let goals = labels
            .iter()
            .map(|(_, entry)| Goal::block(*entry))
            .collect();
        labels.pop();
        let texts: Vec<Arc<str>> = labels
            .iter()
            .map(|(name, _)| match name {
                LabelName::Number(number) => format!("{subject} == {number}").into(),
                LabelName::Text(text) => format!("{subject} == \"{text}\"").into(),
            })
            .collect();
        let asking = reads(at.block, at.text, expression, &self.externals);
        let question = MachineQuestion {
            kind: ConditionKind::Jump,
            span: if place.end > place.start { place } else { span },
            cause: cause.clone(),
            reads: asking.map(|asking| asking.about(ConditionSubject::Cases(texts.clone()))),
            texts,
            kept: None,
        };
        self.part(question, goals, at);
    }

    /// Reports FC902: a jump that may go to any label of its program, on ways that are not told apart.
    fn tell_any_label(&mut self, cause: &Unknown, span: Span, at: &BlockContext<'_>) {
        if self.scratch.read.unread.get() {
            return;
        }
        let message = format!(
            "where this jump goes depends on {}; it may be any label of the program",
            cause.seen_from(at.file)
        );
        let fault = Fault::new(Code::Fc902, span, message).with_help(cause.advice());
        self.tell_once(cause, "label", fault, at);
    }

    /// Parts the run where a probe answers, or does not (R2.91).
    pub(crate) fn part_at_probe(&mut self, place: Span, at: &BlockContext<'_>) {
        let Some((goal, span)) = self.possible_jump(place, at) else {
            return;
        };
        let question = MachineQuestion {
            kind: ConditionKind::Probe,
            span,
            texts: vec!["the probe answers".into()],
            cause: Unknown::Probe,
            reads: None,
            kept: None,
        };
        let goals = vec![goal, Goal::block(self.position().next_block())];
        self.part(question, goals, at);
    }

    /// Parts the run at an M function of which only the machine knows the number: it may end the program or return from
    /// it.
    pub(crate) fn part_at_unknown_m(&mut self, span: Span, at: &BlockContext<'_>) {
        let question = |what: &str| MachineQuestion {
            kind: ConditionKind::Stop,
            span,
            texts: vec![what.into()],
            cause: Unknown::text("M"),
            reads: None,
            kept: None,
        };
        let [ends, goes_on] = self.part_at_end(question("M"), at);
        self.end_on(ends, at);
        self.state.go_on_with(goes_on);
        let running = self.state.control.frames.running();
        if let Some(frame) = running.filter(|frame| frame.level > 0) {
            let end = self.programs.section(frame.program()).end;
            let goals = [end, frame.next].map(Goal::block);
            self.part(question("M returns"), goals.into(), at);
        }
    }

    /// Returns the jump at a place of a block or after it, before its next condition; `None` where its label does not
    /// exist.
    fn jump_after(&mut self, place: Span, at: &BlockContext<'_>) -> ConditionalJump {
        let mut items = at.block.items.iter();
        let after = items
            .by_ref()
            .skip_while(|item| item.span().start < place.start);
        let mut is_first = true;
        let mut jump = None;
        for item in after {
            match item {
                Item::Flow(Flow::Goto(target), span) => {
                    jump = Some((*target, *span));
                    break;
                }
                Item::Flow(Flow::If(_), _) if !is_first => break,
                _ => {}
            }
            is_first = false;
        }
        let Some((target, span)) = jump else {
            return ConditionalJump::Nowhere;
        };
        let value = match target {
            BlockReference::Label(name) => Ok(Value::Text(name.of(at.text).into())),
            BlockReference::Number(operand) => self.value(operand, at),
            BlockReference::Variable(place) => self.value(Operand::Expression(place), at),
        };
        let (Ok(value), Some(frame)) = (value, self.state.control.frames.running()) else {
            return ConditionalJump::Nowhere;
        };
        let index = self.programs.index(frame.unit);
        let label = match value {
            Value::Number(number) => LabelName::numbered(number),
            Value::Text(name) => LabelName::Text(name.trim_matches(['[', ']']).to_owned()),
            Value::Unknown(_) => {
                let any = Goal::any(index.labels(frame.section).collect());
                return any.map_or(ConditionalJump::Nowhere, |goal| {
                    ConditionalJump::To(goal, span)
                });
            }
        };
        match index.label(frame.section, label.clone()) {
            Some(entry) => ConditionalJump::To(Goal::block(entry), span),
            None if is_reported(target, at) => ConditionalJump::Nowhere,
            None => ConditionalJump::Missing(label, span),
        }
    }

    /// Returns the jump after a condition of which the answer does not say what it is about: a missing label may end
    /// the program.
    fn possible_jump(&mut self, place: Span, at: &BlockContext<'_>) -> Option<(Goal, Span)> {
        match self.jump_after(place, at) {
            ConditionalJump::To(goal, span) => Some((goal, span)),
            ConditionalJump::Missing(_, span) => {
                self.perhaps_stop((Unknown::MissingLabel, StopScope::Block), span, at);
                None
            }
            ConditionalJump::Nowhere => None,
        }
    }

    /// Parts the run at a `$SWITCH`: one way for each case, and one for everything else.
    pub(crate) fn part_at_cases(
        &mut self,
        operand: Operand,
        doubt: &Doubt,
        span: Span,
        at: &BlockContext<'_>,
    ) -> bool {
        let Operand::Expression(expression) = operand else {
            return false;
        };
        let Some((cases, mut other)) = self.cases(at) else {
            return false;
        };
        let (subject, place) = text_of(at.block, at.text, expression);
        let mut goals = Vec::with_capacity(cases.len() + 1);
        let mut texts: Vec<Arc<str>> = Vec::with_capacity(cases.len());
        let asking = reads(at.block, at.text, expression, &self.externals);
        let subject_of = variable(at.block, at.text, expression);
        let subject_of = subject_of.filter(|target| self.may_conclude(target));
        let kept = doubt.kept_answer(|value| {
            let case = cases.iter().position(|(_, case)| same_case(case, value));
            case.unwrap_or(cases.len())
        });
        for (entry, value) in cases {
            texts.push(format!("{subject} == {}", value.as_written()).into());
            let values: Vec<_> = subject_of.iter().cloned().zip([value.clone()]).collect();
            other.ruled_out.extend(values.iter().cloned());
            goals.push(Goal {
                values,
                seeking: Some(Seeking::Case(value)),
                ..Goal::block(entry)
            });
        }
        goals.push(other);
        let question = MachineQuestion {
            kind: ConditionKind::Case,
            span: if place.end > place.start { place } else { span },
            cause: doubt.cause(),
            // Cases with the same values are the same question.
            reads: asking.map(|asking| asking.about(ConditionSubject::Cases(texts.clone()))),
            texts,
            kept,
        };
        self.part(question, goals, at)
    }

    /// Returns the cases of the `$SWITCH` being executed, with their values, and the target of everything else.
    fn cases(&mut self, at: &BlockContext<'_>) -> Option<(Vec<(EntryIndex, Value)>, Goal)> {
        let unit = self.state.control.frames.running()?.unit;
        let whole = self.position().current_block();
        let mut cases: Vec<(EntryIndex, Value)> = Vec::new();
        let mut entry = self.programs.index(unit).links(whole.start).next;
        while entry < whole.end {
            let parsed = self.programs.parsed(unit, entry);
            if parsed.block.skip.is_some() {
                return None;
            }
            let shown = ShownBlockLines::default();
            let head = at.other(&parsed, &shown);
            let flow = head.block.items.iter().find_map(|item| match item {
                Item::Flow(flow, _) => Some(flow),
                _ => None,
            });
            match flow? {
                Flow::Case(operand) => {
                    let value = self.value(*operand, &head).ok()?;
                    if matches!(value, Value::Unknown(_)) {
                        return None;
                    }
                    let is_new = !cases.iter().any(|(_, known)| *known == value);
                    cases.extend(is_new.then_some((entry, value)));
                }
                Flow::Default => return Some((cases, Goal::block(entry))),
                _ => return None,
            }
            let next = self.programs.index(unit).links(entry).next;
            if next <= entry {
                return None;
            }
            entry = next;
        }
        Some((cases, Goal::block(whole.end)))
    }

    /// Parts the run before a block with a skip mark: one way executes the adjacent blocks of the level,
    /// the other passes over them (R2.90). Returns whether it can.
    #[cold]
    pub(crate) fn part_by_skip(&mut self, level: u8, parsed: &Parsed) -> bool {
        let Some(frame) = self.state.control.frames.running() else {
            return false;
        };
        let (unit, entry) = (frame.unit, frame.next.saturating_sub(1));
        let index = self.programs.index(unit);
        let section_end = self.programs.section(frame.program()).end;
        let is_marked = |entry: EntryIndex| index.skips.get(&entry) == Some(&level);
        // A control block of which only a part has the mark is passed over (R2.51, R2.90).
        let is_whole = |entry: EntryIndex| {
            index.links.get(&entry).is_none_or(|links| {
                [links.opener, links.next, links.end]
                    .into_iter()
                    .all(is_marked)
            })
        };
        if !is_whole(entry) {
            return false;
        }
        let mut after = entry + 1;
        while after < section_end && is_marked(after) && is_whole(after) {
            after += 1;
        }
        let marked = Marked {
            depth: self.state.control.frames.depth(),
            unit,
            first: entry,
            after,
        };
        let shown = ShownBlockLines::default();
        let at = BlockContext::of_parsed(parsed, self.state.control.frames.level(), &shown);
        let mark = parsed.text.trim_start();
        let is_bare = mark.strip_prefix('/').is_some_and(|rest| {
            !rest
                .trim_start()
                .starts_with(|it: char| it.is_ascii_digit())
        });
        let at_start = self.machine.readings.takes_second(Open::SkipLevel);
        let cause = Unknown::SkipLevel(level);
        self.scratch.clear();
        self.scratch.has_plain_words = false;
        self.note_unknown(&cause, &at);
        let span = Span::new(0, parsed.text.trim_end().len());
        if !is_bare && self.is_level_read_again(level, &at.place(span)) {
            self.state.rests_on.insert(Open::SkipLevel);
        }
        // The switch of blocks without a number is read when the main program begins, and the others
        // where the machine is read so (R2.90).
        let writer = if is_bare || at_start {
            Writer::Nothing
        } else {
            Writer::Machine
        };
        let question = MachineQuestion {
            kind: ConditionKind::Skip(level),
            span,
            texts: vec!["executed".into()],
            cause: cause.clone(),
            reads: Some(Asking::of_unknown(writer, cause)),
            kept: None,
        };
        let goals = [after, entry].map(Goal::block);
        if !self.part(question, goals.into(), &at) {
            return false;
        }
        let mut sides = self.sides.iter_mut();
        if let Some(executed) = sides.find(|side| side.to == entry) {
            executed.marked = Some(marked);
        }
        true
    }

    /// Returns whether blocks at another place also ask for a level, and a selected reading decides whether its switch
    /// may have changed in between.
    fn is_level_read_again(&self, level: u8, here: &Place) -> bool {
        let mut conditions = self.state.conditions.iter();
        self.machine.readings.of(Open::SkipLevel).is_some()
            && conditions.any(|it| it.kind == ConditionKind::Skip(level) && it.place != *here)
    }

    /// Notes the level as a value of the machine.
    fn note_unknown(&mut self, cause: &Unknown, at: &BlockContext<'_>) {
        if self.options.notes == Notes::Taken {
            let note = Note {
                kind: NoteKind::Unknown,
                name: cause.to_string(),
                place: at.place(Span::new(0, at.text.trim_end().len())),
            };
            self.scratch.read.notes.borrow_mut().push(note);
        }
    }
}

impl ControlState {
    fn is_effective(&self, (axis, kind): (AxisIndex, Kind)) -> bool {
        self.compensation.is_parameterised(axis, kind)
    }
}

/// Returns the condition that a case applies.
fn compared(subject: &str, case: &Flow, block: (&Block, &str)) -> Arc<str> {
    let value = match case {
        Flow::Case(operand) => operand_text(*operand, block),
        _ => String::new(),
    };
    format!("{subject} == {value}").into()
}

fn operand_text(operand: Operand, (block, text): (&Block, &str)) -> String {
    match operand {
        Operand::Expression(expression) => text_of(block, text, expression).0,
        Operand::Number(number) => number.to_string(),
    }
}

impl Executor {
    /// Returns whether the jump of a block waits for the signal of a probe (R2.91).
    pub(crate) fn jump_is_probed(&mut self, at: &BlockContext<'_>) -> bool {
        if self.scratch.actions.probes {
            return true;
        }
        let words = at.block.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        let mut numbers = words
            .filter(|word| word.address == Address::Letter(b'G'))
            .filter_map(|word| word.value);
        numbers.any(|number| {
            let number = self.value(number, at);
            number.is_ok_and(|number| number.number().is_none_or(measures))
        })
    }
}

/// Returns whether a G function measures. With G310, `$GOTO` in its block is taken if the probe answers (TF5200
/// Programming manual, 206197003). Its effect with the other measuring functions is not documented; they wait for the
/// probe, too.
fn measures(number: f64) -> bool {
    GFunction::of_value(number).is_some_and(GFunction::is_measuring)
}

impl Executor {}
