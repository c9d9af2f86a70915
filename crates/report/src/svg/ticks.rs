//! The x axis of a chart: its line, and the values at its ticks.

use super::canvas::{Anchor, Canvas, WIDTH, widest_text};
use super::scale::Scale;

/// The room between the values.
const ROOM: f64 = 10.0;

/// Side of the line on which the values stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TickSide {
    Below,
    Above,
}

/// Draws the line from a place on over a width, with its ticks and values. A value without room is omitted.
pub(super) fn draw_ticks(
    canvas: &mut Canvas<'_>,
    scale: &Scale,
    (left, y, width): (f64, f64, f64),
    side: TickSide,
) {
    let (tick, words) = match side {
        TickSide::Below => (y + 5.0, y + 18.0),
        TickSide::Above => (y - 5.0, y - 9.0),
    };
    canvas.line("fc-axis", (left, y), (left + width, y));
    let mut free = f64::NEG_INFINITY;
    for (value, text) in &scale.ticks {
        let x = left + scale.share(*value) * width;
        canvas.line("fc-axis", (x, y.min(tick)), (x, y.max(tick)));
        let half = widest_text(text) / 2.0;
        // The last value would be cut off at the edge.
        let middle = x.min(WIDTH - half - 4.0);
        if middle - half > free {
            canvas.text("fc-quiet", (middle, words), Anchor::Middle, text);
            free = middle + half + ROOM;
        }
    }
}

/// Draws the x axis with its values and its label from a place on over a width; returns where the room below
/// it begins.
pub(super) fn draw_x_axis(
    canvas: &mut Canvas<'_>,
    scale: &Scale,
    (left, y, width): (f64, f64, f64),
    label: &str,
) -> f64 {
    draw_ticks(canvas, scale, (left, y, width), TickSide::Below);
    canvas.text("", (left + width / 2.0, y + 36.0), Anchor::Middle, label);
    y + 42.0
}
