//! The option for the CNC build of lists.

use clap::Args;

use frictcomp::comp::CncBuild;

/// The build of a control.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct CncBuildArgs {
    /// The CNC build, such as `3.1.3132.0`; outputs of lists are whole numbers unless it accepts fractions. By default
    /// that of the configuration, where one is read
    #[arg(long, value_name = "BUILD")]
    pub(crate) cnc_build: Option<CncBuild>,
}
