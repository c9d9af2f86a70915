//! `frictcomp.current_of_recording`: the additive current over a recorded commanded motion.

use std::collections::HashMap;
use std::path::PathBuf;

use frictcomp::comp::State;
use frictcomp_host::{Disk, FileRegistry, read_commanded, read_value_list};
use frictcomp_physics::current::{
    AdditiveCurrent, Commanded, DeadBand, Reading, Resampling, Switched, TraceOptions,
};
use frictcomp_recordings::trace::ChannelSelection;
use pyo3::prelude::*;

use super::axis::{AxisCycles, Counted, NamedAxis, PyAxisCurrent, array};
use super::expect_numpy;
use crate::exceptions::refused;
use crate::failure::Failure;
use crate::identify::given_units;
use crate::words::{meant, seconds};
use crate::work::interruptible;

/// Input of a computation, independent of Python.
struct RecordingJob {
    recording: PathBuf,
    value_list: PathBuf,
    selection: ChannelSelection,
    options: TraceOptions,
    reading: Reading,
}

/// Its result.
struct RecordingCurrents {
    t: Vec<f64>,
    cycles: AxisCycles,
    counted: Counted,
    remarks: Vec<String>,
}

/// The additive current of one axis over a recorded commanded motion, as NumPy arrays.
///
/// The recording is an export of TwinCAT Scope, a SINUMERIK trace or a CSV file with the columns ``t`` in
/// s, ``x`` in 0.1 µm or 0.0001°, ``v`` in µm/s or 0.001°/s and, where it is recorded, ``comp``; or
/// ``time``, ``position`` and ``velocity`` name its channels, and ``units`` their units if the file
/// does not. Of a recording of several axes, ``axis`` says which one is meant. Times that are not those
/// of CNC cycles are refused unless ``resample`` is set. Velocities up to ``dead_band`` in µm/s or
/// 0.001°/s are standstill.
#[pyfunction]
#[pyo3(signature = (recording, value_list, *, time=None, position=None, velocity=None, units=None, axis=None, cycle_time_ms=None, resample=false, dead_band=None, reading=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn current_of_recording(
    py: Python<'_>,
    recording: PathBuf,
    value_list: PathBuf,
    time: Option<String>,
    position: Option<String>,
    velocity: Option<String>,
    units: Option<HashMap<String, String>>,
    axis: Option<String>,
    cycle_time_ms: Option<f64>,
    resample: bool,
    dead_band: Option<f64>,
    reading: Option<&str>,
) -> PyResult<PyAxisCurrent> {
    expect_numpy(py)?;
    let cycle = seconds(py, cycle_time_ms)?;
    let resampling = if resample {
        Resampling::Done
    } else {
        Resampling::Refused
    };
    let job = RecordingJob {
        recording,
        value_list,
        selection: ChannelSelection {
            time,
            position,
            velocity,
            units: given_units(units)?,
            axis: axis.clone(),
            ..ChannelSelection::default()
        },
        options: TraceOptions::default()
            .with_cycle_s(cycle)
            .with_resampling(resampling)
            .with_dead_band(standstill_up_to(dead_band)?),
        reading: meant("reading", reading)?,
    };
    let computed = interruptible(py, move |_| job.done())?;
    let axis = NamedAxis::new(axis.as_deref().unwrap_or_default(), None);
    let axis = (axis, computed.counted);
    let t = array(py, computed.t);
    Ok(PyAxisCurrent::new(
        axis,
        computed.cycles,
        t.bind(py),
        computed.remarks,
    ))
}

fn standstill_up_to(velocity: Option<f64>) -> PyResult<DeadBand> {
    match velocity {
        None => Ok(DeadBand::default()),
        Some(velocity) if velocity.is_finite() && velocity >= 0.0 => Ok(DeadBand::Below(velocity)),
        Some(velocity) => Err(refused(format!(
            "a dead band is a velocity from 0 on, in µm/s or 0.001°/s, not {velocity}"
        ))),
    }
}

impl RecordingJob {
    fn done(self) -> Result<RecordingCurrents, Failure> {
        let list =
            read_value_list(&self.value_list, &FileRegistry::default(), &Disk::default())?.list;
        let trace = read_commanded(&self.recording, &self.selection, self.options)?;
        let mut current = AdditiveCurrent::new(&list, self.reading);
        let (mut t, mut cycles) = (Vec::new(), AxisCycles::default());
        for (row, added) in trace.currents(&mut current) {
            t.push(row.time_s);
            let commanded = Commanded {
                position_units: row.position,
                velocity_units: row.velocity,
                friction: match row.switched {
                    Switched::On => State::Active,
                    Switched::Off => State::Inactive,
                },
            };
            cycles.push(&commanded, &added);
        }
        Ok(RecordingCurrents {
            t,
            cycles,
            counted: Counted {
                saturated: current.saturated(),
                at_rest: current.at_rest(),
            },
            remarks: trace.remarks().to_vec(),
        })
    }
}
