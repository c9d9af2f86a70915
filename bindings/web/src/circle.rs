//! The simulated circular test with the value lists of the machine.

use std::str::FromStr;

use frictcomp::machine::{Machine, Parameterisation};
use frictcomp_host::{Watch, compare};
use frictcomp_physics::circle::{Circle, CircularTest, Method};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::{FrictionModel, Preset};
use frictcomp_report::html::render_document;
use frictcomp_report::results::circle::{CircleReport, ListOrigin, document};
use serde::{Deserialize, Serialize};

use crate::drawn_report::DrawnReport;
use crate::dropped::Dropped;
use crate::refusal::Refusal;
use crate::run::json;

/// Settings of a circular test.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct CircleSettings {
    /// A program on the machine whose value lists are used.
    program: Option<String>,
    radius_mm: f64,
    feed_mm_per_min: f64,
    /// The drives: `stiff`, `mid`, `soft`.
    plant: String,
}

#[derive(Serialize)]
struct CircleAnswer<'a> {
    #[serde(flatten)]
    drawn: DrawnReport<'a>,
    /// Origin of the value lists.
    lists: String,
}

/// Returns the drives of a name: `stiff`, `mid`, `soft`.
pub(crate) fn preset(name: &str) -> Result<Preset, Refusal> {
    name.parse()
        .map_err(|error: <Preset as FromStr>::Err| Refusal::new(error.to_string()))
}

fn simulate(
    dropped: &mut Dropped,
    settings: &CircleSettings,
) -> Result<(CircleReport, String), Refusal> {
    let plant = preset(&settings.plant)?.plant();
    let machine = match &settings.program {
        Some(program) => {
            let input = dropped.program(program)?;
            Some(dropped.machine(&input, &[])?)
        }
        None => None,
    };
    let lists = machine.and_then(|loaded| lists_of(&loaded.machine));
    let (compensation, origin, told) = match lists {
        Some((methods, names)) => {
            let told = format!("Compensation on: X {}, Y {}.", names[0], names[1]);
            (methods, ListOrigin::EachAxis(names), told)
        }
        None => (
            Method::of_plant(&plant),
            ListOrigin::Plant,
            "The machine has no accepted value list for X or Y: the lists here are the friction curves of the simulated drives, not yours.".to_owned(),
        ),
    };
    let test = CircularTest {
        circle: Circle {
            radius_mm: settings.radius_mm,
            feed_mm_per_min: settings.feed_mm_per_min,
            ..Circle::default()
        },
        plant,
        model: FrictionModel::default(),
        compensation,
        reading: Reading::default(),
    };
    let comparison =
        compare(&test, &Watch::default()).map_err(|error| Refusal::new(error.to_string()))?;
    Ok((CircleReport::simulated(test, comparison, origin), told))
}

/// Returns the value lists of X and Y, if any of them was accepted.
fn lists_of(machine: &Machine) -> Option<([Option<Method>; 2], [String; 2])> {
    let list = |name: &str| {
        let axis = machine.axes.iter().find(|axis| axis.name == name)?;
        match &axis.friction {
            Parameterisation::Accepted(list) => Some(Method::from(list.clone())),
            _ => None,
        }
    };
    let lists = ["X", "Y"].map(list);
    let names = lists.each_ref().map(|list| match list {
        Some(_) => "list of the machine".to_owned(),
        None => "none".to_owned(),
    });
    lists.iter().any(Option::is_some).then_some((lists, names))
}

/// Returns the picture and the figures.
pub(crate) fn answer(dropped: &mut Dropped, settings: &CircleSettings) -> Result<Vec<u8>, Refusal> {
    let (report, lists) = simulate(dropped, settings)?;
    Ok(json(&CircleAnswer {
        drawn: DrawnReport::from(&document(&report)),
        lists,
    }))
}

/// Returns the report as a page.
pub(crate) fn report(dropped: &mut Dropped, settings: &CircleSettings) -> Result<Vec<u8>, Refusal> {
    let (report, _) = simulate(dropped, settings)?;
    let mut written = Vec::new();
    render_document(&document(&report), &mut written)
        .map_err(|error| Refusal::new(error.to_string()))?;
    Ok(written)
}
