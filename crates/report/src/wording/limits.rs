//! Assumed limits of axes, for people.

use frictcomp::lists::AxisType;
use frictcomp_physics::motion::AssumedLimits;

/// One line for all axes with the same assumed limits: their values, and the keys that set them (R5.2,
/// R11.23).
pub fn assumed_limits<'a>(axes: impl IntoIterator<Item = &'a AssumedLimits>) -> Vec<String> {
    let mut assumed: Vec<([String; 2], Vec<&str>)> = Vec::new();
    for axis in axes {
        let words = words(axis);
        match assumed.iter_mut().find(|(known, _)| *known == words) {
            Some((_, names)) => names.push(&axis.axis),
            None => assumed.push((words, vec![&axis.axis])),
        }
    }
    let line = |([limits, keys], names): &([String; 2], Vec<&str>)| {
        format!(
            "limits assumed for {}: {limits}; give those of the machine in `frictcomp.toml`, with {keys}",
            names.join(" ")
        )
    };
    assumed.iter().map(line).collect()
}

/// The values, and the keys.
fn words(axis: &AssumedLimits) -> [String; 2] {
    let units = match axis.axis_type {
        AxisType::Linear => ["mm/min", "m/s²", "m/s³"],
        _ => ["°/min", "°/s²", "°/s³"],
    };
    let parts = [
        (axis.max_velocity, "`max_velocity`"),
        (axis.max_acceleration, "`max_acceleration`"),
        (axis.max_jerk, "`max_jerk`"),
    ];
    let parts = parts.into_iter().zip(units);
    let (values, keys): (Vec<String>, Vec<&str>) = parts
        .filter_map(|((value, key), unit)| Some((format!("{:.0} {unit}", value?), key)))
        .unzip();
    let keys = match keys.as_slice() {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        keys => keys.join(""),
    };
    [values.join(", "), keys]
}
