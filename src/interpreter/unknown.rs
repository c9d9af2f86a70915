//! What cannot be known offline: a region that may or may not be executed makes unknown whatever
//! it could change (R2.50, R2.51).

use std::ops::Range;
use std::sync::Arc;

use super::call::Wanted;
use super::event::Notes;
use super::expression::Place;
use super::hash::declared_name;
use super::program::EntryIndex;
use super::{At, Interpreter, Step, Value};
use crate::codes::Code;
use crate::machine::AxisIndex;
use crate::source::Span;
use crate::syntax::ast::{
    Address, Block, Call, CallName, Expression, Flow, Hash, Item, Node, Operand, Word,
};
use crate::syntax::{Comments, Fault};

/// A call found in a region that may or may not be executed.
#[derive(Debug, Clone)]
pub(super) struct Scan {
    pub(super) call: Wanted,
    pub(super) cause: Arc<str>,
    /// The file that holds the call.
    pub(super) unit: usize,
}

impl Interpreter {
    /// Passes over a control block, from its statement to its end, and says so (FC901).
    pub(super) fn skip_unknown(
        &mut self,
        (from, to): (EntryIndex, EntryIndex),
        cause: &Arc<str>,
        span: Span,
        at: &At<'_>,
    ) -> Option<Step> {
        let fault = Fault::new(
            Code::Fc901,
            span,
            format!("this control block hangs on `{cause}`, which only the machine knows; what it could change is unknown from here"),
        )
        .with_help(super::flow::how_to_set(cause));
        self.work.diagnostics.push(at.diagnostic(fault));
        let unit = self.state.frames.last()?.unit;
        self.forget_region(unit, from..to, cause);
        Some(Step::Jump(to + 1))
    }

    /// Makes unknown what the blocks of a region could change. Calls are kept for later, when
    /// their programs can be looked for.
    pub(super) fn forget_region(
        &mut self,
        unit: usize,
        region: Range<EntryIndex>,
        cause: &Arc<str>,
    ) {
        for entry in region {
            let mut block = Block::default();
            let mut text = String::new();
            if let Some(mut reader) = self.units[unit].index.reader(entry)
                && let Some(raw) = reader.next(&mut block)
            {
                raw.text.clone_into(&mut text);
            }
            let file = self.units[unit].index.source.name().clone();
            let at = At {
                file: &file,
                text: &text,
                line: self.units[unit].index.entries[entry as usize].line,
                comments: Comments::Possible,
                remark: None,
                level: 0,
                called_from: None,
                macro_depth: 0,
                used: None,
            };
            self.note_reads(&block, &at);
            for word in &block.words {
                self.forget_word((word, &block, unit), &at, cause);
            }
            for item in &block.items {
                self.forget_item(item, (&block, unit), &at, cause);
            }
        }
    }

    /// Notes the values of the machine that a block would read.
    fn note_reads(&mut self, block: &Block, at: &At<'_>) {
        if self.options.notes == Notes::None {
            return;
        }
        let items = (0..block.nodes.len()).filter_map(|place| u32::try_from(place).ok());
        for start in items {
            if matches!(
                block.nodes[start as usize],
                Node::Variable { subscripts: 0 }
            ) {
                let end = start + 1;
                let read = Operand::Expression(Expression { start, end });
                let _ = self.value(read, block, at);
            }
        }
    }

    fn forget_item(
        &mut self,
        item: &Item,
        (block, unit): (&Block, usize),
        at: &At<'_>,
        cause: &Arc<str>,
    ) {
        match item {
            Item::Comp(command) => {
                if let Ok(axis) = self.state.compensation.resolve(&command.axis) {
                    self.see(axis);
                    let kinds = command.selection.kinds();
                    self.state
                        .compensation
                        .forget(axis, kinds, &mut self.work.changes);
                }
            }
            Item::Assign(assignment) => {
                self.forget_target(assignment.target.place, block, at, cause);
            }
            Item::Flow(Flow::For { counter, .. }, _) => {
                self.forget_target(counter.place, block, at, cause);
            }
            Item::Flow(Flow::Switch(Some(target), _), _) => {
                self.forget_target(target.place, block, at, cause);
            }
            Item::Word(word) => self.forget_word((word, block, unit), at, cause),
            Item::Call(call) => match call.name {
                CallName::Literal(span) => {
                    self.forget_call(call, (span.of(at.text), unit), cause);
                }
                CallName::Quoted(span) => {
                    self.forget_call(
                        call,
                        (super::expression::unquoted(span.of(at.text)), unit),
                        cause,
                    );
                }
                CallName::Variable(_) => self.forget_all(),
            },
            Item::GCall(call) => {
                self.forget_configured(&format!("G{}", call.number), unit, cause);
            }
            Item::Hash(hash) => self.forget_hash(hash, at, cause),
            Item::MacroUse(span) => self.forget_macro((*span, unit), at, cause),
            Item::MacroDefinition(..)
            | Item::BadCommand(_)
            | Item::Bracket { .. }
            | Item::BareNumber(..)
            | Item::Label(_)
            | Item::Flow(..) => {}
        }
    }

    fn forget_call(&mut self, call: &Call, (name, unit): (&str, usize), cause: &Arc<str>) {
        let name = self.state.memory.macro_code(name).unwrap_or(name);
        self.pending.push(Scan {
            call: Wanted::program(call.scope, name.to_owned(), call.span),
            cause: cause.clone(),
            unit,
        });
    }

    fn forget_hash(&mut self, hash: &Hash, at: &At<'_>, cause: &Arc<str>) {
        for declaration in &hash.declarations {
            let name = declared_name(declaration, at);
            self.state
                .memory
                .declare(&name, Value::Unknown(cause.clone()));
            self.state.memory.forget_elements(&name, cause);
        }
        self.state.modal.forget_hash(&hash.name);
    }

    /// The code of a macro is scanned as a block of its own.
    fn forget_macro(&mut self, (span, unit): (Span, usize), at: &At<'_>, cause: &Arc<str>) {
        let name = super::expression::unquoted(span.of(at.text));
        let Some(code) = self.state.memory.macro_code(name).map(str::to_owned) else {
            return;
        };
        if at.macro_depth >= self.options.limits.macros {
            return;
        }
        let block = crate::syntax::parse_block(&code);
        let inner = At {
            text: &code,
            macro_depth: at.macro_depth + 1,
            ..*at
        };
        // A macro that uses itself several times would be scanned without end.
        let uses = |item: &&Item| !matches!(item, Item::MacroUse(inner) if super::expression::unquoted(inner.of(&code)) == name);
        for word in &block.words {
            self.forget_word((word, &block, unit), &inner, cause);
        }
        for item in block.items.iter().filter(uses) {
            self.forget_item(item, (&block, unit), &inner, cause);
        }
    }

    fn forget_target(&mut self, place: Expression, block: &Block, at: &At<'_>, cause: &Arc<str>) {
        if let Ok(place) = self.target_place(place, block, at) {
            match place {
                // The region writes it nowhere that is known.
                Place::Nowhere => {}
                place => self.write(place, Value::Unknown(cause.clone())),
            }
        }
    }

    fn forget_word(
        &mut self,
        (word, block, unit): (&Word, &Block, usize),
        at: &At<'_>,
        cause: &Arc<str>,
    ) {
        let number = match word.value {
            Some(Operand::Number(number)) => super::value::rounded(number),
            _ => None,
        };
        match word.address {
            Address::Letter(b'G') => {
                self.state.modal.forget_g(number);
                let name = number.map(|number| format!("G{number}"));
                self.forget_configured(&name.unwrap_or_default(), unit, cause);
            }
            Address::Letter(b'F') => self.state.modal.feeds = [None; 3],
            Address::Letter(b'R') => self.state.modal.radius = None,
            Address::Letter(letter @ (b'M' | b'T')) => {
                let letter = char::from(letter);
                let number = number.map(|number| number.to_string()).unwrap_or_default();
                self.forget_configured(&format!("{letter}{number}"), unit, cause);
            }
            Address::Letter(letter @ b'A'..=b'Z') => {
                if let Some(axis) = self.letters[usize::from(letter - b'A')] {
                    self.forget_axis(axis, block);
                }
            }
            Address::Main(letter) => match self.main_axis(letter) {
                Some(axis) => self.forget_axis(axis, block),
                None => self.state.modal.forget_positions(),
            },
            Address::Name(name) => {
                if let Some(&axis) = self.names.get(name.of(at.text)) {
                    self.forget_axis(axis, block);
                }
            }
            _ => {}
        }
    }

    fn forget_axis(&mut self, axis: AxisIndex, block: &Block) {
        self.see(axis);
        let is_reference = |word: &Word| {
            word.address == Address::Letter(b'G') && word.value == Some(Operand::Number(92.0))
        };
        let behind = block.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        if block.words.iter().chain(behind).any(is_reference) {
            self.state.modal.forget_reference(axis);
        } else {
            self.state.modal.forget_position(axis);
        }
    }

    fn forget_configured(&mut self, word: &str, unit: usize, cause: &Arc<str>) {
        let Some(head) = word.get(..1) else {
            return;
        };
        let words = if head == "G" {
            [word, word]
        } else {
            [word, head]
        };
        if let Some(call) = self.configured(words, Span::default()) {
            self.pending.push(Scan {
                call,
                cause: cause.clone(),
                unit,
            });
        }
    }
}
