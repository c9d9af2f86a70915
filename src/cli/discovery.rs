//! Which machine a program runs on: `frictcomp.toml`, a start-up list, or none.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::failure::Failure;
use super::files::Input;
use super::finder::Reach;
use super::grounds::{Elsewhere, Grounds, absolute};
use super::ledger::Ledger;
use super::list_files::{Lists, read_list};
use super::lookahead::{AxesAhead, may_be_axis};
use super::settings::{self, SetVariable};
use super::severities::SeverityArgs;
use super::watch::Watch;
use crate::diagnostic::{Code, Diagnostic, Levels, Severity, did_you_mean};
use crate::lists::Parameter;
use crate::machine::{AxisReport, AxisSet, Configuration, Machine, Origin, Setting};
use crate::text::SourceFile;

/// The name of the configuration file.
pub(super) const CONFIG_NAME: &str = "frictcomp.toml";

/// The machine, as the user gives it on the command line.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Machine")]
pub(super) struct MachineArgs {
    /// Use this configuration instead of the nearest `frictcomp.toml`
    #[arg(long, value_name = "FILE", conflicts_with = "isolated")]
    pub(super) config: Option<PathBuf>,
    /// Ignore any `frictcomp.toml`
    #[arg(long)]
    pub(super) isolated: bool,
    /// Take the axes from this start-up list instead of the configuration
    #[arg(long, value_name = "LIST")]
    pub(super) startup: Option<PathBuf>,
    /// Assume P-AXIS-00522 = 1 and an accepted value list for these axes
    #[arg(long, value_name = "AXES", value_delimiter = ',')]
    pub(super) enable: Vec<String>,
    /// Call programs in any folder, and show the text of lists in any folder
    #[arg(long)]
    pub(super) allow_outside: bool,
    /// Set a variable that only the machine knows
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = settings::parse_setting)]
    pub(super) settings: Vec<SetVariable>,
}

/// A machine and what else its configuration says.
#[derive(Debug, Clone, Default)]
pub(super) struct LoadedMachine {
    /// The machine.
    pub(super) machine: Machine,
    /// Values of variables that only the machine knows.
    pub(super) settings: Vec<(String, Setting)>,
    /// The user's severities.
    pub(super) levels: Levels,
    /// Where called programs may lie.
    pub(super) reach: Reach,
    /// What there is to say about the lists.
    pub(super) diagnostics: Vec<Diagnostic>,
    /// The effective parameters, by axis.
    pub(super) reports: Vec<AxisReport>,
    /// The programs and macros that the configuration names, and where.
    pub(super) programs: Vec<Parameter>,
    /// The configuration or the start-up list that was read.
    pub(super) origin: Option<PathBuf>,
    /// How many lists were read, and how many are named and are not there.
    pub(super) lists: (usize, usize),
    /// The extensions of files that are programs.
    pub(super) extensions: Option<Vec<String>>,
    /// Where the files of a run on this machine are noted.
    pub(super) ledger: Ledger,
    /// Who watches the runs on this machine.
    pub(super) watch: Arc<Watch>,
}

impl LoadedMachine {
    fn new(configuration: Configuration, path: &Path, ledger: &Ledger) -> Self {
        ledger.reads("configuration", path);
        for file in &configuration.files {
            ledger.reads("list", Path::new(&**file));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let folders = configuration.program_dirs.iter();
        Self {
            machine: configuration.machine,
            settings: configuration.settings,
            levels: configuration.levels,
            reach: Reach {
                program_dirs: folders.map(|written| folder.join(written)).collect(),
                project: folder.to_owned(),
                elsewhere: Elsewhere::Kept,
            },
            diagnostics: configuration.diagnostics,
            reports: configuration.reports,
            programs: configuration.programs,
            origin: Some(path.to_owned()),
            lists: (configuration.files.len(), configuration.missing),
            extensions: match configuration.extensions {
                given if given.is_empty() => None,
                given => Some(given),
            },
            ledger: ledger.clone(),
            watch: Arc::default(),
        }
    }

    /// The machine without a configuration.
    fn unconfigured(ledger: &Ledger) -> Self {
        Self {
            machine: Machine::unconfigured(),
            ledger: ledger.clone(),
            ..Self::default()
        }
    }

    /// What stops the control at start-up or keeps it from taking a list.
    pub(super) fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics
            .iter()
            .filter(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// One line about what `lists` would say beyond the errors.
    pub(super) fn remark(&self) -> Option<String> {
        let count = |severity| {
            self.diagnostics
                .iter()
                .filter(|diagnostic| diagnostic.severity == severity)
                .count()
        };
        let mut parts = Vec::new();
        for (severity, noun) in [(Severity::Warning, "warning"), (Severity::Info, "info")] {
            match count(severity) {
                0 => {}
                1 => parts.push(format!("1 {noun}")),
                several => parts.push(format!("{several} {noun}s")),
            }
        }
        let origin = self.origin.as_ref()?.display();
        (!parts.is_empty()).then(|| {
            let parts = parts.join(", ");
            format!("lists: {parts} (`frictcomp lists {origin}` shows them)")
        })
    }
}

/// The machines of the programs of one command; each configuration is read once.
pub(super) struct Machines<'a> {
    args: &'a MachineArgs,
    ledger: Ledger,
    severities: Option<&'a SeverityArgs>,
    /// The axes of the programs, where somebody asks for axes.
    ahead: Option<AxesAhead>,
    watch: Arc<Watch>,
    loaded: BTreeMap<Option<PathBuf>, Arc<LoadedMachine>>,
    /// The nearest configuration of each folder that was asked for.
    nearest: BTreeMap<PathBuf, Option<PathBuf>>,
}

impl<'a> Machines<'a> {
    pub(super) fn new(args: &'a MachineArgs, ledger: &Ledger) -> Self {
        Self {
            args,
            ledger: ledger.clone(),
            severities: None,
            ahead: None,
            watch: Arc::default(),
            loaded: BTreeMap::new(),
            nearest: BTreeMap::new(),
        }
    }

    /// The machine of a program in a folder.
    pub(super) fn for_folder(&mut self, folder: &Path) -> Result<Arc<LoadedMachine>, Failure> {
        let config = match (&self.args.config, self.args.isolated) {
            (Some(path), _) => Some(path.clone()),
            (None, true) => None,
            (None, false) => self.nearest(folder),
        };
        if let Some(loaded) = self.loaded.get(&config) {
            return Ok(Arc::clone(loaded));
        }
        let mut loaded = load_machine(config.as_deref(), self.args, &self.ledger)?;
        enable_axes(&mut loaded, self.args, self.ahead.as_ref())?;
        if let Some(severities) = self.severities {
            severities.apply(&mut loaded.levels);
            severities.sift(&mut loaded.diagnostics);
        }
        loaded.watch = Arc::clone(&self.watch);
        let loaded = Arc::new(loaded);
        self.loaded.insert(config, Arc::clone(&loaded));
        Ok(loaded)
    }

    /// Changes severities for this call.
    pub(super) fn weigh(&mut self, severities: &'a SeverityArgs) -> Result<(), Failure> {
        severities.check()?;
        self.severities = Some(severities);
        Ok(())
    }

    /// The programs are known: `--enable` takes axes that they name.
    pub(super) fn look_ahead(&mut self, inputs: &[Input]) {
        self.watch.expect(inputs.len());
        if !self.args.enable.is_empty() {
            let names = self.args.enable.iter().map(|name| name.trim());
            self.ahead = Some(AxesAhead::of(inputs, names));
            self.loaded.clear();
        }
    }

    /// Programs of other runs name the usual axes, and those that an earlier run left.
    pub(super) fn expect_more(&mut self, left: Vec<String>) {
        if let Some(ahead) = &mut self.ahead {
            ahead.expect_more(left);
        }
    }

    /// The extensions of programs below a folder, where its configuration names them.
    pub(super) fn extensions(&mut self, folder: &Path) -> Option<Vec<String>> {
        let loaded = self.for_folder(folder).ok()?;
        loaded.extensions.clone()
    }

    fn nearest(&mut self, folder: &Path) -> Option<PathBuf> {
        if let Some(found) = self.nearest.get(folder) {
            return found.clone();
        }
        let found = nearest_config(folder);
        self.nearest.insert(folder.to_owned(), found.clone());
        found
    }

    /// Every machine that was asked for, in the order of its configuration's path.
    pub(super) fn loaded(&self) -> impl Iterator<Item = &LoadedMachine> {
        self.loaded.values().map(Arc::as_ref)
    }
}

/// Reads the configuration and applies what the command line says about the machine.
fn load_machine(
    config: Option<&Path>,
    args: &MachineArgs,
    ledger: &Ledger,
) -> Result<LoadedMachine, Failure> {
    let elsewhere = args.elsewhere();
    let mut loaded = match config {
        Some(path) => read_config(path, args, ledger)?,
        None => LoadedMachine::unconfigured(ledger),
    };
    loaded.reach.elsewhere = elsewhere;
    if let Some(path) = &args.startup {
        let axes = read_startup(path, args, ledger)?;
        loaded.machine = axes.machine;
        loaded.diagnostics = axes.diagnostics;
        loaded.reports = axes.reports;
        loaded.programs = axes.programs;
        loaded.origin = axes.origin;
        loaded.lists = axes.lists;
    }
    let given = args.settings.iter();
    loaded
        .settings
        .extend(given.map(|set| (set.name.clone(), set.value.clone())));
    Ok(loaded)
}

impl MachineArgs {
    fn elsewhere(&self) -> Elsewhere {
        if self.allow_outside {
            Elsewhere::Allowed
        } else {
            Elsewhere::Kept
        }
    }

    /// The folders whose lists are shown: the current one, that of a file and those of programs.
    fn grounds(&self, path: &Path, reach: &Reach) -> Grounds {
        let reach = Reach {
            elsewhere: self.elsewhere(),
            ..reach.clone()
        };
        let grounds = reach.grounds().with(Path::new(""));
        // A file that the user names lies where it lies; one that was found may be a link.
        match (&self.config, path.canonicalize()) {
            (Some(_), Ok(real)) => grounds.with(real.parent().unwrap_or(&real)),
            _ => grounds,
        }
    }
}

/// Reads a `frictcomp.toml` and the lists that it names.
fn read_config(path: &Path, args: &MachineArgs, ledger: &Ledger) -> Result<LoadedMachine, Failure> {
    let source = SourceFile::new(path.display().to_string(), read_list(path)?);
    match Configuration::from_toml(source, &mut Lists) {
        Ok(configuration) => {
            let mut loaded = LoadedMachine::new(configuration, path, ledger);
            let grounds = args.grounds(path, &loaded.reach);
            grounds.conceal(&mut loaded.diagnostics);
            Ok(loaded)
        }
        Err(error) => {
            let reach = Reach {
                project: path.parent().unwrap_or(path).to_owned(),
                ..Reach::default()
            };
            let mut diagnostics = vec![*error.diagnostic];
            args.grounds(path, &reach).conceal(&mut diagnostics);
            Err(Failure {
                message: format!("the configuration `{}` cannot be used", path.display()),
                diagnostics,
                ..Failure::default()
            })
        }
    }
}

/// Reads a start-up list and the lists that it names.
fn read_startup(
    path: &Path,
    args: &MachineArgs,
    ledger: &Ledger,
) -> Result<LoadedMachine, Failure> {
    let source = SourceFile::new(path.display().to_string(), read_list(path)?);
    let configuration = Configuration::from_startup(source, &mut Lists);
    let wrong = configuration.diagnostics.iter().find(|said| {
        let whole_file = *said.place.file == *path.display().to_string();
        said.code == Code::Fc125 && whole_file && said.place.start().line == 1
    });
    if let Some(wrong) = wrong
        && configuration.machine.axis_set == AxisSet::AsTheyOccur
    {
        let failure = Failure::new(wrong.message.clone());
        let toml = path
            .extension()
            .is_some_and(|it| it.eq_ignore_ascii_case("toml"));
        return Err(if toml {
            failure.with_help("`--config` takes a `frictcomp.toml`")
        } else {
            let help = "`--startup` takes the list that names all others, `hochlauf.lis`";
            failure.with_help(help)
        });
    }
    let mut loaded = LoadedMachine::new(configuration, path, ledger);
    let grounds = args.grounds(path, &loaded.reach);
    grounds.conceal(&mut loaded.diagnostics);
    Ok(loaded)
}

/// Assumes friction compensation on the axes that the user names.
fn enable_axes(
    loaded: &mut LoadedMachine,
    args: &MachineArgs,
    ahead: Option<&AxesAhead>,
) -> Result<(), Failure> {
    for name in args.enable.iter().map(|name| name.trim()) {
        check_name(name)?;
        if loaded.machine.axis_set == AxisSet::AsTheyOccur {
            check_occurs(name, ahead)?;
        }
        enable(&mut loaded.machine, name)?;
        assume(&mut loaded.reports, &loaded.machine, name);
        // What is assumed need not be found missing.
        loaded.diagnostics.retain(|said| {
            let assumed = matches!(said.code, Code::Fc135 | Code::Fc303);
            !(assumed && said.axis.as_deref() == Some(name))
        });
    }
    Ok(())
}

/// Whether a program may name an axis, where no machine is described (R9.74). Called programs and
/// pipes may name axes that nobody sees ahead.
fn check_occurs(name: &str, ahead: Option<&AxesAhead>) -> Result<(), Failure> {
    let Some(ahead) = ahead else {
        return may_be_axis(name).then_some(()).ok_or_else(|| no_name(name));
    };
    if ahead.may_hold(name) {
        return Ok(());
    }
    let names: Vec<&str> = ahead.names().collect();
    let failure = Failure::new(format!("no program names an axis `{name}`"));
    Err(match did_you_mean(name, names.iter().copied()) {
        Some(near) => failure.with_help(format!("did you mean `{near}`?")),
        None if names.is_empty() => failure,
        None => failure.with_help(format!("they name {}", names.join(", "))),
    })
}

fn check_name(name: &str) -> Result<(), Failure> {
    let word = name.starts_with(|letter: char| letter.is_ascii_alphabetic())
        && name
            .chars()
            .all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if word { Ok(()) } else { Err(no_name(name)) }
}

fn no_name(name: &str) -> Failure {
    Failure::new(format!("`{name}` is not an axis name")).with_help("write `--enable X,Y`")
}

fn enable(machine: &mut Machine, name: &str) -> Result<(), Failure> {
    if machine.enable(name) {
        return Ok(());
    }
    let names: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
    let failure = Failure::new(format!("the machine has no axis `{name}`"));
    Err(match did_you_mean(name, names.iter().copied()) {
        Some(near) => failure.with_help(format!("did you mean `{near}`?")),
        None => failure.with_help(format!("its axes are {}", names.join(", "))),
    })
}

/// Shows an assumed P-AXIS-00522 among the parameters of its axis.
fn assume(reports: &mut [AxisReport], machine: &Machine, name: &str) {
    let axis = machine.axes.iter().find(|axis| axis.name == name);
    if axis.is_none_or(|axis| axis.frict_comp_origin != Origin::Assumed) {
        return;
    }
    let report = reports.iter_mut().filter(|report| report.axis == name);
    let rows = report.flat_map(|report| &mut report.parameters);
    for row in rows.filter(|row| row.number == "P-AXIS-00522") {
        "1".clone_into(&mut row.value);
        row.origin = Origin::Assumed;
    }
}

/// The nearest configuration from a folder upwards, as a path from the current folder.
pub(super) fn nearest_config(folder: &Path) -> Option<PathBuf> {
    let found = absolute(folder)?
        .ancestors()
        .map(|ancestor| ancestor.join(CONFIG_NAME))
        .find(|candidate| candidate.is_file())?;
    let here = std::env::current_dir().ok()?;
    Some(relative(&found, &here))
}

/// A path seen from a folder, so that no output holds an absolute path (R9.16).
pub(super) fn relative(path: &Path, folder: &Path) -> PathBuf {
    let shared = path
        .components()
        .zip(folder.components())
        .take_while(|(one, other)| one == other)
        .count();
    if shared == 0 {
        return path.to_owned();
    }
    let up = folder
        .components()
        .skip(shared)
        .map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_configuration_counts() {
        let root = tempfile::tempdir().unwrap();
        let deep = root.path().join("a/b");
        std::fs::create_dir_all(&deep).unwrap();
        std::fs::write(root.path().join(CONFIG_NAME), "").unwrap();
        let far = nearest_config(&deep).unwrap();
        assert!(far.ends_with(CONFIG_NAME) && !far.ends_with("a/frictcomp.toml"));
        std::fs::write(root.path().join("a").join(CONFIG_NAME), "").unwrap();
        assert!(nearest_config(&deep).unwrap().ends_with("a/frictcomp.toml"));
    }

    #[test]
    fn paths_are_seen_from_the_current_folder() {
        let seen = |path, folder| relative(Path::new(path), Path::new(folder));
        assert_eq!(seen("/a/b/c.toml", "/a/b"), Path::new("c.toml"));
        assert_eq!(seen("/a/c.toml", "/a/b/d"), Path::new("../../c.toml"));
        assert_eq!(seen("/a/b/c.toml", "/a"), Path::new("b/c.toml"));
    }

    #[test]
    fn an_axis_that_the_machine_lacks_is_not_enabled() {
        let mut machine = Machine::unconfigured();
        machine.axis_set = AxisSet::Configured;
        assert!(enable(&mut machine, "X").is_ok());
        let failure = enable(&mut machine, "XX").unwrap_err();
        assert_eq!(failure.message, "the machine has no axis `XX`");
        assert_eq!(failure.help, ["did you mean `X`?"]);
        assert!(check_name("X[").is_err());
    }
}
