//! The possible effects of a region of a program, found by reading it without executing it
//! (R2.51).
//!
//! They depend on its text and on the macros, not on the state: an
//! assignment whose target has to be computed could go anywhere in its array. So a region is
//! read once, however often a loop returns to it.

use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, KindSet};
use crate::interpreter::programs::file_names::named_words;
use crate::interpreter::programs::index::{EntryIndex, JumpAcross, LabelName};
use crate::interpreter::programs::wanted::{FunctionWord, WantedCall};
use crate::interpreter::run::block_context::{BlockContext, MacroCode, ShownBlockLines};
use crate::interpreter::run::cycles::after_motion_only;
use crate::interpreter::run::hash_parts::declared_name;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::lone_part::{LonePart, has_parts};
use crate::interpreter::run::region::{Exit, Region, RegionEffect};
use crate::interpreter::values::expression::unquoted;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::plain::subscript;
use crate::interpreter::values::value::{Value, rounded};
use crate::interpreter::values::work_budget::ITEM;
use crate::language::{
    AxisAction, AxisCommand, GAction, GFunction, HashAction, Moves, Plc, Touches, is_read_only,
};
use crate::syntax::ast::{
    Address, Block, BlockReference, Call, CallName, CallScope, Effect as Unread, Expression, Flow,
    Hash as HashCommand, Item, Node, Operand, Owner, ReturnLevels, Word,
};
use crate::syntax::{Stretch, VariableFamily, VariableName, is_letter, is_program_number};
use crate::text::Span;

/// A region that is being analysed.
struct MayEffects<'a> {
    run: &'a Interpreter,
    region: Region,
    effects: HashSet<RegionEffect>,
    calls: HashSet<(bool, Option<bool>, String)>,
    exits: HashSet<Exit>,
    /// The block being examined.
    place: (usize, EntryIndex),
    /// Macros of the region whose code has not been examined yet.
    macros: Vec<(String, Span)>,
    /// Macros that were found alone in a block, and those found with other parts.
    expanded: HashSet<(String, bool)>,
    /// Whether it may execute any part of its program.
    whole: bool,
}

impl MayEffects<'_> {
    fn blocks(&mut self, unit: usize, range: Range<EntryIndex>) {
        let index = self.run.programs.index(unit);
        let file = index.source.name();
        let Some(mut reader) = index.reader(range.start) else {
            return;
        };
        let mut block = Block::default();
        let mut left = range.len();
        self.place = (unit, range.start);
        while left > 0 && !self.run.is_exhausted() {
            let Some(raw) = reader.next(&mut block) else {
                return;
            };
            if raw.stretch != Stretch::Block {
                continue;
            }
            left -= 1;
            self.run.state.work.charge_region(ITEM + raw.text.len());
            let shown = ShownBlockLines::default();
            let at = BlockContext::of_raw(file, &raw, &block, &shown);
            // Blocks that are skipped change nothing (R2.3).
            if !self.run.is_skipped(&block) {
                self.block(&at);
                self.expand(&at);
            }
            self.place.1 += 1;
        }
    }

    /// The effects, with those of the section that holds a call of an unknown part of it.
    fn whole_region(mut self, from: EntryIndex) -> Region {
        let unit = self.place.0;
        if self.whole
            && let Some(section) = self.run.programs.section_of((unit, from))
        {
            self.blocks(unit, section);
        }
        self.region
    }

    fn block(&mut self, at: &BlockContext<'_>) {
        self.run.note_reads(at);
        for word in &at.block.words {
            self.word(word, at);
        }
        for item in &at.block.items {
            self.item(item, at);
        }
    }

    /// Examines the code of macros, each once however often it is used: macros that use each other would
    /// otherwise be examined endlessly.
    fn expand(&mut self, at: &BlockContext<'_>) {
        let mut is_shared = has_parts(at.block);
        while let Some((name, used)) = self.macros.pop() {
            let code = match self.run.state.control.memory.macro_code(&name) {
                Some(Value::Text(code)) => &**code,
                Some(Value::Unknown(_)) => {
                    self.effect(RegionEffect::All);
                    continue;
                }
                Some(Value::Number(_)) | None => continue,
            };
            self.run.state.work.charge_region(ITEM + code.len());
            let block = crate::syntax::parse_block(code);
            let shown = ShownBlockLines::default();
            let code = MacroCode {
                text: code,
                block: &block,
                depth: at.macro_depth,
            };
            let may_do_anything = LonePart::of(&code).is_some_and(LonePart::leaves_rest_open);
            if is_shared && may_do_anything {
                self.effect(RegionEffect::All);
            }
            is_shared |= has_parts(&block);
            self.block(&at.in_macro(&code, used, &shown));
        }
    }

    fn effect(&mut self, effect: RegionEffect) {
        if self.effects.insert(effect.clone()) {
            self.region.effects.push(effect);
        }
    }

    fn writes(&mut self, target: Location) {
        if self.region.written.insert(target.clone()) {
            self.region.targets.push(target);
        }
    }

    fn calls(&mut self, wanted: WantedCall) {
        let local = wanted.scope == CallScope::Local;
        let key = (local, wanted.repeat, wanted.name.clone());
        if self.calls.insert(key) {
            self.region.calls.push(wanted);
        }
    }

    fn item(&mut self, item: &Item, at: &BlockContext<'_>) {
        match item {
            Item::Comp(command) => {
                let kinds = command.selection.kinds();
                let is_refused = self.run.machine.refuses(command);
                self.region.refuse_if(is_refused, self.place);
                self.effect(RegionEffect::Compensation(command.axis.clone(), kinds));
            }
            Item::Assign(assignment) => self.assigns(assignment.target.place, at),
            Item::Flow(Flow::For { counter, .. }, _) => self.assigns(counter.place, at),
            Item::Flow(Flow::Switch(Some(target), _), _) => self.assigns(target.place, at),
            Item::Word(word) => self.word(word, at),
            Item::Call(call) => self.call(call, at),
            Item::Sequence(sequence) => match sequence.name {
                // Some part of the program that holds the region.
                None => self.whole = true,
                Some(name) => match self.program_name(name, at) {
                    Some(name) => {
                        let span = at.in_block(sequence.span);
                        self.calls(WantedCall::program(CallScope::Global, name, span));
                    }
                    None => self.effect(RegionEffect::All),
                },
            },
            Item::GCall(call) => {
                self.effect(RegionEffect::Function(FunctionWord::g(call.number)));
            }
            Item::Hash(hash) => {
                for target in &hash.written {
                    self.assigns(target.place, at);
                }
                self.hash(hash, at);
            }
            Item::MacroUse(span) => {
                let name = unquoted(span.of(at.text)).trim();
                let key = (name.to_owned(), has_parts(at.block));
                if self.expanded.insert(key) {
                    self.macros.push((name.to_owned(), at.in_block(*span)));
                }
            }
            Item::MacroDefinition(name, _) => {
                let name = unquoted(name.of(at.text)).trim();
                self.effect(RegionEffect::Macro(name.to_owned()));
            }
            Item::Unread(Unread::Everything, span) => {
                if !self.run.machine.harmless.has_command(span.of(at.text)) {
                    self.effect(RegionEffect::All);
                }
            }
            Item::Unread(Unread::Parameters, _) => self.writes(Location::Parameters),
            Item::Flow(flow, _) => self.flow(flow, at),
            Item::Return(back) if back.levels != ReturnLevels::One || back.target.is_some() => {
                self.exit(Exit::Far);
            }
            Item::Return(_) => self.exit(Exit::Return),
            Item::Unread(Unread::Spindle, _) => self.effect(RegionEffect::Spindle),
            Item::Bracket { axis, command, .. } => self.bracket(axis.of(at.text), *command),
            Item::BadCommand(_) | Item::BareNumber(..) | Item::Label(_) => {}
        }
    }

    /// A command in the bracket of an axis or spindle.
    fn bracket(&mut self, name: &str, command: AxisCommand) {
        if command.action == AxisAction::Override {
            self.effect(RegionEffect::Overrides);
        } else if name.starts_with('S') {
            self.effect(RegionEffect::Spindle);
        }
        if command.plc == Plc::Acts {
            self.effect(RegionEffect::Plc);
        }
        if let Some(what) = command.simplifies {
            self.effect(RegionEffect::Simplified(what));
        }
        if let Some(axis) = self.run.axis_named(name) {
            let row = command.motion;
            if row.is_some() {
                self.effect(RegionEffect::Position(axis));
            }
            if row.is_some_and(|row| row.moves == Moves::Follower)
                || command.action == AxisAction::EndFollowing
            {
                self.effect(RegionEffect::Followers(vec![axis]));
            }
        }
    }

    fn flow(&mut self, flow: &Flow, at: &BlockContext<'_>) {
        let (unit, entry) = self.place;
        let index = self.run.programs.index(unit);
        match flow {
            Flow::Goto(BlockReference::Label(name)) => {
                self.jump(LabelName::Text(name.of(at.text).to_owned()));
            }
            Flow::Goto(BlockReference::Number(Operand::Number(number))) => {
                self.jump(LabelName::numbered(*number));
            }
            Flow::Goto(_) => {
                // There may be no such label.
                self.region.refuse_if(true, self.place);
                self.exit(Exit::AnyLabel);
            }
            Flow::Break if index.is_linked(entry) => {
                self.exit(Exit::Block(index.links(entry).end + 1));
            }
            Flow::Continue if index.is_linked(entry) => {
                self.exit(Exit::Block(index.links(entry).end));
            }
            _ => {}
        }
    }

    /// A jump, which the control may refuse where it stays within a loop or enters one (R2.103).
    fn jump(&mut self, label: LabelName) {
        let (unit, from) = self.place;
        let index = self.run.programs.index(unit);
        let sections = index.sections.iter();
        let mut numbered = sections.enumerate();
        let section = numbered.find(|(_, it)| (it.start..it.end).contains(&from));
        let to = section.and_then(|(section, _)| index.label(section, label.clone()));
        let crosses = to.map_or(JumpAcross::Nothing, |to| index.jump_across(from, to));
        self.region
            .refuse_if(crosses != JumpAcross::Nothing, self.place);
        self.exit(Exit::Label(label));
    }

    fn exit(&mut self, exit: Exit) {
        if self.exits.insert(exit.clone()) {
            self.region.exits.push(exit);
        }
    }

    /// The name of a called program; `None` where only the machine knows it.
    fn program_name(&self, name: CallName, at: &BlockContext<'_>) -> Option<String> {
        match name {
            CallName::Literal(span) => Some(span.of(at.text).to_owned()),
            CallName::Quoted(span) => {
                let name = unquoted(span.of(at.text));
                match self.run.state.control.memory.macro_or_text(name) {
                    Value::Text(name) => Some(name.to_string()),
                    Value::Number(_) | Value::Unknown(_) => None,
                }
            }
            CallName::Variable(_) => None,
        }
    }

    fn call(&mut self, call: &Call, at: &BlockContext<'_>) {
        let span = at.in_block(call.span);
        let Some(name) = self.program_name(call.name, at) else {
            self.effect(RegionEffect::All);
            if call.scope == CallScope::Local {
                self.effect(RegionEffect::AnyLocal(span));
            }
            return;
        };
        let wanted = WantedCall::program(call.scope, name, span);
        self.calls(WantedCall {
            repeat: after_motion_only(call),
            ..wanted
        });
    }

    fn hash(&mut self, hash: &HashCommand, at: &BlockContext<'_>) {
        let command = hash.command;
        let ends =
            command.action == HashAction::ReportError && hash.arguments != [Operand::Number(0.0)];
        self.region.refuse_if(ends, self.place);
        for declaration in &hash.declarations {
            let name = declared_name(declaration, at);
            self.effect(RegionEffect::Declaration(name));
        }
        match command.action {
            HashAction::NamePrograms => {
                for word in named_words(hash, at.text) {
                    self.effect(RegionEffect::FileName(word));
                }
                return;
            }
            HashAction::Delete => {
                for argument in &hash.arguments {
                    if let Operand::Expression(place) = argument {
                        self.deletes(*place, at);
                    }
                }
                return;
            }
            HashAction::DefineCoupling(by) => {
                let axes = self.run.members(by, &hash.brackets, at.text);
                self.effect(RegionEffect::Coupling(axes));
                return;
            }
            HashAction::WriteMachineData => {
                for axis in self.run.perhaps_transferred(&hash.brackets, at.text) {
                    let name = self.run.machine.axis(axis).name.clone();
                    self.effect(RegionEffect::Compensation(name, KindSet::ALL));
                }
            }
            _ => {}
        }
        if command.links_axes() {
            let axes = self.run.axes_in(&hash.brackets, at.text);
            self.effect(RegionEffect::Followers(axes));
        }
        if command.lets_plc_act() {
            self.effect(RegionEffect::Plc);
        }
        self.effect(RegionEffect::Hash(command));
        match command.touches {
            Touches::Motion | Touches::Plane => self.effect(RegionEffect::Positions),
            Touches::Friction => {
                for axis in self.run.axes_or_all(&hash.brackets, at.text) {
                    let name = self.run.machine.axis(axis).name.clone();
                    self.effect(RegionEffect::Compensation(name, KindSet::of(Kind::Frict)));
                }
            }
            _ => {}
        }
    }

    fn assigns(&mut self, place: Expression, at: &BlockContext<'_>) {
        let Some(target) = Self::target(place, at) else {
            return;
        };
        if let Location::Variable(name) | Location::Elements(name) = &target {
            let is_refused = is_read_only(name.array());
            self.region.refuse_if(is_refused, self.place);
        }
        self.writes(target);
    }

    /// A deleted variable is unknown, and so are the elements that it may have.
    fn deletes(&mut self, place: Expression, at: &BlockContext<'_>) {
        let target = Self::target(place, at);
        match &target {
            Some(Location::Variable(name)) => {
                // A calling program may have it (20933).
                let may_be_refused = name.family() == VariableFamily::Cycle;
                self.region.refuse_if(may_be_refused, self.place);
                self.writes(Location::Elements(name.clone()));
            }
            Some(Location::Parameter(Owner::Program, index)) => {
                self.writes(Location::Elements(VariableName::parameter(*index)));
            }
            _ => {}
        }
        if let Some(target) = target {
            self.writes(target);
        }
    }

    /// Returns the possible targets of an assignment. A place that has to be computed may be
    /// different each time.
    fn target(place: Expression, at: &BlockContext<'_>) -> Option<Location> {
        let root = place.end.checked_sub(1)?;
        let inner = place.start as usize..root as usize;
        let operands = at.block.nodes.get(inner).unwrap_or_default();
        let is_plain = operands.iter().all(|node| matches!(node, Node::Number(_)));
        let root = root as usize;
        let (node, span) = (at.block.nodes.get(root)?, at.block.spans.get(root)?);
        let array = || VariableName::array_of(span.of(at.text));
        Some(match node {
            Node::Parameter { owner, index } => Location::Parameter(*owner, *index),
            Node::Variable { subscripts: 0 } => Location::Variable(array()),
            Node::Variable { .. } if is_plain => {
                let values = operands.iter().map(subscript).collect();
                Location::Variable(VariableName::with_values(span.of(at.text), values))
            }
            Node::Variable { .. } => Location::Elements(array()),
            Node::IndexedParameter { owner, subscripts } => {
                let index = match operands.first() {
                    Some(Node::Number(number)) if is_plain || *subscripts > 0 => rounded(*number),
                    _ => None,
                };
                let index = index.and_then(|index| u32::try_from(index).ok());
                match (index, *subscripts) {
                    (Some(index), 0) => Location::Parameter(*owner, index),
                    (Some(index), _) if is_plain => {
                        let subscripts = operands[1..].iter().map(subscript).collect();
                        Location::Variable(VariableName::parameter(index).at(subscripts))
                    }
                    (Some(index), _) => Location::Elements(VariableName::parameter(index)),
                    (None, _) => Location::Parameters,
                }
            }
            Node::Unread => Location::Parameters,
            _ => return None,
        })
    }

    fn word(&mut self, word: &Word, at: &BlockContext<'_>) {
        let number = match word.value {
            Some(Operand::Number(number)) => rounded(number),
            _ => None,
        };
        match (word.address, number) {
            (Address::Letter(b'M'), Some(2 | 30)) => {
                self.exit(Exit::End);
                self.region.end_at(self.place);
            }
            (Address::Letter(b'M'), Some(17 | 29)) => self.exit(Exit::Return),
            (Address::Letter(b'M'), None) => {
                self.exit(Exit::End);
                self.exit(Exit::Return);
            }
            _ => {}
        }
        if let Address::Letter(letter) = word.address
            && self.run.lets_plc_act_at(letter, number)
        {
            self.effect(RegionEffect::Plc);
        }
        match word.address {
            Address::Letter(b'G') => self.g(number),
            Address::Letter(b'F') => self.effect(RegionEffect::Feeds),
            Address::Letter(b'S') => self.effect(RegionEffect::Spindle),
            Address::Letter(b'R') => self.effect(RegionEffect::Radius),
            Address::Letter(b'O') if is_program_number(at.block) => {}
            Address::Letter(letter @ b'A'..=b'Z') if !is_letter(letter) => {
                self.effect(RegionEffect::All);
            }
            Address::Lower(letter) => {
                let upper = letter.to_ascii_uppercase();
                self.axis_word(char::from(upper).encode_utf8(&mut [0; 4]), at);
            }
            Address::Letter(letter @ (b'M' | b'T' | b'D')) => {
                if letter == b'M' && matches!(number, Some(3..=5 | 19)) {
                    self.effect(RegionEffect::Spindle);
                }
                self.effect(RegionEffect::Function(FunctionWord { letter, number }));
            }
            Address::Letter(letter @ b'A'..=b'Z') => {
                self.axis_word(char::from(letter).encode_utf8(&mut [0; 4]), at);
            }
            // Which axis it is depends on the plane, which the region may change.
            Address::Main(_) => self.effect(RegionEffect::Positions),
            Address::Name(name) => {
                let name = name.of(at.text);
                if self.run.is_main_spindle(name) {
                    self.effect(RegionEffect::Spindle);
                } else {
                    self.axis_word(name, at);
                }
            }
            Address::Letter(_) => {}
        }
    }

    fn g(&mut self, number: Option<i64>) {
        let plain = number.and_then(|number| u32::try_from(number).ok());
        let function = plain.and_then(GFunction::of);
        let is_group = function.is_some_and(|function| function.group.is_some());
        let matters = |function: &GFunction| {
            function.chain.is_some()
                || function.simplifies.is_some()
                || matches!(
                    function.action,
                    GAction::SetCuttingSpeed | GAction::SetSpindleSpeed | GAction::WeighRapid
                )
        };
        if plain.is_none() || is_group || function.is_some_and(matters) {
            self.effect(RegionEffect::G(number));
        }
        if !is_group {
            self.effect(RegionEffect::Function(FunctionWord {
                letter: b'G',
                number,
            }));
        }
    }

    fn axis_word(&mut self, name: &str, at: &BlockContext<'_>) {
        if self.run.state.control.channel_axes.doubtful {
            self.effect(RegionEffect::Positions);
        } else if let Some(axis) = self.run.axis_named(name) {
            self.axis(axis, at);
        }
    }

    fn axis(&mut self, axis: AxisIndex, at: &BlockContext<'_>) {
        let is_reference = |word: &Word| {
            word.address == Address::Letter(b'G') && word.value == Some(Operand::Number(92.0))
        };
        let after = at.block.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        let effect = if at.block.words.iter().chain(after).any(is_reference) {
            RegionEffect::Reference(axis)
        } else {
            RegionEffect::Position(axis)
        };
        self.effect(effect);
    }
}

impl Interpreter {
    /// Returns the possible effects of a region.
    pub(crate) fn region(&mut self, unit: usize, range: Range<EntryIndex>) -> Arc<Region> {
        let key = (unit, range.start, range.end);
        let version = self.state.control.memory.macro_version();
        let known = self.regions.get(&key);
        if let Some(known) = known.filter(|known| known.macro_version == version) {
            return Arc::clone(known);
        }
        let mut may_effects = self.may_effects((unit, range.start));
        let from = range.start;
        may_effects.blocks(unit, range);
        let region = Arc::new(may_effects.whole_region(from));
        self.regions.insert(key, Arc::clone(&region));
        region
    }

    fn may_effects(&self, place: (usize, EntryIndex)) -> MayEffects<'_> {
        MayEffects {
            run: self,
            region: Region {
                macro_version: self.state.control.memory.macro_version(),
                ..Region::default()
            },
            effects: HashSet::new(),
            calls: HashSet::new(),
            exits: HashSet::new(),
            place,
            macros: Vec::new(),
            expanded: HashSet::new(),
            whole: false,
        }
    }

    /// Returns the possible effects of one block, which may be of lines that are not kept.
    pub(crate) fn region_of_block(&self, unit: usize, at: &BlockContext<'_>) -> Region {
        let mut may_effects =
            self.may_effects((unit, self.state.control.frames.entry().unwrap_or_default()));
        may_effects.block(at);
        may_effects.expand(at);
        let from = may_effects.place.1;
        may_effects.whole_region(from)
    }

    /// Returns the possible effects of a call.
    pub(crate) fn region_of_call(&self, unit: usize, call: &Call, at: &BlockContext<'_>) -> Region {
        let mut may_effects = self.may_effects((unit, 0));
        may_effects.call(call, at);
        may_effects.region
    }

    /// Returns the possible effects of the blocks of a skip level in a file.
    pub(crate) fn region_of_level(&self, unit: usize, level: u8) -> Region {
        let skips = &self.programs.index(unit).skips;
        let mut may_effects = self.may_effects((unit, 0));
        for (entry, _) in skips.iter().filter(|(_, of)| **of == level) {
            may_effects.blocks(unit, *entry..entry + 1);
        }
        may_effects.region
    }
}
