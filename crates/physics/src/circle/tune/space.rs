//! The parameters of a search: those of value lists, and those of stiction compensation.

use super::candidate::Candidate;
use super::ranges::Ranges;

/// Candidates with their neighbours.
pub(super) trait Space {
    /// A set of parameters.
    type Candidate: Copy + Ord;

    /// Sizes of steps between neighbours, the largest first.
    const STEPS: usize;

    /// Candidates all over the space.
    fn grid(&self) -> Vec<Self::Candidate>;

    /// Returns the candidates around one, at a step of the size with this number.
    fn neighbours(&self, centre: Self::Candidate, step: usize) -> Vec<Self::Candidate>;

    /// Returns the candidate to take if none is known.
    fn start(&self) -> Self::Candidate;
}

/// The parameters of a value list whose table is given.
#[derive(Debug, Clone)]
pub(super) struct Lists(pub(super) Ranges);

/// Steps between lists: `position_delay` as a part of its value, at least one unit, and the scaling
/// factor.
const LIST_STEPS: [(f64, i16); 5] = [(0.5, 80), (0.3, 40), (0.15, 20), (0.08, 10), (0.0, 5)];

impl Lists {
    fn contain(&self, candidate: &Candidate) -> bool {
        let ranges = &self.0;
        ranges.position_delay.contains(&candidate.position_delay)
            && ranges
                .reversal_lookahead
                .contains(&candidate.reversal_lookahead)
            && ranges.delay_cycles.contains(&candidate.delay_cycles)
            && ranges.scaling_factor.contains(&candidate.scaling_factor)
    }
}

impl Space for Lists {
    type Candidate = Candidate;

    const STEPS: usize = LIST_STEPS.len();

    fn grid(&self) -> Vec<Candidate> {
        let distances = [0, 4, 9, 20, 45, 90, 200, 500];
        let mut grid = Vec::new();
        for position_delay in distances {
            for reversal_lookahead in [0, 2, 4] {
                for delay_cycles in [0, 1, 2, 4] {
                    grid.push(Candidate {
                        position_delay,
                        reversal_lookahead,
                        delay_cycles,
                        scaling_factor: 1000,
                    });
                }
            }
        }
        grid.retain(|candidate| self.contain(candidate));
        grid
    }

    fn neighbours(&self, centre: Candidate, step: usize) -> Vec<Candidate> {
        let (part, scaling) = LIST_STEPS[step];
        let distance = (f64::from(centre.position_delay) * part).round();
        #[allow(clippy::cast_possible_truncation)] // at most half of a position_delay
        let distance = (distance as i32).max(1);
        let mut found = Vec::new();
        for p in [-1, 0, 1] {
            for l in [-1, 0, 1] {
                for d in [-1, 0, 1] {
                    for s in [-1, 0, 1] {
                        found.push(Candidate {
                            position_delay: centre.position_delay.saturating_add(p * distance),
                            reversal_lookahead: centre.reversal_lookahead.saturating_add_signed(l),
                            delay_cycles: centre.delay_cycles.saturating_add(d),
                            scaling_factor: centre.scaling_factor.saturating_add(s * scaling),
                        });
                    }
                }
            }
        }
        found.retain(|candidate| self.contain(candidate));
        found
    }

    fn start(&self) -> Candidate {
        let ranges = &self.0;
        Candidate {
            position_delay: *ranges.position_delay.start(),
            reversal_lookahead: *ranges.reversal_lookahead.start(),
            delay_cycles: *ranges.delay_cycles.start(),
            scaling_factor: 1000,
        }
    }
}

/// MP1511 in µs and MP1512 in counting steps.
#[derive(Debug, Clone)]
pub(super) struct Stictions(pub(super) Ranges);

/// Places of the grid along each parameter.
const PLACES: u32 = 5;

/// Steps between them as parts of a step of the grid: 1/2, 1/4 …
const HALVES: usize = 5;

impl Space for Stictions {
    type Candidate = (u32, u32);

    const STEPS: usize = HALVES;

    fn grid(&self) -> Vec<(u32, u32)> {
        let places = |from: u32, to: u32| {
            (0..=PLACES).map(move |at| from + to.saturating_sub(from) * at / PLACES)
        };
        let Ranges { mp1511, mp1512, .. } = &self.0;
        let factors = places(*mp1511.start(), *mp1511.end());
        let limits = || places(*mp1512.start(), *mp1512.end());
        factors
            .flat_map(|factor| limits().map(move |limit| (factor, limit)))
            .collect()
    }

    fn neighbours(&self, (factor, limit): (u32, u32), step: usize) -> Vec<(u32, u32)> {
        let Ranges { mp1511, mp1512, .. } = &self.0;
        let around = |centre: u32, range: &std::ops::RangeInclusive<u32>| {
            let whole = range.end().saturating_sub(*range.start());
            let step = ((whole / PLACES) >> (step + 1)).max(1);
            let [from, to] = [*range.start(), *range.end()];
            [centre.saturating_sub(step), centre, centre + step].map(|it| it.clamp(from, to))
        };
        let limits = around(limit, mp1512);
        around(factor, mp1511)
            .into_iter()
            .flat_map(|factor| limits.map(|limit| (factor, limit)))
            .collect()
    }

    fn start(&self) -> (u32, u32) {
        (*self.0.mp1511.start(), *self.0.mp1512.start())
    }
}
