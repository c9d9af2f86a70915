//! A block: its place and text, what its words leave while it is executed, and its actions after them.

use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Change, Kind, KindSet};
use crate::diagnostic::{Code, Collected, Diagnostic, Severity};
use crate::interpreter::events::{Aside, EndedBy, Note, Outcome};
use crate::interpreter::motion::block::BlockMotion;
use crate::interpreter::programs::calls::WantedCall;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::store::Parsed;
use crate::interpreter::stack::ControlStep;
use crate::interpreter::values::externals::{HeldValues, SetAt};
use crate::interpreter::values::location::{MissingProgram, Unknown};
use crate::interpreter::values::value::Slot;
use crate::interpreter::ways::path::{EarlierStates, Path};
use crate::interpreter::ways::words::seen_from;
use crate::language::{AxisWords, BlockGroup, GFunction, Group, OnOff};
use crate::machine::HarmlessWords;
use crate::syntax::ast::{Block, BlockSharing, Declaration, Item};
use crate::syntax::{Comments, Fault, RawBlock, Remark, VariableName, code_of};
use crate::text::{MAX_WHOLE, Place, Span};

/// The place of a block, and what is known about it apart from its tree.
pub(crate) struct BlockContext<'a> {
    pub(crate) block: &'a Block,
    pub(crate) file: &'a Arc<str>,
    pub(crate) text: &'a str,
    pub(crate) line: u32,
    pub(crate) comments: Comments,
    pub(crate) remark: Option<&'a Remark>,
    pub(crate) level: u32,
    pub(crate) called_from: Option<&'a Place>,
    /// Number of macros around the code.
    pub(crate) macro_depth: u32,
    /// Span of the use of the outermost of them in the block.
    pub(crate) used: Option<Span>,
    /// The lines of the text that messages showed last.
    pub(crate) shown: &'a ShownBlockLines,
}

/// The code of a macro in place of words.
pub(crate) struct MacroCode<'a> {
    pub(crate) text: &'a str,
    pub(crate) block: &'a Block,
    /// Number of macros around it, its own included.
    pub(crate) depth: u32,
}

/// The lines of a block that a message showed last. The next one often shows the same, and then
/// they are held once; a block of many lines is gone through once for all its messages (R2.85).
#[derive(Debug, Default)]
pub(crate) struct ShownBlockLines(RefCell<Option<LineSpan>>);

#[derive(Debug)]
struct LineSpan {
    /// Offset of their start in the block's text.
    from: usize,
    to: usize,
    /// The number of the first of them.
    number: u32,
    text: Arc<str>,
    /// Offsets of the ends of the first and the last line between them.
    breaks: Option<(usize, usize)>,
}

impl ShownBlockLines {
    /// Returns the place of a span: only the lines of the block that it touches.
    fn place(&self, at: &BlockContext<'_>, span: Span) -> Place {
        let text = at.text;
        let clamped = |offset: u32| {
            let offset = usize::try_from(offset).unwrap_or(usize::MAX);
            offset.min(text.len())
        };
        let (start, end) = (clamped(span.start), clamped(span.end.max(span.start)));
        let mut last = self.0.borrow_mut();
        let held = last.as_ref().filter(|lines| lines.show(start, end));
        let lines = if let Some(held) = held {
            held
        } else {
            let bytes = text.as_bytes();
            let from = memchr::memrchr(b'\n', &bytes[..start]).map_or(0, |at| at + 1);
            let to = memchr::memchr(b'\n', &bytes[end..]).map_or(text.len(), |at| end + at);
            // Messages mostly come from left to right: what was counted is not counted again.
            let (counted, number) = match last.as_ref() {
                Some(lines) if lines.from <= from => (lines.from, lines.number),
                _ => (0, at.line),
            };
            let breaks = memchr::memchr_iter(b'\n', &bytes[counted..from]).count();
            last.insert(LineSpan {
                from,
                to,
                number: number.saturating_add(u32::try_from(breaks).unwrap_or(u32::MAX)),
                text: text.get(from..to).unwrap_or(text).into(),
                breaks: memchr::memchr(b'\n', &bytes[from..to])
                    .zip(memchr::memrchr(b'\n', &bytes[from..to]))
                    .map(|(first, last)| (from + first, from + last)),
            })
        };
        Place {
            file: at.file.clone(),
            text: lines.text.clone(),
            first_line: lines.number,
            span: Span::new(start - lines.from, end - lines.from),
        }
    }
}

impl LineSpan {
    /// Returns whether the text between two offsets is shown with these lines.
    fn show(&self, start: usize, end: usize) -> bool {
        let is_within = self.from <= start && start <= self.to && end <= self.to;
        let touches_all = || {
            self.breaks
                .is_none_or(|(first, last)| start <= first && last < end)
        };
        is_within && (self.text.len() <= MAX_WHOLE || touches_all())
    }
}

impl<'a> BlockContext<'a> {
    /// Returns the block as one that sets a variable.
    pub(crate) fn as_setter(&self) -> SetAt {
        SetAt {
            file: self.file.clone(),
            line: self.line,
        }
    }

    /// Returns a block of the main program, or one that is inspected, not executed.
    #[inline]
    pub(crate) fn of_raw(
        file: &'a Arc<str>,
        raw: &RawBlock<'a>,
        block: &'a Block,
        shown: &'a ShownBlockLines,
    ) -> Self {
        Self {
            block,
            file,
            text: raw.text,
            line: raw.line,
            comments: raw.comments,
            remark: raw.remark,
            level: 0,
            called_from: None,
            macro_depth: 0,
            used: None,
            shown,
        }
    }

    /// Returns a block of the program that runs on a level of the call stack.
    pub(crate) fn of_parsed(parsed: &'a Parsed, level: u32, shown: &'a ShownBlockLines) -> Self {
        Self {
            block: &parsed.block,
            file: &parsed.file,
            text: &parsed.text,
            line: parsed.line,
            comments: parsed.comments,
            remark: parsed.remark.as_ref(),
            level,
            called_from: None,
            macro_depth: 0,
            used: None,
            shown,
        }
    }

    /// Returns the context of another block of the same program.
    pub(crate) fn other(&self, parsed: &'a Parsed, shown: &'a ShownBlockLines) -> Self {
        Self {
            block: &parsed.block,
            text: &parsed.text,
            line: parsed.line,
            shown,
            ..*self
        }
    }

    /// Returns the code of a macro that is used at a span of this block or macro.
    pub(crate) fn in_macro(
        &self,
        code: &MacroCode<'a>,
        used: Span,
        shown: &'a ShownBlockLines,
    ) -> Self {
        Self {
            block: code.block,
            text: code.text,
            macro_depth: code.depth,
            used: self.used.or(Some(used)),
            shown,
            ..*self
        }
    }
}

impl BlockContext<'_> {
    /// Returns the span in the block of a span here, for messages once the whole block is known.
    pub(crate) fn in_block(&self, span: Span) -> Span {
        self.used.unwrap_or(span)
    }

    pub(crate) fn place(&self, span: Span) -> Place {
        self.shown.place(self, span)
    }

    pub(crate) fn diagnostic(&self, fault: Fault) -> Diagnostic {
        let place = self.place(fault.span);
        // The code of a macro is not the text of the program.
        let in_text = |span| self.used.is_none().then(|| self.place(span));
        let mut diagnostic = fault.into_diagnostic(place, in_text);
        if let Some(caller) = self.called_from {
            diagnostic = diagnostic.with_label(caller.clone(), "called from here");
        }
        diagnostic
    }
}

/// The block that ends the program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct OwnEnd {
    pub(crate) place: Place,
    /// Whether no jump goes to the block.
    pub(crate) is_passed_into: bool,
}

/// The last executed block, in case the program ends without M30.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LastBlock {
    pub(crate) file: Arc<str>,
    pub(crate) line: u32,
    pub(crate) text: String,
}

impl LastBlock {
    /// Returns the whole block.
    pub(crate) fn place(&self) -> Place {
        Place {
            file: self.file.clone(),
            text: self.text.as_str().into(),
            first_line: self.line,
            span: Span::new(0, self.text.len()),
        }
    }
}

/// Action required between an error and the next program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum AfterError {
    /// A reset of the channel.
    #[default]
    Reset,
    /// A reset of the channel, or a restart of the control (R2.100).
    ResetOrRestart,
}

/// A program that only the machine has, and its call: the state that it leaves is not known.
#[derive(Debug, Clone)]
pub(crate) struct LeftOpen {
    pub(crate) program: MissingProgram,
    pub(crate) place: Place,
}

/// Blocks of a file that the block being executed passes over.
#[derive(Debug, Clone)]
pub(crate) struct PassedBlocks {
    pub(crate) unit: usize,
    pub(crate) blocks: Range<EntryIndex>,
    /// The value that decides whether they are executed.
    pub(crate) cause: Unknown,
    /// The message about them, where the run goes on after them.
    pub(crate) said: Option<Diagnostic>,
}

/// A block while it is executed: what its words read, how it moves, what it switches, how it ends, and the messages on it.
/// The buffers are used again for each block.
#[derive(Default, Clone)]
pub(crate) struct BlockScratch {
    pub(crate) outcomes: Vec<Outcome>,
    pub(crate) changes: Vec<Change>,
    /// Kinds that may or may not have been switched.
    pub(crate) doubted: Vec<(AxisIndex, KindSet)>,
    pub(crate) left_open: Option<LeftOpen>,
    /// The states before the block, where the control may skip its commands (R2.109).
    pub(crate) earlier: Option<Box<EarlierStates>>,
    pub(crate) read: BlockReading,
    pub(crate) moves: BlockMotion,
    pub(crate) aside: Aside,
    /// The blocks that it passes over, which only the machine may execute.
    pub(crate) passed: Vec<PassedBlocks>,
    /// The paths on which the run may go on elsewhere than after them.
    pub(crate) left: Vec<Path>,
    pub(crate) actions: BlockActions,
    pub(crate) ending: BlockEnding,
    pub(crate) messages: BlockMessages,
    /// Whether the block has only coordinates, a feed and G functions of groups so far, each a plain number.
    pub(crate) has_plain_words: bool,
    /// Whether an axis occurred for the first time.
    pub(crate) new_axes: bool,
    /// Whether a value was written.
    pub(crate) wrote: bool,
}

/// Values read by the words of a block.
#[derive(Default, Clone)]
pub(crate) struct BlockReading {
    pub(crate) stack: RefCell<Vec<Slot>>,
    pub(crate) notes: RefCell<Vec<Note>>,
    /// The variables that its expressions read and that the PLC may write, where their value is known (R2.99).
    pub(crate) relied: RefCell<Vec<VariableName>>,
    pub(crate) held: HeldValues,
    /// Whether the PLC acts by design in the block.
    pub(crate) plc_acts: bool,
    /// The states of compensation that its expressions read.
    pub(crate) asked: RefCell<Vec<(AxisIndex, Kind)>>,
    /// Whether a text of the block had no known meaning; what depends on it is not reported again
    /// (R2.71).
    pub(crate) unread: Cell<bool>,
    /// A variable that was read and whose reading flushes the channel, where that matters (R1.42).
    pub(crate) flushing: RefCell<Option<VariableName>>,
    /// A `V.I.` variable that was read and that no program of the run declares (R2.102).
    pub(crate) undeclared: RefCell<Option<String>>,
    /// Reason why an unknown program may be called, if one may.
    pub(crate) unknown_call: Option<Unknown>,
    /// A part of the macro expanded last that limits what may be in the block.
    pub(crate) lone: Option<LonePart>,
    /// Macros that the block has expanded.
    pub(crate) expansions: Cell<u32>,
}

/// End of the program, or of a way through it, at a block.
#[derive(Default, Clone)]
pub(crate) struct BlockEnding {
    /// The block that ends the program.
    pub(crate) at: Option<OwnEnd>,
    /// Action required after the error by which the block ends the program.
    pub(crate) after_error: AfterError,
    /// Messages on the end of the run or of a way through it: a budget, or the end of a file
    /// without M30.
    pub(crate) over: Vec<Diagnostic>,
    /// Whether the way ends here because another way does the same from here on.
    pub(crate) covered: bool,
    /// Whether the way ends here in a loop that never ends.
    pub(crate) endless: bool,
    /// Whether calls are nested too deeply for the run to continue (R9.91).
    pub(crate) too_deep: bool,
}

/// The messages on a block.
#[derive(Default, Clone)]
pub(crate) struct BlockMessages {
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Errors that end some of the ways that lead to the block, and not the others.
    pub(crate) of_some_ways: Vec<Diagnostic>,
    /// Number of messages on the last block.
    pub(crate) said: u64,
    /// Number of messages on the block that are left out, and the place of the first of them.
    pub(crate) unsaid: Option<(Span, u64)>,
}

impl BlockReading {
    /// Returns whether a variable was read whose reading the control may refuse.
    #[inline]
    pub(crate) fn may_be_refused(&mut self) -> bool {
        self.flushing.get_mut().is_some() || self.undeclared.get_mut().is_some()
    }
}

impl BlockScratch {
    /// Clears the messages on the block; those left at program end belong to no block.
    #[inline]
    pub(crate) fn clear_said(&mut self) {
        if self.has_plain_words {
            return;
        }
        self.messages.said = u64::try_from(self.messages.diagnostics.len()).unwrap_or(u64::MAX);
        self.messages.diagnostics.clear();
        self.messages.of_some_ways.clear();
        self.changes.clear();
    }

    /// Hands the states that the block read to the details reported of it.
    #[inline]
    pub(crate) fn gather_asked(&mut self) {
        let asked = self.read.asked.get_mut();
        if !asked.is_empty() {
            self.aside.asked.append(asked);
        }
    }

    #[inline]
    pub(crate) fn clear(&mut self) {
        self.moves.clear();
        self.new_axes = false;
        self.actions.clear_words();
        self.changes.clear();
        self.doubted.clear();
        self.messages.diagnostics.clear();
        self.aside.withheld.clear();
        self.aside.refused.clear();
        if !std::mem::replace(&mut self.has_plain_words, true) {
            self.clear_rest();
        }
    }

    /// Clears what plain words leave empty.
    #[inline(never)]
    fn clear_rest(&mut self) {
        self.actions.clear();
        self.outcomes.clear();
        self.left_open = None;
        self.earlier = None;
        self.read.unknown_call = None;
        self.read.lone = None;
        self.read.plc_acts = false;
        self.read.notes.get_mut().clear();
        self.aside.asked.clear();
        self.read.unread.set(false);
        self.read.expansions.set(0);
        self.ending.too_deep = false;
        self.wrote = false;
    }

    /// Returns whether the words of the block ask for nothing but a motion, and nothing is said on it or left to be
    /// done after it.
    #[inline]
    pub(crate) fn is_done(&self) -> bool {
        (self.has_plain_words || self.asks_for_nothing())
            && self.messages.diagnostics.is_empty()
            && self.messages.of_some_ways.is_empty()
            && self.aside.withheld.is_empty()
            && self.passed.is_empty()
            && self.left.is_empty()
            // The program that the machine calls at the start may let the PLC act.
            && !self.read.plc_acts
    }

    /// Returns whether the words of the block ask for nothing but a motion, as plain ones do.
    pub(crate) fn asks_for_nothing(&self) -> bool {
        let (actions, read) = (&self.actions, &self.read);
        actions.goes_on()
            && actions.calls.is_empty()
            && actions.looks_for.is_none()
            && actions.axis_words == AxisWords::Motion
            && actions.radius.is_none()
            && self.left_open.is_none()
            && self.earlier.is_none()
            && read.unknown_call.is_none()
            && !read.plc_acts
            && !self.ending.too_deep
            && self.is_quiet()
    }

    /// Returns whether the block switches nothing, and nothing is said on it.
    pub(crate) fn is_quiet(&self) -> bool {
        self.outcomes.is_empty()
            && self.changes.is_empty()
            && self.doubted.is_empty()
            && self.messages.diagnostics.is_empty()
            && self.aside.withheld.is_empty()
            && self.aside.asked.is_empty()
            && self.read.asked.borrow().is_empty()
            && self.read.notes.borrow().is_empty()
    }
}

/// The F word of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) enum Feed {
    /// No F word.
    #[default]
    Absent,
    /// Value, where it is known.
    Given(Option<f64>),
}

/// A file that `#FILE EXIST` looks for.
#[derive(Clone)]
pub(crate) enum LookedFor {
    /// The one of a name.
    Named(String),
    /// File whose name the program computes.
    Computed,
}

/// Actions requested by the words of a block.
#[derive(Default, Clone)]
pub(crate) struct BlockActions {
    /// M02, M30.
    pub(crate) end: Option<EndedBy>,
    /// M17, M29.
    pub(crate) returns: bool,
    /// A jump, or the step of a control block.
    pub(crate) step: Option<ControlStep>,
    /// Calls, in the order in which they are made.
    pub(crate) calls: Vec<WantedCall>,
    /// The file that `#FILE EXIST` looks for.
    pub(crate) looks_for: Option<LookedFor>,
    /// Letter of the last word that calls a program.
    pub(crate) implicit: Option<u8>,
    /// The groups of its G functions, a bit each: those of [`Group`], then those of [`BlockGroup`].
    groups: u32,
    /// The letters of which it has a word and may have one, D at bit 0.
    letters: u32,
    /// The numbers of its M functions, sorted.
    functions: Vec<i64>,
    /// Meaning of the axis words: with G04, G92 … they are not coordinates.
    pub(crate) axis_words: AxisWords,
    /// F, which may be unknown.
    pub(crate) feed: Feed,
    /// R of a circle.
    pub(crate) radius: Option<Span>,
    /// The condition of an `$IF` in a block with `$GOTO`.
    pub(crate) condition: Option<bool>,
    /// Whether a probe decides where the block leads (R2.91).
    pub(crate) probes: bool,
    /// G201 or G202, and the axes that `#ACHSE` names.
    pub(crate) manual: Option<OnOff>,
    pub(crate) manual_axes: Vec<AxisIndex>,
}

impl BlockActions {
    /// Clears what plain words ask for.
    #[inline]
    fn clear_words(&mut self) {
        self.feed = Feed::Absent;
        self.groups = 0;
    }

    fn clear(&mut self) {
        self.end = None;
        self.returns = false;
        self.step = None;
        self.calls.clear();
        self.looks_for = None;
        self.implicit = None;
        self.letters = 0;
        self.functions.clear();
        self.axis_words = AxisWords::Motion;
        self.radius = None;
        self.condition = None;
        self.probes = false;
        self.manual = None;
        self.manual_axes.clear();
    }

    /// Takes a G function; returns whether the control refuses it, because the block has one of its group.
    pub(crate) fn is_second_of_group(&mut self, function: &GFunction) -> bool {
        let group = function.group.map(|group| group as usize);
        let place = group.or(function.one_of.map(BlockGroup::place));
        place.is_some_and(|place| !self.take_bit(place))
    }

    /// Takes a G function of a group; returns whether it is the first one.
    #[inline]
    pub(crate) fn take_group(&mut self, group: Group) -> bool {
        self.take_bit(group as usize)
    }

    #[inline]
    fn take_bit(&mut self, bit: usize) -> bool {
        let is_first = self.groups & 1 << bit == 0;
        self.groups |= 1 << bit;
        is_first
    }

    /// Takes a word of a letter; returns whether the control refuses it, because the block already has one (R2.45).
    pub(crate) fn is_repeated(
        &mut self,
        (letter, number): (u8, Option<i64>),
        block: &Block,
    ) -> bool {
        match letter {
            b'N' if self.groups & 1 << BlockGroup::LookAhead.place() != 0 => false,
            b'N' if block.number.is_some() => true,
            b'F' => matches!(self.feed, Feed::Given(_)),
            b'M' => number.is_some_and(|it| self.is_repeated_function(it)),
            b'D' | b'I' | b'J' | b'K' | b'N' | b'S' => {
                let bit = 1 << (letter - b'D');
                let is_repeated = self.letters & bit != 0;
                self.letters |= bit;
                is_repeated
            }
            _ => false,
        }
    }

    fn is_repeated_function(&mut self, number: i64) -> bool {
        let found = self.functions.binary_search(&number);
        if let Err(place) = found {
            self.functions.insert(place, number);
        }
        found.is_ok()
    }

    /// Returns whether the block itself leads only to the next one.
    pub(crate) fn goes_on(&self) -> bool {
        self.end.is_none() && !self.returns && self.step.is_none()
    }
}

/// Returns a single message.
pub(crate) fn one(diagnostic: Diagnostic) -> Collected {
    let mut notes = Collected::default();
    notes.push(diagnostic);
    notes
}

/// Returns whether a diagnostic stops the control.
pub(crate) fn stops(diagnostic: &Diagnostic) -> bool {
    diagnostic.code.severity() == Severity::Error
}

/// Returns the reason for the end of a program that one of these diagnostics stops.
pub(crate) fn ended_by(said: &[Diagnostic]) -> EndedBy {
    let bound = |diagnostic: &Diagnostic| diagnostic.code.is_budget();
    match said.iter().find(|diagnostic| stops(diagnostic)) {
        Some(diagnostic) if bound(diagnostic) => EndedBy::Budget,
        _ => EndedBy::Error,
    }
}

/// Returns whether a fault is about a word that the user declares harmless.
pub(crate) fn is_harmless(words: &HarmlessWords, fault: &Fault, text: &str) -> bool {
    fault.code == Code::Fc210 && words.has_command(fault.span.of(text))
}

/// The block at whose error the control stops, and the dry run goes on (R9.20).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct FailedAt {
    seq: u64,
    file: Arc<str>,
    line: u32,
    by: EndedBy,
}

impl FailedAt {
    /// Returns the executed block `seq`, with its messages.
    pub(crate) fn new(seq: u64, at: &BlockContext<'_>, said: &[Diagnostic]) -> Self {
        Self {
            seq,
            file: Arc::clone(at.file),
            line: at.line,
            by: ended_by(said),
        }
    }

    /// Says on a message about what follows that the control stops before it.
    pub(crate) fn mark(&self, said: &mut Diagnostic, seq: u64) {
        let is_here = |end: &Place| *end.file == *self.file && end.start().line == self.line;
        if seq == self.seq
            || said.code.is_about_text()
            || self.by == EndedBy::Budget
            || said.ends.iter().any(is_here)
        {
            return;
        }
        let place = seen_from((&self.file, self.line), &said.place.file);
        let words = format!("mend {place} first: the control stops there");
        said.advice.push(words.into());
    }
}

/// A part of a macro with which words of the same block cannot be, or perhaps not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LonePart {
    /// A call, after which the control accepts nothing (R2.13).
    Call,
    /// A `#` command (R2.47).
    Command(BlockSharing),
    /// A comment up to the end, perhaps of the whole block.
    Comment,
}

impl LonePart {
    pub(crate) fn of(code: &MacroCode<'_>) -> Option<Self> {
        let mut items = code.block.items.iter();
        let lone = items.find_map(|item| match item {
            Item::Call(_) => Some(Self::Call),
            Item::Hash(hash) if hash.sharing == BlockSharing::Words => None,
            Item::Hash(hash) => Some(Self::Command(hash.sharing)),
            _ => None,
        });
        lone.or_else(|| ends_in_comment(code.text).then_some(Self::Comment))
    }

    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Call => "a call",
            Self::Command(_) => "a `#` command",
            Self::Comment => "a comment",
        }
    }

    /// Returns whether the control may or may not execute what shares the block with it.
    pub(crate) fn leaves_rest_open(self) -> bool {
        self != Self::Call
    }

    /// Returns the first part of a block that should not be in it together with a macro.
    pub(crate) fn conflict(self, block: &Block, used: Span) -> Option<Span> {
        let from = block
            .items
            .partition_point(|item| item.span().start <= used.start);
        let after = block.items[from..].iter().find(|item| is_part(item));
        let is_alone = self == Self::Command(BlockSharing::None);
        let before = parts(block)
            .next()
            .filter(|part| is_alone && part.start < used.start);
        before.or(after.map(Item::span))
    }
}

fn parts(block: &Block) -> impl Iterator<Item = Span> + '_ {
    let words = block.words.iter().map(|word| word.span);
    let items = block.items.iter().filter(|item| is_part(item));
    words.chain(items.map(Item::span))
}

fn is_part(item: &Item) -> bool {
    !matches!(item, Item::Label(_) | Item::BadCommand(_))
}

/// Returns whether the code ends in a comment: a word after it would not be read.
fn ends_in_comment(code: &str) -> bool {
    code.contains([';', '(']) && !code_of(&format!("{code} X")).ends_with('X')
}

/// Returns the name that a declaration declares, without its dimensions.
pub(crate) fn declared_name(declaration: &Declaration, at: &BlockContext<'_>) -> VariableName {
    VariableName::array_of(declaration.target.span.of(at.text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::{BlockReader, FastPath};
    use crate::text::TextLines;

    #[test]
    fn a_place_holds_the_lines_it_touches_and_shares_them() {
        // R2.85
        let (file, shown) = (Arc::from("a.nc"), ShownBlockLines::default());
        let text = "V.P.T[3] = [1,\\\n2, x,\\\n3, y]";
        let mut block = Block::default();
        let mut reader = BlockReader::new(TextLines::new(text), 7, FastPath::On);
        let raw = reader.next(&mut block).expect("a block");
        let at = BlockContext::of_raw(&file, &raw, &block, &shown);
        let place = |start, end| at.place(Span::new(start, end));
        let (first, second, third) = (place(19, 20), place(16, 17), place(26, 27));
        assert_eq!((&*first.text, first.first_line), ("2, x,\\", 8));
        assert_eq!(first.start().to_string(), "8:4");
        assert!(Arc::ptr_eq(&first.text, &second.text));
        assert_eq!((&*third.text, third.start().line), ("3, y]", 9));
        let back = place(0, 20);
        assert_eq!((back.first_line, &*back.text), (7, &text[..22]));
    }
}
