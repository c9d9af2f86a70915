//! The arguments of requests.

use std::path::PathBuf;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::transport::Request;

/// `launch`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Launch {
    /// Path of the program.
    pub(super) program: PathBuf,
    /// Whether the run stops before the first block.
    #[serde(default = "yes")]
    pub(super) stop_on_entry: bool,
    /// Values that only the machine knows.
    #[serde(default)]
    pub(super) set: Map<String, Value>,
}

fn yes() -> bool {
    true
}

/// `setBreakpoints`.
#[derive(Debug, Deserialize)]
pub(super) struct SetBreakpoints {
    pub(super) source: Source,
    #[serde(default)]
    pub(super) breakpoints: Vec<SourceBreakpoint>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Source {
    pub(super) path: String,
}

/// A breakpoint as a client requests it.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SourceBreakpoint {
    pub(super) line: u32,
    /// Condition of the breakpoint.
    pub(super) condition: Option<String>,
    /// Hits that count.
    pub(super) hit_condition: Option<String>,
    /// The text that is printed in place of a stop.
    pub(super) log_message: Option<String>,
}

/// `setExceptionBreakpoints`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SetFilters {
    #[serde(default)]
    pub(super) filters: Vec<String>,
    #[serde(default)]
    pub(super) filter_options: Vec<FilterOption>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct FilterOption {
    pub(super) filter_id: String,
    #[serde(default)]
    pub(super) condition: String,
}

/// `variables`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Variables {
    pub(super) variables_reference: i64,
}

/// `stepIn`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StepIn {
    /// The place of the side that is taken.
    pub(super) target_id: Option<usize>,
}

/// `setVariable`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SetVariable {
    pub(super) variables_reference: i64,
    pub(super) name: String,
    pub(super) value: String,
}

/// `evaluate`.
#[derive(Debug, Deserialize)]
pub(super) struct Evaluate {
    pub(super) expression: String,
}

/// Returns the arguments of a request.
///
/// # Errors
/// The arguments do not match the protocol; the reason in words.
pub(super) fn arguments<T: DeserializeOwned>(request: &Request) -> Result<T, String> {
    serde_json::from_value(request.arguments.clone()).map_err(|error| {
        format!(
            "the arguments of `{}` are not understood: {error}",
            request.command
        )
    })
}
