//! Curves over a common axis, in panels one below the other.

use super::bands::{self, BandRow, Rows, draw_legend, draw_ticks};
use super::canvas::{Anchor, Area, Canvas, Head, Legend, Marks, Role, SERIES, WIDTH, text_width};
use super::frame::Frame;
use super::reduce::reduce;
use super::scale::{ChartAxis, Ends, Scale};

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Drawn {
    /// A line.
    #[default]
    Line,
    /// A line with a marker at each point.
    Marked,
    /// A thin broken line, for what is assumed to go on. It has no row in the legend of its own
    /// and the colour of the series before it.
    Held,
}

/// A curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Pairs of x and y in the order of drawing. One that is not finite interrupts the curve.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub drawn: Drawn,
}

/// Curves that share a y axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// The y axis.
    pub y: ChartAxis,
    /// The curves.
    pub series: Vec<Series>,
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
}

/// The least room left of the panels.
const MIN_LEFT: f64 = 60.0;

impl LineChart {
    /// The picture, 860 units wide. More points than can be seen are reduced to the least and the
    /// greatest of each column.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let mut canvas = Canvas::default();
        canvas.text("fc-title", (16.0, 26.0), Anchor::Start, &self.title);
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
        let widest = labels.map(|(_, text)| text_width(text)).fold(0.0, f64::max);
        let left = (widest + 22.0).max(MIN_LEFT).max(if self.bands.is_empty() {
            0.0
        } else {
            16.0 + bands::label_width(&self.bands)
        });
        let mut area = Area {
            x: left,
            y: 40.0,
            width: WIDTH - 24.0 - left,
            height: bands::height(&self.bands),
        };
        let rows = Rows {
            bars: &self.bands,
            scale: &x,
            area,
        };
        let states = rows.draw(&mut canvas);
        area.y = area.bottom();
        let mut above = false;
        for (panel, scale) in self.panels.iter().zip(&y) {
            area.y += if above { 36.0 } else { 26.0 };
            above = true;
            area.height = if self.panels.len() > 1 { 130.0 } else { 300.0 };
            canvas.text("", (16.0, area.y - 9.0), Anchor::Start, &panel.y.label);
            let axes = Axes {
                x: &x,
                y: scale,
                area,
            };
            axes.draw_grid(&mut canvas);
            panel.draw(&mut canvas, &axes);
            area.y = area.bottom();
        }
        let mut floor = draw_ticks(&mut canvas, &x, area, &self.x.label) + 6.0;
        floor += draw_legend(&mut canvas, &states, (16.0, floor));
        floor += self.legend().draw(&mut canvas, (16.0, floor));
        canvas.finish(
            frame,
            &Head {
                title: &self.title,
                description: &self.description,
                height: floor + 10.0,
                role: Role::Image,
            },
        )
    }

    fn ticks(&self) -> u32 {
        if self.panels.len() > 1 { 4 } else { 7 }
    }

    /// The names of the curves of panels with several, each once; the one curve of a panel is named
    /// by its axis.
    fn legend(&self) -> Legend<'_> {
        let named = |panel: &&Panel| panel.numbered().any(|(number, _)| number > 0);
        let all = self.panels.iter().filter(named).flat_map(Panel::numbered);
        let drawn = all.filter(|(_, series)| series.drawn != Drawn::Held);
        let mut items: Vec<(usize, &str, Marks)> = Vec::new();
        for (number, series) in drawn {
            let name = series.name.as_str();
            if !items
                .iter()
                .any(|&(same, other, _)| (same, other) == (number, name))
            {
                items.push((number, name, series.drawn.marks()));
            }
        }
        Legend { items }
    }
}

impl Drawn {
    fn marks(self) -> Marks {
        if self == Self::Marked {
            Marks::With
        } else {
            Marks::Without
        }
    }
}

impl Panel {
    fn scale(&self, ticks: u32) -> Scale {
        let values = self.series.iter().flat_map(|series| &series.points);
        Scale::over(
            values.map(|point| point[1]),
            self.y.spacing,
            Ends::Round,
            ticks,
        )
    }

    /// The series with the numbers of their looks; a held one has that of the one before it.
    fn numbered(&self) -> impl Iterator<Item = (usize, &Series)> {
        let mut next: usize = 0;
        self.series.iter().map(move |series| {
            if series.drawn != Drawn::Held {
                next += 1;
            }
            (next.saturating_sub(1), series)
        })
    }

    fn draw(&self, canvas: &mut Canvas, axes: &Axes<'_>) {
        for (number, series) in self.numbered() {
            let number = number % SERIES;
            let class = match series.drawn {
                Drawn::Held => format!("fc-curve fc-s{number} fc-held"),
                Drawn::Line | Drawn::Marked => format!("fc-curve fc-s{number}"),
            };
            let kept = reduce(&series.points, |point| axes.place(point).0);
            canvas.path(&class, kept.iter().map(|&point| axes.place(point)));
            if series.drawn == Drawn::Marked {
                let seen = kept.iter().map(|&point| axes.place(point));
                for place in seen.filter(|(x, y)| x.is_finite() && y.is_finite()) {
                    canvas.marker(number, place);
                }
            }
        }
    }
}

/// The axes of one panel.
struct Axes<'a> {
    x: &'a Scale,
    y: &'a Scale,
    area: Area,
}

impl Axes<'_> {
    fn place(&self, [x, y]: [f64; 2]) -> (f64, f64) {
        (
            self.area.x + self.x.share(x) * self.area.width,
            self.area.bottom() - self.y.share(y) * self.area.height,
        )
    }

    fn draw_grid(&self, canvas: &mut Canvas) {
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
