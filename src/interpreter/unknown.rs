//! What cannot be known offline: a region that may or may not be executed makes unknown whatever
//! it could change (R2.50, R2.51).

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use super::at::At;
use super::budget::ITEM;
use super::call::Wanted;
use super::cycles::{Repeated, RepeatedCall};
use super::exchange::{Addressed, is_exchange};
use super::expression::Place;
use super::finder::Finder;
use super::memory::unescaped;
use super::program::EntryIndex;
use super::region::{Effect, Region};
use super::run::Interpreter;
use super::state::Step;
use super::target::Target;
use super::value::Value;
use crate::comp::{AxisIndex, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic};
use crate::syntax::Fault;
use crate::syntax::ast::Effect as Unread;
use crate::text::Span;

/// A call found in a region that may or may not be executed.
#[derive(Debug, Clone)]
pub(super) struct Scan {
    pub(super) call: Wanted,
    pub(super) cause: Arc<str>,
    /// The file that holds the call.
    pub(super) unit: usize,
    /// The region that holds it, where it is written there.
    pub(super) region: Option<RegionKey>,
}

/// What was written since regions were made unknown last: a loop that comes back to a region need
/// only look at that.
#[derive(Debug, Default)]
pub(super) struct Journal {
    written: Vec<Target>,
    /// Rises when the list is restarted.
    epoch: u64,
    /// Up to where the list counted when a region was made unknown.
    seen: HashMap<RegionKey, (u64, usize)>,
}

/// A file and a range of its blocks.
pub(super) type RegionKey = (usize, EntryIndex, EntryIndex);

/// How many axes a message names.
const MAX_NAMED: usize = 8;

/// How long the list may become.
const MAX_WRITTEN: usize = 4096;

impl Journal {
    /// A value became known.
    #[inline]
    pub(super) fn write(&mut self, place: &Place, value: &Value) {
        // Where no region was looked through, nothing has to be kept.
        if self.seen.is_empty() || matches!(value, Value::Unknown(_)) {
            return;
        }
        match place {
            Place::Parameter(owner, index) => self.note(Target::Parameter(*owner, *index)),
            Place::Variable(name) => self.note(Target::Variable(name.clone())),
            Place::Elements(..) | Place::Parameters(_) | Place::Nowhere => {}
        }
    }

    fn note(&mut self, target: Target) {
        if self.written.len() >= MAX_WRITTEN {
            self.begin_anew();
        } else {
            self.written.push(target);
        }
    }

    /// Something happened that the list does not tell.
    pub(super) fn begin_anew(&mut self) {
        self.written.clear();
        self.epoch += 1;
        self.seen.clear();
    }

    /// What was written since the region was made unknown last; `None` where that is not known.
    fn since(&self, key: RegionKey) -> Option<&[Target]> {
        let &(epoch, from) = self.seen.get(&key)?;
        (epoch == self.epoch).then(|| self.written.get(from..).unwrap_or_default())
    }

    fn mark(&mut self, key: RegionKey) {
        self.seen.insert(key, (self.epoch, self.written.len()));
    }
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
        if !self.work.unread.get() {
            let what = super::cause::unknown_value(cause);
            let message = format!(
                "this control block depends on {what}; whatever it could change is unknown from here on"
            );
            let fault = Fault::new(Code::Fc901, span, message);
            let fault = fault.with_help(super::cause::how_to_set(cause));
            self.work.diagnostics.push(at.diagnostic(fault));
        }
        let unit = self.state.frames.last()?.unit;
        self.units[unit].undecided.insert(from);
        let region = self.forget_region(unit, from..to, cause);
        self.note_exits(&region, (from, to + 1), (cause, Some(span)));
        Some(Step::Jump(to + 1))
    }

    /// Makes unknown what the blocks of a region could change. Calls are kept for later, when
    /// their programs can be looked for.
    pub(super) fn forget_region(
        &mut self,
        unit: usize,
        range: Range<EntryIndex>,
        cause: &Arc<str>,
    ) -> Arc<Region> {
        let version = self.state.memory.macro_version();
        let region = self.forget_blocks(unit, range.clone(), cause);
        // What it defines it may use as well, before or after: the second look finds such macros
        // unknown, and no third one is needed.
        if self.state.memory.macro_version() != version {
            return self.forget_blocks(unit, range, cause);
        }
        region
    }

    fn forget_blocks(
        &mut self,
        unit: usize,
        range: Range<EntryIndex>,
        cause: &Arc<str>,
    ) -> Arc<Region> {
        let key = (unit, range.start, range.end);
        let version = self.state.memory.macro_version();
        let known = self.regions.get(&key);
        let is_new = known.is_none_or(|known| known.macro_version != version);
        let region = self.region(unit, range);
        self.state
            .charge(ITEM * (region.effects.len() + region.calls.len()));
        for effect in &region.effects {
            self.suffer(effect, unit, cause);
        }
        let since = self.journal.since(key).filter(|_| !is_new);
        if let Some(written) = since {
            let known: Vec<Target> = written
                .iter()
                .filter(|written| region.writes(written))
                .cloned()
                .collect();
            self.state.charge(written.len());
            for target in &known {
                self.lose(target, cause);
            }
        } else {
            self.state.charge(region.targets.len());
            for target in &region.targets {
                self.lose(target, cause);
            }
        }
        self.journal.mark(key);
        let calls = region.calls.iter().map(|call| Scan {
            call: call.clone(),
            cause: cause.clone(),
            unit,
            region: Some(key),
        });
        self.pending.extend(calls);
        region
    }

    /// Something of the state may have changed.
    fn suffer(&mut self, effect: &Effect, unit: usize, cause: &Arc<str>) {
        let modal = &mut self.state.modal;
        match effect {
            Effect::Compensation(axis, kinds) => match self.addressed(axis) {
                Ok(Addressed::Axis(axis)) => {
                    self.see(axis);
                    self.doubt(axis, *kinds);
                }
                Ok(Addressed::Absent(Some(axis))) => self.doubt(axis, *kinds),
                Ok(Addressed::Any | Addressed::Absent(None)) => self.doubt_any_axis(*kinds),
                Err(_) => {}
            },
            Effect::G(number) => modal.forget_g(*number),
            Effect::Feeds => modal.feeds = [None; 3],
            Effect::Radius => modal.radius = None,
            Effect::Position(axis) => {
                modal.forget_position(*axis);
                self.see(*axis);
            }
            Effect::Positions => modal.forget_positions(),
            Effect::Reference(axis) => {
                modal.forget_reference(*axis);
                self.see(*axis);
            }
            Effect::Macro(name) => {
                self.state.memory.forget_macro(name, cause);
                self.work.wrote = true;
            }
            Effect::Hash(name) => {
                self.forget_hash(name, cause);
                if is_exchange(name) {
                    self.doubt_exchange();
                }
            }
            Effect::Coupling(axes) => self.doubt_definitions(axes),
            Effect::Function(letter, number) => {
                self.forget_function((*letter, *number), unit, cause);
            }
            Effect::FileName(word) => {
                let unknown = Value::Unknown(cause.clone());
                self.state.named.insert(word.clone(), unknown);
                self.work.wrote = true;
            }
            Effect::Declaration(name) => {
                let unknown = Value::Unknown(cause.clone());
                self.state.memory.declare(name, unknown);
                self.state.memory.forget_elements(name, cause);
                self.work.wrote = true;
            }
            Effect::All => self.forget_all(cause),
        }
    }

    /// A value may have been written.
    pub(super) fn lose(&mut self, target: &Target, cause: &Arc<str>) {
        let unknown = || Value::Unknown(cause.clone());
        match target {
            Target::Parameter(owner, index) => {
                self.write(Place::Parameter(*owner, *index), unknown());
            }
            Target::Variable(name) => self.write(Place::Variable(name.clone()), unknown()),
            Target::Elements(name) => {
                self.write(Place::Elements(name.clone(), cause.clone()), unknown());
            }
            Target::Parameters => self.write(Place::Parameters(cause.clone()), unknown()),
        }
    }

    /// What text could change that is not known here (R2.70).
    pub(super) fn forget_unread(&mut self, effect: Unread, cause: &Arc<str>) {
        match effect {
            Unread::Everything => self.forget_all(cause),
            Unread::Parameters => {
                self.write(
                    Place::Parameters(cause.clone()),
                    Value::Unknown(cause.clone()),
                );
            }
            Unread::Spindle => {}
        }
    }

    /// Everything that a program could change becomes unknown: every kind of every axis, positions and
    /// modal words, parameters and variables (R2.52).
    pub(super) fn forget_all(&mut self, cause: &Arc<str>) {
        self.forget_memory(cause);
        self.state.memory.forget_macros(cause, |_, _| false);
        self.state.modal.forget_g(None);
        self.state.modal.feeds = [None; 3];
        self.state.modal.radius = None;
        self.doubt_couplings();
        self.forget_compensation();
    }

    /// Every parameter and variable becomes unknown.
    pub(super) fn forget_memory(&mut self, cause: &Arc<str>) {
        self.journal.begin_anew();
        self.work.wrote = true;
        self.state.memory.forget_all(cause);
    }

    /// Every kind of every axis becomes unknown.
    pub(super) fn forget_compensation(&mut self) {
        for position in 0..self.machine.axes.len() {
            let axis = AxisIndex::new(position);
            self.state
                .compensation
                .forget(axis, KindSet::ALL, &mut self.work.changes);
        }
    }

    /// The macros of programs may be gone; those of the machine are what it says, now as before.
    pub(super) fn doubt_macros(&mut self, cause: &Arc<str>) {
        let machine = &self.machine.programs.macros;
        let stays = |name: &str, code: &str| {
            let last = machine.iter().rev().find(|(own, _)| own.trim() == name);
            last.is_some_and(|(_, own)| unescaped(own) == code)
        };
        self.state.memory.forget_macros(cause, stays);
    }

    /// Kinds of an axis become unknown.
    pub(super) fn doubt(&mut self, axis: AxisIndex, kinds: KindSet) {
        let compensation = &mut self.state.compensation;
        compensation.forget(axis, kinds, &mut self.work.changes);
        let doubted = compensation.unknown(axis).intersection(kinds);
        if !doubted.is_empty() {
            self.work.doubted.push((axis, doubted));
        }
    }

    /// Names the kinds that a control block makes unknown, as soon as the programs are known that it
    /// may call.
    #[cold]
    pub(super) fn name_doubted(&mut self) {
        let is_block = |said: &Diagnostic| said.code == Code::Fc901;
        if !self.work.diagnostics.iter().any(is_block) {
            return;
        }
        let mut kinds: BTreeMap<Kind, Vec<&str>> = BTreeMap::new();
        for (axis, doubted) in &self.work.doubted {
            for kind in doubted.iter() {
                let names = kinds.entry(kind).or_default();
                let name = self.machine.axis(*axis).name.as_str();
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        let named = kinds.iter().map(|(kind, axes)| {
            let shown: Vec<String> = axes
                .iter()
                .take(MAX_NAMED)
                .map(|it| format!("`{it}`"))
                .collect();
            let more = if axes.len() > MAX_NAMED { " …" } else { "" };
            format!("`{}` of {}{more}", kind.keyword(), shown.join(" "))
        });
        let named: Vec<String> = named.collect();
        let said = self.work.diagnostics.iter_mut();
        for said in said.filter(|said| is_block(said)) {
            said.message.push_str(", including ");
            said.message.push_str(&named.join(", "));
        }
    }

    /// What called programs of a region could change becomes unknown too (R2.51).
    pub(super) fn forget_called(&mut self, finder: &mut dyn Finder) {
        let mut pending = std::mem::take(&mut self.pending);
        let mut seen = HashSet::new();
        let version = self.state.memory.macro_version();
        let mut callers = BTreeMap::new();
        while let Some(Scan {
            call,
            cause,
            unit,
            region,
        }) = pending.pop()
        {
            if self.is_worn_out() {
                return;
            }
            callers.extend(region.map(|region| (region, cause.clone())));
            if self.is_external(&call) {
                self.leave_to_machine(&call.name);
                let name = call.name.clone();
                self.perhaps_repeat(&call, RepeatedCall::External(name));
                continue;
            }
            let caller = self.units.get(unit).map(|unit| unit.index.source.name());
            let caller = caller.cloned().unwrap_or_default();
            let found = match self.find(&call, (unit, &caller), finder) {
                Ok(Some(found)) => found,
                Ok(None) => continue,
                Err(_) => {
                    // What it would have done is not known.
                    self.forget_all(&cause);
                    continue;
                }
            };
            self.perhaps_repeat(&call, RepeatedCall::Perhaps(found));
            if !seen.insert((found.unit, found.section)) {
                continue;
            }
            let section = &self.units[found.unit].index.sections[found.section];
            let region = section.start..section.end;
            let region = self.forget_region(found.unit, region, &cause);
            self.note_far_exits(&region, &cause);
            pending.append(&mut self.pending);
        }
        // Macros that a called program may define are used where it was called from.
        if self.state.memory.macro_version() != version {
            for ((unit, from, to), cause) in callers {
                self.forget_blocks(unit, from..to, &cause);
            }
            self.pending.clear();
        }
    }

    /// A modal cycle of a region may be in force after it.
    fn perhaps_repeat(&mut self, wanted: &Wanted, call: RepeatedCall) {
        if let Some(after_motion_only) = wanted.repeat {
            self.state.cycles.add(Repeated {
                call,
                own: BTreeMap::new(),
                after_motion_only,
            });
        }
    }
}

/// Regions that were looked through.
pub(super) type Regions = HashMap<RegionKey, Arc<Region>>;
