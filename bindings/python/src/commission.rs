//! `frictcomp.commission` and `frictcomp.trend`: the recordings of a commissioning, and those of an axis over the years.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::comp::CncBuild;
use frictcomp_host::commission::{
    CommissionChannels, CommissionReader, Commissioning, DatedRecordings, motors_of, read_plans,
};
use frictcomp_host::{FileRegistry, OutputFiles, Watch, recordings_in};
use frictcomp_physics::circle::Shaping;
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::results::{commission, trend};
use pyo3::prelude::*;

use crate::identify::{given_units, switched};
use crate::json::JsonText;
use crate::outputs::place;
use crate::words::{meant_if_given, seconds};
use crate::work::interruptible;

/// Evaluates the recordings of a commissioning: the document of ``frictcomp commission run --format json``.
///
/// Reads the plans in the folder and the recordings in its folder ``recordings``, writes a provisional list of each axis to
/// its folder ``lists``, and what it found to ``results.json``. In the name of a channel ``%`` stands for that of each axis;
/// ``roles`` are the numbers of the programs of recordings without a signature. With ``plant`` drives are fitted, and lists
/// tuned on them, without ``shaping`` as the friction curve is.
#[pyfunction]
#[pyo3(name = "commission", signature = (folder, *, time=None, position=None, velocity=None, torque=None, actual_position=None, following_error=None, units=None, cycle_time_ms=None, torque_kind=None, roles=None, plant=None, shaping=true, cnc_build=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn evaluate_commissioning(
    py: Python<'_>,
    folder: PathBuf,
    time: Option<String>,
    position: Option<String>,
    velocity: Option<String>,
    torque: Option<String>,
    actual_position: Option<String>,
    following_error: Option<String>,
    units: Option<HashMap<String, String>>,
    cycle_time_ms: Option<f64>,
    torque_kind: Option<&str>,
    roles: Option<HashMap<String, u16>>,
    plant: Option<String>,
    shaping: bool,
    cnc_build: Option<&str>,
) -> PyResult<JsonText> {
    let cycle_s = seconds(py, cycle_time_ms)?;
    let units = given_units(units)?;
    let torque_kind = meant_if_given("torque_kind", torque_kind)?;
    let build: Option<CncBuild> = meant_if_given("cnc_build", cnc_build)?;
    interruptible(py, move |stop| {
        let registry = FileRegistry::default();
        let planned = read_plans(&folder, &registry)?;
        let recordings = recordings_in(&folder.join("recordings"))?;
        let of_axis = |axis: &str| {
            let selection = ChannelSelection {
                axis: Some(axis.to_owned()),
                time: time.clone(),
                position: position.clone(),
                velocity: velocity.clone(),
                torque: torque.clone(),
                actual_position: actual_position.clone(),
                following_error: following_error.clone(),
                units: units.clone(),
                is_for_several: true,
                ..ChannelSelection::default()
            };
            (axis.to_owned(), selection)
        };
        let channels = CommissionChannels {
            axes: motors_of(&planned).into_iter().map(of_axis).collect(),
            has_each_torque: torque.as_ref().is_some_and(|it| it.contains('%')),
            cycle_s,
            torque_kind,
            roles: roles.unwrap_or_default().into_iter().collect(),
        };
        let commissioning = Commissioning {
            folder: &folder,
            plans: &planned,
            recordings: &recordings,
            reader: CommissionReader {
                channels: &channels,
                words: ToString::to_string,
            },
            plant: plant.as_deref(),
            shaping: if shaping {
                Shaping::Allowed
            } else {
                Shaping::None
            },
            build,
            before: &[],
            said: Vec::new(),
            registry: &registry,
        };
        let mut outputs = OutputFiles::new(&registry);
        let watch = Watch::by(Arc::new(stop.clone()));
        let report = commissioning.evaluate(&mut outputs, &watch)?;
        place(outputs, stop)?;
        Ok(JsonText(commission::render_results_json(&report)))
    })
}

/// Follows the friction of an axis over the dates of its recordings: the document of ``frictcomp commission trend --format
/// json``.
///
/// Takes every recording of constant speeds in a folder whose name holds a date, ``x-2026-03-01.csv``; the channels are named
/// as for ``identify``.
#[pyfunction]
#[pyo3(name = "trend", signature = (folder, *, axis=None, time=None, position=None, velocity=None, torque=None, units=None, cycle_time_ms=None, torque_kind=None, compensation=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn friction_trend(
    py: Python<'_>,
    folder: PathBuf,
    axis: Option<String>,
    time: Option<String>,
    position: Option<String>,
    velocity: Option<String>,
    torque: Option<String>,
    units: Option<HashMap<String, String>>,
    cycle_time_ms: Option<f64>,
    torque_kind: Option<&str>,
    compensation: Option<&str>,
) -> PyResult<JsonText> {
    let cycle_s = seconds(py, cycle_time_ms)?;
    let channels = ChannelSelection {
        axis: axis.clone(),
        time,
        position,
        velocity,
        torque,
        units: given_units(units)?,
        ..ChannelSelection::default()
    };
    let torque_kind = meant_if_given("torque_kind", torque_kind)?;
    let compensation = compensation.map(switched).transpose()?;
    interruptible(py, move |_| {
        let dated = DatedRecordings {
            folder: &folder,
            recordings: &recordings_in(&folder)?,
            axis,
            channels,
            cycle_s,
            torque_kind,
            compensation,
        };
        Ok(JsonText(trend::render_json(&dated.trend()?)))
    })
}
