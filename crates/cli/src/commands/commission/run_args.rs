//! The arguments of `frictcomp commission run`.

use std::path::PathBuf;

use clap::Args;

use super::channels::ReadingArgs;
use crate::args::{CncBuildArgs, PerAxis, ResultArgs};
use crate::output::HtmlArgs;

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
    pub(super) folder: PathBuf,
    #[command(flatten)]
    pub(super) reading: ReadingArgs,
    /// The plant as known beforehand, `stiff`, `mid`, `soft` or a TOML file: moved mass, position loop and the
    /// force of a drive unit. Contact, Kp, friction and delay are fitted to circles off and on, and lists are
    /// tuned on the fitted plant
    #[arg(long, value_name = "PLANT")]
    pub(super) plant: Option<String>,
    /// Keep the friction curve of tuned lists as it is; do not shape it below 1 mm/s
    #[arg(long, requires = "plant")]
    pub(super) no_shaping: bool,
    #[command(flatten)]
    pub(super) build: CncBuildArgs,
    #[command(flatten)]
    pub(super) html: HtmlArgs,
    /// The name of the machine in the report
    #[arg(long, value_name = "NAME", requires = "html")]
    pub(super) machine: Option<String>,
    /// The date of the recordings in the report
    #[arg(long, value_name = "DATE", requires = "html")]
    pub(super) date: Option<String>,
    /// The list of an axis before the commissioning, with which the report compares that of stage 2:
    /// `X=old.lis`
    #[arg(long, value_name = "LIST", requires = "html")]
    pub(super) before: Vec<PerAxis>,
    #[command(flatten)]
    pub(super) result: ResultArgs,
}
