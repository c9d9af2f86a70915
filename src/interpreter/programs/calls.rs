//! The calls in a text, found without executing it (R17.2), the program that a block calls, and where the texts come from: the
//! library opens no file itself.

use std::collections::BTreeMap;

use crate::interpreter::programs::index::LabelName;
use crate::interpreter::values::expression::unquoted;
use crate::interpreter::values::location::{MissingProgram, Unknown};
use crate::interpreter::values::value::{Value, rounded};
use crate::language::HashAction;
use crate::machine::{ConfiguredPrograms, canonical_word};
use crate::syntax::ast::{
    Address, Argument, Block, CallForm, CallName, CallScope, Hash, Item, Operand, Word,
};
use crate::syntax::{
    BlockReader, FastPath, MAX_MACROS, Stretch, may_call_file, parse_block, with_macros,
};
use crate::text::{SourceFile, Span, TextLines};

/// A call of another file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CallSite {
    /// The name of the program; `None` where it is known only at run time.
    pub name: Option<String>,
    /// The line of its block, from 1.
    pub line: u32,
}

/// Returns the calls of other files in a text, in their order, on a control that has these programs for words and
/// macros: `L`, `L CYCLE`, `L SEQUENCE`, and the words that call a program (R2.14, R2.75). Nothing is executed: a call
/// counts whether it is reached or not.
///
/// ```
/// use frictcomp::interpreter::call_sites;
/// use frictcomp::machine::ConfiguredPrograms;
///
/// let sites = call_sites("N10 X1\nN20 L drill.nc\n", &ConfiguredPrograms::default());
/// assert_eq!((sites[0].name.as_deref(), sites[0].line), (Some("drill.nc"), 2));
/// ```
pub fn call_sites(text: &str, programs: &ConfiguredPrograms) -> Vec<CallSite> {
    let calls_by_words = !programs.words.is_empty() || !programs.macros.is_empty();
    if !calls_by_words && !text.contains('#') && !may_call_file(text.as_bytes()) {
        return Vec::new();
    }
    let words = programs.words.iter();
    let words = words.map(|(word, name)| (canonical_word(word), Some(name.clone())));
    let mut sites = Sites {
        programs,
        macros: programs.macros.iter().cloned().collect(),
        by_word: words.collect(),
        line: 1,
        found: Vec::new(),
    };
    for_each_block(text, |block, text, line| {
        sites.line = line;
        sites.block(block, text);
    });
    sites.found
}

/// Returns whether M02 or M30 is in a text, or an M function known only at run time.
///
/// ```
/// use frictcomp::interpreter::holds_program_end;
///
/// assert!(holds_program_end("N10 X1\nN20 M30\n"));
/// assert!(!holds_program_end("N10 X1 (M30)\nN20 M17\n"));
/// ```
pub fn holds_program_end(text: &str) -> bool {
    let mut is_found = false;
    for_each_block(text, |block, text, _| {
        with_macros(block, text, MAX_MACROS, &mut |block, _| {
            is_found |= block.all_words().any(|word| {
                word.address == Address::Letter(b'M')
                    && word.value.is_some()
                    && number(word).is_none_or(|number| matches!(number, 2 | 30))
            });
        });
    });
    is_found
}

/// Returns whether a text is a main program: M02 or M30 is in it, and it does not end with M17 or M29 (R2.110).
pub(crate) fn is_main_program(text: &str) -> bool {
    let mut returns = false;
    for_each_block(text, |block, _, _| {
        let is_return = |word: &Word| {
            word.address == Address::Letter(b'M') && matches!(number(word), Some(17 | 29))
        };
        let mut items = block.items.iter();
        returns =
            block.all_words().any(is_return) || items.any(|item| matches!(item, Item::Return(_)));
    });
    !returns && holds_program_end(text)
}

fn for_each_block(text: &str, mut take: impl FnMut(&Block, &str, u32)) {
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    while let Some(raw) = reader.next(&mut block) {
        if raw.stretch == Stretch::Block {
            take(&block, raw.text, raw.line);
        }
    }
}

fn number(word: &Word) -> Option<i64> {
    match word.value {
        Some(Operand::Number(value)) => rounded(value),
        _ => None,
    }
}

/// The calls that were found so far.
struct Sites<'a> {
    programs: &'a ConfiguredPrograms,
    /// The macros that were defined so far, with their code.
    macros: BTreeMap<String, String>,
    /// The programs of words, of the configuration and of `#FILE NAME`; `None` for a name that only a
    /// run can determine.
    by_word: BTreeMap<String, Option<String>>,
    line: u32,
    found: Vec<CallSite>,
}

impl Sites<'_> {
    fn block(&mut self, block: &Block, text: &str) {
        for item in &block.items {
            match item {
                Item::MacroDefinition(name, code) => {
                    let [name, code] = [name, code].map(|span| unquoted(span.of(text)).to_owned());
                    self.macros.insert(name, code);
                }
                Item::MacroUse(name) => self.configured_macro(unquoted(name.of(text))),
                _ => {}
            }
        }
        with_macros(block, text, MAX_MACROS, &mut |block, text| {
            self.own(block, text);
        });
    }

    /// Adds a macro of the channel list, whose code is in no program.
    fn configured_macro(&mut self, name: &str) {
        let macros = &self.programs.macros;
        if let Some((_, code)) = macros.iter().find(|(it, _)| it == name) {
            let code = code.replace("\\\"", "\"");
            with_macros(
                &parse_block(&code),
                &code,
                MAX_MACROS,
                &mut |block, text| {
                    self.own(block, text);
                },
            );
        }
    }

    /// Adds the calls of a block, without those of its macros.
    fn own(&mut self, block: &Block, text: &str) {
        for word in block.all_words() {
            self.word(word);
        }
        for item in &block.items {
            match item {
                Item::Call(call) if call.scope == CallScope::Global => self.named(call.name, text),
                Item::Sequence(part) => {
                    if let Some(name) = part.name {
                        self.named(name, text);
                    }
                }
                Item::GCall(call) => self.function('G', Some(i64::from(call.number))),
                Item::Hash(hash) if hash.command.action == HashAction::NamePrograms => {
                    self.name_programs(hash, text);
                }
                _ => {}
            }
        }
    }

    fn named(&mut self, name: CallName, text: &str) {
        let shown = |span: Span| unquoted(span.of(text)).trim().to_owned();
        self.add(match name {
            CallName::Literal(span) => Some(shown(span)),
            CallName::Quoted(span) => {
                let name = shown(span);
                Some(self.macros.get(&name).cloned().unwrap_or(name))
            }
            CallName::Variable(_) => None,
        });
    }

    fn name_programs(&mut self, hash: &Hash, text: &str) {
        for (word, name) in file_names(hash, text) {
            let name = match name {
                FileName::Written(name) => Some(name.to_owned()),
                FileName::Elsewhere(_) => None,
            };
            self.by_word.insert(word, name);
        }
    }

    fn word(&mut self, word: &Word) {
        let Address::Letter(letter @ (b'G' | b'M' | b'T' | b'D')) = word.address else {
            return;
        };
        let number = number(word);
        self.function(char::from(letter), number);
        if letter == b'T' && self.programs.data_with_tool {
            self.function('D', number);
        }
    }

    /// Adds a function, whose number is `None` where it is known only at run time.
    fn function(&mut self, letter: char, number: Option<i64>) {
        if self.by_word.is_empty() {
            return;
        }
        let Some(number) = number else {
            if self.by_word.keys().any(|word| word.starts_with(letter)) {
                self.add(None);
            }
            return;
        };
        for word in [format!("{letter}{number}"), letter.to_string()] {
            if let Some(called) = self.by_word.get(&word).cloned() {
                // An empty name takes the program of a word away.
                if called.as_deref() != Some("") {
                    self.add(called);
                }
                return;
            }
        }
    }

    fn add(&mut self, name: Option<String>) {
        let line = self.line;
        self.found.push(CallSite { name, line });
    }
}

/// A word that may call a program: G, M, T or D with its number, where that is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct FunctionWord {
    pub(crate) letter: u8,
    pub(crate) number: Option<i64>,
}

impl FunctionWord {
    /// Returns a G function.
    pub(crate) fn g(number: u32) -> Self {
        Self {
            letter: b'G',
            number: Some(i64::from(number)),
        }
    }

    /// Returns the D word with the number of a T word.
    pub(crate) fn of_data(self) -> Self {
        Self {
            letter: b'D',
            ..self
        }
    }
}

/// Program configured for a word.
pub(crate) enum Configured {
    /// No program.
    None,
    /// A program.
    Program(String),
    /// A program, or none; the name depends on a value that only the machine knows.
    Unknown(Unknown),
}

/// A call whose program has not been looked for yet.
#[derive(Debug, Clone)]
pub(crate) struct WantedCall {
    pub(crate) scope: CallScope,
    pub(crate) name: String,
    pub(crate) own: BTreeMap<u32, Value>,
    pub(crate) span: Span,
    /// Span of the name, if the block itself has it.
    pub(crate) named: Option<Span>,
    /// Form of the call: that of a cycle or of a program.
    pub(crate) form: CallForm,
    /// Set for a modal cycle: whether it waits for motion.
    pub(crate) repeat: Option<bool>,
    /// The part of the program, where it is not all of it.
    pub(crate) part: Option<CalledPart>,
    /// The G function that is called, where no program is known for it (R2.94).
    pub(crate) word: Option<u32>,
}

impl WantedCall {
    /// Returns a call of a program without parameters.
    pub(crate) fn program(scope: CallScope, name: String, span: Span) -> Self {
        Self {
            scope,
            name,
            own: BTreeMap::new(),
            span,
            named: None,
            form: CallForm::Plain,
            repeat: None,
            part: None,
            word: None,
        }
    }

    /// Creates the call of G80 and the like: a program of the machine that is not known (R2.94).
    pub(crate) fn of_word(number: u32, span: Span) -> Self {
        Self {
            word: Some(number),
            ..Self::program(CallScope::Global, format!("G{number}"), span)
        }
    }

    /// Returns the called program, if it is missing.
    pub(crate) fn missing(&self) -> MissingProgram {
        let named = || MissingProgram::Named(self.name.as_str().into());
        self.word.map_or_else(named, MissingProgram::OfG)
    }
}

/// The part of a program that `L SEQUENCE` calls.
#[derive(Debug, Clone)]
pub(crate) struct CalledPart {
    pub(crate) first: LabelName,
    pub(crate) last: Option<LabelName>,
    /// Whether the call itself ends the part, too.
    pub(crate) end_tag: bool,
    pub(crate) passes: u64,
    /// Whether the part belongs to the program being executed.
    pub(crate) here: bool,
}

/// The name of a program after `#FILE NAME`.
pub(crate) enum FileName<'a> {
    /// A literal name.
    Written(&'a str),
    /// The value of a variable, or of something that is not followed.
    Elsewhere(&'a str),
}

/// The letters of the words that may get a program.
const LETTERS: [&str; 4] = ["D", "G", "M", "T"];

/// Returns the words and program names of `[ G80="part.nc" M6 "change.nc" ]`; the equals sign is optional. With any
/// other text, the program of every word is unknown.
pub(crate) fn file_names<'a>(hash: &Hash, text: &'a str) -> Vec<(String, FileName<'a>)> {
    let mut names = Vec::new();
    let mut arguments = hash.brackets.iter();
    while let Some(argument) = arguments.next() {
        let (word, name) = match argument.key {
            Some(word) => (word, Some(argument)),
            None => (argument.span, arguments.next()),
        };
        let word = word.of(text);
        // The file of `#MSG SAVE` (PM/207504523).
        if word.eq_ignore_ascii_case("MSG") {
            continue;
        }
        if !is_word(word) {
            names.extend(LETTERS.map(|letter| (letter.to_owned(), FileName::Elsewhere(word))));
        }
        names.extend(name.map(|name| (canonical_word(word), file_name(name, text))));
    }
    names
}

fn file_name<'a>(argument: &Argument, text: &'a str) -> FileName<'a> {
    match argument.quoted(text) {
        Some(name) => FileName::Written(name.trim()),
        None => FileName::Elsewhere(argument.span.of(text)),
    }
}

fn is_word(word: &str) -> bool {
    let Some((letter, number)) = word.split_at_checked(1) else {
        return false;
    };
    let mut letters = LETTERS.iter();
    letters.any(|known| known.eq_ignore_ascii_case(letter))
        && number.bytes().all(|byte| byte.is_ascii_digit())
}

/// Reason why a called program is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoProgram {
    /// No program of that name (FC320).
    Absent,
    /// No program of that name, but one with a similar name that may be meant (FC320).
    Near(String),
    /// A program in a folder that programs are not called from (FC321).
    Outside,
    /// A file that exists but cannot be used (FC320), with the words that follow its name: `is a folder`.
    Unusable(String),
}

/// Finds called programs.
pub trait Finder {
    /// Returns the text of the program called `name`, asked for by the file `caller`.
    ///
    /// # Errors
    /// It is missing.
    fn find(&mut self, name: &str, caller: &str) -> Result<SourceFile, NoProgram>;

    /// Returns the names of further files with other content that the name may mean on the control (FC329).
    fn others(&mut self, _name: &str, _caller: &str) -> Vec<String> {
        Vec::new()
    }
}

impl<F: FnMut(&str, &str) -> Option<SourceFile>> Finder for F {
    fn find(&mut self, name: &str, caller: &str) -> Result<SourceFile, NoProgram> {
        self(name, caller).ok_or(NoProgram::Absent)
    }
}

/// A finder that finds nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoFiles;

impl Finder for NoFiles {
    fn find(&mut self, _name: &str, _caller: &str) -> Result<SourceFile, NoProgram> {
        Err(NoProgram::Absent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sites(text: &str) -> String {
        let programs = ConfiguredPrograms {
            words: vec![("M06".to_owned(), "change.nc".to_owned())],
            macros: vec![("PARK".to_owned(), "L park.nc".to_owned())],
            ..ConfiguredPrograms::default()
        };
        let sites = call_sites(text, &programs).into_iter();
        let sites = sites.map(|it| format!("{}:{}", it.name.as_deref().unwrap_or("?"), it.line));
        sites.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn calls_are_found_without_a_run() {
        // R17.2
        for (text, found) in [
            (
                "N10 L a.nc\nLL SUB\nN30 L CYCLE [NAME=b.cyc @P1=2]",
                "a.nc:1 b.cyc:3",
            ),
            ("G1 \\\n X1\nL \"a b.nc\"", "a b.nc:3"),
            ("\"DO\" = \"L a.nc\"\n\"DO\"", "a.nc:1"),
            ("\"FILE\" = \"a.nc\"\nL \"FILE\"", "a.nc:2"),
            ("\"PARK\"", "park.nc:1"),
            ("L V.P.NAME\nM=P1", "?:1 ?:2"),
            ("T1 M6\nM06 X1", "change.nc:1 change.nc:2"),
            (
                "#FILE NAME [M6=\"mine.nc\" G800=V.P.A T=\"\"]\nM6\nG800[1]\nT1",
                "mine.nc:2 ?:3",
            ),
            (
                "L SEQUENCE [NAME=a.nc N10 N20]\nL SEQUENCE [N10 N20]",
                "a.nc:1",
            ),
            (
                "(L a.nc)\n#COMMENT BEGIN\nL b.nc\n#COMMENT END\n; L c.nc",
                "",
            ),
            (
                "$IF V.E.A == 1\nL a.nc\n$ENDIF\n%L SUB\nL b.nc",
                "a.nc:2 b.nc:5",
            ),
        ] {
            assert_eq!(sites(text), found, "{text}");
        }
    }

    #[test]
    fn program_ends_are_words() {
        // R17.2
        for text in ["M30", "N10 M02", "X1 M2", "\"END\" = \"M30\"", "M=P1"] {
            assert!(holds_program_end(text), "{text}");
        }
        for text in [
            "M17",
            "M3 M20",
            "(M30)",
            "#MSG [\"M30\"]",
            "V.P.M30 = 1",
            "M29 [MAIN]",
        ] {
            assert!(!holds_program_end(text), "{text}");
        }
    }
}

#[cfg(test)]
mod file_names_tests {
    use super::*;
    use crate::syntax::ast::Item;
    use crate::syntax::parse_block;

    #[test]
    fn file_names_are_read_with_and_without_an_equals_sign() {
        // R2.75
        let shown = |bracket: &str| {
            let text = format!("#FILE NAME {bracket}");
            let block = parse_block(&text);
            let Some(Item::Hash(hash)) = block.items.first() else {
                panic!("{text}")
            };
            let names = file_names(hash, &text).into_iter();
            let names = names.map(|(word, name)| match name {
                FileName::Written(name) => format!("{word}={name}"),
                FileName::Elsewhere(name) => format!("{word}?{name}"),
            });
            names.collect::<Vec<_>>().join(" ")
        };
        let text = " [ G080=\"a b.nc\" m06 \"c.nc\",T = \"\" D=V.P.NAME ]";
        assert_eq!(shown(text), "G80=a b.nc M6=c.nc T= D?V.P.NAME");
        assert_eq!(shown(""), "");
        assert_eq!(shown("[M6=\"a.nc\" / ]"), "M6=a.nc D?/ G?/ M?/ T?/");
        assert_eq!(shown("[FOO=\"a.nc\"]"), "D?FOO G?FOO M?FOO T?FOO FOO=a.nc");
    }
}
