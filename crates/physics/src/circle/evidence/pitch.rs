//! The pitch of a periodic error (R5.28).

use super::periodic::{Periodic, Screw};
use super::shapes::Shapes;
use crate::circle::geometry::CosineSine;
use crate::circle::geometry::PlaneAxis;

/// Pitches in mm.
const PITCHES: [f64; 2] = [1.0, 40.0];

/// Minimum number of turns of a screw within a radius.
const LEAST_TURNS: f64 = 0.5;

/// Number of turns within a radius below which a screw looks like other shapes.
const ALIKE_TURNS: f64 = 3.0;

/// Frequencies on either side of the best one among which the pitch is sharpened.
const FINE: i32 = 15;

/// The part of what a screw explains from which a third harmonic of the turn explains it, too: a guide that is
/// bent, not a screw.
const BENT: f64 = 0.9;

/// Returns the error of the pitch that explains most of what the shapes leave, in addition to them.
pub(crate) fn search(shapes: &Shapes) -> Option<Periodic> {
    let radius_mm = shapes.left.first()?.radius_mm;
    let [from, to] = [1.0 / PITCHES[1], 1.0 / PITCHES[0]];
    let step = 1.0 / (6.0 * radius_mm);
    let of = |screw: Screw| {
        let joint = shapes.joint(|angle, radius_mm| screw.columns(angle, radius_mm))?;
        Some(Periodic { screw, joint })
    };
    let mut best: Option<(Screw, f64)> = None;
    for axis in PlaneAxis::ALL {
        let mut frequency = from.max(LEAST_TURNS / radius_mm);
        while frequency <= to {
            let screw = Screw { axis, frequency };
            let explains = if frequency * radius_mm < ALIKE_TURNS {
                of(screw).map_or(0.0, |it| it.explains())
            } else {
                screw.explains(&shapes.left)
            };
            if best.is_none_or(|(_, most)| explains > most) {
                best = Some((screw, explains));
            }
            frequency += step;
        }
    }
    let (best, _) = best?;
    // Between the frequencies that were tried.
    let near = (-FINE..=FINE).filter_map(|at| {
        let frequency = best.frequency + f64::from(at) / f64::from(FINE) * step;
        of(Screw { frequency, ..best })
    });
    let found = near.max_by(|one, other| one.explains().total_cmp(&other.explains()))?;
    let guide = shapes.joint(|CosineSine { cos, sin }, _| [cos * sin * sin, sin * cos * cos]);
    let of_guide = guide.map_or(0.0, |it| it.explains);
    (of_guide < BENT * found.explains()).then_some(found)
}
