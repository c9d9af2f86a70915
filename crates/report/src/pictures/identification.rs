//! An identified friction curve: speeds with their errors, the curve, and the residuals.

use crate::results::identify::IdentifyReport;
use crate::svg::{ChartAxis, Drawn, LineChart, Panel, Series};

/// Draws friction over speed: the pairs with their errors, the curve, the points of the list; below it the differences
/// of the pairs from the curve.
pub fn friction_curve(report: &IdentifyReport) -> LineChart {
    let found = &report.identified;
    let unit = report.unit();
    let (slowest, fastest) = match (found.pairs.first(), found.pairs.last()) {
        (Some(first), Some(last)) => (first.speed, last.speed),
        _ => (1.0, 1.0),
    };
    let bars = |values: &dyn Fn(f64, f64) -> f64| {
        let bar = |pair: &frictcomp_recordings::identify::Pair| {
            let value = values(pair.speed, pair.friction);
            [
                [pair.speed, value - pair.error],
                [pair.speed, value + pair.error],
                [f64::NAN, f64::NAN],
            ]
        };
        found.pairs.iter().flat_map(bar).collect()
    };
    let measured: Vec<[f64; 2]> = found
        .pairs
        .iter()
        .map(|pair| [pair.speed, pair.friction])
        .collect();
    let residuals: Vec<[f64; 2]> = found
        .pairs
        .iter()
        .map(|pair| [pair.speed, pair.friction - found.curve.at(pair.speed)])
        .collect();
    let steps = (fastest / slowest).ln() / 200.0;
    let speeds = (0..=200).map(|at| slowest * (f64::from(at) * steps).exp());
    let points = found.points.iter();
    let points = points.map(|point| [point.input / 1000.0, point.output]);
    let listed = points.filter(|point| point[0] >= slowest);
    LineChart {
        title: report.titled("Friction"),
        description: format!(
            "Friction in {unit} at {} speeds from {slowest:.3} to {fastest:.3} mm/s with standard errors, the \
             curve through them and the {} points of the value list; below, how far the speeds are from \
             the curve.",
            found.pairs.len(),
            found.points.len()
        ),
        x: ChartAxis::logarithmic("speed in mm/s, logarithmic"),
        panels: vec![
            Panel {
                y: ChartAxis::linear(format!("friction in {unit}, bars are standard errors"))
                    .from_zero(),
                series: vec![
                    series("measured", measured, Drawn::Scattered),
                    series("error", bars(&|_, friction| friction), Drawn::Held),
                    series(
                        "curve",
                        speeds.map(|v| [v, found.curve.at(v)]).collect(),
                        Drawn::Line,
                    ),
                    series(
                        "points of the value list",
                        listed.collect(),
                        Drawn::Scattered,
                    ),
                ],
                ..Panel::default()
            },
            Panel {
                y: ChartAxis::linear(format!("residual in {unit}")),
                series: vec![
                    series("residual", residuals, Drawn::Scattered),
                    series(
                        "error",
                        bars(&|v, friction| friction - found.curve.at(v)),
                        Drawn::Held,
                    ),
                ],
                ..Panel::default()
            },
        ],
        ..LineChart::default()
    }
}

/// Returns the distance of the torque from the mean of its segment, over the position: its mean in pieces of the
/// travel, and the range of nine tenths of the samples. All of them would be a block of colour.
pub fn residuals_over_position(report: &IdentifyReport) -> LineChart {
    let unit = report.unit();
    let pieces = Piece::of_way(&report.identified.residuals);
    let over = |value: fn(&Piece) -> f64| pieces.iter().map(|it| [it.place, value(it)]).collect();
    LineChart {
        title: report.titled("Residual torque over the position"),
        description: format!(
            "How far the torque is from the mean of its segment, in {unit}, over the position: what \
             repeats here is not friction."
        ),
        x: ChartAxis::linear("position in mm"),
        panels: vec![Panel {
            y: ChartAxis::linear(format!("residual in {unit}")),
            series: vec![
                series("mean", over(|it| it.mean), Drawn::Line),
                series("5 % are lower", over(|it| it.low), Drawn::Line),
                series("5 % are higher", over(|it| it.high), Drawn::Line),
            ],
            ..Panel::default()
        }],
        ..LineChart::default()
    }
}

/// The residuals in a piece of the travel.
struct Piece {
    /// Middle.
    place: f64,
    mean: f64,
    low: f64,
    high: f64,
}

/// Pieces of the travel.
const PIECES: u32 = 100;

impl Piece {
    /// Pieces of equal length, those without samples left out.
    fn of_way(residuals: &[[f64; 2]]) -> Vec<Self> {
        let mut points = residuals.to_vec();
        points.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let (Some([first, _]), Some([last, _])) = (points.first(), points.last()) else {
            return Vec::new();
        };
        let length = (last - first) / f64::from(PIECES);
        let mut rest = &points[..];
        let pieces = (1..=PIECES).filter_map(|number| {
            let end = first + length * f64::from(number);
            let count = if number == PIECES {
                rest.len()
            } else {
                rest.partition_point(|point| point[0] < end)
            };
            let (piece, later) = rest.split_at(count);
            rest = later;
            Self::of(piece, end - length / 2.0)
        });
        pieces.collect()
    }

    fn of(points: &[[f64; 2]], place: f64) -> Option<Self> {
        let mut values: Vec<f64> = points.iter().map(|point| point[1]).collect();
        values.sort_by(f64::total_cmp);
        let twentieth = values.len() / 20;
        let low = *values.get(twentieth)?;
        let high = *values.get(values.len() - 1 - twentieth)?;
        let count = f64::from(u32::try_from(values.len()).unwrap_or(u32::MAX));
        Some(Self {
            place,
            mean: values.iter().sum::<f64>() / count,
            low,
            high,
        })
    }
}

/// Draws velocity and torque over time, the used samples drawn over all others.
pub fn segments_on_trace(report: &IdentifyReport) -> LineChart {
    let track = &report.recording.track;
    let over_time = |values: &[f64], factor: f64| -> Vec<[f64; 2]> {
        let pairs = track.times_s.iter().zip(values);
        pairs.map(|(time, value)| [*time, value * factor]).collect()
    };
    let used = |values: &[f64], factor: f64| -> Vec<[f64; 2]> {
        let segment = |segment: &frictcomp_recordings::identify::Segment| {
            let samples = segment.samples.clone();
            let points = samples.map(|at| [track.times_s[at], values[at] * factor]);
            points.chain([[f64::NAN, f64::NAN]]).collect::<Vec<_>>()
        };
        report
            .identified
            .segments
            .iter()
            .flat_map(segment)
            .collect()
    };
    let (motion, label, factor) = match (&track.velocities, &track.positions) {
        (Some(velocities), _) => (velocities, "velocity in mm/s", 1e-3),
        (None, Some(positions)) => (positions, "position in mm", 1e-4),
        (None, None) => (&track.torques, "torque", 1.0),
    };
    let panel = |label: String, values: &[f64], factor: f64| Panel {
        y: ChartAxis::linear(label.clone()),
        series: vec![
            series("recorded", over_time(values, factor), Drawn::Line),
            series("used", used(values, factor), Drawn::Line),
        ],
        ..Panel::default()
    };
    LineChart {
        title: report.titled("Segments of constant speed"),
        description: format!(
            "The recording over time, and the {} segments of constant speed that are used.",
            report.identified.segments.len()
        ),
        x: ChartAxis::linear("time in s"),
        panels: vec![
            panel(label.to_owned(), motion, factor),
            panel(format!("torque in {}", report.unit()), &track.torques, 1.0),
        ],
        ..LineChart::default()
    }
}

fn series(name: &str, points: Vec<[f64; 2]>, drawn: Drawn) -> Series {
    Series {
        name: name.to_owned(),
        points,
        drawn,
    }
}
