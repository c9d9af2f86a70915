//! The circular test as a circle whose deviation is magnified (R5.23).

use std::f64::consts::TAU;

use super::canvas::{Anchor, Canvas, Head, Legend, Marks, Role, SERIES, WIDTH, text_width};
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

/// Radial deviations from a commanded circle.
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
    /// The curves.
    pub series: Vec<PolarSeries>,
}

/// The commanded circle in the picture.
const CIRCLE: f64 = 190.0;

/// The greatest deviation in the picture, inward and outward.
const REACH: f64 = 110.0;

const CENTRE: (f64, f64) = (WIDTH / 2.0, 384.0);

/// The room that the circle takes, with the names of the quadrants.
const BOTTOM: f64 = 384.0 + CIRCLE + REACH + 34.0;

impl PolarChart {
    /// The picture, with a scale bar that says how far the deviation is magnified.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let mut canvas = Canvas::default();
        canvas.text("fc-title", (16.0, 26.0), Anchor::Start, &self.title);
        let values = self.series.iter().flat_map(|series| &series.points);
        let largest = values
            .map(|point| point[1].abs())
            .filter(|deviation| deviation.is_finite())
            .fold(0.0, f64::max)
            .clamp(1e-6, 1e12);
        let step = round_step(largest / 3.0);
        let magnified = Magnified {
            factor: REACH / (step * (largest / step).ceil()),
            step,
        };
        magnified.draw_rings(&mut canvas, largest);
        self.draw_directions(&mut canvas);
        for (number, series) in self.series.iter().enumerate() {
            let number = number % SERIES;
            let kept = reduce(&series.points, |[angle, _]| angle / TAU * 1440.0);
            let class = format!("fc-curve fc-s{number}");
            canvas.path(&class, kept.iter().map(|&point| magnified.place(point)));
        }
        magnified.draw_bar(&mut canvas, self.radius);
        let legend = Legend {
            items: (self.series.iter().enumerate())
                .map(|(number, series)| (number, series.name.as_str(), Marks::Without))
                .collect(),
        };
        let height = legend.draw(&mut canvas, (16.0, BOTTOM)) + BOTTOM + 10.0;
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

    fn draw_directions(&self, canvas: &mut Canvas) {
        let (x, y) = CENTRE;
        let reach = CIRCLE + REACH + 8.0;
        canvas.line("fc-axis", (x - reach, y), (x + reach, y));
        canvas.line("fc-axis", (x, y - reach), (x, y + reach));
        let [first, second] = &self.axes;
        let name = |axis: &str, sign: &str| format!("{axis}{sign}");
        let plus = |axis: &str| name(axis, "+");
        let minus = |axis: &str| name(axis, "\u{2212}");
        let beside = reach + 8.0;
        canvas.text(
            "fc-title",
            (x + beside, y + 5.0),
            Anchor::Start,
            &plus(first),
        );
        canvas.text(
            "fc-title",
            (x - beside, y + 5.0),
            Anchor::End,
            &minus(first),
        );
        canvas.text("fc-title", (x, y - beside), Anchor::Middle, &plus(second));
        canvas.text(
            "fc-title",
            (x, y + beside + 10.0),
            Anchor::Middle,
            &minus(second),
        );
    }
}

/// How deviations become lengths.
struct Magnified {
    /// Units of the picture for a µm.
    factor: f64,
    /// The deviation between two rings in µm.
    step: f64,
}

impl Magnified {
    fn place(&self, [angle, deviation]: [f64; 2]) -> (f64, f64) {
        let radius = CIRCLE + deviation * self.factor;
        (
            CENTRE.0 + radius * angle.cos(),
            CENTRE.1 - radius * angle.sin(),
        )
    }

    fn draw_rings(&self, canvas: &mut Canvas, largest: f64) {
        let count = (largest / self.step).ceil();
        let rings = (-8..=8).map(f64::from).filter(|ring| ring.abs() <= count);
        for ring in rings {
            let class = if ring == 0.0 { "fc-axis" } else { "fc-grid" };
            let radius = CIRCLE + ring * self.step * self.factor;
            canvas.circle(class, CENTRE, radius);
            let mut text = label(ring * self.step, self.step);
            if ring > 0.0 {
                text.insert(0, '+');
            }
            // Along a direction in which no quadrant changes.
            let (x, y) = (CENTRE.0 + radius * 0.5, CENTRE.1 - radius * 0.75_f64.sqrt());
            canvas.text("fc-quiet", (x + 3.0, y + 4.0), Anchor::Start, &text);
        }
    }

    /// A length of the picture that is a round deviation, and the magnification in words.
    fn draw_bar(&self, canvas: &mut Canvas, radius: f64) {
        let (left, y) = (16.0, 62.0);
        let right = left + self.step * self.factor;
        canvas.line("fc-axis", (left, y), (right, y));
        canvas.line("fc-axis", (left, y - 5.0), (left, y + 5.0));
        canvas.line("fc-axis", (right, y - 5.0), (right, y + 5.0));
        let text = format!("{} \u{b5}m", label(self.step, self.step));
        canvas.text("", (right + 8.0, y + 4.0), Anchor::Start, &text);
        if radius > 0.0 && radius.is_finite() {
            // The commanded circle is drawn `CIRCLE` long for `radius` millimetres.
            let times = self.factor * 1000.0 * radius / CIRCLE;
            let rounded = round_to_two_digits(times);
            let text = format!(
                "deviation magnified {}\u{d7} against the circle of {} mm",
                label(rounded, 1.0),
                label(radius, decimal_of(radius)),
            );
            canvas.text("fc-quiet", (left, y + 24.0), Anchor::Start, &text);
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
