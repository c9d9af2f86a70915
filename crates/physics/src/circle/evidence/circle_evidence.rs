//! The evidence in a recorded path: its noise, shapes with their standard errors, and the residual
//! (R5.28).

use serde::Serialize;

use super::evidence_shape::{OtherShape, ShapeTerm, Term};
use super::oscillation::Oscillation;
use super::pitch;
use super::series::{AngleSeries, Mask, beyond_noise};
use super::shapes::{Additions, Shapes};
use super::swings::stick_slip;
use super::tail_search;
use super::tails::Tails;
use crate::circle::geometry::CircleDrift;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Quality, RadialProfile};

/// Least residual in µm that counts as a shape …
const LEAST_REST_UM: f64 = 0.15;

/// … from this part of the noise …
const REST_OF_NOISE: f64 = 0.3;

/// … and from this part of a step of the encoder.
const REST_OF_STEP: f64 = 0.5;

/// Part of the residual that a shape explains at least.
const EXPLAINS: f64 = 0.2;

/// A residual that screws leave counts as a shape from this part of what it was.
const REMAINS: f64 = 0.2;

/// Evidence in a recording, with its limits.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CircleEvidence {
    /// Standard deviation of the noise of single samples.
    pub noise_um: f64,
    /// The shapes that were fitted, named or not.
    pub terms: Vec<Term>,
    /// Residual beyond the noise, root mean square.
    pub rest_um: f64,
    /// The shape of the residual, if it has one.
    pub other: Option<OtherShape>,
    /// The shape of another residual beside it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub second: Option<OtherShape>,
    /// The largest swing of X and of Y in µm, if the axis sticks and slips.
    pub stick_slip_um: [Option<f64>; 2],
    /// Remainders of slow peaks beyond their reversals.
    #[serde(skip)]
    pub(crate) tails: Tails,
}

impl CircleEvidence {
    /// Returns the evidence in the paths; `None` if the masked reversals leave too little of a turn.
    pub(crate) fn of<'a>(
        paths: impl Iterator<Item = (Direction, &'a RadialProfile)>,
        quality: Quality,
    ) -> Option<Self> {
        let paths: Vec<(Direction, &RadialProfile)> = paths.collect();
        let in_steps = |steps: PathSteps, mask: Mask| {
            let paths = paths.iter();
            let series =
                paths.map(|&(direction, profile)| steps(profile, direction, quality.samples, mask));
            series.collect::<Option<Vec<AngleSeries>>>()
        };
        let mut mask = Mask::Reversals;
        let mut coarse = in_steps(AngleSeries::coarse, mask)?;
        let rough = in_steps(AngleSeries::rough, mask)?;
        let noise_um = quality.noise_um;
        let mut shapes = tail_search::fit(&paths, (&coarse, &rough), noise_um)?;
        if shapes.added() == Additions::default() {
            mask = Mask::ReversalsAndSlowing;
            coarse = in_steps(AngleSeries::coarse, mask)?;
            shapes = Shapes::fit(&coarse, Additions::default())?;
        }
        let fine = in_steps(AngleSeries::fine, mask)?;
        let without = Shapes::fit(&coarse, Additions::default())?;
        let floor = (REST_OF_NOISE * noise_um)
            .max(LEAST_REST_UM)
            .max(REST_OF_STEP * quality.step_um);
        let limits = RestLimits { noise_um, floor };
        let Explained {
            shapes,
            rest_um,
            others: [other, second],
        } = explained(shapes, (&coarse, &fine), limits)?;
        let is_named = |it: OtherShape| it != OtherShape::Unknown;
        let is_explained = other.is_some_and(is_named);
        let stick_slip_um =
            PlaneAxis::ALL.map(|axis| stick_slip(&paths, axis, noise_um).filter(|_| !is_explained));
        let shapes = shapes.doubted(&without);
        let tails = shapes.tails();
        let mut terms = shapes.terms;
        terms.extend(
            paths
                .iter()
                .filter_map(|(_, path)| path.quality()?.drift)
                .flat_map(drifts),
        );
        Some(Self {
            noise_um,
            terms,
            rest_um,
            other,
            second,
            stick_slip_um,
            tails,
        })
    }

    /// Returns the shapes of the residual.
    pub(crate) fn others(&self) -> impl Iterator<Item = OtherShape> {
        [self.other, self.second].into_iter().flatten()
    }

    /// Returns whether there is a residual that noise does not explain.
    pub fn has_other_shape(&self) -> bool {
        self.other.is_some()
    }
}

/// A path in steps of some length.
type PathSteps = fn(&RadialProfile, Direction, usize, Mask) -> Option<AngleSeries>;

/// Limits above which a remainder counts as a residual.
#[derive(Debug, Clone, Copy)]
struct RestLimits {
    noise_um: f64,
    /// The least residual that has a shape.
    floor: f64,
}

/// Shapes, with the screws that explain what others leave.
struct Explained {
    shapes: Shapes,
    rest_um: f64,
    others: [Option<OtherShape>; 2],
}

/// Explains what shapes leave: by one or two screws, by an oscillation, or not.
fn explained(
    mut shapes: Shapes,
    (coarse, fine): (&[AngleSeries], &[AngleSeries]),
    limits: RestLimits,
) -> Option<Explained> {
    let mut left = shapes.less(fine);
    let mut rest_um = rest(&shapes, &left, limits.noise_um);
    let at_first = rest_um;
    let mut unexplained = None;
    while rest_um > limits.floor.max(REMAINS * at_first) {
        let least = EXPLAINS * rest_um * rest_um;
        let oscillation = Oscillation::search(&shapes.left, &left);
        let oscillation = oscillation.filter(|it| it.explains > least);
        let beaten = oscillation.map_or(least, |it| it.explains);
        let mut added = shapes.added();
        let free = added.screws.iter().position(Option::is_none);
        let periodic = pitch::search(&shapes).filter(|it| it.explains() > beaten);
        let (Some(periodic), Some(free)) = (periodic, free) else {
            unexplained =
                Some(
                    oscillation.map_or(OtherShape::Unknown, |it| OtherShape::Vibration {
                        hertz: it.hertz,
                        amplitude_um: it.amplitude_um,
                    }),
                );
            break;
        };
        added.screws[free] = Some(periodic.screw);
        shapes = Shapes::fit(coarse, added)?;
        left = shapes.less(fine);
        rest_um = rest(&shapes, &left, limits.noise_um);
    }
    let screws = shapes.added().screws.into_iter().enumerate();
    let mut others = screws.filter_map(|(number, screw)| {
        screw.map(|screw| OtherShape::Periodic {
            axis: screw.axis,
            pitch_mm: 1.0 / screw.frequency,
            amplitude_um: shapes.amplitude_um(number),
        })
    });
    let mut others = [others.next(), others.next()];
    if let (Some(unexplained), Some(free)) =
        (unexplained, others.iter_mut().find(|it| it.is_none()))
    {
        *free = Some(unexplained);
    }
    Some(Explained {
        shapes,
        rest_um,
        others,
    })
}

/// Returns the residual that neither shapes nor noise explain: of the coarse steps, in which noise is smaller, or of
/// the fine ones, in which a fast oscillation is visible.
fn rest(shapes: &Shapes, fine: &[AngleSeries], noise_um: f64) -> f64 {
    beyond_noise(&shapes.left, noise_um).max(beyond_noise(fine, noise_um))
}

/// Returns the shift of each axis in µm per turn.
fn drifts(drift: CircleDrift) -> [Term; 2] {
    const UM_PER_MM: f64 = 1000.0;
    let sizes = drift.per_turn_mm.into_iter().zip(drift.error_mm);
    let mut terms = PlaneAxis::ALL
        .into_iter()
        .zip(sizes)
        .map(|(axis, (size, error))| Term {
            shape: ShapeTerm::Drift(axis),
            size_um: size * UM_PER_MM,
            error_um: error * UM_PER_MM,
        });
    std::array::from_fn(|_| terms.next().expect("two axes"))
}
