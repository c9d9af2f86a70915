//! Calls: which program is meant, where it is, and whether it may be called (R2.13 to R2.16).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::at::At;
use super::cycles::{ModalCycles, Repeated, RepeatedCall, after_motion_only};
use super::finder::{Finder, NoProgram};
use super::options::StopPolicy;
use super::program::Index;
use super::run::Interpreter;
use super::sequence::Part;
use super::start::stops;
use super::state::{Frame, Request, Retains, Step};
use super::value::Value;
use crate::diagnostic::{Advice, Budget, Code, Diagnostic, did_you_mean};
use crate::machine::Keeps;
use crate::syntax::Fault;
use crate::syntax::ast::{Block, Call, CallForm, CallName, CallScope, Operand};
use crate::text::{Place, Span};

/// How many names a run compares with those of calls that find nothing.
const MAX_COMPARED: usize = 100_000;

/// A call whose program has not been looked for yet.
#[derive(Debug, Clone)]
pub(super) struct Wanted {
    pub(super) scope: CallScope,
    pub(super) name: String,
    pub(super) own: BTreeMap<u32, Value>,
    pub(super) span: Span,
    /// Whether it is a cycle.
    pub(super) form: CallForm,
    /// Set for a modal cycle: whether it waits for motion.
    pub(super) repeat: Option<bool>,
    /// The part of the program, where it is not the whole.
    pub(super) part: Option<Part>,
}

impl Wanted {
    /// A call of a program without parameters.
    pub(super) fn program(scope: CallScope, name: String, span: Span) -> Self {
        Self {
            scope,
            name,
            own: BTreeMap::new(),
            span,
            form: CallForm::Plain,
            repeat: None,
            part: None,
        }
    }
}

/// A program that was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Found {
    pub(super) unit: usize,
    pub(super) section: usize,
}

impl Interpreter {
    /// What a call statement asks for; `None` when its name is not known offline (R2.52).
    pub(super) fn wanted(
        &mut self,
        call: &Call,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Option<Wanted>, Box<Fault>> {
        let name = match call.name {
            CallName::Literal(span) => Value::Text(span.of(at.text).into()),
            CallName::Quoted(span) => {
                let name = super::expression::unquoted(span.of(at.text));
                self.state.memory.macro_or_text(name)
            }
            CallName::Variable(place) => self.value(Operand::Expression(place), block, at)?,
        };
        let mut own = BTreeMap::new();
        for (index, operand) in &call.arguments {
            own.insert(*index, self.value(*operand, block, at)?);
        }
        for (_, operand) in &call.words {
            self.value(*operand, block, at)?;
        }
        match name {
            Value::Text(name) => Ok(Some(Wanted {
                scope: call.scope,
                name: name.trim().to_owned(),
                own,
                span: at.in_block(call.span),
                form: call.form,
                repeat: after_motion_only(call),
                part: None,
            })),
            Value::Unknown(cause) => {
                self.forget_all(&cause);
                if self.work.unread.get() {
                    return Ok(None);
                }
                let fault = Fault::new(
                    Code::Fc902,
                    call.span,
                    format!("which program is called depends on {}; the call is passed over, and everything that a program could change becomes unknown", super::cause::unknown_value(&cause)),
                )
                .with_help(super::cause::how_to_set(&cause));
                self.work.diagnostics.push(at.diagnostic(fault));
                Ok(None)
            }
            Value::Number(_) => Err(Box::new(Fault::new(
                Code::Fc312,
                call.span,
                "a number is not a program name",
            ))),
        }
    }

    /// Looks for the programs that a block calls.
    #[inline(never)]
    pub(super) fn resolve_all(
        &mut self,
        calls: Vec<Wanted>,
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Vec<Request> {
        let mut requests = Vec::new();
        for wanted in calls {
            let refused = self.work.diagnostics.iter().any(stops);
            if refused && self.options.stop == StopPolicy::FirstError {
                break;
            }
            requests.extend(self.resolve(wanted, at, finder));
        }
        requests
    }

    /// Looks for the wanted program.
    pub(super) fn resolve(
        &mut self,
        wanted: Wanted,
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Option<Request> {
        if self.is_external(&wanted) {
            self.pass_over_external(wanted, at);
            return None;
        }
        let unit = self.state.frames.last().map_or(0, |frame| frame.unit);
        let here = self.current_program().filter(|_| self.is_here(&wanted));
        let found = match here.map_or_else(
            || self.find(&wanted, (unit, at.file), finder),
            |here| Ok(Some(here)),
        ) {
            Ok(found) => found?,
            Err(fault) => {
                self.work.diagnostics.push(at.diagnostic(*fault));
                return None;
            }
        };
        let is_refused = !self.units[found.unit].index.refused.is_empty();
        if is_refused && found.unit > 0 {
            // What is wrong with the file is said at the first call of it (R2.85).
            if self.state.refused.insert(found.unit) {
                let refused = &self.units[found.unit].index.refused;
                self.work.diagnostics.extend(refused.said.iter().cloned());
            }
            if self.options.stop == StopPolicy::FirstError {
                return None;
            }
        }
        if let Some(after_motion_only) = wanted.repeat {
            self.state.cycles = ModalCycles::of(Repeated {
                call: RepeatedCall::Program(found),
                own: wanted.own.clone(),
                after_motion_only,
            });
        }
        let depth = self.state.frames.last().map_or(0, |frame| frame.level) + 1;
        if depth > self.options.limits.calls {
            let fault = Fault::new(
                Code::Fc911,
                wanted.span,
                format!(
                    "subprogram calls are nested more than {} levels deep",
                    self.options.limits.calls
                ),
            )
            .with_help(Advice::RaiseBudget(Budget::Calls));
            self.work.diagnostics.push(at.diagnostic(fault));
            return None;
        }
        let passage = self.passage(&wanted, found, at).ok()?;
        Some(Request {
            found,
            passage,
            own: wanted.own,
            form: wanted.form,
            called_from: at.place(wanted.span),
        })
    }

    /// A program that is on the machine only (R2.83): whatever it may change is unknown after it.
    fn pass_over_external(&mut self, wanted: Wanted, at: &At<'_>) {
        let name = wanted.name;
        self.pass_over(&name, wanted.span, at);
        self.leave_to_machine(&name);
        let keeps = self.machine.programs.keeps(&name);
        if !keeps.compensation || !keeps.positions {
            let what = match keeps {
                Keeps {
                    compensation: true, ..
                } => "all positions become unknown",
                Keeps {
                    positions: true, ..
                } => "the compensation of every axis becomes unknown",
                Keeps { .. } => "every axis becomes unknown",
            };
            let fault = Fault::new(
                Code::Fc902,
                wanted.span,
                format!(
                    "the program `{name}` is only on the machine; the call is passed over, and {what}"
                ),
            )
            .with_help("if it leaves them as they are, say so in `[machine.external_keeps]`");
            self.work.diagnostics.push(at.diagnostic(fault));
        }
        if let Some(after_motion_only) = wanted.repeat {
            self.state.cycles = ModalCycles::of(Repeated {
                call: RepeatedCall::External(name),
                own: wanted.own,
                after_motion_only,
            });
        }
    }

    /// Whether only the machine has the program.
    pub(super) fn is_external(&self, wanted: &Wanted) -> bool {
        wanted.scope == CallScope::Global && self.machine.programs.is_external(&wanted.name)
    }

    /// Makes unknown what a program that is on the machine only does not keep.
    pub(super) fn leave_to_machine(&mut self, name: &str) {
        let keeps = self.machine.programs.keeps(name);
        if !keeps.compensation {
            self.doubt_couplings();
            self.forget_compensation();
        }
        if !keeps.parameters {
            // It writes the P parameters and variables of its caller (R2.33, R2.52).
            self.forget_memory(&name.into());
        }
        if !keeps.positions {
            self.state.modal.forget_positions();
            self.state.modal.note_transformed(name);
        }
    }

    /// The calls of a block with the modal cycle after them, unless the block is one of the
    /// cycle's.
    pub(super) fn repetition(
        &mut self,
        step: Option<Step>,
        moved: bool,
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Option<Step> {
        if self.state.cycles.is_empty() {
            return step;
        }
        let mut calls = match step {
            Some(Step::Call(calls)) => calls,
            // What was called with this block is the cycle itself.
            step => {
                debug_assert!(step.is_none());
                Vec::new()
            }
        };
        for cycle in self.state.cycles.known().to_vec() {
            if moved || !cycle.after_motion_only {
                calls.extend(self.repeat(cycle, &calls, at, finder));
            }
        }
        (!calls.is_empty()).then_some(Step::Call(calls))
    }

    /// A modal cycle after a block that made some calls.
    fn repeat(
        &mut self,
        cycle: Repeated,
        calls: &[Request],
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Option<Request> {
        let found = match &cycle.call {
            RepeatedCall::Program(found) | RepeatedCall::Perhaps(found) => *found,
            RepeatedCall::External(name) => {
                self.leave_to_machine(name);
                return None;
            }
        };
        let inside = self.state.frames.iter().any(|frame| {
            frame.level > 0 && (frame.unit, frame.section) == (found.unit, found.section)
        });
        if inside || calls.iter().any(|call| call.found == found) {
            return None;
        }
        if let RepeatedCall::Perhaps(_) = cycle.call {
            let section = &self.units[found.unit].index.sections[found.section];
            let region = section.start..section.end;
            let cause = self.units[found.unit].index.source.name().clone();
            self.forget_region(found.unit, region, &cause);
            self.forget_called(finder);
            return None;
        }
        Some(Request {
            found,
            passage: None,
            own: cycle.own,
            form: CallForm::Cycle,
            called_from: at.place(Span::new(0, at.text.len())),
        })
    }

    pub(super) fn find(
        &mut self,
        wanted: &Wanted,
        (unit, caller): (usize, &str),
        finder: &mut dyn Finder,
    ) -> Result<Option<Found>, Box<Fault>> {
        let name = wanted.name.as_str();
        if wanted.scope == CallScope::Local {
            let section = self.units.get(unit);
            return match section.and_then(|unit| unit.index.local(name)) {
                Some(section) => Ok(Some(Found { unit, section })),
                None => Err(self.no_local(wanted, unit)),
            };
        }
        let key = (caller.to_owned(), name.to_owned());
        let unit = if let Some(&unit) = self.found.get(&key) {
            unit
        } else {
            let source = match self.missing.get(&key) {
                Some(why) => Err(why.clone()),
                None => finder.find(name, caller),
            };
            let source = match source {
                Ok(source) => source,
                Err(why) => {
                    let fault = not_at_hand(wanted, &why);
                    self.missing.insert(key, why);
                    return Err(fault);
                }
            };
            let known = self.unit_names.get(source.name()).copied();
            let unit =
                known.unwrap_or_else(|| self.hold(Index::new(source, self.options.limits.nesting)));
            self.found.insert(key, unit);
            unit
        };
        let index = &self.units[unit].index;
        match index.main() {
            Some(section) => Ok(Some(Found { unit, section })),
            None if index.local_names().next().is_some() => Err(Box::new(
                Fault::new(
                    Code::Fc320,
                    wanted.span,
                    format!(
                        "the called program `{name}` contains only local subprograms, nothing to \
                         call"
                    ),
                )
                .with_help(
                    "a program that is called begins with `%NAME` or has no `%` line at all",
                ),
            )),
            // An empty file does nothing (R2.8).
            None => Ok(None),
        }
    }

    /// Calls the configured program that runs before every main program (R2.15).
    pub(super) fn start_program(
        &mut self,
        main: &str,
        finder: &mut dyn Finder,
    ) -> Result<(), Box<Diagnostic>> {
        let Some(name) = self.machine.programs.start.clone() else {
            return Ok(());
        };
        if self.machine.programs.is_external(&name) {
            self.leave_to_machine(&name);
            return Ok(());
        }
        let place = Place {
            file: name.as_str().into(),
            text: "".into(),
            first_line: 1,
            span: Span::default(),
        };
        let wanted = Wanted::program(CallScope::Global, name, Span::default());
        match self.find(&wanted, (0, main), finder) {
            Ok(Some(found)) => {
                let refused = &self.units[found.unit].index.refused;
                if let (Some(first), StopPolicy::FirstError) =
                    (refused.said.first(), self.options.stop)
                {
                    return Err(Box::new(first.clone()));
                }
                self.push_call(Request {
                    found,
                    passage: None,
                    own: BTreeMap::new(),
                    form: CallForm::Plain,
                    called_from: place,
                });
                Ok(())
            }
            Ok(None) => Ok(()),
            Err(fault) => {
                // The call stands in the configuration, not in a block.
                Err(Box::new(fault.into_diagnostic(place, |_| None)))
            }
        }
    }

    pub(super) fn push_call(&mut self, request: Request) {
        let Found { unit, section } = request.found;
        let level = self.state.frames.last().map_or(0, |frame| frame.level) + 1;
        self.state
            .memory
            .enter_call(usize::try_from(level).unwrap_or(usize::MAX));
        let restores = match request.form {
            CallForm::Plain => None,
            CallForm::Cycle => Some(Box::new(self.state.modal.save())),
        };
        self.journal.begin_anew();
        self.state.frames.push(Frame {
            unit,
            section,
            next: request
                .passage
                .map_or(self.units[unit].index.sections[section].start, |passage| {
                    passage.first
                }),
            level,
            own: request.own,
            seeking: None,
            called_from: Some(request.called_from),
            restores,
            retains: Retains::Nothing,
            waiting: Vec::new(),
            passage: request.passage,
        });
    }

    /// FC320 for a local subprogram. Names are compared for the first calls only: a file of calls
    /// that all fail has as many names as calls (R2.60).
    fn no_local(&mut self, wanted: &Wanted, unit: usize) -> Box<Fault> {
        let name = wanted.name.as_str();
        let fault = Fault::new(
            Code::Fc320,
            wanted.span,
            format!("the file has no local subprogram `{name}`"),
        );
        let left = MAX_COMPARED.saturating_sub(self.compared);
        let mut compared = 0;
        let near = self.units.get(unit).and_then(|unit| {
            let known = unit.index.local_names().take(left);
            did_you_mean(name, known.inspect(|_| compared += 1))
        });
        let fault = match near {
            Some(near) => fault.with_help(Advice::DidYouMean(near.to_owned())),
            None => fault.with_help(format!(
                "a local subprogram begins with `%L {name}` in the same file"
            )),
        };
        self.compared += compared;
        self.state.charge(compared);
        Box::new(fault)
    }
}

fn not_at_hand(wanted: &Wanted, why: &NoProgram) -> Box<Fault> {
    let name = &wanted.name;
    let fault = |code, what: &str| {
        Fault::new(
            code,
            wanted.span,
            format!("the called program `{name}` {what}"),
        )
    };
    Box::new(match why {
        NoProgram::Absent if name.is_empty() => {
            Fault::new(Code::Fc320, wanted.span, "the name of the called program is empty")
        }
        NoProgram::Absent => fault(Code::Fc320, "was not found")
            .with_help("it was looked for beside the calling file, then in the `program_dirs` of the configuration")
            .with_help(on_machine_only(name)),
        NoProgram::Unusable(what) => fault(Code::Fc320, what)
            .with_help("a called program must be a readable file of at most 1 GiB"),
        NoProgram::Outside => fault(Code::Fc321, "is outside the folders that programs may be called from")
            .with_help("these are the caller's folder, that of `frictcomp.toml` (the current folder if there is none), `program_dirs`, and everything below them; a file of the same name is also looked for there")
            .with_help(Advice::AllowOutside),
    })
}

/// How a program is passed over that only the machine has (R2.83).
fn on_machine_only(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    format!(
        "to pass over a program that only the machine has, set `external = [\"{last}\"]` in `[machine]`"
    )
}
