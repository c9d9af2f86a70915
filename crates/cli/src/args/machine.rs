//! The machine on the command line.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::fail_on::SeverityArgs;
use super::settings::{self, SetVariable};
use crate::output::{Console, Failure, Terminal};
use frictcomp::diagnostic::{CodeFilter, Severity};
use frictcomp::lists::FrictionList;
use frictcomp::machine::Machine;
use frictcomp::session::undescribed;
use frictcomp::text::shown_path;
use frictcomp_host::{
    ConfigurationChoice, Disk, FileRegistry, Input, LoadedMachine, MachineOptions, Machines,
    OutsidePolicy, read_value_list, switched_axes, unread_variables,
};
use frictcomp_report::{command_line, counted};

/// The machine, as given on the command line.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Machine")]
pub(crate) struct MachineArgs {
    /// Use this configuration instead of the nearest `frictcomp.toml`
    #[arg(long, value_name = "FILE", conflicts_with = "isolated")]
    config: Option<PathBuf>,
    /// Ignore any `frictcomp.toml`
    #[arg(long)]
    isolated: bool,
    /// Take the axes from this start-up list instead of the configuration
    #[arg(long, value_name = "LIST")]
    startup: Option<PathBuf>,
    /// Take the axes from this TwinCAT project instead of the configuration
    #[arg(long, value_name = "FILE", conflicts_with = "startup")]
    project: Option<PathBuf>,
    /// Assume P-AXIS-00522 = 1 and an accepted value list for these axes
    #[arg(long, value_name = "AXES", value_delimiter = ',')]
    pub(crate) enable: Vec<String>,
    /// Call programs in any folder, and show the text of lists in any folder
    #[arg(long)]
    allow_outside: bool,
    /// Set a variable that only the machine knows
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = settings::parse_setting)]
    settings: Vec<SetVariable>,
}

impl MachineArgs {
    /// Returns the machines of the programs of a command.
    pub(crate) fn machines(&self, registry: &FileRegistry) -> Machines {
        self.with_codes(CodeFilter::default(), registry)
    }

    /// Returns the machines with changed severities.
    pub(crate) fn weighed(
        &self,
        severities: &SeverityArgs,
        registry: &FileRegistry,
    ) -> Result<Machines, Failure> {
        Ok(self.with_codes(severities.filter()?, registry))
    }

    fn with_codes(&self, codes: CodeFilter, registry: &FileRegistry) -> Machines {
        let given = self.settings.iter();
        let given = given.map(|set| (set.name.clone(), set.value.clone()));
        let options = MachineOptions {
            configuration: match &self.config {
                Some(path) => ConfigurationChoice::File(path.clone()),
                None if self.isolated => ConfigurationChoice::Isolated,
                None => ConfigurationChoice::Nearest,
            },
            startup: self.startup.clone().or_else(|| self.project.clone()),
            enable: self.enable.clone(),
            outside_policy: outside_policy(self.allow_outside),
            settings: given.collect(),
            codes,
            ..MachineOptions::default()
        };
        let machines = Machines::new(options, registry);
        match Terminal::watched() {
            Some(terminal) => machines.watched_by(Arc::new(terminal)),
            None => machines,
        }
    }

    /// Reports which `--set` and `--enable` name nothing in the programs that were read (R9.74).
    pub(crate) fn say_unread(
        &self,
        machines: &Machines,
        registry: &FileRegistry,
        console: Console,
    ) {
        let meant = |near: Option<String>| {
            near.map_or(String::new(), |it| format!(", did you mean `{it}`?"))
        };
        let names = self.settings.iter().map(|set| set.name.as_str());
        for variable in unread_variables(names, registry) {
            let (name, near) = (variable.name, meant(variable.near));
            console.remark(&format!("`--set {name}`: no program reads it{near}"));
        }
        for axis in machines.unused_axes() {
            let (name, near) = (axis.name, meant(axis.near));
            console.remark(&format!(
                "`--enable {name}`: no program has this axis{near}"
            ));
        }
    }
}

/// Returns the meaning of `--allow-outside`.
pub(crate) fn outside_policy(is_allowed: bool) -> OutsidePolicy {
    if is_allowed {
        OutsidePolicy::Allowed
    } else {
        OutsidePolicy::Kept
    }
}

/// Returns one line on what `lists` would report beyond the errors.
pub(crate) fn remark(loaded: &LoadedMachine) -> Option<String> {
    let mut parts = Vec::new();
    for (severity, noun) in [(Severity::Warning, "warning"), (Severity::Info, "info")] {
        let said = loaded.diagnostics.iter();
        match said.filter(|said| said.severity == severity).count() {
            0 => {}
            count => parts.push(counted(count, noun)),
        }
    }
    let origin = shown_path(loaded.origin.as_ref()?);
    (!parts.is_empty()).then(|| {
        let parts = parts.join(", ");
        format!("lists: {parts} (see `frictcomp lists {origin}`)")
    })
}

/// Returns the sentence above the messages about programs that run without a described machine, if any of
/// them switches friction compensation (R1.37).
pub(crate) fn undescribed_remark<'a>(
    inputs: impl IntoIterator<Item = &'a Input>,
) -> Option<String> {
    let axes = switched_axes(inputs);
    if axes.is_empty() {
        return None;
    }
    let advice = undescribed(&Machine::unconfigured(), &axes)?;
    Some(advice.in_words(Some(command_line)))
}

/// Returns the values that a list would give the control.
pub(crate) fn value_list(path: &Path, registry: &FileRegistry) -> Result<FrictionList, Failure> {
    let read = read_value_list(path, registry, &Disk::default())?;
    let count = read.diagnostics.len();
    if count > 0 {
        let name = shown_path(path);
        Console::talk(&format!(
            "lists: {} (see `frictcomp lists {name}`)",
            counted(count, "remark")
        ));
    }
    Ok(read.list)
}
