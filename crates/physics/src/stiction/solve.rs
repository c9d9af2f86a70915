//! The conclusions from known quantities.

use std::collections::BTreeMap;

use serde::Serialize;
use thiserror::Error;

use super::formula::{FORMULAS, Formula};
use super::guideline::{Guideline, MP1511_RANGE_US, not_kept};
use super::quantity::Quantity;

/// Largest relative difference between a given value and the result of a formula.
const TOLERANCE: f64 = 1e-6;

/// The value of a quantity and its origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Solved {
    /// The quantity.
    pub quantity: Quantity,
    /// Value in its own unit.
    pub value: f64,
    /// The formula that gave it; absent if it was given.
    pub by: Option<&'static str>,
}

/// Effect of the stiction compensation at the commanded feed (R8.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum FeedEffect {
    /// The feed is at most MP1513.
    Acts,
    /// The feed is above MP1513.
    TooFast,
    /// The feed or MP1513 is not known.
    Unknown,
}

/// Conclusions from the given quantities.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Solution {
    /// The values in the order of the quantities.
    pub values: Vec<Solved>,
    /// The acting `Δs_a` in mm, if the limit cuts it (R8.1).
    pub clipped_to: Option<f64>,
    /// Effect at the commanded feed.
    pub effect: FeedEffect,
    /// The guidelines that are not kept.
    pub guidelines: Vec<Guideline>,
}

/// Reason why nothing can be concluded.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum StictionError {
    /// No quantity was given.
    #[error("no quantity is given")]
    Nothing,
    /// No formula has all its quantities but one.
    #[error("nothing follows from these values: {formula} also needs {}", .missing.join(" and "))]
    TooFew {
        /// The formula that needs fewest.
        formula: &'static str,
        /// Further inputs; all but one of these.
        missing: Vec<&'static str>,
    },
    /// A formula contradicts a value.
    #[error("the values contradict {formula}: {quantity} would be {}, but {} is given", .quantity.shown(*.computed), .quantity.shown(*.given))]
    Contradiction {
        /// The formula.
        formula: &'static str,
        /// The quantity.
        quantity: Quantity,
        /// Result of the formula.
        computed: f64,
        /// Given value.
        given: f64,
    },
    /// A value is out of range.
    #[error("{quantity} must be {expected}")]
    Range {
        /// The quantity.
        quantity: Quantity,
        /// Permitted range.
        expected: &'static str,
    },
    /// The formula cannot be solved because a value is 0, or because the result is too large.
    #[error("{formula} cannot be solved for {quantity}: a value is 0 or too large")]
    Division {
        /// The formula.
        formula: &'static str,
        /// The quantity.
        quantity: Quantity,
    },
    /// The limit keeps `Δs_a` below the required value.
    #[error("F_add needs a Δs_a of {}, but the limit is {}", Quantity::DeltaSa.shown(*.needed_mm), Quantity::DeltaSa.shown(*.limit_mm))]
    Limited {
        /// The required `Δs_a`.
        needed_mm: f64,
        /// Limit.
        limit_mm: f64,
    },
}

/// Computes the quantities that follow from the given ones, each in its own unit.
///
/// # Errors
/// A value is outside its range, values contradict a formula, or nothing follows from them.
pub fn solve(given: &BTreeMap<Quantity, f64>) -> Result<Solution, StictionError> {
    check_ranges(given)?;
    let mut state = State {
        values: given.clone(),
        by: BTreeMap::new(),
        clipped_to: None,
    };
    for _ in &FORMULAS {
        for formula in &FORMULAS {
            state.apply(formula, given)?;
        }
    }
    let compares_feed = [Quantity::Feed, Quantity::Mp1513]
        .iter()
        .all(|quantity| given.contains_key(quantity));
    if state.by.is_empty() && !state.is_complete() && !compares_feed {
        return Err(state.too_few());
    }
    check_ranges(&state.values)?;
    Ok(state.solution())
}

struct State {
    values: BTreeMap<Quantity, f64>,
    by: BTreeMap<Quantity, &'static str>,
    clipped_to: Option<f64>,
}

impl State {
    fn get(&self, quantity: Quantity) -> Option<f64> {
        self.values.get(&quantity).copied()
    }

    fn limit_mm(&self) -> Option<f64> {
        self.get(Quantity::DeltaSaLimit).map(|limit| limit / 1000.0)
    }

    /// Returns the value of a quantity for a formula: `Δs_a` is cut to its limit (R8.1).
    fn effective(&self, quantity: Quantity) -> f64 {
        let value = self.get(quantity).unwrap_or(f64::NAN);
        match (quantity, self.limit_mm()) {
            (Quantity::DeltaSa, Some(limit)) => value.clamp(-limit, limit),
            _ => value,
        }
    }

    fn apply(
        &mut self,
        formula: &Formula,
        given: &BTreeMap<Quantity, f64>,
    ) -> Result<(), StictionError> {
        let open: Vec<Quantity> = formula
            .quantities()
            .filter(|quantity| self.get(*quantity).is_none())
            .collect();
        if let (true, Some(limit)) = (formula.has(Quantity::DeltaSa), self.limit_mm())
            && self
                .get(Quantity::DeltaSa)
                .is_some_and(|it| it.abs() > limit)
        {
            self.clipped_to = Some(self.effective(Quantity::DeltaSa));
        }
        match open.as_slice() {
            [] => self.compare(formula, given),
            &[wanted] => {
                let value = formula.value(wanted, |quantity| self.effective(quantity));
                let value = value.ok_or(StictionError::Division {
                    formula: formula.text,
                    quantity: wanted,
                })?;
                if let (Quantity::DeltaSa, Some(limit_mm)) = (wanted, self.limit_mm())
                    && value.abs() > limit_mm * (1.0 + TOLERANCE)
                {
                    return Err(StictionError::Limited {
                        needed_mm: value,
                        limit_mm,
                    });
                }
                self.values.insert(wanted, value);
                self.by.insert(wanted, formula.text);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Checks a formula whose values are all known.
    fn compare(
        &self,
        formula: &Formula,
        given: &BTreeMap<Quantity, f64>,
    ) -> Result<(), StictionError> {
        // The last given quantity is compared, so that the message names one.
        let Some(quantity) = formula
            .quantities()
            .filter(|it| given.contains_key(it))
            .last()
        else {
            return Ok(());
        };
        let computed = formula.value(quantity, |quantity| self.effective(quantity));
        let known = self.effective(quantity);
        match computed {
            Some(computed)
                if (computed - known).abs() > TOLERANCE * computed.abs().max(known.abs()) =>
            {
                Err(StictionError::Contradiction {
                    formula: formula.text,
                    quantity,
                    computed,
                    given: known,
                })
            }
            _ => Ok(()),
        }
    }

    /// Returns whether some formula has all its values.
    fn is_complete(&self) -> bool {
        FORMULAS
            .iter()
            .any(|formula| formula.quantities().all(|it| self.get(it).is_some()))
    }

    fn too_few(&self) -> StictionError {
        let missing = |formula: &Formula| -> Vec<&'static str> {
            let open = formula.quantities().filter(|it| self.get(*it).is_none());
            open.map(Quantity::symbol).collect()
        };
        let begun = |formula: &&Formula| formula.quantities().any(|it| self.get(it).is_some());
        let begun = FORMULAS.iter().filter(begun);
        let nearest = begun.min_by_key(|formula| missing(formula).len());
        nearest.map_or(StictionError::Nothing, |nearest| StictionError::TooFew {
            formula: nearest.text,
            missing: missing(nearest),
        })
    }

    fn solution(self) -> Solution {
        let guidelines = not_kept(self.get(Quantity::Mp1511), self.get(Quantity::Mp1512));
        let effect = match (self.get(Quantity::Feed), self.get(Quantity::Mp1513)) {
            (Some(feed), Some(most)) if feed.abs() <= most => FeedEffect::Acts,
            (Some(_), Some(_)) => FeedEffect::TooFast,
            _ => FeedEffect::Unknown,
        };
        let values = self.values.iter().map(|(&quantity, &value)| Solved {
            quantity,
            value,
            by: self.by.get(&quantity).copied(),
        });
        Solution {
            values: values.collect(),
            clipped_to: self.clipped_to,
            effect,
            guidelines,
        }
    }
}

/// Checks the range of every quantity (R8.3): `Δs_a` and its results have a sign, the others have
/// none.
fn check_ranges(values: &BTreeMap<Quantity, f64>) -> Result<(), StictionError> {
    for (&quantity, &value) in values {
        let (is_possible, expected) = match quantity {
            Quantity::DeltaSa | Quantity::FAdd | Quantity::VAdd | Quantity::Feed => {
                (value.is_finite(), "a number")
            }
            Quantity::Mp1511 => (MP1511_RANGE_US.contains(&value), "from 0 to 16777215 µs"),
            Quantity::Mp1512 | Quantity::DeltaSaLimit | Quantity::Mp1513 => {
                (value >= 0.0, "0 or more")
            }
            Quantity::Tc | Quantity::Kv | Quantity::Mp1050 | Quantity::Mp1010 | Quantity::Gp => {
                (value > 0.0, "more than 0")
            }
        };
        if !is_possible {
            return Err(StictionError::Range { quantity, expected });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(values: &[(Quantity, f64)]) -> BTreeMap<Quantity, f64> {
        values.iter().copied().collect()
    }

    fn value(solution: &Solution, quantity: Quantity) -> f64 {
        let found = solution.values.iter().find(|it| it.quantity == quantity);
        found.map_or(f64::NAN, |it| it.value)
    }

    const WORKED: [(Quantity, f64); 11] = [
        (Quantity::Kv, 1.5),
        (Quantity::Tc, 3000.0),
        (Quantity::Mp1511, 8000.0),
        (Quantity::DeltaSa, 0.002),
        (Quantity::FAdd, 0.008),
        (Quantity::Mp1050, 9.0),
        (Quantity::Mp1010, 10.0),
        (Quantity::VAdd, 0.0072),
        (Quantity::Gp, 20.0),
        (Quantity::Mp1512, 50.0),
        (Quantity::DeltaSaLimit, 3.90625),
    ];

    #[test]
    fn each_formula_is_solved_for_each_of_its_terms() {
        // R8.1, R8.4: the worked case, with each value left out in turn.
        for (left_out, expected) in WORKED {
            let rest: Vec<_> = WORKED
                .into_iter()
                .filter(|(it, _)| *it != left_out)
                .collect();
            let solution = solve(&given(&rest)).expect("a solution");
            let computed = value(&solution, left_out);
            assert!(
                (computed - expected).abs() < 1e-9 * expected,
                "{left_out}: {computed}"
            );
        }
        let solution = solve(&given(&WORKED)).expect("a solution");
        assert!(solution.values.iter().all(|it| it.by.is_none()));
    }

    #[test]
    fn the_change_of_the_lag_is_cut_to_its_limit() {
        // R8.1
        let mut values = given(&WORKED[..4]);
        values.insert(Quantity::DeltaSa, -0.005);
        values.insert(Quantity::Gp, 20.0);
        values.insert(Quantity::Mp1512, 25.6);
        let solution = solve(&values).expect("a solution");
        assert_eq!(solution.clipped_to, Some(-0.002));
        assert!((value(&solution, Quantity::FAdd) + 0.008).abs() < 1e-12);
        values.remove(&Quantity::DeltaSa);
        values.insert(Quantity::FAdd, 0.009);
        assert!(matches!(solve(&values), Err(StictionError::Limited { .. })));
    }

    #[test]
    fn it_acts_up_to_a_feed() {
        // R8.2
        let effect = |feed, most| {
            let values = given(&[(Quantity::Feed, feed), (Quantity::Mp1513, most)]);
            solve(&values).map(|solution| solution.effect)
        };
        assert_eq!(effect(0.5, 0.5), Ok(FeedEffect::Acts));
        assert_eq!(effect(0.51, 0.5), Ok(FeedEffect::TooFast));
        let solution = solve(&given(&WORKED)).expect("a solution");
        assert_eq!(solution.effect, FeedEffect::Unknown);
    }

    #[test]
    fn guidelines_and_ranges_are_kept() {
        // R8.3
        let with = |quantity, value| {
            let mut values = given(&WORKED[..4]);
            values.insert(Quantity::Gp, 20.0);
            values.insert(quantity, value);
            solve(&values).map(|solution| solution.guidelines)
        };
        assert_eq!(with(Quantity::Mp1511, 5000.0), Ok(vec![]));
        assert_eq!(
            with(Quantity::Mp1511, 10_001.0),
            Ok(vec![Guideline::Mp1511])
        );
        assert_eq!(with(Quantity::Mp1512, 49.0), Ok(vec![]));
        assert_eq!(with(Quantity::Mp1512, 50.0), Ok(vec![Guideline::Mp1512]));
        for (quantity, value) in [
            (Quantity::Mp1511, -1.0),
            (Quantity::Mp1511, 16_777_216.0),
            (Quantity::Tc, 0.0),
            (Quantity::Gp, -20.0),
            (Quantity::Kv, f64::NAN),
        ] {
            let range = StictionError::Range {
                quantity,
                expected: "",
            };
            let found = with(quantity, value).expect_err("outside");
            assert_eq!(
                std::mem::discriminant(&found),
                std::mem::discriminant(&range)
            );
        }
    }

    #[test]
    fn contradictions_and_gaps_are_said() {
        // R8.5
        let mut values = given(&WORKED);
        values.insert(Quantity::FAdd, 0.009);
        let said = solve(&values).expect_err("a contradiction").to_string();
        assert!(said.contains("F_add would be 0.008"), "{said}");
        assert_eq!(solve(&given(&[])), Err(StictionError::Nothing));
        let said = solve(&given(&WORKED[..1]))
            .expect_err("too few")
            .to_string();
        assert!(said.contains("F_add = "), "{said}");
        let said = solve(&given(&WORKED[..3]))
            .expect_err("too few")
            .to_string();
        assert!(said.ends_with("also needs Δs_a and F_add"), "{said}");
        let zero = given(&[
            (Quantity::DeltaSa, 0.0),
            (Quantity::Tc, 3000.0),
            (Quantity::Kv, 1.5),
            (Quantity::FAdd, 0.008),
        ]);
        assert!(matches!(solve(&zero), Err(StictionError::Division { .. })));
    }
}
