//! `frictcomp.replay`: what a machine did, compared with the dry run of its programs.

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::interpreter::Options;
use frictcomp::text::shown_path;
use frictcomp_host::MachineOptions;
use frictcomp_host::replay::{Replay, ReplayChannels, read_states};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::results::replay::{ReplayReport, render_json};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::identify::given_units;
use crate::json::JsonText;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_options, watched_machine_of};
use crate::program::GivenPrograms;
use crate::start::{Places, positions};
use crate::work::{Stop, interruptible};

/// Compares what a machine did with the dry run of its programs: the document of ``frictcomp replay --format json``.
///
/// The recording says for each axis whether friction compensation is active; ``active`` and ``position`` name its channels of
/// axes, ``{"X": "FrictX"}``, if they are not recognised. The programs are those that ran meanwhile, in their order.
/// ``tolerance_um`` is how much positions may differ where no blocks were recorded, in µm or 0.001°.
#[pyfunction]
#[pyo3(signature = (recording, programs, *, machine=None, time=None, active=None, position=None, line=None, block=None, program=None, units=None, tolerance_um=None, start=None, limits=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn replay(
    recording: PathBuf,
    programs: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    time: Option<String>,
    active: Option<BTreeMap<String, String>>,
    position: Option<BTreeMap<String, String>>,
    line: Option<String>,
    block: Option<String>,
    program: Option<String>,
    units: Option<HashMap<String, String>>,
    tolerance_um: Option<f64>,
    start: Option<Places>,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<JsonText> {
    let job = ReplayJob {
        recording,
        programs: GivenPrograms::in_order(programs)?,
        machine: machine_options(machine)?,
        channels: ReplayChannels {
            selection: ChannelSelection {
                time,
                units: given_units(units)?,
                ..ChannelSelection::default()
            },
            active: active.unwrap_or_default().into_iter().collect(),
            positions: position.unwrap_or_default().into_iter().collect(),
            line,
            block,
            program,
        },
        tolerance: tolerance_um.map_or(Replay::TOLERANCE, |it| it / 1000.0),
        start: start.map_or_else(Vec::new, |Places(places)| places),
        run: limits::options(limits),
    };
    interruptible(programs.py(), move |stop| job.done(stop))
}

/// Input of a comparison with a recording, independent of Python.
struct ReplayJob {
    recording: PathBuf,
    programs: GivenPrograms,
    machine: MachineOptions,
    channels: ReplayChannels,
    tolerance: f64,
    start: Vec<(String, f64)>,
    run: Options,
}

impl ReplayJob {
    fn done(self, stop: &Stop) -> Result<JsonText, Failure> {
        self.programs.probe()?;
        if !(self.tolerance.is_finite() && self.tolerance >= 0.0) {
            return Err(Failure::new("`tolerance_um` is 0 or more")
                .with_help("give how much positions may differ, in µm"));
        }
        let loaded = watched_machine_of(self.machine, &self.programs, Arc::new(stop.clone()))?;
        let recording = read_states(&self.recording, &self.channels, &loaded.machine)?;
        let start = positions(&self.start, &loaded)?;
        let replay = Replay {
            inputs: &self.programs.inputs,
            loaded: &loaded,
            options: loaded.session(self.run).with_start(start),
            tolerance: self.tolerance,
        };
        Ok(JsonText(render_json(&ReplayReport {
            name: shown_path(&self.recording),
            recording: &recording,
            replayed: &replay.compare(&recording)?,
        })))
    }
}
