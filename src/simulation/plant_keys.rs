//! The keys of a plant file, each once: its unit, its range, and what it sets.

use super::parameters::DriveParameters;

/// A key whose value is one number.
pub(super) struct Quantity {
    /// The symbol of the equations.
    pub(super) key: &'static str,
    /// Its SI unit; empty where it has none.
    pub(super) unit: &'static str,
    /// The smallest value that is accepted.
    pub(super) least: f64,
    /// The largest value that is accepted.
    pub(super) most: f64,
    /// The parameter that it is; `None` where others follow from it.
    pub(super) parameter: Option<Parameter>,
}

/// Where a number has its place in a drive.
type Parameter = fn(&mut DriveParameters) -> &mut f64;

/// The moved mass; the gain of the speed loop and the damping of the contact follow from it.
pub(super) const MASS: &str = "m";
/// The rated force; the force of a drive unit and the largest force follow from it.
pub(super) const RATED_FORCE: &str = "rated_force";
/// The force of a drive unit, in place of the rated force.
pub(super) const FORCE_PER_UNIT: &str = "k_I";
/// The stiffness of the contact; its damping and its elements follow from it.
pub(super) const STIFFNESS: &str = "sigma0";

/// Every number. The ranges are wide; they are there against wrong units and against values that
/// the step of the simulation could not follow.
pub(super) static QUANTITIES: [Quantity; 18] = [
    quantity(MASS, "kg", [0.01, 1e6], |it| &mut it.mass_kg),
    quantity("Kv", "1/s", [0.1, 2000.0], |it| &mut it.position_gain_per_s),
    quantity("Kp", "N·s/m", [0.1, 1e10], |it| {
        &mut it.speed_gain_n_s_per_m
    }),
    quantity("Ti", "s", [1e-4, 1e6], |it| &mut it.integral_time_s),
    quantity("Tt", "s", [1e-5, 0.1], |it| &mut it.current_time_s),
    quantity("k_ff", "", [0.0, 2.0], |it| &mut it.velocity_forward),
    quantity("k_a", "", [0.0, 2.0], |it| &mut it.acceleration_forward),
    quantity(FORCE_PER_UNIT, "N per drive unit", [-1e6, 1e6], |it| {
        &mut it.force_per_unit_n
    }),
    Quantity {
        key: RATED_FORCE,
        unit: "N",
        least: 0.01,
        most: 1e7,
        parameter: None,
    },
    quantity("max_force", "N", [0.01, 1e8], |it| &mut it.max_force_n),
    quantity("Fc", "N", [0.0, 1e7], |it| &mut it.friction.coulomb_n),
    quantity("Fs", "N", [0.0, 1e7], |it| &mut it.friction.breakaway_n),
    quantity("vs", "m/s", [1e-6, 1.0], |it| {
        &mut it.friction.stribeck_velocity_m_per_s
    }),
    quantity("fv", "N·s/m", [0.0, 1e8], |it| {
        &mut it.friction.viscous_n_s_per_m
    }),
    quantity("delta", "", [0.1, 10.0], |it| &mut it.friction.shape),
    quantity(STIFFNESS, "N/m", [1e3, 1e12], |it| {
        &mut it.friction.stiffness_n_per_m
    }),
    quantity("sigma1", "N·s/m", [0.0, 1e10], |it| {
        &mut it.friction.damping_n_s_per_m
    }),
    quantity("vd", "m/s", [1e-6, 10.0], |it| {
        &mut it.friction.damping_velocity_m_per_s
    }),
];

const fn quantity(
    key: &'static str,
    unit: &'static str,
    [least, most]: [f64; 2],
    parameter: Parameter,
) -> Quantity {
    Quantity {
        key,
        unit,
        least,
        most,
        parameter: Some(parameter),
    }
}

/// The elements of the Maxwell-slip model.
pub(super) const ELEMENTS: &str = "gms";
/// How fast those that slip follow the friction.
pub(super) const ATTRACTION: &str = "gms_C";

/// What the plant is called in reports.
pub(super) const NAME: &str = "name";
/// The plant that gives the missing values.
pub(super) const BASE: &str = "base";
/// The table of each axis.
pub(super) const AXES: [&str; 2] = ["x", "y"];

const COUNT: usize = QUANTITIES.len() + 2;

/// The keys of `[x]` and `[y]`.
pub(super) const AXIS_KEYS: [&str; COUNT] = {
    let mut keys = [""; COUNT];
    let mut at = 0;
    while at < QUANTITIES.len() {
        keys[at] = QUANTITIES[at].key;
        at += 1;
    }
    keys[COUNT - 2] = ELEMENTS;
    keys[COUNT - 1] = ATTRACTION;
    keys
};

/// The keys at the top of the file: its own, and for both axes those of one.
pub(super) const FILE_KEYS: [&str; COUNT + 4] = {
    let mut keys = [""; COUNT + 4];
    [keys[0], keys[1], keys[2], keys[3]] = [NAME, BASE, AXES[0], AXES[1]];
    let mut at = 0;
    while at < COUNT {
        keys[at + 4] = AXIS_KEYS[at];
        at += 1;
    }
    keys
};
