//! One block: its words from left to right, then what it does as a whole.

use std::ops::ControlFlow;

use super::call::Wanted;
use super::expression::{Evaluator, Place, Scope};
use super::value::rounded;
use super::{
    At, EndedBy, Event, Executed, Finder, Group, Interpreter, Last, Observer, Outcome, Step,
    StopPolicy, Value, stops,
};
use crate::codes::Code;
use crate::compensation::{CompensationError, Coupling, State};
use crate::diagnostic::did_you_mean;
use crate::machine::{AxisIndex, AxisSet, CncBuild, Origin, Parameterisation};
use crate::source::Span;
use crate::syntax::ast::{
    Address, Assignment, Block, CallScope, Declaration, GCall, Hash, Item, Operand, Owner, Word,
};
use crate::syntax::{CompCommand, FastPath, Fault, Kind, KindSet, Selection};

/// What a block does after its words.
#[derive(Default)]
struct Intent {
    /// M02, M30.
    end: Option<EndedBy>,
    /// M17, M29.
    returns: bool,
    /// A jump, or a control block's business.
    step: Option<Step>,
    /// A call.
    call: Option<Wanted>,
    /// The G functions of the block, to find two of one group.
    groups: [Option<u32>; Group::COUNT],
    /// G04, G92 …: axis words are no motion.
    no_motion: bool,
    /// G92: axis words set the reference.
    reference: bool,
    /// The condition of an `$IF` in a block with `$GOTO`.
    condition: Option<Option<bool>>,
}

impl Interpreter {
    /// Executes a block and tells the observer. `Break` when the observer wants to stop.
    pub(super) fn execute(
        &mut self,
        block: &Block,
        at: &At<'_>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<(), Step> {
        self.work.clear();
        self.state.seq += 1;
        self.state.blocks += 1;
        let mut intent = Intent::default();
        let limit = self.first_refusal(block);
        self.items(block, at, &mut intent, limit);
        if !self.pending.is_empty() {
            self.forget_called(at, finder);
        }
        let call = intent.call.take();
        let call = call.and_then(|wanted| self.resolve(wanted, at, finder));
        let refused = self
            .work
            .diagnostics
            .iter()
            .find(|diagnostic| stops(diagnostic));
        let budget = refused.is_some_and(|diagnostic| diagnostic.code.text().starts_with("FC91"));
        let stopped =
            self.options.stop == StopPolicy::FirstError && (limit.is_some() || refused.is_some());
        self.take_faults(block, at, stopped);
        if !stopped {
            self.move_axes(&intent);
        }
        let number = self.block_number(block, at);
        if !self.work.changes.is_empty() || self.work.new_axes {
            self.version += 1;
        }
        self.remember_last(at);
        let step = if stopped {
            Step::End(if budget {
                EndedBy::Budget
            } else {
                EndedBy::Error
            })
        } else {
            let moved = !self.work.moved.is_empty();
            self.step((intent, call), moved, at, finder)
        };
        let flow = observer.event(Event::Executed(Executed {
            seq: self.state.seq,
            file: at.file,
            line: at.line,
            text: at.text,
            remark: at.remark,
            number,
            level: (at.level > 0).then_some(at.level),
            block,
            outcomes: &self.work.outcomes,
            changes: &self.work.changes,
            moved: if stopped { &[] } else { &self.work.moved },
            diagnostics: &self.work.diagnostics,
            stopped,
            compensation: &self.state.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        }));
        // They are said; what is left at program end belongs to no executed block.
        self.work.diagnostics.clear();
        match flow {
            ControlFlow::Continue(()) => ControlFlow::Continue(step),
            ControlFlow::Break(()) => {
                self.park(step);
                ControlFlow::Break(())
            }
        }
    }

    /// Where the control would refuse the block's text; nothing right of it is executed then.
    fn first_refusal(&self, block: &Block) -> Option<u32> {
        if self.options.stop != StopPolicy::FirstError {
            return None;
        }
        block
            .faults
            .iter()
            .find(|fault| fault.code.severity() == crate::diagnostic::Severity::Error)
            .map(|fault| fault.span.start)
    }

    /// Adds what is wrong with the text, up to the first error when that stops the program.
    fn take_faults(&mut self, block: &Block, at: &At<'_>, stopped: bool) {
        if block.faults.is_empty() {
            return;
        }
        let error = |diagnostic: &&crate::diagnostic::Diagnostic| stops(diagnostic);
        let executed = self
            .work
            .diagnostics
            .iter()
            .find(error)
            .map(|d| d.place.span.start);
        let limit = if stopped {
            let refused = self.first_refusal(block);
            match (executed, refused) {
                (Some(executed), Some(refused)) => executed.min(refused),
                (found, None) | (None, found) => found.unwrap_or(u32::MAX),
            }
        } else {
            u32::MAX
        };
        for fault in block
            .faults
            .iter()
            .filter(|fault| fault.span.start <= limit)
        {
            self.work.diagnostics.push(at.diagnostic(fault.clone()));
        }
    }

    fn items(&mut self, block: &Block, at: &At<'_>, intent: &mut Intent, limit: Option<u32>) {
        for item in &block.items {
            if limit.is_some_and(|limit| item.span().start >= limit) {
                return;
            }
            if let Err(fault) = self.item(item, block, at, intent) {
                self.work.diagnostics.push(at.diagnostic(*fault));
            }
            if self.options.stop == StopPolicy::FirstError
                && self.work.diagnostics.iter().any(stops)
            {
                return;
            }
        }
    }

    /// What the control does next.
    fn step(
        &mut self,
        (intent, call): (Intent, Option<Step>),
        moved: bool,
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Step {
        if let Some(by) = intent.end {
            if at.level > 0 && self.state.ending.is_none() {
                let fault = Fault::new(
                    Code::Fc315,
                    Span::new(0, at.text.len()),
                    "program end inside a subprogram ends the whole program",
                )
                .with_help("end a subprogram with `M17` or `M29`");
                self.work.diagnostics.push(at.diagnostic(fault));
            }
            if let (None, Some(name)) = (self.state.ending, self.machine.programs.end.clone()) {
                let wanted = Wanted {
                    scope: CallScope::Global,
                    name,
                    own: std::collections::BTreeMap::new(),
                    span: Span::new(0, at.text.len()),
                    repeat: None,
                };
                self.state.frames.clear();
                if let Some(step) = self.resolve(wanted, at, finder) {
                    self.state.ending = Some(by);
                    return step;
                }
            }
            return Step::End(self.state.ending.take().unwrap_or(by));
        }
        if intent.returns {
            return Step::Return;
        }
        call.or(intent.step)
            .or_else(|| self.repetition(moved, at))
            .unwrap_or(Step::Next)
    }

    fn item(
        &mut self,
        item: &Item,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        match item {
            Item::Word(word) => self.word(word, block, at, intent),
            Item::Comp(command) => {
                self.comp(command, at);
                Ok(())
            }
            Item::Bracket { axis, keyword, .. } => {
                let word = format!("{}[{}]", axis.of(at.text), keyword.of(at.text));
                self.pass_over(&word);
                Ok(())
            }
            Item::BareNumber(operand, span) => {
                self.value(*operand, block, at)?;
                if intent.no_motion {
                    return Ok(());
                }
                let found = span.of(at.text);
                Err(Box::new(Fault::new(
                    Code::Fc207,
                    *span,
                    format!("`{found}` stands without an address"),
                )))
            }
            Item::Assign(assignment) => self.assign(*assignment, block, at),
            Item::Hash(hash) => self.hash(hash, block, at, intent),
            Item::MacroDefinition(name, code) => {
                let (name, code) = (unquoted(*name, at), unquoted(*code, at));
                self.state.memory.define_macro(name, code);
                Ok(())
            }
            Item::GCall(call) => self.g_call(call, block, at, intent),
            Item::Call(call) => {
                intent.call = self.wanted(call, block, at)?;
                Ok(())
            }
            Item::Flow(flow, span) => {
                if let Some(condition) = self.one_line_condition(flow, block, at)? {
                    intent.condition = Some(condition);
                    return Ok(());
                }
                if intent.condition == Some(Some(false)) {
                    return Ok(());
                }
                intent.step = self.flow(flow, *span, block, at)?;
                Ok(())
            }
            Item::MacroUse(span) => self.expand(*span, at, intent),
            Item::Label(_) | Item::BadCommand(_) => Ok(()),
        }
    }

    /// The value of an operand.
    pub(super) fn value(
        &mut self,
        operand: Operand,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Value, Box<Fault>> {
        if let Operand::Number(number) = operand {
            return Ok(Value::Number(number));
        }
        let mut stack = std::mem::take(&mut self.work.stack);
        let value =
            self.with_evaluator(block, at, |evaluator| evaluator.value(operand, &mut stack));
        self.work.stack = stack;
        value
    }

    fn with_evaluator<T>(
        &self,
        block: &Block,
        at: &At<'_>,
        work: impl FnOnce(&Evaluator<'_>) -> T,
    ) -> T {
        static NO_CALL: std::collections::BTreeMap<u32, Value> = std::collections::BTreeMap::new();
        let own = self
            .state
            .frames
            .last()
            .map_or(&NO_CALL, |frame| &frame.own);
        work(&Evaluator {
            block,
            text: at.text,
            scope: Scope {
                memory: &self.state.memory,
                own,
                system: &|name| self.system_variable(name),
            },
        })
    }

    /// What the dry run knows of the machine's own variables (R1.35, R2.36).
    fn system_variable(&self, name: &str) -> Option<Value> {
        let rest = name.strip_prefix("V.A.")?;
        let (variable, axis) = match rest.split_once('[') {
            Some((variable, index)) => {
                let position = index.trim_end_matches(']').parse().ok()?;
                (
                    variable,
                    (position < self.machine.axes.len()).then(|| AxisIndex::new(position))?,
                )
            }
            None => {
                let (variable, axis) = rest.rsplit_once('.')?;
                (variable, self.machine.find(axis)?)
            }
        };
        if let Some(kind) = variable
            .strip_suffix("_COMP_ACTIVE")
            .and_then(compensation_kind)
        {
            return match self.state.compensation.state(axis, kind) {
                State::Unknown => None,
                state => Some((state == State::Active).into()),
            };
        }
        if let Some(kind) = variable
            .strip_suffix("_COMP_INIT")
            .and_then(compensation_kind)
        {
            let machine = self.machine.axis(axis);
            let ready = machine.configured.contains(kind) && machine.parameterised().contains(kind);
            return Some(ready.into());
        }
        match variable {
            "ABS" | "PROG" => self.state.modal.position(axis).value.map(Value::Number),
            _ => None,
        }
    }

    fn word(
        &mut self,
        word: &Word,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let number = match word.value {
            None => None,
            Some(Operand::Number(number)) => Some(number),
            Some(operand) => self.value(operand, block, at)?.number(),
        };
        match word.address {
            Address::Letter(letter @ b'A'..=b'Z') => {
                if let Some(axis) = self.letters[usize::from(letter - b'A')] {
                    self.axis_word(axis, word, number, at)
                } else {
                    self.letter(letter, number, word, intent)
                }
            }
            Address::Name(name) => match self.names.get(name.of(at.text)).copied() {
                Some(axis) => self.axis_word(axis, word, number, at),
                None => {
                    if !name.of(at.text).starts_with('S') {
                        let name = name.of(at.text).to_owned();
                        self.pass_over(&name);
                    }
                    Ok(())
                }
            },
            Address::Lower(letter) | Address::Letter(letter) => {
                self.pass_over(&char::from(letter).to_string());
                Ok(())
            }
        }
    }

    /// An axis occurs.
    pub(super) fn see(&mut self, axis: AxisIndex) {
        self.work.new_axes |= !std::mem::replace(&mut self.state.occurred[axis.get()], true);
    }

    fn axis_word(
        &mut self,
        axis: AxisIndex,
        word: &Word,
        number: Option<f64>,
        at: &At<'_>,
    ) -> Result<(), Box<Fault>> {
        self.see(axis);
        self.work.coordinates.push((axis, number));
        self.work.moved.push((axis, word.span));
        let required = self.machine.axis(axis).required;
        if required.is_empty() {
            return Ok(());
        }
        let missing = required.iter().find(|kind| {
            !matches!(
                self.state.compensation.state(axis, *kind),
                State::Active | State::Unknown
            )
        });
        let Some(kind) = missing else {
            return Ok(());
        };
        let name = &self.machine.axis(axis).name;
        let keyword = kind.keyword();
        let fault = Fault::new(
            Code::PErr70435,
            word.span,
            format!("axis `{name}` moves without `{keyword}`, which P-AXIS-00465 requires"),
        )
        .with_help(format!(
            "switch it on before, with `{name}[COMP ON {keyword}]`"
        ));
        let diagnostic = at.diagnostic(fault).with_axis(name.clone());
        self.work.diagnostics.push(diagnostic);
        Ok(())
    }

    fn letter(
        &mut self,
        letter: u8,
        number: Option<f64>,
        word: &Word,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let whole = match letter {
            b'G' | b'M' | b'T' => number.and_then(rounded),
            _ => None,
        };
        match (letter, whole) {
            (b'G', Some(number)) => return self.g_word(number, word, intent),
            (b'M', Some(30)) => intent.end = Some(EndedBy::M30),
            (b'M', Some(2)) => intent.end = Some(EndedBy::M02),
            (b'M', Some(17 | 29)) => intent.returns = true,
            (b'F', _) => self.state.modal.set_feed(number),
            (b'M' | b'T', Some(number)) => {
                if !self.machine.programs.words.is_empty() {
                    let letter = char::from(letter).to_string();
                    let wanted =
                        self.configured([&format!("{letter}{number}"), &letter], word.span);
                    intent.call = intent.call.take().or(wanted);
                }
            }
            (b'M' | b'T' | b'D' | b'H' | b'E' | b'S' | b'I' | b'J' | b'K' | b'R' | b'N', _) => {}
            _ => self.pass_over(&char::from(letter).to_string()),
        }
        Ok(())
    }

    fn g_word(&mut self, number: i64, word: &Word, intent: &mut Intent) -> Result<(), Box<Fault>> {
        let Ok(number) = u32::try_from(number) else {
            self.pass_over(&format!("G{number}"));
            return Ok(());
        };
        if let Some(group) = Group::of(number) {
            let first = *intent.groups[group as usize].get_or_insert(number);
            if first != number {
                return Err(Box::new(
                    Fault::new(
                        Code::Fc313,
                        word.span,
                        format!("`G{number}` and `G{first:02}` belong to one group"),
                    )
                    .with_help("a block takes one G function of each group"),
                ));
            }
        }
        match number {
            4 => intent.no_motion = true,
            92 => {
                intent.no_motion = true;
                intent.reference = true;
            }
            _ if self.state.modal.set(number) => {}
            // G60, G61 and the like have no bearing on the compensation; a configured cycle has.
            _ => {
                let name = format!("G{number}");
                match self.configured([&name, &name], word.span) {
                    Some(wanted) => intent.call = Some(wanted),
                    None => self.pass_over(&name),
                }
            }
        }
        Ok(())
    }

    /// Axis words become positions when the whole block is known: G90, G91, G70 and G92 count
    /// wherever they stand.
    fn move_axes(&mut self, intent: &Intent) {
        if intent.no_motion {
            self.work.moved.clear();
        }
        if intent.no_motion && !intent.reference {
            return;
        }
        for &(axis, value) in &self.work.coordinates {
            if intent.reference {
                self.state.modal.set_reference(axis, value);
            } else {
                self.state.modal.move_axis(axis, value);
            }
        }
    }

    fn comp(&mut self, command: &CompCommand, at: &At<'_>) {
        let before = self.work.changes.len();
        let axis = self.find_axis(command);
        let result = axis.and_then(|axis| {
            self.see(axis);
            self.warn_opposite(command, axis, at);
            self.state
                .compensation
                .switch(axis, command.selection, &mut self.work.changes)
                .map(|()| axis)
        });
        match &result {
            Ok(axis) => {
                self.warn_build(command, at);
                self.warn_ineffective(command, *axis, at);
            }
            Err(error) => {
                let diagnostic = self.refusal(error, command, at);
                self.work.diagnostics.push(diagnostic);
            }
        }
        self.work.outcomes.push(Outcome {
            command: command.clone(),
            result,
            changes: self.work.changes.len() - before,
        });
    }

    fn find_axis(&self, command: &CompCommand) -> Result<AxisIndex, CompensationError> {
        let axis = self.state.compensation.resolve(&command.axis)?;
        let nameless = self.machine.axis_set == AxisSet::AsTheyOccur;
        debug_assert!(nameless || self.state.occurred[axis.get()]);
        Ok(axis)
    }

    /// FC301: the same axis and kind twice in one block with opposite states.
    fn warn_opposite(&mut self, command: &CompCommand, axis: AxisIndex, at: &At<'_>) {
        let on = |selection| matches!(selection, Selection::On(_));
        let opposite = self.work.outcomes.iter().find_map(|earlier| {
            let same_axis = earlier.result.as_ref().ok() == Some(&axis);
            let kinds = earlier
                .command
                .selection
                .kinds()
                .intersection(command.selection.kinds());
            (same_axis
                && !kinds.is_empty()
                && on(earlier.command.selection) != on(command.selection))
            .then_some((earlier.command.span, kinds))
        });
        if let Some((first, kinds)) = opposite {
            let keywords: Vec<&str> = kinds.iter().map(Kind::keyword).collect();
            let name = &command.axis;
            let fault = Fault::new(
                Code::Fc301,
                command.span,
                format!(
                    "`{}` of axis `{name}` is switched both on and off in this block; this command wins",
                    keywords.join(" ")
                ),
            );
            let diagnostic = at
                .diagnostic(fault)
                .with_axis(name.clone())
                .with_label(at.place(first), "the opposite stands here");
            self.work.diagnostics.push(diagnostic);
        }
    }

    /// FC305: a kind that the configured build does not know (R1.10).
    fn warn_build(&mut self, command: &CompCommand, at: &At<'_>) {
        let Some(build) = self.machine.build else {
            return;
        };
        let named = match command.selection {
            Selection::On(kinds) | Selection::Off(kinds) => kinds,
            Selection::OffAll => KindSet::NONE,
        };
        for kind in named.iter() {
            let since: CncBuild = kind.facts().since;
            if build < since {
                let keyword = kind.keyword();
                let fault = Fault::new(
                    Code::Fc305,
                    command.span,
                    format!("`{keyword}` exists since CNC build {since}, the machine has {build}"),
                );
                self.work
                    .diagnostics
                    .push(at.diagnostic(fault).with_axis(command.axis.clone()));
            }
        }
    }

    /// FC303: selected, but nothing to work with (R1.26).
    fn warn_ineffective(&mut self, command: &CompCommand, axis: AxisIndex, at: &At<'_>) {
        let selects =
            matches!(command.selection, Selection::On(kinds) if kinds.contains(Kind::Frict));
        if !selects || self.state.compensation.state(axis, Kind::Frict) != State::Ineffective {
            return;
        }
        let name = &command.axis;
        let (missing, help) = match &self.machine.axis(axis).friction {
            Parameterisation::Missing => (
                "the axis has no value list".to_owned(),
                format!("give axis `{name}` a list with `frict_comp.mode 3` and table values"),
            ),
            Parameterisation::Off => (
                "the value list says `frict_comp.mode 0`".to_owned(),
                "set P-COMP-00041 to 3".to_owned(),
            ),
            Parameterisation::Rejected { file, code } => (
                format!("the value list `{file}` was rejected with {code}"),
                format!("`frictcomp explain {code}` says why"),
            ),
            Parameterisation::Assumed | Parameterisation::Accepted(_) => return,
        };
        let fault = Fault::new(
            Code::Fc303,
            command.span,
            format!("friction compensation of axis `{name}` is selected without effect: {missing}"),
        )
        .with_help(help);
        self.work
            .diagnostics
            .push(at.diagnostic(fault).with_axis(name.clone()));
    }

    fn refusal(
        &self,
        error: &CompensationError,
        command: &CompCommand,
        at: &At<'_>,
    ) -> crate::diagnostic::Diagnostic {
        let name = &command.axis;
        let axis_span = Span::new(
            command.span.start as usize,
            command.span.start as usize + name.len(),
        );
        let span = match error {
            CompensationError::UnknownAxis { .. } => axis_span,
            _ => command.span,
        };
        let fault = Fault::new(error.code(), span, error.to_string());
        let mut diagnostic = at.diagnostic(fault).with_axis(name.clone());
        match error {
            CompensationError::NotConfigured { .. } => {
                let axis = self.machine.find(name).map(|axis| self.machine.axis(axis));
                diagnostic = diagnostic.with_help(match axis.map(|axis| &axis.frict_comp_origin) {
                    Some(Origin::File { file, line }) => {
                        format!("{file}:{line} sets P-AXIS-00522 (lr_param.frict_comp) to 0; set it to 1 and restart the control")
                    }
                    _ => format!("P-AXIS-00522 (lr_param.frict_comp) of axis `{name}` is not set; set it to 1 in its axis list and restart the control"),
                });
                diagnostic = diagnostic.with_help(format!(
                    "to go on as if it were set, run with `--enable {name}`"
                ));
            }
            CompensationError::UnknownAxis { .. } => {
                let known = self.machine.axes.iter().map(|axis| axis.name.as_str());
                diagnostic = match did_you_mean(name, known.clone()) {
                    Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
                    None => diagnostic.with_help(format!(
                        "the machine has {}",
                        known.collect::<Vec<_>>().join(", ")
                    )),
                };
            }
            CompensationError::Coupled { .. } => {
                diagnostic =
                    diagnostic.with_help("release the coupling before, with `#DISABLE AX LINK`");
            }
            CompensationError::Spindle { .. } => {}
        }
        diagnostic
    }

    /// Counts something that was accepted and passed over.
    pub(super) fn pass_over(&mut self, word: &str) {
        match self.state.opaque.get_mut(word) {
            Some(count) => *count += 1,
            None => {
                self.state.opaque.insert(word.to_owned(), 1);
            }
        }
    }

    fn assign(
        &mut self,
        assignment: Assignment,
        block: &Block,
        at: &At<'_>,
    ) -> Result<(), Box<Fault>> {
        let value = self.value(assignment.value, block, at)?;
        let place = self.target_place(assignment.target.place, block, at)?;
        self.write(place, value);
        Ok(())
    }

    pub(super) fn target_place(
        &mut self,
        place: crate::syntax::ast::Expression,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Place, Box<Fault>> {
        let mut stack = std::mem::take(&mut self.work.stack);
        let found = self.with_evaluator(block, at, |evaluator| evaluator.place(place, &mut stack));
        self.work.stack = stack;
        found
    }

    pub(super) fn write(&mut self, place: Place, value: Value) {
        match place {
            Place::Parameter(Owner::Program, index) => {
                self.state.memory.set_parameter(index, value)
            }
            Place::Parameter(Owner::Call, index) => {
                if let Some(frame) = self.state.frames.last_mut() {
                    frame.own.insert(index, value);
                }
            }
            Place::Variable(name) => self.state.memory.set_variable(&name, value),
            Place::Nowhere => {}
        }
    }

    fn hash(
        &mut self,
        hash: &Hash,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        match hash.name.as_str() {
            "#VAR" => return self.declare(&hash.declarations, block, at),
            "#DELETE" => self.delete(hash, block, at)?,
            "#TIME" => {
                intent.no_motion = true;
                if let Some(time) = hash.argument {
                    self.value(time, block, at)?;
                }
            }
            "#SET AX LINK" => self.define_coupling(hash.rest.of(at.text)),
            "#ENABLE AX LINK" => self.couple(hash.rest.of(at.text), Coupling::Active),
            "#DISABLE AX LINK" | "#DISABLE AX LINK ALL" => {
                self.couple(hash.rest.of(at.text), Coupling::None)
            }
            "#DISABLE MODAL CYCLE" => self.state.repeated = None,
            "#COMMENT END" | "#ENDVAR" => {}
            name => {
                self.state.modal.hash(name);
                let word = name
                    .trim_end_matches(" OFF")
                    .trim_end_matches(" ON")
                    .to_owned();
                self.pass_over(&word);
                let rest = hash.rest.of(at.text);
                if name.starts_with("#MACHINE DATA") && names_friction(rest) {
                    return Err(Box::new(
                        Fault::new(
                            Code::Fc314,
                            hash.span,
                            "the program writes friction parameters into the machine data",
                        )
                        .with_help("from here on the machine may differ from its lists; this run goes on with the lists"),
                    ));
                }
            }
        }
        Ok(())
    }

    fn define_coupling(&mut self, rest: &str) {
        let axes = self.axes_in(rest);
        self.state.couplings.insert(group_of(rest), axes);
    }

    fn couple(&mut self, rest: &str, coupling: Coupling) {
        let group = group_of(rest);
        let named = self.axes_in(rest);
        let axes = match self.state.couplings.get(&group) {
            Some(axes) => axes.clone(),
            None if !named.is_empty() => named,
            // Without a group every coupling ends; what an unknown group couples is not known.
            None if coupling == Coupling::None => {
                (0..self.machine.axes.len()).map(AxisIndex::new).collect()
            }
            None => {
                self.pass_over("#ENABLE AX LINK");
                return;
            }
        };
        for axis in axes {
            self.state.compensation.set_coupled(axis, coupling);
        }
    }

    fn axes_in(&self, text: &str) -> Vec<AxisIndex> {
        text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .filter_map(|word| self.machine.find(word))
            .collect()
    }

    fn delete(&mut self, hash: &Hash, block: &Block, at: &At<'_>) -> Result<(), Box<Fault>> {
        let Some(Operand::Expression(place)) = hash.argument else {
            return Ok(());
        };
        match self.target_place(place, block, at)? {
            Place::Parameter(_, index) => self.state.memory.delete_parameter(index),
            Place::Variable(name) => self.state.memory.delete(&name),
            Place::Nowhere => {}
        }
        Ok(())
    }

    fn declare(
        &mut self,
        declarations: &[Declaration],
        block: &Block,
        at: &At<'_>,
    ) -> Result<(), Box<Fault>> {
        for declaration in declarations {
            let mut stack = std::mem::take(&mut self.work.stack);
            let dimensions = self.with_evaluator(block, at, |evaluator| {
                evaluator.dimensions(declaration.target.place, &mut stack)
            });
            self.work.stack = stack;
            let text = declaration.target.span.of(at.text);
            let name = text.split('[').next().unwrap_or_default().trim().to_owned();
            let mut values = Vec::with_capacity(declaration.initial.len());
            for operand in &declaration.initial {
                values.push(self.value(*operand, block, at)?);
            }
            if dimensions.is_empty() {
                let is_text = declaration.kind.as_deref() == Some("STRING");
                let default = if is_text {
                    Value::Text("".into())
                } else {
                    Value::Number(0.0)
                };
                self.state
                    .memory
                    .declare(&name, values.into_iter().next().unwrap_or(default));
                continue;
            }
            for (at, value) in values.into_iter().enumerate() {
                let element = element(&name, &dimensions, at);
                self.state.memory.declare(&element, value);
            }
            self.state.memory.declare_array(&name, dimensions);
        }
        Ok(())
    }

    fn g_call(
        &mut self,
        call: &GCall,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let mut own = std::collections::BTreeMap::new();
        for (place, operand) in (1..).zip(&call.arguments) {
            if let Some(operand) = operand {
                own.insert(place, self.value(*operand, block, at)?);
            }
        }
        let word = format!("G{}", call.number);
        match self.configured([&word, &word], call.span) {
            Some(wanted) => intent.call = Some(Wanted { own, ..wanted }),
            None => self.pass_over(&word),
        }
        let _ = at;
        Ok(())
    }

    /// A macro in place of words: its code is a block of its own, executed here (R2.35).
    fn expand(&mut self, span: Span, at: &At<'_>, intent: &mut Intent) -> Result<(), Box<Fault>> {
        let name = unquoted(span, at);
        let Some(code) = self.state.memory.macro_code(name).map(str::to_owned) else {
            let fault = Fault::new(Code::Fc207, span, format!("macro `{name}` is not defined"));
            return Err(Box::new(fault.with_help(format!(
                "define it before, with `\"{name}\" = \"code\"`"
            ))));
        };
        let depth = self.options.limits.macros;
        if at.macro_depth >= depth {
            let fault = Fault::new(
                Code::Fc914,
                span,
                format!("macros expand into each other more than {depth} deep"),
            );
            return Err(Box::new(
                fault.with_help("a deeper expansion is allowed with `--max-macros`"),
            ));
        }
        let mut block = Block::default();
        let lines = crate::source::TextLines::new(&code);
        let _ = crate::syntax::BlockReader::new(lines, 1, FastPath::On).next(&mut block);
        let inner = At {
            text: &code,
            macro_depth: at.macro_depth + 1,
            ..*at
        };
        let (said, moved) = (self.work.diagnostics.len(), self.work.moved.len());
        let limit = self.first_refusal(&block);
        self.items(&block, &inner, intent, limit);
        self.take_faults(&block, &inner, limit.is_some());
        // What is said about the macro's code is shown where the macro is used.
        for diagnostic in &mut self.work.diagnostics[said..] {
            diagnostic.place = at.place(span);
        }
        for (_, word) in &mut self.work.moved[moved..] {
            *word = span;
        }
        Ok(())
    }

    fn block_number(&mut self, block: &Block, at: &At<'_>) -> Option<i64> {
        let value = match block.number?.value {
            Operand::Number(number) => return rounded(number),
            operand @ Operand::Expression(_) => self.value(operand, block, at),
        };
        value
            .ok()
            .as_ref()
            .and_then(Value::number)
            .and_then(rounded)
    }

    /// Keeps the block in mind for FC310; whether M30 comes nobody knows beforehand.
    fn remember_last(&mut self, at: &At<'_>) {
        if at.level > 0 {
            return;
        }
        match &mut self.state.last {
            Some(last) => {
                at.text.clone_into(&mut last.text);
                last.line = at.line;
            }
            None => {
                self.state.last = Some(Last {
                    file: at.file.clone(),
                    line: at.line,
                    text: at.text.to_owned(),
                });
            }
        }
    }
}

fn compensation_kind(name: &str) -> Option<Kind> {
    Kind::from_keyword(name).filter(|kind| *kind != Kind::Backlash)
}

fn unquoted<'a>(span: Span, at: &At<'a>) -> &'a str {
    span.of(at.text).trim_matches('"')
}

fn names_friction(text: &str) -> bool {
    text.contains("lr_param.frict_comp") || text.contains("frict_comp.")
}

/// The coupling group that `[1]` names.
fn group_of(rest: &str) -> String {
    let digits = rest.trim_start_matches(|c: char| !c.is_ascii_digit() && !c.is_ascii_alphabetic());
    digits.chars().take_while(char::is_ascii_digit).collect()
}

/// The name of the element at a place in row order.
fn element(name: &str, dimensions: &[u32], place: usize) -> String {
    let mut subscripts = Vec::with_capacity(dimensions.len());
    let mut rest = place;
    for size in dimensions.iter().rev() {
        let size = (*size).max(1) as usize;
        subscripts.push(rest % size);
        rest /= size;
    }
    let mut element = name.to_owned();
    for subscript in subscripts.iter().rev() {
        element.push_str(&format!("[{subscript}]"));
    }
    element
}
