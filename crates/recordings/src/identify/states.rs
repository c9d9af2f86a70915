//! One axis in several states, for example cold and warm (R16.6).

use super::identified::Identified;

/// Part within which two speeds are the same.
const SAME: f64 = 0.05;

/// Friction of one axis in several states, at the speeds of the state that the list is for.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ComparedStates {
    /// Slowest first.
    pub rows: Vec<StateRow>,
}

/// The friction at one speed in each state.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct StateRow {
    /// The speed in mm/s or °/s.
    pub speed: f64,
    /// Friction and its standard error in drive units; `None` if a state has no such speed.
    pub frictions: Vec<Option<[f64; 2]>>,
    /// The largest less the smallest friction, as a part of that of the working state; `None` with one of
    /// them alone.
    pub spread: Option<f64>,
}

impl ComparedStates {
    /// Compares states at the speeds of the working one, which is given by its index.
    pub fn of(states: &[&Identified], working: usize) -> Self {
        let Some(reference) = states.get(working) else {
            return Self { rows: Vec::new() };
        };
        let row = |speed: f64| {
            let at_speed = |state: &&Identified| {
                let apart = |other: f64| (other - speed).abs();
                let pairs = state.pairs.iter();
                let nearest = pairs.min_by(|a, b| apart(a.speed).total_cmp(&apart(b.speed)))?;
                (apart(nearest.speed) <= SAME * speed).then_some([nearest.friction, nearest.error])
            };
            let frictions: Vec<_> = states.iter().map(at_speed).collect();
            let values = frictions.iter().flatten().map(|it| it[0]);
            let own = frictions.get(working).copied().flatten();
            let own = own.map(|it| it[0].abs()).filter(|it| *it > 0.0);
            let is_compared = frictions.iter().flatten().count() > 1;
            let most = values.clone().fold(f64::NEG_INFINITY, f64::max);
            let least = values.fold(f64::INFINITY, f64::min);
            let spread = own.filter(|_| is_compared).map(|own| (most - least) / own);
            StateRow {
                speed,
                frictions,
                spread,
            }
        };
        Self {
            rows: reference.pairs.iter().map(|pair| row(pair.speed)).collect(),
        }
    }

    /// Returns the row with the largest spread; `None` if no two states have a common speed.
    pub fn widest(&self) -> Option<&StateRow> {
        let spread = |row: &&StateRow| row.spread;
        let rows = self.rows.iter().filter(|row| spread(row).is_some());
        rows.max_by(|a, b| a.spread.unwrap_or(0.0).total_cmp(&b.spread.unwrap_or(0.0)))
    }
}
