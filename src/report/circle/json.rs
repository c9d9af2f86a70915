//! The circular test for machines.

use serde::Serialize;

use super::super::strings::to_pretty;
use super::subject::{CircleReport, ListOrigin, NamedSide, Subject, TREATMENT, round};
use crate::circle::{Crossing, Diagnosis, Glitch, PathFigures};

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    #[serde(flatten)]
    conditions: Conditions<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    off: Option<SideRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<SideRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recorded: Option<SideRecord>,
}

#[derive(Serialize)]
struct Conditions<'a> {
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
    value_list: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reading: Option<String>,
    centre: &'static str,
    data: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    saturated_cycles: Option<u64>,
}

#[derive(Serialize)]
struct SideRecord {
    #[serde(skip_serializing_if = "Option::is_none")]
    ccw: Option<PathRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cw: Option<PathRecord>,
    #[serde(rename = "G_b")]
    g_b: Option<f64>,
    #[serde(rename = "H")]
    h: Option<f64>,
    #[serde(rename = "D")]
    d: Option<f64>,
    glitch_max: f64,
    advice: Vec<Diagnosis>,
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
    glitch: ByCrossing<f64>,
    shape: ByCrossing<Shape>,
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
struct Shape {
    outward: f64,
    inward: f64,
    step: f64,
}

impl<T> ByCrossing<T> {
    fn of(glitches: &[Glitch], value: impl Fn(&Glitch) -> T) -> Self {
        let at = |crossing: Crossing| {
            let glitch = glitches.iter().find(|glitch| glitch.crossing == crossing);
            value(glitch.expect("a path has a glitch for every crossing"))
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
        Self {
            g_mz: round(figures.g_mz_um),
            g_lsc: round(figures.g_lsc_um),
            f_max: figures.f_max_um.map(round),
            f_min: figures.f_min_um.map(round),
            d: figures.d_um.map(round),
            glitch: ByCrossing::of(&figures.glitch, |glitch| round(glitch.height_um)),
            shape: ByCrossing::of(&figures.glitch, |glitch| Shape {
                outward: round(glitch.outward_um),
                inward: round(glitch.inward_um),
                step: round(glitch.step_um),
            }),
        }
    }
}

impl SideRecord {
    fn of(side: &NamedSide) -> Self {
        let figures = &side.side.figures;
        let rounded = |advice: &Diagnosis| Diagnosis {
            size_um: round(advice.size_um),
            ..*advice
        };
        Self {
            ccw: figures.ccw.as_ref().map(PathRecord::of),
            cw: figures.cw.as_ref().map(PathRecord::of),
            g_b: figures.g_b_um.map(round),
            h: figures.h_um.map(round),
            d: figures.d_um.map(round),
            glitch_max: round(figures.glitch_max_um()),
            advice: side.advice.iter().map(rounded).collect(),
        }
    }
}

/// The report for machines, all lengths in µm unless the key says otherwise.
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
        } => Conditions {
            source: "simulated",
            diameter_mm: Some(2.0 * test.circle.radius_mm),
            feed_mm_min: Some(test.circle.feed_mm_per_min),
            cycle_time_s: Some(test.circle.cycle_time_s),
            plant: Some(&test.plant.name),
            model: Some(test.model.as_str()),
            value_list: Some(match origin {
                ListOrigin::Plant => "plant",
                ListOrigin::File(name) => name,
            }),
            reading: Some(test.reading.to_string()),
            centre: "commanded",
            data: TREATMENT,
            saturated_cycles: Some(*saturated_cycles),
        },
        Subject::Recorded(recording) => Conditions {
            source: "recorded",
            diameter_mm: recording.radius_mm.map(|radius| 2.0 * radius),
            feed_mm_min: None,
            cycle_time_s: None,
            plant: None,
            model: None,
            value_list: None,
            reading: None,
            centre: "least-squares",
            data: TREATMENT,
            saturated_cycles: None,
        },
    };
    let document = Document {
        schema: 1,
        conditions,
        off: side("off"),
        on: side("on"),
        recorded: side("recorded"),
    };
    let mut text = to_pretty(&document);
    text.push('\n');
    text
}
