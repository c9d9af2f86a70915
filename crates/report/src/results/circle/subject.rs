//! The subject of the report on a circular test.

use super::document::{advice_lines, no_glitches};
use crate::document::{Headline, Standing};
use serde::Serialize;

use frictcomp_physics::circle::{
    Circle, CircularTest, Comparison, Diagnosis, RecordedCircle, Recording, Side, diagnose,
    diagnose_comparison,
};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::identify::TraceFinding;

/// Treatment of the radial deviations, shown with the figures (R5.21).
pub(super) const TREATMENT: &str = "every point of the path for G, F and the glitch; H at 36000 fixed angles, \
                         linear between points; no filter, no mean";

/// Origin of the value list.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ListOrigin {
    /// Friction curve of the plant.
    Plant,
    /// A file of the user for both axes.
    File(String),
    /// A list for X and a list for Y.
    EachAxis([String; 2]),
}

impl ListOrigin {
    /// Returns the names of the files.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Plant => "plant".to_owned(),
            Self::File(name) => name.clone(),
            Self::EachAxis([x, y]) => format!("X={x}, Y={y}"),
        }
    }
}

/// Report on a circular test.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CircleReport {
    /// Driven circle.
    pub subject: Subject,
    /// The paths without and with compensation, or the recorded ones.
    pub sides: Vec<NamedSide>,
    /// Assumptions made in reading recorded paths.
    pub findings: Vec<TraceFinding>,
}

/// Driven circle.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Subject {
    /// A simulated test, with the origin of its value list and the cycles in which a force was limited.
    Simulated {
        /// The test.
        test: Box<CircularTest>,
        /// Origin of its list.
        origin: ListOrigin,
        /// Cycles of the speed loop in which a force was limited.
        saturated_cycles: u64,
    },
    /// Recorded circles.
    Recorded(Box<Recording>),
}

/// Paths under a name, with the causes that they suggest.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct NamedSide {
    /// `off`, `on` or `recorded`.
    pub name: &'static str,
    /// The paths.
    pub side: Side,
    /// Causes that their shapes suggest.
    pub advice: Vec<Diagnosis>,
}

impl CircleReport {
    /// Returns the report of a simulated test.
    pub fn simulated(test: CircularTest, comparison: Comparison, origin: ListOrigin) -> Self {
        let side = |name, advice, side| NamedSide { name, side, advice };
        let without = diagnose(&comparison.off.figures, Some(Switched::Off));
        let with = diagnose_comparison(&comparison);
        Self {
            subject: Subject::Simulated {
                test: Box::new(test),
                origin,
                saturated_cycles: comparison.saturated_cycles,
            },
            sides: vec![
                side("off", without, comparison.off),
                side("on", with, comparison.on),
            ],
            findings: Vec::new(),
        }
    }

    /// Returns the report of recorded circles, with what was assumed to read them.
    pub fn recorded((recording, findings): (Recording, Vec<TraceFinding>)) -> Self {
        let side = recording.side.clone();
        Self {
            subject: Subject::Recorded(Box::new(recording)),
            sides: vec![NamedSide {
                name: "recorded",
                advice: diagnose(&side.figures, None),
                side,
            }],
            findings,
        }
    }
}

/// Heights that differ by at most this part are the same: the first crossing stands for all of a symmetric circle on
/// every system.
const EQUAL_HEIGHTS: f64 = 1e-9;

impl CircleReport {
    /// Returns the verdict: the largest glitch, without and with compensation or in the recording, and its cure
    /// (R18.20).
    pub fn headline(&self) -> Headline {
        let worst = |side: &NamedSide| {
            let figures = &side.side.figures;
            let paths = [&figures.ccw, &figures.cw].into_iter().flatten();
            let glitches = paths.filter_map(|path| path.shape.as_ref());
            let glitches = glitches.flat_map(|shape| shape.glitches.iter());
            let worst = glitches.reduce(|worst, it| {
                let is_larger = it.height_um > worst.height_um * (1.0 + EQUAL_HEIGHTS);
                if is_larger { it } else { worst }
            });
            worst.map(|it| (it.height_um, it.crossing))
        };
        let worsts: Option<Vec<_>> = self.sides.iter().map(worst).collect();
        let verdict = match (worsts.as_deref(), &self.subject) {
            (Some([(off, _), (on, at)]), _) => Headline::new(
                if on < off {
                    Standing::Plain
                } else {
                    Standing::Bad
                },
                format!("largest glitch {on:.1} µm at {at} with compensation, {off:.1} µm without"),
            ),
            (Some([(um, at)]), _) => {
                let advice = self.sides.iter().flat_map(|side| advice_lines(self, side));
                let advice: Vec<String> = self
                    .other_radius()
                    .into_iter()
                    .chain(advice)
                    .take(1)
                    .collect();
                let (standing, advice) = match advice.as_slice() {
                    [] => (Standing::Plain, String::new()),
                    said => (Standing::Bad, format!("; {}", said.join("; "))),
                };
                Headline::new(
                    standing,
                    format!("largest glitch {um:.1} µm at {at}{advice}"),
                )
            }
            _ => Headline::new(
                Standing::Open,
                no_glitches(self).unwrap_or_else(|| "no glitch can be measured".to_owned()),
            ),
        };
        verdict.with_fault(&self.findings)
    }

    /// Returns in words the distance of a recorded circle from the commanded radius, where that is more than any
    /// deviation of a machine.
    fn other_radius(&self) -> Option<String> {
        /// A thousandth of the radius.
        const PART: f64 = 0.001;
        let Subject::Recorded(recording) = &self.subject else {
            return None;
        };
        let commanded = recording.commanded.radius_mm?;
        let circle = recording.circles.first()?;
        let more = circle.radius_mm - commanded;
        let which = if more > 0.0 { "larger" } else { "smaller" };
        (more.abs() > PART * commanded).then(|| {
            format!(
                "the recorded radius is {:.0} µm {which} than the commanded one: check that radius, the unit and the scale \
                 of the axes",
                1000.0 * more.abs()
            )
        })
    }

    /// Returns the radius in mm, and the feed in mm/min if it is known.
    pub(super) fn driven(&self) -> (f64, Option<f64>) {
        match &self.subject {
            Subject::Simulated { test, .. } => {
                (test.circle.radius_mm, Some(test.circle.feed_mm_per_min))
            }
            Subject::Recorded(recording) => {
                let first = recording.circles.first();
                let fitted = first.map_or(0.0, |circle| circle.radius_mm);
                let feeds = recording.circles.iter();
                let feeds = feeds.filter_map(RecordedCircle::feed_mm_per_min);
                (
                    recording.commanded.radius_mm.unwrap_or(fitted),
                    feeds.reduce(f64::max),
                )
            }
        }
    }

    /// Returns the change that would give figures at the crossings, if the circle is too fast for them
    /// (R5.22).
    pub(super) fn too_fast(&self) -> Option<TooFast> {
        let mut paths = self.sides.iter().flat_map(|side| {
            let figures = &side.side.figures;
            [&figures.ccw, &figures.cw].into_iter().flatten()
        });
        if paths.all(|path| path.shape.is_some()) {
            return None;
        }
        let (radius_mm, feed) = self.driven();
        let feed_mm_per_min = Circle::fastest_feed_for_glitches(radius_mm);
        Some(TooFast {
            feed_mm_per_min: feed_mm_per_min.floor(),
            radius_mm: feed.map(|feed| (10.0 * radius_mm * feed / feed_mm_per_min).ceil() / 10.0),
        })
    }
}

/// Change that would give figures at the crossings.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct TooFast {
    /// Highest feed with figures at the crossings.
    #[serde(rename = "feed_mm_min")]
    pub(super) feed_mm_per_min: f64,
    /// Radius from which there are figures, as an alternative.
    pub(super) radius_mm: Option<f64>,
}
