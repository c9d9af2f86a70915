//! The glitch at a reversal in words.

use frictcomp_physics::contour::{ContourReversal, GlitchFigure};

/// The glitch as programmed, or the reason why it has no figure: "along the path".
pub(crate) fn glitch_in_words(reversal: &ContourReversal) -> String {
    match reversal.figure {
        GlitchFigure::Measured => format!("{:.1} µm", reversal.glitch_um.programmed),
        GlitchFigure::AlongPath => "along the path".to_owned(),
        GlitchFigure::Missing => "too near to a stop or a corner for a figure".to_owned(),
    }
}
