//! Dynamics in an axis list (R11.20; TF5200 Axis parameters, `getriebe[i].dynamik`,
//! `.slope_profil`, `.lslope_profil`). Programs begin in gear step 0.

use std::collections::BTreeMap;

use super::entry::{Entry, Given, Number};
use super::parameter::{AxisType, Parameter};
use crate::diagnostic::{Code, Diagnostic};

/// The quantity of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DynamicQuantity {
    /// µm/s or 0.001°/s.
    Velocity,
    /// mm/s² or °/s².
    Acceleration,
    /// µs.
    Ramp,
    /// A thousandth.
    Weight,
}

/// The keys, each with the number of its parameter.
const KEYS: [(&str, &str, DynamicQuantity); 18] = {
    use DynamicQuantity::{Acceleration, Ramp, Velocity, Weight};
    [
        ("P-AXIS-00008", "dynamik.a_max", Acceleration),
        ("P-AXIS-00212", "dynamik.vb_max", Velocity),
        ("P-AXIS-00209", "vb_eilgang", Velocity),
        ("P-AXIS-00001", "slope_profil.a_beschl", Acceleration),
        ("P-AXIS-00002", "slope_profil.a_brems", Acceleration),
        ("P-AXIS-00004", "slope_profil.a_grenz", Acceleration),
        ("P-AXIS-00195", "slope_profil.tr_beschl_ab", Ramp),
        ("P-AXIS-00196", "slope_profil.tr_beschl_zu", Ramp),
        ("P-AXIS-00197", "slope_profil.tr_brems_ab", Ramp),
        ("P-AXIS-00198", "slope_profil.tr_brems_zu", Ramp),
        ("P-AXIS-00200", "slope_profil.tr_grenz", Ramp),
        ("P-AXIS-00199", "dynamik.tr_geom", Ramp),
        ("P-AXIS-00201", "dynamik.tr_min", Ramp),
        ("P-AXIS-00011", "slope_profil.a_stufe_1", Acceleration),
        ("P-AXIS-00012", "slope_profil.a_stufe_2", Acceleration),
        ("P-AXIS-00221", "slope_profil.vb_stufe_1_2", Velocity),
        ("P-AXIS-00013", "dynamik.a_trans_weight", Weight),
        ("P-AXIS-00154", "dynamik.r_trans_weight", Weight),
    ]
};

/// The values of an axis list, by the numbers of their parameters.
#[derive(Debug, Clone, Default)]
pub struct DynamicsDraft(BTreeMap<&'static str, (String, Given<Number>)>);

/// The dynamics of an axis as given by its list: in mm or degrees, and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct ListedDynamics {
    /// The highest velocity, P-AXIS-00212.
    pub velocity_per_s: Option<f64>,
    /// The highest velocity of rapid motions, P-AXIS-00209.
    pub rapid_velocity_per_s: Option<f64>,
    /// The acceleration with ramps, the smaller of P-AXIS-00001 and P-AXIS-00002.
    pub acceleration_per_s2: Option<f64>,
    /// The acceleration without ramps, the smaller of P-AXIS-00011 and P-AXIS-00012.
    pub stage_acceleration_per_s2: Option<f64>,
    /// The acceleration of rapid motions, P-AXIS-00004.
    pub rapid_acceleration_per_s2: Option<f64>,
    /// The longest of the ramp times P-AXIS-00195 to P-AXIS-00198, not below P-AXIS-00201.
    pub ramp_s: Option<f64>,
    /// The ramp time of rapid motions, P-AXIS-00200.
    pub rapid_ramp_s: Option<f64>,
    /// The ramp time where the curvature of the path changes, P-AXIS-00199.
    pub curve_ramp_s: Option<f64>,
    /// The share of the acceleration that an axis may jump by in a corner, P-AXIS-00013.
    pub corner_share: Option<f64>,
}

impl DynamicsDraft {
    /// Takes an entry of gear step 0 and returns whether its key is one of these. Reports FC130 for a value that is not
    /// a number, or not above 0 if it is a limit.
    pub(super) fn take(&mut self, entry: &Entry, diagnostics: &mut Vec<Diagnostic>) -> bool {
        let Some(key) = entry.pattern.strip_prefix("getriebe[].") else {
            return false;
        };
        let key = key
            .strip_prefix('l')
            .filter(|key| key.starts_with("slope_profil."))
            .unwrap_or(key);
        let Some((number, _, quantity)) = KEYS.iter().find(|(_, known, _)| *known == key) else {
            return false;
        };
        if entry.indices.as_slice() != [0] {
            return true;
        }
        let given = entry.number();
        let is_possible =
            |value: f64| value > 0.0 || (*quantity == DynamicQuantity::Weight && value == 0.0);
        let possible = given.value.number;
        let possible = possible.filter(|value| is_possible(value.to_f64()));
        if let Some(value) = possible {
            self.0.insert(number, (entry.key(), given.with(value)));
        } else {
            let message = format!(
                "`{}` is `{}`; the value is not used",
                entry.key(),
                given.value.text
            );
            diagnostics.push(
                Diagnostic::new(Code::Fc130, given.place(), message)
                    .with_help("write a number above 0"),
            );
        }
        true
    }

    /// Replaces values by those of another list.
    pub(super) fn override_with(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Returns the values in mm or degrees and seconds.
    pub(crate) fn dynamics(&self) -> ListedDynamics {
        let value = |number: &str| self.0.get(number).map(|(_, given)| given.value.to_f64());
        let known = |numbers: &[&str]| -> Vec<f64> {
            numbers.iter().filter_map(|number| value(number)).collect()
        };
        let most = value("P-AXIS-00008").unwrap_or(f64::INFINITY);
        let least = |numbers: &[&str]| {
            let smallest = known(numbers).into_iter().reduce(f64::min);
            smallest.map(|value| value.min(most))
        };
        let shortest = value("P-AXIS-00201").unwrap_or(0.0);
        let longest = |numbers: &[&str]| {
            let largest = known(numbers).into_iter().reduce(f64::max);
            largest.map(|time| time.max(shortest) * 1e-6)
        };
        let velocity = |number: &str| value(number).map(|value| value / 1000.0);
        ListedDynamics {
            velocity_per_s: velocity("P-AXIS-00212").or_else(|| velocity("P-AXIS-00209")),
            rapid_velocity_per_s: velocity("P-AXIS-00209"),
            acceleration_per_s2: least(&["P-AXIS-00001", "P-AXIS-00002"]),
            stage_acceleration_per_s2: least(&["P-AXIS-00011", "P-AXIS-00012"]),
            rapid_acceleration_per_s2: least(&["P-AXIS-00004"]),
            ramp_s: longest(&[
                "P-AXIS-00195",
                "P-AXIS-00196",
                "P-AXIS-00197",
                "P-AXIS-00198",
            ]),
            rapid_ramp_s: longest(&["P-AXIS-00200"]),
            curve_ramp_s: longest(&["P-AXIS-00199"]),
            corner_share: value("P-AXIS-00013")
                .map(|thousandths| thousandths / 1000.0)
                .filter(|share| *share > 0.0),
        }
    }

    /// Returns the parameters that the list gives.
    pub(super) fn parameters(&self, axis_type: AxisType) -> Vec<Parameter> {
        let linear = axis_type == AxisType::Linear;
        let rows = self.0.iter().map(|(&number, (key, given))| {
            let quantity = KEYS.iter().find(|(known, ..)| *known == number);
            let unit = match quantity.map(|(_, _, quantity)| quantity) {
                Some(DynamicQuantity::Velocity) if linear => "µm/s",
                Some(DynamicQuantity::Velocity) => "0.001°/s",
                Some(DynamicQuantity::Acceleration) if linear => "mm/s²",
                Some(DynamicQuantity::Acceleration) => "°/s²",
                Some(DynamicQuantity::Ramp) => "µs",
                _ => "‰",
            };
            Parameter {
                number,
                key: key.clone(),
                value: given.value.to_string(),
                unit,
                origin: given.into(),
            }
        });
        rows.collect()
    }
}
