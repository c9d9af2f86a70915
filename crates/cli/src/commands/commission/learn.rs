//! `frictcomp commission learn`: from recorded circles with a list to the next list (R16.4).

use std::path::PathBuf;

use clap::Args;

use crate::args::{
    ByAxis, CircleChannelArgs, CncBuildArgs, CurrentReadingArgs, CycleArgs, ModelArgs, PerAxis,
    value_list,
};
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit, progress};
use frictcomp_host::FileRegistry;
use frictcomp_host::commission::{FirstLists, Learning};
use frictcomp_recordings::commission::NextStep;
use frictcomp_report::results::learn::{document, render_json};

/// Learn value lists from recorded circles, round by round
///
/// The folder holds `round-1`, `round-2` and so on, each with the lists `X.lis` and `Y.lis` and the circles that were
/// recorded with them: at least six feeds, each recorded twice. The recordings judge the lists; a
/// reference plant gives only the direction of the next step. Run it after each round: it judges the lists
/// and writes those of the next round. `learning.json` keeps the rounds with the SHA-256 of lists and recordings.
#[derive(Debug, Args)]
pub(crate) struct LearnArgs {
    /// The folder of the rounds
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// The drives that give the direction of a step: `stiff`, `mid`, `soft`, or a TOML file
    #[arg(long, value_name = "PLANT")]
    plant: String,
    /// For the first round: the measured friction as `identify` or `commission run` wrote it, one list for both axes or `X=LIST` and
    /// `Y=LIST`; no list adds more than 1.3 times this
    #[arg(long, value_name = "LIST")]
    friction: Vec<PerAxis>,
    /// The lists of the first round, for example from `tune`; by default those of `--friction`
    #[arg(long, value_name = "LIST", requires = "friction")]
    value_list: Vec<PerAxis>,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    reading: CurrentReadingArgs,
    #[command(flatten)]
    channels: CircleChannelArgs,
    #[command(flatten)]
    build: CncBuildArgs,
    /// Write the best list so far of every axis, or of `X=FILE`, to this file
    #[arg(long, value_name = "FILE")]
    write_list: Vec<PerAxis>,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    html: HtmlArgs,
}

/// Runs the command.
pub(crate) fn run(args: &LearnArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let mut job = Job::new(&args.result, &registry, console)?.with_page(&args.html)?;
    let learning = Learning {
        folder: &args.folder,
        first: args.first(&registry)?,
        plant: &args.plant,
        model: args.model.model(),
        reading: args.reading.reading,
        channels: args.channels.selections()?,
        cycle_s: args.cycle.seconds()?,
        build: args.build.cnc_build,
        registry: &registry,
    };
    let best = ByAxis::new("--write-list", &args.write_list, &AXES);
    let best = [best.list(AXES[0])?, best.list(AXES[1])?];
    let report = learning.step(best, job.outputs.files(), &progress::watch())?;
    let document = document(&report);
    job.finish(&document, || render_json(&report))?;
    Ok(if report.next == NextStep::Done {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

/// The axes of the lists.
const AXES: [&str; 2] = ["X", "Y"];

impl LearnArgs {
    /// Returns the lists with which learning begins, and reports where one has remarks.
    fn first(&self, registry: &FileRegistry) -> Result<Option<FirstLists<'_>>, Failure> {
        if self.friction.is_empty() {
            return Ok(None);
        }
        let both = |option, given| {
            let lists = ByAxis::new(option, given, &AXES);
            Ok::<_, Failure>([lists.required(AXES[0])?, lists.required(AXES[1])?])
        };
        let friction = both("--friction", &self.friction)?;
        let lists = match &self.value_list[..] {
            [] => None,
            given => Some(both("--value-list", given)?),
        };
        for path in friction.into_iter().chain(lists.into_iter().flatten()) {
            value_list(path, registry)?;
        }
        Ok(Some(FirstLists { friction, lists }))
    }
}
