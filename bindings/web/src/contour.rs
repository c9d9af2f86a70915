//! The contour of a program driven by simulated axes (chapter 11 of the rules).

use std::sync::Arc;

use frictcomp::diagnostic::UnknownName;
use frictcomp::interpreter::Options;
use frictcomp_host::{ContourSetup, LoadedMachine, Naming, NoDrivenContour, Watch, drive_contour};
use frictcomp_physics::contour::{ContourOptions, ContourReport, NoContour};
use frictcomp_physics::motion::{PlannerOptions, check_cycle};
use frictcomp_physics::simulation::FrictionModel;
use frictcomp_report::Detail;
use frictcomp_report::html::render_contour;
use frictcomp_report::pictures::ContourPicture;
use frictcomp_report::results::contour::{ContourRecorder, ContourSubject, document};
use frictcomp_report::svg::Frame;
use serde::{Deserialize, Serialize};

use crate::circle::preset;
use crate::drawn_report::DrawnReport;
use crate::dropped::Dropped;
use crate::refusal::Refusal;
use crate::run::{RunSettings, Texts, json};
use crate::watched::Page;
use crate::wording::page;

/// Limit on the cycles; more would take minutes.
const MOST_CYCLES: u64 = 20_000_000;

/// Settings of a contour.
#[derive(Debug, Deserialize)]
pub(crate) struct ContourSettings {
    program: String,
    /// The axis positions at the start, in mm or degrees.
    #[serde(default)]
    start: Vec<(String, f64)>,
    /// The drives: `stiff`, `mid`, `soft`.
    plant: String,
    #[serde(default)]
    settings: RunSettings,
}

#[derive(Serialize)]
struct ContourAnswer<'a> {
    #[serde(flatten)]
    drawn: DrawnReport<'a>,
    /// Causes that stopped the program or the trace, and simplifications of the trace.
    notes: Vec<String>,
}

/// A contour that was driven, and its names.
type Driven = (ContourReport, ContourRecorder<'static>, ContourSubject);

fn drive(dropped: &mut Dropped, settings: &ContourSettings) -> Result<Driven, Refusal> {
    let input = dropped.program(&settings.program)?;
    let machine = dropped.machine(&input, &settings.settings.enable)?;
    let mut loaded = machine.as_ref().clone();
    expect_axes(&loaded, &settings.start)?;
    loaded.watch = Arc::new(Watch::by(Arc::new(Page)));
    let setup = setup(&loaded, settings)?;
    let (contour, recorder) = drive_contour(&input, &loaded, &setup, recorder)?;
    let subject = ContourSubject {
        program: input.name(Naming::AsGiven),
        plant: settings.plant.clone(),
    };
    Ok((contour, recorder, subject))
}

/// Refuses a start of an axis that the machine does not have.
pub(crate) fn expect_axes(loaded: &LoadedMachine, start: &[(String, f64)]) -> Result<(), Refusal> {
    let mut strange = start.iter();
    let strange = strange.find(|(name, _)| loaded.machine.find(name).is_none());
    let Some((name, _)) = strange else {
        return Ok(());
    };
    let known = loaded.machine.axes.iter().map(|axis| axis.name.as_str());
    let unknown = UnknownName::new(name, known);
    let message = format!("the machine has no axis `{name}`, of which a start is given");
    Err(Refusal::unknown(message, &unknown))
}

fn setup(loaded: &LoadedMachine, settings: &ContourSettings) -> Result<ContourSetup, Refusal> {
    let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
    let usual = PlannerOptions::default();
    let cycle_s = check_cycle(of_machine.unwrap_or(usual.cycle_s))
        .map_err(|error| Refusal::new(error.to_string()))?;
    Ok(ContourSetup {
        plane: ["X", "Y"].map(str::to_owned),
        plant: preset(&settings.plant)?.plant(),
        value_lists: Vec::new(),
        model: FrictionModel::default(),
        planner: usual.with_cycle_s(cycle_s).with_max_cycles(MOST_CYCLES),
        session: loaded
            .session(Options::default())
            .with_start(settings.start.clone())
            .with_wording(Some(page)),
        naming: Naming::AsGiven,
    })
}

/// Keeps everything, and draws.
fn recorder(options: &ContourOptions) -> ContourRecorder<'static> {
    let names: Vec<String> = options.axes.iter().map(|axis| axis.name.clone()).collect();
    let plane = [names[0].clone(), names[1].clone()];
    let recorder = ContourRecorder::new(names).keeping_all();
    recorder.drawing(ContourPicture::new(plane))
}

/// Returns the picture and the figures.
pub(crate) fn answer(
    dropped: &mut Dropped,
    settings: &ContourSettings,
) -> Result<Vec<u8>, Refusal> {
    let (contour, mut recorder, subject) = drive(dropped, settings)?;
    let picture = recorder.take_picture().filter(|_| contour.has_moved());
    let chart = picture.map(|picture| picture.chart(&subject.heading(&contour)));
    let document = document(&contour, &recorder, &subject);
    let svg = chart.map(|chart| chart.render(Frame::Alone));
    Ok(json(&ContourAnswer {
        drawn: DrawnReport {
            svg,
            report: document.shown(Detail::Brief),
        },
        notes: notes(&contour),
    }))
}

fn notes(contour: &ContourReport) -> Vec<String> {
    let mut notes: Vec<String> = contour
        .diagnostics()
        .map(|said| format!("{} {}", said.code, said.message))
        .collect();
    if !contour.has_moved() {
        notes.push(
            "no motion was driven: program absolute positions and F first, or say above where the \
             axes start"
                .to_owned(),
        );
    }
    notes
}

/// Returns the report as a page, the same as that of `frictcomp contour --html`.
pub(crate) fn report(
    dropped: &mut Dropped,
    settings: &ContourSettings,
) -> Result<Vec<u8>, Refusal> {
    let (contour, mut recorder, subject) = drive(dropped, settings)?;
    let picture = recorder.take_picture();
    let picture = picture.ok_or_else(|| Refusal::new("nothing was driven"))?;
    let mut written = Vec::new();
    let mut sources = Texts(dropped.disk());
    render_contour(
        (&contour, &recorder),
        &subject,
        &picture,
        (&mut sources, &mut written),
    )
    .map_err(|error| Refusal::new(error.to_string()))?;
    Ok(written)
}

impl From<NoDrivenContour> for Refusal {
    fn from(error: NoDrivenContour) -> Self {
        match error {
            NoDrivenContour::Host(error) => error.into(),
            NoDrivenContour::Axes(NoContour::NoAxis(unknown)) => {
                let message = NoContour::NoAxis(unknown.clone()).to_string();
                Self::unknown(message, &unknown)
            }
            error => Self::new(error.to_string()),
        }
    }
}
