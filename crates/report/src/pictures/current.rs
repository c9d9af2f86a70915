//! The additive current over time.

use crate::svg::{
    Band, BandRow, BandState, ChartAxis, Curve, Drawn, LineChart, Panel, PanelHeight, Series,
    StartUpRelation, XMark,
};
use crate::wording::rounded;
use frictcomp::comp::State;
use frictcomp::lists::AxisType;
use frictcomp_physics::current::Added;

use super::units::velocity_unit;

/// Number of states over time that are kept apart.
const MAX_BANDS: usize = 20_000;

/// Number of named blocks: there is no room for more.
const MAX_BLOCKS: usize = 2000;

/// The traces of several axes in the making, in memory that does not grow with their length.
#[derive(Debug, Default)]
pub struct CurrentPlot {
    axes: Vec<AxisPlot>,
    cycles: u64,
    length: f64,
    /// Beginnings of blocks.
    blocks: Vec<XMark>,
    /// Number of blocks of which one is kept.
    every: u64,
    /// Number of blocks begun.
    begun: u64,
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

/// An axis in a CNC cycle.
#[derive(Debug, Clone, Copy)]
pub struct AxisSample<'a> {
    /// The commanded velocity in µm/s or 0.001°/s.
    pub velocity: f64,
    /// The state of friction compensation.
    pub state: State,
    /// Additive current.
    pub added: &'a Added,
}

impl AxisPlot {
    /// Returns an axis before its first cycle. A recorded trace has neither name nor type.
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

    /// Takes a CNC cycle at a time in s. In the state `unknown` the current is not known and is not
    /// drawn.
    fn push(&mut self, time: f64, sample: &AxisSample<'_>) {
        let AxisSample {
            velocity,
            state,
            added,
        } = *sample;
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
                    last.relation = StartUpRelation::StartUp;
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
                    relation: StartUpRelation::of(state, State::Active),
                    title: format!("{name} {} from {time} s", state.as_str()),
                    href: None,
                });
            }
        }
    }

    fn panels(&self, several: bool) -> [Panel; 4] {
        let panel = |label: &str, (curve, drawn): (&Curve, Drawn), height| {
            let label = if several {
                format!("axis {}: {label}", self.name)
            } else {
                label.to_owned()
            };
            let y = ChartAxis::linear(&label);
            Panel {
                y: match drawn {
                    Drawn::Notches => y.from_zero(),
                    _ => y,
                },
                series: vec![Series {
                    name: label,
                    points: curve.points(),
                    drawn,
                }],
                height,
                ..Panel::default()
            }
        };
        let (full, low) = (PanelHeight::Full, PanelHeight::Low);
        [
            panel(
                "additive current in drive units",
                (&self.current, Drawn::Steps),
                full,
            ),
            panel(
                &format!("velocity in {}", self.unit),
                (&self.velocity, Drawn::Line),
                full,
            ),
            panel(
                "weight before a reversal, 1 where it has no effect",
                (&self.before, Drawn::Notches),
                low,
            ),
            panel(
                "weight after a reversal, 1 where it has no effect",
                (&self.after, Drawn::Notches),
                low,
            ),
        ]
    }
}

impl CurrentPlot {
    /// Returns a plot of axes.
    pub fn new(axes: Vec<AxisPlot>) -> Self {
        Self {
            axes,
            every: 1,
            ..Self::default()
        }
    }

    /// Marks the beginning of a block at a time: its number, or the line without one.
    pub fn block(&mut self, time: f64, number: Option<i64>, line: u32) {
        if self.begun.is_multiple_of(self.every) {
            let name = match number {
                Some(number) => format!("N{number}"),
                None => format!("line {line}"),
            };
            self.blocks.push(XMark { at: time, name });
        }
        self.begun += 1;
        if self.blocks.len() > MAX_BLOCKS {
            let mut keep = false;
            self.blocks.retain(|_| {
                keep = !keep;
                keep
            });
            self.every *= 2;
        }
    }

    /// Takes a CNC cycle: its time in s, and for each axis the commanded velocity in µm/s or 0.001°/s,
    /// the state of friction compensation and the additive current.
    pub fn push<'a>(&mut self, time: f64, samples: impl IntoIterator<Item = AxisSample<'a>>) {
        self.cycles += 1;
        self.length = time;
        for (axis, sample) in self.axes.iter_mut().zip(samples) {
            axis.push(time, &sample);
        }
    }

    /// Interrupts the curves where the trace restarts.
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

    /// Returns the title of the chart and of its page.
    pub(crate) fn title(&self) -> String {
        match &self.axes[..] {
            [one] if one.name.is_empty() => "Additive current".to_owned(),
            [one] => format!("Additive current of axis {}", one.name),
            axes => {
                let all: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
                format!("Additive current of axes {}", all.join(", "))
            }
        }
    }

    /// Returns the chart: for each axis the current, below it velocity and weights; above all the states of
    /// compensation.
    pub fn chart(&self) -> LineChart {
        let several = self.axes.len() > 1;
        let told: Vec<String> = (self.axes.iter())
            .map(|axis| {
                let name = &axis.name;
                let space = if name.is_empty() { "" } else { " " };
                format!(
                    "the largest current{space}{name} is {} drive units",
                    rounded(axis.largest)
                )
            })
            .collect();
        LineChart {
            title: self.title(),
            description: format!(
                "{} CNC cycles in {} s; {}. Below each current the commanded velocity and the \
                 weights before and after a reversal, above all whether compensation is active; \
                 along the time the numbers of the blocks.",
                self.cycles,
                self.length,
                told.join("; ")
            ),
            x: ChartAxis::linear(if self.blocks.is_empty() {
                "time in s"
            } else {
                "time in s, and where blocks begin"
            }),
            bands: (self.axes.iter())
                .map(|axis| BandRow {
                    label: axis.name.clone(),
                    bands: axis.bands.clone(),
                })
                .collect(),
            panels: (self.axes.iter())
                .flat_map(|axis| axis.panels(several))
                .collect(),
            marks: self.blocks.clone(),
            ..LineChart::default()
        }
    }
}
