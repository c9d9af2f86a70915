//! A plant as its user writes it down: TOML with the symbols of the equations, in SI units.

use std::sync::Arc;

use toml::de::DeTable;

use super::drive::DriveParameters;
use super::friction::{GmsElement, STEP};
use super::plant::{PEAK, Plant, Preset, damping, elements, speed_gain};
use crate::diagnostic::did_you_mean;
use crate::lists::{Given, Number, Written};
use crate::machine::ConfigError;
use crate::machine::section::{Section, Shape};
use crate::source::{SourceFile, Span};

/// The whole file.
const PLANT: Shape = Shape {
    name: "plant",
    keys: Some(&[
        "name",
        "base",
        "x",
        "y",
        "m",
        "Kv",
        "Kp",
        "Ti",
        "Tt",
        "k_ff",
        "k_a",
        "k_I",
        "rated_force",
        "max_force",
        "Fc",
        "Fs",
        "vs",
        "fv",
        "delta",
        "sigma0",
        "sigma1",
        "vd",
        "gms",
        "gms_C",
    ]),
};

/// The tables `[x]` and `[y]`.
const AXIS: Shape = Shape {
    name: "[x] and [y]",
    keys: Some(&[
        "m",
        "Kv",
        "Kp",
        "Ti",
        "Tt",
        "k_ff",
        "k_a",
        "k_I",
        "rated_force",
        "max_force",
        "Fc",
        "Fs",
        "vs",
        "fv",
        "delta",
        "sigma0",
        "sigma1",
        "vd",
        "gms",
        "gms_C",
    ]),
};

/// Elements of the Maxwell-slip model at most.
const MAX_ELEMENTS: usize = 20;

/// What a value may be, in SI units.
struct Limits {
    key: &'static str,
    unit: &'static str,
    least: f64,
    most: f64,
}

/// The ranges are wide; they are there against wrong units and against steps that the simulation
/// could not follow.
const LIMITS: [Limits; 18] = {
    const fn limits(key: &'static str, unit: &'static str, least: f64, most: f64) -> Limits {
        Limits {
            key,
            unit,
            least,
            most,
        }
    }
    [
        limits("m", "kg", 0.01, 1e6),
        limits("Kv", "1/s", 0.1, 2000.0),
        limits("Kp", "N·s/m", 0.1, 1e10),
        limits("Ti", "s", 1e-4, 1e6),
        limits("Tt", "s", 1e-5, 0.1),
        limits("k_ff", "", 0.0, 2.0),
        limits("k_a", "", 0.0, 2.0),
        limits("k_I", "N per drive unit", -1e6, 1e6),
        limits("rated_force", "N", 0.01, 1e7),
        limits("max_force", "N", 0.01, 1e8),
        limits("Fc", "N", 0.0, 1e7),
        limits("Fs", "N", 0.0, 1e7),
        limits("vs", "m/s", 1e-6, 1.0),
        limits("fv", "N·s/m", 0.0, 1e8),
        limits("delta", "", 0.1, 10.0),
        limits("sigma0", "N/m", 1e3, 1e12),
        limits("sigma1", "N·s/m", 0.0, 1e10),
        limits("vd", "m/s", 1e-6, 10.0),
    ]
};

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
        let name = root.string("name")?.map(|given| given.value);
        Ok(Self {
            x: one("x")?,
            y: one("y")?,
            name: name.unwrap_or_else(|| source.name().to_string()),
        })
    }
}

fn base(root: &Section<'_>) -> Result<Preset, ConfigError> {
    let Some(given) = root.string("base")? else {
        return Ok(Preset::default());
    };
    Preset::from_name(&given.value).ok_or_else(|| {
        let names = Preset::ALL.map(Preset::name);
        let message = format!("there is no plant `{}`", given.value);
        ConfigError::at(&given, message).with_help(match did_you_mean(&given.value, names) {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => format!("there are {}", names.join(", ")),
        })
    })
}

/// A drive with the values of a table over those that it had. What follows from others by a
/// formula follows from the new ones, unless it is written itself.
fn overridden(
    drive: &DriveParameters,
    table: &Section<'_>,
) -> Result<DriveParameters, ConfigError> {
    let mut drive = drive.clone();
    let mut friction = drive.friction.clone();
    let value = |key: &str| real(table, key);
    let set = |key: &str, place: &mut f64| -> Result<bool, ConfigError> {
        let given = value(key)?;
        if let Some(given) = &given {
            *place = given.value;
        }
        Ok(given.is_some())
    };
    let new_mass = set("m", &mut drive.mass)?;
    if !set("Kp", &mut drive.speed_gain)? && new_mass {
        drive.speed_gain = speed_gain(drive.mass);
    }
    set("Kv", &mut drive.position_gain)?;
    set("Ti", &mut drive.integral_time)?;
    set("Tt", &mut drive.current_time)?;
    set("k_ff", &mut drive.velocity_forward)?;
    set("k_a", &mut drive.acceleration_forward)?;
    let mut rated = 1000.0 * drive.force_per_unit;
    let new_rated = set("rated_force", &mut rated)?;
    if new_rated {
        drive.force_per_unit = rated / 1000.0;
    }
    if !set("max_force", &mut drive.max_force)? && new_rated {
        drive.max_force = PEAK * rated;
    }
    let new_unit = set("k_I", &mut drive.force_per_unit)?;
    set("Fc", &mut friction.coulomb)?;
    set("Fs", &mut friction.breakaway)?;
    set("vs", &mut friction.stribeck_velocity)?;
    set("fv", &mut friction.viscous)?;
    set("delta", &mut friction.shape)?;
    let new_stiffness = set("sigma0", &mut friction.stiffness)?;
    if !set("sigma1", &mut friction.damping)? && (new_stiffness || new_mass) {
        friction.damping = damping(friction.stiffness, drive.mass);
    }
    set("vd", &mut friction.damping_velocity)?;
    if let Some(attraction) = table.positive("gms_C")? {
        friction.attraction = attraction;
    }
    match gms(table)? {
        Some(given) => friction.elements = given,
        None if new_stiffness => friction.elements = elements(friction.stiffness),
        None => {}
    }
    drive.friction = friction;
    if new_rated && new_unit {
        return Err(ConfigError::at(
            &table.given_or_whole("k_I"),
            "`k_I` and `rated_force` are two ways to say the same",
        )
        .with_help("`k_I` is `rated_force` / 1000; leave one of them out"));
    }
    check(&drive, table)?;
    Ok(drive)
}

/// What the values must be to each other.
fn check(drive: &DriveParameters, table: &Section<'_>) -> Result<(), ConfigError> {
    let friction = &drive.friction;
    let refuse = |key: &str, message: String, help: &str| {
        Err(ConfigError::at(&table.given_or_whole(key), message).with_help(help))
    };
    if friction.coulomb <= 0.0 && friction.breakaway > 0.0 {
        let message = "`Fs` without `Fc`: nothing is left to slide against".to_owned();
        return refuse("Fc", message, "write both, or 0 for both");
    }
    if friction.breakaway < friction.coulomb {
        let message = format!(
            "`Fs` is {} N and less than `Fc`, {} N",
            friction.breakaway, friction.coulomb
        );
        return refuse(
            "Fs",
            message,
            "the breakaway friction is at least the Coulomb friction",
        );
    }
    // Both limits are those of the explicit step: a contact that swings faster than it.
    let least = drive.mass / (STEP * STEP);
    if friction.stiffness > least {
        let message = format!(
            "a contact of {} N/m is too stiff for {} kg: the step of {STEP} s cannot follow it",
            friction.stiffness, drive.mass
        );
        return refuse(
            "sigma0",
            message,
            &format!("`sigma0` is at most {least:.3e} here"),
        );
    }
    let least = drive.mass / STEP;
    if friction.damping + friction.viscous > least {
        let message = format!(
            "a damping of {} N·s/m is too strong for {} kg: the step of {STEP} s cannot follow it",
            friction.damping + friction.viscous,
            drive.mass
        );
        return refuse(
            "sigma1",
            message,
            &format!("`sigma1` + `fv` is at most {least:.3e} here"),
        );
    }
    Ok(())
}

/// A number within its limits.
fn real(table: &Section<'_>, key: &str) -> Result<Option<Given<f64>>, ConfigError> {
    let limits = LIMITS.iter().find(|limits| limits.key == key);
    let limits = limits.expect("every key that is asked for has limits");
    let Some(place) = table.given(key) else {
        return Ok(None);
    };
    let number = table.number(key).and_then(|given| value(&given));
    let unit = if limits.unit.is_empty() {
        String::new()
    } else {
        format!(" {}", limits.unit)
    };
    match number {
        Some(number) if (limits.least..=limits.most).contains(&number) => {
            Ok(Some(place.with(number)))
        }
        Some(number) => {
            let shown = if number.abs() < 1e15 {
                number.to_string()
            } else {
                format!("{number:e}")
            };
            Err(ConfigError::at(
                &place,
                format!(
                    "`{key}` is {shown}{unit}, it lies between {} and {}",
                    limits.least, limits.most
                ),
            )
            .with_help("all values are in SI units: kg, N, m, s"))
        }
        None => Err(ConfigError::at(
            &place,
            format!("`{key}` is a number{}", {
                if unit.is_empty() {
                    unit
                } else {
                    format!(" in{unit}")
                }
            }),
        )),
    }
}

fn value(given: &Given<Written>) -> Option<f64> {
    given.value.number.map(Number::to_f64)
}

/// `gms = [[share, stiffness], …]`.
fn gms(table: &Section<'_>) -> Result<Option<Vec<GmsElement>>, ConfigError> {
    let Some(pairs) = table.number_pairs("gms")? else {
        return Ok(None);
    };
    let place = table.given_or_whole("gms");
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
        elements.push(GmsElement { share, stiffness });
    }
    let sum: f64 = elements.iter().map(|element| element.share).sum();
    if (sum - 1.0).abs() > 1e-6 {
        let message = format!("the shares of `gms` make {sum} together");
        return Err(ConfigError::at(&place, message).with_help("they make 1"));
    }
    Ok(Some(elements))
}
