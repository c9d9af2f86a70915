//! Motion of a block: its axis words and the words of its geometry, the axes that move without a word of their own
//! (R10.7), and the path and velocity that follow from them (R5.1).

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use crate::comp::AxisIndex;
use crate::interpreter::axes::AxisLookup;
use crate::interpreter::coupling::CouplingLink;
use crate::interpreter::motion::form::{
    Arc, AxisWord, BlockEnd, Centre, Geometry, Motion, MovedAxis, PathFeed, PathForm, Travel, Turn,
    WordValue,
};
use crate::interpreter::motion::modal::{CUTTER_RADIUS, Leaving, Modal};
use crate::interpreter::motion::pace::{Haste, ProgrammedFeed};
use crate::language::{AxisWords, Certainty, Group, HashCommand, MotionEffect, MotionKind, Moves};
use crate::lists::AxisType;
use crate::text::Span;

/// The words of a block that move axes, and what follows from them.
#[derive(Debug, Default, Clone)]
pub(crate) struct BlockMotion {
    words: Vec<AxisWord>,
    /// The axes that it moves, or may, without their own word.
    also: Vec<MovedAxis>,
    /// Words of axes that the machine does not have.
    lacking: Vec<(String, Span)>,
    /// The axes that have a word, and those that may have another, a bit each.
    named: u64,
    again: u64,
    /// Motion of its axis words, where the G functions in force do not decide it.
    row: Option<MotionEffect>,
    /// I, J, K, R and the like, where the block has any.
    geometry: Option<Geometry>,
    /// Whether the axes come to rest in the block, or may.
    rests: Cell<bool>,
    /// Whether the block is G04 or `#TIME`.
    dwells: bool,
    /// Motion of the block, where motions are taken.
    motion: Option<Motion>,
    /// The words of the block before, and its arc, unless the axes came to rest after it.
    last_words: Vec<AxisWord>,
    arc: Option<Travel>,
    last_arc: Option<Travel>,
}

/// State on which the motion of a block depends, apart from its words.
#[derive(Clone, Copy)]
pub(crate) struct MotionSetting<'a> {
    pub(crate) axes: AxisLookup<'a>,
    pub(crate) modal: &'a Modal,
}

impl BlockMotion {
    #[inline]
    pub(crate) fn clear(&mut self) {
        self.also.clear();
        self.row = None;
        if !self.words.is_empty() {
            std::mem::swap(&mut self.words, &mut self.last_words);
            self.words.clear();
            if self.arc.is_some() || self.last_arc.is_some() {
                std::mem::swap(&mut self.arc, &mut self.last_arc);
            }
        }
        if self.rests.replace(false) || self.dwells {
            self.last_words.clear();
            self.last_arc = None;
        }
        self.arc = None;
        self.lacking.clear();
        self.named = 0;
        self.again = 0;
        self.geometry = None;
        self.dwells = false;
        self.motion = None;
    }

    #[inline]
    pub(crate) fn take_word(&mut self, axis: AxisIndex, span: Span, value: Option<f64>) {
        let bit = bit_of(axis);
        self.again |= self.named & bit;
        self.named |= bit;
        self.words.push(AxisWord {
            axis,
            span,
            value,
            from: None,
        });
    }

    /// Records a word of an axis that the machine does not have.
    pub(crate) fn lack(&mut self, name: String, span: Span) {
        self.lacking.push((name, span));
    }

    /// Records an axis that moves, or may, without a word of its own.
    pub(crate) fn also_move(&mut self, moved: MovedAxis) {
        self.also.push(moved);
    }

    /// Records that an axis possibly moves.
    pub(crate) fn perhaps_move(&mut self, axis: AxisIndex) {
        self.also.push(MovedAxis {
            axis,
            span: Span::default(),
            kind: MotionKind::Unknown,
            certainty: Certainty::Possible,
        });
    }

    /// Records that each of these axes possibly moves.
    pub(crate) fn perhaps_move_all(&mut self, axes: impl ExactSizeIterator<Item = AxisIndex>) {
        let possible = |it: &&MovedAxis| it.certainty == Certainty::Possible;
        if self.also.iter().filter(possible).count() < axes.len() {
            axes.for_each(|axis| self.perhaps_move(axis));
        }
    }

    /// Sets the motion of the axis words, which differs from that of the G functions in force.
    pub(crate) fn move_as(&mut self, row: MotionEffect) {
        self.row = Some(row);
        self.rests.set(true);
    }

    /// Records that the axes come to rest, or may.
    pub(crate) fn rest(&self) {
        self.rests.set(true);
    }

    /// Marks the block as G04 or `#TIME`.
    pub(crate) fn dwell(&mut self) {
        self.dwells = true;
    }

    pub(crate) fn dwells(&self) -> bool {
        self.dwells
    }

    /// Returns where expressions say that the axes may come to rest.
    pub(crate) fn rest_flag(&self) -> &Cell<bool> {
        &self.rests
    }

    /// Returns whether the axes come to rest in the block, or may.
    pub(crate) fn rests(&self) -> bool {
        self.rests.get() || self.dwells
    }

    /// Returns the geometry words of the block.
    pub(crate) fn geometry(&mut self) -> &mut Geometry {
        self.geometry.get_or_insert_default()
    }

    /// Those that it has so far.
    pub(crate) fn geometry_words(&self) -> Option<&Geometry> {
        self.geometry.as_ref()
    }

    pub(crate) fn has_geometry(&self) -> bool {
        self.geometry.is_some()
    }

    /// Returns the axis words, those of axes that move along a circle last.
    pub(crate) fn words(&self) -> &[AxisWord] {
        &self.words
    }

    /// Returns the axis words that give targets.
    #[inline]
    pub(crate) fn coordinates(&mut self) -> &mut [AxisWord] {
        let around = self.geometry.as_ref().map_or(0, |it| it.around);
        let count = self.words.len() - around;
        &mut self.words[..count]
    }

    /// Returns the axes that the block moves, or may, without their own word.
    pub(crate) fn also_moved(&self) -> &[MovedAxis] {
        &self.also
    }

    /// Returns the axes that have a word, a bit each by their positions modulo 64.
    pub(crate) fn named(&self) -> u64 {
        self.named
    }

    /// Returns the motion of the axis words, where the G functions in force do not decide it.
    pub(crate) fn row(&self) -> Option<MotionEffect> {
        self.row
    }

    pub(crate) fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// Returns the words of the block before, unless the axes came to rest after it.
    pub(crate) fn last_words(&self) -> &[AxisWord] {
        &self.last_words
    }

    /// Returns the arc of the block, and that of the block before, unless the axes came to rest after it.
    pub(crate) fn arcs(&self) -> [Option<&Travel>; 2] {
        [self.arc.as_ref(), self.last_arc.as_ref()]
    }

    /// Returns every axis that the block moves, or may.
    pub(crate) fn axes(&self) -> impl Iterator<Item = AxisIndex> {
        let words = self.words.iter().map(|word| word.axis);
        words.chain(self.also.iter().map(|moved| moved.axis))
    }

    /// Returns whether it has words of axes that the machine does not have.
    #[inline]
    pub(crate) fn lacks_axes(&self) -> bool {
        !self.lacking.is_empty()
    }

    pub(crate) fn take_lacking(&mut self) -> Vec<(String, Span)> {
        std::mem::take(&mut self.lacking)
    }

    /// Returns whether an axis may have two words.
    #[inline]
    pub(crate) fn has_repeated(&self) -> bool {
        self.again != 0
    }

    /// Leaves each axis its first word. Returns the first two words of each axis that had more.
    pub(crate) fn drop_repeated(&mut self) -> Vec<[AxisWord; 2]> {
        let (mut first, mut repeated) = (BTreeMap::new(), Vec::new());
        let mut said = BTreeSet::new();
        self.words.retain(|word| match first.get(&word.axis) {
            None => {
                first.insert(word.axis, *word);
                true
            }
            Some(earlier) => {
                if said.insert(word.axis) {
                    repeated.push([*earlier, *word]);
                }
                false
            }
        });
        repeated
    }

    /// Drops the axis words, which move nothing.
    pub(crate) fn drop_words(&mut self) {
        self.words.clear();
    }

    /// Drops all motion of the block, since the control stops before it.
    pub(crate) fn stop(&mut self) {
        self.words.clear();
        self.also.clear();
    }

    /// Drops all words of the block, since they describe geometry.
    pub(crate) fn drop_all(&mut self) {
        self.words.clear();
        self.geometry = None;
    }

    /// Drops the words of the block before, since it was executed on another way.
    pub(crate) fn forget_last(&mut self) {
        self.words.clear();
        self.last_words.clear();
    }

    /// Returns the words so far, and the other motions.
    pub(crate) fn len(&self) -> [usize; 2] {
        [self.words.len(), self.also.len()]
    }

    /// Moves the spans of everything that a macro added to the use of the macro.
    pub(crate) fn show_at(&mut self, [words, also]: [usize; 2], span: Span) {
        for word in &mut self.words[words..] {
            word.span = span;
        }
        for moved in &mut self.also[also..] {
            moved.span = span;
        }
    }

    /// Returns the positions of the axes of the words, where they are known.
    pub(crate) fn ends(&mut self, modal: &Modal) -> Vec<Option<f64>> {
        let words = self.coordinates().iter();
        words.map(|word| modal.position(word.axis).value).collect()
    }

    /// Returns whether the block moves along its axis words at the feed in force.
    pub(crate) fn is_at_feed(&self, modal: &Modal) -> bool {
        let geometry = self.geometry.as_ref();
        let is_other = geometry.is_some_and(|it| it.foreign.is_some() || it.end_feed.is_some());
        !self.words.is_empty() && self.row.is_none() && modal.functions.is_feed_move() && !is_other
    }

    /// Returns the axes that the block certainly moves, with the words that move them; by homing only where that
    /// counts.
    pub(crate) fn certain(&self, words: AxisWords, homing_counts: bool) -> Vec<(AxisIndex, Span)> {
        let is_motion = matches!(words, AxisWords::Motion | AxisWords::Measuring)
            || (homing_counts && words == AxisWords::Homing);
        let of_words = self.words.iter().filter(|_| is_motion);
        let of_words = of_words.map(|word| (word.axis, word.span));
        let counts = |moved: &&MovedAxis| {
            moved.certainty == Certainty::Certain
                && (homing_counts || moved.kind != MotionKind::Homing)
        };
        let others = self.also.iter().filter(counts);
        of_words
            .chain(others.map(|moved| (moved.axis, moved.span)))
            .collect()
    }

    /// Returns the kind of motion of its axis words.
    #[inline]
    pub(crate) fn word_kind(&self, modal: &Modal) -> MotionKind {
        match self.row {
            Some(row) => row.kind,
            None if !modal.is_known(Group::Motion) => MotionKind::Unknown,
            None if modal.functions.motion == 0 => MotionKind::Rapid,
            None => MotionKind::Feed,
        }
    }

    /// Returns the kind of motion of an axis.
    pub(crate) fn kind_of(&self, axis: AxisIndex, modal: &Modal) -> MotionKind {
        let mut also = self.also.iter();
        let has_word = self.words.iter().any(|word| word.axis == axis);
        match also.find(|moved| moved.axis == axis) {
            Some(moved) if !has_word => moved.kind,
            _ => self.word_kind(modal),
        }
    }

    /// Returns the axes that move to their reference points.
    pub(crate) fn homed(&self, words: AxisWords) -> impl Iterator<Item = AxisIndex> {
        let is_homing = words == AxisWords::Homing;
        let of_words = self.words.iter().filter(move |_| is_homing);
        let others = self.also.iter();
        let others = others.filter(|it| it.kind == MotionKind::Homing);
        let others = others.map(|it| it.axis);
        of_words.map(|word| word.axis).chain(others)
    }
}

fn bit_of(axis: AxisIndex) -> u64 {
    1 << (axis.get() % 64)
}

/// Axes that move with others.
impl BlockMotion {
    /// Notes the axes that the operator moves, and those of a rotated or transformed frame.
    #[inline(never)]
    pub(crate) fn move_others(&mut self, words: AxisWords, setting: MotionSetting<'_>) {
        if let Some(row) = self.row
            && row.certainty == Certainty::Possible
        {
            self.leave_to_operator(row, setting);
        }
        if let Some(row) = self.row
            && row.moves == Moves::WordsInSpace
        {
            self.move_in_space(row, setting);
        }
        if matches!(words, AxisWords::Motion | AxisWords::Measuring) {
            self.move_in_frame(setting);
        }
    }

    /// Returns whether other axes may follow what the block moves.
    pub(crate) fn leads(&self, words: AxisWords) -> bool {
        !self.also.is_empty() || !self.words.is_empty() && words.move_axes()
    }

    /// Leaves the motion of axes to the operator in manual mode.
    fn leave_to_operator(&mut self, row: MotionEffect, setting: MotionSetting<'_>) {
        let words = self.words.iter().map(|it| (it.axis, it.span));
        let mut axes: Vec<_> = words.collect();
        if axes.is_empty() && row.moves == Moves::WordsOrAll {
            let all = setting.axes.path().into_iter();
            axes.extend(all.map(|axis| (axis, Span::default())));
        }
        for (axis, span) in axes {
            self.also.push(MovedAxis {
                axis,
                span,
                kind: row.kind,
                certainty: Certainty::Possible,
            });
        }
    }

    /// A motion of the block triggers a stroke, which may move these axes.
    pub(crate) fn punch(&mut self, stroke: &BTreeSet<AxisIndex>) {
        let Some(span) = self.words.first().map(|word| word.span) else {
            return;
        };
        self.also.extend(stroke.iter().map(|axis| MovedAxis {
            axis: *axis,
            span,
            kind: MotionKind::Feed,
            certainty: Certainty::Possible,
        }));
    }

    /// An arc in space may move every axis of it.
    fn move_in_space(&mut self, row: MotionEffect, setting: MotionSetting<'_>) {
        let Some(first) = self.words.first() else {
            return;
        };
        let span = first.span;
        let named: Vec<_> = self.words.iter().map(|word| word.axis).collect();
        let others = setting.axes.xyz().into_iter();
        let others = others.filter(|axis| !named.contains(axis));
        self.also.extend(others.map(|axis| MovedAxis {
            axis,
            span,
            kind: row.kind,
            certainty: Certainty::Possible,
        }));
    }

    /// Moves the other axes, too, in a rotated or transformed frame.
    fn move_in_frame(&mut self, setting: MotionSetting<'_>) {
        let of_words = self.words.iter().map(|it| (it.axis, it.span));
        let moves = |it: &&MovedAxis| it.kind == MotionKind::Unknown;
        let unknown = self.also.iter().filter(moves);
        let in_motion: Vec<_> = of_words
            .clone()
            .chain(unknown.map(|it| (it.axis, it.span)))
            .collect();
        let words: Vec<AxisIndex> = of_words.map(|(axis, _)| axis).collect();
        let mut found: BTreeMap<AxisIndex, (Certainty, Span)> = BTreeMap::new();
        // The motion after G40, or in its block, takes the tool radius back.
        let is_leaving = setting.modal.leaving != Leaving::Done;
        let leaving = is_leaving.then_some(CUTTER_RADIUS);
        let names = setting.modal.transformed.iter().map(String::as_str);
        for name in names.chain(leaving) {
            let Some((axes, certainty)) = setting.frame(name) else {
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
        self.also.extend(found);
    }

    /// Notes the axes that follow what the block moves.
    pub(crate) fn move_followers(&mut self, words: AxisWords, links: &[CouplingLink]) {
        let kind = match words {
            AxisWords::Homing => MotionKind::Homing,
            _ => MotionKind::Coupled,
        };
        let of_words = self.words.iter().filter(|_| words.move_axes());
        let of_words = of_words.map(|word| MovedAxis::of_word(word, kind));
        let in_motion = of_words.chain(self.also.iter().copied());
        let mut moving: BTreeMap<AxisIndex, MovedAxis> = BTreeMap::new();
        for moved in in_motion {
            let known = moving.entry(moved.axis).or_insert(moved);
            known.certainty = known.certainty.min(moved.certainty);
        }
        let own = moving.clone();
        // Each round makes the motion of an axis certain, or possible, or is the last.
        while follow(&mut moving, links) {}
        let is_new = |motion: &MovedAxis| {
            let known = own.get(&motion.axis);
            known.is_none_or(|known| known.certainty > motion.certainty)
        };
        self.also.extend(moving.into_values().filter(is_new));
    }
}

/// Moves the axes that follow moving ones directly. Returns whether any moves more certainly than before.
fn follow(moving: &mut BTreeMap<AxisIndex, MovedAxis>, links: &[CouplingLink]) -> bool {
    let mut grew = false;
    for &(follower, leader, certainty) in links {
        let leading = match leader {
            Some(leader) => moving.get(&leader),
            None => moving.values().min_by_key(|it| it.certainty),
        };
        let Some(&leading) = leading else {
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
        let motion = MovedAxis {
            axis: follower,
            span: leading.span,
            kind,
            certainty,
        };
        moving.insert(follower, motion);
        grew = true;
    }
    grew
}

impl MotionSetting<'_> {
    /// Returns the axes of a frame, and whether each certainly moves with another of them.
    fn frame(self, name: &str) -> Option<(Vec<AxisIndex>, Certainty)> {
        if name == CUTTER_RADIUS {
            // The path of the tool centre is beside the programmed one.
            return Some((self.axes.plane(self.modal), Certainty::Possible));
        }
        let row = HashCommand::named(name)?.motion?;
        Some(match row.moves {
            Moves::Plane => {
                let axes = self.axes.plane(self.modal);
                let main = |letter| self.axes.main(letter, self.modal);
                let is_known = [b'X', b'Y'].iter().all(|it| main(*it).is_some());
                let certainty = if is_known && self.modal.is_skewed() {
                    row.certainty
                } else {
                    Certainty::Possible
                };
                (axes, certainty)
            }
            Moves::Main => (self.axes.xyz(), row.certainty),
            Moves::Channel => (self.axes.path(), row.certainty),
            _ => return None,
        })
    }
}

/// The path and the velocity.
impl BlockMotion {
    /// Returns the axes of the plane that a circle moves, even without a word for them: `G2 I5` is a full circle
    /// (R2.46). Axes without a word end where they start. Returns those axes.
    pub(crate) fn move_around(
        &mut self,
        turns: bool,
        setting: MotionSetting<'_>,
    ) -> [Option<AxisIndex>; 2] {
        let plane = [b'X', b'Y'].map(|letter| setting.axes.main(letter, setting.modal));
        let geometry = self.geometry.as_ref();
        let centred = geometry.is_some_and(|it| it.centre.iter().any(Option::is_some));
        let is_circle = turns || !setting.modal.is_known(Group::Motion);
        let mut words = self.words.iter();
        let word = words.find(|word| plane.contains(&Some(word.axis)));
        let along = geometry.and_then(|it| it.span).filter(|_| centred);
        let Some(span) = along.or(word.map(|word| word.span)) else {
            return [None; 2];
        };
        if !is_circle || (!turns && !centred) || self.dwells {
            return [None; 2];
        }
        let own = self.words.len();
        let has_word = |axis: AxisIndex| self.words.iter().any(|word| word.axis == axis);
        let added = plane.map(|axis| axis.filter(|axis| !has_word(*axis)));
        for axis in added.into_iter().flatten() {
            self.named |= bit_of(axis);
            self.words.push(AxisWord {
                axis,
                span,
                value: None,
                from: None,
            });
        }
        let around = self.words.len() - own;
        if around > 0 {
            self.geometry().around = around;
        }
        added
    }

    /// Returns the radius of the block, if it has one.
    pub(crate) fn radius(&self) -> WordValue {
        self.geometry.as_ref()?.radius
    }

    /// Takes the geometry words: they make the motion of a block that started at `from`; `is_taken` where hosts take
    /// every motion.
    #[inline(never)]
    pub(crate) fn travel(
        &mut self,
        from: Option<Vec<Option<f64>>>,
        words: AxisWords,
        setting: MotionSetting<'_>,
        is_taken: bool,
    ) {
        let geometry = self.geometry.take();
        let Some(from) = from else { return };
        let path = BlockPath {
            geometry: &geometry.unwrap_or_default(),
            words: &self.words,
            setting,
        };
        let motion = if self.dwells {
            Some(path.dwell())
        } else {
            path.travel(from, words).map(Motion::Travel)
        };
        match motion {
            Some(Motion::Travel(travel)) if matches!(travel.form, PathForm::Arc(_)) => {
                self.motion = is_taken.then(|| Motion::Travel(travel.clone()));
                self.arc = Some(travel);
            }
            motion => self.motion = motion.filter(|_| is_taken),
        }
    }
}

/// The words of a block, and what they depend on.
#[derive(Clone, Copy)]
struct BlockPath<'a> {
    geometry: &'a Geometry,
    words: &'a [AxisWord],
    setting: MotionSetting<'a>,
}

impl BlockPath<'_> {
    fn dwell(self) -> Motion {
        let by_axis = self.words.first().map(|word| word.value);
        Motion::Dwell(self.geometry.dwell.or(by_axis).flatten())
    }

    fn travel(self, from: Vec<Option<f64>>, words: AxisWords) -> Option<Travel> {
        let Self {
            geometry,
            setting: MotionSetting { modal, .. },
            ..
        } = self;
        let centred = geometry.centre.iter().any(Option::is_some);
        let moves = !self.words.is_empty() || (modal.functions.is_arc() && centred);
        let form = match words {
            _ if !moves => return None,
            AxisWords::Motion | AxisWords::Measuring => self.form(&from),
            AxisWords::Homing => {
                PathForm::Unknown("homing ends at a reference point of the machine")
            }
            AxisWords::Reference | AxisWords::Other => return None,
        };
        Some(Travel {
            form,
            axes: self.words.iter().map(|word| word.axis).collect(),
            from,
            to: modal.positions().to_vec(),
            feed: self.feed(),
            end: match geometry.end {
                BlockEnd::Through => modal.functions.block_end,
                BlockEnd::ExactStop => BlockEnd::ExactStop,
            },
            contouring: modal.contouring(geometry.simplified),
            slope: modal.slope(),
            end_feed_per_min: self.end_feed(),
            tool: modal.tool_side(),
            simplified: modal.simplified.union(geometry.simplified),
        })
    }

    fn form(self, from: &[Option<f64>]) -> PathForm {
        let modal = self.setting.modal;
        if let Some(reason) = self.geometry.foreign {
            return PathForm::Unknown(reason);
        }
        if !modal.is_known(Group::Motion) {
            return PathForm::Unknown("it is not known whether G00, G01, G02 or G03 is active");
        }
        match modal.functions.motion {
            0 => PathForm::Rapid,
            1 => PathForm::Line,
            motion => self.arc(motion, from),
        }
    }

    fn arc(self, motion: u32, from: &[Option<f64>]) -> PathForm {
        let MotionSetting { axes, modal } = self.setting;
        let letters = [b'X', b'Y'].map(|letter| modal.main_axis(letter));
        let [Some(first), Some(second)] = letters else {
            return PathForm::Unknown("the active plane is not known");
        };
        let [Some(one), Some(two)] = [first, second].map(|letter| axes.letter(letter)) else {
            return PathForm::Unknown("the machine lacks an axis of the plane");
        };
        let geometry = self.geometry;
        let centre = if geometry.centre.iter().any(Option::is_some) {
            let offset = |letter: u8| geometry.centre[usize::from(letter - b'X')];
            let at = |axis: AxisIndex, letter| modal.centre_of(axis, offset(letter), from);
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
    fn feed(self) -> PathFeed {
        let modal = self.setting.modal;
        let haste = match modal.functions.motion {
            0 if modal.is_known(Group::Motion) => Haste::Rapid,
            _ => Haste::Feed,
        };
        let Some(share) = self.override_share(haste) else {
            return PathFeed::Unknown("the override is not known");
        };
        if haste == Haste::Rapid {
            return PathFeed::OfAxes(share);
        }
        if !modal.is_known(Group::Feed) {
            return PathFeed::Unknown("it is not known whether G93, G94 or G95 is active");
        }
        if matches!(self.geometry.end_feed, Some(None)) {
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
    fn override_share(self, haste: Haste) -> Option<f64> {
        let pace = &self.setting.modal.pace;
        if self.geometry.at_full_speed {
            return pace.weight(haste);
        }
        pace.share(haste, self.words.iter().map(|word| word.axis))
    }

    /// Returns a feed in mm, or in degrees where only rotary axes move.
    fn per_minute(self, feed: ProgrammedFeed) -> Option<f64> {
        let machine = self.setting.axes.machine;
        let is_rotary = |word: &AxisWord| machine.axis(word.axis).axis_type == AxisType::Rotary;
        if !self.words.is_empty() && self.words.iter().all(is_rotary) {
            return Some(feed.value);
        }
        feed.unit_mm.map(|unit| feed.value * unit)
    }

    /// Executes E, which counts with G94 only (PM/206811147).
    fn end_feed(self) -> Option<f64> {
        let modal = self.setting.modal;
        let is_per_minute = modal.functions.feed_mode == 94 && modal.functions.motion != 0;
        let value = self.geometry.end_feed.flatten().filter(|_| is_per_minute)?;
        let unit_mm = modal.unit_per_min();
        let feed = self.per_minute(ProgrammedFeed { value, unit_mm })?;
        Some(feed * self.override_share(Haste::Feed)?)
    }
}
