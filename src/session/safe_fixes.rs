//! The changes that may be made without a review, from the messages of runs (R9.82).

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic, Fix, Safety};
use crate::timeline::{Record, Sink};

/// The safe changes that one run proposes, and the files that it saw: a sink.
#[derive(Debug, Clone, Default)]
pub struct ProposedFixes {
    files: BTreeSet<Arc<str>>,
    /// The file of the last block.
    last: Option<Arc<str>>,
    fixes: HashMap<Fix, Code>,
}

impl ProposedFixes {
    fn see(&mut self, file: &str) {
        if self.last.as_deref() != Some(file) {
            let file: Arc<str> = file.into();
            self.files.insert(Arc::clone(&file));
            self.last = Some(file);
        }
    }

    /// Takes the first safe change of a message; the others would do the same in another way.
    fn take(&mut self, said: &Diagnostic) {
        let mut safe = said.fixes.iter().filter(|it| it.safety == Safety::Safe);
        if let Some(fix) = safe.next() {
            self.files.insert(Arc::clone(&fix.place.file));
            self.fixes.insert(fix.clone(), said.code);
        }
    }
}

impl Sink for ProposedFixes {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            self.see(row.file);
        }
        for said in record.diagnostics() {
            self.take(said.diagnostic());
        }
        ControlFlow::Continue(())
    }
}

/// The safe changes that apply to all runs of some programs, file by file.
#[derive(Debug, Clone, Default)]
pub struct SafeFixes {
    files: BTreeMap<Arc<str>, FileFixes>,
}

#[derive(Debug, Clone, Default)]
struct FileFixes {
    /// Number of runs that executed the file.
    runs: usize,
    /// Each change, its code, and how many runs propose it.
    proposed: HashMap<Fix, (Code, usize)>,
}

impl SafeFixes {
    /// Adds the changes that one run proposes.
    pub fn add(&mut self, run: ProposedFixes) {
        for file in run.files {
            self.files.entry(file).or_default().runs += 1;
        }
        for (fix, code) in run.fixes {
            let file = self.files.entry(Arc::clone(&fix.place.file)).or_default();
            file.proposed.entry(fix).or_insert((code, 0)).1 += 1;
        }
    }

    /// The changes of each file. A comment that silences nothing in one run may be needed in
    /// another one that calls the same program: it goes only if no run needs it.
    pub fn of_files(self) -> impl Iterator<Item = (Arc<str>, Vec<Fix>)> {
        let files = self.files.into_iter().map(|(name, file)| {
            let holds = |(code, runs): (Code, usize)| code != Code::Fc490 || runs == file.runs;
            let proposed = file.proposed.into_iter();
            let fixes = proposed.filter_map(|(fix, by)| holds(by).then_some(fix));
            (name, fixes.collect::<Vec<_>>())
        });
        files.filter(|(_, fixes)| !fixes.is_empty())
    }
}
