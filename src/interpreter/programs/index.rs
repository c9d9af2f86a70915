//! The index of a program with flow: blocks, sections, labels, control blocks.
//!
//! It holds offsets, not trees: blocks are parsed when they are executed, and kept only when they
//! are executed again.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Collected, Diagnostic};
use crate::interpreter::programs::store::Parsed;
use crate::interpreter::values::value::rounded;
use crate::syntax::ast::{Block, BlockReference, Operand};
use crate::syntax::{BlockReader, FastPath, LostRemarks, Remark, Stretch};
use crate::text::{Place, SourceFile, Span, TextLines};

/// The position of a block in [`Index::entries`].
pub(crate) type EntryIndex = u32;

/// A program of the run: a section of one of its files, both by their positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) struct ProgramId {
    pub(crate) unit: usize,
    pub(crate) section: usize,
}

impl ProgramId {
    /// The first section of the main file.
    pub(crate) const FIRST: Self = Self {
        unit: 0,
        section: 0,
    };
}

/// One block of the text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct IndexEntry {
    pub(crate) offset: u32,
    pub(crate) line: u32,
}

/// A main program or a local subprogram.
#[derive(Debug, Clone)]
pub(crate) struct ProgramSection {
    pub(crate) name: Option<String>,
    pub(crate) local: bool,
    /// Name in the `%` line, where it has one.
    pub(crate) opening: Option<Place>,
    pub(crate) start: EntryIndex,
    pub(crate) end: EntryIndex,
}

/// Statements of one control block.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Links {
    /// The statement that opened the control block.
    pub(crate) opener: EntryIndex,
    /// The next branch: `$ELSEIF`, `$ELSE`, `$CASE`, `$DEFAULT`, or the end.
    pub(crate) next: EntryIndex,
    /// The statement that closes it.
    pub(crate) end: EntryIndex,
}

/// A jump label within a section.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum LabelName {
    Number(i64),
    Text(String),
}

impl LabelName {
    /// Returns the label of a number. One that is larger than any block number names no block.
    pub(crate) fn numbered(number: f64) -> Self {
        rounded(number).map_or_else(|| Self::Text(format!("N{number}")), Self::Number)
    }

    /// Returns the label that a jump names; `None` where it computes it.
    pub(crate) fn of(target: &BlockReference, text: &str) -> Option<Self> {
        match target {
            BlockReference::Number(Operand::Number(number)) => Some(Self::numbered(*number)),
            BlockReference::Label(name) => Some(Self::Text(name.of(text).to_owned())),
            BlockReference::Number(Operand::Expression(_)) | BlockReference::Variable(_) => None,
        }
    }

    /// Returns the label of a block number for a text label such as `[N40]`, and the reverse.
    pub(crate) fn in_other_form(&self) -> Option<Self> {
        match self {
            Self::Number(number) => Some(Self::Text(format!("N{number}"))),
            Self::Text(text) => {
                let number = text.strip_prefix(['N', 'n'])?;
                number.parse().ok().map(Self::Number)
            }
        }
    }
}

impl std::fmt::Display for LabelName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "N{number}"),
            Self::Text(text) => write!(f, "[{text}]"),
        }
    }
}

/// Control blocks whose borders a jump crosses, where the control may refuse it (R2.103).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum JumpAcross {
    /// No border, or only those of blocks that the jump leaves completely.
    Nothing,
    /// Jump that stays within its loop.
    WithinLoop,
    /// Jump out of a loop that stays within another loop.
    OneOfSeveralLoops,
    /// Jump into a loop.
    IntoLoop,
    /// Jump into a `$SWITCH`.
    IntoSwitch,
}

/// Control blocks of a kind by their openers, each with the innermost one of the kind around it.
pub(crate) type OpenedBlocks = BTreeMap<EntryIndex, Option<EntryIndex>>;

/// The targets of the jumps of a program.
#[derive(Debug, Default)]
pub(crate) struct JumpTargets {
    named: HashSet<LabelName>,
    /// Whether a jump computes its target.
    are_computed: bool,
}

impl JumpTargets {
    /// Takes the target of a jump.
    pub(crate) fn take(&mut self, target: &BlockReference, text: &str) {
        match LabelName::of(target, text) {
            Some(name) => _ = self.named.insert(name),
            None => self.are_computed = true,
        }
    }

    /// Returns whether a label may be one of them, in either form.
    pub(crate) fn may_be(&self, label: &LabelName) -> bool {
        let other = label.in_other_form();
        self.are_computed
            || self.named.contains(label)
            || other.is_some_and(|other| self.named.contains(&other))
    }
}

/// The index of one file.
#[derive(Debug)]
pub(crate) struct Index {
    pub(crate) source: SourceFile,
    pub(crate) entries: Vec<IndexEntry>,
    /// The first blocks, parsed, until a run takes them.
    pub(crate) parsed: Vec<Arc<Parsed>>,
    pub(crate) sections: Vec<ProgramSection>,
    pub(crate) links: BTreeMap<EntryIndex, Links>,
    /// The loops.
    pub(crate) loops: OpenedBlocks,
    /// The `$IF` statements without `$ENDIF`, which reach to the end of their section.
    pub(crate) unclosed: BTreeSet<EntryIndex>,
    /// The `$SWITCH` blocks.
    pub(crate) switches: OpenedBlocks,
    pub(crate) labels: HashMap<(usize, LabelName), EntryIndex>,
    pub(crate) targets: JumpTargets,
    /// The local subprograms by name, the first of each.
    pub(crate) locals: HashMap<String, usize>,
    /// The names that several local subprograms have, each with the section of the second.
    pub(crate) repeated: HashMap<String, usize>,
    pub(crate) remarks: HashMap<EntryIndex, Remark>,
    /// Comments to this tool that no block follows.
    pub(crate) lost: LostRemarks,
    /// Ends of the branches of each `#IF`.
    pub(crate) interpreted: BTreeMap<EntryIndex, EntryIndex>,
    /// The blocks with a skip mark, with their levels.
    pub(crate) skips: BTreeMap<EntryIndex, u8>,
    /// The openers of control blocks of which another part has a skip mark, with its level.
    pub(crate) split: BTreeMap<EntryIndex, u8>,
    /// Messages on the `%` lines.
    pub(crate) openings: Collected,
    /// The section that a run of the file executes.
    pub(crate) main: Option<usize>,
    /// Faults that keep the program from running at all.
    pub(crate) refused: Collected,
}

impl Index {
    /// Returns whether a `$` statement belongs to a control block that is whole.
    pub(crate) fn is_linked(&self, entry: EntryIndex) -> bool {
        self.links.contains_key(&entry)
    }

    /// Returns the last `$IF` without `$ENDIF` of a section.
    pub(crate) fn last_unclosed(&self, section: usize) -> Option<EntryIndex> {
        let section = self.sections.get(section)?;
        let mut unclosed = self.unclosed.range(section.start..section.end);
        unclosed.next_back().copied()
    }

    /// Returns the links of a `$` statement.
    pub(crate) fn links(&self, entry: EntryIndex) -> Links {
        self.links.get(&entry).copied().unwrap_or(Links {
            opener: entry,
            next: entry,
            end: entry,
        })
    }

    /// Returns FC323 where the file has only local subprograms.
    pub(crate) fn no_main_program(&self) -> Option<Diagnostic> {
        let first_local = self.sections.iter().find(|section| section.local)?;
        let place = first_local.opening.clone()?;
        let message = "the file has no main program, only local subprograms; nothing of it was run";
        let said = Diagnostic::new(Code::Fc323, place, message);
        Some(said.with_help("begin the main program with `%NAME`"))
    }

    /// Returns FC103 where the program that a run executes has no block (R18.6).
    pub(crate) fn no_block(&self) -> Option<Diagnostic> {
        let is_empty = match self.main {
            Some(main) => self.sections.get(main).is_some_and(|it| it.start == it.end),
            None => self.entries.is_empty() && self.locals.is_empty(),
        };
        (is_empty && self.refused.is_empty()).then(|| no_block(self.source.name()))
    }

    /// Returns FC324 for every main program with blocks except the one that runs, with its first block. A lone `%` may
    /// end a file.
    pub(crate) fn other_mains(&self) -> impl Iterator<Item = (EntryIndex, Diagnostic)> {
        let others = self.sections.iter().enumerate();
        let others = others.filter(|(number, section)| {
            !section.local && section.end > section.start && self.main != Some(*number)
        });
        others.filter_map(|(_, section)| Some((section.start, never_run(section.opening.clone()?))))
    }

    /// Returns the line of the `%` that follows the main program; `u32::MAX` where the file ends with it.
    pub(crate) fn end_of_main(&self) -> u32 {
        let next = self.main.and_then(|main| self.sections.get(main + 1));
        let opening = next.and_then(|section| section.opening.as_ref());
        opening.map_or(u32::MAX, |place| place.first_line)
    }

    /// Returns the text of a program from one of its blocks on.
    pub(crate) fn text_from(&self, section: usize, first: EntryIndex) -> &str {
        let end = self.sections.get(section).map(|section| section.end);
        let offset = |entry: EntryIndex| {
            let entry = self.entries.get(usize::try_from(entry).ok()?)?;
            usize::try_from(entry.offset).ok()
        };
        let text = self.source.text();
        let to = end.and_then(offset).unwrap_or(text.len());
        offset(first)
            .and_then(|from| text.get(from..to))
            .unwrap_or_default()
    }

    /// Returns a local subprogram by its name.
    pub(crate) fn local(&self, name: &str) -> Option<usize> {
        self.locals.get(name).copied()
    }

    /// Returns the opening of another local subprogram of a name that several have.
    pub(crate) fn repeated_local(&self, name: &str) -> Option<&Place> {
        let section = self.sections.get(*self.repeated.get(name)?)?;
        section.opening.as_ref()
    }

    /// Returns the names of the local subprograms.
    pub(crate) fn local_names(&self) -> impl Iterator<Item = &str> {
        self.sections
            .iter()
            .filter(|section| section.local)
            .filter_map(|section| section.name.as_deref())
    }

    /// Returns the block of a label.
    pub(crate) fn label(&self, section: usize, label: LabelName) -> Option<EntryIndex> {
        self.labels.get(&(section, label)).copied()
    }

    /// Returns the jump labels of a section in the order of the text; `None` where there are more than a number of
    /// them.
    pub(crate) fn few_labels(
        &self,
        section: usize,
        most: usize,
    ) -> Option<Vec<(&LabelName, EntryIndex)>> {
        let labels = self.labels.iter().filter(|((of, _), _)| *of == section);
        let labels = labels.map(|((_, name), entry)| (name, *entry));
        let mut labels: Vec<_> = labels.take(most + 1).collect();
        labels.sort_unstable_by_key(|(name, entry)| (*entry, name.to_string()));
        (labels.len() <= most).then_some(labels)
    }

    /// Returns the blocks of a section that have jump labels.
    pub(crate) fn labels(&self, section: usize) -> impl Iterator<Item = EntryIndex> {
        let mut found: Vec<EntryIndex> = self
            .labels
            .iter()
            .filter(|((of, _), _)| *of == section)
            .map(|(_, entry)| *entry)
            .collect();
        found.sort_unstable();
        found.into_iter()
    }

    /// Returns the blocks of a section by their numbers; of a number given twice the first one.
    pub(crate) fn numbers(&self, section: usize) -> HashMap<i64, EntryIndex> {
        let mut numbers = HashMap::new();
        let Some(section) = self.sections.get(section) else {
            return numbers;
        };
        let mut reader = self.reader(section.start);
        let mut block = Block::default();
        for entry in section.start..section.end {
            while let Some(raw) = reader.next(&mut block) {
                if raw.stretch == Stretch::Block {
                    break;
                }
            }
            if let Some(number) = &block.number
                && let Operand::Number(value) = number.value
                && let Some(value) = rounded(value)
            {
                numbers.entry(value).or_insert(entry);
            }
        }
        numbers
    }

    /// Returns the place of a span in the text of a block.
    pub(crate) fn place(&self, entry: EntryIndex, span: Span) -> Place {
        let mut block = Block::default();
        self.reader(entry).next(&mut block).map_or_else(
            || self.block_place(entry),
            |raw| Place {
                file: self.source.name().clone(),
                text: raw.text.into(),
                first_line: raw.line,
                span,
            },
        )
    }

    /// Returns the place of a whole block's first line.
    pub(crate) fn block_place(&self, entry: EntryIndex) -> Place {
        let line = self
            .entries
            .get(entry as usize)
            .map_or(1, |entry| entry.line);
        let text = self.source.text();
        let span = self.source.lines().line_span(text, line);
        let (start, block) = (span.start as usize, span.of(text).trim_end());
        self.source.place(Span::new(start, start + block.len()))
    }

    /// Returns the loop that contains a block, by its opener.
    pub(crate) fn innermost_loop(&self, entry: EntryIndex) -> Option<EntryIndex> {
        let opens = self.loops.contains_key(&entry);
        opens.then_some(entry).or_else(|| self.loop_around(entry))
    }

    /// Returns the innermost loop that contains a block and does not begin with it, by its opener.
    pub(crate) fn loop_around(&self, entry: EntryIndex) -> Option<EntryIndex> {
        self.opened_around(&self.loops, entry).next()
    }

    /// Returns the control blocks that contain a block and do not begin with it, by their openers, the innermost first.
    fn opened_around<'a>(
        &'a self,
        blocks: &'a OpenedBlocks,
        entry: EntryIndex,
    ) -> impl Iterator<Item = EntryIndex> + 'a {
        let last = blocks.range(..entry).next_back();
        let outwards = std::iter::successors(last.map(|(opener, _)| *opener), |opener| {
            blocks.get(opener).copied().flatten()
        });
        outwards.filter(move |opener| self.is_within(entry, *opener))
    }

    /// Returns whether a block is within a control block, by its opener, and does not open it.
    fn is_within(&self, entry: EntryIndex, opener: EntryIndex) -> bool {
        opener < entry && entry <= self.links(opener).end
    }

    /// Returns the control blocks that a jump crosses (R2.103).
    pub(crate) fn jump_across(&self, from: EntryIndex, to: EntryIndex) -> JumpAcross {
        let mut loops = self.opened_around(&self.loops, from);
        let mut enters_switch = self
            .opened_around(&self.switches, to)
            .filter(|opener| !self.is_within(from, *opener));
        match loops.next() {
            Some(innermost) if self.is_within(to, innermost) => JumpAcross::WithinLoop,
            _ if loops.any(|opener| self.is_within(to, opener)) => JumpAcross::OneOfSeveralLoops,
            _ if self.loop_around(to).is_some() => JumpAcross::IntoLoop,
            _ if enters_switch.next().is_some() => JumpAcross::IntoSwitch,
            _ => JumpAcross::Nothing,
        }
    }

    /// Returns the end of the branches of an `#IF`.
    pub(crate) fn interpreted_to(&self, entry: EntryIndex) -> Option<EntryIndex> {
        self.interpreted.get(&entry).copied()
    }

    /// Returns the comment line above a block that is addressed to this tool.
    pub(crate) fn remark(&self, entry: EntryIndex) -> Option<Remark> {
        self.remarks.get(&entry).cloned()
    }

    /// Returns a reader that is positioned before a block, or at the end of the text.
    pub(crate) fn reader(&self, entry: EntryIndex) -> BlockReader<TextLines<'_>> {
        let text = self.source.text();
        let entry = self.entries.get(entry as usize);
        let (offset, line) = entry.map_or((text.len(), 1), |it| (it.offset as usize, it.line));
        BlockReader::new(TextLines::starting_at(text, offset), line, FastPath::On)
    }
}

/// Returns FC103: a file whose program has no block.
pub(crate) fn no_block(file: &Arc<str>) -> Diagnostic {
    let place = Place::head_of(file);
    let message = "the program has no block: the control executes nothing and keeps every state";
    Diagnostic::new(Code::Fc103, place, message)
        .with_help("check whether it was saved and copied as a whole")
}

/// Returns FC104: a file that is something else.
pub(crate) fn not_a_program(file: &Arc<str>, what: &str) -> Diagnostic {
    let place = Place::head_of(file);
    let message = format!("this file is {what}, not an NC program; nothing of it was run");
    Diagnostic::new(Code::Fc104, place, message)
        .with_help("name the program itself, or keep the file out of the folder")
}

/// Returns FC324: a main program, by its name in its `%` line, after the one that its file runs.
pub(crate) fn never_run(name: Place) -> Diagnostic {
    let (shown, call) = match name.span.of(&name.text) {
        "" => ("without a name".to_owned(), "%L NAME".to_owned()),
        named => (format!("`{named}`"), format!("%L {named}")),
    };
    let message = format!("the main program {shown} is never run: another one comes before it");
    Diagnostic::new(Code::Fc324, name, message).with_help(format!(
        "give it a file of its own, or make it a subprogram with `{call}`"
    ))
}
