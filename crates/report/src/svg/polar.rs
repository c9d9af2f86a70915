//! The circular test as a circle whose deviation is magnified (R5.23).

use std::f64::consts::TAU;

use super::canvas::{Anchor, Canvas, Head, MARGIN, PictureRole, WIDTH, curve_class, text_width};
use super::frame::Frame;
use super::legend::{Legend, LegendSample};
use super::reduce::reduce;
use super::scale::{label, round_step};

/// One way round the circle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolarSeries {
    /// Name in the legend; series of one name have one row.
    pub name: String,
    /// Colour: 0 with compensation, 1 without.
    pub look: usize,
    /// Line style: finer for the other way round the circle.
    pub stroke: PolarStroke,
    /// Pairs of the angle from the first axis in rad and the radial deviation in µm, in the order
    /// of the motion.
    pub points: Vec<[f64; 2]>,
}

/// The line style of a way round the circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PolarStroke {
    /// Full line.
    #[default]
    Full,
    /// Finer, in dashes.
    Fine,
}

/// A circle with its own magnification.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolarPanel {
    /// The heading above it.
    pub label: String,
    /// The curves.
    pub series: Vec<PolarSeries>,
}

/// Radial deviations from a commanded circle, with an inset at a separate magnification next to it (R5.30).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolarChart {
    /// The heading.
    pub title: String,
    /// The picture in a sentence or two.
    pub description: String,
    /// The names of the axes, the one that points to the right first.
    pub axes: [String; 2],
    /// The commanded radius in mm.
    pub radius: f64,
    /// One circle, or one and the inset.
    pub panels: Vec<PolarPanel>,
}

/// The place and size of a panel.
#[derive(Debug, Clone, Copy)]
struct PanelLayout {
    centre: (f64, f64),
    /// The commanded circle.
    circle: f64,
    /// The greatest deviation, inward and outward.
    reach: f64,
}

/// The heading and the text above the circle.
const TOP: f64 = 112.0;

/// Size below which a circle has no room for the names of all rings.
const SMALL: f64 = 100.0;

/// The names of the quadrants around the rings.
const NAMES: f64 = 34.0;

impl PanelLayout {
    /// Returns the panel with a number, of a number of panels.
    fn of(number: usize, count: usize) -> Self {
        let (circle, reach) = match (number, count) {
            (_, 0 | 1) => (190.0, 110.0),
            (0, _) => (145.0, 88.0),
            _ => (74.0, 42.0),
        };
        let half = circle + reach + NAMES;
        let x = match (number, count) {
            (_, 0 | 1) => WIDTH / 2.0,
            (0, _) => 14.0 + half,
            _ => WIDTH - 14.0 - half,
        };
        Self {
            centre: (x, TOP + half),
            circle,
            reach,
        }
    }

    fn bottom(self) -> f64 {
        self.centre.1 + self.circle + self.reach + NAMES
    }

    fn left(self) -> f64 {
        (self.centre.0 - self.circle - self.reach - NAMES).max(MARGIN)
    }
}

impl PolarChart {
    /// Returns the picture; in each panel a scale bar shows the magnification of the deviation.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let mut canvas = Canvas::headed(Head {
            title: &self.title,
            description: &self.description,
            role: PictureRole::Image,
        });
        let mut legend = Legend::default();
        let count = self.panels.len();
        for (number, panel) in self.panels.iter().enumerate() {
            let layout = PanelLayout::of(number, count);
            let magnified = Magnified::of(panel, layout);
            canvas.text("", (layout.left(), 54.0), Anchor::Start, &panel.label);
            magnified.draw_rings(&mut canvas);
            self.draw_directions(&mut canvas, layout);
            for series in &panel.series {
                legend.name(LegendSample::Line(series.look), series.name.as_str());
                let kept = reduce(&series.points, |[angle, _]| angle / TAU * 1440.0);
                let class = match series.stroke {
                    PolarStroke::Full => curve_class(series.look),
                    PolarStroke::Fine => curve_class(series.look) + " fc-held",
                };
                canvas.path(&class, kept.iter().map(|&point| magnified.place(point)));
            }
            magnified.draw_bar(&mut canvas, self.radius);
        }
        let bottom = PanelLayout::of(0, count).bottom();
        let floor = legend.draw(&mut canvas, bottom);
        canvas.finish(frame, floor + 10.0)
    }

    fn draw_directions(&self, canvas: &mut Canvas<'_>, layout: PanelLayout) {
        let (x, y) = layout.centre;
        let reach = layout.circle + layout.reach + 8.0;
        canvas.line("fc-axis", (x - reach, y), (x + reach, y));
        canvas.line("fc-axis", (x, y - reach), (x, y + reach));
        let [first, second] = &self.axes;
        let plus = |axis: &str| format!("{axis}+");
        let minus = |axis: &str| format!("{axis}\u{2212}");
        let beside = reach + 8.0;
        let names = [
            ((x + beside, y + 5.0), Anchor::Start, plus(first)),
            ((x - beside, y + 5.0), Anchor::End, minus(first)),
            ((x, y - beside), Anchor::Middle, plus(second)),
            ((x, y + beside + 10.0), Anchor::Middle, minus(second)),
        ];
        for (place, anchor, name) in names {
            canvas.text("fc-title", place, anchor, &name);
        }
    }
}

/// The conversion of deviations to lengths.
struct Magnified {
    layout: PanelLayout,
    /// Units of the picture for a µm.
    factor: f64,
    /// The deviation between two rings in µm.
    step: f64,
    /// Rings on either side of the commanded circle.
    rings: f64,
}

impl Magnified {
    fn of(panel: &PolarPanel, layout: PanelLayout) -> Self {
        let values = panel.series.iter().flat_map(|series| &series.points);
        let largest = values
            .map(|point| point[1].abs())
            .filter(|deviation| deviation.is_finite())
            .fold(0.0, f64::max)
            .clamp(0.1, 1e12);
        let step = round_step(largest / 3.0);
        let rings = (largest / step).ceil();
        Self {
            layout,
            factor: layout.reach / (step * rings),
            step,
            rings,
        }
    }

    fn place(&self, [angle, deviation]: [f64; 2]) -> (f64, f64) {
        let PanelLayout { centre, circle, .. } = self.layout;
        let radius = circle + deviation * self.factor;
        (
            centre.0 + radius * angle.cos(),
            centre.1 - radius * angle.sin(),
        )
    }

    fn draw_rings(&self, canvas: &mut Canvas<'_>) {
        let PanelLayout { centre, circle, .. } = self.layout;
        let rings = (-8..=8).map(f64::from);
        for ring in rings.filter(|ring| ring.abs() <= self.rings) {
            let class = if ring == 0.0 { "fc-axis" } else { "fc-grid" };
            let radius = circle + ring * self.step * self.factor;
            canvas.circle(class, centre, radius);
            // Among small rings only the outermost ones and the circle have names.
            let is_named = ring == 0.0 || ring.abs() > self.rings - 0.5;
            if !is_named && self.layout.circle < SMALL {
                continue;
            }
            let mut text = label(ring * self.step, self.step);
            if ring > 0.0 {
                text.insert(0, '+');
            }
            if ring.abs() > self.rings - 0.5 {
                text.push_str(" \u{b5}m");
            }
            // Along a direction in which no quadrant changes.
            let (x, y) = (centre.0 + radius * 0.5, centre.1 - radius * 0.75_f64.sqrt());
            canvas.text("fc-quiet", (x + 3.0, y + 4.0), Anchor::Start, &text);
        }
    }

    /// Draws a length of the picture that is a round deviation, and the magnification in words.
    fn draw_bar(&self, canvas: &mut Canvas<'_>, radius: f64) {
        let (left, y) = (self.layout.left(), 74.0);
        let text = format!("{} \u{b5}m", label(self.step, self.step));
        canvas.scale_bar((left, y), self.step * self.factor, &text);
        if radius > 0.0 && radius.is_finite() {
            // The commanded circle is drawn `circle` long for `radius` millimetres.
            let times = self.factor * 1000.0 * radius / self.layout.circle;
            let times = label(round_to_two_digits(times), 1.0);
            let mm = label(radius, decimal_of(radius));
            let whole = format!("deviation magnified {times}\u{d7} against the circle of {mm} mm");
            let text = if left + text_width(&whole) < WIDTH - 16.0 {
                whole
            } else {
                format!("deviation magnified {times}\u{d7}")
            };
            canvas.text("fc-quiet", (left, y + 22.0), Anchor::Start, &text);
        }
    }
}

fn round_to_two_digits(value: f64) -> f64 {
    let unit = 10_f64.powf(value.max(1e-300).log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// Returns the step that shows a length to the micrometre, and no more digits than it has.
fn decimal_of(length: f64) -> f64 {
    [1.0, 0.1, 0.01]
        .into_iter()
        .find(|step| ((length / step).round() * step - length).abs() < 1e-9 * length)
        .unwrap_or(0.001)
}
