//! The files of a run: loaded when they are first needed, looked up by their caller, with the blocks that are kept parsed and
//! the work of executing one again (R9.91). A unit is about a nanosecond of a processor of this decade.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use crate::diagnostic::{Advice, Code, nearest};
use crate::interpreter::programs::calls::{Finder, NoProgram, WantedCall};
use crate::interpreter::programs::index::{
    EntryIndex, Index, LabelName, ProgramId, ProgramSection,
};
use crate::interpreter::values::work_budget::{ITEM, WorkBudget};
use crate::syntax::allow::MARK;
use crate::syntax::ast::{Block, CallScope, Item};
use crate::syntax::{Comments, Fault, RawBlock, Remark, Stretch, no_program};
use crate::text::{Place, SourceFile};

/// Limit on the names that a run compares with those of calls that find nothing.
const MAX_COMPARED: usize = 100_000;

/// Limit of the parsed blocks that a run keeps.
pub(crate) const MAX_KEPT: usize = 100_000;

/// Units of work that a byte of a program in memory allows: its regions may have to be examined
/// once.
const PER_BYTE_HELD: u64 = 16;

/// Caller of a program.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Caller<'a> {
    pub(crate) unit: usize,
    /// The name of its file.
    pub(crate) file: &'a str,
}

/// The files of a run, the main program first.
#[derive(Clone, Default)]
pub(crate) struct ProgramStore {
    units: Vec<SourceUnit>,
    /// Depth of nested control blocks.
    nesting: u32,
    /// The files by name.
    names: HashMap<Arc<str>, usize>,
    /// File that a call by name from a file meant.
    found: BTreeMap<(String, String), usize>,
    /// Calls that found no file, with the reason.
    missing: BTreeMap<(String, String), NoProgram>,
    /// The blocks of sections by their numbers, where those were asked for.
    numbers: HashMap<ProgramId, HashMap<i64, EntryIndex>>,
    /// Number of parsed blocks kept.
    kept: usize,
    /// Bytes of the texts.
    held_text: u64,
    /// Names that were compared with those of calls that found nothing.
    compared: usize,
}

impl ProgramStore {
    /// Creates a store without files.
    pub(crate) fn new(nesting: u32) -> Self {
        Self {
            nesting,
            ..Self::default()
        }
    }

    /// Drops all files.
    pub(crate) fn clear(&mut self) {
        *self = Self::new(self.nesting);
    }

    /// Returns the files.
    pub(crate) fn units(&self) -> &[SourceUnit] {
        &self.units
    }

    /// Returns a file.
    pub(crate) fn unit_mut(&mut self, unit: usize) -> &mut SourceUnit {
        &mut self.units[unit]
    }

    /// Returns the index of a file.
    #[inline]
    pub(crate) fn index(&self, unit: usize) -> &Index {
        &self.units[unit].index
    }

    /// Returns whether the first blocks of a file were read line by line and are not kept.
    pub(crate) fn is_cut(&self, unit: usize) -> bool {
        let source = &self.index(unit).source;
        unit == 0 && (source.name().is_empty() || source.lines().first() > 1)
    }

    /// Returns a program.
    #[inline]
    pub(crate) fn section(&self, program: ProgramId) -> &ProgramSection {
        &self.units[program.unit].index.sections[program.section]
    }

    /// Returns the work that the texts allow.
    pub(crate) fn granted(&self) -> u64 {
        PER_BYTE_HELD.saturating_mul(self.held_text)
    }

    /// Takes a file into the run; returns its number.
    pub(crate) fn hold(&mut self, index: Index) -> usize {
        let bytes = u64::try_from(index.source.text().len()).unwrap_or(u64::MAX);
        self.held_text = self.held_text.saturating_add(bytes);
        let unit = self.units.len();
        let name = index.source.name().clone();
        self.names.entry(name).or_insert(unit);
        let mut held = SourceUnit::new(index);
        if self.kept + held.kept.len() > MAX_KEPT {
            held.kept = Vec::new();
        }
        self.kept += held.kept.len();
        self.units.push(held);
        unit
    }

    /// Puts the main program into the place that was kept for it. The programs that were called so far
    /// stay where they are: a modal cycle and the calls that were found name them by their places.
    pub(crate) fn hold_first(&mut self, index: Index) {
        self.names.retain(|_, unit| *unit != 0);
        let held = self.hold(index);
        let name = self.units[held].index.source.name().clone();
        self.units.swap_remove(0);
        self.numbers.clear();
        self.names.insert(name, 0);
    }

    /// Returns whether a block was read before, in order to be executed.
    #[inline]
    pub(crate) fn was_read(&self, unit: usize, entry: EntryIndex) -> bool {
        self.units[unit].executed[entry as usize]
    }

    /// Returns a parsed block; the first ones and those that are executed again are kept.
    pub(crate) fn parsed(&mut self, unit: usize, entry: EntryIndex) -> Arc<Parsed> {
        let place = entry as usize;
        let unit = &mut self.units[unit];
        unit.executed[place] = true;
        let again = entry < unit.high;
        unit.high = unit.high.max(entry + 1);
        if let Some(Some(kept)) = unit.kept.get(place) {
            return Arc::clone(kept);
        }
        let parsed = Arc::new(unit.parse(entry));
        if again && self.kept < MAX_KEPT {
            if unit.kept.len() <= place {
                unit.kept.resize(unit.index.entries.len(), None);
            }
            unit.kept[place] = Some(Arc::clone(&parsed));
            self.kept += 1;
        }
        parsed
    }

    /// Returns the block of a section that a jump label or a block number names.
    pub(crate) fn block_of(
        &mut self,
        program: ProgramId,
        name: &LabelName,
        work: &WorkBudget,
    ) -> Option<EntryIndex> {
        let ProgramId { unit, section } = program;
        if let Some(entry) = self.units[unit].index.label(section, name.clone()) {
            return Some(entry);
        }
        let LabelName::Number(number) = name else {
            return None;
        };
        let index = &self.units[unit].index;
        let numbers = self.numbers.entry(program).or_insert_with(|| {
            work.charge(ITEM * index.entries.len());
            index.numbers(section)
        });
        numbers.get(number).copied()
    }

    /// Returns the program that a call means; `None` where its file holds nothing to execute.
    pub(crate) fn find(
        &mut self,
        wanted: &WantedCall,
        caller: Caller<'_>,
        finder: &mut dyn Finder,
        work: &WorkBudget,
    ) -> Result<Option<ProgramId>, Box<Fault>> {
        let name = wanted.name.as_str();
        let unit = caller.unit;
        if wanted.scope == CallScope::Local {
            let index = self.units.get(unit).map(|unit| &unit.index);
            if let Some(again) = index.and_then(|index| index.repeated_local(name)) {
                return Err(repeated(wanted, again));
            }
            return match index.and_then(|index| index.local(name)) {
                Some(section) => Ok(Some(ProgramId { unit, section })),
                None => Err(self.no_local(wanted, unit, work)),
            };
        }
        let key = (caller.file.to_owned(), name.to_owned());
        let unit = if let Some(&unit) = self.found.get(&key) {
            unit
        } else {
            let source = match self.missing.get(&key) {
                Some(why) => Err(why.clone()),
                None => finder.find(name, caller.file).and_then(program),
            };
            let source = match source {
                Ok(source) => source,
                Err(why) => {
                    let fault = not_at_hand(wanted, &why);
                    self.missing.insert(key, why);
                    return Err(fault);
                }
            };
            let known = self.names.get(source.name()).copied();
            let unit = known.unwrap_or_else(|| self.hold(Index::new(source, self.nesting)));
            self.found.insert(key, unit);
            unit
        };
        let index = &self.units[unit].index;
        match index.main {
            Some(section) => Ok(Some(ProgramId { unit, section })),
            None if index.local_names().next().is_some() => Err(Box::new(
                Fault::new(
                    Code::Fc320,
                    wanted.span,
                    format!(
                        "the called program `{name}` contains only local subprograms, nothing to \
                         call"
                    ),
                )
                .with_help(
                    "a program that is called begins with `%NAME` or has no `%` line at all",
                ),
            )),
            // A file without a block does nothing, and is reported as such (R18.6).
            None => Ok(None),
        }
    }

    /// Returns FC320 for a local subprogram. Names are compared for the first calls only: a file of calls that all fail
    /// has as many names as calls (R2.60).
    fn no_local(&mut self, wanted: &WantedCall, unit: usize, work: &WorkBudget) -> Box<Fault> {
        let name = wanted.name.as_str();
        let fault = Fault::new(
            Code::Fc320,
            wanted.span,
            format!("the file has no local subprogram `{name}`"),
        );
        let left = MAX_COMPARED.saturating_sub(self.compared);
        let mut compared = 0;
        let near = self.units.get(unit).map(|unit| {
            let known = unit.index.local_names().take(left);
            nearest(name, known.inspect(|_| compared += 1))
        });
        let near = near.unwrap_or_default();
        let fault = match (near.as_slice(), wanted.named) {
            ([], _) => fault.with_help(format!(
                "a local subprogram begins with `%L {name}` in the same file"
            )),
            (near, Some(named)) => fault.with_near(named, near),
            (near, None) => fault.with_help(Advice::did_you_mean(near)),
        };
        self.compared += compared;
        work.charge(compared);
        Box::new(fault)
    }
}

/// Returns a file that was found, unless it is something else than a program (R18.6).
fn program(source: SourceFile) -> Result<SourceFile, NoProgram> {
    match no_program(source.text()) {
        Some(what) => Err(NoProgram::Unusable(format!("is {what}, not an NC program"))),
        None => Ok(source),
    }
}

/// Returns FC320: which of several local subprograms of one name the control calls is not documented.
fn repeated(wanted: &WantedCall, again: &Place) -> Box<Fault> {
    let name = &wanted.name;
    let line = again.first_line;
    let message = format!(
        "the file has several local subprograms `{name}`, and which of them the control calls is not known"
    );
    let help = format!("give the one on line {line} a name of its own");
    Box::new(Fault::new(Code::Fc320, wanted.span, message).with_help(help))
}

fn not_at_hand(wanted: &WantedCall, why: &NoProgram) -> Box<Fault> {
    let name = &wanted.name;
    let fault = |code, what: &str| {
        Fault::new(
            code,
            wanted.span,
            format!("the called program `{name}` {what}"),
        )
    };
    Box::new(match why {
        NoProgram::Absent if name.is_empty() => {
            Fault::new(Code::Fc320, wanted.span, "the name of the called program is empty")
        }
        NoProgram::Near(near) => {
            let fault = fault(Code::Fc320, "was not found");
            let fault = match wanted.named {
                Some(named) => fault.with_near(named, &[near]),
                None => fault.with_help(Advice::DidYouMean(near.clone())),
            };
            fault.with_help(on_machine_only(name))
        }
        NoProgram::Absent => fault(Code::Fc320, "was not found")
            .with_help("it was looked for next to the calling file, then in the `program_dirs` of the configuration")
            .with_help(on_machine_only(name)),
        NoProgram::Unusable(what) => fault(Code::Fc320, what)
            .with_help("a called program must be a readable file of at most 1 GiB"),
        NoProgram::Outside => fault(Code::Fc321, "is outside the folders that programs may be called from")
            .with_help("these are the caller's folder, that of `frictcomp.toml` (the current folder if there is none), `program_dirs`, and everything below them; a file of the same name is also looked for there")
            .with_help(Advice::AllowOutside),
    })
}

/// Returns the remark on a program that only the machine has and that is passed over (R2.83).
fn on_machine_only(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    format!(
        "to pass over a program that only the machine has, set `external = [\"{last}\"]` in `[machine]`"
    )
}

/// A file of the run.
#[derive(Clone)]
pub(crate) struct SourceUnit {
    pub(crate) index: Arc<Index>,
    /// The first blocks and those that were executed more than once, parsed.
    pub(crate) kept: Vec<Option<Arc<Parsed>>>,
    /// Index below which blocks were executed before.
    pub(crate) high: EntryIndex,
    /// Executed blocks, where they are requested.
    pub(crate) executed: Vec<bool>,
    /// Whether a call of the file came back from its end (R17.2).
    pub(crate) returned: bool,
}

impl SourceUnit {
    pub(crate) fn new(mut index: Index) -> Self {
        let parsed = std::mem::take(&mut index.parsed);
        Self {
            kept: parsed.into_iter().map(Some).collect(),
            high: 0,
            executed: vec![false; index.entries.len()],
            returned: false,
            index: Arc::new(index),
        }
    }

    pub(crate) fn parse(&self, entry: EntryIndex) -> Parsed {
        let mut reader = self.index.reader(entry);
        let mut block = Block::default();
        reader.next(&mut block);
        let raw = reader.last();
        debug_assert_eq!(raw.stretch, Stretch::Block);
        let parsed = Parsed::new(self.index.source.name(), &raw, block);
        Parsed {
            remark: self.index.remark(entry),
            ..parsed
        }
    }
}

/// A parsed block with its text and its place.
#[derive(Debug)]
pub(crate) struct Parsed {
    pub(crate) block: Block,
    /// Work of executing it again.
    pub(crate) weight: u64,
    pub(crate) file: Arc<str>,
    pub(crate) line: u32,
    pub(crate) text: String,
    pub(crate) comments: Comments,
    pub(crate) remark: Option<Remark>,
}

impl Parsed {
    pub(crate) fn new(file: &Arc<str>, raw: &RawBlock<'_>, block: Block) -> Self {
        Self {
            weight: weight(&block, raw.text),
            block,
            file: Arc::clone(file),
            line: raw.line,
            text: raw.text.to_owned(),
            comments: raw.comments,
            remark: raw.remark.cloned(),
        }
    }
}

/// A block, whatever it contains.
const BLOCK: usize = 60;

/// A word with a number.
const WORD: usize = 18;

/// An operand or an operator.
const NODE: usize = 7;

/// A command, a statement, an assignment, a call.
const COMMAND: usize = 200;

/// A character of a `#` command, whose words are looked at each time.
const HASH_BYTE: usize = 60;

/// A macro, whose code is parsed each time.
const MACRO: usize = 4000;

/// A comment that is addressed to this tool.
const REMARK: usize = 1000;

/// Characters of the text, which is looked through for such comments, that make a unit.
const BYTES: usize = 16;

/// Units of repeated work that a block with its text needs.
pub(crate) fn weight(block: &Block, text: &str) -> u64 {
    let items = block.items.iter().map(|item| match item {
        Item::Word(_) => WORD,
        Item::MacroUse(_) => MACRO,
        Item::Hash(hash) => COMMAND + HASH_BYTE * hash.span.range().len(),
        _ => COMMAND,
    });
    let words = WORD * block.words.len() + NODE * block.nodes.len();
    let remark = if text.contains(MARK) { REMARK } else { 0 };
    let units = BLOCK + words + items.sum::<usize>() + text.len() / BYTES + remark;
    u64::try_from(units).unwrap_or(u64::MAX)
}
