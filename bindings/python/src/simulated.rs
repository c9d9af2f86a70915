//! `frictcomp.circle` and `frictcomp.tune`: circular tests, and the parameters that suit them.

use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::comp::CncBuild;
use frictcomp::lists::{FrictionList, ListHead, Points};
use frictcomp::text::shown_path;
use frictcomp_host::{
    Disk, FileRegistry, Watch, compare, find_plant, memory_for_simulation, read_circles,
    read_value_list, tune as search,
};
use frictcomp_physics::circle::TuningAim;
use frictcomp_physics::circle::{
    Circle, CircularTest, CommandedCircle, FreeParameter, Method, PathCentre, PlaneAxis, Ranges,
    Shaping, Task,
};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::FrictionModel;
use frictcomp_recordings::value_lists::render_tuned;
use frictcomp_report::pictures;
use frictcomp_report::results::circle::{CircleReport, ListOrigin, picture, render_json};
use frictcomp_report::results::tune::{TuneReport, render_json as render_tune};
use frictcomp_report::svg::Frame;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::exceptions::refused;
use crate::failure::Failure;
use crate::json;
use crate::notebook;
use crate::per_axis::PerAxis;
use crate::pickled::{self, Reduced};
use crate::several::{OneOrSeveral, Several};
use crate::words::{meant, meant_if_given, seconds};
use crate::work::{Stop, interruptible};

/// The maximum number of circles that are tuned at once.
const MAX_CIRCLES: usize = 32;

/// The first build that reads outputs with fractions (P-COMP-00047).
const FRACTIONS: CncBuild = CncBuild::new([3, 1, 3132, 0]);

/// A circular test: its figures and its picture.
#[pyclass(frozen, name = "Circle", module = "frictcomp")]
#[derive(Serialize, Deserialize)]
pub(crate) struct PyCircle {
    record: String,
    svg: String,
}

impl From<&CircleReport> for PyCircle {
    fn from(report: &CircleReport) -> Self {
        Self {
            record: render_json(report),
            svg: picture(report).render(Frame::Alone),
        }
    }
}

/// A circular test, as ``frictcomp circle`` makes it.
///
/// Two simulated axes drive the circle with compensation off and on; with ``recordings``, recorded
/// circles are judged instead, with the radius and the feed that were commanded.
#[pyfunction]
#[pyo3(signature = (*, radius_mm=None, feed_mm_per_min=None, plant="stiff", model=None, value_list=None, cycle_time_ms=None, reading=None, recordings=None, centre=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments, clippy::fn_params_excessive_bools)]
pub(crate) fn circle(
    py: Python<'_>,
    radius_mm: Option<f64>,
    feed_mm_per_min: Option<f64>,
    plant: &str,
    model: Option<&str>,
    value_list: Option<PerAxis<PathBuf>>,
    cycle_time_ms: Option<f64>,
    reading: Option<&str>,
    recordings: Option<OneOrSeveral<PathBuf>>,
    centre: Option<&str>,
) -> PyResult<PyCircle> {
    let centre: PathCentre = meant("centre", centre)?;
    if let Some(OneOrSeveral(recordings)) = recordings {
        let of_simulations = [
            ("model", model.is_some()),
            ("value_list", value_list.is_some()),
            ("cycle_time_ms", cycle_time_ms.is_some()),
            ("reading", reading.is_some()),
        ];
        if let Some((name, _)) = of_simulations.iter().find(|it| it.1) {
            let message = format!("`{name}` has no effect on recordings");
            return Err(Failure::new(message).into_error(py));
        }
        if recordings.is_empty() {
            let failure = Failure::new("no recording was given");
            let failure =
                failure.with_help("name one, or leave `recordings` out for simulated axes");
            return Err(failure.into_error(py));
        }
        let commanded = CommandedCircle {
            radius_mm,
            feed_mm_per_min,
        };
        interruptible(py, move |_| {
            let recording = read_circles(&recordings, &Default::default(), commanded, centre)?;
            Ok(PyCircle::from(&CircleReport::recorded(recording)))
        })
    } else {
        let usual = Circle::default();
        let circle = Circle {
            radius_mm: radius_mm.unwrap_or(usual.radius_mm),
            feed_mm_per_min: feed_mm_per_min.unwrap_or(usual.feed_mm_per_min),
            cycle_time_s: seconds(py, cycle_time_ms)?.unwrap_or(usual.cycle_time_s),
        };
        let (model, reading) = (meant("model", model)?, meant("reading", reading)?);
        let plant = plant.to_owned();
        interruptible(py, move |stop| {
            let simulated = Simulated {
                circle,
                plant,
                model,
                reading,
            };
            simulated.driven(value_list, centre, stop)
        })
    }
}

/// Input of a simulation.
struct Simulated {
    circle: Circle,
    plant: String,
    model: FrictionModel,
    reading: Reading,
}

impl Simulated {
    fn driven(
        self,
        lists: Option<PerAxis<PathBuf>>,
        centre: PathCentre,
        stop: &Stop,
    ) -> Result<PyCircle, Failure> {
        memory_for_simulation()?;
        let plant = find_plant(&self.plant, &FileRegistry::default())?;
        let (compensation, origin) = match lists {
            None => (Method::of_plant(&plant), ListOrigin::Plant),
            Some(lists) => {
                let (lists, origin) = read(&lists)?;
                (lists.map(|list| Some(list.into())), origin)
            }
        };
        let test = CircularTest {
            circle: self.circle,
            plant,
            model: self.model,
            compensation,
            reading: self.reading,
        };
        let watch = Watch::by(Arc::new(stop.clone()));
        let comparison = compare(&test, &watch).map_err(Failure::of_circle)?;
        let report = CircleReport::simulated(test, comparison.about(centre), origin);
        Ok(PyCircle::from(&report))
    }
}

fn read(lists: &PerAxis<PathBuf>) -> Result<([FrictionList; 2], ListOrigin), Failure> {
    let list = |path: &PathBuf| {
        Ok::<_, Failure>(read_value_list(path, &FileRegistry::default(), &Disk::default())?.list)
    };
    let name = |path: &PathBuf| shown_path(path);
    let [x, y] = lists.required_of_plane("value_list")?;
    let origin = match lists {
        PerAxis::Every(path) => ListOrigin::File(name(path)),
        PerAxis::Each(_) => ListOrigin::EachAxis([name(x), name(y)]),
    };
    Ok(([list(x)?, list(y)?], origin))
}

/// The parameters of a value list that leave the smallest glitch on a simulated machine.
#[pyclass(frozen, name = "Tuned", module = "frictcomp")]
#[derive(Serialize, Deserialize)]
pub(crate) struct PyTuned {
    plant: String,
    record: String,
    svg: String,
    /// Of X and of Y, with whole outputs and with fractions; none where stiction is compensated.
    lists: Option<[[String; 2]; 2]>,
}

impl PyTuned {
    fn of(report: TuneReport) -> Self {
        let axes = &report.tuned.axes;
        let has_lists = axes.iter().all(|axis| axis.list().is_some());
        let head = ListHead::default();
        let lists = axes.each_ref().map(|axis| {
            [None, Some(FRACTIONS)].map(|build| render_tuned(report.list_of(axis), build, &head))
        });
        let reports = std::slice::from_ref(&report);
        Self {
            record: render_tune(reports),
            svg: pictures::tuning(reports).render(Frame::Alone),
            lists: has_lists.then_some(lists),
            plant: report.plant,
        }
    }
}

/// Searches the value list with the smallest worst glitch over all feeds in mm/min and radii in mm.
///
/// With ``robust`` the list is also good if the contact is half or twice as stiff, or friction
/// differs by 10 % between the directions.
#[pyfunction]
#[pyo3(signature = (*, plant="stiff", feeds=None, radii=None, model=None, cycle_time_ms=None, reading=None, free=None, shaping=true, cnc_build=None, robust=false))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments, clippy::fn_params_excessive_bools)]
pub(crate) fn tune(
    py: Python<'_>,
    plant: &str,
    feeds: Option<Several<f64>>,
    radii: Option<Several<f64>>,
    model: Option<&str>,
    cycle_time_ms: Option<f64>,
    reading: Option<&str>,
    free: Option<Several<String>>,
    shaping: bool,
    cnc_build: Option<&str>,
    robust: bool,
) -> PyResult<PyTuned> {
    let feeds = feeds.map_or_else(|| vec![500.0, 1000.0, 2000.0, 5000.0], |Several(it)| it);
    let radii = radii.map_or_else(|| vec![100.0], |Several(it)| it);
    let cycle = seconds(py, cycle_time_ms)?.unwrap_or(Circle::default().cycle_time_s);
    let circles = radii.iter().flat_map(|&radius_mm| {
        feeds.iter().map(move |&feed_mm_per_min| Circle {
            radius_mm,
            feed_mm_per_min,
            cycle_time_s: cycle,
        })
    });
    let circles: Vec<Circle> = circles.take(MAX_CIRCLES + 1).collect();
    if circles.is_empty() || circles.len() > MAX_CIRCLES {
        return Err(refused(format!(
            "give from 1 to {MAX_CIRCLES} pairs of feed and radius"
        )));
    }
    let build: Option<CncBuild> = meant_if_given("cnc_build", cnc_build)?;
    let (model, reading): (FrictionModel, Reading) =
        (meant("model", model)?, meant("reading", reading)?);
    let ranges = ranges(free.map_or_else(Vec::new, |Several(names)| names))?;
    let plant = plant.to_owned();
    interruptible(py, move |stop| {
        memory_for_simulation()?;
        let plant = find_plant(&plant, &FileRegistry::default())?;
        let task = Task {
            plant,
            model,
            circles,
            ranges,
            reading,
            points: Points::of_build(build),
            shaping: if shaping {
                Shaping::Allowed
            } else {
                Shaping::None
            },
            aim: if robust {
                TuningAim::Robust
            } else {
                TuningAim::Plant
            },
        };
        let watch = Watch::by(Arc::new(stop.clone()));
        let tuned = search(&task, &watch).map_err(Failure::of_circle)?;
        Ok(PyTuned::of(TuneReport::new(&task, tuned)))
    })
}

/// The parameters that may leave their documented ranges.
fn ranges(free: Vec<String>) -> PyResult<Ranges> {
    free.iter().try_fold(Ranges::default(), |ranges, name| {
        Ok(ranges.free(match name.as_str() {
            "position_delay" => FreeParameter::PositionDelay,
            "reversal_lookahead" => FreeParameter::ReversalLookahead,
            "mp1511" => FreeParameter::Mp1511,
            "mp1512" => FreeParameter::Mp1512,
            _ => {
                return Err(refused(format!(
                    "`{name}` is none of position_delay, reversal_lookahead, mp1511 and mp1512"
                )));
            }
        }))
    })
}

#[pymethods]
impl PyCircle {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    /// The document of ``frictcomp circle --format json``.
    #[getter]
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::parsed(py, &self.record)
    }

    /// The picture of the circle with its magnified deviation, as ``frictcomp circle --svg`` draws it.
    fn svg(&self) -> &str {
        &self.svg
    }

    /// Its picture, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        notebook::pictured(py, &notebook::verdict(&self.record), &[&self.svg])
    }

    fn __repr__(&self) -> &'static str {
        "<frictcomp.Circle>"
    }
}

#[pymethods]
impl PyTuned {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    /// The document of ``frictcomp tune --format json``.
    #[getter]
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::parsed(py, &self.record)
    }

    /// The value list of an axis as a file of the control.
    ///
    /// Outputs are whole numbers unless ``cnc_build``, such as ``"3.1.3132.0"``, accepts fractions.
    #[pyo3(signature = (axis="X", *, cnc_build=None))]
    fn value_list(&self, py: Python<'_>, axis: &str, cnc_build: Option<&str>) -> PyResult<String> {
        let Some(lists) = &self.lists else {
            return Err(Failure::new(format!(
                "the plant `{}` compensates stiction, which has no value list",
                self.plant
            ))
            .with_help("enter MP1511 and MP1512 of the record in the control")
            .into_error(py));
        };
        let mut lists = PlaneAxis::ALL.into_iter().zip(lists);
        let found = lists.find(|(plane, _)| plane.as_str() == axis);
        let (_, [whole, fractions]) = found.ok_or_else(|| refused("the axes are `X` and `Y`"))?;
        Ok(
            match Points::of_build(meant_if_given("cnc_build", cnc_build)?) {
                Points::Real => fractions.clone(),
                _ => whole.clone(),
            },
        )
    }

    /// The picture of the glitch before and after tuning, as ``frictcomp tune --svg`` draws it.
    fn svg(&self) -> &str {
        &self.svg
    }

    /// Its picture, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        notebook::pictured(py, &notebook::verdict(&self.record), &[&self.svg])
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.Tuned for the plant '{}'>", self.plant)
    }
}
