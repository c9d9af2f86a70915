//! The figures of ISO 230-4 for a pair of paths, and the glitches at the quadrants.

use serde::Serialize;

use super::glitch::PathShape;
use crate::circle::evidence::CircleEvidence;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PathCentre;
use crate::circle::geometry::{Quality, RadialProfile, UM_PER_M};
use crate::circle::geometry::{least_squares, minimum_zone, zone_about};

/// The figures of one path (R5.21), named by the symbols of ISO 230-4.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PathFigures {
    /// Circular deviation G about the centre of the minimum zone.
    #[serde(rename = "G_mz")]
    pub g_mz_um: f64,
    /// Circular deviation G about the centre of the least-squares circle.
    #[serde(rename = "G_lsc")]
    pub g_lsc_um: f64,
    /// Largest radial deviation, Fmax; only against a commanded radius.
    #[serde(rename = "F_max")]
    pub f_max_um: Option<f64>,
    /// Smallest radial deviation, Fmin; only against a commanded radius.
    #[serde(rename = "F_min")]
    pub f_min_um: Option<f64>,
    /// Mean radial deviation of this path: its least-squares radius less the commanded one.
    #[serde(rename = "D")]
    pub d_um: Option<f64>,
    /// Shape of the path at its crossings; `None` if the windows of the glitches reach the next
    /// crossing.
    pub shape: Option<PathShape>,
}

/// The figures of the paths in both directions (R5.21).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Figures {
    /// Figures of the counter-clockwise path.
    pub ccw: Option<PathFigures>,
    /// Figures of the clockwise path.
    pub cw: Option<PathFigures>,
    /// The centre that G(b) and H refer to.
    pub centre: PathCentre,
    /// Distance between the least-squares centres of both paths.
    #[serde(rename = "centre_distance")]
    pub centre_distance_um: Option<f64>,
    /// Bidirectional circular deviation G(b): from the innermost to the outermost point of both
    /// paths together.
    #[serde(rename = "g_b")]
    pub g_b_um: Option<f64>,
    /// Circular hysteresis H: the largest radial distance of the two paths at one angle.
    #[serde(rename = "h")]
    pub h_um: Option<f64>,
    /// Mean bidirectional radial deviation D.
    #[serde(rename = "d")]
    pub d_um: Option<f64>,
    /// Evidence in a recording beyond these figures; `None` for simulated paths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evidence: Option<CircleEvidence>,
}

/// The profiles of the paths in both directions.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Paths {
    /// The counter-clockwise path.
    pub ccw: Option<RadialProfile>,
    /// The clockwise path.
    pub cw: Option<RadialProfile>,
}

impl Paths {
    /// Returns the profile of one direction.
    pub fn get(&self, direction: Direction) -> Option<&RadialProfile> {
        match direction {
            Direction::Ccw => self.ccw.as_ref(),
            Direction::Cw => self.cw.as_ref(),
        }
    }

    /// Keeps the profile of one direction.
    pub(crate) fn set(&mut self, direction: Direction, profile: RadialProfile) {
        match direction {
            Direction::Ccw => self.ccw = Some(profile),
            Direction::Cw => self.cw = Some(profile),
        }
    }

    /// Returns the quality of recorded paths, that of the worse one.
    fn quality(&self) -> Option<Quality> {
        let qualities: Vec<Quality> = self
            .iter()
            .map(|(_, profile)| profile.quality())
            .collect::<Option<_>>()?;
        qualities.into_iter().reduce(|one, other| Quality {
            noise_um: one.noise_um.max(other.noise_um),
            step_um: one.step_um.max(other.step_um),
            samples: one.samples.min(other.samples),
            drift: None,
        })
    }

    /// Returns the directions whose paths exist.
    pub fn iter(&self) -> impl Iterator<Item = (Direction, &RadialProfile)> {
        Direction::ALL
            .into_iter()
            .filter_map(|direction| Some((direction, self.get(direction)?)))
    }
}

/// The radius that the radial deviations F and D refer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Nominal {
    /// The commanded centre.
    Commanded,
    /// A fitted centre; F and D have no meaning.
    Fitted,
}

impl Figures {
    /// Returns the figures of one or two paths, those of both about a centre.
    pub(crate) fn of(paths: &Paths, nominal: Nominal, centre: PathCentre) -> Self {
        let quality = paths.quality();
        let evidence = quality.and_then(|it| CircleEvidence::of(paths.iter(), it));
        let one = |direction| {
            let profile = paths.get(direction)?;
            let mut figures = PathFigures::of(profile, nominal);
            let tails = evidence.as_ref().map(|it| it.tails).unwrap_or_default();
            figures.shape = PathShape::of(profile, direction, tails);
            if let (Some(shape), Some(evidence)) = (&mut figures.shape, &evidence) {
                shape.take_terms(direction, &evidence.terms);
            }
            Some(figures)
        };
        let (ccw, cw) = (one(Direction::Ccw), one(Direction::Cw));
        let both = paths.ccw.as_ref().zip(paths.cw.as_ref());
        let both = both.map(|(ccw, cw)| Bidirectional::of([ccw, cw], centre));
        let ds = ccw
            .as_ref()
            .and_then(|it| it.d_um)
            .zip(cw.as_ref().and_then(|it| it.d_um));
        Self {
            centre,
            centre_distance_um: both.map(|it| it.distance * UM_PER_M),
            g_b_um: both.map(|it| it.deviation * UM_PER_M),
            h_um: both.map(|it| it.hysteresis * UM_PER_M),
            d_um: ds.map(|(ccw, cw)| f64::midpoint(ccw, cw)),
            evidence,
            ccw,
            cw,
        }
    }

    /// Returns the figures of one direction.
    pub fn get(&self, direction: Direction) -> Option<&PathFigures> {
        match direction {
            Direction::Ccw => self.ccw.as_ref(),
            Direction::Cw => self.cw.as_ref(),
        }
    }

    /// Returns the largest glitch of all crossings and directions; `None` if no crossing has one.
    pub fn glitch_max_um(&self) -> Option<f64> {
        let paths = [&self.ccw, &self.cw].into_iter().flatten();
        let glitches = paths
            .filter_map(|path| path.shape.as_ref())
            .flat_map(|shape| shape.glitches.iter().map(|glitch| glitch.height_um));
        glitches.reduce(f64::max)
    }
}

impl PathFigures {
    fn of(profile: &RadialProfile, nominal: Nominal) -> Self {
        let (centre, radius) = least_squares(profile);
        let outer = profile.outer().map(|point| point.deviation);
        let inner = profile.inner().map(|point| point.deviation);
        let against = |value: f64| match nominal {
            Nominal::Commanded => Some(value * UM_PER_M),
            Nominal::Fitted => None,
        };
        Self {
            g_mz_um: minimum_zone(&[profile]).width * UM_PER_M,
            g_lsc_um: zone_about(&[profile], centre) * UM_PER_M,
            f_max_um: against(outer.fold(f64::MIN, f64::max)),
            f_min_um: against(inner.fold(f64::MAX, f64::min)),
            d_um: against(radius),
            shape: None,
        }
    }
}

/// Bidirectional figures of both paths (R5.21), in m.
#[derive(Debug, Clone, Copy)]
struct Bidirectional {
    /// Between the least-squares centres.
    distance: f64,
    /// Bidirectional deviation of both paths together, G(b).
    deviation: f64,
    /// The largest difference at one angle, H.
    hysteresis: f64,
}

impl Bidirectional {
    fn of(paths: [&RadialProfile; 2], centre: PathCentre) -> Self {
        let own = paths.map(|path| {
            let ([x, y], _) = least_squares(path);
            [path.origin()[0] + x, path.origin()[1] + y]
        });
        let [ccw, cw] = own;
        let common = [0, 1].map(|axis| f64::midpoint(ccw[axis], cw[axis]));
        let about = match centre {
            PathCentre::Common => [common; 2],
            PathCentre::Own => own,
        };
        let seen = [0, 1].map(|path: usize| paths[path].about(about[path]));
        let [ccw_path, cw_path] = &seen;
        Self {
            distance: (ccw[0] - cw[0]).hypot(ccw[1] - cw[1]),
            deviation: zone_about(&[ccw_path, cw_path], [0.0; 2]),
            hysteresis: hysteresis(ccw_path, cw_path),
        }
    }
}

/// Returns the largest difference of two paths at the fixed angles, in m.
fn hysteresis(ccw: &RadialProfile, cw: &RadialProfile) -> f64 {
    let pairs = ccw.deviations_m().iter().zip(cw.deviations_m());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
