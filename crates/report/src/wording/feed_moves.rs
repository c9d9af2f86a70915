//! The feed moves without friction compensation, in words (R13.12).

use std::fmt::Write as _;

use super::strings::grouped;
use frictcomp::lists::AxisType;
use frictcomp::timeline::FeedMoves;

/// The feed moves of an axis without compensation, as the text after its name: ` off during 155 feed
/// moves, the longest 812 mm` (R13.12). `None` if there are none.
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

/// A number with three decimals at most.
fn plain_number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
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
