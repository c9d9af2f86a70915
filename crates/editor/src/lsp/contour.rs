//! `frictcomp/contour`: the path of a program with its deviation. The picture follows the cursor, and a
//! place in it leads to its block (R12.17, R12.18).

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use gen_lsp_types::{LspRequestMethod, MessageDirection, Request, TextDocumentIdentifier, Uri};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::analysis::options;
use super::documents::{Documents, OpenDocument};
use super::refusal::Refusal;
use super::settings::ContourSettings;
use super::view::RequestView;
use super::worker::Cancel;
use frictcomp::diagnostic::UnknownName;
use frictcomp_host::{
    ContourSetup, FileRegistry, Input, LoadedMachine, MachineOptions, Machines, Naming,
    NoDrivenContour, Progress, Watch, Watcher, drive_contour, find_plant,
};
use frictcomp_physics::contour::{ContourOptions, ContourReport, NoContour};
use frictcomp_physics::motion::{PlannerOptions, check_cycle};
use frictcomp_physics::simulation::{FrictionModel, Preset};
use frictcomp_report::Detail;
use frictcomp_report::pictures::{ContourPicture, FollowedContour};
use frictcomp_report::results::contour::{ContourRecorder, ContourSubject, document};
use frictcomp_report::svg::Frame;

/// Cycles of the control that are driven as the user types: half an hour of cycles of 1 ms.
const MOST_CYCLES: u64 = 2_000_000;

/// The contour of an open program.
pub(super) enum ContourRequest {}

impl Request for ContourRequest {
    type Params = ContourParams;
    type Result = Contour;
    const METHOD: LspRequestMethod<'static> = LspRequestMethod::Custom("frictcomp/contour");
    const MESSAGE_DIRECTION: MessageDirection = MessageDirection::ClientToServer;
}

/// The program that `frictcomp/contour` asks about.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ContourParams {
    /// The program that is asked about.
    pub(super) text_document: TextDocumentIdentifier,
}

/// A contour as a picture, and the blocks of its parts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Contour {
    /// The picture; none where nothing was driven.
    svg: Option<String>,
    /// The programs whose blocks are driven.
    files: Vec<Uri>,
    /// The path block by block, in the order of driving.
    stretches: Vec<BlockPath>,
    /// The worst reversals, the worst first.
    worst: Vec<Worst>,
    /// The verdict, then the figures in sentences and tables.
    report: Value,
    /// Remarks on the basis of the contour, and on what it lacks.
    remarks: Vec<String>,
}

/// The part of the path that a block drives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct BlockPath {
    /// The number of its file, from 0.
    file: usize,
    /// Line, from 0.
    line: u32,
    /// A line through points of the picture, in its units.
    points: Vec<[f64; 2]>,
    /// Machine time at its end in s.
    #[serde(rename = "end")]
    end_s: f64,
}

/// A reversal with its description.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Worst {
    /// The number of the file, from 0.
    file: usize,
    /// The line of its block, from 0.
    line: u32,
    /// The axis, its feed, its state and its glitch.
    words: String,
}

/// A client that may cancel its request.
#[derive(Debug)]
struct Asker(Cancel);

impl Watcher for Asker {
    fn is_due(&self) -> bool {
        false
    }

    fn show(&self, _: &Progress) {}

    fn is_stopped(&self) -> bool {
        self.0.is_set()
    }
}

/// Drives an open program with its text in the editor.
pub(super) fn contour(view: &RequestView, params: &ContourParams) -> Result<Contour, Refusal> {
    let uri = &params.text_document.uri;
    let open = view
        .document(uri)
        .ok_or_else(|| Refusal::Params(format!("`{}` is not open", uri.0)))?;
    let disk = view.documents.disk();
    let input = Input::Open(open.open_text());
    let unheard = FileRegistry::default();
    let mut machines = Machines::new(MachineOptions::default(), &unheard).on_disk(&disk);
    let mut loaded = machines.for_folder(input.folder())?.as_ref().clone();
    loaded.watch = Arc::new(Watch::by(Arc::new(Asker(view.cancel.clone()))));
    let settings = &view.client.settings.contour;
    let setup = setup(view, &loaded)?;
    let (driven, mut recorder) = drive_contour(&input, &loaded, &setup, recorder)?;
    let subject = ContourSubject {
        program: name(open),
        plant: settings.plant.clone(),
    };
    let remarks = remarks(&driven, &loaded, settings);
    let heading = subject.heading(&driven);
    let picture = recorder.take_picture().filter(|_| driven.has_moved());
    let report = json!(document(&driven, &recorder, &subject).shown(Detail::Full));
    let shown = picture.map(|picture| picture.followed(&heading));
    Ok(Contour::of(view, shown, (report, remarks)))
}

fn name(document: &OpenDocument) -> String {
    let name = document.path.file_name();
    name.unwrap_or_default().to_string_lossy().into_owned()
}

fn setup(view: &RequestView, loaded: &LoadedMachine) -> Result<ContourSetup, Refusal> {
    let settings = &view.client.settings;
    let ContourSettings {
        plant,
        plane,
        start,
    } = &settings.contour;
    for axis in start.keys() {
        if loaded.machine.find(axis).is_none() {
            let known = loaded.machine.axes.iter().map(|axis| axis.name.as_str());
            let help = UnknownName::new(axis, known).help("its axes are");
            return Err(Refusal::Failed(format!(
                "the machine has no axis `{axis}`, for which `frictcomp.contour.start` gives a position{}",
                help.map_or_else(String::new, |help| format!(": {help}"))
            )));
        }
    }
    let usual = PlannerOptions::default();
    let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
    let cycle_s = check_cycle(of_machine.unwrap_or(usual.cycle_s))
        .map_err(|error| Refusal::Failed(error.to_string()))?;
    let session = options(loaded, settings.max_blocks);
    Ok(ContourSetup {
        plane: plane.clone(),
        plant: find_plant(&placed(view, plant), &FileRegistry::default())?,
        value_lists: Vec::new(),
        model: FrictionModel::default(),
        planner: usual.with_cycle_s(cycle_s).with_max_cycles(MOST_CYCLES),
        session: session.with_start(start.clone().into_iter().collect()),
        naming: Naming::AsGiven,
    })
}

/// Returns a preset as it is, a file relative to the folder of the project.
fn placed(view: &RequestView, plant: &str) -> String {
    if plant.parse::<Preset>().is_ok() {
        return plant.to_owned();
    }
    let file = view.documents.folder().join(Path::new(plant));
    file.to_string_lossy().into_owned()
}

fn recorder(options: &ContourOptions) -> ContourRecorder<'static> {
    let names: Vec<String> = options.axes.iter().map(|axis| axis.name.clone()).collect();
    let plane = [names[0].clone(), names[1].clone()];
    ContourRecorder::new(names).drawing(ContourPicture::new(plane))
}

/// Returns what the contour is based on, and what it lacks.
fn remarks(
    driven: &ContourReport,
    loaded: &LoadedMachine,
    settings: &ContourSettings,
) -> Vec<String> {
    let mut remarks = Vec::new();
    if loaded.origin.is_none() {
        remarks.push(
            "no machine is described: limits of the axes are assumed, and the friction curves are those of the plant; describe it in a `frictcomp.toml` next to the program"
                .to_owned(),
        );
    }
    if settings.plant.parse::<Preset>().is_ok() {
        remarks.push(format!(
            "the drives are those of the preset `{}`, not of your machine: `frictcomp.contour.plant` names a file with yours",
            settings.plant
        ));
    }
    if !driven.has_moved() {
        remarks.push(
            "no motion was driven: program absolute positions and F first, or give the axis positions in `frictcomp.contour.start`"
                .to_owned(),
        );
    }
    let said = driven.diagnostics();
    remarks.extend(said.map(|said| format!("{} {}", said.code, said.message)));
    remarks
}

impl Contour {
    fn of(
        view: &RequestView,
        shown: Option<FollowedContour>,
        (report, remarks): (Value, Vec<String>),
    ) -> Self {
        let mut contour = Self {
            svg: None,
            files: Vec::new(),
            stretches: Vec::new(),
            worst: Vec::new(),
            report,
            remarks,
        };
        let Some(shown) = shown else {
            return contour;
        };
        let mut numbers: BTreeMap<Arc<str>, usize> = BTreeMap::new();
        let files = &mut contour.files;
        let mut number = |file: Arc<str>| {
            *numbers.entry(file).or_insert_with_key(|file| {
                files.push(view.documents.uri(&Documents::path(file)));
                files.len() - 1
            })
        };
        let stretches = shown.stretches.into_iter().map(|it| BlockPath {
            file: number(it.file),
            line: it.line.saturating_sub(1),
            points: it.points.into_iter().map(|it| it.map(tenths)).collect(),
            end_s: it.end_s,
        });
        contour.stretches = stretches.collect();
        let worst = shown.worst.into_iter().map(|it| Worst {
            file: number(it.file),
            line: it.line.saturating_sub(1),
            words: it.words,
        });
        contour.worst = worst.collect();
        contour.svg = Some(shown.chart.render(Frame::Alone));
        contour
    }
}

fn tenths(units: f64) -> f64 {
    (units * 10.0).round() / 10.0
}

impl From<NoDrivenContour> for Refusal {
    fn from(error: NoDrivenContour) -> Self {
        match error {
            NoDrivenContour::Host(error) => error.into(),
            NoDrivenContour::Axes(NoContour::NoAxis(unknown)) => {
                let help = unknown.help("its axes are").unwrap_or_default();
                let said = NoContour::NoAxis(unknown).to_string();
                Self::Failed(format!(
                    "{said}: name two linear axes in `frictcomp.contour.plane`; {help}"
                ))
            }
            error => Self::Failed(error.to_string()),
        }
    }
}
