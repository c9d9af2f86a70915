//! The values that a client can inspect while a run is stopped.

use serde_json::{Value as Json, json};

use super::stepper::Stepper;
use super::wording::in_words;
use frictcomp::comp::{AxisIndex, Kind};
use frictcomp::interpreter::{AxisPosition, Group, Interpreter, PositionFrame};
use frictcomp::machine::Setting;

/// Group of values; the number is the client's handle of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VariableScope {
    /// The axes with their states and positions.
    Axes = 1,
    /// Values that the next block reads and only the machine knows.
    Unknown = 2,
    /// Parameters and variables.
    Values = 3,
    /// G functions and the feed.
    Modal = 4,
    /// The answers to the condition of the next block.
    Sides = 5,
}

/// First handle of a single axis.
const FIRST_AXIS: i64 = 100;

impl VariableScope {
    /// Returns the scopes at the current block.
    pub(super) fn all(stepper: &Stepper) -> Vec<Json> {
        let mut scopes = vec![(Self::Axes, "Axes")];
        if !stepper.wanted().is_empty() {
            scopes.push((Self::Unknown, "Only the machine knows"));
        }
        if stepper.answers().next().is_some() {
            scopes.push((Self::Sides, "Sides"));
        }
        scopes.push((Self::Values, "Parameters and variables"));
        scopes.push((Self::Modal, "G functions"));
        let scope = |(scope, name)| json!({ "name": name, "variablesReference": scope as i64, "expensive": false });
        scopes.into_iter().map(scope).collect()
    }
}

/// Returns the values of a handle.
pub(super) fn variables(stepper: &Stepper, handle: i64) -> Vec<Json> {
    let here = stepper.interpreter();
    match handle {
        _ if handle == VariableScope::Axes as i64 => {
            axes(here).map(|axis| axis_line(here, axis)).collect()
        }
        _ if handle == VariableScope::Unknown as i64 => {
            let names = stepper.wanted().iter();
            names
                .map(|name| line(name, "unknown; set a value here"))
                .collect()
        }
        _ if handle == VariableScope::Sides as i64 => {
            let answers = stepper.answers();
            answers
                .map(|words| line(&words, "open; set 1 to take this side"))
                .collect()
        }
        _ if handle == VariableScope::Values as i64 => {
            let values = here.values().into_iter();
            values
                .map(|(name, value)| line(&name, &in_words(&value)))
                .collect()
        }
        _ if handle == VariableScope::Modal as i64 => modal(here),
        _ => axes(here)
            .find(|&axis| handle_of(axis) == handle)
            .map_or_else(Vec::new, |axis| axis_parts(here, axis)),
    }
}

/// Returns the value of an expression of the language, or what is known of an axis given by name.
///
/// # Errors
/// It has no value here; the reason in words.
pub(super) fn evaluate(stepper: &Stepper, expression: &str) -> Result<Json, String> {
    let here = stepper.interpreter();
    let wanted = expression.trim().to_ascii_uppercase();
    if let Some(axis) = axes(here).find(|&axis| name_of(here, axis) == wanted) {
        let mut found = axis_line(here, axis);
        found["result"] = found["value"].take();
        return Ok(found);
    }
    let value = here.evaluate(expression)?;
    Ok(json!({ "result": in_words(&value), "variablesReference": 0 }))
}

/// Returns the states of all axes in one line: `X inactive, Y active`.
pub(super) fn states(stepper: &Stepper) -> String {
    let here = stepper.interpreter();
    let state = |axis| {
        let state = here.compensation().state(axis, Kind::Frict);
        format!("{} {state}", name_of(here, axis))
    };
    let states: Vec<String> = axes(here).map(state).collect();
    if states.is_empty() {
        return "no axis changed".to_owned();
    }
    states.join(", ")
}

/// Reads a value as typed: a number, or a text in quotes.
pub(super) fn setting(typed: &str) -> Option<Setting> {
    let typed = typed.trim();
    let quoted = typed
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    match quoted {
        Some(text) => Some(Setting::Text(text.to_owned())),
        None => typed
            .parse()
            .ok()
            .filter(|it: &f64| it.is_finite())
            .map(Setting::Number),
    }
}

fn axes(here: &Interpreter) -> impl Iterator<Item = AxisIndex> {
    let occurred = here.occurred().iter().enumerate();
    let occurred = occurred.filter(|(_, occurred)| **occurred);
    occurred.map(|(at, _)| AxisIndex::new(at))
}

fn name_of(here: &Interpreter, axis: AxisIndex) -> &str {
    &here.machine().axis(axis).name
}

fn handle_of(axis: AxisIndex) -> i64 {
    i64::try_from(axis.get()).map_or(i64::MAX, |at| at.saturating_add(FIRST_AXIS))
}

/// Returns `X: active, at 22`, with more below it.
fn axis_line(here: &Interpreter, axis: AxisIndex) -> Json {
    let state = here.compensation().state(axis, Kind::Frict);
    let value = format!("{state}, {}", position(here.position(axis)));
    let mut line = line(name_of(here, axis), &value);
    line["variablesReference"] = handle_of(axis).into();
    line
}

fn axis_parts(here: &Interpreter, axis: AxisIndex) -> Vec<Json> {
    let configured = Kind::ALL
        .into_iter()
        .filter(|&kind| kind == Kind::Frict || here.compensation().is_configured(axis, kind));
    let states = configured.map(|kind| {
        line(
            kind.as_str(),
            here.compensation().state(axis, kind).as_str(),
        )
    });
    states
        .chain([line("position", &position(here.position(axis)))])
        .collect()
}

fn position(position: AxisPosition) -> String {
    match (position.value, position.frame) {
        (None, _) => "position unknown".to_owned(),
        (Some(value), PositionFrame::Machine) => format!("at {value}"),
        (Some(value), _) => format!("at {value} of the program"),
    }
}

fn modal(here: &Interpreter) -> Vec<Json> {
    let modal = here.modal();
    let functions = &modal.functions;
    let one_of = |is_first, first: u32, second: u32| if is_first { first } else { second };
    [
        ("motion", Group::Motion, functions.motion),
        ("plane", Group::Plane, functions.plane),
        (
            "coordinates",
            Group::Distance,
            one_of(functions.absolute, 90, 91),
        ),
        ("unit", Group::Unit, one_of(functions.inch, 70, 71)),
        ("feed mode", Group::Feed, functions.feed_mode),
        ("zero offset", Group::Offset, functions.offset),
    ]
    .map(|(name, group, function)| {
        if modal.is_known(group) {
            line(name, &format!("G{function:02}"))
        } else {
            line(name, "unknown")
        }
    })
    .into()
}

fn line(name: &str, value: &str) -> Json {
    json!({ "name": name, "value": value, "variablesReference": 0 })
}
