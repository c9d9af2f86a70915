//! `frictcomp commission run`: recordings to lists, and what is missing (R16.2, R16.9).

use std::path::{Path, PathBuf};

use clap::Args;

use super::channels::{ReadingArgs, words};
use crate::args::{ByAxis, CncBuildArgs, PerAxis};
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit, progress, shown};
use frictcomp_host::commission::{CommissionReader, Commissioning, read_plans};
use frictcomp_host::{FileRegistry, read_text, recordings_in};
use frictcomp_physics::circle::Shaping;
use frictcomp_recordings::commission::{PlanFile, ResultsReport};
use frictcomp_report::results::commission::{Acceptance, document, render_results_json};
use frictcomp_report::{TextChange, render_unified};

/// Evaluate the recordings of the measuring programs: friction, lists, circles before and after
///
/// Reads the plans in a folder and every recording in its folder `recordings`, recognised by its
/// signature. Reports what is missing and what is not used, writes a provisional list of each axis to the folder
/// `lists`, and judges the lists of stage 2 by the circles with and without them. Run it again with more
/// recordings: what is known already is kept in `results.json`.
#[derive(Debug, Args)]
pub(crate) struct CommissionRunArgs {
    /// The folder of the plan
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    #[command(flatten)]
    reading: ReadingArgs,
    /// The plant as known beforehand, `stiff`, `mid`, `soft` or a TOML file: moved mass, position loop and the
    /// force of a drive unit. Contact, Kp, friction and delay are fitted to circles off and on, and lists are
    /// tuned on the fitted plant
    #[arg(long, value_name = "PLANT")]
    plant: Option<String>,
    /// Keep the friction curve of tuned lists as it is; do not shape it below 1 mm/s
    #[arg(long, requires = "plant")]
    no_shaping: bool,
    #[command(flatten)]
    build: CncBuildArgs,
    #[command(flatten)]
    html: HtmlArgs,
    /// The name of the machine in the report
    #[arg(long, value_name = "NAME", requires = "html")]
    machine: Option<String>,
    /// The date of the recordings in the report
    #[arg(long, value_name = "DATE", requires = "html")]
    date: Option<String>,
    /// The list of an axis before the commissioning, with which the report compares that of stage 2:
    /// `X=old.lis`
    #[arg(long, value_name = "LIST", requires = "html")]
    before: Vec<PerAxis>,
    #[command(flatten)]
    result: ResultArgs,
}

/// Runs the command.
pub(crate) fn run(args: &CommissionRunArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let plans = &read_plans(&args.folder, &registry)?;
    let recordings = &recordings_in(&args.folder.join("recordings"))?;
    for path in recordings {
        registry.reads("recording", path);
    }
    args.reading.check_roles(recordings)?;
    let before = args.lists_before(plans)?;
    let commissioning = Commissioning {
        folder: &args.folder,
        plans,
        recordings,
        reader: CommissionReader {
            channels: &args.reading.channels(plans)?,
            words,
        },
        plant: args.plant.as_deref(),
        shaping: if args.no_shaping {
            Shaping::None
        } else {
            Shaping::Allowed
        },
        build: args.build.cnc_build,
        before: &before,
        said: args.said(),
        registry: &registry,
    };
    let mut job = Job::new(&args.result, &registry, console)?.with_page(&args.html)?;
    let report = commissioning.evaluate(job.outputs.files(), &progress::watch())?;
    let given = args.acceptance(&report, before, &registry)?;
    let document = document(&report, &given);
    job.finish(&document, || render_results_json(&report))?;
    Ok(if report.is_complete() {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

impl CommissionRunArgs {
    /// Returns the contents of the report beyond the results.
    fn acceptance(
        &self,
        report: &ResultsReport,
        before: Vec<(String, PathBuf)>,
        registry: &FileRegistry,
    ) -> Result<Acceptance, Failure> {
        let mut changes = Vec::new();
        let rounds = report.rounds.last().into_iter();
        let used: Vec<_> = rounds.flat_map(|it| &it.lists).collect();
        for (axis, before) in before {
            let Some(used) = used.iter().find(|it| it.axis == axis) else {
                continue;
            };
            registry.reads("value list", &before);
            let (old, new) = (read_text(&before)?, read_text(Path::new(&used.file))?);
            let change = TextChange {
                before: (&shown(&before), &old),
                after: (&used.file, &new),
            };
            let patch = render_unified(change);
            let same = "no line differs".to_owned();
            changes.push((axis, if patch.is_empty() { same } else { patch }));
        }
        Ok(Acceptance {
            machine: self.machine.clone(),
            date: self.date.clone(),
            changes,
        })
    }

    /// Returns the earlier list of each axis of stage 2 for which one is given.
    fn lists_before(&self, plans: &[PlanFile]) -> Result<Vec<(String, PathBuf)>, Failure> {
        let axes = plans.last().into_iter().flat_map(|it| &it.lists);
        let axes: Vec<&str> = axes.map(|it| it.axis.as_str()).collect();
        if axes.is_empty() && !self.before.is_empty() {
            return Err(
                Failure::new("`--before` is given, and stage 2 has no list yet")
                    .with_help("leave it out until stage 2 is planned"),
            );
        }
        let lists = ByAxis::new("--before", &self.before, &axes);
        let mut before = Vec::new();
        for axis in &axes {
            let list = lists.list(axis)?;
            before.extend(list.map(|it| ((*axis).to_owned(), it.to_owned())));
        }
        Ok(before)
    }

    /// Returns the user's statements that no recording shows.
    fn said(&self) -> Vec<String> {
        let mut said = self.reading.said();
        if let Some(plant) = &self.plant {
            said.push(format!(
                "moved mass, position loop and the force of a drive unit are those of {plant}"
            ));
        }
        said
    }
}
