//! Reversals as records.

use serde_json::{Map, Value, json};

use crate::timeline::field;
use frictcomp_physics::contour::ContourReversal;

/// The columns of [`csv_row`].
pub const CSV_HEADER: &str = "axis,file,line,n,t,position,feed,acceleration,movement,state,current_before,current_after,glitch,glitch_on,glitch_off,feed_programmed\n";

/// A number with as many decimals as matter.
pub(super) fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    let rounded = (value * scale).round() / scale;
    // No negative zero.
    rounded + 0.0
}

fn position(reversal: &ContourReversal, names: &[String]) -> Map<String, Value> {
    let places = names.iter().zip(&reversal.positions);
    places
        .map(|(name, place)| (name.clone(), rounded(*place, 4).into()))
        .collect()
}

/// A reversal: µm, mm, mm/min, mm/s², s, currents in drive units.
pub fn reversal_record(reversal: &ContourReversal, names: &[String]) -> Value {
    let glitch = &reversal.glitch_um;
    let figure = |um: f64| reversal.has_figure().then(|| rounded(um, 3));
    json!({
        "axis": reversal.axis,
        "file": &*reversal.file,
        "line": reversal.line,
        "n": reversal.number,
        "t": rounded(reversal.time_s, 6),
        "position": position(reversal, names),
        "feed": rounded(reversal.feed_mm_per_min, 3),
        "feed_programmed": reversal.programmed_mm_per_min.map(|feed| rounded(feed, 3)),
        "acceleration": rounded(reversal.acceleration_mm_per_s2, 3),
        "movement": reversal.movement.as_str(),
        "state": reversal.state.as_str(),
        "current": reversal.current_units.map(|current| rounded(current, 3)),
        "glitch": figure(glitch.programmed),
        "glitch_on": figure(glitch.all_on),
        "glitch_off": figure(glitch.all_off),
    })
}

/// A reversal as a row of [`CSV_HEADER`].
pub fn csv_row(reversal: &ContourReversal, names: &[String]) -> String {
    let glitch = &reversal.glitch_um;
    let figure = |um: f64| {
        let um = reversal.has_figure().then(|| rounded(um, 3));
        um.map_or(String::new(), |um| um.to_string())
    };
    let places = names.iter().zip(&reversal.positions);
    let places: Vec<String> = places
        .map(|(name, place)| format!("{name}{}", rounded(*place, 4)))
        .collect();
    let fields = [
        reversal.axis.clone(),
        reversal.file.to_string(),
        reversal.line.to_string(),
        reversal.number.map_or(String::new(), |n| n.to_string()),
        rounded(reversal.time_s, 6).to_string(),
        places.join(" "),
        rounded(reversal.feed_mm_per_min, 3).to_string(),
        rounded(reversal.acceleration_mm_per_s2, 3).to_string(),
        reversal.movement.as_str().to_owned(),
        reversal.state.as_str().to_owned(),
        rounded(reversal.current_units[0], 3).to_string(),
        rounded(reversal.current_units[1], 3).to_string(),
        figure(glitch.programmed),
        figure(glitch.all_on),
        figure(glitch.all_off),
        reversal
            .programmed_mm_per_min
            .map_or(String::new(), |feed| rounded(feed, 3).to_string()),
    ];
    let mut row = Vec::new();
    for (at, text) in fields.iter().enumerate() {
        if at > 0 {
            row.push(b',');
        }
        if text.parse::<f64>().is_ok() {
            // A negative number is no text that a spreadsheet would compute (R9.76).
            row.extend_from_slice(text.as_bytes());
        } else {
            field(&mut row, text);
        }
    }
    row.push(b'\n');
    String::from_utf8_lossy(&row).into_owned()
}
