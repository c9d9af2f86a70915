//! Velocities around zero without a motion: measured or rounded values toggle while an axis is at rest.

use super::units::POSITION_UNITS_PER_MM;
use frictcomp::diagnostic::ReadableNumber;

/// Velocities that count as standstill.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum DeadBand {
    /// Velocities between two changes of direction that are at most 5 cycles and less than 1 µm apart.
    #[default]
    Toggling,
    /// Velocities up to this one, in µm/s or 0.001°/s.
    Below(f64),
}

/// Samples that count as standstill although the velocity was not 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Standstills {
    /// Number of samples.
    pub count: u64,
    /// Number of cycles.
    pub cycles: u64,
}

impl Standstills {
    /// Returns the rule of standstill in a sentence.
    pub(super) fn told(self, band: DeadBand) -> Option<String> {
        let Self { count, cycles } = self;
        let what = match band {
            DeadBand::Toggling => "in which the velocity only toggles around zero".to_owned(),
            DeadBand::Below(limit) => format!("with a velocity up to {}", ReadableNumber(limit)),
        };
        (count > 0).then(|| {
            let stretches = if count == 1 { "stretch" } else { "stretches" };
            format!("{count} {stretches} {what}, {cycles} cycles, count as standstill")
        })
    }
}

/// Largest number of cycles between two changes of direction that count as toggling.
const CYCLES: usize = 5;

/// Largest distance between them, 1 µm or 0.001° in units of 0.1 µm or 0.0001°.
const DISTANCE: f64 = POSITION_UNITS_PER_MM / 1000.0;

impl DeadBand {
    /// Sets velocities that count as standstill to 0.
    pub(super) fn settle(self, velocities: &mut [f64], positions: &[f64]) -> Standstills {
        let mut found = Standstills::default();
        match self {
            Self::Below(limit) => {
                let mut stands = false;
                for velocity in velocities {
                    let is_small = velocity.abs() <= limit;
                    if is_small && *velocity != 0.0 {
                        found.cycles += 1;
                        found.count += u64::from(!stands);
                        *velocity = 0.0;
                        stands = true;
                    } else if !is_small {
                        stands = false;
                    }
                }
            }
            Self::Toggling => {
                for (from, to) in toggling(velocities, positions) {
                    let moving = velocities[from..to].iter_mut().filter(|it| **it != 0.0);
                    found.count += 1;
                    for velocity in moving {
                        *velocity = 0.0;
                        found.cycles += 1;
                    }
                }
            }
        }
        found
    }
}

/// Returns the beginnings of motion in another direction, the first included, and the end.
fn changes(velocities: &[f64]) -> Vec<usize> {
    let mut direction = 0.0;
    let mut changes = Vec::new();
    for (at, velocity) in velocities.iter().enumerate() {
        if *velocity != 0.0 && velocity * direction <= 0.0 {
            direction = velocity.signum();
            changes.push(at);
        }
    }
    changes.push(velocities.len());
    changes
}

/// Returns the stretches in which the direction only toggles.
fn toggling(velocities: &[f64], positions: &[f64]) -> Vec<(usize, usize)> {
    let changes = changes(velocities);
    let is_short = |pair: &[usize]| {
        let (from, to) = (pair[0], pair[1]);
        let way = &positions[from.saturating_sub(1)..to];
        let (low, high) = way
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(*x), high.max(*x))
            });
        to - from <= CYCLES && high - low < DISTANCE
    };
    let short: Vec<bool> = changes.windows(2).map(is_short).collect();
    let fastest = |at: usize| {
        let stretch = &velocities[changes[at]..changes[at + 1]];
        stretch.iter().fold(0.0_f64, |most, v| most.max(v.abs()))
    };
    let last = short.len().saturating_sub(1);
    let is_inner = |at: usize| at > 0 && at < last && short[at];
    // The first and the last stretch have only one change of direction: they toggle if they are no faster
    // than the toggling stretches next to them.
    let is_like = |at: usize, beside: usize| {
        short[at] && is_inner(beside) && fastest(at) <= 2.0 * fastest(beside)
    };
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (at, pair) in changes.windows(2).enumerate() {
        let toggles = match at {
            0 => is_like(0, 1),
            at if at == last => is_like(at, at - 1),
            at => is_inner(at),
        };
        if !toggles {
            continue;
        }
        match found.last_mut() {
            Some(before) if before.1 == pair[0] => before.1 = pair[1],
            _ => found.push((pair[0], pair[1])),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocities in µm/s after settling, at 1 ms per cycle.
    fn settled(band: DeadBand, velocities: &[f64]) -> (Vec<f64>, Standstills) {
        let mut x = 0.0;
        let positions = velocities.iter().map(|v| {
            x += v * 0.01;
            x
        });
        let positions: Vec<f64> = positions.collect();
        let mut velocities = velocities.to_vec();
        let found = band.settle(&mut velocities, &positions);
        (velocities, found)
    }

    fn found(count: u64, cycles: u64) -> Standstills {
        Standstills { count, cycles }
    }

    #[test]
    fn velocities_that_only_toggle_are_one_standstill() {
        // R4.6
        let v = [500.0, 100.0, -1.0, 1.0, 0.0, -1.0, 2.0, -1.0, -500.0];
        let (now, told) = settled(DeadBand::Toggling, &v);
        assert_eq!(now, [500.0, 100.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, -500.0]);
        assert_eq!(told, found(1, 4));
        // A reversal is not toggling, nor is a change that takes more than five cycles or a micrometre.
        for v in [
            &[500.0, 1.0, -1.0, -500.0][..],
            &[5.0, 5.0, -5.0, -5.0, -5.0, -5.0, -5.0, -5.0, 5.0, 5.0],
            &[9000.0, 9000.0, -9000.0, 9000.0, 9000.0],
        ] {
            let (now, told) = settled(DeadBand::Toggling, v);
            assert_eq!((now, told), (v.to_vec(), found(0, 0)));
        }
        // From the first cycle to the last.
        let (now, told) = settled(DeadBand::Toggling, &[1.0, -1.0, 1.0, -1.0]);
        assert_eq!((now, told), (vec![0.0; 4], found(1, 4)));
        assert_eq!(settled(DeadBand::Toggling, &[]).1, found(0, 0));
        assert_eq!(settled(DeadBand::Toggling, &[1.0, -1.0]).1, found(0, 0));
    }

    #[test]
    fn a_dead_band_is_a_velocity() {
        // R4.6
        let v = [5.0, 0.0, -5.0, 20.0, 4.0];
        let (now, told) = settled(DeadBand::Below(5.0), &v);
        assert_eq!((now, told), (vec![0.0, 0.0, 0.0, 20.0, 0.0], found(2, 3)));
        assert_eq!(settled(DeadBand::Below(0.0), &v).0, v);
    }
}
