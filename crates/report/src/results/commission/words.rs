//! Words and numbers of measuring programs.

use frictcomp::diagnostic::Rounded;
use frictcomp_recordings::commission::{MeasuredAxis, Measurement, MeasuringProgram};

/// Returns the measurement of a program in a few words.
pub(super) fn told(program: &MeasuringProgram, axes: &[MeasuredAxis]) -> String {
    let name = |axis: usize| axes.get(axis).map_or("?", |it| it.name.as_str());
    match &program.role {
        Measurement::Friction { axis, speeds } => format!(
            "{} at {} speeds, {} to {} {}/s",
            name(*axis),
            speeds.len(),
            number(speeds.first().copied().unwrap_or_default()),
            Rounded(speeds.last().copied().unwrap_or_default(), 1),
            axes.get(*axis).map_or("mm", MeasuredAxis::unit),
        ),
        Measurement::Circles { feed, radius } => format!(
            "circles of {} and {}, F{}, radius {} mm",
            name(0),
            name(1),
            number(*feed),
            number(*radius)
        ),
        Measurement::Strokes { axis, feeds } => format!(
            "strokes of {} at {} feeds; motor side, not contour",
            name(*axis),
            feeds.len()
        ),
    }
}

/// Returns a number in a program, to a tenth of a µm.
pub(super) fn number(value: f64) -> String {
    let text = Rounded(value, 4).to_string();
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
