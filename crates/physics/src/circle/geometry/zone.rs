//! Centres: of the least-squares circle and of the minimum zone.

use super::profile::{ProfilePoint, RadialProfile};

/// Maximum number of rounds of the exchange; a handful is needed.
const ROUNDS: usize = 60;

/// A zone whose width is known to this many metres is accurate enough: a millionth of a µm.
const TOLERANCE: f64 = 1e-12;

/// Steps of each nested search.
const SEARCH: u32 = 48;

/// A ring between two concentric circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Zone {
    /// The centre in m.
    pub(crate) centre: [f64; 2],
    /// The difference of the radii in m.
    pub(crate) width: f64,
}

/// Returns the least-squares circle of the deviations at the fixed angles: its centre, and its radius as a deviation
/// from the radius of the profile, all in m. As the centre is moved by micrometres in a circle of millimetres, r = R +
/// a·cos φ + b·sin φ is exact to far below a nanometre, and over whole turns of even angles the sums are the Fourier
/// coefficients.
pub(crate) fn least_squares(profile: &RadialProfile) -> ([f64; 2], f64) {
    #[allow(clippy::cast_precision_loss)] // 36000
    let count = profile.deviations_m().len() as f64;
    let (mut a, mut b, mut mean) = (0.0, 0.0, 0.0);
    for (at, deviation) in profile.deviations_m().iter().enumerate() {
        #[allow(clippy::cast_precision_loss)] // 36000
        let (sin, cos) = (at as f64 / count * std::f64::consts::TAU).sin_cos();
        a += deviation * cos;
        b += deviation * sin;
        mean += deviation;
    }
    ([2.0 * a / count, 2.0 * b / count], mean / count)
}

/// Returns the width in m of the zone about a centre that holds every point of the profiles.
pub(crate) fn zone_about(profiles: &[&RadialProfile], centre: [f64; 2]) -> f64 {
    let [outer, inner] = extremes(profiles, centre);
    outer.map_or(0.0, |it| it.1) - inner.map_or(0.0, |it| it.1)
}

/// Returns the minimum zone of the profiles: two concentric circles as close as possible that hold every point between
/// them. All profiles have the same radius.
///
/// The width is a convex function of the centre (to the square of the shift over the radius). The
/// search is an exchange: the best centre for a few points, then the two points that stick out
/// farthest there join them. The width for the few is never more than that for all, so the
/// difference of both bounds the error.
pub(crate) fn minimum_zone(profiles: &[&RadialProfile]) -> Zone {
    let mut centre = [0.0; 2];
    let mut best = Zone {
        centre,
        width: f64::INFINITY,
    };
    let Some(first) = profiles.first() else {
        return Zone { centre, width: 0.0 };
    };
    let mut few = Few {
        radius: first.radius_m(),
        outer: Vec::new(),
        inner: Vec::new(),
    };
    let mut reach = zone_about(profiles, centre);
    for _ in 0..ROUNDS {
        let [Some(outer), Some(inner)] = extremes(profiles, centre) else {
            return Zone { centre, width: 0.0 };
        };
        let width = outer.1 - inner.1;
        if width < best.width {
            best = Zone { centre, width };
        }
        few.outer.push(outer.0);
        few.inner.push(inner.0);
        reach = reach.max(width);
        centre = few.search(2.0 * reach);
        if few.width(centre) > best.width - TOLERANCE {
            break;
        }
    }
    best
}

/// Returns the points that stick out farthest and least as seen from a centre, with their deviations.
fn extremes(profiles: &[&RadialProfile], centre: [f64; 2]) -> [Option<(ProfilePoint, f64)>; 2] {
    let mut found = [None::<(ProfilePoint, f64)>; 2];
    for profile in profiles {
        for &point in profile.outer() {
            let deviation = seen_from(centre, profile.radius_m(), point);
            if found[0].is_none_or(|(_, most)| deviation > most) {
                found[0] = Some((point, deviation));
            }
        }
        for &point in profile.inner() {
            let deviation = seen_from(centre, profile.radius_m(), point);
            if found[1].is_none_or(|(_, least)| deviation < least) {
                found[1] = Some((point, deviation));
            }
        }
    }
    found
}

/// Returns the radial deviation of a point as seen from another centre.
fn seen_from(centre: [f64; 2], radius: f64, point: ProfilePoint) -> f64 {
    let along = centre[0] * point.cos + centre[1] * point.sin;
    let across = centre[1] * point.cos - centre[0] * point.sin;
    let distance = radius + point.deviation;
    // sqrt((d - along)² + across²) - R without the loss of digits.
    point.deviation - along + across * across / (2.0 * distance.max(f64::MIN_POSITIVE))
}

/// The points that the exchange has gathered.
struct Few {
    radius: f64,
    outer: Vec<ProfilePoint>,
    inner: Vec<ProfilePoint>,
}

impl Few {
    fn width(&self, centre: [f64; 2]) -> f64 {
        let seen = |&point: &ProfilePoint| seen_from(centre, self.radius, point);
        let outer = self.outer.iter().map(seen).fold(f64::MIN, f64::max);
        let inner = self.inner.iter().map(seen).fold(f64::MAX, f64::min);
        outer - inner
    }

    /// Returns the best centre for these points not farther than `reach` from the origin in x and y.
    fn search(&self, reach: f64) -> [f64; 2] {
        let row = |x: f64| golden(reach, |y| self.width([x, y]));
        let x = golden(reach, |x| row(x).1).0;
        [x, row(x).0]
    }
}

/// Returns the place of the least value of a convex function between -reach and reach, and that value.
fn golden(reach: f64, function: impl Fn(f64) -> f64) -> (f64, f64) {
    const PART: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (-reach, reach);
    let mut inner = [high - PART * (high - low), low + PART * (high - low)];
    let mut values = inner.map(&function);
    for _ in 0..SEARCH {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - PART * (high - low), inner[0]];
            values = [function(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + PART * (high - low)];
            values = [values[1], function(inner[1])];
        }
    }
    let best = usize::from(values[1] < values[0]);
    (inner[best], values[best])
}
