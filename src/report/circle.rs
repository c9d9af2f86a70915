//! The result of a circular test as text, JSON and CSV.

use std::fmt::Write as _;

use serde::Serialize;

use crate::circle::{
    Advice, CircularTest, Compensation, Crossing, Direction, Figures, Finding, Glitch, Outcome,
    PathFigures, Place, Recording, Side, advise,
};

/// Rows of the CSV a turn: one every 0.1°.
const ROWS: usize = 3600;

/// How the radial deviations were treated; stands beside the figures (R5.21).
const TREATMENT: &str = "every point of the path for G, F and the glitch; H at 36000 fixed angles, \
                         linear between points; no filter, no mean";

/// Where the value list came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ListOrigin {
    /// It is the friction curve of the plant.
    Plant,
    /// A file of the user.
    File(String),
}

/// What is reported.
#[derive(Debug, Clone)]
pub struct CircleReport {
    /// What was driven.
    pub subject: Subject,
    /// The paths without and with compensation, or what was recorded.
    pub sides: Vec<NamedSide>,
}

/// What was driven.
#[derive(Debug, Clone)]
pub enum Subject {
    /// A simulated test, with the origin of its value list and the cycles in which a force was cut.
    Simulated {
        /// The test.
        test: Box<CircularTest>,
        /// Where its list came from.
        origin: ListOrigin,
        /// Cycles of the speed loop in which a force was cut.
        saturated: u64,
    },
    /// Recorded circles.
    Recorded(Box<Recording>),
}

/// Paths under a name, with what they suggest.
#[derive(Debug, Clone)]
pub struct NamedSide {
    /// `off`, `on` or `recorded`.
    pub name: &'static str,
    /// The paths.
    pub side: Side,
    /// What their shapes suggest.
    pub advice: Vec<Advice>,
}

impl NamedSide {
    fn new(name: &'static str, side: Side, compensation: Option<Compensation>) -> Self {
        Self {
            name,
            advice: advise(&side.paths, compensation),
            side,
        }
    }
}

impl CircleReport {
    /// The report of a simulated test.
    pub fn simulated(test: CircularTest, outcome: Outcome, origin: ListOrigin) -> Self {
        Self {
            subject: Subject::Simulated {
                test: Box::new(test),
                origin,
                saturated: outcome.saturated,
            },
            sides: vec![
                NamedSide::new("off", outcome.off, Some(Compensation::Off)),
                NamedSide::new("on", outcome.on, Some(Compensation::On)),
            ],
        }
    }

    /// The report of recorded circles.
    pub fn recorded(recording: Recording) -> Self {
        let side = recording.side.clone();
        Self {
            subject: Subject::Recorded(Box::new(recording)),
            sides: vec![NamedSide::new("recorded", side, None)],
        }
    }
}

/// The report for people.
pub fn render_text(report: &CircleReport) -> String {
    let mut out = String::new();
    for line in conditions(report) {
        let _ = writeln!(out, "{line}");
    }
    let columns = columns(report);
    let _ = writeln!(out);
    header(&mut out, &columns);
    figure_rows(&mut out, &columns);
    let _ = writeln!(out);
    glitch_rows(&mut out, &columns);
    for side in &report.sides {
        advice_lines(&mut out, side);
    }
    out
}

/// One path of the table.
struct Column<'a> {
    side: &'a NamedSide,
    direction: Direction,
    figures: &'a PathFigures,
}

fn columns(report: &CircleReport) -> Vec<Column<'_>> {
    let pairs = report.sides.iter().flat_map(|side| {
        Direction::ALL
            .into_iter()
            .map(move |direction| (side, direction))
    });
    let found = pairs.filter_map(|(side, direction)| {
        Some(Column {
            side,
            direction,
            figures: side.side.figures.get(direction)?,
        })
    });
    found.collect()
}

/// The conditions of the test, a line each (R5.21).
fn conditions(report: &CircleReport) -> Vec<String> {
    match &report.subject {
        Subject::Simulated {
            test,
            origin,
            saturated,
        } => simulated_conditions(test, origin, *saturated),
        Subject::Recorded(recording) => recorded_conditions(recording),
    }
}

fn simulated_conditions(test: &CircularTest, origin: &ListOrigin, saturated: u64) -> Vec<String> {
    let circle = &test.circle;
    let mut lines = vec![
        format!(
            "circular test, simulated: diameter {} mm, feed {} mm/min, ccw and cw",
            2.0 * circle.radius,
            circle.feed
        ),
        format!(
            "plant {}, friction {}, CNC cycle {} ms, {}",
            test.plant.name,
            test.model.name(),
            round(1000.0 * circle.cycle_time),
            unit_force(test)
        ),
    ];
    let [x, y] = &test.lists;
    let list = match origin {
        ListOrigin::Plant => "the plant's own friction curve".to_owned(),
        ListOrigin::File(name) => name.clone(),
    };
    lines.push(format!("value list: {list}, {} points", x.table.len()));
    let each = if x == y {
        vec![("", x)]
    } else {
        vec![("X: ", x), ("Y: ", y)]
    };
    for (axis, list) in each {
        lines.push(format!(
            "  {axis}position_delay {}, reversal_lookahead {}, delay_cycles {}, scaling_factor {}",
            list.position_delay, list.reversal_lookahead, list.delay_cycles, list.scaling_factor
        ));
    }
    lines.push(format!("reading: {}", test.reading.words()));
    lines.push(format!("centre: the commanded one; {TREATMENT}"));
    if saturated > 0 {
        lines.push(format!(
            "the drives reached their largest force in {saturated} cycles of the speed loop"
        ));
    }
    lines
}

fn unit_force(test: &CircularTest) -> String {
    let [x, y] = [&test.plant.x, &test.plant.y].map(|drive| round(drive.force_per_unit));
    #[allow(clippy::float_cmp)] // the same text
    if x == y {
        format!("{x} N a drive unit")
    } else {
        format!("{x} N (X), {y} N (Y) a drive unit")
    }
}

fn recorded_conditions(recording: &Recording) -> Vec<String> {
    let commanded = match recording.radius {
        Some(radius) => format!("commanded diameter {} mm", 2.0 * radius),
        None => "commanded diameter unknown (`--radius` for F and D)".to_owned(),
    };
    let mut lines = vec![format!("circular test, recorded: {commanded}")];
    for circle in &recording.circles {
        let [x, y] = circle.centre;
        lines.push(format!(
            "{}: {} points of a turn, least-squares centre ({x:.4}, {y:.4}) mm, diameter {:.4} mm",
            circle.direction.name(),
            circle.points,
            2.0 * circle.radius
        ));
    }
    lines.push(format!("centre: least squares, for each path; {TREATMENT}"));
    lines
}

fn header(out: &mut String, columns: &[Column<'_>]) {
    let _ = write!(out, "{:<34}", "µm");
    for column in columns {
        let name = format!("{} {}", column.side.name, column.direction.name());
        let _ = write!(out, "{name:>13}");
    }
    let _ = writeln!(out);
}

/// A figure of one path by its name.
type Figure = (&'static str, fn(&PathFigures) -> Option<f64>);

/// A figure of both paths by its name.
type SharedFigure = (&'static str, fn(&Figures) -> Option<f64>);

fn figure_rows(out: &mut String, columns: &[Column<'_>]) {
    let own: [Figure; 5] = [
        ("G     minimum zone", |it| Some(it.g_mz)),
        ("G     least-squares circle", |it| Some(it.g_lsc)),
        ("Fmax  largest radial deviation", |it| it.f_max),
        ("Fmin  smallest radial deviation", |it| it.f_min),
        ("D     mean radial deviation", |it| it.d),
    ];
    for (name, figure) in own {
        row(
            out,
            name,
            columns.iter().map(|column| figure(column.figures)),
        );
    }
    let shared: [SharedFigure; 3] = [
        ("G(b)  bidirectional", |it| it.g_b),
        ("H     circular hysteresis", |it| it.h),
        ("D     bidirectional", |it| it.d),
    ];
    for (name, figure) in shared {
        // A figure of both directions stands in the first column of its side.
        let mut last = "";
        let values = columns.iter().map(|column| {
            let is_first = std::mem::replace(&mut last, column.side.name) != column.side.name;
            is_first
                .then(|| figure(&column.side.side.figures))
                .flatten()
        });
        row(out, name, values);
    }
}

fn glitch_rows(out: &mut String, columns: &[Column<'_>]) {
    for (at, crossing) in Crossing::ALL.into_iter().enumerate() {
        let name = format!("glitch at {}", crossing.name());
        let glitch = |column: &Column<'_>| column.figures.glitch.get(at).map(|it| it.height);
        row(out, &name, columns.iter().map(glitch));
    }
}

fn row(out: &mut String, name: &str, values: impl Iterator<Item = Option<f64>>) {
    let values: Vec<_> = values.collect();
    if values.iter().all(Option::is_none) {
        return;
    }
    let mut line = format!("{name:<33}");
    for value in values {
        let text = value.map(|value| format!("{value:.3}")).unwrap_or_default();
        let _ = write!(line, "{text:>13}");
    }
    let _ = writeln!(out, "{}", line.trim_end());
}

/// What the shapes suggest: the same finding at several crossings is said once.
fn advice_lines(out: &mut String, side: &NamedSide) {
    let mut said: Vec<(Finding, Vec<&Advice>)> = Vec::new();
    for advice in &side.advice {
        match said
            .iter_mut()
            .find(|(finding, _)| *finding == advice.finding)
        {
            Some((_, same)) => same.push(advice),
            None => said.push((advice.finding, vec![advice])),
        }
    }
    if !said.is_empty() {
        let _ = writeln!(out);
    }
    for (finding, same) in said {
        let mut places = Vec::new();
        for advice in &same {
            if let Place::Crossing(crossing) = advice.place
                && !places.contains(&crossing.name())
            {
                places.push(crossing.name());
            }
        }
        let largest = same.iter().map(|it| it.size).fold(0.0, f64::max);
        let at = if places.is_empty() {
            String::new()
        } else {
            format!(" at {}", places.join(" "))
        };
        let _ = writeln!(
            out,
            "{}{at}: {largest:.1} µm, {}",
            side.name,
            words(finding)
        );
    }
}

/// What a finding means and what to do.
pub fn words(finding: Finding) -> &'static str {
    match finding {
        Finding::Friction => "a peak that decays: friction at the reversal",
        Finding::TooWeak => {
            "a peak outwards is left: too weak, raise scaling_factor or the outputs"
        }
        Finding::TooStrong => "a cut inwards: too strong, lower scaling_factor or the outputs",
        Finding::TooEarly => {
            "inwards, then outwards: too early, raise position_delay or delay_cycles, or lower \
             reversal_lookahead"
        }
        Finding::TooLate => {
            "outwards, then inwards: too late, lower position_delay or delay_cycles, or raise \
             reversal_lookahead"
        }
        Finding::Backlash => "a step that stays: backlash, compensate it as such",
        Finding::GainMismatch => {
            "an ellipse at 45° that turns with the direction: the position loops of the axes \
             differ, make Kv and feed forward equal"
        }
        Finding::Squareness => {
            "an ellipse at 45° that stays with the direction: the axes are not square"
        }
        Finding::ScaleMismatch => "an ellipse along the axes: their scales differ",
    }
}

/// A number of µm as it is written for machines.
fn round(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    #[serde(flatten)]
    conditions: Conditions<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    off: Option<SideRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<SideRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recorded: Option<SideRecord>,
}

#[derive(Serialize)]
struct Conditions<'a> {
    source: &'static str,
    diameter_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    feed_mm_min: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cycle_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plant: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value_list: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reading: Option<String>,
    centre: &'static str,
    data: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    saturated_cycles: Option<u64>,
}

#[derive(Serialize)]
struct SideRecord {
    #[serde(skip_serializing_if = "Option::is_none")]
    ccw: Option<PathRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cw: Option<PathRecord>,
    #[serde(rename = "G_b")]
    g_b: Option<f64>,
    #[serde(rename = "H")]
    h: Option<f64>,
    #[serde(rename = "D")]
    d: Option<f64>,
    glitch_max: f64,
    advice: Vec<Advice>,
}

#[derive(Serialize)]
struct PathRecord {
    #[serde(rename = "G_mz")]
    g_mz: f64,
    #[serde(rename = "G_lsc")]
    g_lsc: f64,
    #[serde(rename = "F_max")]
    f_max: Option<f64>,
    #[serde(rename = "F_min")]
    f_min: Option<f64>,
    #[serde(rename = "D")]
    d: Option<f64>,
    glitch: ByCrossing<f64>,
    shape: ByCrossing<Shape>,
}

/// A value for each crossing.
#[derive(Serialize)]
struct ByCrossing<T> {
    #[serde(rename = "X+")]
    x_plus: T,
    #[serde(rename = "Y+")]
    y_plus: T,
    #[serde(rename = "X-")]
    x_minus: T,
    #[serde(rename = "Y-")]
    y_minus: T,
}

#[derive(Serialize)]
struct Shape {
    outward: f64,
    inward: f64,
    step: f64,
}

impl<T> ByCrossing<T> {
    fn of(glitches: &[Glitch], value: impl Fn(&Glitch) -> T) -> Self {
        let at = |crossing: Crossing| {
            let glitch = glitches.iter().find(|glitch| glitch.crossing == crossing);
            value(glitch.expect("a path has a glitch for every crossing"))
        };
        Self {
            x_plus: at(Crossing::XPlus),
            y_plus: at(Crossing::YPlus),
            x_minus: at(Crossing::XMinus),
            y_minus: at(Crossing::YMinus),
        }
    }
}

impl PathRecord {
    fn of(figures: &PathFigures) -> Self {
        Self {
            g_mz: round(figures.g_mz),
            g_lsc: round(figures.g_lsc),
            f_max: figures.f_max.map(round),
            f_min: figures.f_min.map(round),
            d: figures.d.map(round),
            glitch: ByCrossing::of(&figures.glitch, |glitch| round(glitch.height)),
            shape: ByCrossing::of(&figures.glitch, |glitch| Shape {
                outward: round(glitch.outward),
                inward: round(glitch.inward),
                step: round(glitch.step),
            }),
        }
    }
}

impl SideRecord {
    fn of(side: &NamedSide) -> Self {
        let figures = &side.side.figures;
        let rounded = |advice: &Advice| Advice {
            size: round(advice.size),
            ..*advice
        };
        Self {
            ccw: figures.ccw.as_ref().map(PathRecord::of),
            cw: figures.cw.as_ref().map(PathRecord::of),
            g_b: figures.g_b.map(round),
            h: figures.h.map(round),
            d: figures.d.map(round),
            glitch_max: round(figures.glitch_max()),
            advice: side.advice.iter().map(rounded).collect(),
        }
    }
}

/// The report for machines, all lengths in µm unless the key says otherwise.
pub fn render_json(report: &CircleReport) -> String {
    let side = |name: &str| {
        let side = report.sides.iter().find(|side| side.name == name);
        side.map(SideRecord::of)
    };
    let conditions = match &report.subject {
        Subject::Simulated {
            test,
            origin,
            saturated,
        } => Conditions {
            source: "simulated",
            diameter_mm: Some(2.0 * test.circle.radius),
            feed_mm_min: Some(test.circle.feed),
            cycle_time_s: Some(test.circle.cycle_time),
            plant: Some(&test.plant.name),
            model: Some(test.model.name()),
            value_list: Some(match origin {
                ListOrigin::Plant => "plant",
                ListOrigin::File(name) => name,
            }),
            reading: Some(test.reading.words()),
            centre: "commanded",
            data: TREATMENT,
            saturated_cycles: Some(*saturated),
        },
        Subject::Recorded(recording) => Conditions {
            source: "recorded",
            diameter_mm: recording.radius.map(|radius| 2.0 * radius),
            feed_mm_min: None,
            cycle_time_s: None,
            plant: None,
            model: None,
            value_list: None,
            reading: None,
            centre: "least-squares",
            data: TREATMENT,
            saturated_cycles: None,
        },
    };
    let document = Document {
        schema: 1,
        conditions,
        off: side("off"),
        on: side("on"),
        recorded: side("recorded"),
    };
    let mut text =
        serde_json::to_string_pretty(&document).expect("numbers and texts are always JSON");
    text.push('\n');
    text
}

/// The radial deviations: a row every 0.1° for each path.
pub fn render_csv(report: &CircleReport) -> String {
    let mut out = String::from("compensation,direction,angle_deg,deviation_um\n");
    for side in &report.sides {
        for (direction, profile) in side.side.paths.iter() {
            let deviations = profile.deviations();
            for (row, deviation) in deviations
                .iter()
                .step_by(deviations.len() / ROWS)
                .enumerate()
            {
                #[allow(clippy::cast_precision_loss)] // at most 3600
                let angle = row as f64 / 10.0;
                let deviation = round(deviation * 1e6);
                let name = direction.name();
                let _ = writeln!(out, "{},{name},{angle},{deviation}", side.name);
            }
        }
    }
    out
}
