//! The files of a run: which blocks were executed, and those that are kept parsed.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::at::{At, Shown};
use super::program::{EntryIndex, Index};
use super::run::Interpreter;
use crate::diagnostic::{Code, Collected};
use crate::machine::HarmlessWords;
use crate::syntax::{Comments, Fault, Remark, Stretch, ast::Block};
use crate::text::Span;

/// A file of the run.
pub(super) struct Unit {
    pub(super) index: Index,
    /// Blocks that were executed more than once, parsed.
    pub(super) kept: Vec<Option<Arc<Parsed>>>,
    /// Blocks below this one were executed before.
    pub(super) high: EntryIndex,
    /// Which blocks were executed, where that is asked for.
    pub(super) executed: Vec<bool>,
    /// Control blocks whose branch is not known offline.
    pub(super) undecided: BTreeSet<EntryIndex>,
}

/// A parsed block with its text and its place.
pub(super) struct Parsed {
    pub(super) block: Block,
    pub(super) file: Arc<str>,
    pub(super) line: u32,
    pub(super) text: String,
    pub(super) comments: Comments,
    pub(super) remark: Option<Remark>,
}

/// How many parsed blocks a run keeps.
pub(super) const MAX_KEPT: usize = 100_000;

impl Unit {
    pub(super) fn new(index: Index) -> Self {
        Self {
            kept: Vec::new(),
            high: 0,
            executed: vec![false; index.entries.len()],
            undecided: BTreeSet::new(),
            index,
        }
    }
}

impl Interpreter {
    /// A parsed block; those that are executed again are kept.
    pub(super) fn parsed(&mut self, unit: usize, entry: EntryIndex) -> Arc<Parsed> {
        let place = entry as usize;
        let unit = &mut self.units[unit];
        if let Some(Some(kept)) = unit.kept.get(place) {
            return Arc::clone(kept);
        }
        unit.executed[place] = true;
        let mut block = Block::default();
        let mut text = String::new();
        let mut comments = Comments::Possible;
        let mut remark = None;
        if let Some(mut reader) = unit.index.reader(entry)
            && let Some(raw) = reader.next(&mut block)
        {
            debug_assert_eq!(raw.stretch, Stretch::Block);
            raw.text.clone_into(&mut text);
            comments = raw.comments;
            remark = raw.remark.cloned();
        }
        let remark = remark.or_else(|| unit.index.remark(entry));
        let parsed = Arc::new(Parsed {
            block,
            file: Arc::clone(unit.index.source.name()),
            line: unit.index.entries[place].line,
            text,
            comments,
            remark,
        });
        let again = entry < unit.high;
        unit.high = unit.high.max(entry + 1);
        if again && self.kept < MAX_KEPT {
            if unit.kept.len() <= place {
                unit.kept.resize(unit.index.entries.len(), None);
            }
            unit.kept[place] = Some(Arc::clone(&parsed));
            self.kept += 1;
        }
        parsed
    }

    /// Blocks that no run of the program reached, for their syntax.
    pub(super) fn check_all_unexecuted(&mut self, notes: &mut Collected) {
        let Some(unit) = self.units.first() else {
            return;
        };
        let file = unit.index.source.name().clone();
        let mut unread_up_to = 0;
        for place in 0..unit.index.entries.len() {
            let entry = Span::new(place, place).start;
            if unit.executed[place] {
                // Branches that `#IF` left out are not read at all (R2.73).
                let decided = !unit.undecided.contains(&entry);
                let end = unit.index.interpreted_to(entry).filter(|_| decided);
                unread_up_to = unread_up_to.max(end.unwrap_or_default());
                continue;
            }
            if entry < unread_up_to {
                continue;
            }
            let mut block = Block::default();
            let Some(mut reader) = unit.index.reader(entry) else {
                continue;
            };
            // What is skipped is passed over on the way, too.
            if let Some(raw) = reader.next(&mut block)
                && !self.is_skipped(&block)
            {
                self.check_unexecuted(&file, (raw.line, raw.text), &block, notes);
            }
        }
    }

    pub(super) fn check_unexecuted(
        &self,
        file: &Arc<str>,
        (line, text): (u32, &str),
        block: &Block,
        notes: &mut Collected,
    ) {
        let shown = Shown::default();
        let at = At::of_text(file, (text, line), &shown);
        notes.extend(
            block
                .faults
                .iter()
                .filter(|fault| !is_harmless(&self.machine.harmless, fault, text))
                .map(|fault| at.diagnostic(fault.clone())),
        );
    }
}

/// Whether a fault is about a word that the user declares harmless.
pub(super) fn is_harmless(words: &HarmlessWords, fault: &Fault, text: &str) -> bool {
    fault.code == Code::Fc210 && words.has_command(fault.span.of(text))
}
