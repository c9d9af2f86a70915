//! A plant as its user writes it down: TOML with the symbols of the equations, in SI units.

use std::sync::Arc;

use toml::de::DeTable;

use super::clock::STEP_S;
use super::friction::GmsElement;
use super::parameters::DriveParameters;
use super::plant::{Plant, Preset, UnknownPreset};
use super::plant_keys as keys;
use super::plant_keys::{QUANTITIES, Quantity};
use crate::lists::{Given, Number, Written};
use crate::machine::ConfigError;
use crate::machine::section::{Section, Shape};
use crate::text::{SourceFile, Span};

/// The whole file.
const PLANT: Shape = Shape {
    name: "plant",
    keys: Some(&keys::FILE_KEYS),
};

/// The tables `[x]` and `[y]`.
const AXIS: Shape = Shape {
    name: "[x] and [y]",
    keys: Some(&keys::AXIS_KEYS),
};

/// Elements of the Maxwell-slip model at most.
const MAX_ELEMENTS: usize = 20;

impl Plant {
    /// The plant that a TOML file describes. Keys at the top are for both axes, those in `[x]` and
    /// `[y]` for one; what is not there comes from the plant that `base` names, `stiff` without it.
    ///
    /// # Errors
    /// FC110 with the place: no TOML, an unknown key, a value out of its range, or values that do
    /// not fit together.
    pub fn from_toml(source: SourceFile) -> Result<Self, ConfigError> {
        let source = Arc::new(source);
        let parsed = DeTable::parse(source.text()).map_err(|error| {
            let span = error.span().unwrap_or_default();
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            ConfigError::new(&source, Span::new(span.start, span.end), message)
        })?;
        let root = Section::new(parsed.get_ref(), &source, &PLANT)?;
        let base = base(&root)?;
        let both = overridden(&DriveParameters::of(base), &root)?;
        let one = |key: &str| match root.table(key, &AXIS)? {
            Some(table) => overridden(&both, &table),
            None => Ok(both.clone()),
        };
        let name = root.string(keys::NAME)?.map(|given| given.value);
        let [x, y] = keys::AXES.map(one);
        Ok(Self {
            x: x?,
            y: y?,
            name: name.unwrap_or_else(|| source.name().to_string()),
        })
    }
}

fn base(root: &Section<'_>) -> Result<Preset, ConfigError> {
    let Some(given) = root.string(keys::BASE)? else {
        return Ok(Preset::default());
    };
    given.value.parse().map_err(|unknown: UnknownPreset| {
        let help = match unknown.near() {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => format!("there are {}", Preset::names()),
        };
        ConfigError::at(&given, unknown.to_string()).with_help(help)
    })
}

/// A drive with the values of a table in place of those that it had. What follows from others by a
/// formula follows from the new ones, unless it is written itself.
fn overridden(
    drive: &DriveParameters,
    table: &Section<'_>,
) -> Result<DriveParameters, ConfigError> {
    let mut drive = drive.clone();
    let numbers = numbers(table)?;
    let attraction = table.positive(keys::ATTRACTION)?;
    let elements = elements(table)?;
    let number = |key: &str| {
        let mut written = numbers.iter();
        written.find(|it| it.0.key == key).map(|it| it.1)
    };
    if let Some(mass) = number(keys::MASS) {
        drive.set_mass(mass);
    }
    if let Some(force) = number(keys::RATED_FORCE) {
        drive.set_rated_force(force);
        if number(keys::FORCE_PER_UNIT).is_some() {
            return Err(ConfigError::at(
                &table.given_or_whole(keys::FORCE_PER_UNIT),
                "`k_I` and `rated_force` mean the same",
            )
            .with_help("`k_I` is `rated_force` / 1000; remove one of them"));
        }
    }
    if let Some(stiffness) = number(keys::STIFFNESS) {
        drive.set_stiffness(stiffness);
    }
    for (quantity, number) in numbers {
        if let Some(parameter) = quantity.parameter {
            *parameter(&mut drive) = number;
        }
    }
    if let Some(attraction) = attraction {
        drive.friction.attraction_n_per_s = attraction;
    }
    if let Some(elements) = elements {
        drive.friction.elements = elements;
    }
    check(&drive, table)?;
    Ok(drive)
}

/// The numbers that a table has, each within its range.
fn numbers(table: &Section<'_>) -> Result<Vec<(&'static Quantity, f64)>, ConfigError> {
    let written = QUANTITIES
        .iter()
        .filter_map(|quantity| Some((quantity, table.given(quantity.key)?)));
    let numbers = written.map(|(quantity, place)| {
        let number = checked(quantity, &place, table.number(quantity.key))?;
        Ok((quantity, number))
    });
    numbers.collect()
}

/// What the values must be to each other.
fn check(drive: &DriveParameters, table: &Section<'_>) -> Result<(), ConfigError> {
    let friction = &drive.friction;
    let refuse = |key: &str, message: String, help: &str| {
        Err(ConfigError::at(&table.given_or_whole(key), message).with_help(help))
    };
    if friction.coulomb_n <= 0.0 && friction.breakaway_n > 0.0 {
        let message = "`Fs` without `Fc`: nothing is left to slide against".to_owned();
        return refuse("Fc", message, "write both, or 0 for both");
    }
    if friction.breakaway_n < friction.coulomb_n {
        let message = format!(
            "`Fs` is {} N and less than `Fc`, {} N",
            friction.breakaway_n, friction.coulomb_n
        );
        return refuse(
            "Fs",
            message,
            "the breakaway friction is at least the Coulomb friction",
        );
    }
    // Both limits are those of the explicit step, which cannot follow a contact that swings faster.
    let least = drive.mass_kg / (STEP_S * STEP_S);
    if friction.stiffness_n_per_m > least {
        let message = format!(
            "a contact of {} N/m is too stiff for {} kg: the step of {STEP_S} s cannot follow it",
            friction.stiffness_n_per_m, drive.mass_kg
        );
        return refuse(
            "sigma0",
            message,
            &format!("`sigma0` is at most {least:.3e} here"),
        );
    }
    let least = drive.mass_kg / STEP_S;
    if friction.damping_n_s_per_m + friction.viscous_n_s_per_m > least {
        let message = format!(
            "a damping of {} N·s/m is too strong for {} kg: the step of {STEP_S} s cannot follow it",
            friction.damping_n_s_per_m + friction.viscous_n_s_per_m,
            drive.mass_kg
        );
        return refuse(
            "sigma1",
            message,
            &format!("`sigma1` + `fv` is at most {least:.3e} here"),
        );
    }
    Ok(())
}

/// A number within its range.
fn checked(
    quantity: &Quantity,
    place: &Given<()>,
    written: Option<Given<Written>>,
) -> Result<f64, ConfigError> {
    let Quantity {
        key,
        unit,
        least,
        most,
        ..
    } = *quantity;
    let Some(number) = written.and_then(|given| value(&given)) else {
        let unit = match unit {
            "" => String::new(),
            unit => format!(" in {unit}"),
        };
        return Err(ConfigError::at(place, format!("`{key}` is a number{unit}")));
    };
    if (least..=most).contains(&number) {
        return Ok(number);
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
    let message = format!("`{key}` is {shown}{unit}, it must be between {least} and {most}");
    Err(ConfigError::at(place, message).with_help("all values are in SI units: kg, N, m, s"))
}

fn value(given: &Given<Written>) -> Option<f64> {
    given.value.number.map(Number::to_f64)
}

/// `gms = [[share, stiffness], …]`, stiffnesses in N/m.
fn elements(table: &Section<'_>) -> Result<Option<Vec<GmsElement>>, ConfigError> {
    let Some(pairs) = table.number_pairs(keys::ELEMENTS)? else {
        return Ok(None);
    };
    let place = table.given_or_whole(keys::ELEMENTS);
    if pairs.is_empty() || pairs.len() > MAX_ELEMENTS {
        let message = format!(
            "`gms` has {} elements, it has 1 to {MAX_ELEMENTS}",
            pairs.len()
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
        elements.push(GmsElement {
            share,
            stiffness_n_per_m: stiffness,
        });
    }
    let sum: f64 = elements.iter().map(|element| element.share).sum();
    if (sum - 1.0).abs() > 1e-6 {
        let message = format!("the shares of `gms` add up to {sum}");
        return Err(ConfigError::at(&place, message).with_help("they make 1"));
    }
    Ok(Some(elements))
}
