//! `frictcomp.identify`: from recorded torque to a value list.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use frictcomp::lists::FrictionList;
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, read_axis, refuse_copies, sole_axis};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyOptions, ListRequest, ListRequestError, TorqueKind, identify as find,
    identify_circles,
};
use frictcomp_recordings::trace::{ChannelSelection, Unit};
use frictcomp_recordings::value_lists::{IdentifiedFrom, render_identified};
use frictcomp_report::pictures::friction_curve;
use frictcomp_report::results::identify::on_circles::{self, OnCirclesReport};
use frictcomp_report::results::identify::{IdentifyReport, render_json};
use frictcomp_report::svg::Frame;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::exceptions::refused;
use crate::failure::Failure;
use crate::json;
use crate::notebook;
use crate::pickled::{self, Reduced};
use crate::several::OneOrSeveral;
use crate::words::{meant_if_given, seconds};
use crate::work::interruptible;

/// The friction of an axis, and the value list that is made from it.
#[pyclass(frozen, name = "Identified", module = "frictcomp")]
#[derive(Serialize, Deserialize)]
pub(crate) struct PyIdentified {
    record: String,
    /// The curve; there is none, and no picture, if friction was found on circles.
    svg: Option<String>,
    list: FrictionList,
    axis: Option<String>,
    from: String,
    unit: String,
    faults: Vec<String>,
}

/// The recordings of an axis.
struct AxisRecordings {
    recordings: Vec<PathBuf>,
    selection: ChannelSelection,
    cycle_s: Option<f64>,
    /// The caller's statements about the torque.
    torque_kind: Option<TorqueKind>,
    compensation: Option<Switched>,
}

pub(crate) fn switched(word: &str) -> PyResult<Switched> {
    match word {
        "on" => Ok(Switched::On),
        "off" => Ok(Switched::Off),
        _ => Err(refused(format!("`{word}` is not one of on, off"))),
    }
}

/// Finds the friction of an axis in a recording, and the points of a value list.
///
/// ``torque_kind`` says which torque was recorded and ``compensation`` whether friction compensation
/// was on meanwhile; without them, the channels decide, if they show it.
///
/// ``time``, ``position``, ``velocity`` and ``torque`` name channels, ``units`` their units if
/// the file does not. With ``circles`` the recordings are circles at two or more feeds.
/// ``points`` bounds the points of the list, ``max_error`` its error in per cent of the friction.
#[pyfunction]
#[pyo3(signature = (recordings, *, axis=None, time=None, position=None, velocity=None, torque=None, units=None, cycle_time_ms=None, circles=false, points=None, max_error=None, feed_mm_per_min=1000.0, torque_kind=None, compensation=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn identify(
    py: Python<'_>,
    recordings: OneOrSeveral<PathBuf>,
    axis: Option<String>,
    time: Option<String>,
    position: Option<String>,
    velocity: Option<String>,
    torque: Option<String>,
    units: Option<HashMap<String, String>>,
    cycle_time_ms: Option<f64>,
    circles: bool,
    points: Option<usize>,
    max_error: Option<f64>,
    feed_mm_per_min: f64,
    torque_kind: Option<&str>,
    compensation: Option<&str>,
) -> PyResult<PyIdentified> {
    let options = options(ListRequest {
        points,
        max_error_percent: max_error,
        feed_mm_per_min,
    })?;
    let selection = ChannelSelection {
        axis,
        time,
        position,
        velocity,
        torque,
        units: given_units(units)?,
        ..ChannelSelection::default()
    };
    let mut recorded = AxisRecordings {
        recordings: recordings.0,
        selection,
        cycle_s: seconds(py, cycle_time_ms)?,
        torque_kind: meant_if_given("torque_kind", torque_kind)?,
        compensation: compensation.map(switched).transpose()?,
    };
    interruptible(py, move |_| {
        if let Some(first) = recorded.recordings.first() {
            find_axis(&mut recorded.selection, first)?;
        }
        if circles {
            recorded.on_circles()
        } else {
            recorded.at_speeds(&options)
        }
    })
}

/// Takes the only axis by whose name the channels of a recording are recognised, if none is given.
pub(crate) fn find_axis(selection: &mut ChannelSelection, recording: &Path) -> Result<(), Failure> {
    if selection.axis.is_none() {
        selection.axis = sole_axis(recording, &Disk::default())?;
    }
    Ok(())
}

/// The units of channels by their names.
pub(crate) fn given_units(units: Option<HashMap<String, String>>) -> PyResult<Vec<(String, Unit)>> {
    let units = units.unwrap_or_default().into_iter();
    let known = units.map(|(channel, unit)| match Unit::parse(&unit) {
        Some(known) => Ok((channel, known)),
        None => Err(refused(format!(
            "`{unit}` is not a known unit; known are {}",
            Unit::NAMED
        ))),
    });
    known.collect()
}

impl AxisRecordings {
    fn read(&self, path: &Path) -> Result<AxisRecording, Failure> {
        let recording = read_axis(path, &self.selection, self.cycle_s, &Disk::default())?;
        Ok(recording.stated(self.torque_kind, self.compensation))
    }

    /// Constant speeds in one recording.
    fn at_speeds(self, options: &IdentifyOptions) -> Result<PyIdentified, Failure> {
        let [path] = self.recordings.as_slice() else {
            let count = self.recordings.len();
            return Err(
                Failure::new(format!("{count} recordings were given")).with_help(
                    "give one recording of constant speeds, or `circles=True` for circles",
                ),
            );
        };
        let recording = self.read(path)?;
        let options = IdentifyOptions {
            measured: recording.measured,
            ..*options
        };
        let report = IdentifyReport {
            name: shown_path(path),
            axis: self.selection.axis.clone(),
            identified: find(&recording.track, &options).map_err(Failure::of_identification)?,
            recording,
        };
        Ok(PyIdentified {
            record: render_json(std::slice::from_ref(&report)),
            svg: Some(friction_curve(&report).render(Frame::Alone)),
            list: report.identified.list(),
            unit: report.unit().to_owned(),
            faults: report.faults(),
            axis: report.axis,
            from: report.name,
        })
    }

    /// Circles at several feeds.
    fn on_circles(self) -> Result<PyIdentified, Failure> {
        refuse_copies(&self.recordings)?;
        let recordings = self.recordings.iter().map(|path| self.read(path));
        let recordings: Vec<_> = recordings.collect::<Result<_, _>>()?;
        let names = self.recordings.iter().map(|path| shown_path(path));
        let report = OnCirclesReport {
            names: names.collect(),
            axis: self.selection.axis.clone(),
            found: identify_circles(&recordings).map_err(Failure::of_identification)?,
            recordings,
        };
        Ok(PyIdentified {
            record: on_circles::render_json(&report),
            svg: None,
            list: report.found.list(),
            unit: report.unit().to_owned(),
            faults: report.faults(),
            from: report.names.join(", "),
            axis: report.axis,
        })
    }
}

/// Returns the options for a requested list.
fn options(request: ListRequest) -> PyResult<IdentifyOptions> {
    request.options().map_err(|error| match error {
        ListRequestError::MaxError(_) => refused(format!(
            "{error}; give per cent of the friction, for example 1"
        )),
        _ => refused(error.to_string()),
    })
}

#[pymethods]
impl PyIdentified {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    /// The document of ``frictcomp identify --format json``.
    #[getter]
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::parsed(py, &self.record)
    }

    /// The value list as a file of the control.
    #[pyo3(signature = (*, cnc_build=None))]
    fn value_list(&self, cnc_build: Option<&str>) -> PyResult<String> {
        let made = IdentifiedFrom {
            axis: self.axis.as_deref(),
            from: &self.from,
            unit: &self.unit,
            faults: &self.faults,
        };
        Ok(render_identified(
            &self.list,
            made,
            meant_if_given("cnc_build", cnc_build)?,
        ))
    }

    /// The picture of the friction curve, as ``frictcomp identify --svg`` draws it.
    ///
    /// ``Error`` if friction was found on circles, for which there is no picture.
    fn svg(&self, py: Python<'_>) -> PyResult<&str> {
        let svg = self.svg.as_deref();
        svg.ok_or_else(|| Failure::new("there is no picture of friction on circles").into_error(py))
    }

    /// Its picture, if it has one, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        notebook::pictured(py, &notebook::verdict(&self.record), self.svg.as_slice())
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.Identified from {}>", self.from)
    }
}
