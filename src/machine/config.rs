//! `frictcomp.toml`: the machine as its user writes it down, by itself or over the control's
//! lists.

use std::sync::Arc;

use thiserror::Error;

use super::advice::no_toml;
use super::assemble::{AxisDraft, Dynamics};
use super::load::{AXIS_NAME_HELP, Loader, MAX_AXES, is_axis_name};
use super::resolve::{ListFiles, NoLists};
use super::section::{ROOT, Section, Shape};
use super::{Configuration, Machine, Parameters, Setting, canonical_word};
use crate::comp::{Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, Label, Levels, Severity, did_you_mean};
use crate::lists::{
    AxisType, AxisValues, Field, FrictionDraft, Given, ListKind, Parameter, Written, WrittenPoint,
};
use crate::text::{SourceFile, Span};

/// A `frictcomp.toml` that cannot be used: it is no TOML, or says something that does not exist.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}:{}: {}", .diagnostic.place.file, .diagnostic.place.start(), .diagnostic.message)]
pub struct ConfigError {
    /// FC110 with the place.
    pub diagnostic: Box<Diagnostic>,
}

impl ConfigError {
    pub(crate) fn new(source: &SourceFile, span: Span, message: impl Into<String>) -> Self {
        let place = source.place(span);
        Self {
            diagnostic: Box::new(Diagnostic::new(Code::Fc110, place, message)),
        }
    }

    pub(crate) fn at<T>(given: &Given<T>, message: impl Into<String>) -> Self {
        Self {
            diagnostic: Box::new(Diagnostic::new(Code::Fc110, given.place(), message)),
        }
    }

    pub(crate) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.diagnostic.help.push(help.into());
        self
    }

    /// The same with "did you mean" where a known word is near.
    pub(crate) fn with_near<'a>(
        self,
        found: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        match did_you_mean(found, known) {
            Some(meant) => self.with_help(format!("did you mean `{meant}`?")),
            None => self,
        }
    }
}

impl Configuration {
    /// The machine that a `frictcomp.toml` describes, with every list that it names. What the file
    /// itself says overrides the lists.
    ///
    /// # Errors
    /// The file is no TOML, or has a key or a value that does not exist.
    pub fn from_toml(file: SourceFile, files: &mut dyn ListFiles) -> Result<Self, ConfigError> {
        let source = Arc::new(file);
        let table = toml::de::DeTable::parse(source.text());
        let table = table.map_err(|error| no_toml(&source, &error))?;
        let root = Section::new(table.get_ref(), &source, &ROOT)?;

        let mut configuration = Self::default();
        let machine = root.table("machine", &MACHINE)?;
        if let Some(machine) = &machine {
            configuration.read_machine(machine)?;
        }
        configuration.settings = settings(&root)?;
        configuration.levels = levels(&root)?;
        configuration.extensions = extensions(&root)?;

        let mut loader = Loader::new(files);
        let startup = match &machine {
            Some(machine) => machine.string("startup")?,
            None => None,
        };
        let mut axes = match startup.and_then(|asked| loader.load(&asked, ListKind::Startup)) {
            Some(entries) => loader.startup(&entries),
            None => Vec::new(),
        };
        let mut named: Vec<Given<String>> = Vec::new();
        for section in root.tables("axis", &AXIS)? {
            let name = axis_name(&section, &named)?;
            if axes.len() >= MAX_AXES {
                let message = format!("a machine has at most {MAX_AXES} axes");
                return Err(ConfigError::at(&name, message));
            }
            let found = axes.iter().position(|axis| axis.name == name.value);
            let at = found.unwrap_or_else(|| {
                axes.push(AxisDraft::new(name.value.clone(), AxisValues::default()));
                axes.len() - 1
            });
            read_axis(&section, &mut axes[at], &mut loader)?;
            axes[at].values.name = Some(name.clone());
            named.push(name);
        }
        configuration.assemble(axes, loader);
        Ok(configuration)
    }

    fn read_machine(&mut self, section: &Section<'_>) -> Result<(), ConfigError> {
        self.machine.cycle_time_ms = section.positive("cycle_time_ms")?;
        if let Some(build) = section.string("cnc_build")? {
            let parsed = build.value.parse();
            let parsed =
                parsed.map_err(|e: crate::comp::NoBuild| ConfigError::at(&build, e.to_string()));
            self.machine.build = Some(parsed?);
        }
        let dirs = section.strings("program_dirs")?;
        self.program_dirs = dirs.into_iter().map(|dir| dir.value).collect();
        self.read_programs(section)?;
        for given in section.strings("harmless")? {
            if !self.machine.harmless.add(&given.value) {
                let message = format!(
                    "`{}` is neither a `#` command nor an M function",
                    given.value
                );
                return Err(ConfigError::at(&given, message)
                    .with_help("write `harmless = [\"#MYCMD\", \"M100\"]`"));
            }
        }
        if section
            .truth("keep_parameters")?
            .is_some_and(|given| given.value)
        {
            self.machine.parameters = Parameters::Kept;
        }
        Ok(())
    }

    /// The programs that run by themselves, stand behind words, or are on the machine only.
    fn read_programs(&mut self, section: &Section<'_>) -> Result<(), ConfigError> {
        let mut rows = Vec::new();
        let mut named = |number, key: &str, given: &Given<String>| {
            rows.push(Parameter {
                number,
                key: key.to_owned(),
                value: given.value.clone(),
                unit: "",
                origin: given.into(),
            });
            given.value.clone()
        };
        let programs = &mut self.machine.programs;
        let start = section.string("start_program")?;
        programs.start = start.map(|given| named("P-CHAN-00119", "start_program", &given));
        let end = section.string("end_program")?;
        programs.end = end.map(|given| named("P-CHAN-00252", "end_program", &given));
        if let Some(words) = section.table("programs", &WORDS)? {
            for name in words.names() {
                if let Some(given) = words.string(name.value)? {
                    let word = canonical_word(name.value);
                    let key = format!("programs.{}", name.value);
                    programs.words.push((word, named("", &key, &given)));
                }
            }
        }
        let patterns = section.strings("external")?;
        programs.external = patterns.into_iter().map(|given| given.value).collect();
        if let Some(keeps) = section.table("external_keeps", &EXTERNAL_KEEPS)? {
            programs.keep_compensation = kept(&keeps, "compensation", &programs.external)?;
            programs.keep_positions = kept(&keeps, "positions", &programs.external)?;
        }
        self.programs = rows;
        Ok(())
    }
}

/// The programs that keep something: all that are on the machine only, none, or those that match.
fn kept(keeps: &Section<'_>, key: &str, all: &[String]) -> Result<Vec<String>, ConfigError> {
    if let Ok(on) = keeps.truth(key) {
        let all = on.filter(|on| on.value).map(|_| all.to_vec());
        return Ok(all.unwrap_or_default());
    }
    let patterns = keeps.strings(key)?;
    Ok(patterns.into_iter().map(|given| given.value).collect())
}

impl Machine {
    /// The machine that the text of a `frictcomp.toml` describes by itself, without lists.
    ///
    /// ```
    /// use frictcomp::machine::Machine;
    /// use frictcomp::comp::Kind;
    ///
    /// let machine = Machine::from_toml("[[axis]]\nname = \"X\"\nfrict_comp = true\n")?;
    /// assert!(machine.axes[0].configured.contains(Kind::Frict));
    /// # Ok::<(), frictcomp::machine::ConfigError>(())
    /// ```
    ///
    /// # Errors
    /// The text is no TOML, or has a key or a value that does not exist.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        let file = SourceFile::new("frictcomp.toml", text);
        Ok(Configuration::from_toml(file, &mut NoLists)?.machine)
    }
}

const MACHINE: Shape = Shape {
    name: "[machine]",
    keys: Some(&[
        "startup",
        "cycle_time_ms",
        "cnc_build",
        "program_dirs",
        "start_program",
        "end_program",
        "keep_parameters",
        "programs",
        "external",
        "external_keeps",
        "harmless",
    ]),
};

const EXTERNAL_KEEPS: Shape = Shape {
    name: "[machine.external_keeps]",
    keys: Some(&["compensation", "positions"]),
};

const WORDS: Shape = Shape {
    name: "[machine.programs]",
    keys: None,
};

const AXIS: Shape = Shape {
    name: "[[axis]]",
    keys: Some(&[
        "name",
        "type",
        "number",
        "frict_comp",
        "enable",
        "axis_list",
        "value_list",
        "value",
        "compensations",
        "manual_activation",
        "required",
        "max_velocity",
        "max_acceleration",
        "max_jerk",
    ]),
};

const VALUE: Shape = Shape {
    name: "[axis.value]",
    keys: Some(&[
        "mode",
        "max_points",
        "table_entries",
        "position_delay",
        "reversal_lookahead",
        "scaling_factor",
        "delay_cycles",
        "table",
    ]),
};

const VARIABLES: Shape = Shape {
    name: "[variables]",
    keys: None,
};

const LINT: Shape = Shape {
    name: "[lint]",
    keys: None,
};

const CHECK: Shape = Shape {
    name: "[check]",
    keys: Some(&["extensions"]),
};

/// The extensions of programs, in lower case and without a dot.
fn extensions(root: &Section<'_>) -> Result<Vec<String>, ConfigError> {
    let Some(check) = root.table("check", &CHECK)? else {
        return Ok(Vec::new());
    };
    let extension = |given: Given<String>| {
        let text = given.value.trim_start_matches('.').to_ascii_lowercase();
        let is_one = !text.is_empty() && !text.contains(['.', '/', '\\', '*', ' ']);
        if is_one {
            return Ok(text);
        }
        let message = format!("`{}` is not a file extension", given.value);
        Err(ConfigError::at(&given, message).with_help("write `extensions = [\"nc\", \"spf\"]`"))
    };
    let given = check.strings("extensions")?;
    given.into_iter().map(extension).collect()
}

fn settings(root: &Section<'_>) -> Result<Vec<(String, Setting)>, ConfigError> {
    let Some(variables) = root.table("variables", &VARIABLES)? else {
        return Ok(Vec::new());
    };
    let mut settings = Vec::new();
    for name in variables.names() {
        let setting = match variables.number(name.value) {
            Some(Given {
                value:
                    Written {
                        number: Some(number),
                        ..
                    },
                ..
            }) => Setting::Number(number.to_f64()),
            _ => match variables.string(name.value) {
                Ok(Some(text)) => Setting::Text(text.value),
                _ => return Err(no_variable(&variables, &name)),
            },
        };
        settings.push((name.value.to_owned(), setting));
    }
    Ok(settings)
}

/// A variable that is neither a number nor a text; most often its name lacks the quotes, so that
/// TOML takes its parts as tables.
fn no_variable(variables: &Section<'_>, name: &Given<&str>) -> ConfigError {
    match variables.dotted(name.value) {
        Some((dotted, value)) => {
            ConfigError::at(name, format!("the name `{dotted}` has no quotes"))
                .with_help(format!("write `\"{dotted}\" = {value}`"))
        }
        None => ConfigError::at(
            name,
            format!("`{}` is neither a number nor a text", name.value),
        )
        .with_help(format!("write `\"{}\" = 3` or `= \"TEXT\"`", name.value)),
    }
}

fn levels(root: &Section<'_>) -> Result<Levels, ConfigError> {
    let mut levels = Levels::default();
    let Some(lint) = root.table("lint", &LINT)? else {
        return Ok(levels);
    };
    for name in lint.names() {
        let Some(code) = Code::find(name.value) else {
            let message = format!("there is no diagnostic `{}`", name.value);
            let known = Code::ALL.iter().map(|code| code.text());
            return Err(ConfigError::at(&name, message).with_near(name.value, known));
        };
        let Some(word) = lint.string(name.value)? else {
            continue;
        };
        let level = match word.value.as_str() {
            "off" => None,
            "info" => Some(Severity::Info),
            "warning" => Some(Severity::Warning),
            "error" => Some(Severity::Error),
            other => {
                let message = format!("`{other}` is not a severity");
                return Err(ConfigError::at(&word, message)
                    .with_near(other, ["off", "info", "warning", "error"])
                    .with_help("write `off`, `info`, `warning` or `error`"));
            }
        };
        if !levels.set(code, level) {
            let message = format!("{code} is an error of the control, it keeps its severity");
            return Err(ConfigError::at(&name, message)
                .with_help("only codes that begin with `FC` may be changed"));
        }
    }
    Ok(levels)
}

/// The name of an axis; every `[[axis]]` has one of its own.
fn axis_name(section: &Section<'_>, named: &[Given<String>]) -> Result<Given<String>, ConfigError> {
    let Some(name) = section.string("name")? else {
        let message = "an axis needs a `name`";
        return Err(ConfigError::at(&section.whole(), message).with_help("add `name = \"X\"`"));
    };
    if !is_axis_name(&name.value) {
        let message = format!("`{}` is not an axis name", name.value);
        return Err(ConfigError::at(&name, message).with_help(AXIS_NAME_HELP));
    }
    if let Some(other) = named.iter().find(|other| other.value == name.value) {
        let message = format!("there are two axes `{}`", name.value);
        let mut error = ConfigError::at(&name, message).with_help("remove one of them");
        let label = Label {
            place: other.place(),
            text: "the first one".to_owned(),
        };
        error.diagnostic.labels.push(label);
        return Err(error);
    }
    Ok(name)
}

fn read_axis(
    section: &Section<'_>,
    axis: &mut AxisDraft,
    loader: &mut Loader<'_>,
) -> Result<(), ConfigError> {
    if let Some(list) = section.string("axis_list")?
        && let Some(values) = loader.axis_list(&list)
    {
        axis.add_list(values);
    }
    if let Some(asked) = section.string("value_list")?
        && let Some(list) = loader.value_list(&asked)
    {
        axis.value_list = list;
        axis.startup_number = None;
    }
    if let Some(inline) = section.table("value", &VALUE)? {
        let draft = inline_values(&inline)?;
        axis.value_list.friction.override_with(draft);
    }
    let values = &mut axis.values;
    if let Some(letter) = section.string("type")? {
        let axis_type = AxisType::from_letter(&letter.value);
        let axis_type = axis_type.ok_or_else(|| {
            ConfigError::at(&letter, format!("`{}` is not an axis type", letter.value))
                .with_help("write `T` for linear, `R` for rotary, `S` for a spindle")
        })?;
        values.axis_type = Some(letter.with(axis_type));
    }
    if let Some(number) = section.whole_number("number")? {
        values.number = Some(number);
    }
    for (kind, given) in kinds(section, "compensations")? {
        values.selectors.insert(kind, given.with(true));
    }
    if let Some(on) = section.truth("frict_comp")? {
        values.selectors.insert(Kind::Frict, on);
    }
    axis.enabled = section.truth("enable")?.is_some_and(|given| given.value);
    for (kind, given) in kinds(section, "manual_activation")? {
        if kind.facts().manual_activation.is_none() {
            let message = format!("{} has no manual activation", kind.keyword());
            let others = Kind::ALL
                .into_iter()
                .filter(|k| k.facts().manual_activation.is_some());
            let others: Vec<_> = others.map(Kind::keyword).collect();
            return Err(ConfigError::at(&given, message)
                .with_help(format!("the kinds that have one are {}", others.join(", "))));
        }
        values.manual.insert(kind, given.with(true));
    }
    if let Some(whole) = section.given("required") {
        let required: KindSet = kinds(section, "required")?
            .into_iter()
            .map(|(kind, _)| kind)
            .collect();
        values.required = Some(whole.with(required));
    }
    axis.dynamics = Dynamics {
        velocity: section.positive("max_velocity")?,
        acceleration: section.positive("max_acceleration")?,
        jerk: section.positive("max_jerk")?,
    };
    Ok(())
}

/// A list of compensation keywords.
fn kinds(section: &Section<'_>, key: &str) -> Result<Vec<(Kind, Given<String>)>, ConfigError> {
    let mut found = Vec::new();
    for word in section.strings(key)? {
        let kind = Kind::from_keyword(&word.value).ok_or_else(|| {
            let message = format!("`{}` is not a kind of compensation", word.value);
            ConfigError::at(&word, message).with_near(&word.value, Kind::ALL.map(Kind::keyword))
        })?;
        found.push((kind, word));
    }
    Ok(found)
}

/// The value list that stands in `frictcomp.toml` itself. Its values have the names, units,
/// defaults and checks of a list.
fn inline_values(section: &Section<'_>) -> Result<FrictionDraft, ConfigError> {
    let mut draft = FrictionDraft::default();
    if let (Some(whole), Some(pairs)) = (section.given("table"), section.number_pairs("table")?) {
        let points = pairs
            .into_iter()
            .map(|[input, output]| WrittenPoint {
                input: Some(input),
                output: Some(output),
            })
            .collect();
        draft.set_table(points, &whole);
    }
    for field in Field::ALL {
        if section.given(field.name()).is_none() {
            continue;
        }
        let Some(number) = section.number(field.name()) else {
            return Err(section.no_number(field.name()));
        };
        draft.set(field, number);
    }
    Ok(draft)
}
