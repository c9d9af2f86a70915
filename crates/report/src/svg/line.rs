//! Curves over a common axis, in panels one below the other.

use super::bands::{self, BandRow, BandRows};
use super::canvas::{
    Anchor, Area, Canvas, Head, MARGIN, PictureRole, SERIES, WIDTH, curve_class, text_width,
    widest_text,
};
use super::frame::Frame;
use super::legend::{Legend, LegendSample};
use super::reduce::reduce;
use super::scale::{ChartAxis, Ends, Scale, SecondUnit};
use super::ticks::{TickSide, draw_ticks, draw_x_axis};

/// Way in which a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Drawn {
    /// A line.
    #[default]
    Line,
    /// A line with a marker at each point.
    Marked,
    /// A line without its own colour: colours are those of states elsewhere in the picture.
    Plain,
    /// A marker at each point and no line.
    Scattered,
    /// A marker at each point and no line. It has no separate row in the legend and the colour of the
    /// series before it.
    Points,
    /// A value that holds until the next one.
    Steps,
    /// Steps with the ground above them filled: short notches are seen on long curves.
    Notches,
    /// A thin broken line, for what is assumed to continue. It has no separate row in the legend and
    /// the colour of the series before it.
    Held,
}

/// A curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Pairs of x and y in the order of drawing. One that is not finite interrupts the curve.
    pub points: Vec<[f64; 2]>,
    /// Way in which it is drawn.
    pub drawn: Drawn,
}

/// The height of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PanelHeight {
    /// The height that the room allows.
    #[default]
    Full,
    /// The height for a curve that only goes up and down.
    Low,
}

/// Words next to a place of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveNote {
    /// The place.
    pub at: [f64; 2],
    /// The words, above the place, or below it if there is no room.
    pub text: String,
}

/// Curves that share a y axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// The y axis.
    pub y: ChartAxis,
    /// The curves.
    pub series: Vec<Series>,
    /// Words in the panel.
    pub notes: Vec<CurveNote>,
    /// Height.
    pub height: PanelHeight,
}

/// A name at a place of the x axis.
#[derive(Debug, Clone, PartialEq)]
pub struct XMark {
    /// The place.
    pub at: f64,
    /// The name in the legend.
    pub name: String,
}

/// The looks of the curves of a chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum CurveLooks {
    /// Looks of quantities, none of which stands for a state.
    #[default]
    Quantities,
    /// Looks of two curves: the first with compensation, the second without.
    OnAndOff,
}

impl CurveLooks {
    /// Returns the look of the curve with a number: the first two are those of on and off.
    fn of(self, number: usize) -> usize {
        match self {
            Self::Quantities => 2 + number % (SERIES - 2),
            Self::OnAndOff if number < 2 => number,
            Self::OnAndOff => 3 + (number - 2) % (SERIES - 3),
        }
    }
}

/// Panels, and states above them, over one x axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LineChart {
    /// The heading.
    pub title: String,
    /// The picture in a sentence or two, for those who do not see it.
    pub description: String,
    /// The x axis.
    pub x: ChartAxis,
    /// States along the x axis, above the panels.
    pub bands: Vec<BandRow>,
    /// The panels from top to bottom.
    pub panels: Vec<Panel>,
    /// The looks of their curves.
    pub looks: CurveLooks,
    /// Names along the x axis, below its values.
    pub marks: Vec<XMark>,
}

/// The least room left of the panels.
const MIN_LEFT: f64 = 60.0;

/// The room that the second unit of the x axis needs above the first panel.
const SECOND_ROOM: f64 = 34.0;

/// The room between the names along the x axis.
const MARK_ROOM: f64 = 14.0;

/// Number of names along the x axis from which only the written ones have a tick.
const CROWDED: usize = 120;

impl LineChart {
    /// Returns the picture, 860 units wide. Points beyond the visible resolution are reduced to the least and the
    /// greatest of each column.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let (canvas, height) = self.draw();
        canvas.finish(frame, height)
    }

    /// Returns the picture and its height.
    pub(super) fn draw(&self) -> (Canvas<'_>, f64) {
        let mut canvas = Canvas::headed(Head {
            title: &self.title,
            description: &self.description,
            role: PictureRole::Image,
        });
        let points = self.panels.iter().flat_map(|panel| &panel.series);
        let x_values = points
            .flat_map(|series| &series.points)
            .map(|point| point[0])
            .chain(
                self.bands
                    .iter()
                    .flat_map(|row| &row.bands)
                    .flat_map(|band| [band.from, band.to]),
            );
        let x = Scale::over(x_values, self.x.spacing, Ends::Exact, 9);
        let y: Vec<Scale> = self
            .panels
            .iter()
            .map(|panel| panel.scale(self.ticks()))
            .collect();
        let labels = y.iter().flat_map(|scale| &scale.ticks);
        let widest = labels
            .map(|(_, text)| widest_text(text))
            .fold(0.0, f64::max);
        let left = (widest + 12.0).max(MIN_LEFT).max(if self.bands.is_empty() {
            0.0
        } else {
            MARGIN + bands::label_width(&self.bands)
        });
        let mut area = Area {
            x: left,
            y: 40.0,
            width: WIDTH - 24.0 - left,
            height: bands::height(&self.bands),
        };
        let rows = BandRows {
            bars: &self.bands,
            scale: &x,
            area,
        };
        let mut legend = Legend::default();
        rows.draw(&mut canvas, &mut legend);
        area.y = area.bottom();
        let mut above = false;
        for (panel, scale) in self.panels.iter().zip(&y) {
            area.y += if above { 36.0 } else { 26.0 };
            area.height = match panel.height {
                PanelHeight::Low => 44.0,
                PanelHeight::Full if self.panels.len() > 1 => 130.0,
                PanelHeight::Full => 300.0,
            };
            canvas.text("", (MARGIN, area.y - 13.0), Anchor::Start, &panel.y.label);
            if let Some(second) = self.x.second.as_ref().filter(|_| !above) {
                area.y += SECOND_ROOM;
                draw_second(&mut canvas, &x, second, area);
            }
            above = true;
            let axes = PanelAxes {
                x: &x,
                y: scale,
                area,
            };
            axes.draw_grid(&mut canvas);
            panel.draw(&mut canvas, &axes, self.looks);
            area.y = area.bottom();
        }
        let floor = if self.marks.is_empty() {
            draw_x_axis(&mut canvas, &x, (area.x, area.y, area.width), &self.x.label)
        } else {
            self.draw_marks(&mut canvas, &x, area)
        };
        self.name_curves(&mut legend);
        let floor = legend.draw(&mut canvas, floor + 6.0);
        (canvas, floor + 10.0)
    }

    /// Returns the x axis with names below its values. Names without room are left out; their ticks only if all of them
    /// would be a solid bar.
    fn draw_marks(&self, canvas: &mut Canvas<'_>, x: &Scale, area: Area) -> f64 {
        draw_ticks(canvas, x, (area.x, area.y, area.width), TickSide::Below);
        let (above, row) = (area.y + 24.0, area.y + 40.0);
        let are_crowded = self.marks.len() > CROWDED;
        let mut free = f64::NEG_INFINITY;
        let mut column = f64::NEG_INFINITY;
        for mark in &self.marks {
            let place = area.x + x.share(mark.at) * area.width;
            if !place.is_finite() || place < column + 1.0 {
                continue;
            }
            column = place;
            let width = text_width(&mark.name);
            let is_named = place > free && place + width < WIDTH - 4.0;
            if is_named || !are_crowded {
                canvas.line("fc-axis", (place, above), (place, above + 5.0));
            }
            if is_named {
                canvas.text("fc-quiet", (place, row), Anchor::Start, &mark.name);
                free = place + width + MARK_ROOM;
            }
        }
        let middle = area.x + area.width / 2.0;
        canvas.text("", (middle, row + 20.0), Anchor::Middle, &self.x.label);
        row + 26.0
    }

    fn ticks(&self) -> u32 {
        if self.panels.len() > 1 { 4 } else { 7 }
    }

    /// Names the curves of panels with several; the one curve of a panel is named by its axis.
    fn name_curves<'a>(&'a self, legend: &mut Legend<'a>) {
        let named = |panel: &&Panel| panel.numbered().any(|(number, _)| number > 0);
        let all = self.panels.iter().filter(named).flat_map(Panel::numbered);
        for (number, series) in all.filter(|(_, series)| !series.drawn.belongs_to_another()) {
            let look = self.looks.of(number);
            legend.name(series.drawn.in_legend(look), series.name.as_str());
        }
    }
}

impl Drawn {
    /// Returns whether it has the look of the series before it.
    fn belongs_to_another(self) -> bool {
        matches!(self, Self::Held | Self::Points)
    }

    fn in_legend(self, look: usize) -> LegendSample {
        match self {
            Self::Marked => LegendSample::MarkedLine(look),
            Self::Scattered => LegendSample::Marker(look),
            _ => LegendSample::Line(look),
        }
    }

    fn has_markers(self) -> bool {
        matches!(self, Self::Marked | Self::Scattered | Self::Points)
    }
}

impl Panel {
    fn scale(&self, ticks: u32) -> Scale {
        let values = self.series.iter().flat_map(|series| &series.points);
        let zero = self.y.from_zero.then_some(0.0);
        let reach = self.y.reach.into_iter().flat_map(|it| [-it, it]);
        Scale::over(
            values.map(|point| point[1]).chain(zero).chain(reach),
            self.y.spacing,
            Ends::Round,
            ticks,
        )
    }

    /// Returns the series with their numbers.
    fn numbered(&self) -> impl Iterator<Item = (usize, &Series)> {
        let mut next: usize = 0;
        self.series.iter().map(move |series| {
            if !series.drawn.belongs_to_another() {
                next += 1;
            }
            (next.saturating_sub(1), series)
        })
    }

    fn draw(&self, canvas: &mut Canvas<'_>, axes: &PanelAxes<'_>, looks: CurveLooks) {
        for (number, series) in self.numbered() {
            let number = looks.of(number);
            let class = match series.drawn {
                Drawn::Plain => "fc-curve fc-axis".to_owned(),
                Drawn::Held => curve_class(number) + " fc-held",
                Drawn::Steps | Drawn::Notches => curve_class(number) + " fc-steps",
                _ => curve_class(number),
            };
            let kept = reduce(&series.points, |point| axes.place(point).0);
            let places: Vec<(f64, f64)> = kept.iter().map(|&point| axes.place(point)).collect();
            match series.drawn {
                Drawn::Points | Drawn::Scattered => {}
                Drawn::Steps => canvas.path(&class, steps(&places)),
                Drawn::Notches => {
                    for piece in places.split(|place| !place.0.is_finite() || !place.1.is_finite())
                    {
                        canvas.path("fc-f2", below(axes.area.y, piece));
                    }
                    canvas.path(&class, steps(&places));
                }
                _ => canvas.path(&class, places.iter().copied()),
            }
            if series.drawn.has_markers() {
                let seen = places
                    .iter()
                    .filter(|(x, y)| x.is_finite() && y.is_finite());
                for place in seen {
                    canvas.marker(number, *place);
                }
            }
        }
        for note in &self.notes {
            let (x, y) = axes.place(note.at);
            let half = text_width(&note.text) / 2.0;
            // It stays inside the panel.
            let inside = (axes.area.x + half + 6.0).min(axes.area.right());
            let middle = x.clamp(inside, (axes.area.right() - half - 4.0).max(inside));
            // Below the curve if there is no room above it.
            let fits = y - 20.0 > axes.area.y;
            let y = if fits { y - 8.0 } else { y + 17.0 };
            canvas.text("fc-quiet", (middle, y), Anchor::Middle, &note.text);
        }
    }
}

/// Returns a line that holds each value until the next one.
fn steps(places: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut line = Vec::with_capacity(places.len() * 2);
    let mut before: Option<(f64, f64)> = None;
    for &place in places {
        if let Some((_, y)) = before.filter(|(x, y)| x.is_finite() && y.is_finite())
            && place.0.is_finite()
        {
            line.push((place.0, y));
        }
        line.push(place);
        before = Some(place);
    }
    line
}

/// Returns the ground between a top and a line that holds each value until the next one.
fn below(top: f64, places: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return Vec::new();
    };
    let mut ground = vec![(first.0, top)];
    ground.extend(steps(places));
    ground.push((last.0, top));
    ground
}

/// Draws the x axis in its other unit, above the first panel.
fn draw_second(canvas: &mut Canvas<'_>, x: &Scale, second: &SecondUnit, area: Area) {
    let scale = x.in_unit(second.factor);
    draw_ticks(
        canvas,
        &scale,
        (area.x, area.y, area.width),
        TickSide::Above,
    );
    let end = (area.right(), area.y - SECOND_ROOM + 9.0);
    canvas.text("", end, Anchor::End, &second.label);
}

/// The axes of one panel.
struct PanelAxes<'a> {
    x: &'a Scale,
    y: &'a Scale,
    area: Area,
}

impl PanelAxes<'_> {
    fn place(&self, [x, y]: [f64; 2]) -> (f64, f64) {
        (
            self.area.x + self.x.share(x) * self.area.width,
            self.area.bottom() - self.y.share(y) * self.area.height,
        )
    }

    fn draw_grid(&self, canvas: &mut Canvas<'_>) {
        let area = self.area;
        for (value, text) in &self.y.ticks {
            let y = area.bottom() - self.y.share(*value) * area.height;
            canvas.line("fc-grid", (area.x, y), (area.right(), y));
            canvas.text("fc-quiet", (area.x - 8.0, y + 4.0), Anchor::End, text);
        }
        for (value, _) in &self.x.ticks {
            let x = area.x + self.x.share(*value) * area.width;
            canvas.line("fc-grid", (x, area.y), (x, area.bottom()));
        }
        if self.y.holds(0.0) {
            let zero = area.bottom() - self.y.share(0.0) * area.height;
            canvas.line("fc-axis", (area.x, zero), (area.right(), zero));
        }
        canvas.line("fc-axis", (area.x, area.y), (area.x, area.bottom()));
        canvas.line(
            "fc-axis",
            (area.x, area.bottom()),
            (area.right(), area.bottom()),
        );
    }
}
