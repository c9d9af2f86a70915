//! The plant that a plant file describes.

use std::sync::Arc;

use super::clock::{POSITION_LOOP_S, STEP_S};
use super::friction::GmsElement;
use super::parameters::DriveParameters;
use super::plant::{Plant, Preset, UnknownPreset};
use super::plant_file::{DriveTable, PlantFile, StictionTable};
use super::plant_keys::{PlantQuantity, StictionKey};
use crate::stiction::StictionParameters;
use frictcomp::config::ConfigError;
use frictcomp::diagnostic::Advice;
use frictcomp::lists::Given;
use frictcomp::text::SourceFile;

impl Plant {
    /// Reads the plant from a TOML file. Keys at the top are for both axes, those in `[x]` and
    /// `[y]` for one; missing values come from the plant that `base` names, `stiff` without it.
    ///
    /// # Errors
    /// FC110 with the place: invalid TOML, an unknown key, a value out of its range, or values that do
    /// not fit together.
    pub fn from_toml(source: SourceFile) -> Result<Self, ConfigError> {
        let source = Arc::new(source);
        let file = PlantFile::parse(&source)?;
        let base = match &file.base {
            Some(name) => base(name)?,
            None => Preset::default(),
        };
        let both = overridden(&DriveParameters::of(base), &file.both)?;
        let one = |table: Option<DriveTable>| match table {
            Some(table) => overridden(&both, &table),
            None => Ok(both.clone()),
        };
        let [x, y] = file.axes.map(one);
        Ok(Self {
            x: x?,
            y: y?,
            name: file.name.unwrap_or_else(|| source.name().to_string()),
        })
    }
}

fn base(name: &Given<String>) -> Result<Preset, ConfigError> {
    name.value.parse().map_err(|unknown: UnknownPreset| {
        let help = match unknown.near() {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => format!("there are {}", Preset::names()),
        };
        ConfigError::at(name, unknown.to_string()).with_help(help)
    })
}

/// Returns a drive with the values of a table in place of its own. Values that follow from others by a formula follow
/// from the new ones, unless they are given themselves.
fn overridden(drive: &DriveParameters, table: &DriveTable) -> Result<DriveParameters, ConfigError> {
    let mut drive = drive.clone();
    if let Some(mass) = table.number(PlantQuantity::Mass) {
        drive.set_mass(mass);
    }
    if let Some(force) = table.number(PlantQuantity::RatedForce) {
        drive.set_rated_force(force);
    }
    if let Some(stiffness) = table.number(PlantQuantity::Stiffness) {
        drive.set_stiffness(stiffness);
    }
    if let Some(micrometres) = table.number(PlantQuantity::Backlash) {
        drive.backlash_m = micrometres * 1e-6;
    }
    for (quantity, number) in table.numbers() {
        if let Some(parameter) = parameter(&mut drive, quantity) {
            *parameter = number;
        }
    }
    if let Some(attraction) = table.attraction {
        drive.friction.attraction_n_per_s = attraction;
    }
    if let Some(elements) = &table.elements {
        let element = |&[share, stiffness_n_per_m]: &[f64; 2]| GmsElement {
            share,
            stiffness_n_per_m,
        };
        drive.friction.elements = elements.iter().map(element).collect();
    }
    if let Some(stiction) = &table.stiction {
        drive.stiction = Some(compensated(drive.stiction.unwrap_or_default(), stiction)?);
    }
    check(&drive, table)?;
    Ok(drive)
}

/// Returns the stiction compensation with the values of a table in place of its own.
fn compensated(
    mut parameters: StictionParameters,
    table: &StictionTable,
) -> Result<StictionParameters, ConfigError> {
    for (key, given) in table.numbers() {
        let number = given.value;
        match key {
            StictionKey::Factor => parameters.mp1511_us = number,
            StictionKey::Limit => parameters.mp1512 = number,
            StictionKey::GratingPeriod => parameters.gp_um = number,
            StictionKey::Feed => parameters.mp1513_m_per_min = Some(number),
            StictionKey::Cycle => {
                parameters.tc_us = number;
                let cycles = number * 1e-6 / POSITION_LOOP_S;
                if (cycles - cycles.round()).abs() > 1e-6 {
                    let message = format!(
                        "`tc` is {number} µs; it must be a multiple of 250 µs, the cycle of the \
                         position loop"
                    );
                    return Err(ConfigError::at(given, message));
                }
            }
        }
    }
    Ok(parameters)
}

/// Returns the parameter of a number; `None` if others follow from it or it has another unit.
pub(super) fn parameter(drive: &mut DriveParameters, quantity: PlantQuantity) -> Option<&mut f64> {
    let friction = &mut drive.friction;
    Some(match quantity {
        PlantQuantity::Mass => &mut drive.mass_kg,
        PlantQuantity::PositionGain => &mut drive.position_gain_per_s,
        PlantQuantity::SpeedGain => &mut drive.speed_gain_n_s_per_m,
        PlantQuantity::IntegralTime => &mut drive.integral_time_s,
        PlantQuantity::CurrentTime => &mut drive.current_time_s,
        PlantQuantity::VelocityForward => &mut drive.velocity_forward,
        PlantQuantity::AccelerationForward => &mut drive.acceleration_forward,
        PlantQuantity::ForcePerUnit => &mut drive.force_per_unit_n,
        PlantQuantity::RatedForce | PlantQuantity::Backlash => return None,
        PlantQuantity::MaxForce => &mut drive.max_force_n,
        PlantQuantity::Coulomb => &mut friction.coulomb_n,
        PlantQuantity::Breakaway => &mut friction.breakaway_n,
        PlantQuantity::StribeckVelocity => &mut friction.stribeck_velocity_m_per_s,
        PlantQuantity::Viscous => &mut friction.viscous_n_s_per_m,
        PlantQuantity::StribeckShape => &mut friction.shape,
        PlantQuantity::Stiffness => &mut friction.stiffness_n_per_m,
        PlantQuantity::Damping => &mut friction.damping_n_s_per_m,
        PlantQuantity::DampingVelocity => &mut friction.damping_velocity_m_per_s,
    })
}

/// Checks the relations between the values.
fn check(drive: &DriveParameters, table: &DriveTable) -> Result<(), ConfigError> {
    let friction = &drive.friction;
    let refuse = |quantity, message, help: Advice| Err(table.refuse(quantity, message, help));
    if friction.coulomb_n <= 0.0 && friction.breakaway_n > 0.0 {
        let message = "`Fs` without `Fc`: nothing is left to slide against".to_owned();
        return refuse(
            PlantQuantity::Coulomb,
            message,
            "write both, or 0 for both".into(),
        );
    }
    if friction.breakaway_n < friction.coulomb_n {
        let message = format!(
            "`Fs` is {} N and less than `Fc`, {} N",
            friction.breakaway_n, friction.coulomb_n
        );
        let help = "the breakaway friction is at least the Coulomb friction";
        return refuse(PlantQuantity::Breakaway, message, help.into());
    }
    // Both limits are those of the explicit step, which cannot follow a contact that swings faster.
    let most = drive.mass_kg / (STEP_S * STEP_S);
    if friction.stiffness_n_per_m > most {
        let message = format!(
            "a contact of {} N/m is too stiff for {} kg: the step of {STEP_S} s cannot follow it",
            friction.stiffness_n_per_m, drive.mass_kg
        );
        let help = format!("`sigma0` is at most {most:.3e} here");
        return refuse(PlantQuantity::Stiffness, message, help.into());
    }
    let most = drive.mass_kg / STEP_S;
    let damping = friction.damping_n_s_per_m + friction.viscous_n_s_per_m;
    if damping > most {
        let message = format!(
            "a damping of {damping} N·s/m is too strong for {} kg: the step of {STEP_S} s cannot \
             follow it",
            drive.mass_kg
        );
        let help = format!("`sigma1` + `fv` is at most {most:.3e} here");
        return refuse(PlantQuantity::Damping, message, help.into());
    }
    Ok(())
}
