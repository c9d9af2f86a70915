//! Options for a control: its build, its cycle, its tools, and how the documents of its current are read.

use std::collections::BTreeMap;
use std::sync::Arc;

use clap::Args;

use super::quantities;
use crate::output::Failure;
use frictcomp::comp::CncBuild;
use frictcomp_physics::current::Reading;
use frictcomp_physics::motion::{ToolRadii, check_cycle};

/// The build of a control.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct CncBuildArgs {
    /// The CNC build, such as `3.1.3132.0`; outputs of lists are whole numbers unless it accepts fractions. By default
    /// that of the configuration, where one is read
    #[arg(long, value_name = "BUILD")]
    pub(crate) cnc_build: Option<CncBuild>,
}

/// The CNC cycle.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct CycleArgs {
    /// The CNC cycle in ms; by default that of the machine, else 1
    #[arg(long, value_name = "MS", value_parser = quantities::ms, allow_negative_numbers = true)]
    cycle_time: Option<f64>,
}

impl CycleArgs {
    /// Returns the cycle in seconds, if it is given.
    pub(crate) fn seconds(&self) -> Result<Option<f64>, Failure> {
        let seconds = self.cycle_time.map(|cycle| cycle / 1000.0);
        Ok(seconds.map(check_cycle).transpose()?)
    }
}

/// The readings of the additive current.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct CurrentReadingArgs {
    /// How to read what the documents leave open: `standstill=zero,below=origin,delay=reversal`
    #[arg(
        long,
        value_name = "READING",
        default_value = "",
        hide_default_value = true
    )]
    pub(crate) reading: Reading,
}

/// The tools of G41 and G42.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ToolArgs {
    /// The radius of the tool in mm, for G41 and G42, or one for each D word, such as `D1=5,D2=8`; without it the
    /// programmed contour is followed
    #[arg(long = "tool-radius", value_name = "MM", value_parser = parse_radii)]
    pub(crate) radii: Option<ToolRadii>,
}

fn parse_radii(text: &str) -> Result<ToolRadii, String> {
    if !text.contains('=') {
        return parse_radius(text).map(ToolRadii::Every);
    }
    let mut radii = BTreeMap::new();
    for one in text.split(',') {
        let (word, radius) = one
            .split_once('=')
            .ok_or_else(|| format!("write `{one}` as a D word and its radius, such as `D1=5`"))?;
        let number = word.trim().strip_prefix(['D', 'd']).unwrap_or_default();
        let number: u32 = number
            .parse()
            .map_err(|_| format!("`{word}` is no D word; write it as in `D1=5`"))?;
        if radii.insert(number, parse_radius(radius)?).is_some() {
            return Err(format!("D{number} is given twice"));
        }
    }
    Ok(ToolRadii::OfData(Arc::new(radii)))
}

fn parse_radius(text: &str) -> Result<f64, String> {
    let radius = quantities::mm(text).ok();
    radius
        .filter(|it| *it > 0.0 && *it <= 1e4)
        .ok_or_else(|| format!("`{text}` is no radius in mm; write it as in `5`, or `D1=5,D2=8`"))
}
