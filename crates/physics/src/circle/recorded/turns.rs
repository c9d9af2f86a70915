//! The whole turns of a recorded circle in addition to the evaluated one (R5.26).

use std::fmt;

use serde::Serialize;

use super::circle::RecordedCircle;
use crate::circle::figures::Waveform;
use crate::circle::geometry::Crossing;
use crate::circle::geometry::Direction;
use crate::circle::geometry::RadialProfile;

/// Part of its glitch by which a turn has to be worse than another one …
const WORSE: f64 = 0.25;

/// … and the difference in µm.
const WORSE_UM: f64 = 0.5;

/// The whole turns of a recorded circle: at least two, without its first and last eighth of a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WholeTurns {
    /// Number of whole turns.
    pub count: usize,
    /// The one that leaves most, if one leaves more than the evaluated turn: by a quarter, by 0.5 µm and by
    /// the noise of a sample.
    pub worse: Option<WorseTurn>,
}

/// A turn that leaves more at a crossing than the evaluated one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WorseTurn {
    /// Direction of travel.
    pub direction: Direction,
    /// The crossing.
    pub crossing: Crossing,
    /// The glitch there, as means over 8 ms.
    #[serde(rename = "height")]
    pub height_um: f64,
    /// Glitch of the evaluated turn.
    #[serde(rename = "evaluated")]
    pub evaluated_um: f64,
}

impl fmt::Display for WorseTurn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "at {} one turn {} leaves {:.1} \u{b5}m, and the evaluated one {:.1} \u{b5}m",
            self.crossing, self.direction, self.height_um, self.evaluated_um
        )
    }
}

impl RecordedCircle {
    /// Returns the distance of each point from the centre of its turn in mm, of all whole turns one after another.
    pub fn radii_mm(&self) -> Vec<f64> {
        const MM_PER_M: f64 = 1000.0;
        let points = self.turns_m.iter().flatten();
        points.map(|[x, y]| x.hypot(*y) * MM_PER_M).collect()
    }

    /// Compares the whole turns with the evaluated one, as means over 8 ms at each crossing. `None` if there
    /// are not two, or no glitches and times to compare.
    pub fn whole_turns(&self) -> Option<WholeTurns> {
        let noise_um = self.profile.quality().map_or(0.0, |it| it.noise_um);
        let evaluated = heights_um(&self.profile, self.direction)?;
        let mut worse: Option<WorseTurn> = None;
        let mut count = 0;
        for points in &self.turns_m {
            let profile = self.profile_of(points);
            let Some(heights) = profile.and_then(|it| heights_um(&it, self.direction)) else {
                continue;
            };
            count += 1;
            for (crossing, (height_um, evaluated_um)) in Crossing::ALL
                .into_iter()
                .zip(heights.into_iter().zip(evaluated))
            {
                let least = (WORSE * evaluated_um).max(WORSE_UM).max(noise_um);
                let is_worst = worse.is_none_or(|it| height_um > it.height_um);
                if height_um > evaluated_um + least && is_worst {
                    worse = Some(WorseTurn {
                        direction: self.direction,
                        crossing,
                        height_um,
                        evaluated_um,
                    });
                }
            }
        }
        (count > 1).then_some(WholeTurns { count, worse })
    }
}

fn heights_um(profile: &RadialProfile, direction: Direction) -> Option<[f64; 4]> {
    let crossings = Waveform::at_crossings(profile, direction)?;
    Some(crossings.map(|it| it.height_um()))
}
