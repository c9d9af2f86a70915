//! Errors in a `frictcomp.toml` that cannot be used, with advice.

use thiserror::Error;

use crate::diagnostic::{Advice, Code, Diagnostic, nearest};
use crate::lists::Given;
use crate::text::{SourceFile, Span};

/// Reports a text that is not TOML: the parser's message, with advice on the mistakes that users of
/// the control make most.
pub(super) fn no_toml(source: &SourceFile, error: &toml::de::Error) -> ConfigError {
    let span = error.span().unwrap_or_default();
    let message = error.message().lines().collect::<Vec<_>>().join(", ");
    let line = line_at(source.text(), span.start);
    let refused = ConfigError::new(source, Span::new(span.start, span.end), message);
    let key = line.split('=').next().unwrap_or_default().trim();
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '"' | '\'');
    if line.contains('\\') && line.contains('"') {
        refused
            .with_help("write paths with `/`, or between single quotes: `'C:\\CNC\\hochlauf.lis'`")
    } else if line.contains('=')
        && !key.is_empty()
        && !key.starts_with('[')
        && !key.chars().all(bare)
    {
        refused.with_help(format!("put the name in quotes: `\"{key}\" = ...`"))
    } else if line.contains('=') && !line.contains(['"', '\'']) {
        refused.with_help("put texts in quotes: `startup = \"lists/hochlauf.lis\"`")
    } else {
        refused.with_help(Advice::WriteConfiguration)
    }
}

fn line_at(text: &str, offset: usize) -> &str {
    let before = text.get(..offset).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    text[start..].lines().next().unwrap_or_default()
}

/// Returns an example of a key with a value of the expected form.
pub fn example(key: &str) -> Option<&'static str> {
    let (_, example) = EXAMPLES.iter().find(|(name, _)| *name == key)?;
    Some(example)
}

/// One row per key.
const EXAMPLES: [(&str, &str); 31] = [
    ("machine", "write `[machine]`, in single brackets"),
    (
        "axis",
        "write `[[axis]]`, in double brackets, once for each axis",
    ),
    ("variables", "write `[variables]`, in single brackets"),
    ("lint", "write `[lint]`, in single brackets"),
    ("reading", "write `[reading]`, in single brackets"),
    ("confirmed", "write `[confirmed]`, in single brackets"),
    ("programs", "write `[machine.programs]`, in single brackets"),
    (
        "value",
        "write `[axis.value]` after the axis, in single brackets",
    ),
    ("startup", "write `startup = \"lists/hochlauf.lis\"`"),
    ("project", "write `project = \"Machine.tsproj\"`"),
    (
        "cycle_time_ms",
        "write `cycle_time_ms = 1.0` for a CNC cycle of 1 ms",
    ),
    (
        "skip",
        "write `skip = \"none\"`, or `skip = [1, 3]` for the levels that are on",
    ),
    ("cnc_build", "write `cnc_build = \"3.1.3132.0\"`"),
    ("program_dirs", "write `program_dirs = [\"cycles\"]`"),
    ("external", "write `external = [\"*.ecy\"]`"),
    (
        "external_keeps",
        "write `[machine.external_keeps]`, in single brackets",
    ),
    ("harmless", "write `harmless = [\"#MYCMD\", \"G81\"]`"),
    ("name", "write `name = \"X\"`"),
    (
        "type",
        "write `type = \"T\"` for linear, `\"R\"` for rotary, `\"S\"` for a spindle",
    ),
    ("number", "write `number = 1`"),
    ("stable", "write `stable = [\"V.E.MATERIAL\"]`"),
    ("own", "write `own = [\"V.E.PARTS\"]`"),
    ("frict_comp", "write `frict_comp = true`"),
    ("enable", "write `enable = true`"),
    ("axis_list", "write `axis_list = \"lists/axis_x.lis\"`"),
    ("value_list", "write `value_list = \"lists/comp_x.lis\"`"),
    ("table", "write `table = [[0.0, 12.0], [1800.0, 10.5]]`"),
    ("compensations", "write `compensations = [\"LEAD\"]`"),
    (
        "manual_activation",
        "write `manual_activation = [\"LEAD\"]`",
    ),
    ("required", "write `required = [\"FRICT\"]`"),
    (
        "max_velocity",
        "write `max_velocity = 30000`, in mm/min or \u{b0}/min",
    ),
];

/// A `frictcomp.toml` that cannot be used: it is not TOML, or has an unknown key or value.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}:{}: {}", .diagnostic.place.file, .diagnostic.place.start(), .diagnostic.message)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ConfigError {
    /// FC110 with the place.
    pub diagnostic: Box<Diagnostic>,
}

impl ConfigError {
    /// Creates an error about a part of a file.
    pub fn new(source: &SourceFile, span: Span, message: impl Into<String>) -> Self {
        let place = source.place(span);
        Self {
            diagnostic: Box::new(Diagnostic::new(Code::Fc110, place, message)),
        }
    }

    /// Creates an error about a value.
    pub fn at<T>(given: &Given<T>, message: impl Into<String>) -> Self {
        Self {
            diagnostic: Box::new(Diagnostic::new(Code::Fc110, given.place(), message)),
        }
    }

    /// Adds a line of help.
    pub fn with_help(mut self, advice: impl Into<Advice>) -> Self {
        self.diagnostic.advice.push(advice.into());
        self
    }

    /// Adds "did you mean" if a known word is similar.
    pub(crate) fn with_near<'a>(
        mut self,
        found: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let near = nearest(found, known);
        self.diagnostic = Box::new(self.diagnostic.with_near(found, &near));
        self
    }
}
