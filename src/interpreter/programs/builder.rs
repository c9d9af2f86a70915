//! Construction of the index of a program: control blocks are paired, labels and jumps noted.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::sync::Arc;

use crate::diagnostic::{Advice, Budget, Code, Collected};
use crate::interpreter::programs::index::{
    EntryIndex, Index, IndexEntry, JumpTargets, LabelName, Links, ProgramSection, not_a_program,
};
use crate::interpreter::programs::store::Parsed;
use crate::interpreter::values::value::rounded;
use crate::syntax::ast::{Block, BlockReference, Flow, Item, Operand};
use crate::syntax::{
    BlockReader, ControlBlock, FastPath, Fault, LostRemarks, MAX_MACROS, Part, Stretch,
    control_part, is_statement, no_program, with_macros,
};
use crate::text::{Place, SourceFile, Span, TextLines};

/// Blocks that are kept as they were parsed for the index; a run parses the others when it reaches them.
const MAX_PARSED: usize = 10_000;

/// A control block that is not closed yet.
struct Open {
    kind: ControlBlock,
    opener: EntryIndex,
    /// Statements of the control block so far.
    parts: Vec<EntryIndex>,
    span: Span,
    /// `$`, or the `#` of `#IF`; `None` for a misspelt statement.
    sign: Option<char>,
    /// Whether the `$ELSE` or `$DEFAULT` of the block was found.
    last_branch: bool,
    /// Whether a block before its first branch was refused.
    is_led: bool,
    /// Number of open blocks up to the innermost one of each kind, so that none has to be searched.
    innermost: [usize; ControlBlock::ALL.len()],
}

/// A jump whose label is looked up when the section is known.
struct PendingJump {
    section: usize,
    label: LabelName,
    entry: EntryIndex,
    span: Span,
}

impl Index {
    /// Indexes a text. Control blocks may be nested up to `nesting` levels deep.
    pub(crate) fn new(source: SourceFile, nesting: u32) -> Self {
        let builder = Builder {
            index: Self {
                source,
                entries: Vec::new(),
                parsed: Vec::new(),
                sections: Vec::new(),
                links: BTreeMap::new(),
                loops: BTreeMap::new(),
                unclosed: BTreeSet::new(),
                switches: BTreeMap::new(),
                labels: HashMap::new(),
                targets: JumpTargets::default(),
                locals: HashMap::new(),
                repeated: HashMap::new(),
                remarks: HashMap::new(),
                lost: LostRemarks::default(),
                interpreted: BTreeMap::new(),
                skips: BTreeMap::new(),
                split: BTreeMap::new(),
                openings: Collected::default(),
                main: None,
                refused: Collected::default(),
            },
            nesting: nesting as usize,
            open: Vec::new(),
            jumps: Vec::new(),
            inner: Vec::new(),
            shared: HashSet::new(),
            here: None,
            earlier: None,
        };
        builder.build()
    }
}

/// A statement of a control block, with the block that holds it.
#[derive(Clone, Copy)]
struct Statement<'a> {
    entry: EntryIndex,
    span: Span,
    text: &'a str,
}

impl<'a> Statement<'a> {
    fn word(self) -> &'a str {
        self.span.of(self.text)
    }

    /// Returns the sign of its statements, `$` or `#`.
    fn sign(self) -> char {
        self.word().chars().next().unwrap_or('$')
    }
}

struct Builder {
    index: Index,
    nesting: usize,
    open: Vec<Open>,
    jumps: Vec<PendingJump>,
    /// `$BREAK` and `$CONTINUE` with the loops that contain them, by opener.
    inner: Vec<(EntryIndex, EntryIndex)>,
    /// Blocks of several statements, which get one message each.
    shared: HashSet<EntryIndex>,
    /// The last block so far, once something was refused in it.
    here: Option<(EntryIndex, Place)>,
    /// The block before it in which something was last refused. Openers without an end are reported block by
    /// block, so that no block is read again for each of its statements.
    earlier: Option<(EntryIndex, Place)>,
}

impl Builder {
    fn build(mut self) -> Index {
        let text = self.index.source.shared_text();
        let first = self.index.source.lines().first();
        // The rest of a program that is read line by line begins somewhere in it.
        if let Some(what) = no_program(&text).filter(|_| first == 1) {
            let said = not_a_program(self.index.source.name(), what);
            self.index.refused.push(said);
            return self.index;
        }
        let mut reader = BlockReader::new(TextLines::new(&text), first, FastPath::On);
        let mut block = Block::default();
        self.section(None, None, false);
        while let Some(raw) = reader.next(&mut block) {
            match raw.stretch {
                Stretch::Program { name, local } => {
                    self.close_section();
                    let file = Arc::clone(self.index.source.name());
                    let opening = raw.place(&file, name);
                    self.section(Some(name.of(raw.text).to_owned()), Some(opening), local);
                    let said = raw.opening_said(&file, &block);
                    self.index.openings.extend(said);
                }
                Stretch::Block => {
                    let entry = Span::new(self.index.entries.len(), raw.offset);
                    self.index.entries.push(IndexEntry {
                        offset: entry.end,
                        line: raw.line,
                    });
                    if let Some(remark) = raw.remark {
                        self.index.remarks.insert(entry.start, remark.clone());
                    }
                    if let Some(level) = block.skip {
                        self.index.skips.insert(entry.start, level);
                    }
                    self.block(entry.start, &block, raw.text);
                    if self.index.parsed.len() < MAX_PARSED {
                        let file = self.index.source.name();
                        let parsed = Parsed::new(file, &raw, std::mem::take(&mut block));
                        self.index.parsed.push(Arc::new(parsed));
                    }
                }
            }
        }
        self.index.lost = reader.lost_remarks().clone();
        self.close_section();
        self.index.main = main_of(&self.index.sections);
        self.check_jumps();
        for (statement, opener) in std::mem::take(&mut self.inner) {
            // A loop without an end cannot be left: it is not a loop, which is reported at its opener.
            if !self.index.is_linked(opener) {
                continue;
            }
            let end = self.index.links(opener).end;
            let links = Links {
                opener,
                next: end,
                end,
            };
            self.index.links.insert(statement, links);
        }
        self.index
            .refused
            .said
            .sort_by(|one, other| one.place.cmp_start(&other.place));
        self.index
    }

    fn at(&self) -> EntryIndex {
        Span::new(self.index.entries.len(), self.index.entries.len()).start
    }

    fn section(&mut self, name: Option<String>, opening: Option<Place>, local: bool) {
        let start = self.at();
        if let Some(name) = name.as_ref().filter(|_| local) {
            let number = self.index.sections.len();
            let first = *self.index.locals.entry(name.clone()).or_insert(number);
            if first != number {
                let repeated = &mut self.index.repeated;
                repeated.entry(name.clone()).or_insert(number);
            }
        }
        self.index.sections.push(ProgramSection {
            name,
            local,
            opening,
            start,
            end: start,
        });
    }

    fn close_section(&mut self) {
        let end = self.at();
        if let Some(section) = self.index.sections.last_mut() {
            section.end = end;
        }
        let open = std::mem::take(&mut self.open);
        let is_if = |open: &Open| open.kind == ControlBlock::If && open.sign == Some('$');
        if open.len() <= self.nesting && open.iter().all(is_if) {
            for mut open in open {
                self.index.unclosed.insert(open.opener);
                open.parts.push(end);
                self.link(&open, end);
            }
        } else {
            for open in open {
                self.refuse_open(&open);
            }
        }
    }

    /// Links the parts of a control block up to its end.
    fn link(&mut self, open: &Open, end: EntryIndex) {
        for pair in open.parts.windows(2) {
            let links = Links {
                opener: open.opener,
                next: pair[1],
                end,
            };
            self.index.links.insert(pair[0], links);
        }
    }

    fn refuse(&mut self, entry: EntryIndex, fault: Fault) {
        if self.shared.contains(&entry) {
            return;
        }
        let block = self.place_of(entry);
        let place = |span| {
            let text = Arc::clone(&block.text);
            Place::in_block(&block.file, text, block.first_line, span)
        };
        let at = place(fault.span);
        let diagnostic = fault.into_diagnostic(at, |span| Some(place(span)));
        self.index.refused.push(diagnostic);
    }

    /// Returns a place in a block.
    fn place_of(&mut self, entry: EntryIndex) -> Place {
        let known = if entry + 1 == self.at() {
            &mut self.here
        } else {
            &mut self.earlier
        };
        match known {
            Some((known, place)) if *known == entry => place.clone(),
            _ => {
                let place = self.index.place(entry, Span::default());
                known.insert((entry, place)).1.clone()
            }
        }
    }

    /// Refuses an opener without an end, unless it is misspelt, which the block itself reports.
    fn refuse_open(&mut self, open: &Open) {
        if let Some(fault) = not_closed(open) {
            self.refuse(open.opener, fault);
        }
    }

    fn refuse_stray(&mut self, kind: ControlBlock, at: Statement<'_>) {
        if is_spelt(kind, at.word()) {
            self.refuse(at.entry, stray(kind, at));
        }
    }

    fn block(&mut self, entry: EntryIndex, block: &Block, text: &str) {
        if let Some(number) = block.number.filter(|number| number.label)
            && let Operand::Number(value) = number.value
        {
            if rounded(value).is_some() {
                self.label(entry, LabelName::numbered(value), number.span);
            } else {
                let shown = number.span.of(text).trim();
                let message = format!("`{shown}` is larger than any block number");
                self.refuse(entry, Fault::new(Code::Fc209, number.span, message));
            }
        }
        let targets = &mut self.index.targets;
        with_macros(block, text, MAX_MACROS, &mut |block, text| {
            for item in &block.items {
                if let Item::Flow(Flow::Goto(target), _) = item {
                    targets.take(target, text);
                }
            }
        });
        let at = |span| Statement { entry, span, text };
        self.before_cases(block, at(Span::new(0, text.trim_end().len())));
        self.shares_block(block, at);
        for item in &block.items {
            match (control_part(block, item), item) {
                (Some((kind, Part::Opener)), _) => self.opens(kind, at(item.span())),
                (Some((kind, Part::Branch)), item) => {
                    let is_last = matches!(item, Item::Flow(Flow::Else | Flow::Default, _));
                    self.branches(kind, at(item.span()), is_last);
                }
                (Some((kind, Part::Closer)), _) => self.closes(kind, at(item.span())),
                (None, Item::Label(span)) => {
                    let name = LabelName::Text(span.of(text).to_owned());
                    self.label(entry, name, *span);
                }
                (None, Item::Flow(flow, span)) => self.flow(flow, at(*span)),
                _ => {}
            }
        }
    }

    /// Reports FC208: a control statement whose block contains anything else (PM/206890763, errors 20212 to 20245).
    /// `$GOTO` may be among words, or after an `$IF` (PM/206915851).
    fn shares_block<'t>(&mut self, block: &Block, at: impl Fn(Span) -> Statement<'t>) {
        let jump = block.items.iter().find(|item| is_jump(item));
        let is_other = |item: &&Item| matches!(item, Item::Flow(..)) && !is_jump(item);
        let Some(statement) = block.items.iter().find(is_other).or(jump) else {
            return;
        };
        let from = match statement {
            Item::Flow(Flow::If(_), span) if jump.is_some() => span.start,
            Item::Flow(Flow::Goto(_), _) => 0,
            _ => u32::MAX,
        };
        let jump = jump.map(Item::span).filter(|jump| jump.start >= from);
        let is_shared = |item: &&Item| match item {
            Item::Label(_) => false,
            Item::Flow(_, span) => *span != statement.span() && Some(*span) != jump,
            _ => item.span().start < from,
        };
        let words = block.words.iter().map(|word| word.span);
        let mut words = words.filter(|word| word.start < from);
        let items = || block.items.iter().find(is_shared).map(Item::span);
        let Some(span) = words.next().or_else(items) else {
            return;
        };
        let (shown, word) = (at(span), at(statement.span()));
        let message = format!(
            "`{}` is in the same block as `{}`, which the control refuses",
            shown.word().trim(),
            word.word().trim()
        );
        let fault = Fault::new(Code::Fc208, span, message).with_help(
            "write it in a separate block: only `$GOTO` may be among words, or after an `$IF`",
        );
        self.refuse(shown.entry, fault);
        self.shared.insert(shown.entry);
    }

    fn label(&mut self, entry: EntryIndex, name: LabelName, span: Span) {
        let section = self.index.sections.len() - 1;
        let key = (section, name);
        if let Some(&first) = self.index.labels.get(&key) {
            let line = self.index.entries[first as usize].line;
            let fault = Fault::new(
                Code::Fc209,
                span,
                format!("jump label `{}` already exists on line {line}", key.1),
            );
            self.refuse(entry, fault);
        } else {
            self.index.labels.insert(key, entry);
        }
    }

    fn flow(&mut self, flow: &Flow, at: Statement<'_>) {
        match flow {
            Flow::Break => self.leaves(at, |kind| {
                !matches!(kind, ControlBlock::If | ControlBlock::RealTime)
            }),
            Flow::Continue => {
                let is_loop = |kind| {
                    !matches!(
                        kind,
                        ControlBlock::If | ControlBlock::Switch | ControlBlock::RealTime
                    )
                };
                // P-ERR-20244: a `$SWITCH` will do.
                let around: fn(ControlBlock) -> bool = match self.innermost(is_loop) {
                    Some(_) => is_loop,
                    None => |kind| kind == ControlBlock::Switch,
                };
                self.leaves(at, around);
            }
            Flow::Goto(target) => self.jump(target, at),
            _ => {}
        }
    }

    fn opens(&mut self, kind: ControlBlock, at: Statement<'_>) {
        if self.open.len() >= self.nesting {
            let fault = Fault::new(
                Code::Fc912,
                at.span,
                format!(
                    "control blocks are nested more than {} levels deep",
                    self.nesting
                ),
            )
            .with_help(Advice::RaiseBudget(Budget::Nesting));
            self.refuse(at.entry, fault);
        }
        let is_loop = |it: ControlBlock| !matches!(it, ControlBlock::If | ControlBlock::Switch);
        let around = |it: fn(ControlBlock) -> bool| {
            let depth = self.innermost(it);
            depth.map(|depth| self.open[depth].opener)
        };
        match kind {
            ControlBlock::If => {}
            ControlBlock::Switch => {
                let around = around(|it| it == ControlBlock::Switch);
                self.index.switches.insert(at.entry, around);
            }
            _ => {
                let around = around(is_loop);
                self.index.loops.insert(at.entry, around);
            }
        }
        let mut innermost = self.open.last().map(|open| open.innermost);
        innermost.get_or_insert_default()[kind as usize] = self.open.len() + 1;
        self.open.push(Open {
            kind,
            opener: at.entry,
            parts: vec![at.entry],
            span: at.span,
            sign: is_spelt(kind, at.word()).then(|| at.sign()),
            last_branch: false,
            is_led: false,
            innermost: innermost.unwrap_or_default(),
        });
    }

    /// Reports FC208: a block between `$SWITCH` and its first `$CASE`, which no value reaches.
    fn before_cases(&mut self, block: &Block, at: Statement<'_>) {
        let Some(open) = self.open.last_mut() else {
            return;
        };
        let belongs = |item: &Item| {
            let part = control_part(block, item);
            part.is_some_and(|(kind, part)| match part {
                Part::Opener => false,
                Part::Branch => kind == ControlBlock::Switch,
                Part::Closer => true,
            })
        };
        let is_before = open.kind == ControlBlock::Switch && open.parts.len() == 1;
        let mut items = block.items.iter();
        let first = items.find(|item| !matches!(item, Item::Label(_)));
        let begins = block.words.is_empty() && first.is_none_or(belongs);
        if !is_before || begins || open.is_led {
            return;
        }
        open.is_led = true;
        let message =
            "this block is between `$SWITCH` and its first `$CASE`, and no value leads to it";
        let fault = Fault::new(Code::Fc208, at.span, message)
            .with_help("write it before `$SWITCH`, or after a `$CASE`");
        self.refuse(at.entry, fault);
    }

    fn branches(&mut self, kind: ControlBlock, at: Statement<'_>, is_last: bool) {
        match self.open.last_mut() {
            Some(open) if open.kind == kind => {
                let after = open.last_branch;
                open.parts.push(at.entry);
                open.last_branch |= is_last;
                if after {
                    self.refuse(at.entry, after_last(kind, at));
                }
            }
            _ => self.refuse_stray(kind, at),
        }
    }

    fn closes(&mut self, kind: ControlBlock, at: Statement<'_>) {
        let Some(depth) = self.innermost(|it| it == kind) else {
            self.refuse_stray(kind, at);
            return;
        };
        for open in self.open.split_off(depth + 1) {
            self.refuse_open(&open);
        }
        let Some(mut open) = self.open.pop() else {
            return;
        };
        if open.kind == ControlBlock::If && open.sign == Some('#') {
            self.index.interpreted.insert(open.opener, at.entry);
        }
        open.parts.push(at.entry);
        let skips = &self.index.skips;
        if !skips.contains_key(&open.opener)
            && let Some(level) = open.parts.iter().find_map(|part| skips.get(part))
        {
            self.index.split.insert(open.opener, *level);
        }
        self.link(&open, at.entry);
        let links = Links {
            opener: open.opener,
            next: at.entry,
            end: at.entry,
        };
        self.index.links.insert(at.entry, links);
    }

    /// Returns the innermost open control block of certain kinds.
    fn innermost(&self, wanted: impl Fn(ControlBlock) -> bool) -> Option<usize> {
        let innermost = self.open.last()?.innermost;
        let kinds = ControlBlock::ALL.into_iter().filter(|kind| wanted(*kind));
        kinds
            .map(|kind| innermost[kind as usize])
            .max()?
            .checked_sub(1)
    }

    fn leaves(&mut self, at: Statement<'_>, left: fn(ControlBlock) -> bool) {
        if let Some(depth) = self.innermost(left) {
            self.inner.push((at.entry, self.open[depth].opener));
        } else {
            let word = at.word().trim();
            let fault = Fault::new(
                Code::Fc208,
                at.span,
                format!("`{word}` is not inside a loop"),
            );
            self.refuse(at.entry, fault);
        }
    }

    fn jump(&mut self, target: &BlockReference, at: Statement<'_>) {
        let Some(label) = LabelName::of(target, at.text) else {
            return;
        };
        self.jumps.push(PendingJump {
            section: self.index.sections.len() - 1,
            label,
            entry: at.entry,
            span: at.span,
        });
    }

    fn check_jumps(&mut self) {
        for jump in std::mem::take(&mut self.jumps) {
            if self.index.label(jump.section, jump.label.clone()).is_none() {
                let help = self.help_for_label(jump.section, &jump.label);
                let message = format!("jump label `{}` does not exist in this program", jump.label);
                let fault = Fault::new(Code::Fc209, jump.span, message).with_help(help);
                self.refuse(jump.entry, fault);
            }
        }
    }

    /// Returns the remedy for a missing label, which may exist in the other form.
    fn help_for_label(&self, section: usize, label: &LabelName) -> String {
        let other = label.in_other_form();
        let other = other.filter(|it| self.index.label(section, it.clone()).is_some());
        match (label, other) {
            (_, Some(other)) => {
                format!("this program has the label `{other}`: write `$GOTO {other}`")
            }
            (LabelName::Number(number), None) => {
                format!("write the label with a colon, `N{number}:`, in the same program")
            }
            (LabelName::Text(name), None) => {
                format!("write `[{name}]` at the start of the block to jump to")
            }
        }
    }
}

fn is_jump(item: &Item) -> bool {
    matches!(item, Item::Flow(Flow::Goto(_), _))
}

fn not_closed(open: &Open) -> Option<Fault> {
    let sign = open.sign?;
    if open.kind == ControlBlock::If && sign == '#' {
        let what = "this `#IF` has no `#ENDIF`";
        return Some(*Fault::refused(Code::PErr21387, open.span, what));
    }
    let (opener, closer) = (open.kind.opener(), open.kind.closer());
    let shown = |word: &str| word.replace('$', sign.encode_utf8(&mut [0; 4]));
    let (opener, closer) = (shown(opener), shown(closer));
    let fault = Fault::new(
        Code::Fc208,
        open.span,
        format!("`{opener}` has no `{closer}`"),
    );
    Some(fault.with_help(format!("write `{closer}` in a separate block")))
}

/// Returns whether a statement is one of the language, and not a misspelt one.
fn is_spelt(kind: ControlBlock, text: &str) -> bool {
    kind == ControlBlock::RealTime || is_statement(text)
}

fn stray(kind: ControlBlock, at: Statement<'_>) -> Fault {
    let word = at.word().split_whitespace().next().unwrap_or_default();
    let opener = kind
        .opener()
        .replace('$', at.sign().encode_utf8(&mut [0; 4]));
    Fault::new(
        Code::Fc208,
        at.span,
        format!("`{word}` without an open `{opener}`"),
    )
}

fn after_last(kind: ControlBlock, at: Statement<'_>) -> Fault {
    let word = at.word().split_whitespace().next().unwrap_or_default();
    let last = match kind {
        ControlBlock::If => at.sign().to_string() + "ELSE",
        _ => "$DEFAULT".to_owned(),
    };
    let message = format!("`{word}` follows `{last}`, which is the last branch");
    let help = format!("write `{last}` after all other branches");
    Fault::new(Code::Fc208, at.span, message).with_help(help)
}

/// Returns the section that a run of a file begins with: blocks before any `%` line, else the first program that is not
/// a local subprogram.
fn main_of(sections: &[ProgramSection]) -> Option<usize> {
    let is_main = |section: &ProgramSection| match section.name {
        None => section.end > section.start,
        Some(_) => !section.local,
    };
    sections.iter().position(is_main)
}
