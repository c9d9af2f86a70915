//! The motion of a block, from its words (R5.1).

use crate::comp::AxisIndex;
use crate::interpreter::coordinates::axis_words::AxisWord;
use crate::interpreter::coordinates::geometry::{Geometry, WordValue};
use crate::interpreter::coordinates::motion::{
    Arc, BlockEnd, Centre, Motion, PathFeed, PathForm, Travel, Turn,
};
use crate::interpreter::coordinates::pace::{Haste, ProgrammedFeed};
use crate::interpreter::run::block_scratch::BlockScratch;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::values::value::rounded;
use crate::language::{AxisWords, Group};
use crate::lists::AxisType;
use crate::text::Span;

impl Interpreter {
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
        if (turns || self.scratch.geometry.is_some()) && words == AxisWords::Motion {
            self.move_around_in_plane(turns);
        }
    }

    fn move_around_in_plane(&mut self, turns: bool) {
        let letters = [b'X', b'Y'].map(|letter| self.main_axis(letter));
        let plane = letters.into_iter().flatten();
        let geometry = self.scratch.geometry.as_ref();
        let centred = geometry.is_some_and(|it| it.centre.iter().any(Option::is_some));
        let is_circle = turns || !self.state.control.modal.is_known(Group::Motion);
        let own = self.scratch.moved.len();
        let word = self.scratch.moved.iter();
        let word = word.filter(|word| letters.contains(&Some(word.axis)));
        let word = word.map(|word| word.span).next();
        let along = geometry.and_then(|it| it.span);
        let Some(span) = along.filter(|_| centred).or(word) else {
            return;
        };
        if !is_circle || (!turns && !centred) || self.scratch.dwells {
            return;
        }
        for axis in plane {
            if self.scratch.moved[..own]
                .iter()
                .all(|word| word.axis != axis)
            {
                self.see(axis);
                self.scratch.seen |= 1 << (axis.get() % 64);
                self.scratch.moved.push(AxisWord {
                    axis,
                    span,
                    value: None,
                    from: None,
                });
            }
        }
        let around = self.scratch.moved.len() - own;
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
        let geometry = self.scratch.geometry.take();
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
                self.scratch.motion = is_taken.then(|| Motion::Travel(travel.clone()));
                self.scratch.aside.arc = Some(travel);
            }
            motion => self.scratch.motion = motion.filter(|_| is_taken),
        }
    }

    fn motion(
        &self,
        geometry: &Geometry,
        from: Vec<Option<f64>>,
        words: AxisWords,
    ) -> Option<Motion> {
        if self.scratch.dwells {
            let by_axis = self.scratch.moved.first().map(|word| word.value);
            return Some(Motion::Dwell(geometry.dwell.or(by_axis).flatten()));
        }
        let circular = self.state.control.modal.functions.is_arc();
        let centred = geometry.centre.iter().any(Option::is_some);
        let moves = !self.scratch.moved.is_empty() || (circular && centred);
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
            axes: self.scratch.moved.iter().map(|word| word.axis).collect(),
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
        pace.share(haste, self.scratch.moved.iter().map(|word| word.axis))
    }

    /// A feed in mm, or in degrees where only rotary axes move.
    fn per_minute(&self, feed: ProgrammedFeed) -> Option<f64> {
        let is_rotary =
            |word: &AxisWord| self.machine.axis(word.axis).axis_type == AxisType::Rotary;
        let moved = &self.scratch.moved;
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
        let around = self.geometry.as_ref().map_or(0, |it| it.around);
        self.moved.len() - around
    }

    /// The geometry words of the block.
    pub(crate) fn geometry(&mut self) -> &mut Geometry {
        self.geometry.get_or_insert_default()
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
