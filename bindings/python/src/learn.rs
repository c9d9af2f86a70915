//! `frictcomp.learn`: from recorded circles with a list to the next list.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use frictcomp::comp::CncBuild;
use frictcomp_host::commission::{FirstLists, Learning};
use frictcomp_host::{FileRegistry, OutputFiles, Watch};
use frictcomp_physics::circle::PlaneAxis;
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::FrictionModel;
use frictcomp_recordings::trace::{ChannelSelection, Unit};
use frictcomp_report::results::learn::render_json;
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::identify::given_units;
use crate::json::JsonText;
use crate::outputs::place;
use crate::per_axis::PerAxis;
use crate::words::{meant, meant_if_given, seconds};
use crate::work::{Stop, interruptible};

/// Learns value lists from recorded circles, round by round: the document of ``frictcomp commission learn --format json``.
///
/// The folder holds ``round-1``, ``round-2`` and so on, each with the lists ``X.lis`` and ``Y.lis`` and the circles that were
/// recorded with them. The recordings judge the lists; ``plant`` gives only the direction of the next step. ``friction``
/// begins the first round with the measured friction, ``value_list`` with other lists of at most 1.3 times as much. Each call
/// judges what is recorded, and writes the lists of the next round and ``learning.json`` to the folder; no other list there is
/// replaced. ``position`` names the channel of the actual positions, with ``%`` for the axis. ``write_list`` is where the best
/// list of each axis is written, ``{"X": "comp_x.lis"}``.
#[pyfunction]
#[pyo3(signature = (folder, *, plant, friction=None, value_list=None, model=None, cycle_time_ms=None, reading=None, time=None, position=None, units=None, cnc_build=None, write_list=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn learn(
    py: Python<'_>,
    folder: PathBuf,
    plant: String,
    friction: Option<PerAxis<PathBuf>>,
    value_list: Option<PerAxis<PathBuf>>,
    model: Option<&str>,
    cycle_time_ms: Option<f64>,
    reading: Option<&str>,
    time: Option<String>,
    position: Option<PerAxis<String>>,
    units: Option<HashMap<String, String>>,
    cnc_build: Option<&str>,
    write_list: Option<PerAxis<PathBuf>>,
) -> PyResult<JsonText> {
    let job = LearnJob {
        folder,
        plant,
        friction,
        value_list,
        model: meant("model", model)?,
        cycle_s: seconds(py, cycle_time_ms)?,
        reading: meant("reading", reading)?,
        time,
        position,
        units: given_units(units)?,
        build: meant_if_given("cnc_build", cnc_build)?,
        write_list,
    };
    interruptible(py, move |stop| job.done(stop))
}

/// A step of learning, independent of Python.
struct LearnJob {
    folder: PathBuf,
    plant: String,
    friction: Option<PerAxis<PathBuf>>,
    value_list: Option<PerAxis<PathBuf>>,
    model: FrictionModel,
    cycle_s: Option<f64>,
    reading: Reading,
    time: Option<String>,
    position: Option<PerAxis<String>>,
    units: Vec<(String, Unit)>,
    build: Option<CncBuild>,
    write_list: Option<PerAxis<PathBuf>>,
}

impl LearnJob {
    fn done(self, stop: &Stop) -> Result<JsonText, Failure> {
        let registry = FileRegistry::default();
        let learning = Learning {
            folder: &self.folder,
            first: self.first()?,
            plant: &self.plant,
            model: self.model,
            reading: self.reading,
            channels: self.channels()?,
            cycle_s: self.cycle_s,
            build: self.build,
            registry: &registry,
        };
        let best = match &self.write_list {
            Some(lists) => lists.of_plane("write_list")?,
            None => [None, None],
        };
        let mut outputs = OutputFiles::new(&registry);
        let watch = Watch::by(Arc::new(stop.clone()));
        let report = learning.step(
            best.map(|it| it.map(PathBuf::as_path)),
            &mut outputs,
            &watch,
        )?;
        place(outputs, stop)?;
        Ok(JsonText(render_json(&report)))
    }

    /// The lists with which learning begins.
    fn first(&self) -> Result<Option<FirstLists<'_>>, Failure> {
        let Some(friction) = &self.friction else {
            return match &self.value_list {
                None => Ok(None),
                Some(_) => Err(Failure::new("`value_list` is given without `friction`").with_help(
                    "give the measured friction to begin, or leave `value_list` out to continue",
                )),
            };
        };
        let lists = self.value_list.as_ref();
        Ok(Some(FirstLists {
            friction: both(friction, "friction")?,
            lists: lists.map(|it| both(it, "value_list")).transpose()?,
        }))
    }

    /// The channels of both axes.
    fn channels(&self) -> Result<[ChannelSelection; 2], Failure> {
        let [x, y] = match &self.position {
            Some(positions) => positions.of_plane("position")?,
            None => [None, None],
        };
        let of = |axis: PlaneAxis, position: Option<&String>| ChannelSelection {
            axis: Some(axis.as_str().to_owned()),
            time: self.time.clone(),
            position: position.cloned(),
            units: self.units.clone(),
            ..ChannelSelection::default()
        };
        Ok([of(PlaneAxis::X, x), of(PlaneAxis::Y, y)])
    }
}

fn both<'a>(lists: &'a PerAxis<PathBuf>, argument: &str) -> Result<[&'a Path; 2], Failure> {
    Ok(lists.required_of_plane(argument)?.map(PathBuf::as_path))
}
