//! The friction of a commissioned axis, and its circles before and after.

use crate::svg::{ChartAxis, Drawn, LineChart, Panel, Series};
use frictcomp_recordings::commission::{BeforeAfter, FrictionFound, Round, Shows};

/// Draws friction over speed with bars of one standard error, and the points of the list.
pub(super) fn friction_of_axis(found: &FrictionFound) -> LineChart {
    let bar = |&[speed, friction, error]: &[f64; 3]| {
        [
            [speed, friction - error],
            [speed, friction + error],
            [f64::NAN, f64::NAN],
        ]
    };
    let slowest = found.speeds.first().map_or(0.0, |it| it[0]);
    let points = found.table.iter().map(|it| [it[0] / 1000.0, it[1]]);
    let points: Vec<[f64; 2]> = points.filter(|it| it[0] >= slowest).collect();
    let curve = points.windows(2).flat_map(|ends| between(ends[0], ends[1]));
    let curve: Vec<[f64; 2]> = curve.chain(points.last().copied()).collect();
    let series = |name: &str, points: Vec<[f64; 2]>, drawn: Drawn| Series {
        name: name.to_owned(),
        points,
        drawn,
    };
    LineChart {
        title: format!("Friction of axis {}", found.axis),
        description: format!(
            "Friction in drive units at {} recorded speeds, and the points of the list.",
            found.speeds.len()
        ),
        x: ChartAxis::logarithmic("speed in mm/s or degrees/s, logarithmic"),
        panels: vec![Panel {
            y: ChartAxis::linear("friction in drive units, bars are standard errors").from_zero(),
            series: vec![
                series(
                    "recorded",
                    found.speeds.iter().map(|it| [it[0], it[1]]).collect(),
                    Drawn::Scattered,
                ),
                series(
                    "recorded",
                    found.speeds.iter().flat_map(bar).collect(),
                    Drawn::Held,
                ),
                series("list", curve, Drawn::Line),
                series("list", points, Drawn::Points),
            ],
            ..Panel::default()
        }],
        ..LineChart::default()
    }
}

/// Returns a straight line between two points of a list, as points without its end: over the logarithm of the speed it
/// is a curve.
fn between(from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    const PARTS: u32 = 12;
    (0..PARTS).map(move |part| {
        let share = f64::from(part) / f64::from(PARTS);
        [0, 1].map(|at| from[at] + share * (to[at] - from[at]))
    })
}

/// Returns the glitches of a round over the feed, off and on.
pub(super) fn glitches_by_feed(round: &Round) -> LineChart {
    let series = |name: &str, value: fn(&BeforeAfter) -> f64| Series {
        name: name.to_owned(),
        points: round
            .recorded
            .iter()
            .map(|it| [it.driven, value(it)])
            .collect(),
        drawn: Drawn::Marked,
    };
    let (title, x, y) = match round.shows {
        Shows::Contour => ("Largest glitch of recorded circles", "mm", "glitch"),
        Shows::FollowingError => (
            "Following error after recorded reversals: motor side, not contour",
            if round.unit == "µm" { "mm" } else { "degrees" },
            "following error",
        ),
    };
    LineChart {
        title: title.to_owned(),
        description: format!(
            "{title}, at {} feeds with compensation off and on.",
            round.recorded.len()
        ),
        x: ChartAxis::linear(format!("feed in {x}/min")),
        panels: vec![Panel {
            y: ChartAxis::linear(format!("{y} in {}", round.unit)).from_zero(),
            series: vec![series("off", |it| it.off), series("on", |it| it.on)],
            ..Panel::default()
        }],
        ..LineChart::default()
    }
}
