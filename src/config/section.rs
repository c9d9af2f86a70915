//! Tables of TOML with the place of everything in them, the keys that `frictcomp.toml` may have, and errors in a file that
//! cannot be used, with advice.

use std::sync::Arc;

use thiserror::Error;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::file::{CHECK, LINT, ROOT, VARIABLES};
use super::machine::{
    AXIS, CONFIRMATION, CONFIRMED, EXTERNAL_KEEPS, MACHINE, READING, VALUE, WORDS,
};
use crate::diagnostic::{Advice, Code, Diagnostic, nearest};
use crate::lists::{Given, Number, Written};
use crate::syntax::SkipLevels;
use crate::text::{SourceFile, Span};

/// Name and permitted keys of a table.
pub struct Shape {
    /// The name as the user writes it.
    pub name: &'static str,
    /// The keys; `None` if the user chooses them.
    pub keys: Option<&'static [&'static str]>,
}

impl Shape {
    /// Returns the first key of a table that the shape does not have.
    pub(super) fn first_unknown<'a>(
        &self,
        table: &'a DeTable<'_>,
    ) -> Option<&'a Spanned<DeString<'a>>> {
        let known = self.keys?;
        let unknown = table
            .keys()
            .filter(|key| !known.contains(&key.get_ref().as_ref()));
        unknown.min_by_key(|key| key.span().start)
    }
}

/// One table whose keys are all known.
pub struct Section<'a> {
    table: &'a DeTable<'a>,
    source: &'a Arc<SourceFile>,
    span: Span,
}

impl<'a> Section<'a> {
    /// Checks the keys of a table.
    ///
    /// # Errors
    /// A key is unknown, or is given twice.
    pub fn new(
        table: &'a DeTable<'a>,
        source: &'a Arc<SourceFile>,
        shape: &Shape,
    ) -> Result<Self, ConfigError> {
        if let Some(known) = shape.keys
            && let Some(key) = shape.first_unknown(table)
        {
            let name = key.get_ref().as_ref();
            let message = format!("`{}` has no key `{name}`", shape.name);
            let error = ConfigError::new(source, span(key), message);
            let error = error.with_near(name, known.iter().copied());
            return Err(if error.diagnostic.advice.is_empty() {
                error.with_help(format!("its keys are {}", known.join(", ")))
            } else {
                error
            });
        }
        Ok(Self {
            table,
            source,
            span: Span::default(),
        })
    }

    /// Returns the place of the table itself.
    pub fn whole(&self) -> Given<()> {
        Given::new((), self.source, self.span)
    }

    /// Returns the place of a value.
    pub fn given(&self, key: &str) -> Option<Given<()>> {
        let value = self.table.get(key)?;
        Some(Given::new((), self.source, span(value)))
    }

    /// Returns the file that contains the table.
    pub(super) fn source(&self) -> &SourceFile {
        self.source
    }

    /// Returns the span from the beginning of the last value of an array to the end of the last item in it.
    pub(super) fn extent_of_last(&self, key: &str) -> Option<Span> {
        let last = self.table.get(key)?.get_ref().as_array()?.last()?;
        Some(Span::new(last.span().start, end(last)))
    }

    /// Returns the keys with their places.
    pub(super) fn names(&self) -> impl Iterator<Item = Given<&'a str>> {
        self.table
            .keys()
            .map(|key| Given::new(key.get_ref().as_ref(), self.source, span(key)))
    }

    /// Returns a table inside this one.
    ///
    /// # Errors
    /// The key is not a table, or the table has an unknown key.
    pub fn table(&self, key: &str, shape: &Shape) -> Result<Option<Section<'a>>, ConfigError> {
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        let Some(table) = value.get_ref().as_table() else {
            return Err(self.expected(value, key, "a table"));
        };
        Ok(Some(self.section(value, table, shape)?))
    }

    /// Returns the tables of an array, `[[axis]]`.
    pub(super) fn tables(&self, key: &str, shape: &Shape) -> Result<Vec<Section<'a>>, ConfigError> {
        let mut tables = Vec::new();
        for value in self.array(key, "an array of tables")? {
            let Some(table) = value.get_ref().as_table() else {
                return Err(self.expected(value, key, "an array of tables"));
            };
            tables.push(self.section(value, table, shape)?);
        }
        Ok(tables)
    }

    /// Returns a text.
    ///
    /// # Errors
    /// The value is not a text.
    pub fn string(&self, key: &str) -> Result<Option<Given<String>>, ConfigError> {
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        match value.get_ref().as_str() {
            Some(text) => Ok(Some(self.place(value, text.to_owned()))),
            None => Err(self.expected(value, key, "a text in quotes")),
        }
    }

    /// Returns a list of texts; empty without the key.
    pub(super) fn strings(&self, key: &str) -> Result<Vec<Given<String>>, ConfigError> {
        let mut texts = Vec::new();
        for value in self.array(key, "a list of texts")? {
            match value.get_ref().as_str() {
                Some(text) => texts.push(self.place(value, text.to_owned())),
                None => return Err(self.expected(value, key, "a list of texts")),
            }
        }
        Ok(texts)
    }

    /// Returns skip levels: `"none"`, `"all"`, a list of levels or texts such as `"1,3-5"`.
    pub(super) fn skip_levels(&self, key: &str) -> Result<Option<SkipLevels>, ConfigError> {
        const WANTED: &str = "`\"none\"`, `\"all\"` or a list of levels from 1 to 10";
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        let level = |value: &Spanned<DeValue<'_>>| match self.written(value)?.number? {
            Number::Integer(level) => u8::try_from(level).ok(),
            _ => None,
        };
        let levels = match value.get_ref() {
            DeValue::String(text) => text.parse().ok(),
            DeValue::Array(values) => values
                .iter()
                .try_fold(SkipLevels::NONE, |levels, value| levels.with(level(value)?)),
            _ => level(value).and_then(|level| SkipLevels::NONE.with(level)),
        };
        levels
            .map(Some)
            .ok_or_else(|| self.expected(value, key, WANTED))
    }

    /// Returns a truth value, also given as `0` or `1`.
    pub(super) fn truth(&self, key: &str) -> Result<Option<Given<bool>>, ConfigError> {
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        let on = match (value.get_ref(), self.written(value).and_then(|w| w.number)) {
            (DeValue::Boolean(on), _) => *on,
            (_, Some(Number::Integer(0))) => false,
            (_, Some(Number::Integer(1))) => true,
            _ => return Err(self.expected(value, key, "`true` or `false`")),
        };
        Ok(Some(self.place(value, on)))
    }

    /// Returns the number of a key as written; `None` without the key or for a value of another type.
    pub fn number(&self, key: &str) -> Option<Given<Written>> {
        let value = self.table.get(key)?;
        Some(self.place(value, self.written(value)?))
    }

    /// Returns a whole number from 0 to 65535.
    pub(super) fn whole_number(&self, key: &str) -> Result<Option<Given<u32>>, ConfigError> {
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        let number = match self.written(value).and_then(|written| written.number) {
            Some(Number::Integer(number)) => u16::try_from(number).ok(),
            _ => None,
        };
        match number {
            Some(number) => Ok(Some(self.place(value, u32::from(number)))),
            None => Err(self.expected(value, key, "a whole number from 0 to 65535")),
        }
    }

    /// Returns a number above 0.
    ///
    /// # Errors
    /// The value is not a number above 0.
    pub fn positive(&self, key: &str) -> Result<Option<f64>, ConfigError> {
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        let number = self.written(value).and_then(|written| written.number);
        match number.map(Number::to_f64).filter(|&number| number > 0.0) {
            Some(number) => Ok(Some(number)),
            None => Err(self.expected(value, key, "a number above 0")),
        }
    }

    /// Returns a list of pairs of numbers, `[[0, 12.0], [1800, 10.5]]`.
    ///
    /// # Errors
    /// The value is something else.
    pub fn number_pairs(&self, key: &str) -> Result<Option<Vec<[Given<Written>; 2]>>, ConfigError> {
        const WANTED: &str = "a list of pairs `[velocity, current]`";
        if !self.table.contains_key(key) {
            return Ok(None);
        }
        let mut pairs = Vec::new();
        for value in self.array(key, WANTED)? {
            let pair = match value.get_ref() {
                DeValue::Array(pair) if pair.len() == 2 => {
                    let number = |at: usize| {
                        let value = pair.get(at)?;
                        Some(self.place(value, self.written(value)?))
                    };
                    number(0).zip(number(1))
                }
                _ => None,
            };
            match pair {
                Some((input, output)) => pairs.push([input, output]),
                None => return Err(self.expected(value, key, WANTED)),
            }
        }
        Ok(Some(pairs))
    }

    fn section(
        &self,
        value: &Spanned<DeValue<'a>>,
        table: &'a DeTable<'a>,
        shape: &Shape,
    ) -> Result<Section<'a>, ConfigError> {
        let mut section = Section::new(table, self.source, shape)?;
        section.span = span(value);
        Ok(section)
    }

    fn array(
        &self,
        key: &str,
        wanted: &str,
    ) -> Result<impl Iterator<Item = &'a Spanned<DeValue<'a>>> + use<'a>, ConfigError> {
        let found = match self.table.get(key) {
            None => None,
            Some(value) => match value.get_ref() {
                DeValue::Array(values) => Some(values),
                _ => return Err(self.expected(value, key, wanted)),
            },
        };
        Ok(found.into_iter().flat_map(|values| values.iter()))
    }

    /// Returns a number with its text as written in the file.
    fn written(&self, value: &Spanned<DeValue<'_>>) -> Option<Written> {
        let text = || span(value).of(self.source.text()).to_owned();
        match value.get_ref() {
            DeValue::Integer(integer) => Some(Written {
                text: text(),
                number: i64::from_str_radix(integer.as_str(), integer.radix())
                    .ok()
                    .map(Number::Integer),
            }),
            DeValue::Float(float) => Some(Written {
                text: text(),
                number: float
                    .as_str()
                    .parse()
                    .ok()
                    .filter(|number: &f64| number.is_finite())
                    .map(Number::Real),
            }),
            _ => None,
        }
    }

    fn place<T>(&self, value: &Spanned<DeValue<'_>>, content: T) -> Given<T> {
        Given::new(content, self.source, span(value))
    }

    fn expected(&self, value: &Spanned<DeValue<'_>>, key: &str, wanted: &str) -> ConfigError {
        let found = match value.get_ref() {
            DeValue::Table(_) => "a table".to_owned(),
            _ => shortened(span(value).of(self.source.text())),
        };
        let message = format!("`{key}` is {found}; it must be {wanted}");
        let error = ConfigError::new(self.source, span(value), message);
        match example(key) {
            Some(example) => error.with_help(example),
            None => error,
        }
    }

    /// Reports a value that is not a number.
    pub(super) fn no_number(&self, key: &str) -> ConfigError {
        let Some(value) = self.table.get(key) else {
            return ConfigError::at(&self.whole(), format!("`{key}` is missing"));
        };
        self.expected(value, key, "a number")
            .with_help("write it without quotes")
    }

    /// Returns a dotted name and its value if TOML took its parts for tables.
    pub(super) fn dotted(&self, key: &str) -> Option<(String, String)> {
        let mut name = key.to_owned();
        let mut value = self.table.get(key)?;
        while let DeValue::Table(table) = value.get_ref() {
            let (part, inner) = table.iter().next()?;
            name.push('.');
            name.push_str(part.get_ref());
            value = inner;
        }
        let is_one = name.contains('.');
        is_one.then(|| {
            (
                name,
                shortened(span(value).of(self.source.text())).replace('`', ""),
            )
        })
    }
}

/// Returns a value as written, in backquotes; only its beginning if it is long.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    let line = text.lines().next().unwrap_or_default();
    let whole = line.len() == text.len() && line.chars().count() <= LONGEST;
    if whole {
        format!("`{line}`")
    } else {
        format!(
            "`{}\u{2026}`",
            line.chars().take(LONGEST).collect::<String>()
        )
    }
}

/// Returns the end of the last item in a value. The span of a table is that of its header.
fn end(value: &Spanned<DeValue<'_>>) -> usize {
    let own = value.span().end;
    let ends = match value.get_ref() {
        DeValue::Array(values) => values.iter().map(end).max(),
        DeValue::Table(table) => table.values().map(end).max(),
        _ => None,
    };
    own.max(ends.unwrap_or_default())
}

fn span<T>(spanned: &Spanned<T>) -> Span {
    let range = spanned.span();
    Span::new(range.start, range.end)
}

/// Every table, by its header; the file itself has none.
const TABLES: [(&str, &Shape); 12] = [
    ("", &ROOT),
    (AXIS.name, &AXIS),
    (VALUE.name, &VALUE),
    (MACHINE.name, &MACHINE),
    (EXTERNAL_KEEPS.name, &EXTERNAL_KEEPS),
    (WORDS.name, &WORDS),
    (VARIABLES.name, &VARIABLES),
    (LINT.name, &LINT),
    (CHECK.name, &CHECK),
    (READING.name, &READING),
    (CONFIRMED.name, &CONFIRMED),
    (CONFIRMATION.name, &CONFIRMATION),
];

/// Returns the keys of the table with a header such as `[[axis]]`; `None` if the user chooses them, or there is no such
/// table.
pub fn keys(header: &str) -> Option<&'static [&'static str]> {
    let table = TABLES.iter().find(|(name, _)| *name == header);
    table.and_then(|(_, shape)| shape.keys)
}

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
