//! `#` commands (R2.34, R2.47).

use std::sync::Arc;

use crate::comp::{Kind, KindSet};
use crate::diagnostic::Code;
use crate::interpreter::effects::machine_data::{WriteTarget, enables, written};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::control::OptionalSection;
use crate::interpreter::run::cycles::ModalCycles;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::language::{AxisWords, FurtherWord, HashAction, PathFlow, Plc, Touches};
use crate::readings::{Alternative, Question};
use crate::syntax::ast::Hash;
use crate::syntax::{Fault, VariableFamily};
use crate::text::Span;

/// Number of axes that a message names.
const MAX_NAMED: usize = 8;

impl Executor {
    pub(crate) fn hash(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        let command = hash.command;
        if command.path == PathFlow::MayRest {
            self.scratch.rests.set(true);
        }
        self.scratch.plc_acts |= command.lets_plc_act();
        self.check_flushing(hash, at)?;
        match command.action {
            HashAction::Wait => self.wait_for(hash, at, outcome)?,
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
                outcome.axis_words = AxisWords::Other;
                self.scratch.dwells = true;
                if let Some(&time) = hash.arguments.first() {
                    let seconds = self.number(time, hash.span, at)?;
                    self.scratch.geometry().dwell = Some(seconds);
                }
            }
            HashAction::DefineCoupling(by) => {
                let axes = self.members(by, &hash.brackets, at.text);
                self.define_coupling(hash, axes, at);
            }
            HashAction::EnableCoupling => self.enable_coupling(hash, at),
            HashAction::ReleaseCoupling => self.disable_coupling(hash, at),
            HashAction::ReleaseCouplings => self.release_couplings(),
            HashAction::EndModalCycles => self.state.control.cycles = ModalCycles::default(),
            HashAction::ForgetMacros => {
                self.state.control.memory.clear_macros();
                self.define_machine_macros();
            }
            HashAction::RetainCycleChanges => self.state.control.retain_cycle_changes(),
            HashAction::EndComment | HashAction::EndDeclarations | HashAction::EndRealTimeLoop => {}
            HashAction::NamePrograms => self.name_programs(hash, at),
            HashAction::Describe => self.state.control.describe(hash, at),
            HashAction::EndDescription if self.state.control.end_description(command.words) => {}
            HashAction::RealTimeLoop => self.real_time_loop(hash.span, at),
            HashAction::ReportError => return self.report_error(hash, at, outcome),
            HashAction::ExchangeAxes(exchange) => self.exchange_axes(exchange, hash, at),
            HashAction::SaveConfig(action) => return self.saved_config(action, hash, at),
            HashAction::ChangeFile(action) => self.file_command(action, hash, at, outcome),
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

    /// FC328, P-ERR-51081: a command that flushes the channel where the control refuses that (R2.109, R2.111).
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
        self.check_flush(command.flushes, &hash.name, hash.span, at);
        Ok(())
    }

    /// `#OPTIONAL EXECUTION ON` and `OFF` (R2.109).
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

    /// Whether the section is executed is one question to the machine.
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

    /// A command that is passed over, apart from its effects on what is followed.
    fn pass_over_command(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let (command, name) = (hash.command, hash.name.as_str());
        self.state.control.modal.hash(command);
        if command.action == HashAction::Rotate {
            self.rotate(&hash.brackets, at);
        }
        self.couple_by(hash, at);
        self.command_motion(hash, at);
        if command.unmodelled.is_some() {
            self.scratch.geometry().foreign = command.unmodelled;
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
                for axis in self.plane_axes() {
                    self.state.control.modal.havoc_position(axis);
                    self.scratch.perhaps_move(axis);
                }
            }
            Touches::Friction => {
                for axis in self.axes_or_all(&hash.brackets, at.text) {
                    self.havoc(axis, KindSet::of(Kind::Frict));
                }
                self.say_undescribed(hash, at);
            }
            Touches::Nothing | Touches::Values | Touches::Axes => {}
        }
    }

    /// FC902: the effect of the command is not documented, so states became unknown.
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
        self.scratch.diagnostics.push(at.diagnostic(fault));
    }

    /// FC314: the whole axis list is transferred again (R2.92).
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
        let fault = Fault::new(Code::Fc314, hash.span, message)
            .with_help("set the state after it, for example with `X[COMP ON FRICT]`");
        let diagnostic = at.diagnostic(fault);
        self.scratch.diagnostics.push(diagnostic);
    }

    /// `#RT WHILE` runs as long as its condition on a real-time variable holds (tf5261, 783727499).
    fn real_time_loop(&mut self, span: Span, at: &BlockContext<'_>) {
        let whole = self.current_block();
        if !whole.is_empty() {
            let cause = Unknown::text("V.RTG.LOOP.ENABLED");
            self.pass_over_part(cause, span, at);
        }
    }
}

impl ControlState {
    /// The running cycle keeps its changes to G functions and feed.
    fn retain_cycle_changes(&mut self) {
        if let Some(frame) = self.frames.cycle_mut() {
            frame.restores = None;
        }
    }
}
