//! The motion of axes in words: feed moves without friction compensation (R13.12), assumed limits, glitches.

use std::fmt::Write as _;

use super::strings::grouped;
use frictcomp::lists::AxisType;
use frictcomp::timeline::FeedMoves;
use frictcomp_physics::contour::{ContourReversal, GlitchFigure};
use frictcomp_physics::motion::AssumedLimits;

/// Returns the feed moves of an axis without compensation, as the text after its name:
/// ` off during 155 feed moves, the longest 812 mm` (R13.12). `None` if there are none.
pub fn feed_moves_text(moves: &FeedMoves, axis_type: AxisType) -> Option<String> {
    let (without, unknown) = (moves.without(), moves.unknown);
    let counted = |count| {
        let plural = if count == 1 { "" } else { "s" };
        format!("{} feed move{plural}", grouped(count))
    };
    if without == 0 {
        return (unknown > 0).then(|| format!(" perhaps off during {}", counted(unknown)));
    }
    let what = match (moves.off, moves.ineffective) {
        (_, 0) => "off",
        (0, _) => "without effect",
        _ => "off or without effect",
    };
    let mut text = format!(" {what} during {}", counted(without));
    if let Some(longest) = moves.longest {
        let known = if moves.unmeasured > 0 { " known" } else { "" };
        let unit = match axis_type {
            AxisType::Rotary => "\u{b0}",
            _ => " mm",
        };
        let long = plain_number(longest);
        let _ = match without {
            1 => write!(text, " of {long}{unit}"),
            _ => write!(text, ", the longest{known} {long}{unit}"),
        };
    }
    if unknown > 0 {
        let _ = write!(text, ", and perhaps during {} more", grouped(unknown));
    }
    Some(text)
}

/// Returns a number with three decimals at most.
fn plain_number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns one line for all axes with the same assumed limits: their values, and the keys that set them (R5.2, R11.23).
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

/// Returns the values, and the keys.
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

/// Returns the glitch as programmed, or the reason why it has no figure: "along the path".
pub(crate) fn glitch_in_words(reversal: &ContourReversal) -> String {
    match reversal.figure {
        GlitchFigure::Measured => format!("{:.1} µm", reversal.glitch_um.programmed),
        GlitchFigure::AlongPath => "along the path".to_owned(),
        GlitchFigure::Missing => "too near to a stop or a corner for a figure".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_are_counted_in_words() {
        // R13.12
        let text = |off, ineffective, unknown, longest, unmeasured| {
            let moves = FeedMoves {
                off,
                ineffective,
                unknown,
                longest,
                unmeasured,
            };
            feed_moves_text(&moves, AxisType::Linear).unwrap_or_default()
        };
        assert_eq!(text(0, 0, 0, None, 0), "");
        assert_eq!(
            text(1, 0, 0, Some(12.5), 0),
            " off during 1 feed move of 12.5 mm"
        );
        assert_eq!(
            text(1155, 0, 0, Some(812.0), 0),
            " off during 1 155 feed moves, the longest 812 mm"
        );
        assert_eq!(
            text(2, 1, 4, Some(0.1 + 0.2), 1),
            " off or without effect during 3 feed moves, the longest known 0.3 mm, \
             and perhaps during 4 more"
        );
        assert_eq!(
            text(0, 2, 0, None, 2),
            " without effect during 2 feed moves"
        );
        assert_eq!(text(0, 0, 1, None, 0), " perhaps off during 1 feed move");
        let turned = FeedMoves {
            off: 1,
            longest: Some(90.0),
            ..FeedMoves::default()
        };
        let turned = feed_moves_text(&turned, AxisType::Rotary);
        assert_eq!(
            turned.as_deref(),
            Some(" off during 1 feed move of 90\u{b0}")
        );
    }
}
