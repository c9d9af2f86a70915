//! Charts that the tests draw.

use std::f64::consts::TAU;

use crate::pictures::{AxisPlot, AxisSample, CurrentPlot, tuning, value_curve};
use crate::results::tune::TuneReport;
use crate::svg::{
    Band, BandChart, BandRow, BandState, ChartAxis, LineChart, PolarChart, PolarPanel, PolarSeries,
    PolarStroke, StartUpRelation,
};
use frictcomp::comp::State;
use frictcomp::lists::{AxisType, FrictionList, TablePoint};
use frictcomp::machine::AcceptedList;
use frictcomp_physics::circle::{FeedResult, Tuned, TunedAxis};
use frictcomp_physics::current::{AdditiveCurrent, Reading};

pub(super) fn list() -> FrictionList {
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
    let relation = match state {
        BandState::One(state) => StartUpRelation::of(state, State::Active),
        BandState::Changing => StartUpRelation::StartUp,
    };
    Band {
        relation,
        from,
        to,
        state,
        title: format!("from {from} to {to}: {}", state.as_str()),
        href: Some("#line-1".to_owned()),
    }
}

pub(super) fn value_list() -> LineChart {
    value_curve(&AcceptedList {
        axis: "X".to_owned(),
        axis_type: AxisType::Linear,
        list: list(),
    })
}

pub(super) fn current() -> LineChart {
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
    let mut plot = CurrentPlot::new(vec![AxisPlot::new("X", Some(AxisType::Linear))]);
    for ((&time, &velocity), cycle) in times.iter().zip(&velocities).zip(&cycles) {
        let state = match time {
            1.4..2.1 => State::Inactive,
            3.0.. => State::Unknown,
            _ => State::Active,
        };
        if time == 0.0 {
            plot.block(time, Some(10), 1);
        } else if (time - 2.0).abs() < 1e-9 {
            plot.block(time, None, 3);
        }
        let sample = AxisSample {
            velocity,
            state,
            added: cycle,
        };
        plot.push(time, [sample]);
    }
    plot.chart()
}

pub(super) fn circle() -> PolarChart {
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
        panels: [("compensation off", 19.2), ("compensation on", 0.8)]
            .map(|(label, peak)| PolarPanel {
                label: label.to_owned(),
                series: vec![PolarSeries {
                    look: 0,
                    stroke: PolarStroke::Full,
                    name: "counter-clockwise".to_owned(),
                    points: turn(-0.6, peak),
                }],
            })
            .to_vec(),
    }
}

pub(super) fn glitches() -> LineChart {
    let feeds = [
        [500.0, 10.6, 1.4, 3.1, 3.3],
        [1000.0, 14.8, 1.2, 3.4, 3.6],
        [2000.0, 19.2, 0.8, 3.9, 4.2],
        [5000.0, 23.3, 1.0, 4.4, 4.9],
    ];
    let feeds = feeds.map(|[feed, off, on, minus20, plus20]| FeedResult {
        feed_mm_per_min: feed,
        radius_mm: 100.0,
        acceleration_mm_per_s2: (feed / 60.0).powi(2) / 100.0,
        glitch_off_um: off,
        glitch_on_um: on,
        glitch_friction_minus20_um: minus20,
        glitch_friction_plus20_um: plus20,
    });
    let axis = TunedAxis {
        compensation: Some(list().into()),
        is_shaped: false,
    };
    tuning(&[TuneReport {
        plant: "stiff".to_owned(),
        model: "lugre",
        reading: Reading::default().to_string(),
        not_modelled: Vec::new(),
        tuned: Tuned {
            axes: [axis.clone(), axis],
            feeds: feeds.to_vec(),
            check: Vec::new(),
            robust: None,
            trials: 1,
        },
    }])
}

pub(super) fn states() -> BandChart {
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
        description: "Four rows of states.".to_owned(),
        x: ChartAxis::linear("executed blocks"),
        steps: None,
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
