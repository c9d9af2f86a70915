//! The quantities of stiction compensation, with their units.

use std::fmt;

use serde::Serialize;
use thiserror::Error;

/// A quantity of the formulas (TNC 407/415/425, 4-33).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Quantity {
    /// `Δs_a`, the change of the servo lag over one control loop cycle, in mm.
    DeltaSa,
    /// `t_C`, the control loop cycle, in µs.
    Tc,
    /// `k_v`, the gain of the position loop, in (m/min)/mm.
    Kv,
    /// MP1511, the factor of stiction compensation, in µs.
    Mp1511,
    /// `F_add`, the feed that is added, in m/min.
    FAdd,
    /// MP1050, the voltage for rapid traverse, in V.
    Mp1050,
    /// MP1010, the rapid traverse, in m/min.
    Mp1010,
    /// `V_add`, the voltage that is added, in V.
    VAdd,
    /// GP, the grating period of the encoder, in µm.
    Gp,
    /// MP1512, the limit of `Δs_a` in counting steps.
    Mp1512,
    /// The limit of `Δs_a`, in µm.
    DeltaSaLimit,
    /// The commanded feed, in m/min.
    Feed,
    /// MP1513, the feed up to which stiction is compensated, in m/min.
    Mp1513,
}

/// Fixed facts about a quantity.
struct QuantityFacts {
    quantity: Quantity,
    symbol: &'static str,
    /// Key in records, and its name for a host.
    name: &'static str,
    unit: &'static str,
    /// Further units, each with the factor of a value in it.
    units: &'static [(&'static str, f64)],
}

const LENGTHS_MM: &[(&str, f64)] = &[("mm", 1.0), ("µm", 1e-3), ("um", 1e-3), ("nm", 1e-6)];
const LENGTHS_UM: &[(&str, f64)] = &[("µm", 1.0), ("um", 1.0), ("mm", 1e3), ("nm", 1e-3)];
const TIMES: &[(&str, f64)] = &[("µs", 1.0), ("us", 1.0), ("ms", 1e3), ("s", 1e6)];
const FEEDS: &[(&str, f64)] = &[("m/min", 1.0), ("mm/min", 1e-3), ("mm/s", 0.06)];
const VOLTAGES: &[(&str, f64)] = &[("V", 1.0), ("mV", 1e-3)];
/// 1 (m/min)/mm is 1000/60 1/s.
const GAINS: &[(&str, f64)] = &[("m/min/mm", 1.0), ("(m/min)/mm", 1.0), ("1/s", 0.06)];
const STEPS: &[(&str, f64)] = &[("", 1.0)];

const fn facts(
    quantity: Quantity,
    names: [&'static str; 2],
    unit: &'static str,
    units: &'static [(&'static str, f64)],
) -> QuantityFacts {
    let [symbol, name] = names;
    QuantityFacts {
        quantity,
        symbol,
        name,
        unit,
        units,
    }
}

const TABLE: [QuantityFacts; 13] = [
    facts(Quantity::DeltaSa, ["Δs_a", "delta_sa"], "mm", LENGTHS_MM),
    facts(Quantity::Tc, ["t_C", "tc"], "µs", TIMES),
    facts(Quantity::Kv, ["k_v", "kv"], "(m/min)/mm", GAINS),
    facts(Quantity::Mp1511, ["MP1511", "mp1511"], "µs", TIMES),
    facts(Quantity::FAdd, ["F_add", "f_add"], "m/min", FEEDS),
    facts(Quantity::Mp1050, ["MP1050", "mp1050"], "V", VOLTAGES),
    facts(Quantity::Mp1010, ["MP1010", "mp1010"], "m/min", FEEDS),
    facts(Quantity::VAdd, ["V_add", "v_add"], "V", VOLTAGES),
    facts(Quantity::Gp, ["GP", "gp"], "µm", LENGTHS_UM),
    facts(Quantity::Mp1512, ["MP1512", "mp1512"], "", STEPS),
    facts(
        Quantity::DeltaSaLimit,
        ["Δs_a,limit", "delta_sa_limit"],
        "µm",
        LENGTHS_UM,
    ),
    facts(Quantity::Feed, ["feed", "feed"], "m/min", FEEDS),
    facts(Quantity::Mp1513, ["MP1513", "mp1513"], "m/min", FEEDS),
];

/// A text that is not a value of a quantity.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum UnitError {
    /// A text that does not begin with a number.
    #[error("`{0}` does not begin with a number")]
    NoNumber(String),
    /// The unit is not one of those of the quantity.
    #[error("`{unit}` is not a unit of {quantity}, which has {known}")]
    Unknown {
        /// The quantity.
        quantity: Quantity,
        /// Text after the number.
        unit: String,
        /// The units that it has.
        known: String,
    },
}

impl Quantity {
    /// Returns every quantity, in the order of the formulas.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.quantity)
    }

    fn facts(self) -> &'static QuantityFacts {
        let row = TABLE.iter().find(|row| row.quantity == self);
        row.expect("every quantity has a row")
    }

    /// Returns the key in records, such as `delta_sa`.
    pub fn as_str(self) -> &'static str {
        self.facts().name
    }

    /// Returns the symbol of the manual, such as `Δs_a`.
    pub fn symbol(self) -> &'static str {
        self.facts().symbol
    }

    /// Returns the unit of a value without one; empty for counting steps.
    pub fn unit(self) -> &'static str {
        self.facts().unit
    }

    /// Returns a value with its unit, without the digits that only come from its binary form.
    pub fn shown(self, value: f64) -> String {
        let rounded = format!("{value:.9e}").parse().unwrap_or(value);
        format!("{rounded} {}", self.unit()).trim_end().to_owned()
    }

    /// Reads a value with or without a unit, `2um` or `0.002`, in the quantity's own unit.
    ///
    /// # Errors
    /// It does not begin with a number, or the unit is not one of the quantity.
    pub fn parse(self, text: &str) -> Result<f64, UnitError> {
        let text = text.trim();
        let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-');
        let mut end = text.find(|c| !is_part(c)).unwrap_or(text.len());
        // An exponent belongs to the number, `1e-3`; the `e` of no unit does.
        if let Some(exponent) = text[end..].strip_prefix(['e', 'E']) {
            let length = exponent.find(|c| !is_part(c)).unwrap_or(exponent.len());
            end += if length > 0 { 1 + length } else { 0 };
        }
        let (number, unit) = (&text[..end], text[end..].trim());
        let number = number.parse::<f64>().ok().filter(|value| value.is_finite());
        let number = number.ok_or_else(|| UnitError::NoNumber(text.to_owned()))?;
        let units = self.facts().units;
        let factor = match unit {
            "" => Some(1.0),
            unit => units
                .iter()
                .find(|(name, _)| *name == unit)
                .map(|row| row.1),
        };
        let known = || {
            let names = units.iter().map(|(name, _)| *name);
            let names: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
            if names.is_empty() {
                "none".to_owned()
            } else {
                names.join(", ")
            }
        };
        factor
            .map(|factor| number * factor)
            .ok_or_else(|| UnitError::Unknown {
                quantity: self,
                unit: unit.to_owned(),
                known: known(),
            })
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_with_their_units() {
        // R8.5
        let cases = [
            (Quantity::DeltaSa, "2um", 0.002),
            (Quantity::DeltaSa, "0.002", 0.002),
            (Quantity::DeltaSa, "-2 µm", -0.002),
            (Quantity::Tc, "3000us", 3000.0),
            (Quantity::Tc, "3ms", 3000.0),
            (Quantity::Tc, "3e3", 3000.0),
            (Quantity::Mp1010, "10000mm/min", 10.0),
            (Quantity::Mp1010, "10", 10.0),
            (Quantity::Kv, "25 1/s", 1.5),
            (Quantity::VAdd, "7.2mV", 0.0072),
            (Quantity::Mp1512, "50", 50.0),
        ];
        for (quantity, text, value) in cases {
            let read = quantity.parse(text).expect(text);
            assert!(
                (read - value).abs() <= 1e-12 * value.abs(),
                "{text}: {read}"
            );
        }
        for (quantity, text) in [
            (Quantity::Tc, ""),
            (Quantity::Tc, "us"),
            (Quantity::Tc, "3000mm"),
            (Quantity::Mp1512, "50um"),
            (Quantity::Kv, "1e999"),
            (Quantity::Kv, "1.5.2"),
            (Quantity::Kv, "nan"),
        ] {
            assert!(quantity.parse(text).is_err(), "{text}");
        }
    }
}
