//! Changes to a text that do what a diagnostic advises.

use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use crate::text::{Numbering, Place, SourceFile, Span};

crate::words! {
    /// Safety of a fix: the need for a review before it is applied.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum Safety {
        /// Fix that leaves the behaviour of the machine unchanged.
        Safe = "safe",
        /// Fix that guesses the intention or changes what the machine does, and has to be reviewed.
        Unsafe = "unsafe",
    }
}

/// Form of the text of a fix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum FixForm {
    /// Text inserted as written.
    Text,
    /// Block on a line of its own, with a number where its neighbours have numbers.
    Block,
}

/// A change to a text: it replaces the text at a place.
///
/// The place of a fix in a [`Fault`](crate::syntax::Fault) is a [`Span`] of the block, that of a
/// fix in a [`Diagnostic`](super::Diagnostic) a [`Place`] in a file. The fixes of one diagnostic
/// are alternatives: each alone does what is advised.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Fix<P = Place> {
    /// Text to replace; an empty place inserts.
    pub place: P,
    /// Replacement, with lines separated by `\n`.
    pub text: String,
    /// Need for a review before it is applied.
    pub safety: Safety,
    /// Form of the replacement.
    pub form: FixForm,
    /// A further change of the same file that is made with it, because each alone is half a remedy.
    pub also: Option<Box<Fix>>,
}

impl<P> Fix<P> {
    /// Creates a fix that changes nothing for the machine.
    pub fn safe(place: P, text: impl Into<String>) -> Self {
        Self {
            place,
            text: text.into(),
            safety: Safety::Safe,
            form: FixForm::Text,
            also: None,
        }
    }

    /// Creates a fix that has to be reviewed.
    pub fn guess(place: P, text: impl Into<String>) -> Self {
        Self {
            safety: Safety::Unsafe,
            ..Self::safe(place, text)
        }
    }

    /// Creates a fix that inserts a block above the line of an empty place; it has to be reviewed.
    pub fn block(place: P, command: &str) -> Self {
        Self {
            form: FixForm::Block,
            ..Self::guess(place, format!("{command}\n"))
        }
    }

    /// Adds a change that is made with it.
    pub fn with(self, also: Fix) -> Self {
        Self {
            also: Some(Box::new(also)),
            ..self
        }
    }

    /// Converts the place of the fix with `to`.
    pub fn map<Q>(self, to: impl FnOnce(P) -> Q) -> Fix<Q> {
        Fix {
            place: to(self.place),
            text: self.text,
            safety: self.safety,
            form: self.form,
            also: self.also,
        }
    }
}

impl Fix {
    /// Returns the changes that it consists of.
    pub fn changes(&self) -> impl Iterator<Item = &Self> {
        std::iter::successors(Some(self), |fix| fix.also.as_deref())
    }
}

impl Fix<Span> {
    /// Shifts the span of the fix by an offset.
    pub fn shifted(self, offset: u32) -> Self {
        self.map(|span| span.shifted(offset))
    }
}

impl Serialize for Fix {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (start, end) = (self.place.start(), self.place.end());
        let mut object = serializer.serialize_struct("Fix", 8)?;
        object.serialize_field("file", &self.place.file)?;
        object.serialize_field("line", &start.line)?;
        object.serialize_field("column", &start.column)?;
        object.serialize_field("end_line", &end.line)?;
        object.serialize_field("end_column", &end.column)?;
        object.serialize_field("text", &self.text)?;
        object.serialize_field("safety", &self.safety)?;
        match &self.also {
            Some(also) => object.serialize_field("also", also)?,
            None => object.skip_field("also")?,
        }
        object.end()
    }
}

/// A fix whose text contains a name that is known only when the message is made.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct NamedFix {
    /// Text to replace; an empty place inserts.
    pub place: Place,
    /// Replacement up to the name.
    pub before: String,
    /// The rest, after the name.
    pub after: String,
}

impl NamedFix {
    /// Returns the fix for a name; it has to be reviewed.
    pub fn guess(&self, name: &str) -> Fix {
        let Self { before, after, .. } = self;
        Fix::guess(self.place.clone(), format!("{before}{name}{after}"))
    }
}

/// A text after fixes.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Fixed {
    /// The text that replaces the original.
    pub text: String,
    /// Number of fixes applied; the others overlap an earlier one, or their place is outside the text.
    pub applied: usize,
}

impl Fixed {
    /// Applies fixes to a file, from its start to its end. Lines that a fix adds end like the first line of the file.
    pub fn new<'a>(source: &SourceFile, fixes: impl IntoIterator<Item = &'a Fix>) -> Self {
        let edits = edits(source, fixes);
        Self {
            text: edited(source.text(), &edits),
            applied: edits.len(),
        }
    }
}

/// A change of one text.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Edit {
    /// Text to replace.
    pub span: Span,
    /// Replacement, with the line ends of the text.
    pub text: String,
}

/// Returns the changes that fixes make in a file, from its start to its end. A fix that overlaps an earlier one, or
/// whose place is not in the text, changes nothing.
pub fn edits<'a>(source: &SourceFile, fixes: impl IntoIterator<Item = &'a Fix>) -> Vec<Edit> {
    let (text, lines) = (source.text(), source.lines());
    let line_end = line_end(text);
    let changes = fixes.into_iter().flat_map(Fix::changes);
    let placed = changes.filter_map(|fix| Some((source.find(&fix.place)?, fix)));
    let mut placed: Vec<(Span, &Fix)> = placed.collect();
    let key = |(span, fix): &(Span, &'a Fix)| (span.start, span.end, fix.text.as_str(), fix.form);
    placed.sort_by_key(key);
    placed.dedup_by_key(|placed| key(placed));
    let mut end = 0;
    placed.retain(|(span, _)| {
        let is_free = span.start >= end;
        if is_free {
            end = span.end;
        }
        is_free
    });
    let mut numbering = None;
    let written = placed.into_iter().map(|(span, fix)| {
        let new = match fix.form {
            FixForm::Text => fix.text.clone(),
            FixForm::Block => {
                let line = lines.line(span.start) - lines.first() + 1;
                let numbering = numbering.get_or_insert_with(|| Numbering::of(text));
                numbering.block(line, fix.text.trim_end()) + "\n"
            }
        };
        Edit {
            span,
            text: new.replace('\n', line_end),
        }
    });
    written.collect()
}

/// Returns a text after changes, given from its start to its end.
pub fn edited(text: &str, edits: &[Edit]) -> String {
    let mut result = String::with_capacity(text.len());
    let mut copied = 0;
    for edit in edits {
        let range = edit.span.range();
        result.push_str(&text[copied..range.start]);
        result.push_str(&edit.text);
        copied = range.end;
    }
    result.push_str(&text[copied..]);
    result
}

/// Returns the line end of the first line.
fn line_end(text: &str) -> &'static str {
    match text.find(['\r', '\n']).map(|at| &text[at..]) {
        Some(end) if end.starts_with("\r\n") => "\r\n",
        Some(end) if end.starts_with('\r') => "\r",
        _ => "\n",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fix(source: &SourceFile, found: &str, text: &str) -> Fix {
        let start = source.text().find(found).expect("it is there");
        Fix::guess(source.place(Span::new(start, start + found.len())), text)
    }

    #[test]
    fn fixes_are_applied_from_start_to_end() {
        let source = SourceFile::new("a.nc", "N1 X[COMP ON FRIKT]\r\n(\u{dc}) Y[CMP]\r\nM30");
        let second = fix(&source, "CMP", "COMP");
        let first = fix(&source, "FRIKT", "FRICT");
        let fixed = Fixed::new(&source, [&second, &first]);
        assert_eq!(
            (fixed.text.as_str(), fixed.applied),
            ("N1 X[COMP ON FRICT]\r\n(\u{dc}) Y[COMP]\r\nM30", 2)
        );
    }

    #[test]
    fn of_two_fixes_that_overlap_the_first_is_applied() {
        let source = SourceFile::new("a.nc", "N1 ABC");
        let (long, short) = (fix(&source, "ABC", "D"), fix(&source, "BC", "E"));
        let fixed = Fixed::new(&source, [&short, &long, &long]);
        assert_eq!((fixed.text.as_str(), fixed.applied), ("N1 D", 1));
    }

    #[test]
    fn inserted_lines_end_as_the_file_does() {
        for (text, expected) in [
            ("A\r\nM30", "A\r\nX\r\nM30"),
            ("A\rM30", "A\rX\rM30"),
            ("M30", "X\nM30"),
        ] {
            let source = SourceFile::new("a.nc", text);
            let mut insert = fix(&source, "M30", "X\n");
            insert.place.span.end = insert.place.span.start;
            assert_eq!(Fixed::new(&source, [&insert]).text, expected);
        }
    }

    #[test]
    fn a_fix_of_another_text_is_not_applied() {
        let old = SourceFile::new("a.nc", "N1 ABC");
        let fix = fix(&old, "ABC", "D");
        let new = SourceFile::new("a.nc", "N1 ABD");
        let fixed = Fixed::new(&new, [&fix]);
        assert_eq!((fixed.text.as_str(), fixed.applied), ("N1 ABD", 0));
    }
}
