//! The circular test as a document.

use super::picture::{picture, title};
use super::subject::{CircleReport, ListOrigin, NamedSide, Subject, TREATMENT};
use crate::assumptions::{not_modelled, not_modelled_line};
use crate::document::{Document, Table};
use crate::pictures::value_curve;
use crate::results::stiction::guideline;
use crate::wording::{counted, rounded};
use frictcomp::diagnostic::{ReadableNumber, Rounded};
use frictcomp::lists::{AxisType, FrictionList};
use frictcomp::machine::AcceptedList;
use frictcomp_physics::circle::{
    AxisShape, CircularTest, Crossing, Diagnosis, DiagnosisGrounds, Direction, Figures, Finding,
    FoundAt, LeftOut, Method, PathFigures, PathShape, PlaneAxis, RecordedCircle, Recording,
    WholeTurns,
};
use frictcomp_physics::stiction::StictionParameters;

/// Returns the figures, what the shapes suggest, and the conditions.
pub fn document(report: &CircleReport) -> Document<'_> {
    let mut out = Document::new(title(report), report.headline());
    out.figure(|| picture(report));
    match &report.subject {
        Subject::Recorded(recording) => out.lines(recorded_conditions(recording)),
        Subject::Simulated {
            saturated_cycles, ..
        } => out.lines(saturation(*saturated_cycles)),
    }
    out.folded("Conditions");
    out.lines(conditions(report));
    out.section("Figures");
    out.push_str("\n");
    out.table(table(report));
    out.section("What the shapes suggest");
    for side in &report.sides {
        let lines = advice_lines(report, side);
        if !lines.is_empty() {
            out.push_str("\n");
        }
        out.lines(lines);
    }
    if !report.findings.is_empty() {
        out.section("What to look at");
        out.findings(&report.findings);
    }
    out.section("Value lists");
    for list in lists(report) {
        out.figure(move || value_curve(&list));
    }
    out
}

/// Returns the value lists of the axes, one if both have the same.
fn lists(report: &CircleReport) -> Vec<AcceptedList> {
    let Subject::Simulated { test, .. } = &report.subject else {
        return Vec::new();
    };
    let accepted = |axis: &str, list: &FrictionList| AcceptedList {
        axis: axis.to_owned(),
        axis_type: AxisType::Linear,
        list: list.clone(),
    };
    let lists = test.compensation.each_ref();
    let [Some(x), Some(y)] = lists.map(|it| it.as_ref().and_then(Method::list)) else {
        return Vec::new();
    };
    if x == y {
        vec![accepted("X and Y", x)]
    } else {
        vec![accepted("X", x), accepted("Y", y)]
    }
}

/// Decimals of a simulated figure in µm (R18.26), and of a recorded one.
const SIMULATED: usize = 1;
const RECORDED: usize = 3;

/// One figure of all paths.
struct FigureRow {
    name: String,
    /// Values by path; a figure of both directions is in the first column of its side.
    values: Vec<Option<f64>>,
}

/// Returns the figures of ISO 230-4, then the glitches, in µm.
fn table(report: &CircleReport) -> Table {
    let columns = columns(report);
    let mut table = columns
        .iter()
        .map(PathColumn::name)
        .fold(Table::default().left("µm"), Table::right);
    let decimals = match report.subject {
        Subject::Simulated { .. } => SIMULATED,
        Subject::Recorded(_) => RECORDED,
    };
    for row in figure_rows(&columns) {
        table.cells(row.cells(decimals));
    }
    table.row(&[]);
    for row in shape_rows(&columns) {
        table.cells(row.cells(decimals));
    }
    table
}

/// One path of the table.
struct PathColumn<'a> {
    side: &'a NamedSide,
    direction: Direction,
    figures: &'a PathFigures,
}

impl PathColumn<'_> {
    fn name(&self) -> String {
        format!("{} {}", self.side.name, self.direction)
    }
}

fn columns(report: &CircleReport) -> Vec<PathColumn<'_>> {
    let pairs = report.sides.iter().flat_map(|side| {
        Direction::ALL
            .into_iter()
            .map(move |direction| (side, direction))
    });
    let found = pairs.filter_map(|(side, direction)| {
        Some(PathColumn {
            side,
            direction,
            figures: side.side.figures.get(direction)?,
        })
    });
    found.collect()
}

/// Returns the conditions of the test, one line each (R5.21).
fn conditions(report: &CircleReport) -> Vec<String> {
    let mut lines = match &report.subject {
        Subject::Simulated { test, origin, .. } => simulated_conditions(test, origin),
        Subject::Recorded(_) => Vec::new(),
    };
    lines.extend(bidirectional_condition(report));
    lines.extend(window_condition(report));
    lines
}

/// Returns the centre about which both paths are compared (R5.21).
fn bidirectional_condition(report: &CircleReport) -> Option<String> {
    let figures = report.sides.iter().map(|side| &side.side.figures);
    let distances: Vec<String> = figures
        .filter_map(|it| it.centre_distance_um)
        .map(|distance| format!("{} µm", Rounded(distance, 3)))
        .collect();
    let centre = report.sides.first()?.side.figures.centre;
    (!distances.is_empty()).then(|| {
        format!(
            "G(b) and H: about {}, which are {} apart",
            centre.title(),
            distances.join(" and ")
        )
    })
}

/// Returns the window of the glitch in words (R5.22).
fn window_condition(report: &CircleReport) -> Option<String> {
    let mut figures = report.sides.iter().map(|side| &side.side.figures);
    let shape = figures.find_map(|it| {
        [&it.ccw, &it.cw]
            .into_iter()
            .flatten()
            .next()?
            .shape
            .as_ref()
    });
    let degrees = ReadableNumber((shape?.window_deg * 10.0).round() / 10.0);
    let time = match report.driven().1 {
        Some(_) => "the larger of 8\u{b0} and 0.3 s",
        None => "of an unknown feed, which the feed or a column `t` gives",
    };
    Some(format!(
        "glitch: from 8\u{b0} before to {degrees}\u{b0} after a crossing, {time}; less the ellipse \
         and a straight line through both sides"
    ))
}

/// Returns the reason why the report has no glitches, and what would give some (R5.22).
pub(super) fn no_glitches(report: &CircleReport) -> Option<String> {
    let limit = report.too_fast()?;
    let radius = limit.radius_mm.map_or(String::new(), |radius| {
        format!(" or a radius of {} mm and more", ReadableNumber(radius))
    });
    Some(format!(
        "no glitch and no advice: 0.3 s after a crossing the path is half-way to the next one; a \
         feed of {} mm/min or less{radius} gives figures",
        ReadableNumber(limit.feed_mm_per_min)
    ))
}

/// Returns the cycles in which a force was limited, if there are any.
fn saturation(cycles: u64) -> Option<String> {
    (cycles > 0).then(|| {
        format!("the drives reached their largest force in {cycles} cycles of the speed loop")
    })
}

fn simulated_conditions(test: &CircularTest, origin: &ListOrigin) -> Vec<String> {
    let circle = &test.circle;
    let mut lines = vec![
        format!(
            "circular test, simulated: diameter {} mm, feed {} mm/min, ccw and cw",
            2.0 * circle.radius_mm,
            circle.feed_mm_per_min
        ),
        format!(
            "plant {}, friction {}, CNC cycle {} ms, {}",
            test.plant.name,
            test.model,
            rounded(1000.0 * circle.cycle_time_s),
            unit_force(test)
        ),
    ];
    lines.extend(if test.is_stiction() {
        stiction_conditions(test)
    } else {
        list_conditions(test, origin)
    });
    lines.push(format!("reading: {}", test.reading));
    lines.push(format!(
        "centre: the commanded one for F and D; {TREATMENT}"
    ));
    lines.push(not_modelled_line(&not_modelled([
        &test.plant.x,
        &test.plant.y,
    ])));
    lines
}

/// Returns the value lists, which may differ between the axes.
fn list_conditions(test: &CircularTest, origin: &ListOrigin) -> Vec<String> {
    let lists = test.compensation.each_ref();
    let [Some(x), Some(y)] = lists.map(|it| it.as_ref().and_then(Method::list)) else {
        return Vec::new();
    };
    let list = match origin {
        ListOrigin::Plant => "the plant's own friction curve".to_owned(),
        ListOrigin::File(_) | ListOrigin::EachAxis(_) => origin.name(),
    };
    let mut lines = vec![format!(
        "value list: {list}, {}",
        counted(x.table.len(), "point")
    )];
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
    lines
}

/// Returns the remarks on stiction compensation of the axes: where it does not act, and which guidelines it does not
/// keep (R8.2, R8.3).
fn stiction_conditions(test: &CircularTest) -> Vec<String> {
    let mut lines = vec!["stiction compensation, as the plant file says".to_owned()];
    let drives = [&test.plant.x, &test.plant.y];
    let feed = test.circle.feed_mm_per_min / 1000.0;
    let axes = PlaneAxis::ALL.into_iter().zip(&test.compensation);
    for ((axis, compensation), drive) in axes.zip(drives) {
        let Some(stiction) = compensation.as_ref().and_then(Method::stiction) else {
            lines.push(format!("  {axis}: none"));
            continue;
        };
        lines.push(format!("  {axis}: {}", stiction_line(stiction)));
        if !stiction.acts_at(feed) {
            lines.push(format!(
                "  {axis}: the feed is above MP1513, nothing is added"
            ));
        }
        if drive.velocity_forward <= 0.0 {
            lines.push(format!(
                "  {axis}: without feed forward, `k_ff`, nothing is added"
            ));
        }
        let kept = stiction.guidelines().into_iter().map(guideline);
        lines.extend(kept.map(|it| format!("  {axis}: {it}")));
    }
    lines
}

/// Returns the parameters of stiction compensation in one line.
pub(crate) fn stiction_line(stiction: &StictionParameters) -> String {
    let feed = stiction.mp1513_m_per_min.map_or(String::new(), |feed| {
        format!(", MP1513 {} m/min", ReadableNumber(feed))
    });
    format!(
        "MP1511 {} µs, MP1512 {} (Δs_a at most {} µm), GP {} µm, t_C {} µs{feed}",
        ReadableNumber(stiction.mp1511_us),
        ReadableNumber(stiction.mp1512),
        ReadableNumber(rounded(stiction.limit_um())),
        ReadableNumber(stiction.gp_um),
        ReadableNumber(stiction.tc_us)
    )
}

fn unit_force(test: &CircularTest) -> String {
    let [x, y] = [&test.plant.x, &test.plant.y].map(|drive| rounded(drive.force_per_unit_n));
    #[allow(clippy::float_cmp)] // the same text
    if x == y {
        format!("{x} N a drive unit")
    } else {
        format!("{x} N (X), {y} N (Y) a drive unit")
    }
}

fn recorded_conditions(recording: &Recording) -> Vec<String> {
    let commanded = match recording.commanded.radius_mm {
        Some(radius) => format!("commanded diameter {} mm", 2.0 * radius),
        None => "commanded diameter unknown, which F and D need".to_owned(),
    };
    let mut lines = vec![format!("circular test, recorded: {commanded}")];
    for circle in &recording.circles {
        let [x, y] = circle.centre_mm;
        let feed = circle
            .feed_mm_per_min()
            .map_or(String::new(), |feed| format!(", feed {feed:.0} mm/min"));
        lines.push(format!(
            "{}: {} points of a turn, least-squares centre ({}, {}) mm, diameter {:.4} \
             mm{feed}",
            circle.direction,
            circle.points,
            Rounded(x, 4),
            Rounded(y, 4),
            2.0 * circle.radius_mm
        ));
        lines.push(left_out(circle));
        lines.extend(circle.whole_turns().map(other_turns));
    }
    lines.push(format!("centre: least squares, for each path; {TREATMENT}"));
    lines
}

/// Returns the parts cut away, in words (R5.26).
fn left_out(circle: &RecordedCircle) -> String {
    let LeftOut {
        repeated,
        before,
        after,
        along_deg,
    } = circle.left_out;
    format!(
        "  taken from {along_deg:.0}\u{b0} along the circle; left out: {before} points before it, \
         {after} after it, {repeated} repeated rows"
    )
}

/// Describes the glitches of the other turns (R5.26).
fn other_turns(turns: WholeTurns) -> String {
    match turns.worse {
        Some(worse) => format!("  not every turn is like the evaluated one: {worse}"),
        None => format!(
            "  of {} whole turns none leaves more at a crossing than the evaluated one, by a quarter or 0.5 µm",
            turns.count
        ),
    }
}

/// A figure of one path by its name.
type PathFigure = (&'static str, fn(&PathFigures) -> Option<f64>);

/// A figure of both paths by its name.
type SharedFigure = (&'static str, fn(&Figures) -> Option<f64>);

fn figure_rows(columns: &[PathColumn<'_>]) -> Vec<FigureRow> {
    let own: [PathFigure; 5] = [
        ("G     minimum zone", |it| Some(it.g_mz_um)),
        ("G     least-squares circle", |it| Some(it.g_lsc_um)),
        ("Fmax  largest radial deviation", |it| it.f_max_um),
        ("Fmin  smallest radial deviation", |it| it.f_min_um),
        ("D     mean radial deviation", |it| it.d_um),
    ];
    let own = own.into_iter().map(|(name, figure)| FigureRow {
        name: name.to_owned(),
        values: columns
            .iter()
            .map(|column| figure(column.figures))
            .collect(),
    });
    let shared: [SharedFigure; 3] = [
        ("G(b)  bidirectional", |it| it.g_b_um),
        ("H     circular hysteresis", |it| it.h_um),
        ("D     bidirectional", |it| it.d_um),
    ];
    let shared = shared.into_iter().map(|(name, figure)| {
        let mut last = "";
        let values = columns.iter().map(|column| {
            let is_first = std::mem::replace(&mut last, column.side.name) != column.side.name;
            is_first
                .then(|| figure(&column.side.side.figures))
                .flatten()
        });
        FigureRow {
            name: name.to_owned(),
            values: values.collect(),
        }
    });
    own.chain(shared)
        .filter(FigureRow::says_something)
        .collect()
}

/// Returns the shapes of the paths at the crossings: the glitches, and for each axis the permanent
/// and the decaying part.
fn shape_rows(columns: &[PathColumn<'_>]) -> Vec<FigureRow> {
    let row = |name: String, value: &dyn Fn(&PathShape) -> Option<f64>| FigureRow {
        name,
        values: columns
            .iter()
            .map(|column| value(column.figures.shape.as_ref()?))
            .collect(),
    };
    let crossings = Crossing::ALL.into_iter().enumerate();
    let glitches = crossings.map(|(at, crossing)| {
        row(format!("glitch at {crossing}"), &|shape| {
            shape.glitches.get(at).map(|it| it.height_um)
        })
    });
    let of_axis = |axis: PlaneAxis, name: &str, value: fn(&AxisShape) -> f64| {
        row(format!("{axis}: {name}"), &|shape| {
            Some(value(shape.axis(axis)))
        })
    };
    let axes = PlaneAxis::ALL.into_iter().flat_map(|axis| {
        [
            of_axis(axis, "peak that decays", |it| it.peak_um),
            of_axis(axis, "step that stays", |it| it.step_um),
        ]
    });
    glitches
        .chain(axes)
        .filter(FigureRow::says_something)
        .collect()
}

impl FigureRow {
    fn says_something(&self) -> bool {
        self.values.iter().any(Option::is_some)
    }

    fn cells(&self, decimals: usize) -> Vec<String> {
        let values = self.values.iter();
        let values = values.map(|value| value.map(|value| Rounded(value, decimals).to_string()));
        let name = [self.name.clone()].into_iter();
        name.chain(values.map(Option::unwrap_or_default)).collect()
    }
}

/// Returns the suggested causes: the same finding at several crossings is reported once.
pub(super) fn advice_lines(report: &CircleReport, side: &NamedSide) -> Vec<String> {
    let words = match &report.subject {
        Subject::Simulated { test, .. } if test.is_stiction() => words_of_stiction,
        _ => words,
    };
    let mut said: Vec<(Finding, Vec<&Diagnosis>)> = Vec::new();
    for advice in &side.advice {
        match said
            .iter_mut()
            .find(|(finding, _)| *finding == advice.finding)
        {
            Some((_, same)) => same.push(advice),
            None => said.push((advice.finding, vec![advice])),
        }
    }
    let mut lines = Vec::new();
    for (finding, same) in said {
        let mut places = Vec::new();
        for advice in &same {
            let place = match advice.place {
                FoundAt::Crossing(crossing) => crossing.as_str(),
                FoundAt::Axis(axis) => axis.as_str(),
                _ => continue,
            };
            if !places.contains(&place) {
                places.push(place);
            }
        }
        let largest = same.iter().map(|it| it.size_um).fold(0.0, f64::max);
        let at = if places.is_empty() {
            String::new()
        } else {
            format!(" at {}", places.join(" "))
        };
        lines.push(format!(
            "{}{at}: {largest:.1} µm{}, {}",
            side.name,
            grounds(&same[0].grounds),
            words(finding)
        ));
    }
    lines
}

/// Returns the grounds of advice about a recording, with the evidence against it (R5.28).
fn grounds(grounds: &DiagnosisGrounds) -> String {
    let mut said = Vec::new();
    said.extend(grounds.error_um.map(|it| format!("± {it:.2}")));
    said.extend(grounds.pitch_mm.map(|it| format!("every {it:.2} mm")));
    said.extend(grounds.hertz.map(|it| format!("{it:.1} Hz")));
    said.extend(
        grounds
            .unexplained_um
            .filter(|it| *it >= 0.05)
            .map(|it| format!("{it:.2} unexplained")),
    );
    if said.is_empty() {
        return String::new();
    }
    format!(" ({})", said.join(", "))
}

/// Returns the meaning of a finding if the compensation is that of stiction.
fn words_of_stiction(finding: Finding) -> &'static str {
    match finding {
        Finding::TooWeak => "a peak outwards remains: raise MP1511, or MP1512 where it limits",
        Finding::WrongSign => "larger than without compensation: lower MP1511",
        Finding::TooStrong | Finding::TooEarly | Finding::TooLate => {
            "a cut inwards: it adds too much, lower MP1511 or MP1512"
        }
        other => words(other),
    }
}

/// Returns the meaning of a finding, with the advice.
pub fn words(finding: Finding) -> &'static str {
    match finding {
        Finding::Friction => "a peak that decays: friction at the reversal",
        Finding::TooWeak => {
            "a peak outwards remains: too weak, raise scaling_factor or the outputs"
        }
        Finding::WrongSign => {
            "larger than without compensation: it pushes the wrong way, change the sign of the \
             outputs"
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
        Finding::Backlash => "a step outwards that stays: backlash, compensate it as such",
        Finding::OvercompensatedBacklash => {
            "a step inwards that stays: more backlash is compensated than there is, lower its \
             compensation"
        }
        Finding::GainMismatch => {
            "an ellipse at 45° that turns with the direction: the position loops of the axes \
             differ, make Kv and feed forward equal"
        }
        Finding::Squareness => {
            "an ellipse at 45° that does not turn with the direction: the axes are not square"
        }
        Finding::ScaleMismatch => "an ellipse along the axes: their scales differ",
        Finding::LateralPlay => {
            "a step sideways where the other axis reverses: play of the guide of this axis"
        }
        Finding::Periodic => {
            "repeats along the axis: an error of the screw or the encoder, nothing for friction \
             compensation"
        }
        Finding::Vibration => {
            "an oscillation in time: look for its source, compensation does not end it"
        }
        Finding::StickSlip => "swings after the reversal: the axis sticks and slips",
        Finding::Drift => {
            "a turn: the circle shifts while it is driven, warm the machine up and record again"
        }
        Finding::OtherShape => {
            "another shape than those of friction, backlash and axes that do not match; nothing is said \
             about the timing of compensation"
        }
    }
}
