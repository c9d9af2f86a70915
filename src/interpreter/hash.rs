//! `#` commands (R2.34, R2.47) and axis couplings.

use std::sync::Arc;

use super::at::{At, Shown};
use super::block::Intent;
use super::chain;
use super::cycles::ModalCycles;
use super::event::EndedBy;
use super::exchange::is_exchange;
use super::expression::Place;
use super::implicit::is_file_name;
use super::options::StopPolicy;
use super::run::Interpreter;
use super::state::{Description, Retains, Step};
use super::value::Value;
use super::variable::canonical;
use super::words::AxisWords;
use crate::comp::AxisIndex;
use crate::diagnostic::{Code, Diagnostic};
use crate::syntax::Fault;
use crate::syntax::ast::{Block, Declaration, Hash, Operand};
use crate::text::Span;

impl Interpreter {
    pub(super) fn hash(
        &mut self,
        hash: &Hash,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let rest = hash.rest.of(at.text);
        match hash.name.as_str() {
            "#VAR" => return self.declare(&hash.declarations, block, at),
            "#DELETE" => return self.delete(hash, block, at),
            "#TIME" => {
                intent.axis_words = AxisWords::Other;
                self.work.dwells = true;
                if let Some(&time) = hash.arguments.first() {
                    let seconds = self.value(time, block, at)?.number();
                    self.geometry().dwell = Some(seconds);
                }
            }
            // PM/207120267
            "#SET AX LINK" | "#AX LINK" => {
                let axes = self.axes_in(rest);
                self.define_coupling((rest, axes), at);
            }
            "#SET AX LINK NBR" | "#AX LINK NBR" => {
                let axes = self.axes_by_number(rest);
                self.define_coupling((rest, axes), at);
            }
            // PM/207133579
            "#ENABLE AX LINK" | "#AX LINK ON" => self.enable_coupling((rest, hash.span), at),
            "#DISABLE AX LINK" | "#AX LINK OFF" => self.disable_coupling(rest, at),
            "#DISABLE AX LINK ALL" | "#AX LINK OFF ALL" => self.release_couplings(),
            "#DISABLE MODAL CYCLE" => self.state.cycles = ModalCycles::default(),
            "#INIT MACRO TAB" => {
                self.state.memory.clear_macros();
                self.define_machine_macros();
            }
            "#RETAIN CYCLE CHANGES" => self.retain_cycle_changes(),
            "#COMMENT END" | "#ENDVAR" => {}
            name if is_file_name(name) => self.name_programs(hash, at),
            opener if description_end(opener).is_some() => self.describe(hash, at),
            end if self.ends_description(end) => {
                if let Some(description) = self.state.described.take() {
                    self.state.modal.end_description(&description.before);
                }
            }
            "#RT WHILE" => self.real_time_loop(hash.span, at, intent),
            "#RT ENDWHILE" => {}
            "#ERROR" => self.report_error(hash, at, intent),
            name if is_exchange(name) => self.exchange_axes(hash, at),
            name => {
                self.state.modal.hash(name);
                for target in &hash.written {
                    let place = self.target_place(target.place, block, at)?;
                    self.write(place, Value::Unknown(name.into()));
                }
                let word = match chain::command(name) {
                    Some((words, ..)) => words,
                    None => name.trim_end_matches(" OFF").trim_end_matches(" ON"),
                };
                self.pass_over(word, hash.span, at);
                if let Some((point, code)) = point_behind(hash, at) {
                    let inner = At { text: &code, ..*at };
                    self.items(&point, &inner, intent, None);
                    self.take_faults(&point, &inner, false);
                }
                if name.starts_with("#MACHINE DATA") && names_friction(rest) {
                    return Err(Box::new(
                        Fault::new(
                            Code::Fc314,
                            hash.span,
                            "the program writes friction parameters into the machine data",
                        )
                        .with_help("from here on the machine may differ from its lists; this run continues with the lists"),
                    ));
                }
            }
        }
        Ok(())
    }

    /// The blocks up to the end describe geometry.
    fn describe(&mut self, hash: &Hash, at: &At<'_>) {
        if self.state.described.is_none() {
            self.state.described = Some(Box::new(Description {
                opener: hash.name.clone(),
                place: at.place(hash.span),
                before: self.state.modal.clone(),
            }));
        }
    }

    /// Whether a command ends the description that is open.
    fn ends_description(&self, name: &str) -> bool {
        let open = self.state.described.as_ref();
        open.is_some_and(|open| description_end(&open.opener) == Some(name))
    }

    /// FC208: the program ends inside a description.
    pub(super) fn open_description(&mut self) -> Option<Diagnostic> {
        let open = self.state.described.take()?;
        let end = description_end(&open.opener)?;
        let message = format!("`{}` has no `{end}`", open.opener);
        let help = format!("write `{end}` in a block of its own");
        Some(Diagnostic::new(Code::Fc208, open.place, message).with_help(help))
    }

    /// `#RT WHILE` runs as long as a variable of real time says so (tf5261, 783727499).
    fn real_time_loop(&mut self, span: Span, at: &At<'_>, intent: &mut Intent) {
        let (entry, end) = self.current_block();
        if end > entry {
            let cause = "V.RTG.LOOP.ENABLED".into();
            intent.step = self.skip_unknown((entry, end), &cause, span, at);
        }
    }

    /// FC318: the program reports an error of its own, with a remedy class that stops it. Without a
    /// class that is known it is taken for a warning (tf5200, 207457163).
    fn report_error(&mut self, hash: &Hash, at: &At<'_>, intent: &mut Intent) {
        self.pass_over("#ERROR", hash.span, at);
        let class = remedy_class(hash.rest.of(at.text));
        let class = class.and_then(|class| self.number_in(class, at));
        let Some(class) = class.filter(|class| *class >= 1.0) else {
            return;
        };
        let message =
            format!("the control stops here: the program reports an error with `RC={class}`");
        let fault = Fault::new(Code::Fc318, hash.span, message)
            .with_help("with `RC=0` it is a warning, and the program goes on");
        self.work.diagnostics.push(at.diagnostic(fault));
        if self.options.stop == StopPolicy::FirstError {
            intent.step = Some(Step::End(EndedBy::Error));
        }
    }

    /// The number that a text is, `2` or `P1+1`, if it is known.
    pub(super) fn number_in(&mut self, text: &str, at: &At<'_>) -> Option<f64> {
        let mut block = Block::default();
        let operand = crate::syntax::parse_expression(text, &mut block)?;
        let shown = Shown::default();
        let inner = At {
            text,
            shown: &shown,
            ..*at
        };
        match self.value(operand, &block, &inner) {
            Ok(Value::Number(number)) => Some(number),
            _ => None,
        }
    }

    /// The cycle that runs keeps what it did to G functions and feed.
    fn retain_cycle_changes(&mut self) {
        let cycle = self.state.frames.iter_mut().rev();
        if let Some(frame) = cycle.into_iter().find(|frame| frame.restores.is_some()) {
            frame.restores = None;
        }
    }

    fn define_coupling(&mut self, (rest, axes): (&str, Vec<AxisIndex>), at: &At<'_>) {
        let group = self.group_of(rest, at);
        self.work.wrote = true;
        let changed = self.state.couplings.define(&group, axes);
        self.mark_coupled(changed);
    }

    fn enable_coupling(&mut self, (rest, span): (&str, Span), at: &At<'_>) {
        let group = self.group_of(rest, at);
        match self.state.couplings.enable(&group) {
            Some(changed) => self.mark_coupled(changed),
            // A group of the channel parameters: which axes it couples is not known offline.
            None => self.pass_over("#ENABLE AX LINK", span, at),
        }
    }

    /// Without a group the last one that was enabled is released.
    fn disable_coupling(&mut self, rest: &str, at: &At<'_>) {
        let group = self.group_of(rest, at);
        let changed = if group.is_empty() {
            self.state.couplings.release_last()
        } else {
            self.state.couplings.release(&group)
        };
        self.mark_coupled(changed);
    }

    /// Couplings end with the program unless P-CHAN-00105 says otherwise; their definitions stay.
    pub(super) fn release_couplings(&mut self) {
        let changed = self.state.couplings.release_all();
        self.mark_coupled(changed);
    }

    /// Any coupling may be in force, or none.
    pub(super) fn doubt_couplings(&mut self) {
        let changed = self.state.couplings.doubt();
        self.mark_coupled(changed);
    }

    /// Groups may couple these axes of which nobody knows which.
    pub(super) fn doubt_definitions(&mut self, axes: &[AxisIndex]) {
        let changed = self.state.couplings.doubt_definitions(axes);
        self.mark_coupled(changed);
    }

    fn mark_coupled(&mut self, changed: Vec<AxisIndex>) {
        for axis in changed {
            let coupling = self.state.couplings.of(axis);
            self.state.compensation.set_coupled(axis, coupling);
        }
    }

    /// The axes that a definition of a coupling group names; `None` for any other command.
    pub(super) fn defined_axes(&self, name: &str, rest: &str) -> Option<Vec<AxisIndex>> {
        match name {
            "#SET AX LINK" | "#AX LINK" => Some(self.axes_in(rest)),
            "#SET AX LINK NBR" | "#AX LINK NBR" => Some(self.axes_by_number(rest)),
            _ => None,
        }
    }

    /// A command that may or may not have been executed (R2.51).
    pub(super) fn forget_hash(&mut self, name: &str, cause: &Arc<str>) {
        match name {
            "#DISABLE MODAL CYCLE" => self.state.cycles.doubt(),
            "#INIT MACRO TAB" => self.doubt_macros(cause),
            "#ENABLE AX LINK"
            | "#AX LINK ON"
            | "#DISABLE AX LINK"
            | "#AX LINK OFF"
            | "#DISABLE AX LINK ALL"
            | "#AX LINK OFF ALL" => self.doubt_couplings(),
            "#RETAIN CYCLE CHANGES" => {
                let frames = self.state.frames.iter_mut().rev();
                if let Some(frame) = frames.into_iter().find(|frame| frame.restores.is_some()) {
                    frame.retains = Retains::Perhaps;
                }
            }
            name if DESCRIPTIONS
                .iter()
                .any(|(begin, end)| [*begin, *end].contains(&name)) =>
            {
                // What follows may be a description, or not.
                let modal = &mut self.state.modal;
                modal.forget_g(None);
                modal.feeds = [None; 3];
                modal.radius = None;
                modal.note_transformed(name);
            }
            name => self.state.modal.forget_hash(name),
        }
    }

    /// The coupling group that `[1, …]` or `[P1+1]` names; empty without one.
    fn group_of(&mut self, rest: &str, at: &At<'_>) -> String {
        let inside = rest.trim_start().strip_prefix('[').unwrap_or_default();
        let text = inside.split([',', ']']).next().unwrap_or_default().trim();
        match self.number_in(text, at) {
            Some(number) => number.round().to_string(),
            None => text.to_owned(),
        }
    }

    fn axes_in(&self, text: &str) -> Vec<AxisIndex> {
        names_in(text)
            .filter_map(|word| self.machine.find(word))
            .collect()
    }

    /// The axes with the logical numbers of `[1, 8 = 2]`, the group left out.
    fn axes_by_number(&self, text: &str) -> Vec<AxisIndex> {
        let pairs = text.split_once(',').map_or("", |(_, pairs)| pairs);
        let numbers: Vec<u32> = names_in(pairs)
            .filter_map(|word| word.parse().ok())
            .collect();
        let axes = self.machine.axes.iter().enumerate();
        axes.filter(|(_, axis)| axis.number.is_some_and(|number| numbers.contains(&number)))
            .map(|(position, _)| AxisIndex::new(position))
            .collect()
    }

    fn delete(&mut self, hash: &Hash, block: &Block, at: &At<'_>) -> Result<(), Box<Fault>> {
        for argument in &hash.arguments {
            let Operand::Expression(place) = *argument else {
                continue;
            };
            match self.target_place(place, block, at)? {
                Place::Parameter(_, index) => {
                    self.state.ways.write_anything(self.state.seq);
                    self.state.memory.delete_parameter(index);
                }
                Place::Variable(name) => {
                    self.state.ways.write_anything(self.state.seq);
                    self.state.memory.delete(&name);
                }
                unknown @ (Place::Elements(_, _) | Place::Parameters(_)) => {
                    self.write(unknown, Value::Number(0.0));
                }
                Place::Nowhere => {}
            }
        }
        Ok(())
    }

    fn declare(
        &mut self,
        declarations: &[Declaration],
        block: &Block,
        at: &At<'_>,
    ) -> Result<(), Box<Fault>> {
        self.journal.begin_anew();
        self.state.ways.write_anything(self.state.seq);
        for declaration in declarations {
            let mut stack = std::mem::take(&mut self.work.stack);
            let dimensions = self.with_evaluator(block, at, |evaluator| {
                evaluator.dimensions(declaration.target.place, &mut stack)
            });
            self.work.stack = stack;
            let name = declared_name(declaration, at);
            let mut values = Vec::with_capacity(declaration.initial.len());
            for operand in &declaration.initial {
                values.push(self.value(*operand, block, at)?);
            }
            let default = if declaration.kind.as_deref() == Some("STRING") {
                Value::Text("".into())
            } else {
                Value::Number(0.0)
            };
            self.work.wrote = true;
            let memory = &mut self.state.memory;
            if dimensions.is_empty() {
                let value = values.into_iter().next().unwrap_or(default);
                match name.strip_prefix('P').map(str::parse) {
                    Some(Ok(index)) => memory.set_parameter(index, value),
                    _ => memory.declare(&name, value),
                }
                continue;
            }
            let elements: Vec<String> = (0..values.len())
                .map(|at| element(&name, &dimensions, at))
                .collect();
            memory.declare_array(&name, dimensions, default);
            for (element, value) in elements.iter().zip(values) {
                memory.declare(element, value);
            }
        }
        Ok(())
    }
}

/// The name that a declaration declares, without its dimensions.
pub(super) fn declared_name(declaration: &Declaration, at: &At<'_>) -> String {
    let text = declaration.target.span.of(at.text);
    let name = text.split('[').next().unwrap_or_default();
    canonical(name).into_owned()
}

/// The words that may stand after a command that switches a path, `#SPLINE ON X10 Y20`, as a block
/// whose spans are those of the whole.
pub(super) fn point_behind(hash: &Hash, at: &At<'_>) -> Option<(Block, String)> {
    let (_, step, _) = chain::command(&hash.name)?;
    if !matches!(step, chain::Step::Path | chain::Step::Machine) {
        return None;
    }
    let text = hash.span.of(at.text);
    let is_switch = |word: &&str| {
        let word = word.trim();
        word.eq_ignore_ascii_case("ON") || word.eq_ignore_ascii_case("OFF")
    };
    let mut length = 0;
    let mut words = text.split_inclusive([' ', '\t']);
    for word in words.by_ref() {
        length += word.len();
        if is_switch(&word) {
            break;
        }
    }
    let words = &text[length..];
    let first = words.split_whitespace().next()?;
    if first.starts_with('[') || first.eq_ignore_ascii_case("EX") {
        return None;
    }
    let code = " ".repeat(hash.span.start as usize + length) + words;
    Some((crate::syntax::parse_block(&code), code))
}

fn names_in(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
}

/// What stands after `RC` in the bracket of `#ERROR`, `[ID=455 RC=2]` or `[ID455 RC2]`.
fn remedy_class(text: &str) -> Option<&str> {
    let outside_of_texts = text.split('"').step_by(2);
    let mut words = outside_of_texts.flat_map(|part| part.split([' ', '\t', '[', ',']));
    let word = words.find_map(|word| word.strip_prefix("RC"))?;
    Some(word.trim_start_matches('=').trim_end_matches(']'))
}

fn names_friction(text: &str) -> bool {
    text.contains("lr_param.frict_comp") || text.contains("frict_comp.")
}

/// The name of the element at a place in row order.
fn element(name: &str, dimensions: &[u32], place: usize) -> String {
    let mut subscripts = Vec::with_capacity(dimensions.len());
    let mut rest = place;
    for size in dimensions.iter().rev() {
        let size = usize::try_from(*size).unwrap_or(usize::MAX).max(1);
        subscripts.push(rest % size);
        rest /= size;
    }
    let mut element = name.to_owned();
    for subscript in subscripts.iter().rev() {
        element.push('[');
        element.push_str(&subscript.to_string());
        element.push(']');
    }
    element
}

/// The commands between which blocks describe geometry and do not move: what a cycle shall cut
/// (tf5293, 717505035), a stroke, the limits of an area (tccncprogramming, 15557317259).
const DESCRIPTIONS: [(&str, &str); 3] = [
    ("#CONTOUR BEGIN", "#CONTOUR END"),
    ("#STROKE DEF BEGIN", "#STROKE DEF END"),
    ("#CONTROL AREA BEGIN", "#CONTROL AREA END"),
];

/// What ends the description that a command opens.
fn description_end(opener: &str) -> Option<&'static str> {
    let row = DESCRIPTIONS.iter().find(|(begin, _)| *begin == opener);
    row.map(|(_, end)| *end)
}
