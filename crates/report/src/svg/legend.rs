//! The legend of a picture.

use std::borrow::Cow;

use super::canvas::{Anchor, Area, Canvas, MARGIN, WIDTH, curve_class, widest_text};
use super::shape::BarShape;

/// Graphic element that a name of the legend belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LegendSample {
    /// The line of the series with this number.
    Line(usize),
    /// Markers.
    Marker(usize),
    /// Line with markers.
    MarkedLine(usize),
    /// A line in the colour of the axes.
    Thin,
    /// A marker in a ring.
    Ring,
    /// A bar of a state.
    Bar(BarShape),
}

/// Names with what they belong to, each once, in rows.
#[derive(Debug, Default)]
pub(super) struct Legend<'a> {
    items: Vec<(LegendSample, Cow<'a, str>)>,
}

/// The height of a row, with room for the larger letters of narrow windows.
const ROW: f64 = 20.0;

/// The width of a sample.
const SAMPLE: f64 = 28.0;

impl<'a> Legend<'a> {
    pub(super) fn name(&mut self, sample: LegendSample, name: impl Into<Cow<'a, str>>) {
        let item = (sample, name.into());
        if !self.items.contains(&item) {
            self.items.push(item);
        }
    }

    /// Draws the rows from a height on; returns where the room below them begins.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, top: f64) -> f64 {
        let (mut x, mut y) = (MARGIN, top);
        // Columns of one width.
        let widths = self.items.iter().map(|(_, name)| widest_text(name));
        let width = SAMPLE + 14.0 + widths.fold(0.0, f64::max);
        for (sample, name) in &self.items {
            if x > MARGIN && x + width > WIDTH - 10.0 {
                (x, y) = (MARGIN, y + ROW);
            }
            draw_sample(canvas, *sample, (x, y + 8.0));
            canvas.text("", (x + SAMPLE + 6.0, y + 12.0), Anchor::Start, name);
            x += width;
        }
        if self.items.is_empty() { top } else { y + ROW }
    }
}

fn draw_sample(canvas: &mut Canvas<'_>, sample: LegendSample, (x, y): (f64, f64)) {
    let middle = (x + SAMPLE / 2.0, y);
    match sample {
        LegendSample::Line(look) | LegendSample::MarkedLine(look) => {
            canvas.line(&curve_class(look), (x, y), (x + SAMPLE, y));
        }
        LegendSample::Thin => canvas.line("fc-curve fc-axis", (x, y), (x + SAMPLE, y)),
        LegendSample::Ring => {
            canvas.circle("fc-outline", middle, 4.5);
            canvas.circle("fc-m1", middle, 2.2);
        }
        LegendSample::Bar(shape) => shape.draw(
            canvas,
            Area {
                x,
                y: y - 6.0,
                width: SAMPLE,
                height: 12.0,
            },
        ),
        LegendSample::Marker(_) => {}
    }
    if let LegendSample::Marker(look) | LegendSample::MarkedLine(look) = sample {
        canvas.marker(look, middle);
    }
}
