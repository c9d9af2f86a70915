//! The path of the tool beside the programmed contour (G41, G42; R11.30).
//!
//! Each block is moved aside by the radius of the tool. At an inner corner both blocks end where their paths
//! meet. Around an outer corner straight blocks are extended up to 90°; anything else goes round the corner in
//! an arc. The first block with compensation ends beside the start of the next one, and the first one without
//! it starts where the tool is.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::rounding::Rounding;
use super::segment::{PathSegment, SegmentOutline};
use super::trace::{Dwell, TraceSink};
use frictcomp::comp::AxisIndex;
use frictcomp::interpreter::{Centre, CircularArc, Contouring, SAME_PLACE, ToolSide, Turn};

/// The sine of a kink, 5°, below which a corner beside an arc is passed without an arc of its own.
const SLIGHT: f64 = 0.09;

/// Moves blocks aside, and passes the path on.
pub(super) struct ToolPath {
    rounding: Rounding,
    main: Arc<[bool]>,
    held: Held,
}

/// Path of the tool beside a contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ToolOffset {
    /// The axes of the plane.
    axes: [usize; 2],
    /// The distance to the left of the contour, in mm.
    left: f64,
}

impl ToolOffset {
    /// Returns the offset in the plane of these axes, with the radius of a tool in mm.
    pub(super) fn of(side: ToolSide, axes: [usize; 2], radius_mm: f64) -> Self {
        let left = match side {
            ToolSide::Left => radius_mm,
            _ => -radius_mm,
        };
        Self { axes, left }
    }
}

/// Part of the path that depends on the next block.
enum Held {
    /// No such part: the tool is on the programmed path.
    Nothing,
    /// The block that leads to the contour.
    Approach(HeldBlock),
    /// A block beside the contour, whose end is that without a corner.
    Beside(HeldBlock),
    /// The tool is beside the contour, at this place of the plane.
    Place([usize; 2], [f64; 2]),
}

struct HeldBlock {
    segment: PathSegment,
    contouring: Option<Contouring>,
    beside: ToolOffset,
}

/// Form of the path beside a corner.
#[derive(Debug, Clone, Copy)]
enum CornerBeside {
    /// Blocks of which one ends where the other starts.
    Joined,
    /// Common end point of both blocks.
    Meets([f64; 2]),
    /// Straight piece from one block to the other.
    Straight,
    /// Arc about the corner from one block to the other.
    Around(CircularArc),
}

impl ToolPath {
    pub(super) fn new(rounding: Rounding, main: Arc<[bool]>) -> Self {
        Self {
            rounding,
            main,
            held: Held::Nothing,
        }
    }

    pub(super) fn rounding(&self) -> &Rounding {
        &self.rounding
    }

    /// Adds the next block of the program, with the place of the tool beside it, where it is not on it.
    ///
    /// # Errors
    /// The reason why the tool cannot follow it.
    pub(super) fn add(
        &mut self,
        (segment, contouring): (PathSegment, Option<Contouring>),
        beside: Option<ToolOffset>,
        sink: &mut dyn TraceSink,
    ) -> Result<ControlFlow<()>, &'static str> {
        let Some(beside) = beside else {
            return self.leave((segment, contouring), sink);
        };
        let block = HeldBlock {
            segment,
            contouring,
            beside,
        };
        if block.stays() {
            return Ok(self.pass_beside(block, sink));
        }
        if let Held::Approach(last) | Held::Beside(last) = &self.held
            && last.beside != beside
        {
            return Err("tool radius compensation changes its side, its plane or its radius here");
        }
        if matches!(self.held, Held::Nothing) {
            if !block.segment.is_straight() {
                return Err("tool radius compensation begins on an arc");
            }
            self.held = Held::Approach(block);
            return Ok(ControlFlow::Continue(()));
        }
        let segment = block.segment.beside(beside.axes, beside.left)?;
        let corner = match &self.held {
            Held::Beside(last) => CornerBeside::between(&last.segment, &segment, beside)?,
            _ => CornerBeside::Straight,
        };
        Ok(self.join(corner, HeldBlock { segment, ..block }, sink))
    }

    /// Leads what is held to the next block beside the contour.
    fn join(
        &mut self,
        corner: CornerBeside,
        mut next: HeldBlock,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let start = next.place(PathSegment::starts);
        match std::mem::replace(&mut self.held, Held::Nothing) {
            Held::Nothing => {}
            Held::Approach(block) => {
                let to = next.segment.starts();
                let line = block.segment.moved(block.segment.starts(), to, &self.main);
                self.hand_on(line, block.contouring, sink)?;
            }
            Held::Place(_, place) => {
                let line = self.straight(&next, [place, start]);
                self.hand_on(line, next.contouring, sink)?;
            }
            Held::Beside(mut last) => {
                let between = match corner {
                    CornerBeside::Joined => None,
                    CornerBeside::Meets(place) => {
                        last.cut(1, place);
                        next.cut(0, place);
                        None
                    }
                    CornerBeside::Straight => {
                        self.straight(&next, [last.place(PathSegment::ends), start])
                    }
                    CornerBeside::Around(arc) => last.segment.around(&arc, start, &self.main),
                };
                self.hand_on(Some(last.segment), last.contouring, sink)?;
                self.hand_on(between, next.contouring, sink)?;
            }
        }
        self.held = Held::Beside(next);
        ControlFlow::Continue(())
    }

    /// Returns a block without compensation: it starts where the tool is.
    fn leave(
        &mut self,
        (segment, contouring): (PathSegment, Option<Contouring>),
        sink: &mut dyn TraceSink,
    ) -> Result<ControlFlow<()>, &'static str> {
        let axes = match &self.held {
            Held::Nothing => return Ok(self.rounding.add((segment, contouring), sink)),
            Held::Approach(block) | Held::Beside(block) => block.beside.axes,
            Held::Place(axes, _) => *axes,
        };
        let next = HeldBlock {
            segment,
            contouring,
            beside: ToolOffset { axes, left: 0.0 },
        };
        if next.stays() {
            return Ok(self.pass_beside(next, sink));
        }
        let is_beside = !matches!(self.held, Held::Approach(_));
        if is_beside && !next.segment.is_straight() {
            return Err("tool radius compensation ends on an arc");
        }
        let ControlFlow::Continue(place) = self.release(sink) else {
            return Ok(ControlFlow::Break(()));
        };
        let line = match place {
            Some(place) => {
                let from = at_place(next.segment.starts(), axes, place);
                next.segment.moved(&from, next.segment.ends(), &self.main)
            }
            None => Some(next.segment),
        };
        Ok(self.hand_on(line, contouring, sink))
    }

    /// Passes on what is held, and returns the place of the tool in the plane if it is beside the contour.
    fn release(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<(), Option<[f64; 2]>> {
        match std::mem::replace(&mut self.held, Held::Nothing) {
            Held::Nothing => ControlFlow::Continue(None),
            Held::Approach(block) => {
                self.hand_on(Some(block.segment), block.contouring, sink)?;
                ControlFlow::Continue(None)
            }
            Held::Beside(block) => {
                let place = block.place(PathSegment::ends);
                self.hand_on(Some(block.segment), block.contouring, sink)?;
                ControlFlow::Continue(Some(place))
            }
            Held::Place(_, place) => ControlFlow::Continue(Some(place)),
        }
    }

    /// Passes on what is held; the tool stays beside the contour.
    fn rest_beside(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        let axes = match &self.held {
            Held::Beside(block) => block.beside.axes,
            Held::Place(axes, _) => *axes,
            Held::Nothing | Held::Approach(_) => [0, 1],
        };
        if let Some(place) = self.release(sink)? {
            self.held = Held::Place(axes, place);
        }
        ControlFlow::Continue(())
    }

    /// Takes a block that does not move in the plane: the tool stays where it is there.
    fn pass_beside(&mut self, block: HeldBlock, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.rest_beside(sink)?;
        let Held::Place(axes, place) = self.held else {
            return self.hand_on(Some(block.segment), block.contouring, sink);
        };
        let ends = [block.segment.starts(), block.segment.ends()];
        let [from, to] = ends.map(|end| at_place(end, axes, place));
        let line = block.segment.moved(&from, &to, &self.main);
        self.hand_on(line, block.contouring, sink)
    }

    /// Returns a straight piece of a block in the plane, at its start.
    fn straight(&self, block: &HeldBlock, places: [[f64; 2]; 2]) -> Option<PathSegment> {
        let starts = block.segment.starts();
        let [from, to] = places.map(|place| at_place(starts, block.beside.axes, place));
        block.segment.moved(&from, &to, &self.main)
    }

    fn hand_on(
        &mut self,
        segment: Option<PathSegment>,
        contouring: Option<Contouring>,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        match segment {
            Some(segment) => self.rounding.add((segment, contouring), sink),
            None => ControlFlow::Continue(()),
        }
    }

    /// Holds the axes at rest.
    pub(super) fn rest(&mut self, dwell: Dwell<'_>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.rest_beside(sink)?;
        self.rounding.rest(dwell, sink)
    }

    /// Follows the path to its end and stops there.
    pub(super) fn stop(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.release(sink)?;
        self.rounding.stop(sink)
    }
}

impl HeldBlock {
    /// Returns whether it does not move in the plane.
    fn stays(&self) -> bool {
        let moves = |step: f64| step.abs() > 0.0;
        !self
            .segment
            .direction(self.beside.axes, 0.0)
            .into_iter()
            .any(moves)
    }

    fn place(&self, of: fn(&PathSegment) -> &[f64]) -> [f64; 2] {
        self.beside.axes.map(|axis| of(&self.segment)[axis])
    }

    /// Lets an end of it be at a place of its outline.
    fn cut(&mut self, end: usize, place: [f64; 2]) {
        let mut parts = [0.0, 1.0];
        let mut places = [
            self.place(PathSegment::starts),
            self.place(PathSegment::ends),
        ];
        parts[end] = self.segment.part_at(self.beside.axes, place);
        places[end] = place;
        self.segment = self.segment.between(parts, (self.beside.axes, places));
    }
}

fn at_place(positions: &[f64], axes: [usize; 2], place: [f64; 2]) -> Vec<f64> {
    let mut positions = positions.to_vec();
    (positions[axes[0]], positions[axes[1]]) = (place[0], place[1]);
    positions
}

impl CornerBeside {
    /// Returns the corner between two blocks beside the contour.
    fn between(
        last: &PathSegment,
        next: &PathSegment,
        ToolOffset { axes, left }: ToolOffset,
    ) -> Result<Self, &'static str> {
        let end = axes.map(|axis| last.ends()[axis]);
        let start = axes.map(|axis| next.starts()[axis]);
        if distance(end, start) < SAME_PLACE {
            return Ok(Self::Joined);
        }
        let before = last.direction(axes, last.length);
        let after = next.direction(axes, 0.0);
        let cosine = before[0] * after[0] + before[1] * after[1];
        let sine = before[0] * after[1] - before[1] * after[0];
        let is_inner = sine * left > 0.0;
        let is_slight = cosine > 0.0 && sine.abs() < SLIGHT;
        let vertex = [start[0] + left * after[1], start[1] - left * after[0]];
        let both_straight = last.is_straight() && next.is_straight();
        let is_extended = both_straight && cosine >= 0.0;
        if !(is_inner || is_extended) {
            if is_slight {
                return Ok(Self::Straight);
            }
            return Ok(Self::Around(CircularArc {
                axes: axes.map(AxisIndex::new),
                turn: if left > 0.0 {
                    Turn::Clockwise
                } else {
                    Turn::CounterClockwise
                },
                centre: Centre::Point(vertex),
            }));
        }
        // At an inner corner neither block is extended.
        let is_on_both = |place: &[f64; 2]| {
            !is_inner || (last.part_at(axes, *place) > 0.0 && next.part_at(axes, *place) < 1.0)
        };
        let places = meetings([last, next].map(|it| it.outline(axes))).into_iter();
        let places = places.flatten().filter(is_on_both);
        let nearest =
            places.min_by(|one, other| distance(*one, vertex).total_cmp(&distance(*other, vertex)));
        match nearest {
            Some(place) => Ok(Self::Meets(place)),
            // A slight kink at an arc: the tangents meet.
            None if is_slight => {
                let aside = left / (1.0 + cosine);
                Ok(Self::Meets([
                    vertex[0] - aside * (before[1] + after[1]),
                    vertex[1] + aside * (before[0] + after[0]),
                ]))
            }
            None => Err("the tool does not fit into the contour here"),
        }
    }
}

fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}

/// Returns the places where two outlines meet.
fn meetings(outlines: [SegmentOutline; 2]) -> [Option<[f64; 2]>; 2] {
    match outlines {
        [
            SegmentOutline::Line {
                through: p,
                direction: d,
            },
            SegmentOutline::Line {
                through: q,
                direction: e,
            },
        ] => {
            let cross = d[0] * e[1] - d[1] * e[0];
            let along = ((q[0] - p[0]) * e[1] - (q[1] - p[1]) * e[0]) / cross;
            let place = [p[0] + along * d[0], p[1] + along * d[1]];
            [
                Some(place).filter(|place| place[0].is_finite() && place[1].is_finite()),
                None,
            ]
        }
        [
            SegmentOutline::Line { through, direction },
            SegmentOutline::Circle { centre, radius },
        ]
        | [
            SegmentOutline::Circle { centre, radius },
            SegmentOutline::Line { through, direction },
        ] => on_chord(through, direction, (centre, radius)),
        [
            SegmentOutline::Circle {
                centre: a,
                radius: r,
            },
            SegmentOutline::Circle {
                centre: b,
                radius: s,
            },
        ] => {
            let apart = distance(a, b);
            if apart < SAME_PLACE {
                return [None; 2];
            }
            let axis = [(b[0] - a[0]) / apart, (b[1] - a[1]) / apart];
            let along = (apart * apart + r * r - s * s) / (2.0 * apart);
            let through = [a[0] + along * axis[0], a[1] + along * axis[1]];
            on_chord(through, [-axis[1], axis[0]], (a, r))
        }
    }
}

/// Returns the places where a line meets a circle.
fn on_chord(
    through: [f64; 2],
    direction: [f64; 2],
    (centre, radius): ([f64; 2], f64),
) -> [Option<[f64; 2]>; 2] {
    let to = [centre[0] - through[0], centre[1] - through[1]];
    let along = to[0] * direction[0] + to[1] * direction[1];
    let across = to[0] * direction[1] - to[1] * direction[0];
    let half = (radius * radius - across * across).sqrt();
    [along - half, along + half].map(|along| {
        let place = [
            through[0] + along * direction[0],
            through[1] + along * direction[1],
        ];
        Some(place).filter(|_| half.is_finite())
    })
}
