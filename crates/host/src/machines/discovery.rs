//! The machine of a program: from `frictcomp.toml`, a start-up list, or none.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::allowed_roots::{AllowedRoots, OutsidePolicy};
use super::assumed::{AxesOfPrograms, UnusedAxes, assume_axes};
use super::finder::SearchPath;
use super::list_files::{ListsOnDisk, read_list};
use crate::disk::{
    CONFIG_NAME, Disk, FileRegistry, FolderOptions, FolderSelection, Input, relative,
};
use crate::error::HostError;
use crate::watch::{Watch, Watcher};
use frictcomp::diagnostic::{Code, CodeFilter, Diagnostic, Levels, Severity, UnknownName};
use frictcomp::interpreter::Options;
use frictcomp::lists::{Parameter, is_xml};
use frictcomp::machine::{AxisReport, AxisSet, Configuration, Machine, Setting};
use frictcomp::session::SessionOptions;
use frictcomp::text::{SourceFile, shown_path};

/// Selection of the configuration.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum ConfigurationChoice {
    /// The nearest `frictcomp.toml` from the folder of the program upwards.
    #[default]
    Nearest,
    /// The given file.
    File(PathBuf),
    /// No configuration, whatever files exist.
    Isolated,
}

/// Source of the machine of programs, with deviations from its configuration.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MachineOptions {
    /// The configuration.
    pub configuration: ConfigurationChoice,
    /// The start-up list or TwinCAT project that provides the axes in place of the configuration.
    pub startup: Option<PathBuf>,
    /// The axes on which P-AXIS-00522 = 1 and an accepted value list are assumed.
    pub enable: Vec<String>,
    /// Treatment of such axes that no program has.
    pub unused_axes: UnusedAxes,
    /// Treatment of programs and lists outside the folders.
    pub outside_policy: OutsidePolicy,
    /// Values of variables that only the machine has.
    pub settings: Vec<(String, Setting)>,
    /// Codes that count.
    pub codes: CodeFilter,
    /// Selection of the files of folders.
    pub folders: FolderOptions,
}

/// A machine with the rest of its configuration.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LoadedMachine {
    /// The machine.
    pub machine: Machine,
    /// Values of variables that only the machine has.
    pub settings: Vec<(String, Setting)>,
    /// The user's severities.
    pub levels: Levels,
    /// Folders of called programs.
    pub search_path: SearchPath,
    /// Messages on the lists.
    pub diagnostics: Vec<Diagnostic>,
    /// The effective parameters, by axis.
    pub reports: Vec<AxisReport>,
    /// The programs and macros that the configuration names, and where.
    pub programs: Vec<Parameter>,
    /// The configuration or the start-up list that was read.
    pub origin: Option<PathBuf>,
    /// Number of lists read, and of named lists that do not exist.
    pub lists: (usize, usize),
    /// The extensions of program files.
    pub extensions: Option<Vec<String>>,
    /// Patterns of files and folders that are not taken, from the folder of the configuration.
    pub exclude: Vec<String>,
    /// Registry of the files of a run on this machine.
    pub registry: FileRegistry,
    /// The disk that runs on this machine read from.
    pub disk: Disk,
    /// The watcher of the runs on this machine.
    pub watch: Arc<Watch>,
}

impl LoadedMachine {
    /// Returns the options of a session on the machine.
    pub fn session(&self, run: Options) -> SessionOptions {
        SessionOptions::from(run)
            .with_levels(self.levels.clone())
            .with_settings(self.settings.clone())
    }

    fn new(configuration: Configuration, path: &Path, registry: &FileRegistry) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        let folders = configuration.program_dirs.iter();
        Self {
            machine: configuration.machine,
            settings: configuration.settings,
            levels: configuration.levels,
            search_path: SearchPath {
                // Written on Windows, read anywhere.
                program_dirs: folders
                    .map(|written| folder.join(written.replace('\\', "/")))
                    .collect(),
                project: folder.to_owned(),
                outside_policy: OutsidePolicy::Kept,
            },
            diagnostics: configuration.diagnostics,
            reports: configuration.reports,
            programs: configuration.programs,
            origin: Some(path.to_owned()),
            lists: match configuration.embedded.count() {
                0 => (configuration.files.len(), configuration.missing),
                count => (count, configuration.missing),
            },
            extensions: match configuration.extensions {
                given if given.is_empty() => None,
                given => Some(given),
            },
            exclude: configuration.exclude,
            registry: registry.clone(),
            disk: Disk::default(),
            watch: Arc::default(),
        }
    }

    /// Creates a machine without a configuration.
    fn unconfigured(registry: &FileRegistry) -> Self {
        Self {
            machine: Machine::unconfigured(),
            registry: registry.clone(),
            ..Self::default()
        }
    }

    /// Returns the messages on faults that stop the control at start-up or make it reject a
    /// list.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics
            .iter()
            .filter(|diagnostic| diagnostic.severity == Severity::Error)
    }
}

/// The machines of programs; each configuration is read once.
#[derive(Debug)]
pub struct Machines {
    options: MachineOptions,
    registry: FileRegistry,
    disk: Disk,
    /// The axes of the programs, where axes are requested.
    ahead: Option<AxesOfPrograms>,
    watch: Arc<Watch>,
    /// The machines without the axes enabled by the user.
    plain: BTreeMap<Option<PathBuf>, LoadedMachine>,
    loaded: BTreeMap<Option<PathBuf>, Arc<LoadedMachine>>,
    /// The nearest configuration of each folder looked up so far.
    nearest: BTreeMap<PathBuf, Option<PathBuf>>,
}

impl Machines {
    /// Creates a finder without machines. The files that it reads are noted in the registry.
    pub fn new(options: MachineOptions, registry: &FileRegistry) -> Self {
        Self {
            options,
            registry: registry.clone(),
            disk: Disk::default(),
            ahead: None,
            watch: Arc::default(),
            plain: BTreeMap::new(),
            loaded: BTreeMap::new(),
            nearest: BTreeMap::new(),
        }
    }

    /// Sets a watcher of the programs that run on the machines.
    pub fn watched_by(mut self, watcher: Arc<dyn Watcher>) -> Self {
        self.watch = Arc::new(Watch::by(watcher));
        self
    }

    /// Sets the selection of the files of folders.
    pub fn selecting(mut self, folders: FolderOptions) -> Self {
        self.options.folders = folders;
        self
    }

    /// Sets a disk other than the system's.
    pub fn on_disk(self, disk: &Disk) -> Self {
        let disk = disk.clone();
        Self { disk, ..self }
    }

    /// Returns the machine of a program in a folder.
    ///
    /// # Errors
    /// The configuration or the start-up list cannot be used, or an axis is unknown.
    pub fn for_folder(&mut self, folder: &Path) -> Result<Arc<LoadedMachine>, HostError> {
        let config = self.configuration(folder);
        if let Some(loaded) = self.loaded.get(&config) {
            return Ok(Arc::clone(loaded));
        }
        let mut loaded = self.plain(config.as_deref())?.clone();
        let options = &self.options;
        let onto = (&mut loaded.machine, loaded.reports.as_mut_slice());
        let names = (options.enable.as_slice(), options.unused_axes);
        let assumed = assume_axes(names, onto, self.ahead.as_ref())?;
        // Assumed compensation need not be reported as missing.
        loaded.diagnostics.retain(|said| {
            let is_missing = matches!(said.code, Code::Fc135 | Code::Fc303);
            !(is_missing && said.axis.as_deref().is_some_and(|it| assumed.contains(&it)))
        });
        options.codes.apply(&mut loaded.levels);
        options.codes.sift(&mut loaded.diagnostics);
        loaded.disk = self.disk.clone();
        loaded.watch = Arc::clone(&self.watch);
        let loaded = Arc::new(loaded);
        self.loaded.insert(config, Arc::clone(&loaded));
        Ok(loaded)
    }

    /// Returns the configuration that applies to the programs of a folder.
    pub(crate) fn configuration(&mut self, folder: &Path) -> Option<PathBuf> {
        match &self.options.configuration {
            ConfigurationChoice::File(path) => Some(path.clone()),
            ConfigurationChoice::Isolated => None,
            ConfigurationChoice::Nearest => self.nearest(folder),
        }
    }

    /// Returns the selection of the configuration.
    pub(crate) fn choice(&self) -> &ConfigurationChoice {
        &self.options.configuration
    }

    /// Returns the disk that configurations and lists are read from.
    pub(crate) fn disk(&self) -> &Disk {
        &self.disk
    }

    /// Returns the folders in which the programs of the machines, and what they call, may lie.
    pub fn folders(&self) -> impl Iterator<Item = &Path> {
        self.loaded().flat_map(|loaded| {
            let project = loaded
                .origin
                .as_ref()
                .map(|_| loaded.search_path.project.as_path());
            let dirs = loaded.search_path.program_dirs.iter().map(PathBuf::as_path);
            project.into_iter().chain(dirs)
        })
    }

    /// Returns the files read so far for machines and programs.
    pub(crate) fn files_read(&self) -> Vec<PathBuf> {
        self.registry.files()
    }

    /// Applies a configuration to the programs of a folder, unless the user chose another one.
    pub(crate) fn settle(&mut self, folder: &Path, configuration: Option<PathBuf>) {
        self.nearest.insert(folder.to_owned(), configuration);
    }

    /// Returns the machine of a configuration without the axes enabled by the user.
    pub(crate) fn plain(&mut self, config: Option<&Path>) -> Result<&LoadedMachine, HostError> {
        let key = config.map(Path::to_owned);
        if !self.plain.contains_key(&key) {
            let loaded = self.load(config)?;
            self.plain.insert(key.clone(), loaded);
        }
        Ok(&self.plain[&key])
    }

    pub(crate) fn registry(&self) -> &FileRegistry {
        &self.registry
    }

    /// Takes the programs: compensation is assumed on axes that they, or their machines, have
    /// (R17.7).
    pub fn look_ahead(&mut self, inputs: &[Input]) {
        self.watch.expect(inputs.len());
        if self.options.enable.is_empty() || inputs.is_empty() {
            return;
        }
        let names: Vec<String> = self.options.enable.clone();
        let mut axes = AxesOfPrograms::default();
        let mut undescribed = Vec::new();
        for input in inputs {
            let config = self.configuration(input.folder());
            match self.plain(config.as_deref()) {
                Ok(loaded) if loaded.machine.axis_set == AxisSet::AsTheyOccur => {
                    undescribed.push(input);
                }
                Ok(loaded) => axes.describe(&loaded.machine),
                // A configuration that cannot be used is reported where a program needs it.
                Err(_) => {}
            }
        }
        axes.look(undescribed, names.iter().map(|name| name.trim()));
        self.ahead = Some(axes);
        self.loaded.clear();
    }

    /// Returns the axes to be assumed that no program has (R9.74); empty before the programs are known.
    pub fn unused_axes(&self) -> Vec<UnknownName> {
        let Some(ahead) = &self.ahead else {
            return Vec::new();
        };
        let names = self.options.enable.iter().map(|name| name.trim());
        let unused = names.filter(|name| !ahead.may_hold(name));
        unused.map(|name| ahead.unknown(name)).collect()
    }

    /// Allows for programs of other runs, which name the usual axes and those that an earlier run left.
    pub fn expect_more(&mut self, left: Vec<String>) {
        if let Some(ahead) = &mut self.ahead {
            ahead.expect_more(left);
        }
    }

    /// Returns the selection of the programs below a folder.
    pub fn selection(&mut self, folder: &Path) -> FolderSelection {
        let options = self.options.folders.clone();
        let config = self.configuration(folder);
        // A configuration that cannot be used is reported where a program needs it.
        let Ok(loaded) = self.plain(config.as_deref()) else {
            return FolderSelection {
                options,
                ..FolderSelection::default()
            };
        };
        let home = loaded.search_path.project.clone();
        FolderSelection {
            extensions: loaded.extensions.clone(),
            options,
            configured: (home, loaded.exclude.clone()),
        }
    }

    /// Reads the configuration and applies the options that differ from it.
    fn load(&self, config: Option<&Path>) -> Result<LoadedMachine, HostError> {
        let options = &self.options;
        let mut loaded = match config {
            Some(path) => self.read_config(path)?,
            None => LoadedMachine::unconfigured(&self.registry),
        };
        loaded.search_path.outside_policy = options.outside_policy;
        if let Some(path) = &options.startup {
            let axes = self.read_startup(path)?;
            loaded.machine = axes.machine;
            loaded.diagnostics = axes.diagnostics;
            loaded.reports = axes.reports;
            loaded.programs = axes.programs;
            loaded.origin = axes.origin;
            loaded.lists = axes.lists;
        }
        loaded.settings.extend(options.settings.iter().cloned());
        Ok(loaded)
    }

    /// Reads a file that describes a machine; the registry has it and its lists even if it has mistakes.
    fn read(&self, path: &Path) -> Result<(SourceFile, ListsOnDisk), HostError> {
        self.registry.reads("configuration", path);
        let lists = ListsOnDisk::new(&self.disk).noting(&self.registry);
        Ok((read_list(path, &self.disk)?, lists))
    }

    /// Reads a `frictcomp.toml` and the lists that it names.
    fn read_config(&self, path: &Path) -> Result<LoadedMachine, HostError> {
        let (text, mut lists) = self.read(path)?;
        match Configuration::from_toml(text, &mut lists) {
            Ok(configuration) => {
                let mut loaded = LoadedMachine::new(configuration, path, &self.registry);
                let allowed_roots =
                    self.options
                        .allowed_roots(path, &loaded.search_path, &self.disk);
                allowed_roots.conceal(&mut loaded.diagnostics);
                Ok(loaded)
            }
            Err(error) => {
                let search_path = SearchPath {
                    project: path.parent().unwrap_or(path).to_owned(),
                    ..SearchPath::default()
                };
                let mut diagnostics = vec![*error.diagnostic];
                let allowed_roots = self.options.allowed_roots(path, &search_path, &self.disk);
                allowed_roots.conceal(&mut diagnostics);
                Err(HostError::Configuration {
                    path: path.to_owned(),
                    diagnostics,
                })
            }
        }
    }

    /// Reads a start-up list and the lists that it names.
    fn read_startup(&self, path: &Path) -> Result<LoadedMachine, HostError> {
        let (text, mut lists) = self.read(path)?;
        let is_xml = is_xml(text.text());
        let configuration = Configuration::from_startup(text, &mut lists);
        let wrong = configuration.diagnostics.iter().find(|said| {
            let whole_file = *said.place.file == *shown_path(path);
            said.code == Code::Fc125 && whole_file && said.place.start().line == 1
        });
        if let Some(wrong) = wrong
            && configuration.machine.axis_set == AxisSet::AsTheyOccur
        {
            let (path, message) = (path.to_owned(), wrong.message.clone());
            return Err(if is_xml {
                HostError::NotAProject { path, message }
            } else {
                HostError::NotAStartupList { path, message }
            });
        }
        let mut loaded = LoadedMachine::new(configuration, path, &self.registry);
        let allowed_roots = self
            .options
            .allowed_roots(path, &loaded.search_path, &self.disk);
        allowed_roots.conceal(&mut loaded.diagnostics);
        Ok(loaded)
    }

    fn nearest(&mut self, folder: &Path) -> Option<PathBuf> {
        if let Some(found) = self.nearest.get(folder) {
            return found.clone();
        }
        let found = nearest_config(folder, &self.disk);
        self.nearest.insert(folder.to_owned(), found.clone());
        found
    }

    /// Returns every machine used so far, in the order of its configuration's path.
    pub fn loaded(&self) -> impl Iterator<Item = &LoadedMachine> {
        self.loaded.values().map(Arc::as_ref)
    }
}

impl MachineOptions {
    /// Returns the folders whose lists are shown: the current one, that of a file and those of programs.
    fn allowed_roots(&self, path: &Path, search_path: &SearchPath, disk: &Disk) -> AllowedRoots {
        let search_path = SearchPath {
            outside_policy: self.outside_policy,
            ..search_path.clone()
        };
        let allowed_roots = search_path.allowed_roots(disk).with(Path::new(""));
        // A file that the user names is where its name says; one that was found may be a link.
        match (&self.configuration, disk.real(path)) {
            (ConfigurationChoice::File(_), Ok(real)) => {
                allowed_roots.with(real.parent().unwrap_or(&real))
            }
            _ => allowed_roots,
        }
    }
}

/// Returns the nearest configuration from a folder upwards, as a path from the current folder.
pub fn nearest_config(folder: &Path, disk: &Disk) -> Option<PathBuf> {
    let found = disk
        .absolute(folder)?
        .ancestors()
        .map(|ancestor| ancestor.join(CONFIG_NAME))
        .find(|candidate| disk.is_file(candidate))?;
    let here = disk.absolute(Path::new(""))?;
    Some(relative(&found, &here))
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
        let nearest = || nearest_config(&deep, &Disk::default()).unwrap();
        let far = nearest();
        assert!(far.ends_with(CONFIG_NAME) && !far.ends_with("a/frictcomp.toml"));
        std::fs::write(root.path().join("a").join(CONFIG_NAME), "").unwrap();
        assert!(nearest().ends_with("a/frictcomp.toml"));
    }

    #[test]
    fn paths_are_seen_from_the_current_folder() {
        let seen = |path, folder| relative(Path::new(path), Path::new(folder));
        assert_eq!(seen("/a/b/c.toml", "/a/b"), Path::new("c.toml"));
        assert_eq!(seen("/a/c.toml", "/a/b/d"), Path::new("../../c.toml"));
        assert_eq!(seen("/a/b/c.toml", "/a"), Path::new("b/c.toml"));
    }
}
