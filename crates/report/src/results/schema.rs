//! JSON schemas of `frictcomp.toml` and of plant files, with which any TOML editor completes and checks
//! them (R17.6).

use std::fmt::Write as _;

use frictcomp::comp::Kind;
use frictcomp::config::{CONFIG_FORMS, Form, TableForm};
use frictcomp::diagnostic::{Code, Levels, Severity};
use frictcomp_physics::simulation::PLANT_FORMS;
use serde_json::{Map, Value, json};

/// Returns the schema of `frictcomp.toml`, JSON Schema 2020-12, made from the tables of the reader. Only the reader
/// finds duplicate entries for an axis or a list.
pub fn config_schema() -> Value {
    schema(&CONFIG_FORMS, "frictcomp.toml")
}

/// Returns the schema of plant files, JSON Schema 2020-12, made from the tables of the reader. Only the reader checks
/// the relations between values.
pub fn plant_schema() -> Value {
    schema(&PLANT_FORMS, "a plant file of frictcomp")
}

fn schema(tables: &[TableForm], title: &str) -> Value {
    let mut schema = Map::new();
    schema.insert(
        "$schema".to_owned(),
        json!("https://json-schema.org/draft/2020-12/schema"),
    );
    schema.insert("title".to_owned(), json!(title));
    if let Some(Value::Object(file)) = tables.first().map(|file| table(file, tables)) {
        schema.extend(file);
    }
    Value::Object(schema)
}

fn table(of: &TableForm, tables: &[TableForm]) -> Value {
    let mut properties = Map::new();
    for key in of.keys {
        let mut value = form(key.form, tables);
        if let Value::Object(value) = &mut value {
            value.insert("description".to_owned(), json!(key.meaning));
        }
        properties.insert(key.key.to_owned(), value);
    }
    let mut table = json!({ "type": "object", "properties": properties });
    match of.free {
        Some(Form::Level) => {
            for code in levelled() {
                let level = json!({ "enum": LEVELS, "description": code.title() });
                table["properties"][code.as_str()] = level;
            }
            let any_case = any_case(levelled().map(Code::as_str));
            table["patternProperties"] = json!({ any_case: { "enum": LEVELS } });
            table["additionalProperties"] = json!(false);
        }
        Some(free) => table["additionalProperties"] = form(free, tables),
        None => table["additionalProperties"] = json!(false),
    }
    if !of.required.is_empty() {
        table["required"] = json!(of.required);
    }
    table
}

/// The words of `[lint]`.
const LEVELS: [&str; 4] = ["off", "info", "warning", "error"];

/// Returns the codes whose severity can be changed.
fn levelled() -> impl Iterator<Item = Code> {
    let codes = Code::ALL.iter().copied();
    codes.filter(|code| Levels::default().set(*code, Some(Severity::Info)))
}

/// Returns a pattern for words in any case.
fn any_case<'a>(words: impl Iterator<Item = &'a str>) -> String {
    let mut pattern = String::from("^(");
    for (at, word) in words.enumerate() {
        if at > 0 {
            pattern.push('|');
        }
        for letter in word.chars() {
            let (upper, lower) = (letter.to_ascii_uppercase(), letter.to_ascii_lowercase());
            let _ = if upper == lower {
                write!(pattern, "{letter}")
            } else {
                write!(pattern, "[{upper}{lower}]")
            };
        }
    }
    pattern + ")$"
}

fn form(form: Form, tables: &[TableForm]) -> Value {
    let text = || json!({ "type": "string" });
    let texts = || json!({ "type": "array", "items": text() });
    let truth = || json!({ "enum": [true, false, 0, 1] });
    match form {
        Form::Text => text(),
        Form::OneOf(words) => json!({ "enum": words }),
        Form::Texts => texts(),
        Form::Kinds => {
            let words = Kind::ALL.map(Kind::as_str);
            let any_case = json!({ "type": "string", "pattern": any_case(words.into_iter()) });
            json!({ "type": "array", "items": { "anyOf": [{ "enum": words }, any_case] } })
        }
        Form::Truth => truth(),
        Form::TruthOrTexts => json!({ "anyOf": [truth(), texts()] }),
        Form::WholeNumber => json!({ "type": "integer", "minimum": 0, "maximum": 65535 }),
        Form::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Form::Number => json!({ "type": "number" }),
        Form::Within([least, most]) => {
            json!({ "type": "number", "minimum": least, "maximum": most })
        }
        Form::NumberOrText => json!({ "type": ["number", "string"] }),
        Form::SkipLevels => {
            let level = json!({ "type": "integer", "minimum": 1, "maximum": 10 });
            let words = json!({ "type": "string", "examples": ["none", "all", "1,3-5"] });
            json!({ "anyOf": [words, level, { "type": "array", "items": level }] })
        }
        Form::Points(most) => {
            let number = json!({ "type": "number" });
            let pair = json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 });
            let mut pairs = json!({ "type": "array", "items": pair });
            if let Some(most) = most {
                pairs["maxItems"] = json!(most);
            }
            pairs
        }
        Form::Level => json!({ "enum": LEVELS }),
        Form::Table(header) => inner(header, tables),
        Form::Tables(header) => json!({ "type": "array", "items": inner(header, tables) }),
    }
}

/// Returns the table of a header; an unknown one may contain anything.
fn inner(header: &str, tables: &[TableForm]) -> Value {
    let mut found = tables.iter().filter(|table| table.header == header);
    found
        .next()
        .map_or_else(|| json!({ "type": "object" }), |of| table(of, tables))
}
