//! Options for driving the path of a program with simulated drives.

use std::str::FromStr;

use clap::Args;

use super::control::{CycleArgs, ToolArgs};
use super::execution::ExecutionArgs;
use super::machine::value_list;
use super::per_axis::{ByAxis, PerAxis};
use super::quantities;
use super::start::StartArgs;
use super::values;
use crate::output::Failure;
use frictcomp::interpreter::StopPolicy;
use frictcomp::text::shown_path;
use frictcomp_host::{
    ContourSetup, FileRegistry, LoadedMachine, Naming, NoDrivenContour, find_plant,
};
use frictcomp_physics::contour::NoContour;
use frictcomp_physics::motion::{PlannerOptions, check_cycle};
use frictcomp_physics::simulation::FrictionModel;

/// The simulated drives.
#[derive(Debug, Clone, Args)]
pub(crate) struct PlantArgs {
    /// The drives: `stiff`, `mid`, `soft`, or a TOML file; by default `stiff`
    #[arg(long, value_name = "PLANT")]
    plant: Option<String>,
}

impl PlantArgs {
    /// Returns the plant as named.
    pub(crate) fn name(&self) -> &str {
        self.plant.as_deref().unwrap_or("stiff")
    }
}

/// The friction of the simulated drives.
#[derive(Debug, Clone, Args)]
pub(crate) struct ModelArgs {
    /// The friction model; by default `lugre`
    #[arg(long, value_parser = values::friction_model())]
    model: Option<FrictionModel>,
}

impl ModelArgs {
    /// Returns the model.
    pub(crate) fn model(&self) -> FrictionModel {
        self.model.unwrap_or_default()
    }
}

/// The drives for the path of a program.
#[derive(Debug, Clone, Args)]
pub(crate) struct SimulationArgs {
    /// The axes of the plane, `XY` or `X1,Y1`; by default `XY`
    #[arg(long, value_name = "AXES", value_parser = parse_plane)]
    plane: Option<[String; 2]>,
    #[command(flatten)]
    plant: PlantArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// The compensation value list of both axes, or `X=LIST`, in place of the machine's
    #[arg(long, value_name = "LIST")]
    value_list: Vec<PerAxis>,
    #[command(flatten)]
    pub(crate) start: StartArgs,
    #[command(flatten)]
    tool: ToolArgs,
    #[command(flatten)]
    cycle: CycleArgs,
    /// The largest number of CNC cycles; by default 100 million
    #[arg(long, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    max_cycles: Option<u64>,
}

impl SimulationArgs {
    /// Returns the plant as named.
    pub(crate) fn plant(&self) -> &str {
        self.plant.name()
    }

    /// Refuses options of a contour if none is requested.
    pub(crate) fn refuse_without_contour(&self) -> Result<(), Failure> {
        let given = [
            ("--plane", self.plane.is_some()),
            ("--plant", self.plant.plant.is_some()),
            ("--model", self.model.model.is_some()),
            ("--value-list", !self.value_list.is_empty()),
            ("--start", !self.start.given().is_empty()),
            ("--tool-radius", self.tool.radii.is_some()),
            ("--cycle-time", self.cycle.seconds()?.is_some()),
            ("--max-cycles", self.max_cycles.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::new(format!(
                "`{option}` sets how a contour is driven, but none is requested"
            ))
            .with_help("add `--contour`")),
            None => Ok(()),
        }
    }

    /// Returns the setup of a contour on a machine, with the naming of files.
    pub(crate) fn setup(
        &self,
        (loaded, naming): (&LoadedMachine, Naming),
        execution: &ExecutionArgs,
        registry: &FileRegistry,
    ) -> Result<ContourSetup, Failure> {
        let plane = self.plane.clone();
        let plane = plane.unwrap_or_else(|| ["X", "Y"].map(str::to_owned));
        let lists = ByAxis {
            option: "--value-list",
            given: &self.value_list,
            axes: &plane.each_ref().map(String::as_str),
        };
        let mut value_lists = Vec::new();
        for axis in &plane {
            if let Some(path) = lists.list(axis)? {
                let list = value_list(path, registry)?;
                value_lists.push((axis.clone(), shown_path(path), list));
            }
        }
        let mut session = execution.options(loaded, StopPolicy::FirstError);
        session.start = self.start.positions(&loaded.machine)?;
        Ok(ContourSetup {
            plane,
            plant: find_plant(self.plant(), registry)?,
            value_lists,
            model: self.model.model(),
            planner: self.planner(loaded)?,
            session,
            naming,
        })
    }

    /// Returns the cycle of the command line, else that of the machine.
    fn planner(&self, loaded: &LoadedMachine) -> Result<PlannerOptions, Failure> {
        let usual = PlannerOptions::default();
        let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
        let cycle = self.cycle.seconds()?.or(of_machine);
        Ok(PlannerOptions {
            cycle_s: check_cycle(cycle.unwrap_or(usual.cycle_s))?,
            max_cycles: self.max_cycles.unwrap_or(usual.max_cycles),
            tool_radii: self.tool.radii.clone().unwrap_or_default(),
        })
    }
}

/// Tolerance of a figure in µm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tolerance(f64);

impl Default for Tolerance {
    /// Returns half a µm: less is not visible on any part.
    fn default() -> Self {
        Self(0.5)
    }
}

impl Tolerance {
    /// Returns the tolerance in µm.
    pub(crate) fn um(self) -> f64 {
        self.0
    }

    /// Refuses a tolerance if no contour is requested.
    pub(crate) fn refuse_without_contour(given: Option<Self>) -> Result<(), Failure> {
        match given {
            Some(_) => Err(Failure::new(
                "`--tolerance` applies to a contour, but none is requested",
            )
            .with_help("add `--contour`")),
            None => Ok(()),
        }
    }
}

impl FromStr for Tolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let um = quantities::um(text)?;
        let um = Some(um).filter(|um| *um >= 0.0);
        um.map(Self)
            .ok_or_else(|| "write the µm, 0 or more".to_owned())
    }
}

/// Parses `XY`, or `X1,Y1` for names of several letters.
fn parse_plane(text: &str) -> Result<[String; 2], String> {
    let pair = match text.split_once(',') {
        Some((first, second)) => Some([first.trim(), second.trim()]),
        None if text.chars().count() == 2 => {
            let second = text.char_indices().nth(1).map_or(0, |(at, _)| at);
            Some([&text[..second], &text[second..]])
        }
        None => None,
    };
    pair.map(|pair| pair.map(str::to_owned))
        .ok_or_else(|| "write two axes, `XY` or `X1,Y1`".to_owned())
}

impl From<NoDrivenContour> for Failure {
    fn from(error: NoDrivenContour) -> Self {
        let help = match &error {
            NoDrivenContour::Axes(NoContour::NoAxis(unknown)) => unknown.help("its axes are"),
            NoDrivenContour::Unstable { .. } => {
                Some("check gains and masses of the plant".to_owned())
            }
            NoDrivenContour::OnlyOnce => Some("name a file".to_owned()),
            _ => None,
        };
        if let NoDrivenContour::Host(error) = error {
            return error.into();
        }
        let failure = Self::new(error.to_string());
        match help {
            Some(help) => failure.with_help(help),
            None => failure,
        }
    }
}
