//! What cannot be known offline: a region that may or may not be executed makes unknown whatever
//! it could change (R2.50, R2.51).

use std::ops::Range;
use std::sync::Arc;

use super::call::Wanted;
use super::program::EntryIndex;
use super::{At, Interpreter, Step, Value};
use crate::codes::Code;
use crate::diagnostic::Place;
use crate::machine::AxisIndex;
use crate::source::Span;
use crate::syntax::Fault;
use crate::syntax::ast::{Address, Block, CallName, Flow, Item, Operand, Word};

/// A call found in a region that may or may not be executed.
#[derive(Debug, Clone)]
pub(super) struct Scan {
    pub(super) call: Wanted,
    pub(super) cause: Arc<str>,
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
            if let Some(mut reader) = self.units[unit].index.reader(entry) {
                if let Some(raw) = reader.next(&mut block) {
                    raw.text.clone_into(&mut text);
                }
            }
            let file = self.units[unit].index.source.name().clone();
            let at = At {
                file: &file,
                text: &text,
                line: self.units[unit].index.entries[entry as usize].line,
                remark: None,
                level: 0,
                called_from: None::<&Place>,
                macro_depth: 0,
            };
            for item in &block.items {
                self.forget_item(item, &block, &at, cause);
            }
        }
    }

    fn forget_item(&mut self, item: &Item, block: &Block, at: &At<'_>, cause: &Arc<str>) {
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
                self.forget_target(assignment.target.place, block, at, cause)
            }
            Item::Flow(Flow::For { counter, .. }, _) => {
                self.forget_target(counter.place, block, at, cause)
            }
            Item::Flow(Flow::Switch(Some(target), _), _) => {
                self.forget_target(target.place, block, at, cause)
            }
            Item::Word(word) => self.forget_word(word, at, cause),
            Item::Call(call) => {
                let name = match call.name {
                    CallName::Literal(span) => span.of(at.text),
                    CallName::Quoted(span) => span.of(at.text).trim_matches('"'),
                    CallName::Variable(_) => return,
                };
                let name = self
                    .state
                    .memory
                    .macro_code(name)
                    .unwrap_or(name)
                    .to_owned();
                self.pending.push(Scan {
                    call: Wanted {
                        scope: call.scope,
                        name,
                        own: std::collections::BTreeMap::new(),
                        span: call.span,
                        repeat: None,
                    },
                    cause: cause.clone(),
                });
            }
            Item::GCall(call) => self.forget_configured(&format!("G{}", call.number), cause),
            _ => {}
        }
    }

    fn forget_target(
        &mut self,
        place: crate::syntax::ast::Expression,
        block: &Block,
        at: &At<'_>,
        cause: &Arc<str>,
    ) {
        if let Ok(place) = self.target_place(place, block, at) {
            self.write(place, Value::Unknown(cause.clone()));
        }
    }

    fn forget_word(&mut self, word: &Word, at: &At<'_>, cause: &Arc<str>) {
        let number = match word.value {
            Some(Operand::Number(number)) => super::value::rounded(number),
            _ => None,
        };
        match word.address {
            Address::Letter(b'G') => self.state.modal.forget_g(number),
            Address::Letter(letter @ (b'M' | b'T')) => {
                let letter = char::from(letter);
                let number = number.map(|number| number.to_string()).unwrap_or_default();
                self.forget_configured(&format!("{letter}{number}"), cause);
            }
            Address::Letter(letter @ b'A'..=b'Z') => {
                if let Some(axis) = self.letters[usize::from(letter - b'A')] {
                    self.forget_axis(axis);
                }
            }
            Address::Name(name) => {
                if let Some(&axis) = self.names.get(name.of(at.text)) {
                    self.forget_axis(axis);
                }
            }
            _ => {}
        }
    }

    fn forget_axis(&mut self, axis: AxisIndex) {
        self.see(axis);
        self.state.modal.forget_position(axis);
    }

    fn forget_configured(&mut self, word: &str, cause: &Arc<str>) {
        let head = &word[..1];
        let words = if head == "G" {
            [word, word]
        } else {
            [word, head]
        };
        if let Some(call) = self.configured(words, Span::default()) {
            self.pending.push(Scan {
                call,
                cause: cause.clone(),
            });
        }
    }
}
