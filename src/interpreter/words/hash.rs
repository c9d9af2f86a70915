//! `#` commands (R2.34, R2.47), with those that have more to say than a row: `#WAIT FOR` (R2.99; PM/207058059), `#FILE …` and what
//! it does to the programs that are called (R2.108; PM/207511947, PM/207518603, PM/207524491), `#MACHINE DATA` (R2.92;
//! PM/207492747), and `#SAVE CONFIG` and its like (R2.107; PM/207535499, PM/207542155, PM/207551115).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::diagnostic::Code;
use crate::interpreter::block::{BlockContext, LookedFor};
use crate::interpreter::control::{
    ControlState, ModalCycles, OptionalSection, SavedConfig, SavedItem,
};
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::Executor;
use crate::interpreter::programs::calls::{Finder, WantedCall};
use crate::interpreter::programs::store::Caller;
use crate::interpreter::stack::ControlStep;
use crate::interpreter::values::location::{Location, MissingProgram, Unknown};
use crate::interpreter::values::plain::{Truth, conclusions, is_written_by_machine};
use crate::interpreter::values::value::{Value, rounded};
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::language::{
    AxisWords, ChannelState, ConfigAction, Exchange, FileAction, FurtherWord, HashAction, PathFlow,
    Plc, Touches,
};
use crate::machine::Machine;
use crate::readings::{Alternative, Question};
use crate::syntax::ast::{BracketArguments, CallScope, Hash, Operand};
use crate::syntax::{Fault, VariableFamily, VariableName};
use crate::text::Span;

/// Number of axes that a message names.
const MAX_NAMED: usize = 8;

impl Executor {
    pub(crate) fn hash(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let command = hash.command;
        if command.path == PathFlow::MayRest {
            self.scratch.moves.rest();
        }
        self.scratch.read.plc_acts |= command.lets_plc_act();
        self.check_flushing(hash, at)?;
        match command.action {
            HashAction::Wait => self.wait_for(hash, at)?,
            HashAction::Initialise if hash.names_all_externals(at.text) => {
                self.pass_over(command.words, hash.span, at);
                self.state
                    .track
                    .write_anything(&mut self.state.control.memory);
                self.state.control.memory.initialise(at.as_setter());
                self.scratch.wrote = true;
            }
            HashAction::Declare => return self.declare(&hash.declarations, at),
            HashAction::Delete => return self.delete(hash, at),
            HashAction::Dwell => {
                self.scratch.actions.axis_words = AxisWords::Other;
                self.scratch.moves.dwell();
                if let Some(&time) = hash.arguments.first() {
                    let seconds = self.number(time, hash.span, at)?;
                    self.scratch.moves.geometry().dwell = Some(seconds);
                }
            }
            HashAction::DefineCoupling(by) => self.define_coupling(by, hash, at)?,
            HashAction::EnableCoupling => self.enable_coupling(hash, at),
            HashAction::ReleaseCoupling => self.disable_coupling(hash, at),
            HashAction::ReleaseCouplings => self.state.control.release_couplings(),
            HashAction::EndModalCycles => self.state.control.cycles = ModalCycles::default(),
            HashAction::ForgetMacros => {
                self.state.control.memory.clear_macros();
                self.define_machine_macros();
            }
            HashAction::RetainCycleChanges => self.state.control.retain_cycle_changes(),
            HashAction::EndComment | HashAction::EndDeclarations | HashAction::EndRealTimeLoop => {}
            HashAction::NamePrograms => self.name_programs(hash, at),
            HashAction::Describe(_) => self.state.control.describe(hash, at),
            HashAction::EndDescription if self.state.control.end_description(command.words) => {}
            HashAction::RealTimeLoop => self.real_time_loop(hash.span, at),
            HashAction::ReportError => return self.report_error(hash, at),
            HashAction::ExchangeAxes(exchange) => self.exchange_axes(exchange, hash, at),
            HashAction::NameManualAxes => self.name_manual_axes(hash, at),
            HashAction::SaveConfig(action) => return self.saved_config(action, hash, at),
            HashAction::ChangeFile(action) => self.file_command(action, hash, at),
            HashAction::SkipBackward => return self.skip_backward(hash, at),
            HashAction::PassOver
            | HashAction::Comment
            | HashAction::Initialise
            | HashAction::EndDescription
            | HashAction::Rotate
            | HashAction::Override
            | HashAction::SelectSpindle
            | HashAction::Round(_)
            | HashAction::SelectSlope(_)
            | HashAction::WriteMachineData => return self.pass_over_command(hash, at),
        }
        Ok(())
    }

    /// Reports FC328 or P-ERR-51081: a command that flushes the channel where the control refuses that (R2.109,
    /// R2.111).
    fn check_flushing(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let command = hash.command;
        if command.has(FurtherWord::Continue) {
            return Ok(());
        }
        if self.state.control.optional != OptionalSection::Outside
            && command.plc == Plc::ActsAfterWait
            && command.lets_plc_act()
        {
            let what = "`#FLUSH WAIT` stands between `#OPTIONAL EXECUTION ON` and `OFF`";
            return Err(Fault::refused(Code::PErr51081, hash.span, what));
        }
        if command.has(FurtherWord::Def) || self.releases_others(hash, at) {
            return Ok(());
        }
        let row = command.row();
        self.check_states((row.refused, row.flushes), &hash.name, hash.span, at);
        Ok(())
    }

    /// Whether a command releases only axes beside the active plane, which the control admits under G41 (PM/524821515).
    fn releases_others(&self, hash: &Hash, at: &BlockContext<'_>) -> bool {
        if hash.command.action != HashAction::ExchangeAxes(Exchange::Release)
            || !self.state.control.is_in(ChannelState::CutterRadius)
        {
            return false;
        }
        let named = self.axes().given(&hash.brackets, at.text);
        let plane = self.axes().plane(&self.state.control.modal);
        !named.is_empty() && !named.iter().any(|axis| plane.contains(axis))
    }

    /// Executes `#OPTIONAL EXECUTION ON` and `OFF` (R2.109).
    fn skip_backward(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        if hash.command.has(FurtherWord::On) && hash.brackets.has("SIMULATE", at.text) {
            let what = "`#OPTIONAL EXECUTION ON` has `APPROACH SIMULATE`";
            return Err(Fault::refused(Code::PErr22132, hash.span, what));
        }
        self.state.control.optional = if hash.command.has(FurtherWord::On) {
            self.begin_optional(hash.span, at)
        } else {
            OptionalSection::Outside
        };
        self.pass_over(hash.command.words, hash.span, at);
        Ok(())
    }

    /// Asks the machine once whether the section is executed.
    fn begin_optional(&mut self, span: Span, at: &BlockContext<'_>) -> OptionalSection {
        if !self.state.can_ask() {
            return OptionalSection::Inside;
        }
        OptionalSection::Asked(self.state.ask_anew(Condition::new(
            ConditionKind::Branch,
            at.place(span),
            vec![Arc::from("the optional section is executed")],
            Unknown::OptionalSection,
        )))
    }

    /// Passes over a command, apart from its effects on what is followed.
    fn pass_over_command(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let (command, name) = (hash.command, hash.name.as_str());
        self.state.control.modal.hash(command);
        if command.action == HashAction::Rotate {
            self.rotate(&hash.brackets, at);
        }
        self.couple_by(hash, at);
        self.command_motion(hash, at);
        if command.unmodelled.is_some() {
            self.scratch.moves.geometry().foreign = command.unmodelled;
        }
        self.pace_command(hash, at);
        for target in &hash.written {
            let Some(place) = self.target_place(target.place, at)? else {
                continue;
            };
            match place.variable() {
                Some(whole)
                    if command.action == HashAction::Initialise
                        && whole.family() == VariableFamily::External =>
                {
                    self.write(&place.location, 0.0.into());
                    self.state.control.memory.zero(whole, &at.as_setter());
                }
                _ => {
                    let unknown = Value::Unknown(Unknown::text(name));
                    let (location, value) = place.assigned(unknown);
                    self.write(&location, value);
                }
            }
        }
        let word = match command.chain {
            Some(_) => command.name(),
            None => name.trim_end_matches(" OFF").trim_end_matches(" ON"),
        };
        self.pass_over(word, hash.span, at);
        self.touch(hash, at);
        if command.action == HashAction::WriteMachineData {
            let has = |word| hash.brackets.has(word, at.text);
            if has("WAIT") && !has("SYN") {
                let what = "`#MACHINE DATA` has `WAIT` and not `SYN`";
                return Err(Fault::refused(Code::PErr21413, hash.span, what));
            }
            self.write_machine_data(hash, at);
        }
        Ok(())
    }

    /// Applies the side effects of a command to the followed state (R2.93).
    fn touch(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        match hash.command.touches {
            Touches::Motion => {
                self.state.control.modal.havoc_positions();
                self.perhaps_move_all();
            }
            Touches::Plane => {
                for axis in self.axes().plane(&self.state.control.modal) {
                    self.state.control.modal.havoc_position(axis);
                    self.scratch.moves.perhaps_move(axis);
                }
            }
            Touches::Friction => {
                for axis in self.axes().given_or_all(&hash.brackets, at.text) {
                    self.havoc(axis, KindSet::of(Kind::Frict));
                }
                self.say_undescribed(hash, at);
            }
            Touches::Nothing | Touches::Values | Touches::Axes => {}
        }
    }

    /// Reports FC902: the effect of the command is not documented, so states became unknown.
    fn say_undescribed(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let doubted = self.scratch.doubted.iter();
        let names = doubted.map(|(axis, _)| format!("`{}`", self.machine.axis(*axis).name));
        let names: Vec<String> = names.take(MAX_NAMED).collect();
        let [first, ..] = names.as_slice() else {
            return;
        };
        let name = &hash.name;
        let fault = Fault::new(
            Code::Fc902,
            hash.span,
            format!(
                "what `{name}` does to friction compensation is not documented; `FRICT` of {} is unknown from here on",
                names.join(", ")
            ),
        );
        let axis = first.trim_matches('`');
        let fault = fault.with_help(format!(
            "a COMP command after it makes the state known again, `{axis}[COMP ON FRICT]`"
        ));
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Reports FC314: the whole axis list is transferred again (R2.92).
    fn write_machine_data(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let lost = self.transferred(hash, at);
        let enables = enables(&hash.brackets, at.text);
        let friction = written(&hash.brackets, at.text) == WriteTarget::Friction;
        if lost.is_empty() && !friction {
            return;
        }
        let doubts = self.scratch.doubted.len();
        let reading = self.machine.readings.of(Question::MachineData);
        self.state.rests_on.insert(Question::MachineData);
        for (axis, kinds) in lost {
            match reading {
                Some(Alternative::First) if !friction || enables => {
                    self.return_to_start(axis);
                    self.havoc(axis, kinds.without(KindSet::of(Kind::Frict)));
                }
                Some(Alternative::Second) if !friction || enables => {
                    self.havoc(axis, kinds.without(KindSet::of(Kind::Frict)));
                }
                _ => self.havoc(axis, kinds),
            }
            let is_known = enables && self.machine.axis(axis).configured.contains(Kind::Frict);
            if friction && reading.is_none() && !is_known {
                self.rewrite_friction(axis, enables);
            }
        }
        let doubted = self.scratch.doubted.get(doubts..).unwrap_or_default();
        let named: Vec<String> = doubted
            .iter()
            .map(|(axis, kinds)| {
                let kinds: Vec<&str> = kinds.iter().map(Kind::as_str).collect();
                format!(
                    "`{}` of `{}`",
                    kinds.join(" "),
                    self.machine.axis(*axis).name
                )
            })
            .collect();
        let what = if friction {
            "the program writes a parameter of friction compensation into the machine data"
        } else {
            "the control transfers the whole axis list again, which may undo NC commands"
        };
        let message = match named.as_slice() {
            [] if !friction => return,
            [] => what.to_owned(),
            named => format!("{what}; {} is unknown from here on", named.join(", ")),
        };
        let fault = Fault::new(Code::Fc314, hash.span, message).with_help(if friction {
            "run what follows with a configuration that has the new value"
        } else {
            "set the state after it, for example with `X[COMP ON FRICT]`"
        });
        let diagnostic = at.diagnostic(fault);
        self.scratch.messages.diagnostics.push(diagnostic);
    }

    /// Makes the effect of `COMP ON` uncertain, since the program writes a parameter of the friction compensation of an
    /// axis.
    fn rewrite_friction(&mut self, axis: AxisIndex, enables: bool) {
        let compensation = &mut self.state.control.compensation;
        if enables || compensation.is_configured(axis, Kind::Frict) {
            compensation.rewrite(axis, Kind::Frict, &mut self.scratch.changes);
            let frict = KindSet::of(Kind::Frict);
            self.state.control.history.close(axis, frict);
        }
    }

    /// Passes over a loop `#RT WHILE`, which runs as long as its condition on a real-time variable holds (tf5261, 783727499).
    fn real_time_loop(&mut self, span: Span, at: &BlockContext<'_>) {
        let whole = self.position().current_block();
        if !whole.is_empty() {
            let cause = Unknown::text("V.RTG.LOOP.ENABLED");
            self.pass_over_part(cause, span, at);
        }
    }
}

impl ControlState {
    /// Lets the running cycle keep its changes to G functions and feed.
    fn retain_cycle_changes(&mut self) {
        if let Some(frame) = self.frames.cycle_mut() {
            frame.restores = None;
        }
    }
}

impl Executor {
    /// Executes a wait: the condition holds after the block, and its plain conclusions are held as values that the
    /// program set.
    pub(crate) fn wait_for(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        self.pass_over(hash.command.words, hash.span, at);
        // The PLC acts while the program waits, not after it.
        self.let_plc_act();
        self.scratch.read.plc_acts = false;
        let Some(&condition) = hash.arguments.first() else {
            return Ok(());
        };
        let value = self.value(condition, at)?;
        let Operand::Expression(expression) = condition else {
            if value.truth() == Some(false) {
                self.wait_for_ever(hash, at);
            }
            return Ok(());
        };
        if value.truth() == Some(false)
            && !is_written_by_machine(at.block, at.text, expression, &self.externals)
        {
            self.wait_for_ever(hash, at);
            return Ok(());
        }
        if value.truth() != Some(true) {
            for (target, value) in conclusions(at.block, at.text, expression, Truth::Holds) {
                if let Location::Variable(name) = &target
                    && self.externals.may_change(name)
                {
                    self.write(&target, value);
                    self.state.control.memory.hold(name, at.as_setter());
                }
            }
        }
        Ok(())
    }

    /// Reports FC909: nothing that the condition reads can change while the program waits.
    fn wait_for_ever(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let condition = hash.code(at.text);
        let condition = condition.trim();
        let message = format!(
            "this wait never ends: `{condition}` does not hold, and only the program could change that"
        );
        let fault = Fault::new(Code::Fc909, hash.span, message)
            .with_help("wait for a value that the machine writes, `#WAIT FOR V.E.READY == 1`");
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
        self.scratch.ending.endless = true;
        self.scratch.actions.step = Some(ControlStep::End(EndedBy::Budget));
    }
}

/// The variable with the result of `#FILE EXIST`.
const RESULT: &str = "V.G.FILE_EXIST";

impl Executor {
    /// Executes a command on a file.
    fn file_command(&mut self, action: FileAction, hash: &Hash, at: &BlockContext<'_>) {
        self.pass_over(hash.command.words, hash.span, at);
        let named = |key| hash.brackets.after(key, at.text);
        let name = |key| named(key).and_then(|argument| argument.quoted(at.text));
        let files = &mut self.state.control.files;
        match action {
            FileAction::Rename => {
                files.change(name("PATHOLD"));
                files.change(name("PATHNEW"));
            }
            FileAction::Delete => files.change(name("PATH")),
            FileAction::Message => files.write_message(),
            FileAction::LookFor => {
                self.scratch.actions.looks_for = Some(match name("PATH") {
                    Some(name) => LookedFor::Named(name.to_owned()),
                    None => LookedFor::Computed,
                });
            }
        }
    }

    /// Sets the result of `#FILE EXIST`: 1 for a file that is here. One that is not here may be on the machine.
    #[cold]
    pub(crate) fn look_for_file(
        &mut self,
        file: LookedFor,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) {
        let name = match file {
            LookedFor::Named(name) => Some(name),
            LookedFor::Computed => None,
        };
        let unit = self.state.control.frames.running().map_or(0, |it| it.unit);
        let caller = Caller {
            unit,
            file: at.file,
        };
        let is_changed = |name: &String| self.state.control.files.has(name);
        let wanted = name.clone().filter(|name| !is_changed(name));
        let wanted = wanted
            .map(|name| WantedCall::program(CallScope::Global, name, Span::new(0, at.text.len())));
        let found = wanted.and_then(|wanted| {
            let found = self
                .programs
                .find(&wanted, caller, finder, &self.state.work);
            found.ok().flatten()
        });
        let value = match (&found, &name) {
            (Some(_), _) => Value::Number(1.0),
            (None, Some(name)) => Value::Unknown(Unknown::Program(MissingProgram::Named(
                name.as_str().into(),
            ))),
            (None, None) => Value::Unknown(Unknown::text(RESULT)),
        };
        let result = VariableName::read(RESULT);
        self.state.control.memory.set_variable(&result, value);
        self.scratch.wrote = true;
        let files = &mut self.state.control.files;
        match found {
            Some(_) => files.find(),
            None => files.miss(name.as_deref()),
        }
    }
}

/// Target of a write to the machine data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WriteTarget {
    /// A parameter of friction compensation.
    Friction,
    /// Another parameter.
    Other,
}

/// Returns the target of a command.
pub(crate) fn written(arguments: &BracketArguments, text: &str) -> WriteTarget {
    let is_friction = |key| arguments.mention(key, text);
    if FRICTION_KEYS.into_iter().any(is_friction) {
        WriteTarget::Friction
    } else {
        WriteTarget::Other
    }
}

/// The parameters of friction compensation, and P-AXIS-00522 among them.
const FRICTION_KEYS: [&str; 2] = ["frict_comp", "p-axis-00522"];

/// Returns whether a command sets P-AXIS-00522 to 1.
pub(crate) fn enables(arguments: &BracketArguments, text: &str) -> bool {
    let keys = ["P-AXIS-00522", "lr_param.frict_comp"];
    let value = keys.iter().find_map(|key| arguments.after(key, text));
    value.is_some_and(|value| value.value == Some(Operand::Number(1.0)))
}

impl Executor {
    /// Returns the axes whose list a command transfers again, with the kinds that NC commands have set there: all kinds
    /// where it writes a parameter of friction compensation.
    pub(crate) fn transferred(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Vec<(AxisIndex, KindSet)> {
        let (arguments, text) = (&hash.brackets, at.text);
        let axes = match arguments.after("AXNR", text) {
            Some(number) => {
                let number = self.argument_number(number, at).and_then(rounded);
                numbered(&self.machine, number)
            }
            None => named(&self.machine, arguments, text),
        };
        let start = self.machine.compensation();
        let now = &self.state.control.compensation;
        let is_lost = |axis: AxisIndex, kind: &Kind| {
            let (now, start) = (now.state(axis, *kind), start.state(axis, *kind));
            let is_open = self.state.control.history.states(axis, *kind).is_some();
            written(arguments, text) == WriteTarget::Friction
                || (now != start && (now != State::Unknown || is_open))
        };
        let lost = axes.into_iter().map(|axis| {
            let kinds = Kind::ALL.into_iter().filter(|kind| is_lost(axis, kind));
            (axis, kinds.collect::<KindSet>())
        });
        lost.filter(|(_, kinds)| !kinds.is_empty()).collect()
    }

    /// Returns the axes that the command may name in blocks that are passed over.
    pub(crate) fn perhaps_transferred(
        &self,
        arguments: &BracketArguments,
        text: &str,
    ) -> Vec<AxisIndex> {
        match arguments.after("AXNR", text) {
            Some(number) => {
                let number = number.logical_number(text).map(i64::from);
                numbered(&self.machine, number)
            }
            None => named(&self.machine, arguments, text),
        }
    }
}

/// Returns the axes with a logical number; those without one may have any.
fn numbered(machine: &Machine, number: Option<i64>) -> Vec<AxisIndex> {
    let number = number.and_then(|number| u32::try_from(number).ok());
    let has = |wanted: Option<u32>| {
        let axes = machine.axes.iter().enumerate();
        let axes = axes.filter(move |(_, axis)| axis.number == wanted);
        axes.map(|(axis, _)| AxisIndex::new(axis))
            .collect::<Vec<_>>()
    };
    match number {
        None => (0..machine.axes.len()).map(AxisIndex::new).collect(),
        Some(_) if has(number).is_empty() => has(None),
        Some(_) => has(number),
    }
}

/// Returns the axis of a name, in either case. A command that names none writes to any axis, unless it is about the
/// channel.
fn named(machine: &Machine, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
    match arguments.after("AX", text) {
        Some(argument) => {
            let name = argument.quoted(text).unwrap_or(argument.span.of(text));
            let mut axes = machine.axes.iter();
            let mut in_capitals = || axes.position(|axis| axis.name.eq_ignore_ascii_case(name));
            let found = machine
                .find(name)
                .or_else(|| in_capitals().map(AxisIndex::new));
            found.into_iter().collect()
        }
        None if arguments.mention("p-chan", text) => Vec::new(),
        None => numbered(machine, None),
    }
}

impl Executor {
    /// Executes a command of saved configurations.
    fn saved_config(
        &mut self,
        action: ConfigAction,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        self.state.control.modal.hash(hash.command);
        self.pass_over(hash.command.words, hash.span, at);
        let [axes, links] = ["AX", "AXLINK"].map(|word| hash.brackets.has(word, at.text));
        match action {
            ConfigAction::Clear => {
                self.state.control.saved = SavedConfig {
                    axes: SavedItem::Nothing,
                    links: SavedItem::Nothing,
                };
            }
            // Without a word both are meant.
            ConfigAction::Save if !axes && !links => self.state.control.save_config(true, true),
            ConfigAction::Save => self.state.control.save_config(axes, links),
            ConfigAction::Load => {
                let is_both = !axes && !links;
                let saved = &self.state.control.saved;
                let [no_axes, no_links] = [
                    saved.axes == SavedItem::Nothing,
                    saved.links == SavedItem::Nothing,
                ];
                if axes || is_both && !no_axes {
                    self.load_axes(hash, at)?;
                }
                if links || is_both && !no_links {
                    self.load_links(hash, at)?;
                }
            }
        }
        Ok(())
    }

    fn load_axes(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        match self.state.control.saved.axes.clone() {
            SavedItem::Known(axes) => self.state.control.channel_axes = axes,
            SavedItem::Nothing => {
                let what = "no axes are saved, and the control refuses to restore them";
                return Err(Fault::refused(Code::PErr21274, hash.span, what));
            }
            SavedItem::Perhaps => {
                let what =
                    "which axes are restored here is not known: no program of this run saved them";
                self.may_refuse(21274, what, hash.span, at);
                self.state.control.channel_axes.havoc();
            }
        }
        Ok(())
    }

    fn load_links(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        match self.state.control.saved.links.clone() {
            SavedItem::Known(axes) => self.state.control.restore_couplings(axes, &self.machine),
            SavedItem::Nothing => {
                let what = "no couplings are saved, and the control refuses to restore them";
                return Err(Fault::refused(Code::PErr21275, hash.span, what));
            }
            SavedItem::Perhaps => {
                let what = "which couplings are restored here is not known: no program of this run saved them";
                self.may_refuse(21275, what, hash.span, at);
                self.state.control.couple_any(&self.machine);
            }
        }
        Ok(())
    }
}

impl ControlState {
    fn save_config(&mut self, axes: bool, links: bool) {
        if axes {
            self.saved.axes = if self.channel_axes.is_doubtful() {
                SavedItem::Perhaps
            } else {
                SavedItem::Known(self.channel_axes.clone())
            };
        }
        if links {
            self.saved.links = match self.couplings.in_force() {
                Some(axes) if axes.is_empty() => SavedItem::Nothing,
                Some(axes) => SavedItem::Known(axes),
                None => SavedItem::Perhaps,
            };
        }
    }
}
