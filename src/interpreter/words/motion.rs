//! The motion of a block from its words (R5.1): its path and velocity, and the axes that move without a word of their own
//! (R10.7): those with a command in their bracket, followers of another axis, axes of a rotated or transformed frame.

use std::collections::BTreeMap;

use crate::comp::AxisIndex;
use crate::interpreter::block::{BlockContext, BlockScratch};
use crate::interpreter::control::ControlState;
use crate::interpreter::executor::Executor;
use crate::interpreter::motion::form::{
    Arc, AxisWord, BlockEnd, Centre, Geometry, Motion, MovedAxis, PathFeed, PathForm, Travel, Turn,
    WordValue,
};
use crate::interpreter::motion::pace::{Factors, Haste, ProgrammedFeed, SlopeSelection};
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::words::exchange::gear_of;
use crate::language::{
    AxisAction, AxisCommand, AxisWords, Certainty, Group, HashAction, HashCommand, Holds,
    MotionKind, Moves, Simplification,
};
use crate::lists::AxisType;
use crate::syntax::ast::{Argument, BracketArguments, Hash, SpindleWord};
use crate::text::Span;

impl Executor {
    /// A command in the bracket of an axis.
    pub(crate) fn move_by_bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let Some(axis) = self.axis_named(bracket.name) else {
            return;
        };
        let span = bracket.span;
        if bracket.command.action == AxisAction::EndFollowing {
            self.state.control.couplings.unfollow(&gear_of(axis));
        }
        let Some(row) = bracket.command.motion else {
            return;
        };
        self.see(axis);
        self.state.control.modal.havoc_position(axis);
        if row.moves == Moves::Follower {
            self.gear_in(axis, bracket.arguments, at);
            return;
        }
        self.scratch.moves.also_moved.push(MovedAxis {
            axis,
            span,
            kind: row.kind,
            certainty: row.certainty,
        });
    }

    /// A `#` command that moves axes at once.
    pub(crate) fn command_motion(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let row = hash.command.motion;
        let Some(row) = row.filter(|row| row.moves == Moves::NamedOrAll) else {
            return;
        };
        let named = self.axes_in(&hash.brackets, at.text);
        let axes = if named.is_empty() {
            self.path_axes()
        } else {
            named
        };
        for axis in axes {
            self.scratch.moves.also_moved.push(MovedAxis {
                axis,
                span: hash.span,
                kind: row.kind,
                certainty: row.certainty,
            });
        }
    }

    /// `#ROTATION ON [ANGLE=30]`: whether a motion along one axis of the plane certainly moves the other
    /// one, too.
    pub(crate) fn rotate(&mut self, arguments: &BracketArguments, at: &BlockContext<'_>) {
        let angle = arguments.after("ANGLE", at.text);
        let angle = angle.and_then(|angle| self.argument_number(angle, at));
        self.state.control.modal.skewed = angle.is_some_and(|angle| angle % 90.0 != 0.0);
    }

    /// Notes the axes that move along with those that the block moves.
    #[inline]
    pub(crate) fn carry_along(&mut self, words: AxisWords) {
        let carries = self.state.control.couplings.carry()
            || !self.state.control.modal.transformed.is_empty()
            || self.scratch.moves.word_row.is_some();
        if carries && self.state.control.described.is_none() {
            self.carry(words);
        }
    }

    #[inline(never)]
    fn carry(&mut self, words: AxisWords) {
        let row = self.scratch.moves.word_row;
        if let Some(row) = row.filter(|row| row.certainty == Certainty::Possible) {
            self.leave_to_operator(row.kind, row.moves);
        }
        if matches!(words, AxisWords::Motion | AxisWords::Measuring) {
            self.move_in_frame();
        }
        self.move_followers(words);
    }

    /// In manual mode the operator moves axes.
    fn leave_to_operator(&mut self, kind: MotionKind, moves: Moves) {
        let words: Vec<_> = self
            .scratch
            .moves
            .moved
            .iter()
            .map(|it| (it.axis, it.span))
            .collect();
        let axes = if words.is_empty() && moves == Moves::WordsOrAll {
            let all = self.path_axes().into_iter();
            all.map(|axis| (axis, Span::default())).collect()
        } else {
            words
        };
        for (axis, span) in axes {
            self.scratch.moves.also_moved.push(MovedAxis {
                axis,
                span,
                kind,
                certainty: Certainty::Possible,
            });
        }
    }

    /// Every axis that words can move.
    fn path_axes(&self) -> Vec<AxisIndex> {
        let axes = self.machine.axes.iter().enumerate();
        let axes = axes.filter(|(_, axis)| !axis.is_spindle());
        axes.map(|(position, _)| AxisIndex::new(position)).collect()
    }

    /// Those of X, Y and Z that the machine has.
    fn main_axes(&self) -> Vec<AxisIndex> {
        let letters = [b'X', b'Y', b'Z'].map(|it| self.letter_axis(it));
        letters.into_iter().flatten().collect()
    }

    /// The axes of the active plane; all main axes where it is not known.
    pub(crate) fn plane_axes(&self) -> Vec<AxisIndex> {
        match [self.main_axis(b'X'), self.main_axis(b'Y')] {
            [Some(first), Some(second)] => vec![first, second],
            _ => self.main_axes(),
        }
    }

    /// The axes of a frame, and whether each certainly moves with another of them.
    fn frame(&self, name: &str) -> Option<(Vec<AxisIndex>, Certainty)> {
        let row = HashCommand::named(name)?.motion?;
        Some(match row.moves {
            Moves::Plane => {
                let axes = self.plane_axes();
                let is_known = [b'X', b'Y'].iter().all(|it| self.main_axis(*it).is_some());
                let is_sure = is_known && self.state.control.is_skewed();
                let certainty = if is_sure {
                    row.certainty
                } else {
                    Certainty::Possible
                };
                (axes, certainty)
            }
            Moves::Main => (self.main_axes(), row.certainty),
            Moves::Channel => (self.path_axes(), row.certainty),
            _ => return None,
        })
    }

    /// A motion word in a rotated or transformed frame moves its other axes, too.
    fn move_in_frame(&mut self) {
        let of_words = self.scratch.moves.moved.iter().map(|it| (it.axis, it.span));
        let moves = |it: &&MovedAxis| it.kind == MotionKind::Unknown;
        let unknown = self.scratch.moves.also_moved.iter().filter(moves);
        let in_motion: Vec<_> = of_words
            .clone()
            .chain(unknown.map(|it| (it.axis, it.span)))
            .collect();
        let words: Vec<AxisIndex> = of_words.map(|(axis, _)| axis).collect();
        let mut found: BTreeMap<AxisIndex, (Certainty, Span)> = BTreeMap::new();
        for name in &self.state.control.modal.transformed {
            let Some((axes, certainty)) = self.frame(name) else {
                continue;
            };
            let Some(&(first, span)) = in_motion.iter().find(|(axis, _)| axes.contains(axis))
            else {
                continue;
            };
            let certainty = if words.contains(&first) {
                certainty
            } else {
                Certainty::Possible
            };
            for axis in axes.into_iter().filter(|axis| !words.contains(axis)) {
                let known = found.entry(axis).or_insert((certainty, span));
                known.0 = known.0.min(certainty);
            }
        }
        let found = found
            .into_iter()
            .map(|(axis, (certainty, span))| MovedAxis {
                axis,
                span,
                kind: MotionKind::Frame,
                certainty,
            });
        self.scratch.moves.also_moved.extend(found);
    }

    /// Axes that follow what the block moves.
    fn move_followers(&mut self, words: AxisWords) {
        if !self.state.control.couplings.carry() {
            return;
        }
        let moves = !matches!(words, AxisWords::Reference | AxisWords::Other);
        let kind = match words {
            AxisWords::Homing => MotionKind::Homing,
            _ => MotionKind::Coupled,
        };
        let of_words = self.scratch.moves.moved.iter().filter(|_| moves);
        let of_words = of_words.map(|word| MovedAxis::of_word(word, kind));
        let in_motion = of_words.chain(self.scratch.moves.also_moved.iter().copied());
        let mut moving: BTreeMap<AxisIndex, MovedAxis> = BTreeMap::new();
        for moved in in_motion {
            let known = moving.entry(moved.axis).or_insert(moved);
            known.certainty = known.certainty.min(moved.certainty);
        }
        if moving.is_empty() {
            return;
        }
        let own = moving.clone();
        let links = self.state.control.couplings.links();
        // R2.60: groups may be many.
        self.state.work.charge(ITEM * links.len());
        // Each round settles an axis more, or is the last.
        for _ in 0..=self.machine.axes.len() {
            let mut grew = false;
            for &(follower, leader, certainty) in &links {
                let leaders = match leader {
                    Some(leader) => moving.get(&leader),
                    None => moving.values().min_by_key(|it| it.certainty),
                };
                let Some(leading) = leaders.copied() else {
                    continue;
                };
                let certainty = certainty.max(leading.certainty);
                let known = moving.get(&follower);
                if known.is_some_and(|known| known.certainty <= certainty) {
                    continue;
                }
                let kind = match leading.kind {
                    MotionKind::Homing => MotionKind::Homing,
                    _ => MotionKind::Coupled,
                };
                let span = leading.span;
                let motion = MovedAxis {
                    axis: follower,
                    span,
                    kind,
                    certainty,
                };
                moving.insert(follower, motion);
                grew = true;
            }
            if !grew {
                break;
            }
        }
        let is_new = |motion: &MovedAxis| {
            let known = own.get(&motion.axis);
            known.is_none_or(|known| known.certainty > motion.certainty)
        };
        let new: Vec<_> = moving.into_values().filter(is_new).collect();
        self.scratch.moves.also_moved.extend(new);
    }
}

impl ControlState {
    fn is_skewed(&self) -> bool {
        let modal = &self.modal;
        modal.skewed && !modal.are_offsets_suspended()
    }
}

impl Executor {
    /// I, J, K or R of a circle.
    pub(crate) fn circle_word(&mut self, letter: u8, value: Option<f64>, span: Span) {
        let metric = self.state.control.modal.is_known(Group::Unit);
        let inch = self.state.control.modal.functions.inch;
        let value = value.filter(|_| metric);
        let value = value.map(|value| if inch { value * 25.4 } else { value });
        let geometry = self.scratch.geometry();
        geometry.span.get_or_insert(span);
        match letter {
            b'R' => geometry.radius = Some(value),
            _ => geometry.centre[usize::from(letter.saturating_sub(b'I')).min(2)] = Some(value),
        }
    }

    /// A circle moves both axes of its plane, even without a word for them: `G2 I5` is a full circle
    /// (R2.46). Axes without a word end where they start.
    #[inline]
    pub(crate) fn move_around(&mut self, words: AxisWords) {
        let turns = self.state.control.modal.functions.is_arc();
        if (turns || self.scratch.moves.geometry.is_some()) && words == AxisWords::Motion {
            self.move_around_in_plane(turns);
        }
    }

    fn move_around_in_plane(&mut self, turns: bool) {
        let letters = [b'X', b'Y'].map(|letter| self.main_axis(letter));
        let plane = letters.into_iter().flatten();
        let geometry = self.scratch.moves.geometry.as_ref();
        let centred = geometry.is_some_and(|it| it.centre.iter().any(Option::is_some));
        let is_circle = turns || !self.state.control.modal.is_known(Group::Motion);
        let own = self.scratch.moves.moved.len();
        let word = self.scratch.moves.moved.iter();
        let word = word.filter(|word| letters.contains(&Some(word.axis)));
        let word = word.map(|word| word.span).next();
        let along = geometry.and_then(|it| it.span);
        let Some(span) = along.filter(|_| centred).or(word) else {
            return;
        };
        if !is_circle || (!turns && !centred) || self.scratch.moves.dwells {
            return;
        }
        for axis in plane {
            if self.scratch.moves.moved[..own]
                .iter()
                .all(|word| word.axis != axis)
            {
                self.see(axis);
                self.scratch.moves.seen |= 1 << (axis.get() % 64);
                self.scratch.moves.moved.push(AxisWord {
                    axis,
                    span,
                    value: None,
                    from: None,
                });
            }
        }
        let around = self.scratch.moves.moved.len() - own;
        if around > 0 {
            self.scratch.geometry().around = around;
        }
    }

    /// `G04 P1`: the parameter holds the seconds (PM/206132747).
    pub(crate) fn dwell_parameter(&mut self, index: Option<f64>) {
        let index = index
            .and_then(rounded)
            .and_then(|index| u32::try_from(index).ok());
        let value = index.and_then(|index| self.state.control.memory.parameter(index));
        let seconds = value.and_then(|value| value.number());
        self.scratch.geometry().dwell = Some(seconds);
    }

    /// Creates the motion of the block, which started at `from`.
    #[inline(never)]
    pub(crate) fn take_motion(&mut self, from: Option<Vec<Option<f64>>>, words: AxisWords) {
        let geometry = self.scratch.moves.geometry.take();
        if let Some(Some(radius)) = geometry.as_ref().map(|geometry| geometry.radius) {
            // The radius is modal (PM, radius programming).
            self.state.control.modal.radius = radius;
        }
        let Some(from) = from else { return };
        let geometry = geometry.unwrap_or_default();
        let motion = self.motion(&geometry, from, words);
        let is_taken = self.options.takes_motions();
        match motion {
            Some(Motion::Travel(travel)) if matches!(travel.form, PathForm::Arc(_)) => {
                self.scratch.moves.motion = is_taken.then(|| Motion::Travel(travel.clone()));
                self.scratch.aside.arc = Some(travel);
            }
            motion => self.scratch.moves.motion = motion.filter(|_| is_taken),
        }
    }

    fn motion(
        &self,
        geometry: &Geometry,
        from: Vec<Option<f64>>,
        words: AxisWords,
    ) -> Option<Motion> {
        if self.scratch.moves.dwells {
            let by_axis = self.scratch.moves.moved.first().map(|word| word.value);
            return Some(Motion::Dwell(geometry.dwell.or(by_axis).flatten()));
        }
        let circular = self.state.control.modal.functions.is_arc();
        let centred = geometry.centre.iter().any(Option::is_some);
        let moves = !self.scratch.moves.moved.is_empty() || (circular && centred);
        let form = match words {
            _ if !moves => return None,
            AxisWords::Motion | AxisWords::Measuring => self.form(geometry, &from),
            AxisWords::Homing => {
                PathForm::Unknown("homing ends at a reference point of the machine")
            }
            AxisWords::Reference | AxisWords::Other => return None,
        };
        let modal = &self.state.control.modal;
        Some(Motion::Travel(Travel {
            form,
            axes: self
                .scratch
                .moves
                .moved
                .iter()
                .map(|word| word.axis)
                .collect(),
            from,
            to: modal.positions().to_vec(),
            feed: self.path_feed(geometry),
            end: match geometry.end {
                BlockEnd::Through => modal.functions.block_end,
                BlockEnd::ExactStop => BlockEnd::ExactStop,
            },
            contouring: modal.contouring(geometry.simplified),
            slope: modal.slope(),
            end_feed_per_min: self.end_feed(geometry),
            tool: modal.tool_side(),
            simplified: modal.simplified.union(geometry.simplified),
        }))
    }

    fn form(&self, geometry: &Geometry, from: &[Option<f64>]) -> PathForm {
        let modal = &self.state.control.modal;
        if let Some(reason) = geometry.foreign {
            return PathForm::Unknown(reason);
        }
        if !modal.is_known(Group::Motion) {
            return PathForm::Unknown("it is not known whether G00, G01, G02 or G03 is active");
        }
        match modal.functions.motion {
            0 => PathForm::Rapid,
            1 => PathForm::Line,
            motion => self.arc(motion, geometry, from),
        }
    }

    fn arc(&self, motion: u32, geometry: &Geometry, from: &[Option<f64>]) -> PathForm {
        let modal = &self.state.control.modal;
        let letters = [b'X', b'Y'].map(|letter| modal.main_axis(letter));
        let [Some(first), Some(second)] = letters else {
            return PathForm::Unknown("the active plane is not known");
        };
        let axes = [first, second].map(|letter| self.letter_axis(letter));
        let [Some(one), Some(two)] = axes else {
            return PathForm::Unknown("the machine lacks an axis of the plane");
        };
        let centre = if geometry.centre.iter().any(Option::is_some) {
            let offset = |letter: u8| geometry.centre[usize::from(letter - b'X')];
            let at =
                |axis: AxisIndex, letter| self.state.control.centre_of(axis, offset(letter), from);
            match (at(one, first), at(two, second)) {
                (Some(a), Some(b)) => Centre::Point([a, b]),
                _ => return PathForm::Unknown("the centre of the circle is not known"),
            }
        } else {
            match modal.radius {
                Some(radius) => Centre::Radius(radius),
                None => {
                    return PathForm::Unknown("the circle has neither a centre nor a known radius");
                }
            }
        };
        PathForm::Arc(Arc {
            axes: [one, two],
            turn: if motion == 2 {
                Turn::Clockwise
            } else {
                Turn::CounterClockwise
            },
            centre,
        })
    }

    /// Computes the velocity of the block from F, overrides and the spindle.
    fn path_feed(&self, geometry: &Geometry) -> PathFeed {
        let modal = &self.state.control.modal;
        let haste = match modal.functions.motion {
            0 if modal.is_known(Group::Motion) => Haste::Rapid,
            _ => Haste::Feed,
        };
        let Some(share) = self.override_share(geometry, haste) else {
            return PathFeed::Unknown("the override is not known");
        };
        if haste == Haste::Rapid {
            return PathFeed::OfAxes(share);
        }
        if !modal.is_known(Group::Feed) {
            return PathFeed::Unknown("it is not known whether G93, G94 or G95 is active");
        }
        if matches!(geometry.end_feed, Some(None)) {
            return PathFeed::Unknown("E is not known");
        }
        let mode = modal.functions.feed_mode;
        match (mode, modal.functions.feeds) {
            (93, [Some(feed), ..]) => PathFeed::Seconds(feed.value / share),
            (94, [_, Some(feed), ..]) => match self.per_minute(feed) {
                Some(feed) => PathFeed::PerMinute(feed * share),
                None => PathFeed::Unknown("the unit of F is not known"),
            },
            (95, [_, _, Some(feed), _]) => match (modal.pace.per_minute(), self.per_minute(feed)) {
                (Ok(turns), Some(feed)) => PathFeed::PerMinute(feed * turns * share),
                (Err(reason), _) => PathFeed::Unknown(reason),
                (_, None) => PathFeed::Unknown("the unit of F is not known"),
            },
            // The manual admits only weights below 100 % (PM/206602507).
            (194, [.., Some(feed)]) => match feed.value / 100.0 {
                weight if weight < 1.0 => PathFeed::OfAxes(weight * share),
                _ => PathFeed::Unknown("with G194, F is a weight below 100 %"),
            },
            _ => PathFeed::Unknown("F is not known"),
        }
    }

    /// Returns the share of the velocity that overrides leave; G166 suppresses programmed ones
    /// (PM/206744331).
    fn override_share(&self, geometry: &Geometry, haste: Haste) -> Option<f64> {
        let pace = &self.state.control.modal.pace;
        if geometry.at_full_speed {
            return pace.weight(haste);
        }
        pace.share(haste, self.scratch.moves.moved.iter().map(|word| word.axis))
    }

    /// A feed in mm, or in degrees where only rotary axes move.
    fn per_minute(&self, feed: ProgrammedFeed) -> Option<f64> {
        let is_rotary =
            |word: &AxisWord| self.machine.axis(word.axis).axis_type == AxisType::Rotary;
        let moved = &self.scratch.moves.moved;
        if !moved.is_empty() && moved.iter().all(is_rotary) {
            return Some(feed.value);
        }
        feed.unit_mm.map(|unit| feed.value * unit)
    }

    /// E, which counts with G94 only (PM/206811147).
    fn end_feed(&self, geometry: &Geometry) -> Option<f64> {
        let modal = &self.state.control.modal;
        let is_per_minute = modal.functions.feed_mode == 94 && modal.functions.motion != 0;
        let value = geometry.end_feed.flatten().filter(|_| is_per_minute)?;
        let unit_mm = modal.unit_per_min();
        let feed = self.per_minute(ProgrammedFeed { value, unit_mm })?;
        Some(feed * self.override_share(geometry, Haste::Feed)?)
    }
}

impl BlockScratch {
    /// The words of the block that give axis targets.
    #[inline]
    pub(crate) fn coordinates(&self) -> usize {
        let around = self.moves.geometry.as_ref().map_or(0, |it| it.around);
        self.moves.moved.len() - around
    }

    /// The geometry words of the block.
    pub(crate) fn geometry(&mut self) -> &mut Geometry {
        self.moves.geometry.get_or_insert_default()
    }
}

impl ControlState {
    /// The centre on one axis: G162 counts from the start of the arc, G161 from the origin of the
    /// program (PM/206537483). A word may be left out only with G162.
    fn centre_of(&self, axis: AxisIndex, word: WordValue, from: &[Option<f64>]) -> Option<f64> {
        let modal = &self.modal;
        if !modal.is_known(Group::CircleCentre) {
            return None;
        }
        let start = if modal.functions.centre_absolute {
            modal.reference(axis)
        } else {
            from.get(axis.get()).copied().flatten()
        };
        let word = match word {
            None if !modal.functions.centre_absolute => Some(0.0),
            word => word.flatten(),
        };
        start.zip(word).map(|(start, word)| start + word)
    }

    /// The position of every axis, for a block that may move.
    pub(crate) fn stand(&self) -> Vec<Option<f64>> {
        self.modal.positions().to_vec()
    }
}

/// An override in percent, where it is in the documented range (PM/207625099).
const OVERRIDE: std::ops::RangeInclusive<f64> = 0.1..=200.0;

/// The keywords of an override.
const FEED: &str = "FEED_FACT";
const RAPID: &str = "RAPID_FACT";

/// A command in the bracket of an axis or spindle.
#[derive(Clone, Copy)]
pub(crate) struct AxisBracket<'a> {
    /// The name before the bracket.
    pub(crate) name: &'a str,
    pub(crate) command: AxisCommand,
    pub(crate) arguments: &'a BracketArguments,
    pub(crate) spindle: &'a [SpindleWord],
    /// The whole of it.
    pub(crate) span: Span,
}

impl Executor {
    /// Notes a command that a commanded trace does not follow in full.
    pub(crate) fn simplify(&mut self, what: Simplification, holds: Holds) {
        if holds == Holds::Once {
            let geometry = self.scratch.geometry();
            geometry.simplified = geometry.simplified.union(what.into());
        } else {
            self.state.control.modal.simplify(what, holds);
        }
    }

    /// `G163=50`: the radius of circles, as R (R2.45). Returns whether there is a value.
    pub(crate) fn radius_word(&mut self, span: Span, at: &BlockContext<'_>) -> bool {
        let Some(value) = at.block.second_value(span) else {
            return false;
        };
        let radius = self.operand_number(value, at);
        self.circle_word(b'R', radius, span);
        true
    }

    /// `G129=70` (PM/206578955)
    pub(crate) fn weigh_rapid(&mut self, span: Span, at: &BlockContext<'_>) {
        let value = at.block.second_value(span);
        let percent = value.and_then(|value| self.operand_number(value, at));
        let weight = percent.filter(|it| *it > 0.0).map(|it| it / 100.0);
        self.state.control.modal.pace.weigh_rapid(weight);
    }

    /// Applies a `#` command that changes the velocity of paths.
    pub(crate) fn pace_command(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let (command, arguments) = (hash.command, &hash.brackets);
        match command.action {
            HashAction::Override => {
                let change = self.factors_in(arguments, at);
                self.state.control.modal.pace.override_path(change);
            }
            HashAction::SelectSpindle => self.state.control.modal.pace.havoc_spindle(),
            HashAction::Round(command) => {
                let before = *self.state.control.modal.contouring_of(command);
                let number = |argument: &Argument| self.argument_number(argument, at);
                let next = command.parameters(before, (arguments, at.text), number);
                *self.state.control.modal.contouring_of(command) = next;
            }
            HashAction::SelectSlope(form) => {
                let number = |argument: &Argument| self.argument_number(argument, at);
                let selected = SlopeSelection::of(form, (arguments, at.text), number);
                if let Some(selected) = selected {
                    self.state.control.modal.select_slope(selected);
                    return;
                }
            }
            _ => {}
        }
        if let Some((what, holds)) = command.simplification() {
            self.simplify(what, holds);
        }
    }

    /// A command in the bracket of an axis or spindle, `X[OVERRIDE FEED_FACT=20]`, `S[REV1200 M3]`.
    pub(crate) fn bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let AxisBracket { name, command, .. } = bracket;
        let axis = self.axis_named(name);
        if name.starts_with('S') && axis.is_none() {
            if self.is_main_spindle(name) {
                self.spindle_words(bracket.spindle, at);
            } else if self.machine.channel.main_spindle.is_empty() {
                // It may be the main spindle under its own name.
                self.state.control.modal.pace.havoc_spindle();
            }
            return;
        }
        let Some(axis) = axis else {
            return;
        };
        if command.action == AxisAction::Override {
            let change = self.factors_in(bracket.arguments, at);
            self.state.control.modal.pace.override_axis(axis, change);
        }
        if let Some(what) = command.simplifies {
            self.simplify(what, Holds::On);
        }
    }

    /// The words in the bracket of the main spindle.
    fn spindle_words(&mut self, words: &[SpindleWord], at: &BlockContext<'_>) {
        for word in words {
            match *word {
                SpindleWord::Speed(speed) => {
                    let speed = speed.and_then(|speed| self.operand_number(speed, at));
                    self.state.control.modal.pace.speed(speed);
                }
                SpindleWord::M(number) => self.state.control.modal.pace.m(number),
            }
        }
    }

    /// Returns the factors in the bracket of an override.
    fn factors_in(
        &mut self,
        arguments: &BracketArguments,
        at: &BlockContext<'_>,
    ) -> impl FnOnce(&mut Factors) + use<> {
        let [feed, rapid] = [FEED, RAPID].map(|key| {
            let percent = self.argument_number(arguments.after(key, at.text)?, at);
            let known = percent.filter(|it| OVERRIDE.contains(it));
            Some(known.map(|it| it / 100.0))
        });
        let is_understood = feed.is_some() || rapid.is_some();
        move |factors| {
            factors.feed = feed.unwrap_or(factors.feed.filter(|_| is_understood));
            factors.rapid = rapid.unwrap_or(factors.rapid.filter(|_| is_understood));
        }
    }
}
