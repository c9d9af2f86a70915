//! The keys of a plant file, each once, with its unit and its range.

use super::plant::Preset;
use frictcomp::config::{Form, KeyForm, TableForm};

/// The names of the presets.
const PRESETS: [&str; Preset::ALL.len()] = {
    let mut names = [""; Preset::ALL.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = Preset::ALL[at].as_str();
        at += 1;
    }
    names
};

/// Maximum number of elements of the Maxwell-slip model.
pub(super) const MAX_ELEMENTS: usize = 20;

/// A key whose value is one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PlantQuantity {
    /// The moved mass; the gain of the speed loop and the damping of the contact follow from it.
    Mass,
    PositionGain,
    SpeedGain,
    IntegralTime,
    CurrentTime,
    VelocityForward,
    AccelerationForward,
    /// The force of a drive unit, in place of the rated force.
    ForcePerUnit,
    /// The rated force; the force of a drive unit and the largest force follow from it.
    RatedForce,
    MaxForce,
    Coulomb,
    Breakaway,
    StribeckVelocity,
    Viscous,
    StribeckShape,
    /// The stiffness of the contact; its damping and its elements follow from it.
    Stiffness,
    Damping,
    DampingVelocity,
    /// The dead zone between motor and load.
    Backlash,
}

/// A key of `[stiction]`, whose value is one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StictionKey {
    /// MP1511, the factor.
    Factor,
    /// MP1512, the limit in counting steps.
    Limit,
    /// The grating period of the encoder.
    GratingPeriod,
    /// The control loop cycle.
    Cycle,
    /// MP1513, the feed up to which it acts.
    Feed,
}

/// Facts about a key.
#[derive(Debug, Clone, Copy)]
pub(super) struct KeyFacts {
    /// The symbol of the equations.
    pub(super) key: &'static str,
    /// Unit, empty if it has none; except in `[stiction]` and for backlash those of SI.
    pub(super) unit: &'static str,
    /// The smallest and the largest accepted value. The ranges are wide; they guard against wrong units
    /// and against values that the step of the simulation could not follow.
    pub(super) range: [f64; 2],
}

impl PlantQuantity {
    pub(super) const ALL: [Self; 19] = [
        Self::Mass,
        Self::PositionGain,
        Self::SpeedGain,
        Self::IntegralTime,
        Self::CurrentTime,
        Self::VelocityForward,
        Self::AccelerationForward,
        Self::ForcePerUnit,
        Self::RatedForce,
        Self::MaxForce,
        Self::Coulomb,
        Self::Breakaway,
        Self::StribeckVelocity,
        Self::Viscous,
        Self::StribeckShape,
        Self::Stiffness,
        Self::Damping,
        Self::DampingVelocity,
        Self::Backlash,
    ];

    pub(super) const fn facts(self) -> KeyFacts {
        let (key, unit, range) = match self {
            Self::Mass => ("m", "kg", [0.01, 1e6]),
            Self::PositionGain => ("Kv", "1/s", [0.1, 2000.0]),
            Self::SpeedGain => ("Kp", "N·s/m", [0.1, 1e10]),
            Self::IntegralTime => ("Ti", "s", [1e-4, 1e6]),
            Self::CurrentTime => ("Tt", "s", [1e-5, 0.1]),
            Self::VelocityForward => ("k_ff", "", [0.0, 2.0]),
            Self::AccelerationForward => ("k_a", "", [0.0, 2.0]),
            Self::ForcePerUnit => ("k_I", "N per drive unit", [-1e6, 1e6]),
            Self::RatedForce => ("rated_force", "N", [0.01, 1e7]),
            Self::MaxForce => ("max_force", "N", [0.01, 1e8]),
            Self::Coulomb => ("Fc", "N", [0.0, 1e7]),
            Self::Breakaway => ("Fs", "N", [0.0, 1e7]),
            Self::StribeckVelocity => ("vs", "m/s", [1e-6, 1.0]),
            Self::Viscous => ("fv", "N·s/m", [0.0, 1e8]),
            Self::StribeckShape => ("delta", "", [0.1, 10.0]),
            Self::Stiffness => ("sigma0", "N/m", [1e3, 1e12]),
            Self::Damping => ("sigma1", "N·s/m", [0.0, 1e10]),
            Self::DampingVelocity => ("vd", "m/s", [1e-6, 10.0]),
            Self::Backlash => ("backlash_um", "µm", [0.0, 1000.0]),
        };
        KeyFacts { key, unit, range }
    }
}

impl StictionKey {
    pub(super) const ALL: [Self; 5] = [
        Self::Factor,
        Self::Limit,
        Self::GratingPeriod,
        Self::Cycle,
        Self::Feed,
    ];

    /// Returns the facts on a key; the units are those of the manual, and only MP1511 has a documented range (R8.3).
    pub(super) const fn facts(self) -> KeyFacts {
        let (key, unit, range) = match self {
            Self::Factor => ("mp1511", "µs", [0.0, 16_777_215.0]),
            Self::Limit => ("mp1512", "counting steps", [0.0, 1e6]),
            Self::GratingPeriod => ("gp", "µm", [1e-3, 1e4]),
            Self::Cycle => ("tc", "µs", [250.0, 1e5]),
            Self::Feed => ("mp1513", "m/min", [0.0, 1000.0]),
        };
        KeyFacts { key, unit, range }
    }
}

/// The elements of the Maxwell-slip model.
pub(super) const ELEMENTS: &str = "gms";
/// Key of the rate of slipping elements.
pub(super) const ATTRACTION: &str = "gms_C";

/// The table of stiction compensation.
pub(super) const STICTION: &str = "stiction";

/// Key of the name of the plant in reports.
pub(super) const NAME: &str = "name";
/// The plant that gives the missing values.
pub(super) const BASE: &str = "base";
/// The table of each axis.
pub(super) const AXES: [&str; 2] = ["x", "y"];

const COUNT: usize = PlantQuantity::ALL.len() + 3;

/// The keys of `[x]` and `[y]`.
pub(super) const AXIS_KEYS: [&str; COUNT] = {
    let mut keys = [""; COUNT];
    let mut at = 0;
    while at < PlantQuantity::ALL.len() {
        keys[at] = PlantQuantity::ALL[at].facts().key;
        at += 1;
    }
    keys[COUNT - 3] = ELEMENTS;
    keys[COUNT - 2] = ATTRACTION;
    keys[COUNT - 1] = STICTION;
    keys
};

/// The keys of `[stiction]`.
pub(super) const STICTION_KEYS: [&str; StictionKey::ALL.len()] = {
    let mut keys = [""; StictionKey::ALL.len()];
    let mut at = 0;
    while at < keys.len() {
        keys[at] = StictionKey::ALL[at].facts().key;
        at += 1;
    }
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

/// The name of a whole plant file in messages.
pub(super) const FILE: &str = "plant";
/// The headers of `[x]` and `[y]`, and of `[stiction]`.
pub(super) const AXIS_TABLE: &str = "[x] and [y]";
pub(super) const STICTION_TABLE: &str = "[stiction]";

const fn of(facts: KeyFacts) -> KeyForm {
    KeyForm {
        key: facts.key,
        form: Form::Within(facts.range),
        meaning: facts.unit,
    }
}

const fn key(key: &'static str, form: Form, meaning: &'static str) -> KeyForm {
    KeyForm { key, form, meaning }
}

const AXIS_FORMS: [KeyForm; COUNT] = {
    let mut forms = [key("", Form::Text, ""); COUNT];
    let mut at = 0;
    while at < PlantQuantity::ALL.len() {
        forms[at] = of(PlantQuantity::ALL[at].facts());
        at += 1;
    }
    let elements = "share and stiffness in N/m of each element";
    forms[COUNT - 3] = key(ELEMENTS, Form::Points(Some(MAX_ELEMENTS)), elements);
    forms[COUNT - 2] = key(ATTRACTION, Form::Positive, "N/s");
    forms[COUNT - 1] = key(
        STICTION,
        Form::Table(STICTION_TABLE),
        "stiction compensation",
    );
    forms
};

const STICTION_FORMS: [KeyForm; StictionKey::ALL.len()] = {
    let mut forms = [key("", Form::Text, ""); StictionKey::ALL.len()];
    let mut at = 0;
    while at < forms.len() {
        forms[at] = of(StictionKey::ALL[at].facts());
        at += 1;
    }
    forms
};

const FILE_FORMS: [KeyForm; COUNT + 4] = {
    let mut forms = [key("", Form::Text, ""); COUNT + 4];
    forms[0] = key(NAME, Form::Text, "what the plant is called in reports");
    forms[1] = key(
        BASE,
        Form::OneOf(&PRESETS),
        "the plant that gives the missing values",
    );
    forms[2] = key(AXES[0], Form::Table(AXIS_TABLE), "what differs for X");
    forms[3] = key(AXES[1], Form::Table(AXIS_TABLE), "what differs for Y");
    let mut at = 0;
    while at < COUNT {
        forms[at + 4] = AXIS_FORMS[at];
        at += 1;
    }
    forms
};

const fn table(header: &'static str, keys: &'static [KeyForm]) -> TableForm {
    TableForm {
        header,
        keys,
        free: None,
        required: &[],
    }
}

/// The tables of a plant file, the file itself first.
pub static PLANT_FORMS: [TableForm; 3] = [
    table(FILE, &FILE_FORMS),
    table(AXIS_TABLE, &AXIS_FORMS),
    table(STICTION_TABLE, &STICTION_FORMS),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_that_is_read_has_a_form() {
        // R17.6
        let formed =
            |table: &TableForm| -> Vec<&str> { table.keys.iter().map(|it| it.key).collect() };
        let [file, axis, stiction] = &PLANT_FORMS;
        assert_eq!(formed(file), FILE_KEYS);
        assert_eq!(formed(axis), AXIS_KEYS);
        assert_eq!(formed(stiction), STICTION_KEYS);
    }
}
