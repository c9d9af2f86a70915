//! The messages of many programs, one a cause (R17.1).

use std::collections::HashMap;
use std::sync::Arc;

use super::findings::Findings;
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::text::Span;

/// Key by which two messages have one cause (R17.3). The message names the kind of compensation.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct CauseKey {
    file: Arc<str>,
    first_line: u32,
    span: Span,
    code: Code,
    severity: Severity,
    axis: Option<String>,
    message: String,
}

impl CauseKey {
    fn of(said: &Diagnostic) -> Self {
        if said.code == Code::Fc408 {
            // That nothing describes an axis is one cause, whichever block switches it (R18.2).
            return Self {
                file: Arc::default(),
                first_line: 0,
                span: Span::default(),
                code: said.code,
                severity: said.severity,
                axis: said.axis.clone(),
                message: said.help().join("\n"),
            };
        }
        Self {
            file: Arc::clone(&said.place.file),
            first_line: said.place.first_line,
            span: said.place.span,
            code: said.code,
            severity: said.severity,
            axis: said.axis.clone(),
            message: said.uncounted().to_owned(),
        }
    }
}

/// The messages of many programs: those that arise at the same block of a called program are one,
/// with the programs that reach it (R17.1).
///
/// ```
/// use frictcomp::machine::Machine;
/// use frictcomp::session::{Causes, SessionOptions};
/// use frictcomp::interpreter::NoFiles;
/// use frictcomp::text::SourceFile;
///
/// let mut causes = Causes::default();
/// for name in ["a.nc", "b.nc"] {
///     let program = SourceFile::new(name, "N10 Y[COMP ON FRICT]\nN20 M30\n");
///     let (machine, options) = (Machine::enabled(["X"]), SessionOptions::default());
///     causes.add(frictcomp::check(program, machine, options, &mut NoFiles));
/// }
/// // Each has its own block, so these are two.
/// assert_eq!(causes.diagnostics().len(), 2);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Causes {
    said: Vec<Diagnostic>,
    known: HashMap<CauseKey, usize>,
}

impl Causes {
    /// Adds the messages of one program; returns their positions among [`diagnostics`](Self::diagnostics).
    pub fn add(&mut self, findings: Findings) -> Vec<usize> {
        let said = findings.into_diagnostics();
        said.map(|said| self.say(said)).collect()
    }

    /// Adds one message, for example about a list; returns its position.
    pub fn say(&mut self, said: Diagnostic) -> usize {
        let next = self.said.len();
        let at = *self.known.entry(CauseKey::of(&said)).or_insert(next);
        let Some(known) = self.said.get_mut(at) else {
            self.said.push(said);
            return at;
        };
        if known.place != said.place {
            return at;
        }
        known.reached_from.append(&said.reached_from);
        if said.times > known.times {
            (known.times, known.message) = (said.times, said.message);
        }
        // The changes that remain serve all the programs.
        known.fixes.retain(|fix| said.fixes.contains(fix));
        at
    }

    /// The messages, in the order in which they were said first.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.said
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::{SourceFile, Span};

    #[test]
    fn equal_messages_at_one_place_are_one() {
        // R17.1, R17.3
        let file = SourceFile::new("sub.nc", "N1 X\nN2 Y");
        let said = |start, message: &str, program: &str| {
            let place = file.place(Span::new(start, start + 1));
            let mut said = Diagnostic::new(Code::Fc401, place, message);
            said.reached_from.add(&Arc::from(program));
            said
        };
        let mut causes = Causes::default();
        causes.say(said(3, "x", "a.nc"));
        causes.say(said(3, "y", "a.nc"));
        causes.say(said(3, "x", "b.nc"));
        causes.say(said(0, "x", "b.nc"));
        let mut warned = said(3, "x", "c.nc");
        warned.severity = Severity::Info;
        causes.say(warned);
        let lines: Vec<_> = causes.diagnostics().iter().map(Diagnostic::line).collect();
        assert_eq!(
            lines,
            [
                "x (reached from 2 programs: a.nc, b.nc)",
                "y (reached from a.nc)",
                "x (reached from b.nc)",
                "x (reached from c.nc)"
            ]
        );
    }
}
