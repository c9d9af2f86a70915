//! Regions that may or may not be executed: they make unknown whatever they could change (R2.50,
//! R2.51).

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::store::Caller;
use crate::interpreter::programs::wanted::WantedCall;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::block_scratch::{PassedBy, PassedOver};
use crate::interpreter::run::channel_axes::Addressed;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::cycles::{Repeated, RepeatedCall};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::journal::RegionCall;
use crate::interpreter::run::region::{Region, RegionEffect};
use crate::interpreter::run::step::ControlStep;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::value::Value;
use crate::interpreter::values::work_budget::ITEM;
use crate::language::HashAction;
use crate::syntax::ast::Call;
use crate::text::Span;

impl Interpreter {
    /// Passes over a control block, from its statement to its end, and reports that (FC901).
    pub(crate) fn skip_unknown(
        &mut self,
        passed: Range<EntryIndex>,
        cause: &Unknown,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Option<ControlStep> {
        self.open_undecided(cause, span, at);
        let unit = self.state.control.frames.running()?.unit;
        let (from, after) = (passed.start, passed.end + 1);
        self.programs.unit_mut(unit).undecided.insert(from);
        self.note_passed(unit, from + 1..passed.end, cause, PassedBy::Branch);
        let region = self.havoc_region(unit, passed, cause);
        self.note_exits(&region, from..=after, cause, Some(span));
        Some(ControlStep::Jump(after))
    }

    /// Notes blocks that are passed over.
    pub(crate) fn note_passed(
        &mut self,
        unit: usize,
        blocks: Range<EntryIndex>,
        cause: &Unknown,
        by: PassedBy,
    ) {
        self.scratch.passed.push(PassedOver {
            unit,
            blocks,
            cause: cause.clone(),
            by,
        });
    }

    /// Makes unknown what the blocks of a region could change. Calls are kept for later, when
    /// their programs can be looked for.
    pub(crate) fn havoc_region(
        &mut self,
        unit: usize,
        range: Range<EntryIndex>,
        cause: &Unknown,
    ) -> Arc<Region> {
        let version = self.state.control.memory.macro_version();
        let region = self.havoc_blocks(unit, range.clone(), cause);
        // It may also use the macros that it defines, before or after: the second look finds them unknown, and
        // no third one is needed.
        if self.state.control.memory.macro_version() != version {
            return self.havoc_blocks(unit, range, cause);
        }
        region
    }

    fn havoc_blocks(
        &mut self,
        unit: usize,
        range: Range<EntryIndex>,
        cause: &Unknown,
    ) -> Arc<Region> {
        let key = (unit, range.start, range.end);
        let version = self.state.control.memory.macro_version();
        let known = self.regions.get(&key);
        let is_new = known.is_none_or(|known| known.macro_version != version);
        let region = self.region(unit, range);
        self.state
            .work
            .charge_region(ITEM * (region.effects.len() + region.calls.len()));
        self.note_differing(&region);
        for effect in &region.effects {
            self.suffer(effect, unit, cause);
        }
        let since = self.journal.since(key).filter(|_| !is_new);
        if let Some(written) = since {
            let known: Vec<Location> = written
                .iter()
                .filter(|written| region.writes(written))
                .cloned()
                .collect();
            self.state.work.charge_region(written.len());
            for target in &known {
                self.write(target, Value::Unknown(cause.clone()));
            }
        } else {
            self.state.work.charge_region(region.targets.len());
            for target in &region.targets {
                self.write(target, Value::Unknown(cause.clone()));
            }
        }
        self.journal.mark(key);
        let calls = region.calls.iter().map(|call| RegionCall {
            call: call.clone(),
            cause: cause.clone(),
            unit,
            region: Some(key),
        });
        self.pending.extend(calls);
        region
    }

    /// Makes unknown what one block could change, which may be of lines that are not kept.
    pub(crate) fn havoc_block(&mut self, at: &BlockContext<'_>, cause: &Unknown) -> Region {
        let version = self.state.control.memory.macro_version();
        let region = self.suffer_block(at, cause);
        if self.state.control.memory.macro_version() != version {
            return self.suffer_block(at, cause);
        }
        region
    }

    /// Makes unknown what a call of an unknown program could change (R2.52).
    pub(crate) fn havoc_call(&mut self, call: &Call, at: &BlockContext<'_>, cause: &Unknown) {
        let unit = self.running_unit();
        let region = self.region_of_call(unit, call, at);
        self.suffer_region(&region, unit, cause);
        self.scratch.unknown_call = Some(cause.clone());
    }

    fn suffer_block(&mut self, at: &BlockContext<'_>, cause: &Unknown) -> Region {
        let unit = self.running_unit();
        let region = self.region_of_block(unit, at);
        self.suffer_region(&region, unit, cause);
        region
    }

    fn running_unit(&self) -> usize {
        let frame = self.state.control.frames.running();
        frame.map_or(0, |frame| frame.unit)
    }

    fn suffer_region(&mut self, region: &Region, unit: usize, cause: &Unknown) {
        self.state.work.charge_region(
            ITEM * (region.effects.len() + region.calls.len() + region.targets.len()),
        );
        self.note_differing(region);
        for effect in &region.effects {
            self.suffer(effect, unit, cause);
        }
        for target in &region.targets {
            self.write(target, Value::Unknown(cause.clone()));
        }
        let calls = region.calls.iter().map(|call| RegionCall {
            call: call.clone(),
            cause: cause.clone(),
            unit,
            region: None,
        });
        self.pending.extend(calls);
    }

    /// Something of the state may have changed.
    fn suffer(&mut self, effect: &RegionEffect, unit: usize, cause: &Unknown) {
        let modal = &mut self.state.control.modal;
        match effect {
            RegionEffect::Compensation(axis, kinds) => match self.state.control.addressed(axis) {
                Ok(Addressed::Axis(axis)) => {
                    self.see(axis);
                    self.havoc(axis, *kinds);
                }
                Ok(Addressed::Absent(Some(axis))) => self.havoc(axis, *kinds),
                Ok(Addressed::Any | Addressed::Absent(None)) => self.havoc_any_axis(*kinds),
                Err(_) => {}
            },
            RegionEffect::G(number) => modal.havoc_g(*number),
            RegionEffect::Feeds => modal.havoc_feeds(),
            RegionEffect::Spindle => modal.pace.havoc_spindle(),
            RegionEffect::Overrides => modal.pace.havoc_overrides(),
            RegionEffect::Simplified(what) => modal.perhaps_simplify(*what),
            RegionEffect::Radius => modal.radius = None,
            RegionEffect::Position(axis) => {
                modal.havoc_position(*axis);
                self.scratch.perhaps_move(*axis);
                self.see(*axis);
            }
            RegionEffect::Positions => {
                modal.havoc_positions();
                self.perhaps_move_all();
            }
            RegionEffect::Reference(axis) => {
                modal.havoc_reference(*axis);
                self.see(*axis);
            }
            RegionEffect::Macro(name) => {
                self.state.control.memory.havoc_macro(name, cause);
                self.scratch.wrote = true;
            }
            RegionEffect::Hash(command) => {
                self.havoc_hash(*command, cause);
                match command.action {
                    HashAction::ExchangeAxes(_) => {
                        self.state.control.havoc_exchange();
                        self.state.control.modal.havoc_positions();
                    }
                    HashAction::SaveConfig(action) => self.havoc_config(action),
                    HashAction::ChangeFile(_) => self.state.control.files.change(None),
                    _ => {}
                }
            }
            RegionEffect::Coupling(axes) => self.state.control.havoc_definitions(axes),
            RegionEffect::Followers(axes) => self.state.control.couplings.havoc_followers(axes),
            RegionEffect::Function(word) => self.havoc_function(*word, unit, cause),
            RegionEffect::FileName(word) => {
                let unknown = Value::Unknown(cause.clone());
                self.state.control.named.insert(word.clone(), unknown);
                self.scratch.wrote = true;
            }
            RegionEffect::Declaration(name) => {
                let unknown = Value::Unknown(cause.clone());
                self.note_use(|used| used.write_name(name, &unknown));
                self.state.control.memory.declare(name, unknown);
                self.state.control.memory.havoc_elements(name, cause);
                self.scratch.wrote = true;
            }
            RegionEffect::Plc => self.let_plc_act(),
            RegionEffect::All => self.havoc_all(cause),
            RegionEffect::AnyLocal(span) => self.look_through_locals(*span, unit, cause),
        }
    }

    /// Makes unknown the possible effects of programs that a region calls (R2.51).
    pub(crate) fn havoc_called(&mut self, finder: &mut dyn Finder) {
        let mut pending = std::mem::take(&mut self.pending);
        let mut seen = HashSet::new();
        let version = self.state.control.memory.macro_version();
        let mut callers = BTreeMap::new();
        while let Some(RegionCall {
            call,
            cause,
            unit,
            region,
        }) = pending.pop()
        {
            if self.is_exhausted() {
                return;
            }
            callers.extend(region.map(|region| (region, cause.clone())));
            if self.is_external(&call) {
                let program = call.missing();
                self.leave_to_machine(&program);
                self.state
                    .control
                    .perhaps_repeat(&call, RepeatedCall::External(program));
                continue;
            }
            let caller = self
                .programs
                .units()
                .get(unit)
                .map(|unit| unit.index.source.name());
            let caller = caller.cloned().unwrap_or_default();
            let found = match self.programs.find(
                &call,
                Caller {
                    unit,
                    file: &caller,
                },
                finder,
                &self.state.work,
            ) {
                Ok(Some(found)) => found,
                Ok(None) => continue,
                Err(_) => {
                    // Its effects are not known.
                    let undecided = self.scratch.undecided.take();
                    self.havoc_all(&cause);
                    self.note_stop(&cause);
                    self.scratch.undecided = undecided.map(|mut undecided| {
                        let name = &call.name;
                        let all = format!("all that `{name}` could change, which is not found");
                        undecided.differing.name(all);
                        undecided
                    });
                    continue;
                }
            };
            self.state
                .control
                .perhaps_repeat(&call, RepeatedCall::Perhaps(found));
            if !seen.insert((found.unit, found.section)) {
                continue;
            }
            let section = self.programs.section(found);
            let region = section.start..section.end;
            self.note_passed(found.unit, region.clone(), &cause, PassedBy::Call);
            let region = self.havoc_region(found.unit, region, &cause);
            self.note_far_exits(&region, &cause);
            pending.append(&mut self.pending);
        }
        // Macros that a called program may define are used where it was called from.
        if self.state.control.memory.macro_version() != version {
            for ((unit, from, to), cause) in callers {
                self.havoc_blocks(unit, from..to, &cause);
            }
            self.pending.clear();
        }
    }
}

impl ControlState {
    /// A modal cycle of a region may be in force after it.
    fn perhaps_repeat(&mut self, wanted: &WantedCall, call: RepeatedCall) {
        if let Some(after_motion_only) = wanted.repeat {
            self.cycles.add(Repeated {
                call,
                own: BTreeMap::new(),
                after_motion_only,
            });
        }
    }
}
