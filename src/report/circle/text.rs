//! The circular test for people.

use std::fmt::Write as _;

use super::{CircleReport, ListOrigin, NamedSide, Subject, TREATMENT, round};
use crate::circle::{
    Advice, CircularTest, Crossing, Direction, Figures, Finding, PathFigures, Place, Recording,
};

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
