//! Reversals as records.

use serde_json::{Map, Value, json};

use crate::wording::{push_row, rounded};
use frictcomp_physics::contour::ContourReversal;

/// The columns of [`push_csv_row`].
pub(super) const CSV_HEADER: &str = "axis,file,line,n,t,position,feed,acceleration,movement,state,current_before,current_after,glitch,glitch_on,glitch_off,feed_programmed\n";

fn position(reversal: &ContourReversal, names: &[String]) -> Map<String, Value> {
    let places = names.iter().zip(&reversal.positions);
    places
        .map(|(name, place)| (name.clone(), (*place).into()))
        .collect()
}

/// Returns a reversal: µm, mm, mm/min, mm/s², s, currents in drive units.
pub(super) fn reversal_record(reversal: &ContourReversal, names: &[String]) -> Value {
    let glitch = &reversal.glitch_um;
    let figure = |um: f64| reversal.has_figure().then_some(um);
    json!({
        "axis": reversal.axis,
        "file": &*reversal.file,
        "line": reversal.line,
        "n": reversal.number,
        "t": reversal.time_s,
        "position": position(reversal, names),
        "feed": reversal.feed_mm_per_min,
        "feed_programmed": reversal.programmed_mm_per_min,
        "acceleration": reversal.acceleration_mm_per_s2,
        "movement": reversal.movement.as_str(),
        "state": reversal.state.as_str(),
        "current": reversal.current_units,
        "glitch": figure(glitch.programmed),
        "glitch_on": figure(glitch.all_on),
        "glitch_off": figure(glitch.all_off),
    })
}

/// Appends a reversal as a row of [`CSV_HEADER`].
pub(super) fn push_csv_row(out: &mut Vec<u8>, reversal: &ContourReversal, names: &[String]) {
    let glitch = &reversal.glitch_um;
    let figure = |um: f64| json!(reversal.has_figure().then_some(um));
    let places = names.iter().zip(&reversal.positions);
    let places: Vec<String> = places
        .map(|(name, place)| format!("{name}{}", rounded(*place)))
        .collect();
    let [before, after] = reversal.current_units;
    let cells = [
        json!(reversal.axis),
        json!(*reversal.file),
        json!(reversal.line),
        json!(reversal.number),
        json!(reversal.time_s),
        json!(places.join(" ")),
        json!(reversal.feed_mm_per_min),
        json!(reversal.acceleration_mm_per_s2),
        json!(reversal.movement.as_str()),
        json!(reversal.state.as_str()),
        json!(before),
        json!(after),
        figure(glitch.programmed),
        figure(glitch.all_on),
        figure(glitch.all_off),
        json!(reversal.programmed_mm_per_min),
    ];
    push_row(out, &cells);
}
