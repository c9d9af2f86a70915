//! Messages on parts of the program that may or may not be executed: the value that decides, its
//! origin, and what becomes unknown (R2.95).

use std::collections::BTreeMap;
use std::ops::Range;

use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::diagnostic::Code;
use crate::interpreter::coordinates::motion::Motions;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::channel_axes::Addressed;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::region::{Region, RegionEffect};
use crate::interpreter::run::undecided::{Differing, Undecided};
use crate::interpreter::run::ways::JumpTarget;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::language::{GAction, GFunction, Group, HashAction, HashWords};
use crate::machine::Parameters;
use crate::syntax::Fault;
use crate::text::Span;

/// Limit of the axes that a message names.
const MAX_NAMED: usize = 8;

impl Interpreter {
    /// Prepares the message about a part of the program (FC901); [`Self::tell_undecided`] completes it, as
    /// soon as the programs that the part may call are known.
    pub(crate) fn open_undecided(&mut self, cause: &Unknown, span: Span, at: &BlockContext<'_>) {
        if self.scratch.unread.get() || self.scratch.undecided.is_some() {
            return;
        }
        let message = match cause {
            Unknown::SkipLevel(level) if at.block.skip == Some(*level) => format!(
                "whether the control executes the blocks of {cause} depends on a switch of the \
                 machine; whatever they could change is unknown from here on"
            ),
            _ => format!(
                "this control block depends on {}; whatever it could change is unknown from here on",
                cause.seen_from(at.file)
            ),
        };
        let fault = Fault::new(Code::Fc901, span, message).with_help(cause.advice());
        let said = at.diagnostic(fault);
        let said = self.state.mentioned.with_origin(said, cause, at);
        self.scratch.undecided = Some(Box::new(Undecided {
            cause: cause.clone(),
            said: self.scratch.diagnostics.len(),
            doubted: self.scratch.doubted.len(),
            differing: Differing::default(),
        }));
        self.scratch.diagnostics.push(said);
        self.state.mentioned.enter_root(cause, span, at);
    }

    /// Completes the message about a part of the program, or withholds it where nothing differs or
    /// where it was reported before.
    #[cold]
    pub(crate) fn tell_undecided(&mut self, undecided: Undecided) {
        let Undecided {
            cause,
            said,
            doubted,
            mut differing,
        } = undecided;
        if said >= self.scratch.diagnostics.len() {
            return;
        }
        let mut doubted = self
            .scratch
            .doubted
            .get(doubted..)
            .unwrap_or_default()
            .to_vec();
        if !doubted.is_empty()
            && let Unknown::SkipLevel(level) = cause
        {
            doubted.extend(self.switched_by_level(level));
        }
        let mut kinds: BTreeMap<Kind, Vec<&str>> = BTreeMap::new();
        for (axis, doubted) in &doubted {
            for kind in doubted.iter() {
                let names = kinds.entry(kind).or_default();
                let name = self.machine.axis(*axis).name.as_str();
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        let mut keys: Vec<String> = differing.named.iter().cloned().collect();
        for (kind, axes) in &kinds {
            keys.extend(axes.iter().map(|axis| format!("{kind} {axis}")));
        }
        // A difference without a name is also reported once.
        keys.push(differing.leaves.unwrap_or_default().to_owned());
        let shown: Vec<String> = kinds
            .iter()
            .map(|(kind, axes)| of_axes(*kind, axes))
            .collect();
        differing.decides |= !shown.is_empty();
        let place = &self.scratch.diagnostics[said].place;
        let is_new = self.state.mentioned.is_new(&cause, keys, place);
        if !(differing.decides && is_new) {
            let said = self.scratch.diagnostics.remove(said);
            self.scratch.aside.withheld.push(said);
            return;
        }
        let named: Vec<String> = shown.into_iter().chain(differing.named).collect();
        if !named.is_empty() {
            let message = &mut self.scratch.diagnostics[said].message;
            message.push_str(", including ");
            message.push_str(&named.join(", "));
        }
        // For a control block, FC902 reports this.
        if let (Some(leaves), Unknown::SkipLevel(_)) = (differing.leaves, &cause) {
            let message = &mut self.scratch.diagnostics[said].message;
            message.push_str("; ");
            message.push_str(leaves);
        }
    }

    /// Returns the switches of a skip level in the running file: one message names them all.
    fn switched_by_level(&mut self, level: u8) -> Vec<(AxisIndex, KindSet)> {
        let Some(unit) = self.state.control.frames.running().map(|frame| frame.unit) else {
            return Vec::new();
        };
        let region = self.region_of_level(unit, level);
        let mut switched = Vec::new();
        for effect in &region.effects {
            let RegionEffect::Compensation(name, kinds) = effect else {
                continue;
            };
            if let Ok(Addressed::Axis(axis)) = self.state.control.addressed(name) {
                let state = |kind: &Kind| self.state.control.compensation.state(axis, *kind);
                let set = kinds
                    .iter()
                    .filter(|kind| state(kind) != State::Unconfigured);
                switched.push((axis, set.collect()));
            }
        }
        switched
    }

    /// Notes what a region changes that may differ afterwards.
    pub(crate) fn note_differing(&mut self, region: &Region) {
        let Some(mut undecided) = self.scratch.undecided.take() else {
            return;
        };
        let is_skip = matches!(undecided.cause, Unknown::SkipLevel(_));
        for effect in &region.effects {
            self.weigh(effect, is_skip, &mut undecided.differing);
        }
        for target in &region.targets {
            if let Location::Variable(name) | Location::Elements(name) = target
                && name.family().is_read_by_others()
            {
                undecided.differing.name(format!("`{name}`"));
            }
            if matches!(target, Location::Parameter(..) | Location::Parameters)
                && self.machine.parameters == Parameters::Kept
            {
                undecided.differing.decides = true;
            }
        }
        self.scratch.undecided = Some(undecided);
    }

    fn weigh(&self, effect: &RegionEffect, is_skip: bool, differing: &mut Differing) {
        match effect {
            // The refusals in a skipped block are reported separately.
            RegionEffect::Compensation(..) => differing.decides |= !is_skip,
            RegionEffect::All => differing.name("everything that a program can change"),
            RegionEffect::Coupling(_) => differing.name("axis couplings"),
            RegionEffect::Hash(command) => weigh_command(*command, differing),
            RegionEffect::Declaration(name) if name.family().is_read_by_others() => {
                differing.name(format!("`{name}`"));
            }
            RegionEffect::Position(axis) if !self.machine.axis(*axis).required.is_empty() => {
                differing.decides = true;
            }
            // A block that may be skipped and only moves matters only if motions are requested.
            RegionEffect::G(number) if !is_skip && is_modal_word(*number) => {
                differing.name("modal words");
            }
            RegionEffect::G(_)
            | RegionEffect::Feeds
            | RegionEffect::Spindle
            | RegionEffect::Overrides
            | RegionEffect::Simplified(_)
            | RegionEffect::Radius
            | RegionEffect::Position(_)
            | RegionEffect::Positions
            | RegionEffect::Reference(_)
                if self.options.motions == Motions::Taken =>
            {
                differing.name("positions and what paces motion");
            }
            // A value that affects something is reported there; called programs are examined.
            _ => {}
        }
    }

    /// Notes a way that leaves a part that may or may not be executed.
    pub(crate) fn note_leaving(&mut self, to: JumpTarget, here: EntryIndex) {
        if self.scratch.undecided.is_none() || !self.differs(to, here) {
            return;
        }
        if let Some(undecided) = &mut self.scratch.undecided {
            undecided.differing.decides = true;
            undecided.differing.leaves = Some(match to {
                JumpTarget::End => "the program may end here",
                JumpTarget::Return | JumpTarget::Far => "the program may be left here",
                JumpTarget::Block(_) => "other blocks may follow",
            });
        }
    }

    /// Whether anything differs between a way and the one of the dry run, which continues at a block.
    pub(crate) fn differs(&mut self, to: JumpTarget, here: EntryIndex) -> bool {
        let JumpTarget::Block(target) = to else {
            return true;
        };
        let Some(place) = self.state.control.frames.program() else {
            return true;
        };
        if self.programs.index(place.unit).entries.len() < here.max(target) as usize {
            return true;
        }
        let between = self.passed_by(place.unit, here.min(target)..here.max(target));
        let region = self.region(place.unit, between);
        let mut differing = Differing::default();
        for effect in &region.effects {
            self.weigh(effect, false, &mut differing);
        }
        let outlives = |target: &Location| match target {
            Location::Variable(name) | Location::Elements(name) => {
                name.family().is_read_by_others()
            }
            Location::Parameter(..) | Location::Parameters => {
                self.machine.parameters == Parameters::Kept
            }
        };
        differing.decides
            || !region.calls.is_empty()
            || !region.exits.is_empty()
            || region.targets.iter().any(outlives)
    }

    /// The blocks that one of two ways may execute and the other does not, where they part before some
    /// blocks and meet after them: a way into a loop or out of it is one past all its passes.
    fn passed_by(&self, unit: usize, blocks: Range<EntryIndex>) -> Range<EntryIndex> {
        let index = self.programs.index(unit);
        self.state.work.charge_region(index.loops.len());
        let mut around = blocks;
        for &opener in index.loops.keys() {
            let end = index.links(opener).end;
            let opens = around.contains(&opener);
            let closes = around.contains(&end);
            if opens != closes {
                around = around.start.min(opener)..around.end.max(end + 1);
            }
        }
        around
    }
}

/// Returns the name of a kind of several axes in a message.
pub(crate) fn of_axes(kind: Kind, axes: &[&str]) -> String {
    let shown: Vec<String> = axes
        .iter()
        .take(MAX_NAMED)
        .map(|it| format!("`{it}`"))
        .collect();
    let more = if axes.len() > MAX_NAMED { " …" } else { "" };
    format!("`{}` of {}{more}", kind.as_str(), shown.join(" "))
}

/// Whether a G function stays in force after a motion and is not a motion itself.
fn is_modal_word(number: Option<i64>) -> bool {
    let number = number.and_then(|number| u32::try_from(number).ok());
    let Some(function) = number.map(GFunction::of) else {
        return true;
    };
    function.is_some_and(|function| match function.group {
        Some(group) => group != Group::Motion,
        None => function.action == GAction::Mirror,
    })
}

/// Notes what a `#` command changes that may differ afterwards.
fn weigh_command(command: HashWords, differing: &mut Differing) {
    match command.action {
        HashAction::DefineCoupling(_)
        | HashAction::EnableCoupling
        | HashAction::ReleaseCoupling
        | HashAction::ReleaseCouplings => differing.name("axis couplings"),
        HashAction::ExchangeAxes(_) => differing.name("the axes of the channel"),
        HashAction::EndModalCycles => differing.name("modal cycles"),
        HashAction::ReportError => differing.decides = true,
        _ => {}
    }
}
