//! The formulas of stiction compensation, as products of powers.

use super::quantity::Quantity;

/// A formula: its factor times the product of its terms, each to its power, is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Formula {
    /// The formula as the manual writes it.
    pub text: &'static str,
    factor: f64,
    /// Quantities and their powers, 1 or -1.
    terms: &'static [(Quantity, i32)],
}

/// The formulas in the order in which they are solved: the limit first, which the others need.
pub const FORMULAS: [Formula; 3] = [
    Formula {
        text: "MP1512 = Δs_a,limit · 256 / GP",
        factor: 256.0,
        terms: &[
            (Quantity::DeltaSaLimit, 1),
            (Quantity::Gp, -1),
            (Quantity::Mp1512, -1),
        ],
    },
    Formula {
        text: "F_add = Δs_a / t_C · k_v · MP1511",
        factor: 1.0,
        terms: &[
            (Quantity::DeltaSa, 1),
            (Quantity::Tc, -1),
            (Quantity::Kv, 1),
            (Quantity::Mp1511, 1),
            (Quantity::FAdd, -1),
        ],
    },
    Formula {
        text: "V_add = MP1050 / MP1010 · F_add",
        factor: 1.0,
        terms: &[
            (Quantity::Mp1050, 1),
            (Quantity::Mp1010, -1),
            (Quantity::FAdd, 1),
            (Quantity::VAdd, -1),
        ],
    },
];

impl Formula {
    /// Returns the quantities in it.
    pub fn quantities(&self) -> impl Iterator<Item = Quantity> {
        self.terms.iter().map(|(quantity, _)| *quantity)
    }

    /// Returns whether it has a quantity.
    pub(super) fn has(&self, quantity: Quantity) -> bool {
        self.quantities().any(|it| it == quantity)
    }

    /// Returns the value of one quantity when the others are known; `None` if the formula cannot be solved for it
    /// because of a value that is 0.
    pub(super) fn value(&self, wanted: Quantity, known: impl Fn(Quantity) -> f64) -> Option<f64> {
        let power = self
            .terms
            .iter()
            .find(|(quantity, _)| *quantity == wanted)?
            .1;
        let others = self
            .terms
            .iter()
            .filter(|(quantity, _)| *quantity != wanted);
        let product = others.fold(self.factor, |product, (quantity, power)| {
            product * known(*quantity).powi(*power)
        });
        let value = if power == 1 { 1.0 / product } else { product };
        value.is_finite().then_some(value)
    }
}
