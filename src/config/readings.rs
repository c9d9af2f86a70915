//! The tables `[reading]` and `[confirmed]` of `frictcomp.toml` (R15.2).

use super::error::ConfigError;
use super::section::{Section, Shape};
use crate::comp::NoBuild;
use crate::lists::Given;
use crate::readings::{Confirmation, Question, Readings};

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
pub(super) fn read(root: &Section<'_>) -> Result<Readings, ConfigError> {
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
