//! Pictures: well-formed, bounded, told in words, and the same bytes for the same input.

#![cfg(feature = "cli")]

use std::f64::consts::TAU;

use frictcomp::compensation::State;
use frictcomp::current::{AdditiveCurrent, Reading};
use frictcomp::lists::{AxisType, FrictionList, TablePoint};
use frictcomp::report::pictures::{CurrentTrace, ValueCurve, current_over_time, value_curve};
use frictcomp::report::svg::{
    Axis, Band, BandChart, BandRow, BandState, Drawn, Frame, LineChart, Panel, PolarChart,
    PolarSeries, Series,
};

fn list() -> FrictionList {
    let points = [
        (0.0, 126.0),
        (1800.0, 112.0),
        (4000.0, 96.0),
        (16667.0, 104.0),
        (50000.0, 131.0),
    ];
    FrictionList {
        position_delay: 100,
        reversal_lookahead: 20,
        scaling_factor: 900,
        delay_cycles: 2,
        max_points: 20,
        table: points
            .into_iter()
            .map(|(input, output)| TablePoint { input, output })
            .collect(),
    }
}

fn band(from: f64, to: f64, state: BandState) -> Band {
    Band {
        from,
        to,
        state,
        title: format!("from {from} to {to}: {}", state.word()),
        href: Some("#line-1".to_owned()),
    }
}

fn value_list() -> LineChart {
    value_curve(&ValueCurve {
        axis: "X",
        axis_type: AxisType::Linear,
        list: &list(),
    })
}

fn current() -> LineChart {
    let times: Vec<f64> = (0..4000_u32)
        .map(|cycle| f64::from(cycle) * 0.001)
        .collect();
    let velocities: Vec<f64> = times
        .iter()
        .map(|time| 16000.0 * (time * 4.0).sin())
        .collect();
    let positions: Vec<f64> = times
        .iter()
        .map(|time| -40000.0 * (time * 4.0).cos())
        .collect();
    let cycles = AdditiveCurrent::new(&list(), Reading::default()).trace(&positions, &velocities);
    let states = [BandRow {
        label: "X".to_owned(),
        bands: vec![
            band(0.0, 1.4, BandState::One(State::Active)),
            band(1.4, 2.1, BandState::One(State::Inactive)),
            band(2.1, 4.0, BandState::One(State::Unknown)),
        ],
    }];
    current_over_time(&CurrentTrace {
        axis: "X",
        times: &times,
        velocities: &velocities,
        cycles: &cycles,
        states: &states,
    })
}

fn circle() -> PolarChart {
    let turn = |offset: f64, peak: f64| -> Vec<[f64; 2]> {
        (0..=20_000_u32)
            .map(|step| {
                let angle = TAU * f64::from(step) / 20_000.0;
                let near = (angle % (TAU / 4.0)) / 0.1;
                [angle, offset + peak * near * (1.0 - near).exp()]
            })
            .collect()
    };
    PolarChart {
        title: "Circular test, X and Y, R 100 mm, 2000 mm/min, counter-clockwise".to_owned(),
        description: "Without compensation 19 µm at a reversal, with compensation 0.8 µm."
            .to_owned(),
        axes: ["X".to_owned(), "Y".to_owned()],
        radius: 100.0,
        series: vec![
            PolarSeries {
                name: "compensation off".to_owned(),
                points: turn(-0.6, 19.2),
            },
            PolarSeries {
                name: "compensation on".to_owned(),
                points: turn(-0.6, 0.8),
            },
        ],
    }
}

fn glitches() -> LineChart {
    let series = |name: &str, values: [f64; 4]| Series {
        name: name.to_owned(),
        points: [500.0, 1000.0, 2000.0, 5000.0]
            .into_iter()
            .zip(values)
            .map(|(feed, value)| [feed, value])
            .collect(),
        drawn: Drawn::Marked,
    };
    LineChart {
        title: "Glitch at reversals before and after tuning".to_owned(),
        description: "Four feeds.".to_owned(),
        x: Axis::logarithmic("feed in mm/min"),
        bands: Vec::new(),
        panels: vec![Panel {
            y: Axis::linear("glitch in µm, peak to peak"),
            series: vec![
                series("without compensation", [10.6, 14.8, 19.2, 23.3]),
                series("tuned", [1.4, 1.2, 0.8, 1.0]),
                series("tuned, friction −20 %", [3.1, 3.4, 3.9, 4.4]),
                series("tuned, friction +20 %", [3.3, 3.6, 4.2, 4.9]),
            ],
        }],
    }
}

fn states() -> BandChart {
    use State::{Active, Inactive, Ineffective, Unconfigured, Unknown};
    let row = |label: &str, states: [State; 3]| BandRow {
        label: label.to_owned(),
        bands: (0_u32..)
            .zip(states)
            .map(|(at, state)| {
                let from = f64::from(at * 40);
                band(from, from + 40.0, BandState::One(state))
            })
            .collect(),
    };
    let flicker = (0..50_000_u32).map(|at| {
        let from = f64::from(at) * 0.0024;
        let state = if at % 2 == 0 { Active } else { Inactive };
        band(from, from + 0.0024, BandState::One(state))
    });
    BandChart {
        title: "States over the blocks".to_owned(),
        description: "Four axes.".to_owned(),
        x: Axis::linear("executed blocks"),
        rows: vec![
            row("X", [Active, Inactive, Active]),
            row("Y", [Ineffective, Unknown, Inactive]),
            row("Z", [Unconfigured; 3]),
            BandRow {
                label: "X LEAD".to_owned(),
                bands: flicker.collect(),
            },
        ],
    }
}

fn all() -> Vec<(&'static str, String)> {
    vec![
        ("value-list", value_list().render(Frame::Alone)),
        ("current", current().render(Frame::Alone)),
        ("circle", circle().render(Frame::Alone)),
        ("tuning", glitches().render(Frame::Alone)),
        ("states", states().render(Frame::Alone)),
    ]
}

#[test]
fn zz_write() {
    for (name, svg) in all() {
        std::fs::write(format!("/tmp/pic/{name}.svg"), svg).unwrap();
    }
}
