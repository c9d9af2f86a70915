//! `#` commands (R2.34, R2.47).

use crate::comp::{Kind, KindSet};
use crate::diagnostic::Code;
use crate::interpreter::coordinates::axis_words::AxisWords;
use crate::interpreter::coordinates::chain;
use crate::interpreter::coordinates::geometry::foreign_command;
use crate::interpreter::effects::descriptions::description_end;
use crate::interpreter::effects::exchange::is_exchange;
use crate::interpreter::effects::machine_data::{WriteTarget, enables, is_machine_data, written};
use crate::interpreter::effects::plc::lets_plc_act;
use crate::interpreter::programs::file_names::is_file_name;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::cycles::ModalCycles;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::value::Value;
use crate::interpreter::values::variable::VariableFamily;
use crate::readings::{Alternative, Question};
use crate::syntax::ast::Hash;
use crate::syntax::{Fault, Touches, hash_command};
use crate::text::Span;

/// Number of axes that a message names.
const MAX_NAMED: usize = 8;

impl Interpreter {
    pub(in crate::interpreter) fn hash(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        let rest = &*hash.code(at.text);
        if !goes_on(&hash.name) {
            self.scratch.rests.set(true);
        }
        self.scratch.plc_acts |= lets_plc_act(&hash.name);
        match hash.name.as_str() {
            "#WAIT FOR" => self.wait_for(hash, at, outcome)?,
            "#INIT" if initialises_all(rest) => {
                self.pass_over("#INIT", hash.span, at);
                self.state
                    .track
                    .write_anything(&mut self.state.control.memory);
                self.state.control.memory.initialise(at.as_setter());
                self.scratch.wrote = true;
            }
            "#VAR" => return self.declare(&hash.declarations, at),
            "#DELETE" => return self.delete(hash, at),
            "#TIME" => {
                outcome.axis_words = AxisWords::Other;
                self.scratch.dwells = true;
                if let Some(&time) = hash.arguments.first() {
                    let seconds = self.number(time, hash.span, at)?;
                    self.scratch.geometry().dwell = Some(seconds);
                }
            }
            // PM/207120267
            "#SET AX LINK" | "#AX LINK" => {
                let axes = self.axes_in(rest);
                self.define_coupling(rest, axes, at);
            }
            "#SET AX LINK NBR" | "#AX LINK NBR" => {
                let axes = self.axes_by_number(rest);
                self.define_coupling(rest, axes, at);
            }
            // PM/207133579
            "#ENABLE AX LINK" | "#AX LINK ON" => self.enable_coupling(rest, at),
            "#DISABLE AX LINK" | "#AX LINK OFF" => self.disable_coupling(rest, at),
            "#DISABLE AX LINK ALL" | "#AX LINK OFF ALL" => self.release_couplings(),
            "#DISABLE MODAL CYCLE" => self.state.control.cycles = ModalCycles::default(),
            "#INIT MACRO TAB" => {
                self.state.control.memory.clear_macros();
                self.define_machine_macros();
            }
            "#RETAIN CYCLE CHANGES" => self.state.control.retain_cycle_changes(),
            "#COMMENT END" | "#ENDVAR" => {}
            name if is_file_name(name) => self.name_programs(hash, at),
            opener if description_end(opener).is_some() => self.state.control.describe(hash, at),
            end if self.state.control.ends_description(end) => {
                if let Some(description) = self.state.control.described.take() {
                    self.state
                        .control
                        .modal
                        .end_description(&description.before);
                }
            }
            "#RT WHILE" => self.real_time_loop(hash.span, at, outcome),
            "#RT ENDWHILE" => {}
            "#ERROR" => return self.report_error(hash, at, outcome),
            name if is_exchange(name) => self.exchange_axes(hash, at),
            name => {
                self.state.control.modal.hash(name);
                self.rotate(name, rest, at);
                self.couple_by(name, rest);
                self.command_motion(name, rest, hash.span);
                if let Some(reason) = foreign_command(name) {
                    self.scratch.geometry().foreign = Some(reason);
                }
                self.pace_command(name, rest, at);
                for target in &hash.written {
                    let Some(place) = self.target_place(target.place, at)? else {
                        continue;
                    };
                    match place.variable() {
                        Some(whole)
                            if name == "#INIT"
                                && VariableFamily::of(whole) == VariableFamily::External =>
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
                let word = match chain::command(name) {
                    Some((words, ..)) => words,
                    None => name.trim_end_matches(" OFF").trim_end_matches(" ON"),
                };
                self.pass_over(word, hash.span, at);
                self.touch(hash, at);
                if is_machine_data(name) {
                    self.write_machine_data(hash, at);
                }
            }
        }
        Ok(())
    }

    /// Applies the side effects of a command to the followed state (R2.93).
    fn touch(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        match hash_command(&hash.name) {
            Some(Touches::Motion) => {
                self.state.control.modal.havoc_positions();
                self.perhaps_move_all();
            }
            Some(Touches::Plane) => {
                for axis in self.plane_axes() {
                    self.state.control.modal.havoc_position(axis);
                    self.scratch.perhaps_move(axis);
                }
            }
            Some(Touches::Friction) => {
                for axis in self.axes_or_all(&hash.code(at.text)) {
                    self.havoc(axis, KindSet::of(Kind::Frict));
                }
                self.say_undescribed(hash, at);
            }
            _ => {}
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
        let text = &*hash.code(at.text);
        let lost = self.transferred(hash, at);
        let friction = written(text) == WriteTarget::Friction;
        if lost.is_empty() && !friction {
            return;
        }
        let doubts = self.scratch.doubted.len();
        let reading = self.machine.readings.of(Question::MachineData);
        self.state.rests_on.insert(Question::MachineData);
        for (axis, kinds) in lost {
            match reading {
                Some(Alternative::First) if !friction || enables(text) => {
                    self.return_to_start(axis);
                    self.havoc(axis, kinds.without(KindSet::of(Kind::Frict)));
                }
                Some(Alternative::Second) if !friction || enables(text) => {
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
    fn real_time_loop(&mut self, span: Span, at: &BlockContext<'_>, outcome: &mut BlockOutcome) {
        let whole = self.current_block();
        if !whole.is_empty() {
            let cause = Unknown::text("V.RTG.LOOP.ENABLED");
            outcome.step = self.skip_unknown(whole, &cause, span, at);
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

/// Whether `#INIT` names the whole family `V.E.` (PM/207988747).
fn initialises_all(rest: &str) -> bool {
    rest.split(',')
        .any(|name| name.trim().eq_ignore_ascii_case("V.E."))
}

/// Whether the axes certainly keep moving through a command.
fn goes_on(name: &str) -> bool {
    ["#VAR", "#ENDVAR", "#COMMENT", "#MSG"]
        .iter()
        .any(|known| name.starts_with(known))
}
