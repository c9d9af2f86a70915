//! States along an axis as rows of bars, in shapes that need no colour.

use super::canvas::{Anchor, Area, Canvas, Head, PictureRole, WIDTH, text_width, widest_text};
use super::frame::Frame;
use super::scale::{ChartAxis, Ends, Scale, Spacing};
use frictcomp::comp::State;

/// The content of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BandState {
    /// One state all along.
    One(State),
    /// It changes too often to be drawn.
    Changing,
}

impl BandState {
    /// Every state, in the order of the legend.
    const ALL: [Self; 6] = [
        Self::One(State::Active),
        Self::One(State::Ineffective),
        Self::One(State::Inactive),
        Self::One(State::Unconfigured),
        Self::One(State::Unknown),
        Self::Changing,
    ];

    /// The word in and below the bars.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::One(state) => state.as_str(),
            Self::Changing => "changing",
        }
    }
}

/// Relation of a state to the start-up state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum StartUpRelation {
    /// It is that state, or unknown.
    #[default]
    StartUp,
    /// It is another one, which outlives the program.
    Away,
}

impl StartUpRelation {
    /// Returns the relation. Only a state that a command switches can be away from its start-up state.
    pub fn of(state: State, start_up: State) -> Self {
        let switched = matches!(state, State::Active | State::Inactive);
        if switched && state != start_up {
            Self::Away
        } else {
            Self::StartUp
        }
    }
}

/// A bar: one state from one value of the axis to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Its content.
    pub state: BandState,
    /// Relation of the state to the start-up state.
    pub standing: StartUpRelation,
    /// Text for a pointer and a screen reader.
    pub title: String,
    /// Target of its link, `#id` of the page.
    pub href: Option<String>,
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
    /// The picture. Bars that are too narrow to be seen are drawn as one that is `changing`.
    pub fn render(&self, frame: Frame<'_>) -> String {
        let mut canvas = Canvas::default();
        let top = if self.title.is_empty() { 4.0 } else { 44.0 };
        if !self.title.is_empty() {
            canvas.text("fc-title", (16.0, 26.0), Anchor::Start, &self.title);
        }
        let ends = self
            .rows
            .iter()
            .flat_map(|row| &row.bands)
            .flat_map(|band| [band.from, band.to]);
        let mut scale = Scale::over(ends, Spacing::Linear, Ends::Exact, 8);
        self.name_ticks(&mut scale);
        let left = 16.0 + label_width(&self.rows);
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
        let states = rows.draw(&mut canvas);
        let floor = area.bottom() + 4.0;
        let y = draw_ticks(
            &mut canvas,
            &scale,
            Area { y: floor, ..area },
            &self.x.label,
        );
        let height = draw_legend(&mut canvas, &states, (16.0, y + 8.0)) + y + 16.0;
        canvas.finish(
            frame,
            &Head {
                title: if self.title.is_empty() {
                    &self.description
                } else {
                    &self.title
                },
                description: &self.description,
                height,
                role: PictureRole::Group,
            },
        )
    }

    /// If the bars represent whole steps, only those have ticks, the first and the last always.
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

/// The height of a bar.
const BAR: f64 = 18.0;

/// The height that rows need.
pub(super) fn height(rows: &[BandRow]) -> f64 {
    ROW * f64::from(u32::try_from(rows.len()).unwrap_or(u32::MAX))
}

/// The width that the labels of rows need.
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
    /// Draws the rows one below the other, their labels left of the area; returns the visible
    /// states.
    pub(super) fn draw(&self, canvas: &mut Canvas) -> Vec<(BandState, StartUpRelation)> {
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
                    shown.standing = StartUpRelation::StartUp;
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
                drawn.push((shown.state, shown.standing));
            }
            top += ROW;
        }
        drawn
    }
}

/// Narrower bars are joined.
const NARROW: f64 = 1.5;

fn draw_band(canvas: &mut Canvas, band: &Band, area: Area) {
    let href = band.href.as_deref();
    canvas.open_link(href, &band.title);
    draw_shape(canvas, (band.state, band.standing), area);
    let word = band.state.as_str();
    if band.state != BandState::One(State::Unconfigured) && text_width(word) + 10.0 < area.width {
        let class = match band.standing {
            StartUpRelation::Away => "fc-on-away",
            StartUpRelation::StartUp => "",
        };
        let place = (area.x + 6.0, area.y + BAR / 2.0 + 4.0);
        canvas.text(class, place, Anchor::Start, word);
    }
    canvas.close_link(href);
}

/// The shape of a state: full, hollow, half full, a line, dashed; striped if it is not the start-up
/// state.
fn draw_shape(canvas: &mut Canvas, (state, standing): (BandState, StartUpRelation), area: Area) {
    if standing == StartUpRelation::Away {
        canvas.rect("fc-away", area);
        let middle = area.y + area.height / 2.0;
        let class = if area.height < BAR {
            "fc-stripes fc-low"
        } else {
            "fc-stripes"
        };
        canvas.line(class, (area.x, middle), (area.right(), middle));
        return;
    }
    match state {
        BandState::One(State::Active) => canvas.rect("fc-active", area),
        BandState::One(State::Inactive) => canvas.rect("fc-inactive", area),
        BandState::One(State::Ineffective) => {
            canvas.rect("fc-outline", area);
            let half = Area {
                y: area.bottom() - 4.0,
                height: 4.0,
                ..area
            };
            canvas.rect("fc-half", half);
        }
        BandState::One(State::Unconfigured) => {
            // An invisible bar makes the whole row a target for the pointer.
            canvas.rect("fc-ground", area);
            let middle = area.y + area.height / 2.0;
            canvas.line("fc-absent", (area.x, middle), (area.right(), middle));
        }
        BandState::One(State::Unknown) => canvas.rect("fc-unknown", area),
        BandState::Changing => canvas.rect("fc-mixed", area),
    }
}

/// Draws each of the states with its word; returns the height of the legend.
pub(super) fn draw_legend(
    canvas: &mut Canvas,
    drawn: &[(BandState, StartUpRelation)],
    (left, y): (f64, f64),
) -> f64 {
    let both = |state| {
        [
            (state, StartUpRelation::StartUp),
            (state, StartUpRelation::Away),
        ]
    };
    let mut states: Vec<_> = BandState::ALL.into_iter().flat_map(both).collect();
    states.retain(|state| drawn.contains(state));
    let mut x = left;
    for state in &states {
        let word = match *state {
            (state, StartUpRelation::Away) => format!("{}, not start-up", state.as_str()),
            (state, StartUpRelation::StartUp) => state.as_str().to_owned(),
        };
        let swatch = Area {
            x,
            y: y + 3.0,
            width: 22.0,
            height: 12.0,
        };
        draw_shape(canvas, *state, swatch);
        canvas.text("", (x + 28.0, y + 13.0), Anchor::Start, &word);
        x += 28.0 + widest_text(&word) + 14.0;
    }
    if states.is_empty() { 0.0 } else { 20.0 }
}

/// The room between the values at the ticks of an axis.
pub(super) const TICK_ROOM: f64 = 10.0;

/// Draws an axis with its ticks and its label below an area; returns where the room below it begins.
pub(super) fn draw_ticks(canvas: &mut Canvas, scale: &Scale, area: Area, label: &str) -> f64 {
    canvas.line("fc-axis", (area.x, area.y), (area.right(), area.y));
    let mut free = f64::NEG_INFINITY;
    for (value, text) in &scale.ticks {
        let x = area.x + scale.share(*value) * area.width;
        canvas.line("fc-axis", (x, area.y), (x, area.y + 5.0));
        let half = text_width(text) / 2.0;
        // The last label would be cut off at the edge.
        let middle = x.min(WIDTH - half - 4.0);
        if middle - half > free {
            canvas.text("fc-quiet", (middle, area.y + 18.0), Anchor::Middle, text);
            free = middle + half + TICK_ROOM;
        }
    }
    let middle = area.x + area.width / 2.0;
    canvas.text("", (middle, area.y + 36.0), Anchor::Middle, label);
    area.y + 42.0
}
