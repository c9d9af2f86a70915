//! A single compensation value list, as the control would read it.

use std::sync::Arc;

use thiserror::Error;

use super::check::{Conditions, Verdict};
use super::friction::FrictionDraft;
use super::friction::FrictionList;
use super::line::Entries;
use crate::diagnostic::{Diagnostic, Severity};
use crate::text::SourceFile;

/// A value list that the control would accept.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ReadList {
    /// The values.
    pub list: FrictionList,
    /// Messages on the values.
    pub diagnostics: Vec<Diagnostic>,
}

/// A value list that gives the control no values.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct NoValues {
    /// The reason, in a few words.
    pub reason: &'static str,
    /// Messages on the lines that are the reason.
    pub diagnostics: Vec<Diagnostic>,
}

impl FrictionList {
    /// Reads the values that this list alone would give the control.
    ///
    /// # Errors
    /// The control would not accept them.
    pub fn read(source: SourceFile) -> Result<ReadList, NoValues> {
        let source = Arc::new(source);
        let entries = Entries::parse(&source);
        let mut diagnostics = entries.diagnostics.clone();
        let draft = FrictionDraft::from_entries(&entries, &mut diagnostics);
        let reading = draft.check(&Conditions::default());
        diagnostics.extend(reading.diagnostics);
        let reason = match reading.verdict {
            Verdict::Accepted(list) => return Ok(ReadList { list, diagnostics }),
            Verdict::Absent => "it holds no friction parameters",
            Verdict::Off => "its mode is 0, off",
            Verdict::Rejected(_) => "the control would reject it",
        };
        diagnostics.retain(|diagnostic| diagnostic.severity == Severity::Error);
        Err(NoValues {
            reason,
            diagnostics,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::friction::TablePoint;
    use super::super::write::{ListHead, Points, write_value_list};
    use super::*;

    #[test]
    fn a_list_is_taken_or_refused_as_a_whole() {
        let read = |text: &str| FrictionList::read(SourceFile::new("x.lis", text));
        let point = |input, output| TablePoint { input, output };
        let list = FrictionList {
            position_delay: 10,
            reversal_lookahead: 2,
            scaling_factor: 1000,
            delay_cycles: 0,
            max_points: 20,
            table: vec![point(0.0, 126.0), point(3000.0, 112.0)],
        };
        let text = write_value_list(&list, Points::Whole, &ListHead::default());
        assert_eq!(read(&text).map(|read| read.list), Ok(list));
        let reason = |text: &str| read(text).map_err(|refused| refused.reason);
        assert_eq!(
            reason("# nothing\n"),
            Err("it holds no friction parameters")
        );
        let rejected = read(&text.replace("3000", "0")).unwrap_err();
        assert_eq!(rejected.reason, "the control would reject it");
        assert!(!rejected.diagnostics.is_empty());
    }
}
