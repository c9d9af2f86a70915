//! What a region of a program could change, found by looking through it without executing it
//! (R2.51).
//!
//! What a region could change depends on its text and on the macros, not on the state: an
//! assignment whose target has to be computed could go anywhere in its array. So a region is
//! looked through once, however often a loop comes back to it.

use std::collections::HashSet;
use std::hash::Hash;
use std::ops::Range;
use std::sync::Arc;

use super::at::{At, Shown};
use super::budget::ITEM;
use super::call::Wanted;
use super::cycles::after_motion_only;
use super::event::Notes;
use super::expression::unquoted;
use super::hash::{declared_name, point_behind};
use super::implicit::{is_file_name, named_words};
use super::modal::Group;
use super::program::{EntryIndex, LabelName, Section};
use super::run::Interpreter;
use super::target::Target;
use super::value::{Value, rounded};
use super::variable::{canonical, with_subscripts};
use crate::comp::{AxisIndex, KindSet};
use crate::syntax::ast::{
    Address, Block, Call, CallName, CallScope, Effect as Unread, Expression, Flow,
    Hash as HashCommand, Item, JumpTarget, Levels, Node, Operand, Owner, Word,
};
use crate::syntax::{Stretch, is_letter};
use crate::text::Span;

/// Something that a region could change.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Effect {
    /// These kinds on this axis.
    Compensation(String, KindSet),
    /// A G function comes into force; `None` for one that is not known.
    G(Option<i64>),
    /// The feeds.
    Feeds,
    /// The radius of circles.
    Radius,
    /// The position of an axis.
    Position(AxisIndex),
    /// The position of any axis.
    Positions,
    /// What G92 set for an axis.
    Reference(AxisIndex),
    /// A `#` command.
    Hash(String),
    /// A coupling group is defined with these axes.
    Coupling(Vec<AxisIndex>),
    /// A declaration.
    Declaration(String),
    /// A G, M, T or D word, which may call a program.
    Function(u8, Option<i64>),
    /// A macro is defined.
    Macro(String),
    /// A word gets another program by `#FILE NAME`.
    FileName(String),
    /// Everything, through a call of an unknown program.
    All,
}

/// How a region may be left other than at its end.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Exit {
    /// A jump of the same program.
    Label(LabelName),
    /// A jump to an unknown place.
    AnyLabel,
    /// `$BREAK`, `$CONTINUE`.
    Block(EntryIndex),
    /// M17, M29.
    Return,
    /// The same over programs or to a label.
    Far,
    /// M02, M30.
    End,
}

impl Exit {
    /// Where a jump to a label goes.
    pub(super) fn label(name: &str) -> Self {
        Self::Label(LabelName::Text(name.trim_matches(['[', ']']).to_owned()))
    }
}

/// What a region could change.
#[derive(Debug, Default)]
pub(super) struct Region {
    pub(super) effects: Vec<Effect>,
    pub(super) targets: Vec<Target>,
    /// The targets, to ask whether something is one.
    written: HashSet<Target>,
    pub(super) calls: Vec<Wanted>,
    pub(super) exits: Vec<Exit>,
    /// The macros that it was looked through with.
    pub(super) macro_version: u64,
}

impl Region {
    /// Whether the region could write what was written.
    pub(super) fn writes(&self, written: &Target) -> bool {
        let whole = match written {
            Target::Parameter(Owner::Program, _) => self.written.contains(&Target::Parameters),
            Target::Variable(name) => name.split_once('[').is_some_and(|(array, _)| {
                self.written.contains(&Target::Elements(array.to_owned()))
            }),
            _ => false,
        };
        whole || self.written.contains(written)
    }
}

impl Interpreter {
    /// What a region could change.
    pub(super) fn region(&mut self, unit: usize, range: Range<EntryIndex>) -> Arc<Region> {
        let key = (unit, range.start, range.end);
        let version = self.state.memory.macro_version();
        let known = self.regions.get(&key);
        if let Some(known) = known.filter(|known| known.macro_version == version) {
            return Arc::clone(known);
        }
        let mut gathering = Gathering {
            run: self,
            region: Region {
                macro_version: version,
                ..Region::default()
            },
            effects: HashSet::new(),
            calls: HashSet::new(),
            exits: HashSet::new(),
            place: (unit, range.start),
            macros: Vec::new(),
            expanded: HashSet::new(),
            whole: false,
        };
        gathering.blocks(unit, range.clone());
        if gathering.whole {
            let sections = &self.units[unit].index.sections;
            let around = |section: &&Section| (section.start..section.end).contains(&range.start);
            if let Some(section) = sections.iter().find(around) {
                gathering.blocks(unit, section.start..section.end);
            }
        }
        let region = Arc::new(gathering.region);
        self.regions.insert(key, Arc::clone(&region));
        region
    }

    /// Notes the values of the machine that a block would read.
    fn note_reads(&self, block: &Block, at: &At<'_>) {
        if self.options.notes == Notes::None {
            return;
        }
        let nodes = block.nodes.iter().enumerate();
        let read = nodes.filter(|(_, node)| matches!(node, Node::Variable { subscripts: 0 }));
        for (place, _) in read {
            let node = Span::new(place, place + 1);
            let read = Operand::Expression(Expression {
                start: node.start,
                end: node.end,
            });
            let _ = self.with_evaluator(block, at, |evaluator| {
                evaluator.value(read, &mut Vec::new())
            });
        }
    }
}

/// A subscript that is a plain number.
fn subscript(node: &Node) -> String {
    let number = match node {
        Node::Number(number) => rounded(*number),
        _ => None,
    };
    number.unwrap_or(i64::MAX).to_string()
}

/// A region on its way to be known.
struct Gathering<'a> {
    run: &'a Interpreter,
    region: Region,
    effects: HashSet<Effect>,
    calls: HashSet<(bool, Option<bool>, String)>,
    exits: HashSet<Exit>,
    /// The block that is looked at.
    place: (usize, EntryIndex),
    /// Macros of the region whose code was not looked through yet.
    macros: Vec<(String, Span)>,
    expanded: HashSet<String>,
    /// Whether it may execute any part of its program.
    whole: bool,
}

impl Gathering<'_> {
    fn blocks(&mut self, unit: usize, range: Range<EntryIndex>) {
        let index = &self.run.units[unit].index;
        let file = index.source.name();
        let Some(mut reader) = index.reader(range.start) else {
            return;
        };
        let mut block = Block::default();
        let mut left = range.len();
        self.place = (unit, range.start);
        while left > 0 && !self.run.is_worn_out() {
            let Some(raw) = reader.next(&mut block) else {
                return;
            };
            if raw.stretch != Stretch::Block {
                continue;
            }
            left -= 1;
            self.run.state.charge(ITEM + raw.text.len());
            let shown = Shown::default();
            let at = At::of_text(file, (raw.text, raw.line), &shown);
            // Blocks that are skipped change nothing (R2.3).
            if !self.run.is_skipped(&block) {
                self.block(&block, &at);
                self.expand(&at);
            }
            self.place.1 += 1;
        }
    }

    fn block(&mut self, block: &Block, at: &At<'_>) {
        self.run.note_reads(block, at);
        for word in &block.words {
            self.word(word, block, at);
        }
        for item in &block.items {
            self.item(item, block, at);
        }
    }

    /// Looks through the code of macros, each once however often it is used: macros that use each
    /// other would be looked through without end.
    fn expand(&mut self, at: &At<'_>) {
        while let Some((name, used)) = self.macros.pop() {
            let code = match self.run.state.memory.macro_code(&name) {
                Some(Value::Text(code)) => &**code,
                Some(Value::Unknown(_)) => {
                    self.effect(Effect::All);
                    continue;
                }
                Some(Value::Number(_)) | None => continue,
            };
            self.run.state.charge(ITEM + code.len());
            let block = crate::syntax::parse_block(code);
            let shown = Shown::default();
            let inner = At {
                text: code,
                used: at.used.or(Some(used)),
                shown: &shown,
                ..*at
            };
            self.block(&block, &inner);
        }
    }

    fn effect(&mut self, effect: Effect) {
        if !self.effects.contains(&effect) {
            self.effects.insert(effect.clone());
            self.region.effects.push(effect);
        }
    }

    fn writes(&mut self, target: Target) {
        if !self.region.written.contains(&target) {
            self.region.written.insert(target.clone());
            self.region.targets.push(target);
        }
    }

    fn calls(&mut self, wanted: Wanted) {
        let local = wanted.scope == CallScope::Local;
        let key = (local, wanted.repeat, wanted.name.clone());
        if self.calls.insert(key) {
            self.region.calls.push(wanted);
        }
    }

    fn item(&mut self, item: &Item, block: &Block, at: &At<'_>) {
        match item {
            Item::Comp(command) => {
                let kinds = command.selection.kinds();
                self.effect(Effect::Compensation(command.axis.clone(), kinds));
            }
            Item::Assign(assignment) => self.assigns(assignment.target.place, block, at),
            Item::Flow(Flow::For { counter, .. }, _) => self.assigns(counter.place, block, at),
            Item::Flow(Flow::Switch(Some(target), _), _) => self.assigns(target.place, block, at),
            Item::Word(word) => self.word(word, block, at),
            Item::Call(call) => self.call(call, at),
            Item::Sequence(sequence) => match sequence.name {
                // Some part of the program that holds the region.
                None => self.whole = true,
                Some(CallName::Variable(_)) => self.effect(Effect::All),
                Some(CallName::Literal(name) | CallName::Quoted(name)) => {
                    let name = unquoted(name.of(at.text));
                    let Value::Text(name) = self.run.state.memory.macro_or_text(name) else {
                        return self.effect(Effect::All);
                    };
                    let span = at.in_block(sequence.span);
                    self.calls(Wanted::program(CallScope::Global, name.to_string(), span));
                }
            },
            Item::GCall(call) => {
                let number = Some(i64::from(call.number));
                self.effect(Effect::Function(b'G', number));
            }
            Item::Hash(hash) => {
                for target in &hash.written {
                    self.assigns(target.place, block, at);
                }
                self.hash(hash, block, at);
            }
            Item::MacroUse(span) => {
                let name = unquoted(span.of(at.text)).trim();
                if self.expanded.insert(name.to_owned()) {
                    self.macros.push((name.to_owned(), at.in_block(*span)));
                }
            }
            Item::MacroDefinition(name, _) => {
                let name = unquoted(name.of(at.text)).trim();
                self.effect(Effect::Macro(name.to_owned()));
            }
            Item::Unread(Unread::Everything, span) => {
                if !self.run.machine.harmless.has_command(span.of(at.text)) {
                    self.effect(Effect::All);
                }
            }
            Item::Unread(Unread::Parameters, _) => self.writes(Target::Parameters),
            Item::Flow(flow, _) => self.flow(flow, at),
            Item::Return(back) if back.levels != Levels::One || back.target.is_some() => {
                self.exit(Exit::Far);
            }
            Item::Return(_) => self.exit(Exit::Return),
            Item::Unread(Unread::Spindle, _)
            | Item::BadCommand(_)
            | Item::Bracket { .. }
            | Item::BareNumber(..)
            | Item::Label(_) => {}
        }
    }

    fn flow(&mut self, flow: &Flow, at: &At<'_>) {
        let (unit, entry) = self.place;
        let index = &self.run.units[unit].index;
        match flow {
            Flow::Goto(JumpTarget::Label(name)) => self.exit(Exit::label(name.of(at.text))),
            Flow::Goto(JumpTarget::Number(Operand::Number(number))) => {
                self.exit(Exit::Label(LabelName::numbered(*number)));
            }
            Flow::Goto(_) => self.exit(Exit::AnyLabel),
            Flow::Break if index.is_linked(entry) => {
                self.exit(Exit::Block(index.links(entry).end + 1));
            }
            Flow::Continue if index.is_linked(entry) => {
                self.exit(Exit::Block(index.links(entry).end));
            }
            _ => {}
        }
    }

    fn exit(&mut self, exit: Exit) {
        if !self.exits.contains(&exit) {
            self.exits.insert(exit.clone());
            self.region.exits.push(exit);
        }
    }

    fn call(&mut self, call: &Call, at: &At<'_>) {
        let name = match call.name {
            CallName::Literal(span) => Value::Text(span.of(at.text).into()),
            CallName::Quoted(span) => {
                let name = unquoted(span.of(at.text));
                self.run.state.memory.macro_or_text(name)
            }
            CallName::Variable(_) => return self.effect(Effect::All),
        };
        let Value::Text(name) = name else {
            return self.effect(Effect::All);
        };
        let span = at.in_block(call.span);
        let wanted = Wanted::program(call.scope, name.to_string(), span);
        self.calls(Wanted {
            repeat: after_motion_only(call),
            ..wanted
        });
    }

    fn hash(&mut self, hash: &HashCommand, block: &Block, at: &At<'_>) {
        for declaration in &hash.declarations {
            let name = declared_name(declaration, at);
            self.effect(Effect::Declaration(name));
        }
        if is_file_name(&hash.name) {
            for word in named_words(hash.rest.of(at.text)) {
                self.effect(Effect::FileName(word));
            }
            return;
        }
        if hash.name == "#DELETE" {
            for argument in &hash.arguments {
                if let Operand::Expression(place) = argument {
                    self.deletes(*place, block, at);
                }
            }
            return;
        }
        if let Some(axes) = self.run.defined_axes(&hash.name, hash.rest.of(at.text)) {
            self.effect(Effect::Coupling(axes));
            return;
        }
        self.effect(Effect::Hash(hash.name.clone()));
        if let Some((point, code)) = point_behind(hash, at) {
            let inner = At { text: &code, ..*at };
            let items = point.items.iter().filter_map(|item| match item {
                Item::Word(word) => Some(word),
                _ => None,
            });
            for word in point.words.iter().chain(items) {
                self.word(word, &point, &inner);
            }
        }
    }

    fn assigns(&mut self, place: Expression, block: &Block, at: &At<'_>) {
        if let Some(target) = Self::target(place, block, at) {
            self.writes(target);
        }
    }

    /// A deleted variable is unknown, and so are the elements that it may have.
    fn deletes(&mut self, place: Expression, block: &Block, at: &At<'_>) {
        let target = Self::target(place, block, at);
        match &target {
            Some(Target::Variable(name)) => self.writes(Target::Elements(name.clone())),
            Some(Target::Parameter(Owner::Program, index)) => {
                self.writes(Target::Elements(format!("P{index}")));
            }
            _ => {}
        }
        if let Some(target) = target {
            self.writes(target);
        }
    }

    /// What an assignment could write. A place that has to be computed may be another one each time.
    fn target(place: Expression, block: &Block, at: &At<'_>) -> Option<Target> {
        let root = place.end.checked_sub(1)?;
        let inner = place.start as usize..root as usize;
        let operands = block.nodes.get(inner).unwrap_or_default();
        let is_plain = operands.iter().all(|node| matches!(node, Node::Number(_)));
        let root = root as usize;
        let (node, span) = (block.nodes.get(root)?, block.spans.get(root)?);
        let name = || {
            let name = span.of(at.text).split('[').next().unwrap_or_default();
            canonical(name).into_owned()
        };
        Some(match node {
            Node::Parameter { owner, index } => Target::Parameter(*owner, *index),
            Node::Variable { subscripts: 0 } => Target::Variable(name()),
            Node::Variable { .. } if is_plain => {
                let values: Vec<String> = operands.iter().map(subscript).collect();
                let name = with_subscripts(span.of(at.text), &values);
                Target::Variable(name)
            }
            Node::Variable { .. } => Target::Elements(name()),
            Node::IndexedParameter { owner, subscripts } => {
                let index = match operands.first() {
                    Some(Node::Number(number)) if is_plain || *subscripts > 0 => rounded(*number),
                    _ => None,
                };
                let index = index.and_then(|index| u32::try_from(index).ok());
                match (index, *subscripts) {
                    (Some(index), 0) => Target::Parameter(*owner, index),
                    (Some(index), _) if is_plain => {
                        let mut element = format!("P{index}");
                        for node in &operands[1..] {
                            element.extend(["[", &subscript(node), "]"]);
                        }
                        Target::Variable(element)
                    }
                    (Some(index), _) => Target::Elements(format!("P{index}")),
                    (None, _) => Target::Parameters,
                }
            }
            Node::Unread => Target::Parameters,
            _ => return None,
        })
    }

    fn word(&mut self, word: &Word, block: &Block, at: &At<'_>) {
        let number = match word.value {
            Some(Operand::Number(number)) => rounded(number),
            _ => None,
        };
        match (word.address, number) {
            (Address::Letter(b'M'), Some(2 | 30)) => self.exit(Exit::End),
            (Address::Letter(b'M'), Some(17 | 29)) => self.exit(Exit::Return),
            _ => {}
        }
        match word.address {
            Address::Letter(b'G') => self.g(number),
            Address::Letter(b'F') => self.effect(Effect::Feeds),
            Address::Letter(b'R') => self.effect(Effect::Radius),
            Address::Letter(letter @ b'A'..=b'Z') if !is_letter(letter) => {
                self.effect(Effect::All);
            }
            Address::Lower(letter) => {
                let upper = letter.to_ascii_uppercase();
                if let Some(axis) = self.run.letters[usize::from(upper - b'A')] {
                    self.axis(axis, block);
                }
            }
            Address::Letter(letter @ (b'M' | b'T' | b'D')) => {
                self.effect(Effect::Function(letter, number));
            }
            Address::Letter(letter @ b'A'..=b'Z') => {
                if let Some(axis) = self.run.letters[usize::from(letter - b'A')] {
                    self.axis(axis, block);
                }
            }
            // Which axis it is depends on the plane, which the region may change.
            Address::Main(_) => self.effect(Effect::Positions),
            Address::Name(name) => {
                if let Some(&axis) = self.run.names.get(name.of(at.text)) {
                    self.axis(axis, block);
                }
            }
            Address::Letter(_) => {}
        }
    }

    fn g(&mut self, number: Option<i64>) {
        let plain = number.and_then(|number| u32::try_from(number).ok());
        let matters =
            plain.is_none_or(|number| Group::of(number).is_some() || (20..=23).contains(&number));
        if matters || number == Some(151) {
            self.effect(Effect::G(number));
        }
        if plain.is_none_or(|number| Group::of(number).is_none()) {
            self.effect(Effect::Function(b'G', number));
        }
    }

    fn axis(&mut self, axis: AxisIndex, block: &Block) {
        let is_reference = |word: &Word| {
            word.address == Address::Letter(b'G') && word.value == Some(Operand::Number(92.0))
        };
        let after = block.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        let effect = if block.words.iter().chain(after).any(is_reference) {
            Effect::Reference(axis)
        } else {
            Effect::Position(axis)
        };
        self.effect(effect);
    }
}
