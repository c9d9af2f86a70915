//! Friction in several states, and over the years.

use crate::results::identify::states::StatesReport;
use crate::svg::{ChartAxis, Drawn, LineChart, Panel, Series};
use frictcomp_recordings::identify::FrictionParameter;
use frictcomp_recordings::identify::TrendReport;
use frictcomp_recordings::value_lists::DRIVE_UNITS;

/// Draws friction over speed, a curve for each state.
pub fn friction_states(report: &StatesReport) -> LineChart {
    let curve = |name: &str, drawn: Drawn, points: Vec<[f64; 2]>| Series {
        name: name.to_owned(),
        points,
        drawn,
    };
    let series = report.states.iter().map(|(name, state)| {
        let pairs = state.identified.pairs.iter();
        curve(
            name,
            Drawn::Marked,
            pairs.map(|it| [it.speed, it.friction]).collect(),
        )
    });
    let unit = report.states.first().map_or(DRIVE_UNITS, |it| it.1.unit());
    LineChart {
        title: "Friction in each state".to_owned(),
        description: format!(
            "Friction in {unit} over speed in {} states; {}.",
            report.states.len(),
            report.spread()
        ),
        x: ChartAxis::logarithmic("speed in mm/s, logarithmic"),
        panels: vec![Panel {
            y: ChartAxis::linear(format!("friction in {unit}")).from_zero(),
            series: series.collect(),
            ..Panel::default()
        }],
        ..LineChart::default()
    }
}

/// Draws Fc, Fs, fv and the offset over the days since the first recording, with bars of one standard error.
pub fn friction_trend(report: &TrendReport) -> LineChart {
    let first = report.dates.first();
    let (day, date) = first.map_or((0.0, ""), |it| (it.day, &it.date));
    let panel = |parameters: &[FrictionParameter], unit: &str| {
        let names: Vec<&str> = parameters.iter().map(|it| it.as_str()).collect();
        let series = parameters
            .iter()
            .flat_map(|&parameter| series(report, parameter, day));
        Panel {
            y: ChartAxis::linear(format!("{} in {unit}", names.join(" and "))),
            series: series.collect(),
            ..Panel::default()
        }
    };
    let unit = &report.unit;
    LineChart {
        title: report
            .axis
            .as_deref()
            .map_or("Friction over the dates".to_owned(), |axis| {
                format!("Friction of axis {axis} over the dates")
            }),
        description: format!(
            "Friction of {} recordings over the days since {date}.",
            report.dates.len()
        ),
        x: ChartAxis::linear(format!("days since {date}")),
        panels: vec![
            panel(
                &[FrictionParameter::Coulomb, FrictionParameter::Breakaway],
                unit,
            ),
            panel(&[FrictionParameter::Viscous], &format!("{unit} per mm/s")),
            panel(&[FrictionParameter::Offset], unit),
        ],
        ..LineChart::default()
    }
}

/// Returns the values of a parameter, and the bars of their errors.
fn series(report: &TrendReport, parameter: FrictionParameter, day: f64) -> [Series; 2] {
    let levels = report
        .dates
        .iter()
        .map(|it| (it.day - day, it.levels.get(parameter)));
    let bar = |(day, level): (f64, frictcomp_recordings::identify::Level)| {
        [
            [day, level.value - level.error],
            [day, level.value + level.error],
            [f64::NAN, f64::NAN],
        ]
    };
    let named = |points: Vec<[f64; 2]>, drawn: Drawn| Series {
        name: parameter.as_str().to_owned(),
        points,
        drawn,
    };
    [
        named(
            levels
                .clone()
                .map(|(day, level)| [day, level.value])
                .collect(),
            Drawn::Marked,
        ),
        named(levels.flat_map(bar).collect(), Drawn::Held),
    ]
}
