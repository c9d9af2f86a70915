//! Parts of programs: `L SEQUENCE` (R2.77), and M17 and M29 with a place to return to (R2.78).

use serde::{Deserialize, Serialize};

use super::at::At;
use super::block::Intent;
use super::budget::ITEM;
use super::call::{Found, Wanted};
use super::program::{EntryIndex, LabelName};
use super::run::Interpreter;
use super::state::Step;
use super::value::{Value, rounded};
use crate::diagnostic::{Code, Diagnostic};
use crate::syntax::Fault;
use crate::syntax::ast::{Block, CallName, CallScope, JumpTarget, Levels, Return, Sequence};
use crate::text::Span;

/// The blocks of a program that a frame executes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Passage {
    pub(super) first: EntryIndex,
    pub(super) last: EntryIndex,
    /// How often they are executed again.
    left: u64,
    /// How many blocks had been executed when this pass began.
    begun: u64,
}

/// What `L SEQUENCE` asks for.
#[derive(Debug, Clone)]
pub(super) struct Part {
    first: LabelName,
    last: Option<LabelName>,
    /// Whether the call itself ends the part, too.
    end_tag: bool,
    passes: u64,
    /// Whether it is one of the program that is executed.
    here: bool,
}

/// Where M17 returns to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Destination {
    level: u32,
    /// The block, where it is not the one that follows the call.
    entry: Option<EntryIndex>,
}

/// A block of a main program that is read line by line, and what is said where it never comes.
#[derive(Debug)]
pub(super) struct Sought {
    pub(super) label: LabelName,
    pub(super) missing: Diagnostic,
}

impl Destination {
    /// The call depth of the program.
    pub(super) fn level(&self) -> u32 {
        self.level
    }

    /// The block, where it is not the one after the call.
    pub(super) fn entry(&self) -> Option<EntryIndex> {
        self.entry
    }
}

impl Passage {
    /// The start of the next pass, when there is one. A pass of blocks that are all skipped is the
    /// last one.
    pub(super) fn again(&mut self, executed: u64) -> Option<EntryIndex> {
        if self.left == 0 || executed == self.begun {
            return None;
        }
        self.left -= 1;
        self.begun = executed;
        Some(self.first)
    }
}

impl Interpreter {
    /// `L SEQUENCE […]`
    pub(super) fn sequence(
        &mut self,
        sequence: &Sequence,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let span = sequence.span;
        let name = match sequence.name {
            None => String::new(),
            Some(name) => match self.called_name(name, block, at)? {
                Value::Text(name) => name.trim().to_owned(),
                Value::Unknown(cause) => {
                    self.unknown_program(&cause, (span, at));
                    return Ok(());
                }
                Value::Number(_) => {
                    return Err(Box::new(Fault::new(
                        Code::Fc312,
                        span,
                        "a number is not a program name",
                    )));
                }
            },
        };
        let passes = match sequence.passes {
            None => Value::Number(1.0),
            Some(passes) => self.value(passes, block, at)?,
        };
        let Some(passes) = passes.number().and_then(rounded) else {
            self.unknown_program("REPEAT", (span, at));
            return Ok(());
        };
        let first = self.label_of(sequence.first, span, (block, at))?;
        let last = match sequence.last {
            Some(last) => self.label_of(last, span, (block, at))?.map(Some),
            None => Some(None),
        };
        let (Some(first), Some(last)) = (first, last) else {
            self.unknown_program("N", (span, at));
            return Ok(());
        };
        let part = Part {
            first,
            last,
            end_tag: sequence.end_tag,
            passes: u64::try_from(passes).unwrap_or_default().max(1),
            here: name.is_empty(),
        };
        let wanted = Wanted::program(CallScope::Global, name, at.in_block(span));
        intent.calls.push(Wanted {
            part: Some(part),
            ..wanted
        });
        Ok(())
    }

    /// The name of a called program.
    fn called_name(
        &mut self,
        name: CallName,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Value, Box<Fault>> {
        Ok(match name {
            CallName::Literal(span) => Value::Text(span.of(at.text).into()),
            CallName::Quoted(span) => {
                let name = super::expression::unquoted(span.of(at.text));
                self.state.memory.macro_or_text(name)
            }
            CallName::Variable(place) => {
                self.value(crate::syntax::ast::Operand::Expression(place), block, at)?
            }
        })
    }

    /// What a target names; `None` where that is not known offline.
    fn label_of(
        &mut self,
        target: JumpTarget,
        span: Span,
        (block, at): (&Block, &At<'_>),
    ) -> Result<Option<LabelName>, Box<Fault>> {
        let value = match target {
            JumpTarget::Label(name) => {
                return Ok(Some(LabelName::Text(name.of(at.text).to_owned())));
            }
            JumpTarget::Number(operand) => self.value(operand, block, at)?,
            JumpTarget::Variable(place) => {
                self.value(crate::syntax::ast::Operand::Expression(place), block, at)?
            }
        };
        match value {
            Value::Number(number) => Ok(rounded(number).map(LabelName::Number)),
            Value::Text(name) => Ok(Some(LabelName::Text(name.to_string()))),
            Value::Unknown(_) => {
                let _ = span;
                Ok(None)
            }
        }
    }

    /// The block of a section that a jump label or a block number names.
    pub(super) fn block_of(
        &mut self,
        (unit, section): (usize, usize),
        name: &LabelName,
    ) -> Option<EntryIndex> {
        if let Some(entry) = self.units[unit].index.label(section, name.clone()) {
            return Some(entry);
        }
        let LabelName::Number(number) = name else {
            return None;
        };
        let index = &self.units[unit].index;
        if !self.numbers.contains_key(&(unit, section)) {
            let numbers = index.numbers(section);
            self.state.charge(ITEM * index.entries.len());
            self.numbers.insert((unit, section), numbers);
        }
        self.numbers.get(&(unit, section))?.get(number).copied()
    }

    /// The place of the program that is executed.
    pub(super) fn current_program(&self) -> Option<Found> {
        let frame = self.state.frames.last()?;
        Some(Found {
            unit: frame.unit,
            section: frame.section,
        })
    }

    /// Whether a part is one of the program that is executed.
    pub(super) fn is_here(&self, wanted: &Wanted) -> bool {
        let own_name = || {
            let found = self.current_program()?;
            let index = &self.units[found.unit].index;
            index.sections[found.section].name.clone()
        };
        wanted
            .part
            .as_ref()
            .is_some_and(|part| part.here || own_name().as_deref() == Some(&*wanted.name))
    }

    /// The blocks that a call asks for; `Err` where they are not in the program.
    pub(super) fn passage(
        &mut self,
        wanted: &Wanted,
        found: Found,
        at: &At<'_>,
    ) -> Result<Option<Passage>, ()> {
        let Some(part) = &wanted.part else {
            return Ok(None);
        };
        let place = (found.unit, found.section);
        let here = self.current_program() == Some(found);
        let call = self
            .state
            .frames
            .last()
            .map(|frame| frame.next.saturating_sub(1));
        let end = self.units[found.unit].index.sections[found.section].end;
        let first = self.block_of(place, &part.first);
        let last = match &part.last {
            Some(last) => self.block_of(place, last).map(Some),
            None => Some(None),
        };
        let (Some(first), Some(last)) = (first, last) else {
            let missing = match first {
                None => &part.first,
                Some(_) => part.last.as_ref().unwrap_or(&part.first),
            };
            self.no_block(missing, (found.unit, wanted.span), at);
            return Err(());
        };
        // The part ends in front of its call.
        let tag = call.filter(|call| part.end_tag && here && *call > first);
        let tag = tag.map(|call| call - 1);
        let last = last.filter(|last| *last >= first);
        let last = match (last, tag) {
            (Some(last), Some(tag)) => last.min(tag),
            (Some(last), None) => last,
            (None, Some(tag)) => tag,
            // Without an end the block alone is executed; one that stands before it never comes.
            (None, None) if part.last.is_none() && !part.end_tag => first,
            (None, None) => end.saturating_sub(1),
        };
        Ok(Some(Passage {
            first,
            last,
            left: part.passes - 1,
            begun: self.state.seq,
        }))
    }

    /// Says that a program has no such block; what was read line by line is not kept.
    fn no_block(&mut self, name: &LabelName, (unit, span): (usize, Span), at: &At<'_>) {
        let source = &self.units[unit].index.source;
        let is_cut = unit == 0 && (source.name().is_empty() || source.lines().first() > 1);
        let fault = if is_cut {
            self.forget_all(&"L SEQUENCE".into());
            Fault::new(
                Code::Fc902,
                span,
                format!("`{name}` is in a part of the program that was read line by line and is not kept; the call is passed over, and every axis becomes unknown"),
            )
            .with_help("give the program as a file")
        } else {
            Fault::new(
                Code::Fc209,
                span,
                format!("block `{name}` does not exist in this program"),
            )
        };
        self.work.diagnostics.push(at.diagnostic(fault));
    }

    /// `M17 [MAIN [LABEL]]`
    pub(super) fn return_to(
        &mut self,
        back: &Return,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let here = self.state.frames.last().map_or(0, |frame| frame.level);
        let level = match back.levels {
            Levels::One => here.saturating_sub(1),
            Levels::Main => 0,
            Levels::Number(operand) => {
                let value = self.value(operand, block, at)?;
                if let Value::Unknown(cause) = &value {
                    self.unknown_program(cause, (back.span, at));
                    intent.returns = true;
                    return Ok(());
                }
                let number = value
                    .number()
                    .and_then(rounded)
                    .filter(|number| *number > 0);
                let Some(number) = number else {
                    return Err(Box::new(Fault::new(
                        Code::Fc312,
                        back.span,
                        "`JUMPS` is a number of programs, 1 or more",
                    )));
                };
                let number = u32::try_from(number).unwrap_or(u32::MAX);
                self.warn_too_many_jumps((number, here), back.span, at);
                here.saturating_sub(number)
            }
        };
        if here == 0 {
            intent.returns = true;
            return Ok(());
        }
        let entry = match back.target {
            None => None,
            Some(target) => {
                let Some(name) = self.label_of(target, back.span, (block, at))? else {
                    self.unknown_program("N", (back.span, at));
                    intent.step = Some(Step::ReturnTo(Destination { level, entry: None }));
                    return Ok(());
                };
                let frame = self.state.frames.iter().find(|frame| frame.level == level);
                let place = frame.map_or((0, 0), |frame| (frame.unit, frame.section));
                let found = self.block_of(place, &name);
                if found.is_none() {
                    let missing = Fault::new(
                        Code::Fc209,
                        back.span,
                        format!(
                            "jump label `{name}` does not exist in the program that is returned to"
                        ),
                    );
                    let arrives = self.units[place.0].index.source.name().is_empty();
                    if !arrives || level > 0 {
                        return Err(Box::new(missing));
                    }
                    self.sought = Some(Sought {
                        label: name,
                        missing: at.diagnostic(missing),
                    });
                }
                found
            }
        };
        intent.step = Some(Step::ReturnTo(Destination { level, entry }));
        Ok(())
    }

    /// FC317: the control warns and goes back to the main program (PM/206781707). A subprogram that
    /// is run by itself is none.
    fn warn_too_many_jumps(&mut self, (number, here): (u32, u32), span: Span, at: &At<'_>) {
        if here == 0 || number <= here {
            return;
        }
        let programs = if here == 1 { "program" } else { "programs" };
        let message = format!(
            "`JUMPS` leaves {number} programs, but only {here} {programs} can be left here; the main program continues"
        );
        let fault = Fault::new(Code::Fc317, span, message)
            .with_help("`M17 [MAIN]` says that the main program is meant");
        self.work.diagnostics.push(at.diagnostic(fault));
    }

    /// Leaves programs down to the one that is returned to.
    pub(super) fn go_back(&mut self, to: &Destination) {
        while self
            .state
            .frames
            .last()
            .is_some_and(|frame| frame.level > to.level)
        {
            self.leave();
        }
        if let Some(frame) = self.state.frames.last_mut() {
            frame.waiting.clear();
            if let Some(entry) = to.entry {
                frame.next = entry;
                frame.seeking = None;
            }
        }
    }
}
