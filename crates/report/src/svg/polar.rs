//! The circular test as a circle whose deviation is magnified (R5.23).

use std::f64::consts::TAU;

use super::canvas::{
    Anchor, Canvas, Head, Legend, LegendItem, LegendLook, Role, SERIES, WIDTH, text_width,
};
use super::frame::Frame;
use super::reduce::reduce;
use super::scale::{label, round_step};

/// One way round the circle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolarSeries {
    /// Its name in the legend.
    pub name: String,
    /// Pairs of the angle from the first axis in rad and the radial deviation in µm, in the order
    /// of the motion.
    pub points: Vec<[f64; 2]>,
}

/// A circle with its own magnification.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolarPanel {
    /// What it shows, above it.
    pub label: String,
    /// The curves.
    pub series: Vec<PolarSeries>,
}

/// Radial deviations from a commanded circle, one panel beside the other.
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
    /// One or two circles.
    pub panels: Vec<PolarPanel>,
}

/// Where a panel is, and how large.
#[derive(Debug, Clone, Copy)]
struct Layout {
    centre: (f64, f64),
    /// The commanded circle.
    circle: f64,
    /// The greatest deviation, inward and outward.
    reach: f64,
}

/// The heading and what stands above the circle.
const TOP: f64 = 112.0;

/// The names of the quadrants around the rings.
const NAMES: f64 = 34.0;

impl Layout {
    /// The panel with a number out of so many.
    fn of(number: usize, count: usize) -> Self {
        let (circle, reach) = if count > 1 {
            (105.0, 62.0)
        } else {
            (190.0, 110.0)
        };
        #[allow(clippy::cast_precision_loss)] // two
        let [number, count] = [number, count.max(1)].map(|it| it as f64);
        Self {
            centre: (WIDTH * (number + 0.5) / count, TOP + NAMES + reach + circle),
            circle,
            reach,
        }
    }

    fn bottom(self) -> f64 {
        self.centre.1 + self.circle + self.reach + NAMES
    }

    fn left(self) -> f64 {
        (self.centre.0 - self.circle - self.reach - NAMES).max(16.0)
    }
}

impl PolarChart {
    /// The picture; in each panel a scale bar says how far the deviation is magnified.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let mut canvas = Canvas::default();
        canvas.text("fc-title", (16.0, 26.0), Anchor::Start, &self.title);
        let count = self.panels.len();
        for (number, panel) in self.panels.iter().enumerate() {
            let layout = Layout::of(number, count);
            let magnified = Magnified::of(panel, layout);
            canvas.text("", (layout.left(), 54.0), Anchor::Start, &panel.label);
            magnified.draw_rings(&mut canvas);
            self.draw_directions(&mut canvas, layout);
            for (number, series) in panel.series.iter().enumerate() {
                let number = number % SERIES;
                let kept = reduce(&series.points, |[angle, _]| angle / TAU * 1440.0);
                let class = format!("fc-curve fc-s{number}");
                canvas.path(&class, kept.iter().map(|&point| magnified.place(point)));
            }
            magnified.draw_bar(&mut canvas, self.radius);
        }
        let bottom = Layout::of(0, count).bottom();
        let longest = self.panels.iter().max_by_key(|panel| panel.series.len());
        let named = longest.map_or(&[][..], |panel| &panel.series);
        let legend = Legend {
            items: (named.iter().enumerate())
                .map(|(look, series)| LegendItem {
                    look,
                    name: &series.name,
                    drawn: LegendLook::Line,
                })
                .collect(),
        };
        let height = legend.draw(&mut canvas, (16.0, bottom)) + bottom + 10.0;
        canvas.finish(
            frame,
            &Head {
                title: &self.title,
                description: &self.description,
                height,
                role: Role::Image,
            },
        )
    }

    fn draw_directions(&self, canvas: &mut Canvas, layout: Layout) {
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

/// How deviations become lengths.
struct Magnified {
    layout: Layout,
    /// Units of the picture for a µm.
    factor: f64,
    /// The deviation between two rings in µm.
    step: f64,
    /// Rings on either side of the commanded circle.
    rings: f64,
}

impl Magnified {
    fn of(panel: &PolarPanel, layout: Layout) -> Self {
        let values = panel.series.iter().flat_map(|series| &series.points);
        let largest = values
            .map(|point| point[1].abs())
            .filter(|deviation| deviation.is_finite())
            .fold(0.0, f64::max)
            .clamp(1e-6, 1e12);
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
        let Layout { centre, circle, .. } = self.layout;
        let radius = circle + deviation * self.factor;
        (
            centre.0 + radius * angle.cos(),
            centre.1 - radius * angle.sin(),
        )
    }

    fn draw_rings(&self, canvas: &mut Canvas) {
        let Layout { centre, circle, .. } = self.layout;
        let rings = (-8..=8).map(f64::from);
        for ring in rings.filter(|ring| ring.abs() <= self.rings) {
            let class = if ring == 0.0 { "fc-axis" } else { "fc-grid" };
            let radius = circle + ring * self.step * self.factor;
            canvas.circle(class, centre, radius);
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

    /// A length of the picture that is a round deviation, and the magnification in words.
    fn draw_bar(&self, canvas: &mut Canvas, radius: f64) {
        let (left, y) = (self.layout.left(), 74.0);
        let right = left + self.step * self.factor;
        canvas.line("fc-axis", (left, y), (right, y));
        canvas.line("fc-axis", (left, y - 5.0), (left, y + 5.0));
        canvas.line("fc-axis", (right, y - 5.0), (right, y + 5.0));
        let text = format!("{} \u{b5}m", label(self.step, self.step));
        canvas.text("", (right + 8.0, y + 4.0), Anchor::Start, &text);
        if radius > 0.0 && radius.is_finite() {
            // The commanded circle is drawn `circle` long for `radius` millimetres.
            let times = self.factor * 1000.0 * radius / self.layout.circle;
            let text = format!(
                "deviation magnified {}\u{d7} against the circle of {} mm",
                label(round_to_two_digits(times), 1.0),
                label(radius, decimal_of(radius)),
            );
            canvas.text("fc-quiet", (left, y + 22.0), Anchor::Start, &text);
            debug_assert!(text_width(&text) < WIDTH, "it fits into a picture");
        }
    }
}

fn round_to_two_digits(value: f64) -> f64 {
    let unit = 10_f64.powf(value.max(1e-300).log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// The step that shows a length to the micrometre, and no more digits than it has.
fn decimal_of(length: f64) -> f64 {
    [1.0, 0.1, 0.01]
        .into_iter()
        .find(|step| ((length / step).round() * step - length).abs() < 1e-9 * length)
        .unwrap_or(0.001)
}
