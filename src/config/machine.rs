//! The tables `[machine]`, `[reading]` and `[confirmed]` of `frictcomp.toml` (R15.2), each `[[axis]]`, and the place for one more.

use super::section::{ConfigError, Section, Shape};
use crate::comp::{CncBuild, Kind, KindSet, NoBuild};
use crate::diagnostic::{Label, NamedFix};
use crate::lists::{
    AXIS_NAME_HELP, AxisValues, Field, FrictionDraft, Given, Monitor, UnknownAxisType,
    WrittenPoint, is_axis_name,
};
use crate::readings::{Confirmation, Question, Readings};
use crate::syntax::SkipLevels;
use crate::text::Span;

/// Contents of `[machine]`.
#[derive(Debug, Clone, Default)]
pub(crate) struct MachineTable {
    /// The start-up list or the project that describes the axes.
    pub(crate) axes: Option<Given<String>>,
    /// The CNC cycle in milliseconds.
    pub(crate) cycle_time_ms: Option<f64>,
    /// The kernel version.
    pub(crate) build: Option<CncBuild>,
    /// The folders of called programs.
    pub(crate) program_dirs: Vec<String>,
    /// The program that runs before every main program.
    pub(crate) start_program: Option<Given<String>>,
    /// The program that runs before the end of every main program.
    pub(crate) end_program: Option<Given<String>>,
    /// Words and the programs that they call, `[machine.programs]`.
    pub(crate) words: Vec<(String, Given<String>)>,
    /// Patterns of programs that only the machine has.
    pub(crate) external: Vec<String>,
    /// Patterns of those that keep compensation states, `[machine.external_keeps]`.
    pub(crate) keep_compensation: Vec<String>,
    /// Patterns of those that keep positions.
    pub(crate) keep_positions: Vec<String>,
    /// Patterns of those that write neither parameters nor variables.
    pub(crate) external_parameters: Vec<String>,
    /// Words of the shop that change nothing.
    pub(crate) harmless: Vec<Given<String>>,
    /// Whether P parameters outlive a program.
    pub(crate) keep_parameters: bool,
    /// The skip levels that are on.
    pub(crate) skip: Option<SkipLevels>,
}

pub(super) const MACHINE: Shape = Shape {
    name: "[machine]",
    keys: Some(&[
        "startup",
        "project",
        "cycle_time_ms",
        "cnc_build",
        "program_dirs",
        "start_program",
        "end_program",
        "keep_parameters",
        "skip",
        "programs",
        "external",
        "external_keeps",
        "harmless",
    ]),
};

pub(super) const EXTERNAL_KEEPS: Shape = Shape {
    name: "[machine.external_keeps]",
    keys: Some(&["compensation", "positions", "parameters"]),
};

pub(super) const WORDS: Shape = Shape {
    name: "[machine.programs]",
    keys: None,
};

impl MachineTable {
    /// Reads the table from the whole file; a missing table is not an error.
    pub(super) fn read(root: &Section<'_>) -> Result<Self, ConfigError> {
        let Some(section) = root.table("machine", &MACHINE)? else {
            return Ok(Self::default());
        };
        let dirs = section.strings("program_dirs")?;
        let mut table = Self {
            axes: axes(&section)?,
            cycle_time_ms: section.positive("cycle_time_ms")?,
            build: build(&section)?,
            program_dirs: dirs.into_iter().map(|dir| dir.value).collect(),
            start_program: section.string("start_program")?,
            end_program: section.string("end_program")?,
            words: words(&section)?,
            harmless: section.strings("harmless")?,
            keep_parameters: section
                .truth("keep_parameters")?
                .is_some_and(|given| given.value),
            skip: section.skip_levels("skip")?,
            ..Self::default()
        };
        let patterns = section.strings("external")?;
        table.external = patterns.into_iter().map(|given| given.value).collect();
        if let Some(keeps) = section.table("external_keeps", &EXTERNAL_KEEPS)? {
            table.keep_compensation = kept(&keeps, "compensation", &table.external)?;
            table.keep_positions = kept(&keeps, "positions", &table.external)?;
            table.external_parameters = kept(&keeps, "parameters", &table.external)?;
        }
        Ok(table)
    }
}

/// Reads the file that describes the axes: a start-up list, or a project (R3.42).
fn axes(section: &Section<'_>) -> Result<Option<Given<String>>, ConfigError> {
    match (section.string("startup")?, section.string("project")?) {
        (Some(_), Some(project)) => {
            let message = "a machine has a `startup` list or a `project`, not both";
            Err(ConfigError::at(&project, message.to_owned()))
        }
        (startup, project) => Ok(startup.or(project)),
    }
}

fn build(section: &Section<'_>) -> Result<Option<CncBuild>, ConfigError> {
    let Some(build) = section.string("cnc_build")? else {
        return Ok(None);
    };
    let refused = |error: NoBuild| ConfigError::at(&build, error.to_string());
    build.value.parse().map(Some).map_err(refused)
}

fn words(section: &Section<'_>) -> Result<Vec<(String, Given<String>)>, ConfigError> {
    let mut words = Vec::new();
    if let Some(programs) = section.table("programs", &WORDS)? {
        for name in programs.names() {
            if let Some(program) = programs.string(name.value)? {
                words.push((name.value.to_owned(), program));
            }
        }
    }
    Ok(words)
}

/// Returns the programs that keep something: all that exist only on the machine, none, or those
/// that match.
fn kept(keeps: &Section<'_>, key: &str, all: &[String]) -> Result<Vec<String>, ConfigError> {
    if let Ok(on) = keeps.truth(key) {
        let all = on.filter(|on| on.value).map(|_| all.to_vec());
        return Ok(all.unwrap_or_default());
    }
    let patterns = keeps.strings(key)?;
    Ok(patterns.into_iter().map(|given| given.value).collect())
}

pub(super) const READING: Shape = Shape {
    name: "[reading]",
    keys: None,
};

pub(super) const CONFIRMED: Shape = Shape {
    name: "[confirmed]",
    keys: None,
};

pub(super) const CONFIRMATION: Shape = Shape {
    name: "an answer of [confirmed]",
    keys: Some(&["build", "date"]),
};

/// Reads the selected reading of each open question.
pub(super) fn selected_readings(root: &Section<'_>) -> Result<Readings, ConfigError> {
    let mut readings = Readings::default();
    if let Some(section) = root.table("reading", &READING)? {
        for key in section.names() {
            let question = question(&section, &key)?;
            let Some(name) = section.string(key.value)? else {
                continue;
            };
            let reading = question.reading(&name.value);
            let reading = reading.ok_or_else(|| no_reading(question, &name))?;
            readings.select(question, reading);
        }
    }
    if let Some(section) = root.table("confirmed", &CONFIRMED)? {
        for key in section.names() {
            let question = question(&section, &key)?;
            if let Some(answer) = section.table(key.value, &CONFIRMATION)? {
                readings.confirm(question, confirmation(&answer)?);
            }
        }
    }
    Ok(readings)
}

fn question(section: &Section<'_>, key: &Given<&str>) -> Result<Question, ConfigError> {
    if let Some(question) = Question::of_rule(key.value) {
        return Ok(question);
    }
    let is_quoted = key.value.contains('.');
    if let Some((dotted, value)) = section.dotted(key.value).filter(|_| !is_quoted) {
        let error = ConfigError::at(key, format!("the rule `{dotted}` has no quotes"));
        return Err(error.with_help(format!("write `\"{dotted}\" = {value}`")));
    }
    let rules = Question::ALL.map(|question| question.facts().rule);
    let error = ConfigError::at(key, format!("no open question belongs to `{}`", key.value));
    let error = error.with_near(key.value, rules);
    Err(error.with_help(format!("the questions are those of {}", rules.join(", "))))
}

fn no_reading(question: Question, name: &Given<String>) -> ConfigError {
    let facts = question.facts();
    let [first, second] = facts.readings;
    let message = format!("`{}` is not a reading of {}", name.value, facts.rule);
    let error = ConfigError::at(name, message).with_near(&name.value, facts.readings);
    error.with_help(format!("its readings are `{first}` and `{second}`"))
}

fn confirmation(answer: &Section<'_>) -> Result<Confirmation, ConfigError> {
    let missing = |key: &str| {
        ConfigError::at(&answer.whole(), format!("`{key}` is missing"))
            .with_help("write `{ build = \"3.1.3081.5\", date = \"2026-01-31\" }`")
    };
    let build = answer.string("build")?.ok_or_else(|| missing("build"))?;
    let refused = |error: NoBuild| ConfigError::at(&build, error.to_string());
    let parsed = build.value.parse().map_err(refused)?;
    let date = answer.string("date")?.ok_or_else(|| missing("date"))?;
    Ok(Confirmation {
        build: parsed,
        date: date.value,
    })
}

/// Contents of `[[axis]]`.
#[derive(Debug, Clone)]
pub(crate) struct AxisTable {
    /// The name in NC programs.
    pub(crate) name: Given<String>,
    /// The axis list.
    pub(crate) axis_list: Option<Given<String>>,
    /// The value list.
    pub(crate) value_list: Option<Given<String>>,
    /// The value list written in the file itself, `[axis.value]`.
    pub(crate) inline_list: Option<FrictionDraft>,
    /// Values that an axis list may give as well.
    pub(crate) values: AxisValues,
    /// Set if compensation is assumed.
    pub(crate) enabled: Option<Given<bool>>,
    /// The maximum velocity in mm/min or °/min.
    pub(crate) max_velocity: Option<f64>,
    /// The maximum acceleration in m/s² or °/s².
    pub(crate) max_acceleration: Option<f64>,
    /// The maximum jerk in m/s³ or °/s³.
    pub(crate) max_jerk: Option<f64>,
    /// The way in mm in a turn of the motor.
    pub(crate) lead: Option<f64>,
}

pub(super) const AXIS: Shape = Shape {
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
        "lead",
    ]),
};

pub(super) const VALUE: Shape = Shape {
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

impl AxisTable {
    /// Reads the tables of the whole file; no two have the same name.
    pub(super) fn read_all(root: &Section<'_>) -> Result<Vec<Self>, ConfigError> {
        let mut tables: Vec<Self> = Vec::new();
        for section in root.tables("axis", &AXIS)? {
            let name = name(&section)?;
            let mut others = tables.iter().map(|table| &table.name);
            if let Some(other) = others.find(|other| other.value == name.value) {
                return Err(named_twice(&name, other));
            }
            tables.push(Self::read(&section, name)?);
        }
        Ok(tables)
    }

    fn read(section: &Section<'_>, name: Given<String>) -> Result<Self, ConfigError> {
        let inline_list = section.table("value", &VALUE)?;
        Ok(Self {
            axis_list: section.string("axis_list")?,
            value_list: section.string("value_list")?,
            inline_list: inline_list.as_ref().map(inline_values).transpose()?,
            values: AxisValues {
                name: Some(name.clone()),
                ..values(section)?
            },
            enabled: section.truth("enable")?.filter(|given| given.value),
            max_velocity: section.positive("max_velocity")?,
            max_acceleration: section.positive("max_acceleration")?,
            max_jerk: section.positive("max_jerk")?,
            lead: section.positive("lead")?,
            name,
        })
    }
}

fn name(section: &Section<'_>) -> Result<Given<String>, ConfigError> {
    let Some(name) = section.string("name")? else {
        let message = "an axis needs a `name`";
        return Err(ConfigError::at(&section.whole(), message).with_help("add `name = \"X\"`"));
    };
    if is_axis_name(&name.value) {
        return Ok(name);
    }
    let message = format!("`{}` is not an axis name", name.value);
    Err(ConfigError::at(&name, message).with_help(AXIS_NAME_HELP))
}

fn named_twice(name: &Given<String>, first: &Given<String>) -> ConfigError {
    let message = format!("there are two axes `{}`", name.value);
    let mut error = ConfigError::at(name, message).with_help("remove one of them");
    error.diagnostic.labels.push(Label {
        place: first.place(),
        text: "the first one".to_owned(),
    });
    error
}

fn values(section: &Section<'_>) -> Result<AxisValues, ConfigError> {
    let mut values = AxisValues {
        number: section.whole_number("number")?,
        ..AxisValues::default()
    };
    if let Some(letter) = section.string("type")? {
        let axis_type = letter.value.parse().map_err(|error: UnknownAxisType| {
            ConfigError::at(&letter, error.to_string())
                .with_help("write `T` for linear, `R` for rotary, `S` for a spindle")
        })?;
        values.axis_type = Some(letter.with(axis_type));
    }
    for (kind, given) in kinds(section, "compensations")? {
        values.selectors.insert(kind, given.with(true));
    }
    if let Some(on) = section.truth("frict_comp")? {
        values.selectors.insert(Kind::Frict, on);
    }
    for (kind, given) in kinds(section, "manual_activation")? {
        if kind.facts().manual_activation.is_none() {
            return Err(no_manual_activation(kind, &given));
        }
        values.manual.insert(kind, given.with(true));
    }
    if let Some(whole) = section.given("required") {
        let required = kinds(section, "required")?.into_iter();
        let required: KindSet = required.map(|(kind, _)| kind).collect();
        values.required = Some(whole.with(Monitor::of_kinds(required)));
    }
    Ok(values)
}

fn no_manual_activation(kind: Kind, given: &Given<String>) -> ConfigError {
    let has_one = |kind: &Kind| kind.facts().manual_activation.is_some();
    let others = Kind::ALL.into_iter().filter(has_one);
    let others: Vec<_> = others.map(Kind::as_str).collect();
    let message = format!("{} has no manual activation", kind.as_str());
    ConfigError::at(given, message)
        .with_help(format!("the kinds that have one are {}", others.join(", ")))
}

/// Reads a list of compensation keywords.
fn kinds(section: &Section<'_>, key: &str) -> Result<Vec<(Kind, Given<String>)>, ConfigError> {
    let mut found = Vec::new();
    for word in section.strings(key)? {
        let kind = word.value.parse::<Kind>().map_err(|_| {
            let message = format!("`{}` is not a kind of compensation", word.value);
            ConfigError::at(&word, message).with_near(&word.value, Kind::ALL.map(Kind::as_str))
        })?;
        found.push((kind, word));
    }
    Ok(found)
}

/// Reads the value list that is part of `frictcomp.toml`. Its values have the names, units,
/// defaults and checks of a list file.
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

/// A replacement in the file, with the text around the name of the axis.
struct Replacement {
    span: Span,
    before: String,
    after: &'static str,
}

/// Returns the change that adds an axis to the file, in the form in which the file lists the others. `None` if it lists
/// none: the first listed axis would end the assumption made without a list (R2.20).
pub(super) fn one_more_axis(root: &Section<'_>) -> Option<NamedFix> {
    let (source, last) = (root.source(), root.extent_of_last("axis")?);
    let text = source.text();
    let change = if last.of(text).starts_with('{') {
        let array = root.given("axis")?;
        in_array(text, last, array.span())
    } else {
        after_table(text, last)
    };
    Some(NamedFix {
        place: source.place(change.span),
        before: change.before,
        after: change.after.to_owned(),
    })
}

/// Places a table `[[axis]]` after the last one and after the comments that close it: those followed by an empty line
/// or the end of the file.
fn after_table(text: &str, last: Span) -> Replacement {
    let line_end = |from: usize| from + text[from..].lines().next().unwrap_or_default().len();
    let table_end = line_end(last.end as usize);
    let (mut end, mut comments_end) = (table_end, table_end);
    loop {
        let Some(below) = text[comments_end..].find('\n') else {
            end = comments_end;
            break;
        };
        let start = comments_end + below + 1;
        let line = text[start..line_end(start)].trim();
        if line.is_empty() {
            end = comments_end;
        }
        if !line.starts_with('#') {
            break;
        }
        comments_end = line_end(start);
    }
    Replacement {
        span: Span::new(end, end),
        before: "\n\n[[axis]]\nname = \"".to_owned(),
        after: "\"",
    }
}

/// Places an entry `{ name = "X" }` after the last one of an array: on the same line, or below it if the array spans
/// lines.
fn in_array(text: &str, last: Span, array: Span) -> Replacement {
    let (start, end) = (last.start as usize, last.end as usize);
    let gap = &text[end..array.end as usize - 1];
    let Some(line_end) = gap.find('\n') else {
        return Replacement {
            span: Span::new(end, end),
            before: ", { name = \"".to_owned(),
            after: "\" }",
        };
    };
    let rest = gap[..line_end].trim_end_matches('\r');
    let (comma, after) = if rest.trim_start().starts_with(',') {
        ("", "\" },")
    } else {
        (",", "\" }")
    };
    let line = &text[text[..start].rfind('\n').map_or(0, |at| at + 1)..start];
    let indent = &line[..line.len() - line.trim_start().len()];
    Replacement {
        span: Span::new(end, end + rest.len()),
        before: format!("{comma}{rest}\n{indent}{{ name = \""),
        after,
    }
}
