//! The additive current over time.

use crate::comp::State;
use crate::current::Added;
use crate::lists::AxisType;
use crate::report::svg::{
    Band, BandRow, BandState, ChartAxis, Curve, Drawn, LineChart, Panel, Series, Standing,
};

use super::units::velocity_unit;

/// More states over time are not kept apart.
const MAX_BANDS: usize = 20_000;

/// The traces of several axes while they come in, in memory that does not grow with their length.
#[derive(Debug, Default)]
pub struct CurrentPlot {
    axes: Vec<AxisPlot>,
    cycles: u64,
    length: f64,
}

/// The trace of one axis.
#[derive(Debug)]
pub struct AxisPlot {
    name: String,
    unit: &'static str,
    current: Curve,
    velocity: Curve,
    before: Curve,
    after: Curve,
    bands: Vec<Band>,
    largest: f64,
}

impl AxisPlot {
    /// An axis before its first cycle. A recorded trace has neither name nor type.
    pub fn new(name: &str, axis_type: Option<AxisType>) -> Self {
        Self {
            name: name.to_owned(),
            unit: axis_type.map_or("\u{b5}m/s or 0.001\u{b0}/s", velocity_unit),
            current: Curve::default(),
            velocity: Curve::default(),
            before: Curve::default(),
            after: Curve::default(),
            bands: Vec::new(),
            largest: 0.0,
        }
    }

    /// Takes a CNC cycle: seconds, commanded velocity in µm/s or 0.001°/s, state, and what is
    /// added. In the state `unknown` the current is not known, and it is not drawn.
    fn push(&mut self, time: f64, velocity: f64, (state, added): (State, &Added)) {
        self.velocity.push([time, velocity]);
        if state == State::Unknown {
            self.current.interrupt();
        } else {
            self.largest = self.largest.max(added.current_units.abs());
            self.current.push([time, added.current_units]);
        }
        self.before.push([time, added.w_before]);
        self.after.push([time, added.w_after]);
        self.extend_bands(time, state);
    }

    fn extend_bands(&mut self, time: f64, state: State) {
        let full = self.bands.len() >= MAX_BANDS;
        match self.bands.last_mut() {
            Some(last) if last.state == BandState::One(state) || full => {
                if last.state != BandState::One(state) {
                    last.state = BandState::Changing;
                    last.standing = Standing::Home;
                }
                last.to = time;
            }
            last => {
                let name = &self.name;
                if let Some(last) = last {
                    last.to = time;
                }
                self.bands.push(Band {
                    from: time,
                    to: time,
                    state: BandState::One(state),
                    // Friction compensation that can be switched is on after a start.
                    standing: Standing::of(state, State::Active),
                    title: format!("{name} {} from {time} s", state.as_str()),
                    href: None,
                });
            }
        }
    }

    fn panels(&self, of_axis: &str) -> [Panel; 3] {
        let curve = |name: &str, curve: &Curve| Series {
            name: format!("{name}{of_axis}"),
            points: curve.points(),
            drawn: Drawn::Line,
        };
        let panel = |label: &str, series| Panel {
            y: ChartAxis::linear(match of_axis {
                "" => label.to_owned(),
                _ => format!("axis {}: {label}", self.name),
            }),
            series,
        };
        [
            panel(
                "additive current in drive units",
                vec![curve("current", &self.current)],
            ),
            panel(
                &format!("velocity in {}", self.unit),
                vec![curve("velocity", &self.velocity)],
            ),
            panel(
                "weights",
                vec![
                    curve("weight before a reversal", &self.before),
                    curve("weight after a reversal", &self.after),
                ],
            ),
        ]
    }
}

impl CurrentPlot {
    /// A plot of axes.
    pub fn new(axes: Vec<AxisPlot>) -> Self {
        Self {
            axes,
            ..Self::default()
        }
    }

    /// Takes a CNC cycle: its time in s, and for each axis the commanded velocity in µm/s or
    /// 0.001°/s, the state of friction compensation and what is added.
    pub fn push<'a>(
        &mut self,
        time: f64,
        samples: impl IntoIterator<Item = (f64, State, &'a Added)>,
    ) {
        self.cycles += 1;
        self.length = time;
        for (axis, (velocity, state, added)) in self.axes.iter_mut().zip(samples) {
            axis.push(time, velocity, (state, added));
        }
    }

    /// Interrupts the curves where the trace begins anew.
    pub fn interrupt(&mut self) {
        for axis in &mut self.axes {
            for curve in [
                &mut axis.current,
                &mut axis.velocity,
                &mut axis.before,
                &mut axis.after,
            ] {
                curve.interrupt();
            }
        }
    }

    /// The chart: for each axis the current, below it velocity and weights; above all the states
    /// of compensation.
    pub fn chart(&self) -> LineChart {
        let several = self.axes.len() > 1;
        let named = |axis: &AxisPlot| match axis.name.as_str() {
            name if several => format!(" of {name}"),
            _ => String::new(),
        };
        let told: Vec<String> = (self.axes.iter())
            .map(|axis| {
                let name = &axis.name;
                let space = if name.is_empty() { "" } else { " " };
                format!(
                    "the largest current{space}{name} is {} drive units",
                    axis.largest
                )
            })
            .collect();
        LineChart {
            title: match &self.axes[..] {
                [one] if one.name.is_empty() => "Additive current".to_owned(),
                [one] => format!("Additive current of axis {}", one.name),
                axes => {
                    let all: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
                    format!("Additive current of axes {}", all.join(", "))
                }
            },
            description: format!(
                "{} CNC cycles in {} s; {}. Below each current the commanded velocity and the \
                 weights before and after a reversal, above all whether compensation is active.",
                self.cycles,
                self.length,
                told.join("; ")
            ),
            x: ChartAxis::linear("time in s"),
            bands: (self.axes.iter())
                .map(|axis| BandRow {
                    label: axis.name.clone(),
                    bands: axis.bands.clone(),
                })
                .collect(),
            panels: (self.axes.iter())
                .flat_map(|axis| axis.panels(&named(axis)))
                .collect(),
        }
    }
}
