//! A path in a plane with a magnified deviation, and marks on it.

use super::canvas::{
    Anchor, Area, Canvas, Head, MARGIN, PictureRole, WIDTH, curve_class, text_width,
};
use super::frame::Frame;
use super::legend::{Legend, LegendSample};
use super::line::LineChart;
use super::scale::{label, round_step};

/// The place of the drawing.
const LEFT: f64 = 60.0;
const TOP: f64 = 64.0;
const ROOM: Area = Area {
    x: LEFT,
    y: TOP,
    width: WIDTH - LEFT - 40.0,
    height: 470.0,
};

/// The drawn length of the largest deviation.
const LARGEST: f64 = 34.0;

/// The deviation in mm, below what a machine resolves, that is not magnified further.
const NOTHING_MM: f64 = 1e-4;

/// Points that are closer together in the picture are drawn as one.
const SEEN: f64 = 0.7;

/// The maximum length of a straight line between two points.
const STRAIGHT: f64 = 7.0;

/// Side of the square in which marks are drawn as one.
const CELL: f64 = 13.0;

/// The approximate length of the scale of the path.
const PATH_BAR: f64 = 70.0;

/// The looks of stretches that are drawn as curves.
const COMPENSATED: usize = 0;
const UNCOMPENSATED: usize = 1;
const LEFT_OUT: usize = 4;

/// Way in which a stretch of the path is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Stroke {
    /// Stretch drawn with the deviation, compensated.
    #[default]
    Compensated,
    /// Stretch drawn with the deviation, not compensated.
    Uncompensated,
    /// Stretch that is not judged: a rapid motion.
    Unjudged,
    /// Left out: its course on the machine is not known.
    LeftOut,
}

/// A point of the path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlanePoint {
    /// The commanded place, in mm.
    pub place: [f64; 2],
    /// The actual place relative to it, in mm.
    pub error: [f64; 2],
    /// Way in which the stretch that ends here is drawn.
    pub stroke: Stroke,
}

/// A mark on the path.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneMark {
    /// Place of the mark, in mm.
    pub place: [f64; 2],
    /// Whether the mark has a ring.
    pub ringed: bool,
    /// Importance; of several in one place the greatest counts.
    pub weight: f64,
    /// Words next to it, for the worst ones.
    pub label: Option<String>,
    /// Text for a pointer and a screen reader.
    pub title: String,
    /// Target of its link, `#id` of the page.
    pub href: Option<String>,
}

/// A path in a plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlaneChart {
    /// The heading.
    pub title: String,
    /// The picture in a sentence or two, for those who do not see it.
    pub description: String,
    /// The names of the axes.
    pub axes: [String; 2],
    /// The path in the order of driving.
    pub points: Vec<PlanePoint>,
    /// Marks on it.
    pub marks: Vec<PlaneMark>,
    /// A chart below it.
    pub below: Option<LineChart>,
}

/// Transformation from mm to the picture.
#[derive(Debug, Clone, Copy)]
struct PlaneFit {
    from: [f64; 2],
    scale: f64,
    origin: (f64, f64),
    magnification: f64,
}

impl PlaneFit {
    fn of(points: &[PlanePoint]) -> Self {
        let mut least = [f64::INFINITY; 2];
        let mut most = [f64::NEG_INFINITY; 2];
        let mut largest: f64 = 0.0;
        for point in points {
            for axis in 0..2 {
                least[axis] = least[axis].min(point.place[axis]);
                most[axis] = most[axis].max(point.place[axis]);
            }
            if point.stroke != Stroke::Unjudged {
                largest = largest.max(point.error[0].hypot(point.error[1]));
            }
        }
        if points.is_empty() {
            (least, most) = ([0.0; 2], [1.0; 2]);
        }
        let size = |axis: usize| (most[axis] - least[axis]).max(1e-3);
        let inner = (ROOM.width - 2.0 * LARGEST, ROOM.height - 2.0 * LARGEST);
        let scale = (inner.0 / size(0)).min(inner.1 / size(1));
        let width = size(0) * scale;
        let largest = largest.max(NOTHING_MM);
        let magnification = round_step(LARGEST / (largest * scale) / 2.0).max(1.0);
        Self {
            from: least,
            scale,
            origin: (
                ROOM.x + (ROOM.width - width) / 2.0,
                ROOM.y + LARGEST + size(1) * scale,
            ),
            magnification,
        }
    }

    fn place(&self, place: [f64; 2]) -> (f64, f64) {
        (
            self.origin.0 + (place[0] - self.from[0]) * self.scale,
            self.origin.1 - (place[1] - self.from[1]) * self.scale,
        )
    }

    fn magnified(&self, point: &PlanePoint) -> (f64, f64) {
        let [x, y] = [0, 1].map(|axis| point.place[axis] + self.magnification * point.error[axis]);
        self.place([x, y])
    }

    /// Draws round lengths of the deviation and of the path.
    fn draw_scales(&self, canvas: &mut Canvas<'_>, y: f64) {
        let of_deviation = self.scale * self.magnification / 1000.0;
        let bars = [
            (LARGEST / 2.0, of_deviation, "\u{b5}m of the deviation"),
            (PATH_BAR, self.scale, "mm of the path"),
        ];
        let mut x = MARGIN;
        for (about, scale, unit) in bars {
            let step = round_step(about / scale);
            let text = format!("{} {unit}", label(step, step));
            x = canvas.scale_bar((x, y), step * scale, &text) + 32.0;
        }
    }
}

impl PlaneChart {
    /// Returns the drawn path: a line through points of the picture for each stretch of the points, in its units. A
    /// stretch begins where the one before it ends.
    pub fn drawn(&self, ends: &[usize]) -> Vec<Vec<[f64; 2]>> {
        let fit = PlaneFit::of(&self.points);
        let begins = std::iter::once(0).chain(ends.iter().map(|end| end.saturating_sub(1)));
        let stretches = begins.zip(ends).map(|(begin, end)| {
            let points = self.points.get(begin..*end).unwrap_or_default();
            let places = points.iter().map(|point| fit.place(point.place));
            thinned(places).into_iter().map(<[f64; 2]>::from).collect()
        });
        stretches.collect()
    }

    /// Returns the picture, with a bar that shows the magnification of the deviation.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let has_links = self.marks.iter().any(|mark| mark.href.is_some());
        let mut canvas = Canvas::headed(Head {
            title: &self.title,
            description: &self.description,
            role: if has_links {
                PictureRole::Group
            } else {
                PictureRole::Image
            },
        });
        let fit = PlaneFit::of(&self.points);
        self.draw_axes(&mut canvas);
        self.draw_path(&mut canvas, &fit);
        self.draw_marks(&mut canvas, &fit);
        self.draw_labels(&mut canvas, &fit);
        let floor = self.legend().draw(&mut canvas, ROOM.bottom() + 12.0) + 12.0;
        fit.draw_scales(&mut canvas, floor);
        let mut height = floor + 18.0;
        if let Some(below) = &self.below {
            let inside = match frame {
                Frame::Alone => "below".to_owned(),
                Frame::Inside(name) => format!("{name}-below"),
            };
            let (chart, chart_height) = below.draw();
            let chart = chart.finish(Frame::Inside(&inside), chart_height);
            canvas.embed(&chart, height);
            height += chart_height;
        }
        canvas.finish(frame, height)
    }

    fn draw_axes(&self, canvas: &mut Canvas<'_>) {
        let (x, y) = (24.0, TOP + 46.0);
        canvas.line("fc-axis", (x, y), (x + 30.0, y));
        canvas.line("fc-axis", (x, y), (x, y - 30.0));
        canvas.text("", (x + 34.0, y + 4.0), Anchor::Start, &self.axes[0]);
        canvas.text("", (x, y - 36.0), Anchor::Middle, &self.axes[1]);
    }

    /// Draws the commanded path thin, and the magnified one over it, by stretches of one kind.
    fn draw_path(&self, canvas: &mut Canvas<'_>, fit: &PlaneFit) {
        for stretch in stretches(&self.points) {
            let class = match stretch[stretch.len() - 1].stroke {
                Stroke::Unjudged => "fc-curve fc-grid",
                Stroke::LeftOut => &curve_class(LEFT_OUT),
                _ => "fc-curve fc-axis",
            };
            let places = stretch.iter().map(|point| fit.place(point.place));
            canvas.path(class, thinned(places));
        }
        for stretch in stretches(&self.points) {
            let look = match stretch[stretch.len() - 1].stroke {
                Stroke::Unjudged | Stroke::LeftOut => continue,
                Stroke::Compensated => COMPENSATED,
                Stroke::Uncompensated => UNCOMPENSATED,
            };
            let places = stretch.iter().map(|point| fit.magnified(point));
            canvas.path(&curve_class(look), thinned(places));
        }
    }

    fn draw_marks(&self, canvas: &mut Canvas<'_>, fit: &PlaneFit) {
        let mut cells: std::collections::BTreeMap<(i64, i64), (&PlaneMark, u32)> =
            std::collections::BTreeMap::new();
        for mark in &self.marks {
            let (x, y) = fit.place(mark.place);
            #[allow(clippy::cast_possible_truncation)] // within the picture
            let cell = ((x / CELL) as i64, (y / CELL) as i64);
            let (worst, count) = cells.entry(cell).or_insert((mark, 0));
            if mark.weight > worst.weight {
                *worst = mark;
            }
            *count += 1;
        }
        for (mark, count) in cells.values() {
            let at = fit.place(mark.place);
            let more = f64::from(*count).log2();
            let title = match count {
                1 => mark.title.clone(),
                _ => format!("{}; the worst of {count}", mark.title),
            };
            let href = mark.href.as_deref();
            canvas.open_link(href, &title);
            if mark.ringed {
                canvas.circle("fc-outline", at, 4.0 + more);
            }
            canvas.circle(
                if mark.ringed { "fc-m1" } else { "fc-m0" },
                at,
                2.2 + more / 2.0,
            );
            canvas.close_link(href);
        }
    }

    /// Writes the words next to the worst marks, where neither the path nor another mark is in their way (R11.5); a
    /// thin line leads to a mark that is farther off. A mark without room for words keeps its title.
    fn draw_labels(&self, canvas: &mut Canvas<'_>, fit: &PlaneFit) {
        const LINE: f64 = 16.0;
        let mut ground = Ground::default();
        for pair in self.points.windows(2) {
            for of in [
                |fit: &PlaneFit, it: &PlanePoint| fit.place(it.place),
                PlaneFit::magnified,
            ] {
                ground.take_line(of(fit, &pair[0]), of(fit, &pair[1]));
            }
        }
        for mark in &self.marks {
            ground.take_line(fit.place(mark.place), fit.place(mark.place));
        }
        for mark in &self.marks {
            let Some(text) = &mark.label else {
                continue;
            };
            let (x, y) = fit.place(mark.place);
            let width = text_width(text);
            let beside = |(far, turn): (f64, f64)| {
                let (sine, cosine) = turn.sin_cos();
                let middle = (
                    x + cosine * (far + width / 2.0),
                    y - sine * (far + LINE / 2.0),
                );
                Area {
                    x: middle.0 - width / 2.0,
                    y: middle.1 - LINE / 2.0,
                    width,
                    height: LINE,
                }
            };
            let places = [10.0, 26.0, 44.0, 70.0, 100.0].into_iter().flat_map(|far| {
                (0..16).map(move |part| (far, f64::from(part) * std::f64::consts::TAU / 16.0))
            });
            let fits = |area: &Area| {
                let inside = area.x > 60.0
                    && area.right() < WIDTH - 6.0
                    && area.y > 40.0
                    && area.bottom() < ROOM.bottom() + 4.0;
                inside && ground.is_free(*area)
            };
            let Some(area) = places.map(beside).find(fits) else {
                continue;
            };
            ground.take(area);
            let near = (
                x.clamp(area.x, area.right()),
                y.clamp(area.y, area.bottom()),
            );
            if length(near, (x, y)) > 16.0 {
                canvas.line("fc-axis", (x, y), near);
            }
            let middle = area.x + width / 2.0;
            canvas.text("", (middle, area.y + 12.0), Anchor::Middle, text);
        }
    }

    fn legend(&self) -> Legend<'_> {
        let mut legend = Legend::default();
        legend.name(LegendSample::Line(COMPENSATED), "compensated");
        legend.name(LegendSample::Line(UNCOMPENSATED), "not compensated");
        legend.name(LegendSample::Thin, "commanded");
        let mut strokes = self.points.iter().map(|point| point.stroke);
        if strokes.any(|stroke| stroke == Stroke::LeftOut) {
            legend.name(LegendSample::Line(LEFT_OUT), "left out");
        }
        legend.name(LegendSample::Ring, "reversal without compensation");
        legend
    }
}

/// Returns the visible points: not those next to the one before, nor those on a short straight line between their
/// neighbours. The last one stays.
fn thinned(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let mut last = None;
    for point in points {
        let is_near = kept.last().is_some_and(|kept| length(*kept, point) < SEEN);
        last = is_near.then_some(point);
        if is_near {
            continue;
        }
        if let [.., before, between] = kept[..]
            && length(before, point) < STRAIGHT
            && off_line(between, (before, point)) < SEEN / 8.0
        {
            kept.pop();
        }
        kept.push(point);
    }
    kept.extend(last);
    kept
}

fn length(one: (f64, f64), other: (f64, f64)) -> f64 {
    (other.0 - one.0).hypot(other.1 - one.1)
}

/// Returns the distance of a point from the line through two others.
fn off_line(point: (f64, f64), (from, to): ((f64, f64), (f64, f64))) -> f64 {
    let cross = (to.0 - from.0) * (point.1 - from.1) - (to.1 - from.1) * (point.0 - from.0);
    cross.abs() / length(from, to)
}

/// Squares of the picture that are occupied.
#[derive(Debug, Default)]
struct Ground {
    taken: std::collections::BTreeSet<(i64, i64)>,
}

impl Ground {
    /// The side of a square.
    const SQUARE: f64 = 6.0;

    #[allow(clippy::cast_possible_truncation)] // within the picture
    fn square((x, y): (f64, f64)) -> (i64, i64) {
        (
            (x / Self::SQUARE).floor() as i64,
            (y / Self::SQUARE).floor() as i64,
        )
    }

    fn take_line(&mut self, from: (f64, f64), to: (f64, f64)) {
        let steps = (length(from, to) / (Self::SQUARE / 2.0))
            .ceil()
            .clamp(1.0, 2000.0);
        let mut step = 0.0;
        while step <= steps {
            let part = step / steps;
            let at = (
                from.0 + part * (to.0 - from.0),
                from.1 + part * (to.1 - from.1),
            );
            self.taken.insert(Self::square(at));
            step += 1.0;
        }
    }

    fn squares(area: Area) -> impl Iterator<Item = (i64, i64)> {
        let (left, top) = Self::square((area.x, area.y));
        let (right, bottom) = Self::square((area.right(), area.bottom()));
        (left..=right).flat_map(move |x| (top..=bottom).map(move |y| (x, y)))
    }

    fn is_free(&self, area: Area) -> bool {
        Self::squares(area).all(|square| !self.taken.contains(&square))
    }

    fn take(&mut self, area: Area) {
        self.taken.extend(Self::squares(area));
    }
}

/// Returns the points cut into stretches that are drawn alike; each begins where the one before it ends.
fn stretches(points: &[PlanePoint]) -> impl Iterator<Item = &[PlanePoint]> {
    let mut from = 0;
    std::iter::from_fn(move || {
        if from + 1 >= points.len() {
            return None;
        }
        let stroke = points[from + 1].stroke;
        let rest = &points[from + 1..];
        let same = rest.iter().take_while(|it| it.stroke == stroke).count();
        let stretch = &points[from..=from + same];
        from += same;
        Some(stretch)
    })
}
