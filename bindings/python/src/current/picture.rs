//! The picture of currents, drawn from their arrays.

use frictcomp_physics::current::Added;
use frictcomp_physics::motion::Cause;
use frictcomp_report::pictures::{AxisPlot, AxisSample, CurrentPlot};
use frictcomp_report::svg::Frame;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::states::STATES;

/// Cycles at which something begins.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Marks {
    /// Cycles at which the trace begins again.
    begins: Vec<usize>,
    /// Cycles at which a block begins, with its number and its line.
    blocks: Vec<(usize, Option<i64>, u32)>,
    /// The last block: program and executed block.
    #[serde(skip)]
    last: Option<(u32, u64)>,
}

impl Marks {
    /// The trace begins again with a cycle.
    pub(super) fn begin(&mut self, cycle: usize) {
        self.begins.push(cycle);
    }

    /// A cycle belongs to a block.
    pub(super) fn block(&mut self, cycle: usize, cause: &Cause) {
        let block = (cause.program, cause.seq);
        if self.last.replace(block) != Some(block) {
            self.blocks.push((cycle, cause.number, cause.line));
        }
    }
}

/// The columns of an axis that are drawn.
pub(super) struct DrawnColumns<'py> {
    /// Times.
    pub(super) t: PyReadonlyArray1<'py, f64>,
    /// Velocity, both weights and the current.
    pub(super) floats: [PyReadonlyArray1<'py, f64>; 4],
    /// Positions in `STATES`.
    pub(super) states: PyReadonlyArray1<'py, i8>,
}

impl DrawnColumns<'_> {
    /// Velocity, state and current of a cycle.
    fn sample(&self, cycle: usize) -> Option<(f64, u8, Added)> {
        let mut values = [0.0; 4];
        for (value, column) in values.iter_mut().zip(&self.floats) {
            *value = *column.get(cycle)?;
        }
        let [velocity, w_before, w_after, current_units] = values;
        let added = Added {
            w_before,
            w_after,
            current_units,
            // It is not drawn.
            output: 0,
        };
        let state = u8::try_from(*self.states.get(cycle)?).ok()?;
        Some((velocity, state, added))
    }
}

/// The picture of axes over time.
pub(super) fn drawn(axes: Vec<(AxisPlot, DrawnColumns<'_>)>, marks: &Marks) -> PyResult<String> {
    let (plots, columns): (Vec<AxisPlot>, Vec<DrawnColumns<'_>>) = axes.into_iter().unzip();
    let mut plot = CurrentPlot::new(plots);
    let times = match columns.first() {
        Some(first) => first.t.as_slice()?.to_vec(),
        None => Vec::new(),
    };
    let mut begins = marks.begins.iter().peekable();
    let mut blocks = marks.blocks.iter().peekable();
    for (cycle, time) in times.into_iter().enumerate() {
        while begins.next_if(|begin| **begin <= cycle).is_some() {
            plot.interrupt();
        }
        while let Some((_, number, line)) = blocks.next_if(|(begin, ..)| *begin <= cycle) {
            plot.block(time, *number, *line);
        }
        let samples = columns.iter().filter_map(|it| it.sample(cycle));
        let samples: Vec<(f64, u8, Added)> = samples.collect();
        plot.push(
            time,
            samples.iter().map(|(velocity, state, added)| AxisSample {
                velocity: *velocity,
                state: STATES[usize::from(*state)],
                added,
            }),
        );
    }
    Ok(plot.chart().render(Frame::Alone))
}
