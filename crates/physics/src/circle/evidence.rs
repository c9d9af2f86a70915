//! The evidence in a recorded path: its noise, shapes with their standard errors, and the residual
//! (R5.28).

use serde::Serialize;

use super::crossing::PlaneAxis;
use super::direction::Direction;
use super::drift::Drift;
use super::evidence_shape::OtherShape;
use super::linear::Normal;
use super::profile::{Quality, RadialProfile};
use super::residual::{Series, other_shape};
use super::swings::stick_slip;
use super::turning::Turning;

/// A term is noticeable from so many standard errors on …
const SIGNIFICANT: f64 = 3.0;

/// … and from this size on, in µm.
const LEAST_TERM_UM: f64 = 0.5;

/// Least residual in µm that counts as a shape …
const LEAST_REST_UM: f64 = 0.15;

/// … and from this part of the noise on …
const REST_OF_NOISE: f64 = 0.3;

/// … and from this part of a step of the encoder on.
const REST_OF_STEP: f64 = 0.5;

/// Rounds in which shapes and a periodic error are told apart.
const ROUNDS: usize = 3;

/// Evidence in a recording, with its limits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CircleEvidence {
    /// Standard deviation of the noise of single samples.
    pub noise_um: f64,
    /// The shapes that were fitted, named or not.
    pub terms: Vec<Term>,
    /// Residual beyond the noise, root mean square.
    pub rest_um: f64,
    /// The shape of what is left over, where it is one.
    pub other: Option<OtherShape>,
    /// The largest swing of X and of Y in µm, where the axis sticks and slips.
    pub stick_slip_um: [Option<f64>; 2],
}

/// A fitted shape with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Term {
    /// The shape.
    pub shape: ShapeTerm,
    /// Its size.
    pub size_um: f64,
    /// Its standard error.
    pub error_um: f64,
}

/// A shape that is fitted away from the reversals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ShapeTerm {
    /// A step outwards where an axis reverses.
    Backlash(PlaneAxis),
    /// A step sideways of an axis where the other one reverses.
    Play(PlaneAxis),
    /// An ellipse at 45° that turns with the direction.
    Gain,
    /// An ellipse at 45° that does not.
    Squareness,
    /// An ellipse along the axes.
    Scale,
    /// A shift of an axis from turn to turn.
    Drift(PlaneAxis),
}

impl Term {
    /// Whether the recording carries it.
    pub fn is_carried(&self) -> bool {
        self.size_um.abs() > (SIGNIFICANT * self.error_um).max(LEAST_TERM_UM)
    }
}

impl CircleEvidence {
    /// The evidence in the paths; `None` where the masked reversals leave too little of a turn.
    pub(super) fn of<'a>(
        paths: impl Iterator<Item = (Direction, &'a RadialProfile)>,
        quality: Quality,
    ) -> Option<Self> {
        let paths: Vec<(Direction, &RadialProfile)> = paths.collect();
        let series: Vec<Series> = paths
            .iter()
            .map(|&(direction, profile)| Series::of(profile, direction, quality.samples))
            .collect::<Option<_>>()?;
        let mut shapes = Shapes::fit(&series)?;
        let noise_um = quality.noise_um;
        let of_mean = noise_um * series.first()?.noise_share;
        let floor = (REST_OF_NOISE * noise_um)
            .max(LEAST_REST_UM)
            .max(REST_OF_STEP * quality.step_um);
        let rest = |shapes: &Shapes| (shapes.rms.powi(2) - of_mean.powi(2)).max(0.0).sqrt();
        let mut rest_um = rest(&shapes);
        let mut other = None;
        if rest_um > floor {
            let found = other_shape(&shapes.left, of_mean);
            if let Some(mut periodic) = found.periodic {
                for _ in 0..ROUNDS {
                    let without: Vec<Series> = series.iter().map(|it| it.less(&periodic)).collect();
                    shapes = Shapes::fit(&without)?;
                    let with: Vec<Series> =
                        shapes.left.iter().map(|it| it.plus(&periodic)).collect();
                    periodic = periodic.again(&with)?;
                }
                rest_um = rest(&shapes);
            }
            other = Some(found.shape());
        }
        let is_explained = matches!(
            other,
            Some(OtherShape::Periodic { .. } | OtherShape::Vibration { .. })
        );
        let stick_slip_um =
            PlaneAxis::ALL.map(|axis| stick_slip(&paths, axis, noise_um).filter(|_| !is_explained));
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
            stick_slip_um,
        })
    }

    /// Whether something is left over that noise does not explain.
    pub fn has_other_shape(&self) -> bool {
        self.other.is_some()
    }
}

/// Fitted shapes, and the paths less them.
struct Shapes {
    terms: Vec<Term>,
    left: Vec<Series>,
    rms: f64,
}

impl Shapes {
    fn fit(series: &[Series]) -> Option<Self> {
        if series.len() == 2 {
            let names = [
                (6, ShapeTerm::Scale, 2.0),
                (7, ShapeTerm::Squareness, 2.0),
                (8, ShapeTerm::Gain, 2.0),
                (9, ShapeTerm::Backlash(PlaneAxis::X), 1.0),
                (10, ShapeTerm::Backlash(PlaneAxis::Y), 1.0),
                (11, ShapeTerm::Play(PlaneAxis::X), 1.0),
                (12, ShapeTerm::Play(PlaneAxis::Y), 1.0),
            ];
            return Self::of::<13>(series, both_row, &names);
        }
        let names = [
            (5, ShapeTerm::Backlash(PlaneAxis::X), 1.0),
            (6, ShapeTerm::Backlash(PlaneAxis::Y), 1.0),
        ];
        Self::of::<7>(series, single_row, &names)
    }

    fn of<const N: usize>(
        series: &[Series],
        row: fn(Turning, Direction) -> [f64; N],
        names: &[(usize, ShapeTerm, f64)],
    ) -> Option<Self> {
        let mut normal = Normal::<N>::new();
        for one in series {
            for (angle, value) in one.samples() {
                normal.add(row(angle, one.direction), value);
            }
        }
        let spreads = normal.spreads()?;
        let found = normal.solve()?;
        let model = |angle: Turning, direction: Direction| -> f64 {
            let row = row(angle, direction);
            row.iter().zip(found).map(|(part, size)| part * size).sum()
        };
        let left: Vec<Series> = series
            .iter()
            .map(|one| one.map(|angle, value| value - model(angle, one.direction)))
            .collect();
        let (sum, count) = left
            .iter()
            .flat_map(Series::samples)
            .fold((0.0, 0.0), |(sum, count), (_, value)| {
                (sum + value * value, count + 1.0)
            });
        let of_blocks = left.iter().map(Series::block_variance).fold(0.0, f64::max);
        let terms = names.iter().map(|&(at, shape, factor)| Term {
            shape,
            size_um: factor * found[at],
            error_um: factor * (spreads[at] * of_blocks).sqrt(),
        });
        Some(Self {
            terms: terms.collect(),
            rms: (sum / f64::max(count, 1.0)).sqrt(),
            left,
        })
    }
}

/// The shift of each axis in µm a turn.
fn drifts(drift: Drift) -> [Term; 2] {
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

/// Steps where X and Y reverse: half of them against the direction of the axis.
fn steps(angle: Turning, turning: f64) -> [f64; 2] {
    [
        0.5 * turning * angle.sin.signum() * angle.cos,
        -0.5 * turning * angle.cos.signum() * angle.sin,
    ]
}

fn both_row(angle: Turning, direction: Direction) -> [f64; 13] {
    let Turning { cos, sin } = angle;
    let turning = direction.sign();
    let of = |which: f64| if turning * which > 0.0 { 1.0 } else { 0.0 };
    let [ccw, cw] = [of(1.0), of(-1.0)];
    let [x, y] = steps(angle, turning);
    let diagonal = 2.0 * cos * sin;
    [
        ccw,
        cw,
        ccw * cos,
        ccw * sin,
        cw * cos,
        cw * sin,
        cos * cos - sin * sin,
        diagonal,
        turning * diagonal,
        x,
        y,
        0.5 * turning * cos.abs(),
        -0.5 * turning * sin.abs(),
    ]
}

fn single_row(angle: Turning, direction: Direction) -> [f64; 7] {
    let Turning { cos, sin } = angle;
    let [x, y] = steps(angle, direction.sign());
    [1.0, cos, sin, cos * cos - sin * sin, 2.0 * cos * sin, x, y]
}
