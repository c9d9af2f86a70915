//! The machine that a `frictcomp.toml` describes, by itself or on top of the control's lists.

use std::sync::Arc;

use super::assemble::{AxisDraft, ConfiguredDynamics};
use super::configuration::Configuration;
use super::description::{Machine, Parameters, Setting};
use super::files::{ListFiles, NoLists};
use super::loader::Loader;
use super::programs::canonical_word;
use super::startup::MAX_AXES;
use crate::config::{AxisTable, ConfigError, ConfigFile, ConfiguredVariable, MachineTable};
use crate::lists::{AxisValues, Given, Parameter};
use crate::text::SourceFile;

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
