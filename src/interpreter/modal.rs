//! Modal state and programmed positions (R2.45 to R2.47).

use serde::{Deserialize, Serialize};

use crate::machine::AxisIndex;

/// A group of G functions of which one is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Group {
    /// G00 G01 G02 G03.
    Motion,
    /// G17 G18 G19.
    Plane,
    /// G70 inch, G71 metric.
    Unit,
    /// G90 absolute, G91 incremental.
    Distance,
    /// G93 G94 G95.
    Feed,
    /// G53 to G59, G159.
    Offset,
    /// G40 G41 G42.
    CutterRadius,
    /// G161 absolute, G162 relative circle centre.
    CircleCentre,
}

impl Group {
    /// How many groups there are.
    pub(super) const COUNT: usize = Self::CircleCentre as usize + 1;

    /// The group of a G number; `None` for one that is not modal or not modelled.
    pub fn of(number: u32) -> Option<Self> {
        Some(match number {
            0..=3 => Self::Motion,
            17..=19 => Self::Plane,
            70 | 71 => Self::Unit,
            90 | 91 => Self::Distance,
            93..=95 => Self::Feed,
            53..=59 | 159 => Self::Offset,
            40..=42 => Self::CutterRadius,
            161 | 162 => Self::CircleCentre,
            _ => return None,
        })
    }
}

/// Whether a position is one of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
    /// The programmed coordinate in mm or degrees; `None` where it is not known.
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
    /// G93 to G95.
    pub feed_mode: u32,
    /// The feed of each mode, G93, G94, G95, where one was programmed.
    pub feeds: [Option<f64>; 3],
    /// G53 to G59, G159.
    pub offset: u32,
    /// Whether the circle centre is absolute, G161.
    pub centre_absolute: bool,
    /// What takes positions away from the machine's: names of `#` commands and G functions.
    pub transformed: std::collections::BTreeSet<String>,
    /// Whether it is known which of G90 and G91, G70 and G71 is in force.
    scale_known: bool,
    positions: Vec<Option<f64>>,
}

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
            transformed: std::collections::BTreeSet::new(),
            scale_known: true,
            positions: vec![None; axes],
        }
    }

    /// Puts a G function into force. `false` for one that is not modelled.
    pub fn set(&mut self, number: u32) -> bool {
        match Group::of(number) {
            Some(Group::Motion) => self.motion = number,
            Some(Group::Plane) => self.plane = number,
            Some(Group::Unit) => self.inch = number == 70,
            Some(Group::Distance) => {
                self.absolute = number == 90;
                self.scale_known = true;
            }
            Some(Group::Feed) => self.feed_mode = number,
            Some(Group::Offset) => {
                // An offset's values are the machine's own; coordinates lose their meaning.
                if self.offset != number {
                    self.forget_positions();
                }
                self.offset = number;
            }
            Some(Group::CutterRadius) => self.transform("G41", number != 40),
            Some(Group::CircleCentre) => self.centre_absolute = number == 161,
            // G20 switches mirroring off, G21 to G23 switch it on.
            None if (20..=23).contains(&number) => self.transform("G21", number != 20),
            None => return false,
        }
        true
    }

    /// Enters or leaves a transformation.
    fn transform(&mut self, name: &str, on: bool) {
        if on {
            self.transformed.insert(name.to_owned());
        } else {
            self.transformed.remove(name);
        }
    }

    /// What a `#` command does to the coordinate chain.
    pub fn hash(&mut self, name: &str) {
        const CHAIN: [&str; 6] = ["#TRAFO", "#CS", "#ROTATION", "#SCALE", "#KIN", "#MIRROR"];
        let head = name.split(' ').next().unwrap_or_default();
        if CHAIN.contains(&head) {
            let off = name.ends_with(" OFF") || name.contains(" DEL");
            self.transform(head, !off);
        }
    }

    /// A programmed coordinate of an axis.
    pub fn move_axis(&mut self, axis: AxisIndex, value: Option<f64>) {
        let metric = if self.inch { 25.4 } else { 1.0 };
        let position = &mut self.positions[axis.get()];
        *position = match (value.filter(|_| self.scale_known), self.absolute) {
            (None, _) => None,
            (Some(value), true) => Some(value * metric),
            (Some(value), false) => position.map(|position| position + value * metric),
        };
    }

    /// G92: the axis stands at this coordinate from now on.
    pub fn set_reference(&mut self, axis: AxisIndex, value: Option<f64>) {
        let metric = if self.inch { 25.4 } else { 1.0 };
        self.positions[axis.get()] = value.map(|value| value * metric);
    }

    /// Forgets where the axes stand.
    pub fn forget_positions(&mut self) {
        self.positions.fill(None);
    }

    /// Forgets where one axis stands.
    pub fn forget_position(&mut self, axis: AxisIndex) {
        self.positions[axis.get()] = None;
    }

    /// A G function that may or may not have been executed.
    pub fn forget_g(&mut self, number: Option<i64>) {
        let group = number
            .and_then(|number| u32::try_from(number).ok())
            .and_then(Group::of);
        match group {
            Some(Group::Distance | Group::Unit) => self.scale_known = false,
            Some(Group::Offset) => self.forget_positions(),
            _ => {}
        }
    }

    /// A feed word in mm/min, or the unit of the mode in force.
    pub fn set_feed(&mut self, value: Option<f64>) {
        let place = (self.feed_mode - 93) as usize;
        self.feeds[place] = value;
    }

    /// Where an axis stands.
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
