//! A machine and the other contents of its configuration: what a `frictcomp.toml` describes, by itself or on top of the control's
//! lists.

use std::sync::Arc;

use super::axis::{AxisDraft, AxisReport, ConfiguredDynamics, compare_gantry};
use super::description::{AxisSet, GantrySlave, Machine, Parameters, Setting};
use super::loader::{EmbeddedLists, ListFiles, Loader, NoLists, describe};
use super::programs::canonical_word;
use super::startup::MAX_AXES;
use crate::config::{AxisTable, ConfigError, ConfigFile, ConfiguredVariable, MachineTable};
use crate::diagnostic::{Code, Diagnostic, Levels};
use crate::lists::{
    AxisValues, ChannelSwitch, Conditions, Entries, Given, ListKind, NoProject, Parameter, is_xml,
};
use crate::text::{SourceFile, Span};

/// A machine and the other contents of its configuration.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Configuration {
    /// The machine.
    pub machine: Machine,
    /// The values of variables that only the machine knows.
    pub settings: Vec<(String, Setting)>,
    /// The user's severities, already applied to `diagnostics`.
    pub levels: Levels,
    /// The extensions of files that are programs, in lower case; empty for the usual ones.
    pub extensions: Vec<String>,
    /// Patterns of files and folders that are left out, from the folder of the configuration.
    pub exclude: Vec<String>,
    /// The folders that are searched for called programs, as written.
    pub program_dirs: Vec<String>,
    /// Messages on the lists.
    pub diagnostics: Vec<Diagnostic>,
    /// The lists that were read, named as in diagnostics, in the order of reading.
    pub files: Vec<Arc<str>>,
    /// Number of named lists that do not exist.
    pub missing: usize,
    /// The effective parameters of each axis, in the order of [`Machine::axes`], then those of the
    /// slaves of static gantries.
    pub reports: Vec<AxisReport>,
    /// The programs and macros that the configuration names and the channel list's settings of
    /// motion, each with its place.
    pub programs: Vec<Parameter>,
    /// The lists within a TwinCAT project.
    pub embedded: EmbeddedLists,
}

impl Configuration {
    /// Reads the machine that a start-up list describes, with every list that it names.
    pub fn from_startup(file: SourceFile, files: &mut dyn ListFiles) -> Self {
        let mut configuration = Self::default();
        configuration.read_startup(&Arc::new(file), files);
        configuration
    }

    pub(super) fn read_startup(&mut self, file: &Arc<SourceFile>, files: &mut dyn ListFiles) {
        let mut loader = Loader::new(files);
        if is_xml(file.text()) {
            match loader.project(file) {
                Ok(axes) => {
                    self.machine.axes_are_listed = true;
                    self.assemble(axes, loader);
                }
                Err(error) => {
                    loader.diagnostics.insert(0, not_project(file, &error));
                    self.assemble(Vec::new(), loader);
                }
            }
            return;
        }
        let entries = loader.entries(file);
        if ListKind::detect(&entries) != Some(ListKind::Startup) {
            loader.diagnostics = vec![not_startup(&entries)];
            self.assemble(Vec::new(), loader);
            return;
        }
        let said = ListKind::Startup.check_keys(&entries);
        loader.diagnostics.extend(said);
        let axes = loader.startup(&entries);
        self.machine.axes_are_listed = true;
        self.assemble(axes, loader);
    }

    /// Assembles the axes for the machine's build and takes over the messages about the lists, with
    /// the user's severities.
    pub(super) fn assemble(&mut self, axes: Vec<AxisDraft>, mut loader: Loader<'_>) {
        loader.merge_missing();
        self.diagnostics.extend(loader.diagnostics);
        self.files.extend(loader.names);
        self.missing += loader.missing;
        self.machine.axes_are_listed &= loader.missing == 0 && !axes.is_empty();
        if let Some(channel) = loader.channel {
            let named = &self.machine.programs;
            let programs = channel.programs.parameters(&|role| named.has(role));
            self.programs.extend(programs);
            self.programs.extend(channel.motion.parameters());
            self.machine.programs.add_channel(&channel.programs);
            if channel.settings.has(ChannelSwitch::KeepParameters) {
                self.machine.parameters = Parameters::Kept;
            }
            self.machine.channel = channel.settings;
        }
        let conditions = Conditions {
            build: self.machine.build,
            ..Conditions::default()
        };
        if axes.is_empty() {
            let any = Machine::unconfigured();
            self.machine.axes = any.axes;
            self.machine.axis_set = any.axis_set;
        } else {
            self.machine.axis_set = AxisSet::Configured;
        }
        self.diagnostics.extend(equal_numbers(&axes));
        for draft in axes {
            let (finished, report) = draft.finish(&conditions, &mut self.diagnostics);
            self.machine.axes.push(finished);
            self.reports.push(report);
        }
        for slave in std::mem::take(&mut loader.slaves) {
            self.add_slave(slave, &conditions);
        }
        self.embedded = loader.project;
        self.embedded.explain(&mut self.diagnostics);
        for axis in &mut self.machine.axes {
            let fix = axis.configuring.take();
            axis.configuring = fix.filter(|fix| !self.embedded.holds(&fix.place));
            self.embedded.rename(&mut axis.frict_comp_origin);
        }
        let rows = self.reports.iter_mut().flat_map(|it| &mut it.parameters);
        for row in rows.chain(&mut self.programs) {
            self.embedded.rename(&mut row.origin);
        }
        let levels = &self.levels;
        self.diagnostics
            .retain_mut(|diagnostic| levels.weigh(diagnostic));
    }
}

impl Configuration {
    /// Adds the slave of a static gantry, which is not an axis for programs (R1.43).
    fn add_slave(&mut self, draft: AxisDraft, conditions: &Conditions) {
        let link = draft.values.gantry_master.clone();
        let (slave, report) = draft.finish(conditions, &mut self.diagnostics);
        let number = link.as_ref().map(|link| link.value);
        let mut masters = self.machine.axes.iter();
        let master = masters.find(|axis| axis.number.is_some() && axis.number == number);
        if let (Some(master), Some(link)) = (master, &link) {
            self.diagnostics
                .extend(compare_gantry(master, &slave, link));
        }
        self.machine.gantry_slaves.push(GantrySlave {
            master: master.map(|axis| axis.name.clone()),
            name: slave.name,
        });
        self.reports.push(report);
    }
}

/// Returns FC125 for a file that is given as a project but is none, or has no CNC (R3.43).
pub(super) fn not_project(file: &SourceFile, error: &NoProject) -> Diagnostic {
    let line = file.lines().line(error.span.start);
    let message = match line {
        1 => format!("`{}` is {error}", file.name()),
        line => format!("`{}`, line {line}: {error}", file.name()),
    };
    Diagnostic::new(Code::Fc125, file.place(Span::new(0, 0)), message).with_help(
        "a project (`.tsproj`, `.xti`, an exported tree item) has a CNC, whose items hold its lists",
    )
}

/// Returns FC125 for a file that is given as a start-up list but names no lists.
fn not_startup(entries: &Entries) -> Diagnostic {
    let source = entries.source();
    let what = describe(entries);
    let message = format!("`{}` is {what}, not a start-up list", source.name());
    Diagnostic::new(Code::Fc125, source.place(Span::new(0, 0)), message)
        .with_help("a start-up list (`hochlauf.lis`) names the lists of the axes and channels")
}

/// Returns FC124 for each axis whose logical number an earlier one has, too: what names an axis by its number takes the
/// first.
fn equal_numbers(axes: &[AxisDraft]) -> impl Iterator<Item = Diagnostic> {
    axes.iter().enumerate().filter_map(|(at, axis)| {
        let number = axis.values.number.as_ref()?;
        let numbered = |it: &&AxisDraft| {
            let own = it.values.number.as_ref();
            own.is_some_and(|own| own.value == number.value)
        };
        let first = axes[..at].iter().find(numbered)?;
        let message = format!(
            "axes `{}` and `{}` have the same number {}",
            first.name, axis.name, number.value
        );
        let label = first.values.number.as_ref()?.place();
        let said = Diagnostic::new(Code::Fc124, number.place(), message)
            .with_label(label, "the other axis")
            .with_help(
                "give each axis its own number; value lists, couplings and axis exchange by number take the first",
            );
        Some(said)
    })
}

impl Configuration {
    /// Reads the machine that a `frictcomp.toml` describes, with every list that it names. The
    /// file's own values override the lists.
    ///
    /// # Errors
    /// The file is not TOML, or has an unknown key or value.
    pub fn from_toml(file: SourceFile, files: &mut dyn ListFiles) -> Result<Self, ConfigError> {
        let file = ConfigFile::parse(&Arc::new(file))?;
        let mut configuration = Self {
            settings: file.variables.into_iter().map(setting).collect(),
            levels: file.levels,
            extensions: file.extensions,
            exclude: file.exclude,
            ..Self::default()
        };
        let startup = file.machine.axes.clone();
        let is_whole = startup.is_none() && file.axes.len() < MAX_AXES;
        configuration.machine.stable = file.stable;
        configuration.machine.own = file.own;
        configuration.machine.readings = file.readings;
        configuration.machine.one_more_axis = file.one_more_axis.filter(|_| is_whole);
        configuration.take_machine(file.machine)?;
        let mut loader = Loader::new(files);
        let listed = startup.and_then(|asked| loader.axes(&asked));
        configuration.machine.axes_are_listed = listed.is_some();
        let mut axes = listed.unwrap_or_default();
        for table in file.axes {
            if axes.len() >= MAX_AXES {
                let message = format!("a machine has at most {MAX_AXES} axes");
                return Err(ConfigError::at(&table.name, message));
            }
            let found = axes.iter().position(|axis| axis.name == table.name.value);
            let at = found.unwrap_or_else(|| {
                let name = table.name.value.clone();
                axes.push(AxisDraft::new(name, AxisValues::default()));
                axes.len() - 1
            });
            axes[at].take_table(table, &mut loader);
        }
        configuration.assemble(axes, loader);
        Ok(configuration)
    }

    fn take_machine(&mut self, table: MachineTable) -> Result<(), ConfigError> {
        for given in &table.harmless {
            if !self.machine.harmless.add(&given.value) {
                let message = format!(
                    "`{}` is neither a `#` command nor a G or M function",
                    given.value
                );
                return Err(ConfigError::at(given, message)
                    .with_help("write `harmless = [\"#MYCMD\", \"M100\"]`"));
            }
        }
        self.machine.cycle_time_ms = table.cycle_time_ms;
        self.machine.build = table.build;
        self.machine.skip = table.skip;
        self.program_dirs.clone_from(&table.program_dirs);
        if table.keep_parameters {
            self.machine.parameters = Parameters::Kept;
        }
        self.take_programs(table);
        Ok(())
    }

    /// Takes the programs that run by themselves, are called by words, or exist only on the
    /// machine.
    fn take_programs(&mut self, table: MachineTable) {
        let mut named = |number, key: String, given: Given<String>| {
            self.programs.push(Parameter {
                number,
                key,
                value: given.value.clone(),
                unit: "",
                origin: (&given).into(),
            });
            given.value
        };
        let programs = &mut self.machine.programs;
        programs.start = (table.start_program)
            .map(|given| named("P-CHAN-00119", "start_program".to_owned(), given));
        programs.end =
            (table.end_program).map(|given| named("P-CHAN-00252", "end_program".to_owned(), given));
        for (word, given) in table.words {
            let key = format!("programs.{word}");
            let program = named("", key, given);
            programs.words.push((canonical_word(&word), program));
        }
        programs.external = table.external;
        programs.keep_compensation = table.keep_compensation;
        programs.keep_positions = table.keep_positions;
        programs.keep_parameters = table.external_parameters;
    }
}

fn setting((name, value): (String, ConfiguredVariable)) -> (String, Setting) {
    let setting = match value {
        ConfiguredVariable::Number(number) => Setting::Number(number),
        ConfiguredVariable::Text(text) => Setting::Text(text),
    };
    (name, setting)
}

impl AxisDraft {
    /// Replaces values of the lists by those of the user's table.
    fn take_table(&mut self, table: AxisTable, loader: &mut Loader<'_>) {
        let list = table.axis_list.as_ref();
        if let Some(values) = list.and_then(|asked| loader.axis_list(asked)) {
            self.add_list(values);
        }
        let list = table.value_list.as_ref();
        if let Some(list) = list.and_then(|asked| loader.value_list(asked)) {
            self.value_list = list;
            self.startup_number = None;
            self.unnumbered = None;
        }
        if let Some(inline) = table.inline_list {
            self.value_list.friction.override_with(inline);
        }
        self.values.override_with(table.values);
        self.enabled = table.enabled;
        self.dynamics = ConfiguredDynamics {
            velocity: table.max_velocity,
            acceleration: table.max_acceleration,
            jerk: table.max_jerk,
            lead: table.lead,
        };
    }
}

impl Machine {
    /// Reads the machine that the text of a `frictcomp.toml` describes by itself, without lists.
    ///
    /// ```
    /// use frictcomp::comp::Kind;
    /// use frictcomp::machine::Machine;
    ///
    /// let machine = Machine::from_toml("[[axis]]\nname = \"X\"\nfrict_comp = true\n")?;
    /// assert!(machine.axes[0].configured.contains(Kind::Frict));
    /// # Ok::<(), frictcomp::config::ConfigError>(())
    /// ```
    ///
    /// # Errors
    /// The text is not TOML, or has an unknown key or value.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        let file = SourceFile::new("frictcomp.toml", text);
        Ok(Configuration::from_toml(file, &mut NoLists)?.machine)
    }
}
