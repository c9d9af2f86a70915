//! Blocks that are passed over: whatever they could change is unknown after them (R2.51).
//!
//! This is left for what cannot be executed: the passes of a loop, or ways, beyond their budgets; a control block of
//! which only some parts have a skip mark; a program that may be in force as a modal cycle. The blocks are read, and
//! what they name is unknown.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::Range;
use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::axes::Addressed;
use crate::interpreter::block::{BlockContext, MacroCode, OwnEnd, PassedBlocks, ShownBlockLines};
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::Executor;
use crate::interpreter::options::StopPolicy;
use crate::interpreter::programs::calls::{Configured, Finder, FunctionWord, WantedCall};
use crate::interpreter::programs::index::{EntryIndex, Index, LabelName, ProgramId};
use crate::interpreter::programs::store::Caller;
use crate::interpreter::stack::{CallStack, ControlStep, Request};
use crate::interpreter::values::expression::unquoted;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::plain::subscript;
use crate::interpreter::values::value::{Value, rounded};
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::others::OtherPaths;
use crate::interpreter::ways::path::{Meeting, Path};
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::of_axes;
use crate::language::{AxisAction, GFunction, HashAction, Moves, Plc, Touches, is_read_only};
use crate::syntax::ast::{
    Address, Block, BlockReference, CallName, CallScope, Effect as Unread, Expression, Flow, Hash,
    Item, Node, Operand, Repetition, Word,
};
use crate::syntax::{Fault, Stretch, VariableName, is_letter, is_program_number};
use crate::text::{Place, Span, in_a_row};

/// Most blocks elsewhere at which the run may go on after blocks that are passed over; with more, all of the program is
/// passed over.
const MAX_EXITS: usize = 8;

/// An effect of blocks on more than they name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum WideEffect {
    Anything,
    AnyValue,
    Couplings,
    NewCouplings,
    Followers,
    ModalCycles,
    ModalWords,
    AnyMotion,
    PlcActs,
    JumpsAnywhere,
    Returns,
    /// Possible end of the program by an error of the control.
    Refusal,
}

/// Possible effects of blocks, judged by their text.
#[derive(Default)]
struct PossibleEffects {
    wide: BTreeSet<WideEffect>,
    switched: Vec<(String, KindSet)>,
    moved: BTreeSet<AxisIndex>,
    written: BTreeSet<Location>,
    /// Names of macros that are defined, and of those that are used.
    macros: BTreeSet<String>,
    used_macros: BTreeSet<String>,
    calls: Vec<WantedCall>,
    jumps: Vec<LabelName>,
    /// Blocks to which they leave loops and cases.
    leaves: Vec<EntryIndex>,
    ends: Vec<Place>,
    /// Errors of the control, each with whether the block was executed, which reports it there.
    refused: Vec<(Diagnostic, bool)>,
}

impl PossibleEffects {
    fn add(&mut self, effect: WideEffect) {
        self.wide.insert(effect);
    }

    fn add_if(&mut self, has: bool, effect: WideEffect) {
        self.wide.extend(has.then_some(effect));
    }

    fn has(&self, effect: WideEffect) -> bool {
        self.wide.contains(&effect)
    }
}

/// Reads blocks for their possible effects.
struct EffectReader<'a> {
    run: &'a Executor,
    effects: PossibleEffects,
    /// The block that is read.
    place: (usize, EntryIndex),
}

impl EffectReader<'_> {
    fn blocks(&mut self, unit: usize, range: Range<EntryIndex>) {
        let index = self.run.programs.index(unit);
        let mut reader = index.reader(range.start);
        let mut block = Block::default();
        let mut left = range.end.saturating_sub(range.start);
        while left > 0 && !self.run.is_exhausted() {
            let Some(raw) = reader.next(&mut block) else {
                return;
            };
            if raw.stretch != Stretch::Block {
                continue;
            }
            self.place = (unit, range.end - left);
            left -= 1;
            self.run.state.work.charge_reading(ITEM + raw.text.len());
            let shown = ShownBlockLines::default();
            let at = BlockContext::of_raw(index.source.name(), &raw, &block, &shown);
            // Blocks that are skipped change nothing (R2.3).
            if !self.run.is_skipped(&block) {
                self.block(&at);
            }
        }
    }

    fn block(&mut self, at: &BlockContext<'_>) {
        for word in &at.block.words {
            self.word(word, at);
        }
        for item in &at.block.items {
            self.item(item, at);
        }
    }

    fn item(&mut self, item: &Item, at: &BlockContext<'_>) {
        match item {
            Item::Comp(command) => {
                let (unit, entry) = self.place;
                let is_told = self.run.programs.was_read(unit, entry);
                let refused = self.run.refusal_of(command, at);
                let refused = refused.map(|said| (said, is_told));
                self.effects.refused.extend(refused);
                let kinds = command.selection.kinds();
                self.effects.switched.push((command.axis.clone(), kinds));
            }
            Item::Assign(assignment) => self.assigns(assignment.target.place, at),
            Item::Word(word) => self.word(word, at),
            Item::Call(call) => {
                let is_repeated = call.repetition != Repetition::Once;
                match self.program_name(call.name, at) {
                    Some(name) if !is_repeated => {
                        let span = at.in_block(call.span);
                        let wanted = WantedCall::program(call.scope, name, span);
                        self.effects.calls.push(wanted);
                    }
                    _ => self.effects.add(WideEffect::Anything),
                }
            }
            Item::GCall(call) => self.function(FunctionWord::g(call.number)),
            Item::Hash(hash) => self.hash(hash, at),
            Item::MacroUse(span) => self.expand(*span, at),
            Item::MacroDefinition(name, _) => {
                let name = unquoted(name.of(at.text)).trim();
                self.effects.macros.insert(name.to_owned());
            }
            Item::Unread(Unread::Everything, span) => {
                self.effects.add_if(
                    !self.run.machine.harmless.has_command(span.of(at.text)),
                    WideEffect::Anything,
                );
            }
            Item::Unread(Unread::Parameters, _) => {
                self.effects.written.insert(Location::Parameters);
            }
            Item::Flow(flow, _) => self.flow(flow, at),
            Item::Sequence(sequence) => {
                let name = sequence.name.and_then(|name| self.program_name(name, at));
                match name {
                    Some(name) => {
                        let span = at.in_block(sequence.span);
                        let wanted = WantedCall::program(CallScope::Global, name, span);
                        self.effects.calls.push(wanted);
                    }
                    None => self.effects.add(WideEffect::Anything),
                }
            }
            Item::Return(_) => self.effects.add(WideEffect::Returns),
            Item::Bracket { command, .. } => {
                let moves = command.motion.map(|motion| motion.moves);
                let links =
                    moves == Some(Moves::Follower) || command.action == AxisAction::EndFollowing;
                self.effects.add_if(links, WideEffect::Followers);
                let acts = command.plc == Plc::Acts;
                self.effects.add_if(acts, WideEffect::PlcActs);
                let is_motion = command.motion.is_some();
                self.effects.add_if(is_motion, WideEffect::AnyMotion);
                self.effects.add(WideEffect::ModalWords);
            }
            Item::Unread(Unread::Spindle, _) => self.effects.add(WideEffect::ModalWords),
            Item::BadCommand(_) | Item::BareNumber(..) | Item::Label(_) => {}
        }
    }

    fn flow(&mut self, flow: &Flow, at: &BlockContext<'_>) {
        match flow {
            Flow::For { counter, .. } => self.assigns(counter.place, at),
            Flow::Switch(Some(target), _) => self.assigns(target.place, at),
            Flow::Goto(BlockReference::Label(name)) => {
                let name = name.of(at.text).trim_matches(['[', ']']).to_owned();
                self.effects.jumps.push(LabelName::Text(name));
            }
            Flow::Goto(BlockReference::Number(Operand::Number(number))) => {
                self.effects.jumps.push(LabelName::numbered(*number));
            }
            Flow::Goto(_) => {
                self.effects.add(WideEffect::JumpsAnywhere);
                self.effects.add(WideEffect::Refusal);
            }
            Flow::Break | Flow::Continue => {
                let (unit, entry) = self.place;
                let index = self.run.programs.index(unit);
                if index.is_linked(entry) {
                    let after = EntryIndex::from(matches!(flow, Flow::Break));
                    self.effects.leaves.push(index.links(entry).end + after);
                }
            }
            _ => {}
        }
    }

    fn hash(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        for target in &hash.written {
            self.assigns(target.place, at);
        }
        let named = |axis: &AxisIndex| self.run.machine.axis(*axis).name.clone();
        let all = |axes: Vec<AxisIndex>, kinds: KindSet| -> Vec<_> {
            axes.iter().map(|axis| (named(axis), kinds)).collect()
        };
        match hash.command.action {
            HashAction::WriteMachineData => {
                let axes = self.run.perhaps_transferred(&hash.brackets, at.text);
                self.effects.switched.extend(all(axes, KindSet::ALL));
            }
            HashAction::ReportError => self.effects.add(WideEffect::Refusal),
            HashAction::Declare | HashAction::Delete | HashAction::Initialise => {
                self.effects.add(WideEffect::AnyValue);
                self.effects.add(WideEffect::Refusal);
            }
            HashAction::DefineCoupling(_) => self.effects.add(WideEffect::NewCouplings),
            HashAction::EnableCoupling
            | HashAction::ReleaseCoupling
            | HashAction::ReleaseCouplings => self.effects.add(WideEffect::Couplings),
            HashAction::EndModalCycles => self.effects.add(WideEffect::ModalCycles),
            HashAction::NamePrograms
            | HashAction::RetainCycleChanges
            | HashAction::ForgetMacros
            | HashAction::Describe(_)
            | HashAction::EndDescription
            | HashAction::SaveConfig(_)
            | HashAction::ChangeFile(_)
            | HashAction::ExchangeAxes(_) => self.effects.add(WideEffect::Anything),
            HashAction::PassOver
            | HashAction::Comment
            | HashAction::EndComment
            | HashAction::EndDeclarations
            | HashAction::Dwell
            | HashAction::NameManualAxes
            | HashAction::Wait
            | HashAction::RealTimeLoop
            | HashAction::EndRealTimeLoop
            | HashAction::SkipBackward
            | HashAction::Rotate
            | HashAction::Override
            | HashAction::SelectSpindle
            | HashAction::Round(_)
            | HashAction::SelectSlope(_) => {}
        }
        self.effects.add(WideEffect::ModalWords);
        let is_motion = hash.command.motion.is_some()
            || matches!(hash.command.touches, Touches::Motion | Touches::Plane);
        self.effects.add_if(is_motion, WideEffect::AnyMotion);
        let moves = hash.command.motion.map(|motion| motion.moves);
        let links = matches!(moves, Some(Moves::Gantry | Moves::Follower));
        self.effects.add_if(links, WideEffect::Followers);
        if hash.command.touches == Touches::Friction {
            let axes = self.run.axes().given_or_all(&hash.brackets, at.text);
            let frict = KindSet::of(Kind::Frict);
            self.effects.switched.extend(all(axes, frict));
        }
        self.effects
            .add_if(hash.command.lets_plc_act(), WideEffect::PlcActs);
    }

    fn word(&mut self, word: &Word, at: &BlockContext<'_>) {
        let number = match word.value {
            Some(Operand::Number(number)) => rounded(number),
            _ => None,
        };
        let letter = match word.address {
            Address::Letter(letter) => letter,
            Address::Name(name) => return self.axis_word(name.of(at.text)),
            Address::Lower(_) | Address::Main(_) => {
                self.effects.add(WideEffect::ModalWords);
                return self.effects.add(WideEffect::AnyMotion);
            }
        };
        self.effects.add_if(
            self.run.lets_plc_act_at(letter, number),
            WideEffect::PlcActs,
        );
        match (letter, number) {
            (b'M', Some(2 | 30)) => {
                let whole = Span::new(0, at.text.trim_end().len());
                self.effects.ends.push(at.place(whole));
            }
            (b'M', Some(17 | 29)) => self.effects.add(WideEffect::Returns),
            (b'G' | b'M', None) => self.effects.add(WideEffect::Anything),
            (b'G' | b'M' | b'T' | b'D', _) => self.function(FunctionWord { letter, number }),
            (b'O', _) if is_program_number(at.block) => {}
            (b'A'..=b'Z', _) if !is_letter(letter) => self.effects.add(WideEffect::Anything),
            (b'N', _) => {}
            _ => self.axis_word(char::from(letter).encode_utf8(&mut [0; 4])),
        }
    }

    /// Adds the effect of an axis word, or of a word that stays in force.
    fn axis_word(&mut self, name: &str) {
        let control = &self.run.state.control;
        match self.run.axes().named(name) {
            _ if control.channel_axes.is_doubtful() => self.effects.add(WideEffect::AnyMotion),
            Some(axis) => _ = self.effects.moved.insert(axis),
            None => self.effects.add(WideEffect::ModalWords),
        }
    }

    fn function(&mut self, word: FunctionWord) {
        self.effects.add(WideEffect::ModalWords);
        let data = (word.letter == b'T').then(|| word.of_data());
        for word in [word].into_iter().chain(data) {
            match self.run.configured(word) {
                Configured::Program(name) => {
                    let wanted = WantedCall::program(CallScope::Global, name, Span::default());
                    self.effects.calls.push(wanted);
                    return;
                }
                Configured::Unknown(_) => self.effects.add(WideEffect::Anything),
                Configured::None => {}
            }
        }
        let number = word.number.and_then(|number| u32::try_from(number).ok());
        if let Some(number) = number.filter(|_| word.letter == b'G')
            && GFunction::known(number).is_some_and(GFunction::is_call)
            && !self
                .run
                .machine
                .harmless
                .has_function(b'G', i64::from(number))
        {
            let wanted = WantedCall::of_word(number, Span::default());
            self.effects.calls.push(wanted);
        }
    }

    /// Adds the code of a macro, once however often it is used: macros that use each other would be read endlessly.
    fn expand(&mut self, used: Span, at: &BlockContext<'_>) {
        let name = unquoted(used.of(at.text)).trim().to_owned();
        if !self.effects.used_macros.insert(name.clone()) {
            return;
        }
        let code = match self.run.state.control.memory.macro_code(&name) {
            Some(Value::Text(code)) => Arc::clone(code),
            Some(Value::Unknown(_)) => {
                self.effects.add(WideEffect::Anything);
                return;
            }
            Some(Value::Number(_)) | None => return,
        };
        self.run.state.work.charge_reading(ITEM + code.len());
        let block = crate::syntax::parse_block(&code);
        let shown = ShownBlockLines::default();
        let code = MacroCode {
            text: &code,
            block: &block,
            depth: at.macro_depth,
        };
        self.block(&at.in_macro(&code, at.in_block(used), &shown));
    }

    /// Returns the name of a called program; `None` where only the machine knows it.
    fn program_name(&self, name: CallName, at: &BlockContext<'_>) -> Option<String> {
        match name {
            CallName::Literal(span) => Some(span.of(at.text).trim().to_owned()),
            CallName::Quoted(span) => {
                let name = unquoted(span.of(at.text));
                match self.run.state.control.memory.macro_or_text(name) {
                    Value::Text(name) => Some(name.trim().to_owned()),
                    Value::Number(_) | Value::Unknown(_) => None,
                }
            }
            CallName::Variable(_) => None,
        }
    }

    /// Adds the possible targets of an assignment. A place that has to be computed may be different each time.
    fn assigns(&mut self, place: Expression, at: &BlockContext<'_>) {
        let Some(root) = place.end.checked_sub(1) else {
            return;
        };
        let inner = place.start as usize..root as usize;
        let operands = at.block.nodes.get(inner).unwrap_or_default();
        let is_plain = operands.iter().all(|node| matches!(node, Node::Number(_)));
        let root = root as usize;
        let (Some(node), Some(span)) = (at.block.nodes.get(root), at.block.spans.get(root)) else {
            return;
        };
        let array = || VariableName::array_of(span.of(at.text));
        let target = match node {
            Node::Parameter { owner, index } => Location::Parameter(*owner, *index),
            Node::Variable { subscripts: 0 } => Location::Variable(array()),
            Node::Variable { .. } if is_plain => {
                let values = operands.iter().map(subscript).collect();
                Location::Variable(VariableName::with_values(span.of(at.text), values))
            }
            Node::Variable { .. } => Location::Elements(array()),
            Node::IndexedParameter { .. } | Node::Unread => {
                return self.effects.add(WideEffect::AnyValue);
            }
            _ => return,
        };
        if let Location::Variable(name) | Location::Elements(name) = &target {
            let is_refused = is_read_only(name.array());
            self.effects.add_if(is_refused, WideEffect::Refusal);
        }
        self.effects.written.insert(target);
    }
}

impl Executor {
    /// Passes over the control block being executed, which cannot be followed.
    pub(crate) fn pass_over_part(&mut self, cause: Unknown, span: Span, at: &BlockContext<'_>) {
        let Some(unit) = self.state.control.frames.running().map(|frame| frame.unit) else {
            return;
        };
        let whole = self.position().current_block();
        let message = format!(
            "how this control block is executed depends on {}; whatever it could change is unknown from here on",
            cause.seen_from(at.file)
        );
        let fault = Fault::new(Code::Fc901, span, message).with_help(cause.advice());
        let said = self
            .state
            .mentioned
            .with_origin(at.diagnostic(fault), &cause, at);
        self.scratch.passed.push(PassedBlocks {
            unit,
            blocks: whole.start..whole.end + 1,
            cause,
            said: Some(said),
        });
    }

    /// Passes over what a statement decides whose operands cannot be computed.
    pub(crate) fn pass_over_undecided(
        &mut self,
        flow: &Flow,
        (cause, span): (Unknown, Span),
        at: &BlockContext<'_>,
    ) {
        if let Flow::Goto(target) = flow {
            self.part_at_target(target, &cause, span, at);
        } else {
            self.pass_over_part(cause, span, at);
        }
    }

    /// Passes over the call of a local subprogram, which may be any of the file.
    pub(crate) fn pass_over_locals(&mut self, cause: &Unknown) {
        let Some(unit) = self.state.control.frames.running().map(|frame| frame.unit) else {
            return;
        };
        let sections = self.programs.index(unit).sections.iter();
        let locals = sections.filter(|section| section.local);
        let locals = locals.map(|section| PassedBlocks {
            unit,
            blocks: section.start..section.end,
            cause: cause.clone(),
            said: None,
        });
        self.scratch.passed.extend(locals);
    }

    /// Makes unknown what the parts that the block passes over could change.
    #[inline]
    pub(crate) fn pass_over_parts(&mut self, finder: &mut dyn Finder) {
        while let Some(passed) = self.scratch.passed.pop() {
            let PassedBlocks {
                unit,
                blocks,
                cause,
                said,
            } = passed;
            let Some(said) = said else {
                self.perhaps_execute(unit, blocks, &cause, finder);
                continue;
            };
            let before = self.unknown_kinds();
            let after = self.pass_over_blocks(blocks, &cause, finder);
            self.scratch.actions.step = Some(ControlStep::Jump(after));
            self.tell_passed(&cause, &before, said);
        }
    }

    /// Passes over blocks of the running program, and over those to which they may lead. Returns the block after them.
    pub(crate) fn pass_over_blocks(
        &mut self,
        blocks: Range<EntryIndex>,
        cause: &Unknown,
        finder: &mut dyn Finder,
    ) -> EntryIndex {
        let Some(program) = self.state.control.frames.program() else {
            return blocks.end;
        };
        let (blocks, exits) = self.reached_from(program, blocks);
        self.perhaps_execute(program.unit, blocks.clone(), cause, finder);
        for exit in exits {
            self.perhaps_leave(exit, blocks.end, program.unit);
        }
        blocks.end
    }

    /// Lets the run possibly go on at another block than the one after those that are passed over.
    fn perhaps_leave(&mut self, exit: EntryIndex, after: EntryIndex, unit: usize) {
        let mut way = Path {
            control: self.state.control.clone(),
            track: self.state.track.clone(),
            parted: self.state.seq,
        };
        self.charge_copies(&way.control, &way.track.reach);
        if self.options.follows_one_way() {
            way.track.shadow.until.get_or_insert(Meeting {
                depth: way.control.frames.depth(),
                unit,
                entry: after,
            });
        }
        self.scratch.left.push(way.at(exit));
    }

    /// Blocks with all of each control block that they touch, and the blocks after them to which they jump or return.
    fn reached_from(
        &self,
        program: ProgramId,
        blocks: Range<EntryIndex>,
    ) -> (Range<EntryIndex>, BTreeSet<EntryIndex>) {
        let index = self.programs.index(program.unit);
        let section = self.programs.section(program);
        let mut known = blocks;
        loop {
            let whole = index.completed(known.clone());
            let effects = self.possible_effects(program.unit, whole.clone());
            let jumps = effects.jumps.iter().cloned();
            let mut exits: BTreeSet<EntryIndex> = jumps
                .filter_map(|name| index.label(program.section, name))
                .collect();
            if effects.has(WideEffect::JumpsAnywhere) {
                exits.extend(index.labels(program.section));
            }
            if effects.has(WideEffect::Returns) {
                exits.insert(section.end);
            }
            exits.extend(&effects.leaves);
            let first = exits.first().map_or(whole.start, |to| whole.start.min(*to));
            exits.retain(|to| *to > whole.end);
            let mut whole = first..whole.end;
            if exits.len() > MAX_EXITS {
                whole.end = section.end;
                exits.clear();
            }
            if whole == known || self.is_exhausted() {
                return (whole, exits);
            }
            known = whole;
        }
    }

    fn possible_effects(&self, unit: usize, blocks: Range<EntryIndex>) -> PossibleEffects {
        let mut reader = EffectReader {
            run: self,
            effects: PossibleEffects::default(),
            place: (unit, blocks.start),
        };
        reader.blocks(unit, blocks);
        reader.effects
    }

    /// Makes unknown what blocks of a file, and the programs that they call, could change.
    #[cold]
    pub(crate) fn perhaps_execute(
        &mut self,
        unit: usize,
        blocks: Range<EntryIndex>,
        cause: &Unknown,
        finder: &mut dyn Finder,
    ) {
        let mut found = vec![(unit, blocks)];
        let mut seen = HashSet::new();
        let (mut defined, mut used) = (BTreeSet::new(), BTreeSet::new());
        // The program may end anywhere in them, with the effects of any of them.
        let mut ends = Vec::new();
        while let Some((unit, blocks)) = found.pop() {
            if !seen.insert((unit, blocks.start)) || self.is_exhausted() {
                continue;
            }
            let effects = self.possible_effects(unit, blocks);
            let file = self.programs.index(unit).source.name().clone();
            for wanted in &effects.calls {
                if self.is_external(wanted) {
                    self.leave_to_machine(&wanted.missing());
                    continue;
                }
                let caller = Caller { unit, file: &file };
                match self.programs.find(wanted, caller, finder, &self.state.work) {
                    Ok(Some(program)) => {
                        let section = self.programs.section(program);
                        found.push((program.unit, section.start..section.end));
                    }
                    Ok(None) => {}
                    Err(_) => {
                        self.havoc_all(cause);
                        ends.push((None, EndedBy::Error));
                    }
                }
            }
            defined.extend(effects.macros.iter().cloned());
            used.extend(effects.used_macros.iter().cloned());
            ends.extend(self.suffer(effects, cause));
        }
        if !defined.is_disjoint(&used) {
            // Their code is what they had before.
            self.havoc_all(cause);
        }
        for (place, by) in ends {
            self.may_end_at(place, by);
        }
        self.version += 1;
    }

    /// Makes unknown what blocks could change. Returns where they may end the program.
    fn suffer(
        &mut self,
        effects: PossibleEffects,
        cause: &Unknown,
    ) -> Vec<(Option<Place>, EndedBy)> {
        let unknown = || Value::Unknown(cause.clone());
        for (name, kinds) in &effects.switched {
            match self.state.control.addressed(name) {
                Ok(Addressed::Axis(axis)) => {
                    self.see(axis);
                    self.havoc(axis, *kinds);
                }
                Ok(Addressed::Absent(Some(axis))) => self.havoc(axis, *kinds),
                Ok(Addressed::Any | Addressed::Absent(None)) => self.havoc_any_axis(*kinds),
                Err(_) => {}
            }
        }
        if effects.has(WideEffect::AnyValue) {
            self.havoc_memory(cause);
        }
        for target in &effects.written {
            self.write(target, unknown());
        }
        for name in &effects.macros {
            self.state.control.memory.havoc_macro(name, cause);
            self.scratch.wrote = true;
        }
        for axis in &effects.moved {
            self.state.control.modal.havoc_position(*axis);
            self.scratch.moves.perhaps_move(*axis);
            self.see(*axis);
        }
        if effects.has(WideEffect::ModalWords) {
            self.state.control.modal.havoc_words();
        }
        if effects.has(WideEffect::AnyMotion) {
            self.state.control.modal.havoc_positions();
            self.perhaps_move_all();
        }
        if effects.has(WideEffect::PlcActs) {
            self.let_plc_act();
        }
        if effects.has(WideEffect::Followers) {
            self.state.control.couplings.havoc_followers(&[]);
        }
        if effects.has(WideEffect::NewCouplings) {
            self.state.control.couple_any(&self.machine);
        }
        if effects.has(WideEffect::Couplings) {
            self.state.control.havoc_couplings();
        }
        if effects.has(WideEffect::ModalCycles) {
            self.state.control.cycles.havoc();
        }
        if effects.has(WideEffect::Anything) {
            self.havoc_all(cause);
            self.state.control.cycles.havoc();
            self.state.control.channel_axes.havoc();
            self.state.control.files.change(None);
        }
        let couples = effects.has(WideEffect::NewCouplings)
            || effects.has(WideEffect::Couplings)
            || self.state.control.couplings.is_any();
        let is_coupled = couples && !effects.switched.is_empty();
        let is_refused = is_coupled || effects.has(WideEffect::Refusal);
        let mut ends: Vec<_> = is_refused
            .then_some((None, EndedBy::Error))
            .into_iter()
            .collect();
        for (mut said, is_told) in effects.refused {
            ends.push((Some(said.place.clone()), EndedBy::Error));
            if !is_told {
                let value = cause.seen_from(&said.place.file);
                let message = &mut said.message;
                *message = format!("{message}; whether the block is executed depends on {value}");
                self.scratch.messages.of_some_ways.push(said);
            }
        }
        let own = effects.ends.into_iter();
        ends.extend(own.map(|place| (Some(place), EndedBy::M30)));
        ends
    }

    /// Lets the program possibly end at a block in the state in which it goes on.
    fn may_end_at(&mut self, place: Option<Place>, by: EndedBy) {
        if by == EndedBy::Error && self.options.stop == StopPolicy::KeepGoing {
            return;
        }
        let here = (self.state.control.clone(), self.state.track.clone());
        if by == EndedBy::Error {
            self.reset_after_stop();
        }
        let end = self.scratch.ending.at.take();
        self.scratch.ending.at = place.map(|place| OwnEnd {
            place,
            is_passed_into: false,
        });
        let ended = self.ended_path(by);
        self.state.end_way(ended);
        self.scratch.ending.at = end;
        (self.state.control, self.state.track) = here;
        self.version += 1;
    }

    /// Ends the program at the block on some ways.
    pub(crate) fn end_on(&mut self, ways: WaySet, at: &BlockContext<'_>) {
        let here = (self.state.control.clone(), self.state.track.clone());
        self.state.go_on_with(ways);
        let whole = Span::new(0, at.text.trim_end().len());
        self.may_end_at(Some(at.place(whole)), EndedBy::M30);
        (self.state.control, self.state.track) = here;
    }

    /// Returns the kinds of each axis that are unknown.
    fn unknown_kinds(&self) -> Vec<KindSet> {
        let axes = (0..self.machine.axes.len()).map(AxisIndex::new);
        axes.map(|axis| self.state.control.compensation.unknown(axis))
            .collect()
    }

    /// Returns the kinds that are unknown and were not before, with their axes.
    pub(crate) fn newly_unknown(&self, before: &[KindSet]) -> Vec<String> {
        let mut kinds: BTreeMap<Kind, Vec<&str>> = BTreeMap::new();
        for (place, now) in self.unknown_kinds().into_iter().enumerate() {
            let axis = self.machine.axis(AxisIndex::new(place));
            let before = before.get(place).copied().unwrap_or(KindSet::NONE);
            for kind in now.without(before).intersection(axis.configured).iter() {
                kinds.entry(kind).or_default().push(axis.name.as_str());
            }
        }
        let named = kinds.iter().map(|(kind, axes)| of_axes(*kind, axes));
        named.collect()
    }

    /// Reports FC901: a control block that cannot be followed is passed over, which leaves kinds unknown.
    fn tell_passed(&mut self, cause: &Unknown, before: &[KindSet], mut said: Diagnostic) {
        let named = self.newly_unknown(before);
        let is_new = !named.is_empty()
            && !self.scratch.read.unread.get()
            && self
                .state
                .mentioned
                .is_new(cause, named.iter().cloned(), &said.place);
        if is_new {
            said.message.push_str(", including ");
            said.message.push_str(&in_a_row(&named));
            self.scratch.messages.diagnostics.push(said);
        } else {
            self.scratch.aside.withheld.push(said);
        }
    }
}

impl OtherPaths {
    /// Passes over calls of programs that call themselves as deep as only the machine knows: two of their levels are
    /// executed.
    #[cold]
    pub(crate) fn without_open_recursion(
        &mut self,
        here: &mut Executor,
        calls: Vec<Request>,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Vec<Request> {
        let (open, calls): (Vec<_>, Vec<_>) = calls
            .into_iter()
            .partition(|call| self.is_open_recursion(&here.state.control.frames, call.found));
        for call in open {
            let reach = here.state.track.reach.conditions().max();
            let asked = reach.and_then(|it| here.state.conditions.get(it as usize));
            let cause = asked.map_or(Unknown::Ways, |asked| asked.cause.clone());
            let section = here.programs.section(call.found);
            let blocks = section.start..section.end;
            here.perhaps_execute(call.found.unit, blocks, &cause, finder);
            let message = format!(
                "how deep this program calls itself depends on {}; the call is passed over, and whatever it could \
                 change is unknown",
                cause.seen_from(at.file)
            );
            let fault = Fault::new(Code::Fc902, Span::new(0, at.text.trim_end().len()), message);
            here.tell_once(&cause, "recursion", fault.with_help(cause.advice()), at);
        }
        calls
    }
}

impl OtherPaths {
    /// Returns whether a program calls itself once more on ways of which others wait in two of its calls.
    fn is_open_recursion(&self, running: &CallStack, called: ProgramId) -> bool {
        let depth = running.depth();
        let waits =
            |frames: &CallStack| frames.depth() <= depth && frames.program() == Some(called);
        let waiting = self.waiting.iter();
        running.is_running(called)
            && waiting
                .filter(|path| waits(&path.control.frames))
                .nth(1)
                .is_some()
    }
}

impl Index {
    /// Blocks with all of each control block of which they have a part.
    fn completed(&self, mut blocks: Range<EntryIndex>) -> Range<EntryIndex> {
        loop {
            let mut whole = blocks.clone();
            for links in self.links.values() {
                if whole.contains(&links.opener) != whole.contains(&links.end) {
                    whole = whole.start.min(links.opener)..whole.end.max(links.end + 1);
                }
            }
            if whole == blocks {
                return blocks;
            }
            blocks = whole;
        }
    }
}
