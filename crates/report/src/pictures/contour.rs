//! The contour of a program: the path with its deviation, reversals, and both over time.

use std::sync::Arc;

use crate::svg::{
    Band, BandRow, BandState, ChartAxis, Curve, Drawn, LineChart, Panel, PlaneChart, PlaneMark,
    PlanePoint, Series, StartUpRelation, Stroke,
};
use crate::wording::glitch_in_words;
use frictcomp::comp::State;
use frictcomp::interpreter::PositionFrame;
use frictcomp_physics::contour::{ContourPoint, ContourReversal};
use frictcomp_physics::motion::Movement;

/// Number of points of the path before they are joined in pairs.
const MOST_POINTS: usize = 12_000;

/// Number of marked reversals, unless further ones are worse.
const MOST_MARKS: usize = 20_000;

/// Number of states over time that are kept apart.
const MOST_BANDS: usize = 5000;

/// Number of the worst reversals with a label.
const NAMED: usize = 6;

/// Number of the worst reversals listed with a contour that is followed.
const LISTED: usize = 10;

/// The block of a reversal, of the largest deviation, or of a stretch of the path.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct MarkedSpot {
    file: Arc<str>,
    line: u32,
}

/// A contour on which the block of a place and the place of a block can be found.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FollowedContour {
    /// The path without the deviation over time.
    pub chart: PlaneChart,
    /// The path block by block, in the order of driving.
    pub stretches: Vec<BlockStretch>,
    /// The worst reversals with their descriptions, the worst first.
    pub worst: Vec<WorstReversal>,
}

/// The part of the path that a block drives.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BlockStretch {
    /// File.
    pub file: Arc<str>,
    /// Line, from 1.
    pub line: u32,
    /// A line through points of the picture, in its units.
    pub points: Vec<[f64; 2]>,
    /// Machine time at its end in s.
    pub end_s: f64,
}

/// A reversal with its description.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct WorstReversal {
    /// The file of its block.
    pub file: Arc<str>,
    /// The line of its block, from 1.
    pub line: u32,
    /// The axis, its feed, its state and its glitch.
    pub words: String,
}

/// A contour in the making, in memory that does not grow with the length of the program.
#[derive(Debug, Clone)]
pub struct ContourPicture {
    axes: [String; 2],
    /// Points of the path with their blocks, and the machine time of their last cycle in s.
    points: Vec<(PlanePoint, MarkedSpot, f64)>,
    /// Cycles that are drawn as one point.
    every: u64,
    filled: u64,
    curves: [Curve; 3],
    bands: [Vec<Band>; 2],
    marks: Vec<(PlaneMark, MarkedSpot)>,
    more_marks: u64,
    largest_um: f64,
    largest_at: MarkedSpot,
}

impl ContourPicture {
    /// Returns the contour in the plane of two axes, before its first cycle.
    pub fn new(axes: [String; 2]) -> Self {
        Self {
            axes,
            points: Vec::new(),
            every: 1,
            filled: 0,
            curves: Default::default(),
            bands: Default::default(),
            marks: Vec::new(),
            more_marks: 0,
            largest_um: 0.0,
            largest_at: MarkedSpot::default(),
        }
    }

    /// Takes a cycle.
    pub fn point(&mut self, point: &ContourPoint<'_>) {
        let off = point.cause.friction.iter().take(2);
        let is_on = off.into_iter().all(|state| *state == State::Active);
        let stroke = match (point.cause.frame, point.counts, is_on) {
            (PositionFrame::Programmed, ..) => Stroke::LeftOut,
            (_, false, _) => Stroke::Unjudged,
            (_, true, true) => Stroke::Compensated,
            (_, true, false) => Stroke::Uncompensated,
        };
        let spot = MarkedSpot {
            file: Arc::clone(&point.cause.file),
            line: point.cause.line,
        };
        let deviation = &point.deviation_um;
        let each = [deviation.programmed, deviation.all_on, deviation.all_off];
        for (curve, deviation) in self.curves.iter_mut().zip(each) {
            if point.counts {
                curve.push([point.time_s, deviation]);
            } else {
                curve.interrupt();
            }
        }
        if point.counts && each[0].abs() > self.largest_um {
            self.largest_um = each[0].abs();
            self.largest_at = spot.clone();
        }
        let kept = PlanePoint {
            place: [point.positions[0], point.positions[1]],
            error: point.error_mm,
            stroke,
        };
        self.keep((kept, spot, point.time_s));
        let names = &self.axes;
        for ((bands, state), name) in self.bands.iter_mut().zip(&*point.cause.friction).zip(names) {
            extend(bands, name, (point.time_s, *state));
        }
    }

    /// Keeps the cycle with the largest deviation among those that make a point.
    fn keep(&mut self, (point, spot, time_s): (PlanePoint, MarkedSpot, f64)) {
        let size = |it: &PlanePoint| it.error[0].hypot(it.error[1]);
        let is_full = self.filled >= self.every;
        match self.points.last_mut() {
            Some(last) if !is_full && last.0.stroke == point.stroke => {
                if size(&point) > size(&last.0) {
                    (last.0, last.1) = (point, spot);
                }
                last.2 = time_s;
                self.filled += 1;
            }
            _ => {
                self.points.push((point, spot, time_s));
                self.filled = 1;
            }
        }
        if self.points.len() >= MOST_POINTS {
            let pairs = self.points.chunks(2);
            let joined = pairs.map(|pair| match pair {
                [one, other] if size(&other.0) > size(&one.0) || other.0.stroke != one.0.stroke => {
                    other.clone()
                }
                [one, other] => (one.0, one.1.clone(), other.2),
                _ => pair[0].clone(),
            });
            self.points = joined.collect();
            self.every *= 2;
        }
    }

    /// Takes a reversal.
    pub fn reversal(&mut self, reversal: &ContourReversal) {
        if reversal.movement == Movement::Rapid || !self.axes.contains(&reversal.axis) {
            return;
        }
        let programmed = reversal.programmed_mm_per_min;
        let programmed = programmed.map_or(String::new(), |feed| format!(" of F{feed:.0}"));
        let mark = PlaneMark {
            place: [reversal.positions[0], reversal.positions[1]],
            ringed: reversal.state != State::Active,
            weight: reversal.glitch_um.programmed,
            label: None,
            title: format!(
                "line {}: {} reverses at {:.0} mm/min{}, {}, {}",
                reversal.line,
                reversal.axis,
                reversal.feed_mm_per_min,
                programmed,
                reversal.state.as_str(),
                glitch_in_words(reversal)
            ),
            href: None,
        };
        let spot = MarkedSpot {
            file: Arc::clone(&reversal.file),
            line: reversal.line,
        };
        if self.marks.len() < MOST_MARKS {
            self.marks.push((mark, spot));
            return;
        }
        self.more_marks += 1;
        let weakest = self
            .marks
            .iter_mut()
            .min_by(|one, other| one.0.weight.total_cmp(&other.0.weight));
        if let Some(weakest) = weakest.filter(|it| it.0.weight < mark.weight) {
            *weakest = (mark, spot);
        }
    }

    /// Returns the path alone, in which an editor finds the block of a place and the place of a block.
    pub fn followed(mut self, program: &str) -> FollowedContour {
        let points = self.points.iter();
        let spots: Vec<MarkedSpot> = points.clone().map(|(_, spot, _)| spot.clone()).collect();
        let times: Vec<f64> = points.map(|(.., time_s)| *time_s).collect();
        self.rank();
        let worst = self
            .marks
            .iter()
            .take(LISTED)
            .map(|(mark, spot)| WorstReversal {
                file: Arc::clone(&spot.file),
                line: spot.line,
                words: mark.title.clone(),
            });
        let worst = worst.collect();
        let mut chart = self.chart(program);
        chart.below = None;
        let mut ends: Vec<usize> = (1..spots.len())
            .filter(|&at| spots[at] != spots[at - 1])
            .collect();
        ends.extend((!spots.is_empty()).then_some(spots.len()));
        let drawn = chart.drawn(&ends).into_iter().zip(&ends);
        let stretches = drawn.map(|(points, end)| BlockStretch {
            file: Arc::clone(&spots[end - 1].file),
            line: spots[end - 1].line,
            points,
            end_s: times[end - 1],
        });
        FollowedContour {
            stretches: stretches.collect(),
            chart,
            worst,
        }
    }

    /// Puts the worst reversals first.
    fn rank(&mut self) {
        self.marks
            .sort_by(|one, other| other.0.weight.total_cmp(&one.0.weight));
    }

    /// Returns the picture: the path above, deviations over time below.
    pub fn chart(self, program: &str) -> PlaneChart {
        self.linked_chart(program, |_, _| None)
    }

    /// Returns the picture in a page: each mark links to what `link` gives for its file and line.
    pub fn linked_chart(
        mut self,
        program: &str,
        link: impl Fn(&str, u32) -> Option<String>,
    ) -> PlaneChart {
        for (mark, spot) in &mut self.marks {
            mark.href = link(&spot.file, spot.line);
        }
        self.rank();
        let uncompensated = self.marks.iter().filter(|(mark, _)| mark.ringed).count();
        for (mark, spot) in self.marks.iter_mut().take(NAMED) {
            mark.label = Some(format!("line {}: {:.1} µm", spot.line, mark.weight));
        }
        let count = self.marks.len();
        let (largest, at) = (self.largest_um, &self.largest_at);
        let description = format!(
            "The commanded path in the plane {}{}, and the simulated one with its deviation \
             magnified. The largest deviation while cutting is {largest:.1} µm, at {}:{}. {count} \
             reversals are marked, {uncompensated} of them without compensation.",
            self.axes[0], self.axes[1], at.file, at.line
        );
        let title = format!("Contour of {program}");
        PlaneChart {
            below: Some(self.strip()),
            title,
            description,
            points: self.points.into_iter().map(|(point, ..)| point).collect(),
            marks: self.marks.into_iter().map(|(mark, _)| mark).collect(),
            axes: self.axes,
        }
    }

    fn strip(&self) -> LineChart {
        let names = ["as programmed", "all on", "all off"];
        // One scale, so that heights can be compared between panels.
        let curves = [0, 1, 2].map(|at: usize| self.curves[at].points());
        let largest = curves
            .iter()
            .flatten()
            .map(|point| point[1].abs())
            .filter(|it| it.is_finite())
            .fold(0.0, f64::max);
        let panels = curves.into_iter().zip(names).map(|(points, name)| Panel {
            y: ChartAxis::linear(format!("{name}: deviation in µm, outside positive"))
                .reaching(largest),
            series: vec![Series {
                name: name.to_owned(),
                points,
                drawn: Drawn::Plain,
            }],
            ..Panel::default()
        });
        let rows = self.axes.iter().zip(&self.bands);
        LineChart {
            title: "Deviation over time".to_owned(),
            description: "The signed deviation from the path while cutting, in each of the three \
                          runs on one scale, below the states of both axes."
                .to_owned(),
            x: ChartAxis::linear("time in s"),
            bands: rows
                .map(|(name, bands)| BandRow {
                    label: name.clone(),
                    bands: bands.clone(),
                })
                .collect(),
            panels: panels.collect(),
            ..LineChart::default()
        }
    }
}

fn extend(bands: &mut Vec<Band>, name: &str, (time_s, state): (f64, State)) {
    let is_full = bands.len() >= MOST_BANDS;
    match bands.last_mut() {
        Some(last) if last.state == BandState::One(state) => last.to = time_s,
        Some(last) if is_full => {
            last.state = BandState::Changing;
            last.relation = StartUpRelation::StartUp;
            last.to = time_s;
        }
        last => {
            if let Some(last) = last {
                last.to = time_s;
            }
            bands.push(Band {
                from: time_s,
                to: time_s,
                state: BandState::One(state),
                relation: StartUpRelation::of(state, State::Active),
                title: format!("{name} {} from {time_s} s", state.as_str()),
                href: None,
            });
        }
    }
}
