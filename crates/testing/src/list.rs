//! The additive current of a value list, from the documents of the control.

use std::collections::HashMap;

/// A value list: current over speed, and its times.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueList {
    /// Speed in µm/s and current in drive units.
    pub points: Vec<[f64; 2]>,
    /// The distance after a reversal over which the current builds up, in 0.1 µm.
    pub build_up: f64,
    /// Cycles before a reversal over which it decays.
    pub lookahead: usize,
    /// Cycles by which all of it is late.
    pub late: usize,
    /// A factor on all currents.
    pub factor: f64,
}

impl ValueList {
    /// Reads a list as the control does: a key and its value in each line.
    ///
    /// # Panics
    /// The list has no points.
    pub fn parse(text: &str) -> Self {
        let values: HashMap<&str, f64> = text
            .lines()
            .filter_map(|line| {
                let mut words = line.split_whitespace();
                let key = words.next()?.strip_prefix("frict_comp.")?;
                Some((key, words.next()?.parse().ok()?))
            })
            .collect();
        let value = |key: &str, otherwise: f64| values.get(key).copied().unwrap_or(otherwise);
        let point = |at: usize| {
            let key = |side: &str| format!("table[{at}].{side}");
            Some([
                *values.get(key("in").as_str())?,
                *values.get(key("out").as_str())?,
            ])
        };
        let points: Vec<[f64; 2]> = (0..).map_while(point).collect();
        assert!(!points.is_empty(), "a list without points: {text}");
        Self {
            points,
            build_up: value("position_delay", 0.0),
            lookahead: value("reversal_lookahead", 0.0) as usize,
            late: value("delay_cycles", 0.0) as usize,
            factor: value("scaling_factor", 1000.0) / 1000.0,
        }
    }

    /// Returns the list with another factor on its currents.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        self.factor *= factor;
        self
    }

    fn at(&self, speed: f64) -> f64 {
        let after = self.points.partition_point(|it| it[0] <= speed);
        let (Some(low), Some(high)) = (
            after.checked_sub(1).map(|it| self.points[it]),
            self.points.get(after),
        ) else {
            let end = if after == 0 { 0 } else { self.points.len() - 1 };
            return self.points[end][1];
        };
        low[1] + (high[1] - low[1]) * (speed - low[0]) / (high[0] - low[0])
    }

    /// Returns the current in drive units in each cycle, for places in mm, velocities in mm/s and whether compensation
    /// is on.
    pub(crate) fn currents(&self, places: &[f64], velocities: &[f64], is_on: &[bool]) -> Vec<f64> {
        let mut direction = 0.0_f64;
        let mut turned_at = f64::NEG_INFINITY;
        let mut undelayed = Vec::with_capacity(places.len());
        for at in 0..places.len() {
            if !is_on[at] {
                (direction, turned_at) = (0.0, f64::NEG_INFINITY);
                undelayed.push(0.0);
                continue;
            }
            let velocity = velocities[at];
            if velocity != 0.0 && velocity.signum() * direction <= 0.0 {
                if direction != 0.0 || at == 0 {
                    turned_at = places[at.saturating_sub(1)];
                }
                direction = velocity.signum();
            }
            let way = (places[at] - turned_at).abs() * 1e4;
            let built = if self.build_up > 0.0 {
                (way / self.build_up).min(1.0)
            } else {
                1.0
            };
            let ahead = velocities[at + 1..].iter().take(self.lookahead);
            let until = ahead
                .enumerate()
                .find(|(_, it)| **it * direction < 0.0)
                .map(|it| it.0);
            let left = until.map_or(1.0, |it| it as f64 / self.lookahead as f64);
            undelayed
                .push(direction * self.factor * self.at(velocity.abs() * 1000.0) * built.min(left));
        }
        let late = |at: usize| {
            let from = at.checked_sub(self.late)?;
            is_on[from..=at]
                .iter()
                .all(|it| *it)
                .then(|| undelayed[from])
        };
        (0..undelayed.len())
            .map(|at| late(at).unwrap_or(0.0))
            .collect()
    }
}
