//! The arguments of `identify`, and the values of one recording with them.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{AxisChannelArgs, CncBuildArgs, CycleArgs, TorqueArgs, named, quantities};
use crate::output::{Failure, HtmlArgs, ResultArgs};
use frictcomp::text::shown_path;
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyError, IdentifyOptions, TraceFinding, identify,
};
use frictcomp_recordings::value_lists::{IdentifiedFrom, render_identified};
use frictcomp_report::results::identify::IdentifyReport;

/// Find the friction of an axis in recordings, and its value list
///
/// Record torque and commanded velocity while the axis moves back and forth at constant speeds:
/// docs/identification.md says how. Without options the columns `t` (s), `v` (µm/s or 0.001°/s), `x`
/// (0.1 µm or 0.0001°) and `torque` (drive units) are taken; `frictcomp trace` lists the channels of a
/// file.
#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    /// The recording; with `--circles` one or more, with `--states` one of each state
    #[arg(value_name = "RECORDING", required = true)]
    pub(super) recordings: Vec<PathBuf>,
    /// The recordings are of several states of the axis, each named: `warm=FILE cold=FILE`
    #[arg(long, conflicts_with = "circles")]
    pub(super) states: bool,
    /// The state in which the machine works and for which the list is made; by default `warm`
    #[arg(long, value_name = "STATE", requires = "states")]
    pub(super) working: Option<String>,
    /// The recordings are circles, at two or more feeds, instead of constant speeds
    #[arg(long, conflicts_with_all = ["points", "max_error", "svg"])]
    pub(super) circles: bool,
    #[command(flatten)]
    pub(super) channels: AxisChannelArgs,
    #[command(flatten)]
    pub(super) cycle: CycleArgs,
    /// The largest number of points in the value list; by default 8
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=200))]
    pub(super) points: Option<u32>,
    /// Use as few points as keep the list within this percentage of the friction
    #[arg(long, value_name = "PCT", value_parser = quantities::percent, allow_negative_numbers = true)]
    pub(super) max_error: Option<f64>,
    /// The feed in mm/min at which the machine works
    #[arg(
        long,
        value_name = "MM/MIN",
        default_value_t = 1000.0,
        value_parser = quantities::mm_per_min,
        allow_negative_numbers = true
    )]
    pub(super) feed: f64,
    #[command(flatten)]
    pub(super) torque: TorqueArgs,
    #[command(flatten)]
    pub(super) result: ResultArgs,
    #[command(flatten)]
    pub(super) build: CncBuildArgs,
    /// Draw speeds, curve and residuals to this SVG file
    #[arg(long, value_name = "FILE")]
    pub(super) svg: Option<PathBuf>,
    #[command(flatten)]
    pub(super) html: HtmlArgs,
    /// Write the value list to this file
    #[arg(long, value_name = "FILE")]
    pub(super) write_list: Option<PathBuf>,
    /// Write the value list of each axis to this folder, named after the axis: `X.lis`
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["write_list", "circles", "states"])]
    pub(super) into: Option<PathBuf>,
}

impl IdentifyArgs {
    /// Returns the value list of a report, with further remarks at its head.
    pub(super) fn list_of(&self, report: &IdentifyReport, remarks: &[String]) -> String {
        let made = IdentifiedFrom {
            axis: report.axis.as_deref(),
            from: &report.name,
            unit: report.unit(),
            faults: &[remarks, &report.faults()].concat(),
        };
        render_identified(&report.identified.list(), made, self.build.cnc_build)
    }
}

/// Returns the values identified in a recording.
pub(super) fn identified(
    (axis, path): (&str, &Path),
    recording: AxisRecording,
    options: &IdentifyOptions,
) -> Result<IdentifyReport, Failure> {
    let options = IdentifyOptions {
        measured: recording.measured,
        ..*options
    };
    let identified = identify(&recording.track, &options)
        .map_err(|error| refusal(error, &recording.findings))?;
    Ok(IdentifyReport {
        name: shown_path(path),
        axis: named(axis),
        recording,
        identified,
    })
}

/// Returns why nothing was identified, with findings about the channels themselves.
pub(crate) fn refusal(error: IdentifyError, findings: &[TraceFinding]) -> Failure {
    findings.iter().fold(error.into(), |failure: Failure, it| {
        failure.with_help(format!("{}: {}", it.code, it.message))
    })
}
