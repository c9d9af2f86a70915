//! Modal state and programmed positions (R2.45 to R2.47).

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::chain::{self, Step};
use super::event::AxisWord;
use super::motion::BlockEnd;
use crate::comp::AxisIndex;

/// A group of G functions of which one is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Group {
    /// G00 G01 G02 G03.
    Motion,
    /// G17 G18 G19.
    Plane,
    /// G70 inch, G71 metric.
    Unit,
    /// G90 absolute, G91 incremental.
    Distance,
    /// G93 G94 G95 G194.
    Feed,
    /// G53 to G59, G159.
    Offset,
    /// G40 G41 G42.
    CutterRadius,
    /// G161 absolute, G162 relative circle centre.
    CircleCentre,
    /// G360 exact stop, G359 none.
    ExactStop,
}

impl Group {
    const ALL: [Self; Self::COUNT] = [
        Self::Motion,
        Self::Plane,
        Self::Unit,
        Self::Distance,
        Self::Feed,
        Self::Offset,
        Self::CutterRadius,
        Self::CircleCentre,
        Self::ExactStop,
    ];

    /// How many groups there are.
    pub(super) const COUNT: usize = Self::ExactStop as usize + 1;

    /// The group of a G number; `None` for one that is not modal or not modelled.
    pub fn of(number: u32) -> Option<Self> {
        Some(match number {
            0..=3 => Self::Motion,
            17..=19 => Self::Plane,
            70 | 71 => Self::Unit,
            90 | 91 => Self::Distance,
            93..=95 | 194 => Self::Feed,
            53..=59 | 159 => Self::Offset,
            40..=42 => Self::CutterRadius,
            161 | 162 => Self::CircleCentre,
            359 | 360 => Self::ExactStop,
            _ => return None,
        })
    }
}

/// A set of groups, a bit each; serialised as the list of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "Vec<Group>", from = "Vec<Group>")]
struct GroupSet(u16);

impl GroupSet {
    fn contains(self, group: Group) -> bool {
        self.0 & 1 << group as u8 != 0
    }

    fn insert(&mut self, group: Group) {
        self.0 |= 1 << group as u8;
    }

    fn remove(&mut self, group: Group) {
        self.0 &= !(1 << group as u8);
    }
}

impl FromIterator<Group> for GroupSet {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        let mut set = Self::default();
        groups.into_iter().for_each(|group| set.insert(group));
        set
    }
}

impl From<Vec<Group>> for GroupSet {
    fn from(groups: Vec<Group>) -> Self {
        groups.into_iter().collect()
    }
}

impl From<GroupSet> for Vec<Group> {
    fn from(set: GroupSet) -> Self {
        let groups = Group::ALL.into_iter();
        groups.filter(|&group| set.contains(group)).collect()
    }
}

/// Whether a position is one of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Frame {
    /// No transformation is active.
    Machine,
    /// A transformation, rotation, mirroring or cutter radius compensation is active: positions
    /// are those of the program (R2.47).
    Programmed,
}

/// The position of an axis after a block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxisPosition {
    /// The programmed coordinate in mm or degrees with the offset of G92; `None` where it is not
    /// known.
    pub value: Option<f64>,
    /// Whether it is one of the machine.
    pub frame: Frame,
}

/// The G functions in force and the programmed positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Modal {
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
    /// The feed of each mode, G93, G94, G95, where one was programmed.
    pub feeds: [Option<f64>; 3],
    /// G53 to G59, G159.
    pub offset: u32,
    /// Whether the circle centre is absolute, G161.
    pub centre_absolute: bool,
    /// How blocks end, G359 and G360.
    pub block_end: BlockEnd,
    /// The radius of circles without a centre, R; `None` where it is not known.
    pub radius: Option<f64>,
    /// What takes positions away from the machine's: names of `#` commands and G functions.
    pub transformed: BTreeSet<String>,
    /// Groups whose active function is not known offline (R2.51).
    unknown: GroupSet,
    /// Absolute positions: the programmed coordinate and the offset of G92.
    positions: Vec<Option<f64>>,
    /// G92; `None` where it is not known.
    references: Vec<Option<f64>>,
    /// What G92 set before `#MCS ON`, which comes back with `#MCS OFF`.
    suspended: Option<Vec<Option<f64>>>,
}

/// What the end of a cycle brings back (P-CHAN-00210): G functions and feed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Saved {
    motion: u32,
    plane: u32,
    absolute: bool,
    inch: bool,
    feed_mode: u32,
    feeds: [Option<f64>; 3],
    offset: u32,
    centre_absolute: bool,
    block_end: BlockEnd,
    transformed: [bool; 2],
    unknown: GroupSet,
}

/// A coordinate that counts from a place; not known where any part is not, nor where the sum
/// leaves the range of numbers.
#[inline]
fn shifted(from: Option<f64>, value: Option<f64>, scale: Option<f64>) -> Option<f64> {
    Some(from? + value? * scale?).filter(|sum| sum.is_finite())
}

/// G functions that take positions away from the machine's.
const TRANSFORMING: [&str; 2] = ["G41", "G21"];

impl Modal {
    /// The defaults at program start. Where the axes stand is not known.
    pub fn new(axes: usize) -> Self {
        Self {
            motion: 0,
            plane: 17,
            absolute: true,
            inch: false,
            feed_mode: 94,
            feeds: [None; 3],
            offset: 53,
            centre_absolute: false,
            block_end: BlockEnd::Through,
            radius: None,
            transformed: BTreeSet::new(),
            unknown: GroupSet::default(),
            positions: vec![None; axes],
            references: vec![Some(0.0); axes],
            suspended: None,
        }
    }

    /// The state at the start of the next program: the axes stay where they are.
    pub(super) fn next_program(&self) -> Self {
        Self {
            positions: self.positions.clone(),
            ..Self::new(self.positions.len())
        }
    }

    /// Whether it describes so many axes.
    pub(super) fn fits(&self, axes: usize) -> bool {
        let suspended = self.suspended.as_ref().map_or(axes, Vec::len);
        [self.positions.len(), self.references.len(), suspended] == [axes; 3]
    }

    /// Whether it is known which G function of a group is in force.
    pub fn is_known(&self, group: Group) -> bool {
        !self.unknown.contains(group)
    }

    /// What a cycle may change and its end brings back.
    pub(super) fn save(&self) -> Saved {
        Saved {
            motion: self.motion,
            plane: self.plane,
            absolute: self.absolute,
            inch: self.inch,
            feed_mode: self.feed_mode,
            feeds: self.feeds,
            offset: self.offset,
            centre_absolute: self.centre_absolute,
            block_end: self.block_end,
            transformed: TRANSFORMING.map(|name| self.transformed.contains(name)),
            unknown: self.unknown,
        }
    }

    /// The end of a cycle.
    pub(super) fn restore(&mut self, saved: &Saved) {
        if self.offset != saved.offset {
            self.forget_positions();
        }
        self.motion = saved.motion;
        self.plane = saved.plane;
        self.absolute = saved.absolute;
        self.inch = saved.inch;
        self.feed_mode = saved.feed_mode;
        self.feeds = saved.feeds;
        self.offset = saved.offset;
        self.centre_absolute = saved.centre_absolute;
        self.block_end = saved.block_end;
        self.unknown = saved.unknown;
        for (name, on) in TRANSFORMING.into_iter().zip(saved.transformed) {
            self.transform(name, on);
        }
    }

    /// The axis letter that `@X`, `@Y` or `@Z` means in the active plane; `None` where the plane is
    /// not known.
    pub(super) fn main_axis(&self, letter: u8) -> Option<u8> {
        let place = usize::from(letter.checked_sub(b'X')?);
        let axes = match self.plane {
            _ if !self.is_known(Group::Plane) => return None,
            18 => b"ZXY",
            19 => b"YZX",
            _ => b"XYZ",
        };
        axes.get(place).copied()
    }

    /// Puts a G function of a group into force.
    #[inline]
    pub(super) fn set(&mut self, group: Group, number: u32) {
        self.unknown.remove(group);
        match group {
            Group::Motion => self.motion = number,
            Group::Plane => self.plane = number,
            Group::Unit => self.inch = number == 70,
            Group::Distance => self.absolute = number == 90,
            Group::Feed => self.feed_mode = number,
            Group::Offset => {
                // An offset's values are the machine's own; coordinates lose their meaning.
                if self.offset != number {
                    self.forget_positions();
                }
                self.offset = number;
            }
            Group::CutterRadius => self.transform("G41", number != 40),
            Group::CircleCentre => self.centre_absolute = number == 161,
            Group::ExactStop if number == 360 => self.block_end = BlockEnd::ExactStop,
            Group::ExactStop => self.block_end = BlockEnd::Through,
        }
    }

    /// G20 switches mirroring off, G21 to G23 switch it on.
    pub(super) fn mirror(&mut self, number: u32) {
        self.transform("G21", number != 20);
    }

    /// Enters or leaves a transformation.
    /// The coordinates before and after are those of different systems, except with cutter radius
    /// compensation, which leaves the program's coordinates as they are.
    fn transform(&mut self, name: &str, on: bool) {
        let changed = if on {
            self.transformed.insert(name.to_owned())
        } else {
            self.transformed.remove(name)
        };
        if changed && name != "G41" {
            self.forget_positions();
        }
    }

    /// What a `#` command does to the coordinate chain.
    pub fn hash(&mut self, name: &str) {
        let Some((words, step, off)) = chain::command(name) else {
            return;
        };
        match step {
            Step::Coordinates => self.transform(words, !off),
            Step::Machine => self.machine_coordinates(words, off),
            Step::Path if off => _ = self.transformed.remove(words),
            Step::Path => self.note_transformed(words),
            Step::Origin => {
                self.note_transformed(words);
                self.forget_positions();
            }
        }
    }

    /// `#MCS ON` takes all offsets away until `#MCS OFF`. What is programmed after either of them
    /// is no sure place of the machine any more.
    fn machine_coordinates(&mut self, words: &str, off: bool) {
        if off {
            if let Some(references) = self.suspended.take() {
                self.references = references;
            }
        } else if self.suspended.is_none() {
            let none = vec![Some(0.0); self.references.len()];
            self.suspended = Some(std::mem::replace(&mut self.references, none));
        }
        self.note_transformed(words);
        self.forget_positions();
    }

    /// Positions are the program's from here on.
    pub(super) fn note_transformed(&mut self, name: &str) {
        if !self.transformed.contains(name) {
            self.transformed.insert(name.to_owned());
        }
    }

    /// A `#` command that may or may not have been executed.
    pub(super) fn forget_hash(&mut self, name: &str) {
        let mut after = self.clone();
        after.hash(name);
        if after != *self {
            if after.references != self.references {
                self.references.fill(None);
                self.suspended = None;
            }
            self.transformed.extend(after.transformed);
            self.forget_positions();
        }
    }

    /// What the blocks of a contour description leave of the state before it: whether their G
    /// functions and feeds hold after it is not documented (R2.81).
    pub(super) fn end_description(&mut self, before: &Self) {
        let value = |modal: &Self, group| match group {
            Group::Motion => modal.motion,
            Group::Plane => modal.plane,
            Group::Unit => u32::from(modal.inch),
            Group::Distance => u32::from(modal.absolute),
            Group::Feed => modal.feed_mode,
            Group::Offset => modal.offset,
            Group::CutterRadius => u32::from(modal.transformed.contains("G41")),
            Group::CircleCentre => u32::from(modal.centre_absolute),
            Group::ExactStop => u32::from(modal.block_end == BlockEnd::ExactStop),
        };
        for group in Group::ALL {
            if before.unknown.contains(group) || value(self, group) != value(before, group) {
                self.unknown.insert(group);
            }
        }
        for (feed, before) in self.feeds.iter_mut().zip(before.feeds) {
            *feed = feed.filter(|_| *feed == before);
        }
        self.radius = self.radius.filter(|_| self.radius == before.radius);
        self.forget_positions();
    }

    fn metric(&self) -> Option<f64> {
        let factor = if self.inch { 25.4 } else { 1.0 };
        self.is_known(Group::Unit).then_some(factor)
    }

    /// Millimetres of a programmed unit, where what coordinates count from is known, too.
    fn scale(&self) -> Option<f64> {
        self.metric().filter(|_| self.is_known(Group::Distance))
    }

    /// Programmed coordinates.
    pub(super) fn move_axes(&mut self, words: &[AxisWord]) {
        let scale = self.scale();
        for word in words {
            let axis = word.axis.get();
            let from = if self.absolute {
                self.references[axis]
            } else {
                self.positions[axis]
            };
            self.positions[axis] = shifted(from, word.value, scale);
        }
    }

    /// G92: offsets for the absolute coordinates that follow; in G91 they add to those in force
    /// (PM/206145291). The axes do not move.
    pub(super) fn set_references(&mut self, words: &[AxisWord]) {
        let scale = self.scale();
        for word in words {
            let axis = word.axis.get();
            let from = if self.absolute {
                Some(0.0)
            } else {
                self.references[axis]
            };
            self.references[axis] = shifted(from, word.value, scale);
        }
    }

    /// Forgets where the axes stand.
    pub fn forget_positions(&mut self) {
        self.positions.fill(None);
    }

    /// Forgets the position of one axis.
    pub fn forget_position(&mut self, axis: AxisIndex) {
        self.positions[axis.get()] = None;
    }

    /// Forgets what G92 set for an axis.
    pub(super) fn forget_reference(&mut self, axis: AxisIndex) {
        self.references[axis.get()] = None;
    }

    /// A G function that may or may not have been executed; `None` for one that is not known.
    pub(super) fn forget_g(&mut self, number: Option<i64>) {
        let Some(number) = number.and_then(|number| u32::try_from(number).ok()) else {
            self.unknown = Group::ALL.into_iter().collect();
            self.forget_positions();
            self.references.fill(None);
            return;
        };
        match Group::of(number) {
            Some(Group::Offset) => self.forget_positions(),
            Some(Group::CutterRadius) if number != 40 => self.transform("G41", true),
            None if (21..=23).contains(&number) => self.transform("G21", true),
            None if number == 151 => self.note_transformed("#SPLINE"),
            _ => {}
        }
        if let Some(group) = Group::of(number) {
            self.unknown.insert(group);
        }
    }

    /// What may also have been another state becomes unknown.
    pub(super) fn doubt(&mut self, other: &Self) {
        let differs = |group: Group| match group {
            Group::Motion => self.motion != other.motion,
            Group::Plane => self.plane != other.plane,
            Group::Unit => self.inch != other.inch,
            Group::Distance => self.absolute != other.absolute,
            Group::Feed => self.feed_mode != other.feed_mode,
            Group::Offset => self.offset != other.offset,
            Group::CutterRadius => {
                self.transformed.contains("G41") != other.transformed.contains("G41")
            }
            Group::CircleCentre => self.centre_absolute != other.centre_absolute,
            Group::ExactStop => self.block_end != other.block_end,
        };
        let groups = Group::ALL.into_iter();
        let unknown = groups.filter(|&group| {
            differs(group) || self.unknown.contains(group) || other.unknown.contains(group)
        });
        self.unknown = unknown.collect();
        let unless_same = |mine: &mut Option<f64>, theirs: &Option<f64>| {
            if mine != theirs {
                *mine = None;
            }
        };
        unless_same(&mut self.radius, &other.radius);
        let mut pairs: Vec<(&mut Option<f64>, &Option<f64>)> = Vec::new();
        pairs.extend(self.feeds.iter_mut().zip(&other.feeds));
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

    /// A feed word in mm/min, or the unit of the mode in force.
    pub fn set_feed(&mut self, value: Option<f64>) {
        match self.feed_mode {
            _ if !self.is_known(Group::Feed) => self.feeds = [None; 3],
            93 => self.feeds[0] = value,
            95 => self.feeds[2] = value,
            // A weight of feeds that the machine knows, no feed.
            194 => {}
            _ => self.feeds[1] = value,
        }
    }

    /// The programmed coordinate, without the offset of G92.
    pub(super) fn programmed(&self, axis: AxisIndex) -> Option<f64> {
        let position = self.positions[axis.get()].zip(self.references[axis.get()]);
        position.map(|(position, reference)| position - reference)
    }

    /// Where the axes stand: the programmed coordinate with the offset of G92.
    pub(super) fn positions(&self) -> &[Option<f64>] {
        &self.positions
    }

    /// The offset of G92 of an axis; `None` where it is not known.
    pub(super) fn reference(&self, axis: AxisIndex) -> Option<f64> {
        self.references[axis.get()]
    }

    /// Takes over the position of an axis.
    pub(super) fn place(&mut self, axis: AxisIndex, position: Option<f64>) {
        self.positions[axis.get()] = position;
    }

    /// The position of an axis.
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        AxisPosition {
            value: self.positions[axis.get()],
            frame: if self.transformed.is_empty() {
                Frame::Machine
            } else {
                Frame::Programmed
            },
        }
    }
}
