//! States along an axis as rows of bars, in shapes that need no colour.

use super::canvas::{Anchor, Area, Canvas, Head, MARGIN, PictureRole, WIDTH, text_width};
use super::frame::Frame;
use super::legend::{Legend, LegendSample};
use super::scale::{ChartAxis, Ends, Scale, Spacing};
use super::shape::{BAR, BandState, BarShape, StartUpRelation};
use super::ticks::draw_x_axis;
use frictcomp::comp::State;

/// A bar: one state from one value of the axis to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Start of the bar.
    pub from: f64,
    /// End of the bar.
    pub to: f64,
    /// Content.
    pub state: BandState,
    /// Relation of the state to the start-up state.
    pub relation: StartUpRelation,
    /// Text for a pointer and a screen reader.
    pub title: String,
    /// Target of its link, `#id` of the page.
    pub href: Option<String>,
}

impl Band {
    fn shape(&self) -> BarShape {
        BarShape {
            state: self.state,
            relation: self.relation,
        }
    }
}

/// The bars of one axis of the machine.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BandRow {
    /// The name of the axis.
    pub label: String,
    /// The bars, one after the other.
    pub bands: Vec<Band>,
}

/// Rows of bars over one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BandChart {
    /// The heading; empty if the page around it has one.
    pub title: String,
    /// The picture in a sentence or two.
    pub description: String,
    /// The axis that the bars are drawn over.
    pub x: ChartAxis,
    /// The first and the last step if each bar represents whole steps: the start and the last
    /// block.
    pub steps: Option<(f64, f64)>,
    /// The rows from top to bottom.
    pub rows: Vec<BandRow>,
}

impl BandChart {
    /// Returns the picture. Bars that are too narrow to be seen are drawn as one that is `changing`.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let mut canvas = Canvas::headed(Head {
            title: &self.title,
            description: &self.description,
            role: PictureRole::Group,
        });
        let top = if self.title.is_empty() { 4.0 } else { 44.0 };
        let ends = self
            .rows
            .iter()
            .flat_map(|row| &row.bands)
            .flat_map(|band| [band.from, band.to]);
        let mut scale = Scale::over(ends, Spacing::Linear, Ends::Exact, 8);
        self.name_ticks(&mut scale);
        let left = MARGIN + label_width(&self.rows);
        let area = Area {
            x: left,
            y: top,
            width: WIDTH - 24.0 - left,
            height: height(&self.rows),
        };
        let rows = BandRows {
            bars: &self.rows,
            scale: &scale,
            area,
        };
        let mut legend = Legend::default();
        rows.draw(&mut canvas, &mut legend);
        let line = (area.x, area.bottom() + 4.0, area.width);
        let floor = draw_x_axis(&mut canvas, &scale, line, &self.x.label) + 8.0;
        let floor = legend.draw(&mut canvas, floor);
        canvas.finish(frame, floor + 8.0)
    }

    /// Gives ticks to whole steps only, the first and the last always, if the bars represent them.
    fn name_ticks(&self, scale: &mut Scale) {
        let Some((first, last)) = self.steps else {
            return;
        };
        let near = (last - first) * 0.06;
        scale.ticks.retain(|(value, _)| {
            let whole = (value - value.round()).abs() < 1e-9;
            whole && *value > first && *value < last - near
        });
        scale.ticks.insert(0, (first, "start".to_owned()));
        if last > first {
            scale.ticks.push((last, format!("{last}")));
        }
    }
}

/// The height of a row.
const ROW: f64 = 26.0;

/// Returns the height that rows need.
pub(super) fn height(rows: &[BandRow]) -> f64 {
    ROW * f64::from(u32::try_from(rows.len()).unwrap_or(u32::MAX))
}

/// Returns the width that the labels of rows need.
pub(super) fn label_width(rows: &[BandRow]) -> f64 {
    let widths = rows.iter().map(|row| text_width(&row.label));
    widths.fold(30.0, f64::max) + 10.0
}

/// Rows on their way into a picture.
pub(super) struct BandRows<'a> {
    pub(super) bars: &'a [BandRow],
    pub(super) scale: &'a Scale,
    pub(super) area: Area,
}

impl BandRows<'_> {
    /// Draws the rows one below the other, their labels left of the area, and names the visible states.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, legend: &mut Legend<'_>) {
        let mut drawn = Vec::new();
        let Area { x, y, width, .. } = self.area;
        let mut top = y;
        for row in self.bars {
            let middle = top + ROW / 2.0 + 4.0;
            canvas.text("", (x - 8.0, middle), Anchor::End, &row.label);
            let place = |value: f64| x + self.scale.share(value) * width;
            let mut bands = row.bands.iter().peekable();
            while let Some(first) = bands.next() {
                let start = place(first.from);
                let mut shown = first.clone();
                let narrow = |band: &Band| place(band.to) - place(band.from) < NARROW;
                while narrow(first)
                    && let Some(next) = bands.next_if(|next| narrow(next))
                {
                    shown.state = BandState::Changing;
                    shown.relation = StartUpRelation::StartUp;
                    shown.to = next.to;
                }
                if shown.state != first.state {
                    shown.title = format!("{}: several short changes from here", row.label);
                }
                let area = Area {
                    x: start,
                    y: top + (ROW - BAR) / 2.0,
                    width: (place(shown.to) - start).max(1.0),
                    height: BAR,
                };
                draw_band(canvas, &shown, area);
                drawn.push(shown.shape());
            }
            top += ROW;
        }
        for shape in BarShape::all().filter(|shape| drawn.contains(shape)) {
            legend.name(LegendSample::Bar(shape), shape.name());
        }
    }
}

/// Width below which bars are joined.
const NARROW: f64 = 1.5;

fn draw_band(canvas: &mut Canvas<'_>, band: &Band, area: Area) {
    let href = band.href.as_deref();
    canvas.open_link(href, &band.title);
    band.shape().draw(canvas, area);
    let word = band.state.as_str();
    if band.state != BandState::One(State::Unconfigured) && text_width(word) + 10.0 < area.width {
        let class = match band.relation {
            StartUpRelation::Away => format!("fc-away {}", band.state.side()),
            StartUpRelation::StartUp => String::new(),
        };
        let place = (area.x + 6.0, area.y + BAR / 2.0 + 4.0);
        canvas.text(&class, place, Anchor::Start, word);
    }
    canvas.close_link(href);
}
