//! The circular test as JSON.

use serde::Serialize;

use super::subject::{CircleReport, NamedSide, Subject, TREATMENT, TooFast};
use crate::assumptions::not_modelled;
use crate::document::Headline;
use crate::wording::to_json;
use frictcomp_physics::circle::{
    AxisShape, CircularTest, Crossing, Diagnosis, Glitch, Method, PathCentre, PathFigures,
    Recording, WorseTurn,
};
use frictcomp_physics::stiction::StictionParameters;
use frictcomp_recordings::identify::TraceFinding;

#[derive(Serialize)]
struct CircleDocument<'a> {
    schema: u32,
    headline: Headline,
    #[serde(flatten)]
    conditions: ConditionsRecord<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    off: Option<SideRecord<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<SideRecord<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recorded: Option<SideRecord<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    diagnostics: &'a [TraceFinding],
}

#[derive(Serialize)]
struct ConditionsRecord<'a> {
    source: &'static str,
    diameter_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    feed_mm_min: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cycle_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plant: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value_list: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiction: Option<ByAxis<Option<StictionParameters>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reading: Option<String>,
    centre: &'static str,
    data: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    saturated_cycles: Option<u64>,
    /// Properties of a machine that the simulation leaves out.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_modelled: Option<Vec<&'static str>>,
    /// Reason why there are no glitches.
    #[serde(skip_serializing_if = "Option::is_none")]
    glitches_up_to: Option<TooFast>,
    /// Turns of a recording that leave more than the evaluated ones.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    worse_turns: Vec<WorseTurn>,
}

#[derive(Serialize)]
struct SideRecord<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    ccw: Option<PathRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cw: Option<PathRecord>,
    centre: PathCentre,
    centre_distance: Option<f64>,
    #[serde(rename = "G_b")]
    g_b: Option<f64>,
    #[serde(rename = "H")]
    h: Option<f64>,
    #[serde(rename = "D")]
    d: Option<f64>,
    glitch_max: Option<f64>,
    advice: &'a [Diagnosis],
}

#[derive(Serialize)]
struct PathRecord {
    #[serde(rename = "G_mz")]
    g_mz: f64,
    #[serde(rename = "G_lsc")]
    g_lsc: f64,
    #[serde(rename = "F_max")]
    f_max: Option<f64>,
    #[serde(rename = "F_min")]
    f_min: Option<f64>,
    #[serde(rename = "D")]
    d: Option<f64>,
    glitch: ByCrossing<Option<f64>>,
    shape: ByCrossing<Option<Bulges>>,
    glitch_window_deg: Option<f64>,
    axes: ByAxis<Option<AxisRecord>>,
    ellipse: Option<Ellipse>,
}

/// A value for each crossing.
#[derive(Serialize)]
struct ByCrossing<T> {
    #[serde(rename = "X+")]
    x_plus: T,
    #[serde(rename = "Y+")]
    y_plus: T,
    #[serde(rename = "X-")]
    x_minus: T,
    #[serde(rename = "Y-")]
    y_minus: T,
}

#[derive(Serialize)]
struct Bulges {
    outward: f64,
    inward: f64,
}

/// A value for each axis.
#[derive(Serialize)]
struct ByAxis<T> {
    #[serde(rename = "X")]
    x: T,
    #[serde(rename = "Y")]
    y: T,
}

/// Permanent and decaying deviations after the reversals of an axis.
#[derive(Serialize)]
struct AxisRecord {
    step: f64,
    peak: f64,
    is_settled: bool,
}

/// The amplitude of the residual without steps and peaks.
#[derive(Serialize)]
struct Ellipse {
    along_axes: f64,
    at_45_deg: f64,
}

impl AxisRecord {
    fn of(shape: &AxisShape) -> Self {
        Self {
            step: shape.step_um,
            peak: shape.peak_um,
            is_settled: shape.is_settled,
        }
    }
}

impl<T> ByCrossing<Option<T>> {
    fn of(glitches: Option<&[Glitch; 4]>, value: impl Fn(&Glitch) -> T) -> Self {
        let at = |crossing: Crossing| {
            let mut glitches = glitches?.iter();
            glitches.find(|it| it.crossing == crossing).map(&value)
        };
        Self {
            x_plus: at(Crossing::XPlus),
            y_plus: at(Crossing::YPlus),
            x_minus: at(Crossing::XMinus),
            y_minus: at(Crossing::YMinus),
        }
    }
}

impl PathRecord {
    fn of(figures: &PathFigures) -> Self {
        let shape = figures.shape.as_ref();
        let glitches = shape.map(|shape| &shape.glitches);
        Self {
            g_mz: figures.g_mz_um,
            g_lsc: figures.g_lsc_um,
            f_max: figures.f_max_um,
            f_min: figures.f_min_um,
            d: figures.d_um,
            glitch: ByCrossing::of(glitches, |glitch| glitch.height_um),
            shape: ByCrossing::of(glitches, |glitch| Bulges {
                outward: glitch.outward_um,
                inward: glitch.inward_um,
            }),
            glitch_window_deg: shape.map(|shape| shape.window_deg),
            axes: ByAxis {
                x: shape.map(|shape| AxisRecord::of(&shape.axes[0])),
                y: shape.map(|shape| AxisRecord::of(&shape.axes[1])),
            },
            ellipse: shape.map(|shape| Ellipse {
                along_axes: shape.ellipse_um[0],
                at_45_deg: shape.ellipse_um[1],
            }),
        }
    }
}

impl<'a> SideRecord<'a> {
    fn of(side: &'a NamedSide) -> Self {
        let figures = &side.side.figures;
        Self {
            ccw: figures.ccw.as_ref().map(PathRecord::of),
            cw: figures.cw.as_ref().map(PathRecord::of),
            centre: figures.centre,
            centre_distance: figures.centre_distance_um,
            g_b: figures.g_b_um,
            h: figures.h_um,
            d: figures.d_um,
            glitch_max: figures.glitch_max_um(),
            advice: &side.advice,
        }
    }
}

/// Returns the stiction compensation of both axes.
fn stiction(test: &CircularTest) -> ByAxis<Option<StictionParameters>> {
    let of = |axis: &Option<Method>| axis.as_ref()?.stiction().copied();
    let [x, y] = &test.compensation;
    ByAxis { x: of(x), y: of(y) }
}

/// Returns the report as JSON, all lengths in µm unless the key says otherwise.
pub fn render_json(report: &CircleReport) -> String {
    let side = |name: &str| {
        let side = report.sides.iter().find(|side| side.name == name);
        side.map(SideRecord::of)
    };
    let conditions = match &report.subject {
        Subject::Simulated {
            test,
            origin,
            saturated_cycles,
        } => ConditionsRecord {
            source: "simulated",
            diameter_mm: Some(2.0 * test.circle.radius_mm),
            feed_mm_min: Some(test.circle.feed_mm_per_min),
            cycle_time_s: Some(test.circle.cycle_time_s),
            plant: Some(&test.plant.name),
            model: Some(test.model.as_str()),
            value_list: (!test.is_stiction()).then(|| origin.name()),
            stiction: test.is_stiction().then(|| stiction(test)),
            reading: Some(test.reading.to_string()),
            centre: "commanded",
            data: TREATMENT,
            saturated_cycles: Some(*saturated_cycles),
            not_modelled: Some(not_modelled([&test.plant.x, &test.plant.y])),
            glitches_up_to: report.too_fast(),
            worse_turns: Vec::new(),
        },
        Subject::Recorded(recording) => ConditionsRecord {
            source: "recorded",
            diameter_mm: recording.commanded.radius_mm.map(|radius| 2.0 * radius),
            feed_mm_min: report.driven().1,
            cycle_time_s: None,
            plant: None,
            model: None,
            value_list: None,
            stiction: None,
            reading: None,
            centre: "least-squares",
            data: TREATMENT,
            saturated_cycles: None,
            not_modelled: None,
            glitches_up_to: report.too_fast(),
            worse_turns: worse_turns(recording),
        },
    };
    let document = CircleDocument {
        schema: 1,
        headline: report.headline(),
        conditions,
        off: side("off"),
        on: side("on"),
        recorded: side("recorded"),
        diagnostics: &report.findings,
    };
    to_json(&document)
}

fn worse_turns(recording: &Recording) -> Vec<WorseTurn> {
    let circles = recording.circles.iter();
    circles
        .filter_map(|circle| circle.whole_turns()?.worse)
        .collect()
}
