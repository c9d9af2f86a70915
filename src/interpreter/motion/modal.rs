//! Modal state: the G functions in force, the feeds, programmed positions (R2.45 to R2.47), and what the end of a cycle restores
//! of it (P-CHAN-00210).

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;
use crate::interpreter::motion::form::{AxisWord, BlockEnd, ToolSide, WordValue, shifted};
use crate::interpreter::motion::pace::{
    Contouring, LackingFeeds, Pace, ProgrammedFeed, SlopeSelection,
};
use crate::language::{
    ChainStep, ChannelState, ContouringCommand, GAction, GFunction, Group, GroupSet, HashCommand,
    HashWords, Holds, Mode, Modes, OnOff, Simplification, Simplifications,
};
use crate::lists::{ChannelSettings, ChannelSwitch, SlopeProfile};

/// Frame of a position: that of the machine, or the difference from it; greater differences come later.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum PositionFrame {
    /// Position in the coordinates of the machine.
    Machine,
    /// An origin that only the machine knows: paths and velocities are those of the machine, places
    /// are those of the program (R11.30).
    Shifted,
    /// Tool radius compensation is active: positions are those of the programmed contour, which the tool
    /// follows beside it.
    Contour,
    /// A transformation, rotation or mirroring is active: positions are those of the program (R2.47).
    Programmed,
}

/// The position of an axis after a block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisPosition {
    /// The programmed coordinate in mm or degrees with the offset of G92; `None` where it is not
    /// known.
    pub value: Option<f64>,
    /// Frame of the position.
    pub frame: PositionFrame,
}

/// The way back from beside the contour after G40.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub(crate) enum Leaving {
    /// The tool is on it.
    #[default]
    Done,
    /// Only axes beside the plane have moved since.
    Beside,
    /// Nothing has moved since.
    Begun,
}

/// The G functions in force and the programmed positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Modal {
    /// The G functions in force and the feeds.
    pub functions: GFunctions,
    /// The radius of circles without a centre, R; `None` where it is not known.
    pub radius: Option<f64>,
    /// Names of the `#` commands and G functions that separate positions from those of the machine.
    pub transformed: BTreeSet<String>,
    /// Functions on the path or its velocity that a commanded trace does not follow.
    pub simplified: Simplifications,
    /// The parameters of `#CONTOUR MODE`, for G61 and G261.
    contour: Contouring,
    /// The parameters of `#HSC`.
    high_speed: Contouring,
    /// The profile of the acceleration, where the program selects one (`#SLOPE`).
    #[serde(default)]
    slope: Option<SlopeProfile>,
    /// State that turns F into the velocity of the path.
    pub(crate) pace: Pace,
    /// Whether the rotation in force certainly turns each axis of the plane out of its direction.
    #[serde(default)]
    pub(crate) skewed: bool,
    /// Modes in which the control refuses some words.
    #[serde(default)]
    pub(crate) modes: Modes,
    /// How far the tool is from the programmed contour after G40.
    #[serde(default)]
    pub(crate) leaving: Leaving,
    /// Axes that the operator moves along with the program, G201.
    #[serde(default)]
    pub(crate) manual: BTreeSet<AxisIndex>,
    /// Axes of the stroke, `#STROKE DEF BEGIN`.
    #[serde(default)]
    pub(crate) stroke: BTreeSet<AxisIndex>,
    /// Whether coordinates count from an origin other than that at the start of the program.
    origin_moved: bool,
    /// Absolute positions: the programmed coordinate and the offset of G92.
    positions: Vec<Option<f64>>,
    /// G92; `None` where it is not known.
    references: Vec<Option<f64>>,
    /// Offsets of G92 before `#MCS ON`, restored by `#MCS OFF`.
    suspended: Option<Vec<Option<f64>>>,
}

impl Modal {
    /// Returns the defaults at program start. Axis positions are not known.
    pub fn new(axes: usize) -> Self {
        Self {
            functions: GFunctions::default(),
            radius: None,
            transformed: BTreeSet::new(),
            simplified: Simplifications::default(),
            contour: Contouring::default(),
            high_speed: Contouring::high_speed(),
            slope: None,
            pace: Pace::new(Some(1.0)),
            skewed: false,
            modes: Modes::default(),
            leaving: Leaving::Done,
            manual: BTreeSet::new(),
            stroke: BTreeSet::new(),
            origin_moved: false,
            positions: vec![None; axes],
            references: vec![Some(0.0); axes],
            suspended: None,
        }
    }

    /// Returns the state at program start in a channel.
    pub(crate) fn at_start(axes: usize, channel: &ChannelSettings) -> Self {
        let mut modal = Self {
            pace: Pace::new(channel.feed_unit.in_mm()),
            ..Self::new(axes)
        };
        for &number in &channel.functions {
            match Group::of(number) {
                Some(group) => modal.set(group, number),
                // G51: diameters are programmed.
                None if number == 51 => modal.note_transformed("G51"),
                None => modal.switch_mode(GFunction::of(number).and_then(|row| row.mode)),
            }
        }
        let chosen = |number: &u32| Group::of(*number) == Some(Group::Unit);
        if channel.inch && !channel.functions.iter().any(chosen) {
            modal.functions.unknown.insert(Group::Unit);
        }
        if channel.has(ChannelSwitch::KeepOffset) {
            modal.functions.unknown.insert(Group::Offset);
        }
        if channel.has(ChannelSwitch::KeepToolData) {
            modal.select_tool_data(None);
        }
        if let Some(value) = channel.feed_mm_per_min {
            modal.functions.lacking.give(PER_MINUTE);
            modal.functions.feeds[PER_MINUTE] = Some(ProgrammedFeed {
                value,
                unit_mm: Some(1.0),
            });
        }
        modal
    }

    /// Returns the state at the start of the next program: the axes stay where they are.
    pub(crate) fn next_program(&self, channel: &ChannelSettings) -> Self {
        Self {
            positions: self.positions.clone(),
            ..Self::at_start(self.positions.len(), channel)
        }
    }

    /// Returns whether it describes a number of axes.
    pub(crate) fn fits(&self, axes: usize) -> bool {
        let suspended = self.suspended.as_ref().map_or(axes, Vec::len);
        let mut named = self.manual.iter().chain(&self.stroke);
        let are_axes = named.all(|axis| axis.get() < axes);
        are_axes && [self.positions.len(), self.references.len(), suspended] == [axes; 3]
    }

    /// Returns whether it is known which G function of a group is in force.
    pub fn is_known(&self, group: Group) -> bool {
        !self.functions.unknown.contains(group)
    }

    /// Returns the axis letter that `@X`, `@Y` or `@Z` means in the active plane; `None` where the plane is not known.
    pub(crate) fn main_axis(&self, letter: u8) -> Option<u8> {
        let place = usize::from(letter.checked_sub(b'X')?);
        let axes = match self.functions.plane {
            _ if !self.is_known(Group::Plane) => return None,
            18 => b"ZXY",
            19 => b"YZX",
            _ => b"XYZ",
        };
        axes.get(place).copied()
    }

    /// Puts a G function of a group into force.
    #[inline]
    pub(crate) fn set(&mut self, group: Group, number: u32) {
        self.functions.unknown.remove(group);
        match group {
            Group::Motion => self.functions.motion = number,
            Group::Plane => self.functions.plane = number,
            Group::Unit => self.functions.inch = number == 70,
            Group::Distance => self.functions.absolute = number == 90,
            Group::Feed => self.functions.feed_mode = number,
            Group::Offset => {
                // An offset's values are the machine's own; coordinates lose their meaning.
                if self.functions.offset != number {
                    self.havoc_positions();
                }
                self.functions.offset = number;
            }
            Group::CutterRadius => {
                let was_on = self.transformed.contains(CUTTER_RADIUS);
                self.leaving = match number {
                    40 if was_on => Leaving::Begun,
                    40 => self.leaving,
                    _ => Leaving::Done,
                };
                self.functions.tool_side = number;
                self.transform(CUTTER_RADIUS, number != 40);
            }
            Group::CircleCentre => self.functions.centre_absolute = number == 161,
            Group::ExactStop if number == 360 => self.functions.block_end = BlockEnd::ExactStop,
            Group::ExactStop => self.functions.block_end = BlockEnd::Through,
        }
    }

    /// Records a command or function that a commanded trace does not follow in full.
    pub(crate) fn simplify(&mut self, what: Simplification, holds: Holds) {
        self.simplified = match holds {
            Holds::On => self.simplified.union(what.into()),
            Holds::Off => self.simplified.without(what.into()),
            Holds::Once => self.simplified,
        };
    }

    /// Returns the parameters that a command sets.
    pub(crate) fn contouring_of(&mut self, command: ContouringCommand) -> &mut Contouring {
        match command {
            ContouringCommand::Contour => &mut self.contour,
            ContouringCommand::HighSpeed => &mut self.high_speed,
        }
    }

    /// Returns the rounding of the transition after a block; `once` applies only in the block.
    pub(crate) fn contouring(&self, once: Simplifications) -> Option<Contouring> {
        let holds = self.simplified.union(once);
        if holds.contains(Simplification::HighSpeed) {
            return Some(self.high_speed);
        }
        (holds.contains(Simplification::Contouring)).then_some(self.contour)
    }

    /// Returns the profile of the acceleration; `None` is that of the channel.
    pub(crate) fn slope(&self) -> Option<SlopeProfile> {
        self.slope
    }

    /// Puts a profile of the acceleration into force.
    pub(crate) fn select_slope(&mut self, selection: SlopeSelection) {
        let (slope, holds) = match selection {
            SlopeSelection::Channel => (None, Holds::Off),
            SlopeSelection::Program(profile) => (Some(profile), Holds::Off),
            SlopeSelection::Unknown => (None, Holds::On),
        };
        self.slope = slope;
        self.simplify(Simplification::Slope, holds);
    }

    /// Records a simplification that may have been put into force: its rounding is not known.
    fn perhaps_simplify(&mut self, what: Simplification) {
        self.simplify(what, Holds::On);
        match what {
            Simplification::Contouring => self.contour = self.contour.unknown(),
            Simplification::HighSpeed => self.high_speed = self.high_speed.unknown(),
            Simplification::Slope => self.slope = None,
            _ => {}
        }
    }

    /// Returns whether coordinates count from an origin other than that at the start of the program, or may: axis
    /// positions from then have no meaning any more.
    pub fn has_moved_origin(&self) -> bool {
        self.origin_moved
    }

    /// Enters or leaves a transformation.
    /// The coordinates before and after are those of different systems, except with cutter radius
    /// compensation, which leaves the program's coordinates as they are.
    pub(crate) fn transform(&mut self, name: &str, on: bool) {
        let changed = if on {
            self.transformed.insert(name.to_owned())
        } else {
            self.transformed.remove(name)
        };
        if changed && name != CUTTER_RADIUS {
            self.havoc_positions();
        }
    }

    /// Applies a `#` command to the coordinate chain.
    pub(crate) fn hash(&mut self, command: HashWords) {
        let switch = if command.is_off() {
            OnOff::Off
        } else {
            OnOff::On
        };
        self.switch_mode(command.mode.map(|(mode, on)| match switch {
            OnOff::On => (mode, on),
            OnOff::Off => (mode, OnOff::Off),
        }));
        if let Some(step) = command.chain {
            self.chain((step, command.name(), switch));
        }
    }

    /// Applies a step of a name to the coordinate chain.
    pub(crate) fn chain(&mut self, (step, name, switch): (ChainStep, &str, OnOff)) {
        match step {
            ChainStep::Coordinates | ChainStep::Kinematics => {
                self.transform(name, switch == OnOff::On);
            }
            ChainStep::Machine => self.machine_coordinates(name, switch),
            ChainStep::Path if switch == OnOff::Off => _ = self.transformed.remove(name),
            ChainStep::Path => self.note_transformed(name),
            ChainStep::Origin => {
                self.note_transformed(name);
                self.havoc_positions();
            }
        }
    }

    /// Suspends all offsets at `#MCS ON` until `#MCS OFF`. Positions programmed after either of them are not certainly
    /// machine positions any more.
    fn machine_coordinates(&mut self, name: &str, switch: OnOff) {
        if switch == OnOff::Off {
            if let Some(references) = self.suspended.take() {
                self.references = references;
            }
        } else if self.suspended.is_none() {
            let none = vec![Some(0.0); self.references.len()];
            self.suspended = Some(std::mem::replace(&mut self.references, none));
        }
        self.note_transformed(name);
        self.havoc_positions();
    }

    /// Returns whether the programmed coordinate of an axis is that of the machine: no zero offset, no G92 and no tool
    /// data are in force (R2.112).
    pub(crate) fn is_without_offsets(&self, axis: AxisIndex) -> bool {
        self.functions.offset == 53
            && self.is_known(Group::Offset)
            && self.reference(axis) == Some(0.0)
            && self.functions.tool_data == Some(0)
    }

    /// Returns whether the path between points is a spline, G151 or `#HSC ON [OPMODE 2]`.
    pub(crate) fn is_spline(&self) -> bool {
        let fast = self.simplified.contains(Simplification::HighSpeed);
        self.transformed.contains("#SPLINE") || fast && self.high_speed.is_spline
    }

    /// Switches the mode of a word or command, if it has one.
    pub(crate) fn switch_mode(&mut self, mode: Option<(Mode, OnOff)>) {
        if let Some((mode, switch)) = mode {
            self.modes.switch(mode, switch);
        }
    }

    /// Whether some words that are plain elsewhere may be refused.
    #[inline]
    pub(crate) fn limits_words(&self) -> bool {
        !self.transformed.is_empty() || !self.simplified.is_empty()
    }

    /// Whether a state may be in force in which the control refuses some words. Couplings are not known here.
    pub(crate) fn is_in(&self, state: ChannelState) -> bool {
        let is_fast = self.simplified.contains(Simplification::HighSpeed);
        let holds = |name: &str| self.transformed.contains(name);
        match state {
            ChannelState::CutterRadius => holds(CUTTER_RADIUS),
            ChannelState::LeavingRadius => {
                self.leaving == Leaving::Begun && self.modes.has(Mode::LeavesWithMotion)
            }
            ChannelState::ProgrammedSpline => holds("#SPLINE"),
            ChannelState::FastSpline => is_fast && self.high_speed.is_spline,
            ChannelState::Spline => self.is_spline(),
            ChannelState::BSpline => holds("#SPLINE") && self.modes.has(Mode::BSpline),
            ChannelState::HighSpeed => is_fast,
            ChannelState::Contouring => self.simplified.contains(Simplification::Contouring),
            ChannelState::Frame | ChannelState::Kinematics => {
                let mut names = self.transformed.iter();
                let row = |name: &String| HashCommand::named(name);
                names.any(|name| row(name).is_some_and(|row| row.brings == Some(state)))
            }
            ChannelState::PointToPoint => self.modes.has(Mode::PointToPoint),
            ChannelState::Mirror => holds("G21"),
            ChannelState::Coupling => false,
        }
    }

    /// The axes of the stroke that each motion triggers.
    #[inline]
    pub(crate) fn punched(&self) -> &BTreeSet<AxisIndex> {
        static NONE: BTreeSet<AxisIndex> = BTreeSet::new();
        if self.modes.has(Mode::Punching) {
            &self.stroke
        } else {
            &NONE
        }
    }

    /// The block moved axes, or none: G40 is over with the first motion in the plane, or at once where it inserts one.
    #[cold]
    pub(crate) fn go_on_leaving(&mut self, plane: &[AxisIndex], words: &[AxisWord]) {
        let is_over = !self.modes.has(Mode::LeavesWithMotion)
            || words.iter().any(|word| plane.contains(&word.axis));
        if is_over {
            self.leaving = Leaving::Done;
        } else if !words.is_empty() {
            self.leaving = Leaving::Beside;
        }
    }

    /// Returns whether offsets may be switched off.
    pub(crate) fn are_offsets_suspended(&self) -> bool {
        let mut rows = self
            .transformed
            .iter()
            .filter_map(|name| HashCommand::named(name));
        rows.any(|row| row.chain == Some(ChainStep::Machine))
    }

    /// Returns whether a rotation is in force in which a motion along one axis of the plane moves the other one, too.
    pub(crate) fn is_skewed(&self) -> bool {
        self.skewed && !self.are_offsets_suspended()
    }

    /// Returns the centre of an arc on one axis: G162 counts from the start of the arc, G161 from the origin of the
    /// program (PM/206537483). A word may be left out only with G162.
    pub(crate) fn centre_of(
        &self,
        axis: AxisIndex,
        word: WordValue,
        from: &[Option<f64>],
    ) -> Option<f64> {
        if !self.is_known(Group::CircleCentre) {
            return None;
        }
        let start = if self.functions.centre_absolute {
            self.reference(axis)
        } else {
            from.get(axis.get()).copied().flatten()
        };
        let word = match word {
            None if !self.functions.centre_absolute => Some(0.0),
            word => word.flatten(),
        };
        start.zip(word).map(|(start, word)| start + word)
    }

    /// Records that positions are in program coordinates from here on.
    pub(crate) fn note_transformed(&mut self, name: &str) {
        if !self.transformed.contains(name) {
            self.transformed.insert(name.to_owned());
        }
    }

    /// Merges the state after a step of the coordinate chain that may or may not have been executed.
    fn havoc_chain(&mut self, after: Self) {
        if after != *self {
            if after.references != self.references {
                self.references.fill(None);
                self.suspended = None;
            }
            self.transformed.extend(after.transformed);
            self.havoc_positions();
        }
    }

    /// Ends a contour description: whether its G functions and feeds apply after it is not documented (R2.81).
    pub(crate) fn end_description(&mut self, before: &Self) {
        self.join_functions(before);
        for (feed, before) in self.functions.feeds.iter_mut().zip(before.functions.feeds) {
            *feed = feed.filter(|_| *feed == before);
        }
        self.functions.lacking.join(before.functions.lacking);
        self.pace.join(&before.pace);
        self.radius = self.radius.filter(|_| self.radius == before.radius);
        self.havoc_positions();
    }

    /// Returns the function of a group in force, as its number.
    fn value(&self, group: Group) -> u32 {
        let functions = &self.functions;
        match group {
            Group::Motion => functions.motion,
            Group::Plane => functions.plane,
            Group::Unit => u32::from(functions.inch),
            Group::Distance => u32::from(functions.absolute),
            Group::Feed => functions.feed_mode,
            Group::Offset => functions.offset,
            Group::CutterRadius => functions.tool_side,
            Group::CircleCentre => u32::from(functions.centre_absolute),
            Group::ExactStop => u32::from(functions.block_end == BlockEnd::ExactStop),
        }
    }

    /// Returns whether it is known that two states have different functions of a group in force, or unknown in one of
    /// them only.
    pub(crate) fn differs_in(&self, other: &Self, group: Group) -> bool {
        let (mine, theirs) = (self.is_known(group), other.is_known(group));
        mine != theirs || (mine && self.value(group) != other.value(group))
    }

    /// Selects the tool data of a D word; `None` if its number is not known, or if it may not have been executed.
    pub(crate) fn select_tool_data(&mut self, number: Option<i64>) {
        self.functions.tool_data = number.and_then(|it| u32::try_from(it).ok());
    }

    /// Makes the groups unknown in which two states differ, or may.
    fn join_functions(&mut self, other: &Self) {
        let data = &mut self.functions.tool_data;
        *data = data.filter(|_| *data == other.functions.tool_data);
        for group in Group::ALL {
            let differs = self.value(group) != other.value(group);
            if differs || other.functions.unknown.contains(group) {
                self.functions.unknown.insert(group);
            }
        }
    }

    fn metric(&self) -> Option<f64> {
        let factor = if self.functions.inch { 25.4 } else { 1.0 };
        self.is_known(Group::Unit).then_some(factor)
    }

    /// Millimetres of a programmed unit, where it is also known what coordinates count from.
    fn scale(&self) -> Option<f64> {
        self.metric().filter(|_| self.is_known(Group::Distance))
    }

    /// Moves axes to programmed coordinates. The words keep the previous axis positions.
    pub(crate) fn move_axes(&mut self, words: &mut [AxisWord]) {
        let scale = self.scale();
        for word in words {
            let axis = word.axis.get();
            let from = if self.functions.absolute {
                self.references[axis]
            } else {
                self.positions[axis]
            };
            let to = shifted(from, word.value, scale);
            word.from = std::mem::replace(&mut self.positions[axis], to);
        }
    }

    /// Sets the offsets of G92 for the absolute coordinates that follow; in G91 they add to those in force
    /// (PM/206145291). The axes do not move.
    pub(crate) fn set_references(&mut self, words: &[AxisWord]) {
        let scale = self.scale();
        for word in words {
            let axis = word.axis.get();
            let from = if self.functions.absolute {
                Some(0.0)
            } else {
                self.references[axis]
            };
            self.references[axis] = shifted(from, word.value, scale);
        }
    }

    /// Forgets the axis positions.
    pub fn havoc_positions(&mut self) {
        self.origin_moved = true;
        self.positions.fill(None);
    }

    /// Forgets the position of one axis.
    pub fn havoc_position(&mut self, axis: AxisIndex) {
        self.positions[axis.get()] = None;
    }

    /// Makes all modal words unknown.
    pub(crate) fn havoc_words(&mut self) {
        self.havoc_g(None);
        self.havoc_feeds();
        self.select_tool_data(None);
        self.pace.havoc();
        self.radius = None;
    }

    /// Records a G function that may or may not have been executed; `None` for one that is not known.
    pub(crate) fn havoc_g(&mut self, number: Option<i64>) {
        let Some(number) = number.and_then(|number| u32::try_from(number).ok()) else {
            self.functions.unknown = Group::ALL.into_iter().collect();
            self.havoc_positions();
            self.references.fill(None);
            return;
        };
        let Some(function) = GFunction::of(number) else {
            return;
        };
        match function.group {
            Some(Group::Offset) => self.havoc_positions(),
            Some(Group::CutterRadius) if number != 40 => self.transform(CUTTER_RADIUS, true),
            Some(Group::CutterRadius) if self.transformed.contains(CUTTER_RADIUS) => {
                self.leaving = Leaving::Begun;
            }
            _ => {}
        }
        match function.action {
            GAction::SetCuttingSpeed | GAction::SetSpindleSpeed => self.pace.havoc_spindle(),
            GAction::WeighRapid => self.pace.havoc_overrides(),
            GAction::Rotate => self.skewed = false,
            _ => {}
        }
        if let Some((mode, OnOff::On)) = function.mode {
            self.modes.switch(mode, OnOff::On);
        }
        if let Some(step) = function.chain {
            let mut after = self.clone();
            after.chain(step);
            self.havoc_chain(after);
        }
        if let Some((what, Holds::On)) = function.simplifies {
            self.perhaps_simplify(what);
        }
        if let Some(group) = function.group {
            self.functions.unknown.insert(group);
        }
    }

    /// Makes unknown what differs between two states.
    pub(crate) fn join(&mut self, other: &Self) {
        self.join_functions(other);
        for (mine, theirs) in self.functions.feeds.iter_mut().zip(other.functions.feeds) {
            *mine = mine.filter(|_| *mine == theirs);
        }
        self.functions.lacking.join(other.functions.lacking);
        self.pace.join(&other.pace);
        if (self.simplified, self.contour, self.high_speed)
            != (other.simplified, other.contour, other.high_speed)
        {
            self.contour = self.contour.unknown();
            self.high_speed = self.high_speed.unknown();
        }
        self.simplified = self.simplified.union(other.simplified);
        if self.slope != other.slope {
            self.perhaps_simplify(Simplification::Slope);
        }
        self.skewed &= other.skewed;
        self.modes = self.modes.union(other.modes);
        self.leaving = self.leaving.max(other.leaving);
        self.manual.extend(&other.manual);
        self.stroke.extend(&other.stroke);
        self.origin_moved |= other.origin_moved;
        let unless_same = |mine: &mut Option<f64>, theirs: &Option<f64>| {
            if mine != theirs {
                *mine = None;
            }
        };
        unless_same(&mut self.radius, &other.radius);
        let mut pairs: Vec<(&mut Option<f64>, &Option<f64>)> = Vec::new();
        pairs.extend(self.positions.iter_mut().zip(&other.positions));
        pairs.extend(self.references.iter_mut().zip(&other.references));
        for (mine, theirs) in pairs {
            unless_same(mine, theirs);
        }
        self.transformed.extend(other.transformed.iter().cloned());
        if self.suspended != other.suspended {
            self.suspended = None;
            self.references.fill(None);
        }
    }

    /// Sets the feed of the mode in force, in its unit.
    #[inline]
    pub fn set_feed(&mut self, value: Option<f64>) {
        if !self.is_known(Group::Feed) {
            self.havoc_feeds();
            return;
        }
        let place = self.functions.feed_place();
        let unit_mm = match place {
            PER_MINUTE => self.pace.unit_per_min(self.metric()),
            PER_REVOLUTION => self.metric(),
            _ => Some(1.0),
        };
        if value == Some(0.0) {
            self.functions.lacking.take(place);
        } else {
            self.functions.lacking.give(place);
        }
        self.functions.feeds[place] = value.map(|value| ProgrammedFeed { value, unit_mm });
    }

    /// Makes all feeds unknown.
    fn havoc_feeds(&mut self) {
        self.functions.feeds = [None; 4];
        self.functions.perhaps_give_feeds();
    }

    /// Returns the unit in mm/min that an E word has.
    pub(crate) fn unit_per_min(&self) -> Option<f64> {
        self.pace.unit_per_min(self.metric())
    }

    /// Returns the programmed coordinate, without the offset of G92.
    pub(crate) fn programmed(&self, axis: AxisIndex) -> Option<f64> {
        let position = self.positions[axis.get()].zip(self.references[axis.get()]);
        position.map(|(position, reference)| position - reference)
    }

    /// Returns the positions of the axes: the programmed coordinate with the offset of G92.
    pub(crate) fn positions(&self) -> &[Option<f64>] {
        &self.positions
    }

    /// Returns the offset of G92 of an axis; `None` where it is not known.
    pub(crate) fn reference(&self, axis: AxisIndex) -> Option<f64> {
        self.references[axis.get()]
    }

    /// Takes over the position of an axis.
    pub(crate) fn place(&mut self, axis: AxisIndex, position: Option<f64>) {
        self.positions[axis.get()] = position;
    }

    /// Returns the position of an axis.
    #[inline]
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        AxisPosition {
            value: self.positions[axis.get()],
            frame: self.frame(),
        }
    }

    /// Returns the frame of the programmed positions.
    #[inline]
    pub fn frame(&self) -> PositionFrame {
        if self.transformed.is_empty() {
            return PositionFrame::Machine;
        }
        self.transformed_frame()
    }

    #[inline(never)]
    fn transformed_frame(&self) -> PositionFrame {
        let names = self.transformed.iter();
        let frames = names.map(|name| frame_of(name));
        frames.max().unwrap_or(PositionFrame::Machine)
    }

    /// Returns the side of the programmed contour on which the tool follows it, where that is known; `None` without
    /// tool radius compensation.
    pub(crate) fn tool_side(&self) -> Option<ToolSide> {
        match self.functions.tool_side {
            _ if !self.is_known(Group::CutterRadius) => None,
            41 => Some(ToolSide::Left),
            42 => Some(ToolSide::Right),
            _ => None,
        }
    }
}

/// Returns the frame that a command or function switches to, by its name (R11.30): an M, T or D function that may move
/// the origin leaves paths as they are; one whose number is not known may call any program.
fn frame_of(name: &str) -> PositionFrame {
    if name == CUTTER_RADIUS {
        return PositionFrame::Contour;
    }
    let is_function = name.starts_with(['M', 'T', 'D']) && name[1..].parse::<u64>().is_ok();
    match HashCommand::named(name).and_then(|row| row.chain) {
        Some(ChainStep::Origin | ChainStep::Machine) => PositionFrame::Shifted,
        None if is_function => PositionFrame::Shifted,
        _ => PositionFrame::Programmed,
    }
}

/// Returns whether an M function is known not to move an origin: those of DIN 66025-2 and of the manual's overview
/// (tccncprogramming/15557312651).
pub(crate) fn is_named_m(number: i64) -> bool {
    matches!(number, 0..=17 | 19 | 29..=31 | 40..=49 | 60)
}

/// Places of the feeds of G94 and G95.
const PER_MINUTE: usize = 1;
const PER_REVOLUTION: usize = 2;

/// The G functions in force and the feeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GFunctions {
    /// G00 to G03.
    pub motion: u32,
    /// G17 to G19.
    pub plane: u32,
    /// Whether G90 is in force.
    pub absolute: bool,
    /// Whether G70 is in force.
    pub inch: bool,
    /// G93 to G95, G194.
    pub feed_mode: u32,
    /// The feed of each mode, G93, G94, G95, G194, where one was programmed.
    pub feeds: [Option<ProgrammedFeed>; 4],
    /// G53 to G59, G159.
    pub offset: u32,
    /// Whether the circle centre is absolute, G161.
    pub centre_absolute: bool,
    /// G40 to G42.
    #[serde(default = "without_compensation")]
    pub(crate) tool_side: u32,
    /// The number of the tool data in force, D, where it is known.
    pub tool_data: Option<u32>,
    /// Condition for the end of blocks, G359 and G360.
    pub block_end: BlockEnd,
    /// Groups whose active function is not known offline (R2.51).
    pub(crate) unknown: GroupSet,
    /// Modes of F without a feed.
    #[serde(default)]
    pub(crate) lacking: LackingFeeds,
}

fn without_compensation() -> u32 {
    40
}

impl Default for GFunctions {
    /// Returns the modal words at program start.
    fn default() -> Self {
        Self {
            motion: 0,
            plane: 17,
            absolute: true,
            inch: false,
            feed_mode: 94,
            feeds: [None; 4],
            offset: 53,
            centre_absolute: false,
            tool_side: without_compensation(),
            tool_data: Some(0),
            block_end: BlockEnd::Through,
            unknown: GroupSet::default(),
            lacking: LackingFeeds::all(),
        }
    }
}

impl GFunctions {
    /// Returns the place of the feed of the mode in force.
    #[inline]
    fn feed_place(&self) -> usize {
        match self.feed_mode {
            93 => 0,
            95 => PER_REVOLUTION,
            194 => 3,
            _ => PER_MINUTE,
        }
    }

    /// Returns whether G01, G02 or G03 is in force and may have no feed, or the feed 0 (R2.110).
    #[inline]
    pub(crate) fn may_lack_feed(&self) -> bool {
        self.is_feed_move() && self.has_no_feed()
    }

    /// Returns whether the mode in force may have no feed, or the feed 0.
    #[inline]
    pub(crate) fn has_no_feed(&self) -> bool {
        self.lacking.contains(self.feed_place())
    }

    /// Returns whether G01, G02 or G03 is in force.
    #[inline]
    pub(crate) fn is_feed_move(&self) -> bool {
        GFunction::is_feed_move(self.motion) && !self.unknown.contains(Group::Motion)
    }

    /// Returns whether G02 or G03 was programmed last.
    #[inline]
    pub(crate) fn is_arc(&self) -> bool {
        GFunction::is_arc(self.motion)
    }

    /// Returns whether the program has certainly given no feed so far, and G94 is in force.
    pub(crate) fn is_first_without_feed(&self) -> bool {
        self.feed_mode == 94 && !self.unknown.contains(Group::Feed) && self.lacking.is_certain()
    }

    /// Returns the feed of the mode in force, as the program gives it.
    pub(crate) fn programmed_feed(&self) -> Option<f64> {
        self.feeds[self.feed_place()].map(|feed| feed.value)
    }

    /// Records that the mode in force has a feed that the program does not give.
    pub(crate) fn give_feed(&mut self) {
        self.lacking.give(self.feed_place());
    }

    /// Records that any mode may have a feed that the program does not give.
    pub(crate) fn perhaps_give_feeds(&mut self) {
        self.lacking = LackingFeeds::default();
    }
}

/// Name of the tool radius compensation, G41 or G42, among what transforms.
pub(crate) const CUTTER_RADIUS: &str = "G41";

/// G functions that separate positions from those of the machine.
const TRANSFORMING: [&str; 2] = [CUTTER_RADIUS, "G21"];

/// G functions and feeds before a cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Saved {
    functions: GFunctions,
    transformed: [bool; 2],
    #[serde(default)]
    modes: Modes,
}

impl Saved {
    /// Makes unknown what differs between two saved states.
    pub(crate) fn join(&mut self, other: &Self) {
        if self == other {
            return;
        }
        for group in Group::ALL {
            self.functions.unknown.insert(group);
        }
        for (mine, theirs) in self.functions.feeds.iter_mut().zip(other.functions.feeds) {
            *mine = mine.filter(|_| *mine == theirs);
        }
        self.functions.lacking.join(other.functions.lacking);
        for (mine, theirs) in self.transformed.iter_mut().zip(other.transformed) {
            *mine |= theirs;
        }
        self.modes = self.modes.union(other.modes);
    }
}

impl Modal {
    /// Saves the state that a cycle may change and its end restores.
    pub(crate) fn save(&self) -> Saved {
        Saved {
            functions: self.functions.clone(),
            transformed: TRANSFORMING.map(|name| self.transformed.contains(name)),
            modes: self.modes,
        }
    }

    /// Restores the saved words at the end of a cycle.
    pub(crate) fn restore(&mut self, saved: &Saved) {
        if self.functions.offset != saved.functions.offset {
            self.havoc_positions();
        }
        self.functions = saved.functions.clone();
        self.modes.restore(saved.modes);
        for (name, on) in TRANSFORMING.into_iter().zip(saved.transformed) {
            self.transform(name, on);
        }
    }
}
