//! A plant file: TOML with the symbols of the equations, in SI units.

use std::sync::Arc;

use toml::de::DeTable;

use super::plant_keys::{self as keys, KeyFacts, PlantQuantity, StictionKey};
use frictcomp::config::{ConfigError, Section, Shape};
use frictcomp::diagnostic::Advice;
use frictcomp::lists::{Given, Number, Written};
use frictcomp::text::{SourceFile, Span};

/// Contents of a plant file.
#[derive(Debug, Clone)]
pub(super) struct PlantFile {
    /// Name of the plant.
    pub(super) name: Option<String>,
    /// The plant that gives the missing values.
    pub(super) base: Option<Given<String>>,
    /// Values for both axes.
    pub(super) both: DriveTable,
    /// Values for X and for Y.
    pub(super) axes: [Option<DriveTable>; 2],
}

/// The values of a drive in a table, each within its range.
#[derive(Debug, Clone)]
pub(super) struct DriveTable {
    numbers: Vec<(PlantQuantity, Given<f64>)>,
    /// Rate at which slipping elements follow the friction.
    pub(super) attraction: Option<f64>,
    /// The share and the stiffness in N/m of each element of the Maxwell-slip model.
    pub(super) elements: Option<Vec<[f64; 2]>>,
    /// Stiction compensation.
    pub(super) stiction: Option<StictionTable>,
    whole: Given<()>,
}

/// The values of a table `[stiction]`, each within its range.
#[derive(Debug, Clone)]
pub(super) struct StictionTable {
    numbers: Vec<(StictionKey, Given<f64>)>,
}

/// The whole file.
const PLANT: Shape = Shape {
    name: keys::FILE,
    keys: Some(&keys::FILE_KEYS),
};

/// The tables `[x]` and `[y]`.
const AXIS: Shape = Shape {
    name: keys::AXIS_TABLE,
    keys: Some(&keys::AXIS_KEYS),
};

/// The tables `[stiction]`, `[x.stiction]` and `[y.stiction]`.
const STICTION: Shape = Shape {
    name: keys::STICTION_TABLE,
    keys: Some(&keys::STICTION_KEYS),
};

impl PlantFile {
    /// Parses the file. Relations between the values are not checked.
    pub(super) fn parse(source: &Arc<SourceFile>) -> Result<Self, ConfigError> {
        let parsed = DeTable::parse(source.text()).map_err(|error| {
            let span = error.span().unwrap_or_default();
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            ConfigError::new(source, Span::new(span.start, span.end), message)
        })?;
        let root = Section::new(parsed.get_ref(), source, &PLANT)?;
        let one = |key: &str| match root.table(key, &AXIS)? {
            Some(table) => DriveTable::read(&table).map(Some),
            None => Ok(None),
        };
        let base = root.string(keys::BASE)?;
        let both = DriveTable::read(&root)?;
        let name = root.string(keys::NAME)?.map(|given| given.value);
        let [x, y] = keys::AXES.map(one);
        Ok(Self {
            name,
            base,
            both,
            axes: [x?, y?],
        })
    }
}

impl DriveTable {
    fn read(table: &Section<'_>) -> Result<Self, ConfigError> {
        let mut numbers = Vec::new();
        for quantity in PlantQuantity::ALL {
            let help = match quantity {
                PlantQuantity::Backlash => "backlash is the width of the dead zone, 0 without one",
                _ => "all values are in SI units: kg, N, m, s",
            };
            if let Some(number) = number(table, &quantity.facts(), help)? {
                numbers.push((quantity, number));
            }
        }
        let read = Self {
            numbers,
            attraction: table.positive(keys::ATTRACTION)?,
            elements: elements(table)?,
            stiction: match table.table(keys::STICTION, &STICTION)? {
                Some(table) => Some(StictionTable::read(&table)?),
                None => None,
            },
            whole: table.whole(),
        };
        let either = [PlantQuantity::RatedForce, PlantQuantity::ForcePerUnit];
        if either
            .iter()
            .all(|&quantity| read.number(quantity).is_some())
        {
            let message = "`k_I` and `rated_force` mean the same".to_owned();
            let help = "`k_I` is `rated_force` / 1000; remove one of them";
            return Err(read.refuse(PlantQuantity::ForcePerUnit, message, help));
        }
        Ok(read)
    }

    /// Returns the numbers of the table.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (PlantQuantity, f64)> {
        self.numbers
            .iter()
            .map(|(quantity, given)| (*quantity, given.value))
    }

    /// Returns a number of the table.
    pub(super) fn number(&self, quantity: PlantQuantity) -> Option<f64> {
        self.numbers()
            .find_map(|(other, number)| (other == quantity).then_some(number))
    }

    /// Returns the error about a number, at its place, or at the table if it is not given.
    pub(super) fn refuse(
        &self,
        quantity: PlantQuantity,
        message: String,
        help: impl Into<Advice>,
    ) -> ConfigError {
        let mut numbers = self.numbers.iter();
        let place = numbers.find_map(|(other, given)| (*other == quantity).then(|| given.with(())));
        ConfigError::at(place.as_ref().unwrap_or(&self.whole), message).with_help(help)
    }
}

impl StictionTable {
    fn read(table: &Section<'_>) -> Result<Self, ConfigError> {
        let mut numbers = Vec::new();
        for key in StictionKey::ALL {
            let help = "the units are those of the manual: µs, counting steps, µm, m/min";
            if let Some(number) = number(table, &key.facts(), help)? {
                numbers.push((key, number));
            }
        }
        Ok(Self { numbers })
    }

    /// Returns the numbers of the table with their places.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (StictionKey, &Given<f64>)> {
        self.numbers.iter().map(|(key, given)| (*key, given))
    }
}

/// Returns the number of a key within its range; `None` without the key.
fn number(
    table: &Section<'_>,
    facts: &KeyFacts,
    help: &'static str,
) -> Result<Option<Given<f64>>, ConfigError> {
    let KeyFacts { key, unit, range } = *facts;
    let Some(place) = table.given(key) else {
        return Ok(None);
    };
    let [least, most] = range;
    let Some(number) = table.number(key).and_then(|given| value(&given)) else {
        let unit = match unit {
            "" => String::new(),
            unit => format!(" in {unit}"),
        };
        return Err(ConfigError::at(
            &place,
            format!("`{key}` is a number{unit}"),
        ));
    };
    if (least..=most).contains(&number) {
        return Ok(Some(place.with(number)));
    }
    let shown = if number.abs() < 1e15 {
        number.to_string()
    } else {
        format!("{number:e}")
    };
    let unit = match unit {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let message = format!("`{key}` is {shown}{unit}; it must be between {least} and {most}");
    Err(ConfigError::at(&place, message).with_help(help))
}

fn value(given: &Given<Written>) -> Option<f64> {
    given.value.number.map(Number::to_f64)
}

/// Reads `gms = [[share, stiffness], …]`, stiffnesses in N/m.
fn elements(table: &Section<'_>) -> Result<Option<Vec<[f64; 2]>>, ConfigError> {
    let Some(pairs) = table.number_pairs(keys::ELEMENTS)? else {
        return Ok(None);
    };
    let place = table.given(keys::ELEMENTS).unwrap_or_else(|| table.whole());
    if pairs.is_empty() || pairs.len() > keys::MAX_ELEMENTS {
        let message = format!(
            "`gms` has {} elements; it takes 1 to {}",
            pairs.len(),
            keys::MAX_ELEMENTS
        );
        return Err(ConfigError::at(&place, message));
    }
    let mut elements = Vec::new();
    for [share, stiffness] in &pairs {
        let share = value(share).filter(|share| (0.0..=1.0).contains(share));
        let stiffness = value(stiffness).filter(|stiffness| (1.0..=1e12).contains(stiffness));
        let (Some(share), Some(stiffness)) = (share, stiffness) else {
            let message = "an element of `gms` is `[share, stiffness]`: 0 to 1, and 1 to 1e12 N/m";
            return Err(ConfigError::at(&place, message));
        };
        elements.push([share, stiffness]);
    }
    let sum: f64 = elements.iter().map(|[share, _]| share).sum();
    if (sum - 1.0).abs() > 1e-6 {
        let message = format!("the shares of `gms` add up to {sum}");
        return Err(ConfigError::at(&place, message).with_help("they must add up to 1"));
    }
    Ok(Some(elements))
}
