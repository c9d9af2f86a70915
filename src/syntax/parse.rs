//! Texts that are parsed by themselves: one command, one block, one expression; and faults in the text of a block.

use super::ast::{Address, Block, Item, Operand, Word};
use super::expression::lower_text;
use super::lines::{BlockReader, FastPath};
use super::pieces::brackets;
use crate::comp::CompCommand;
use crate::diagnostic::{Advice, Code, Diagnostic, Fix, Severity, nearest};
use crate::language::{ControlError, HashAction};
use crate::text::{Place, Span, TextLines, lines_of};

/// Parses one COMP command, `X[COMP ON FRICT]`; `None` where the text is something else:
/// another bracket, an expression, or no bracket at all.
///
/// ```
/// use frictcomp::comp::{Kind, KindSet, Selection};
/// use frictcomp::syntax::parse_comp;
///
/// let command = parse_comp("X[COMP ON FRICT]").unwrap().expect("a COMP command");
/// assert_eq!(command.axis, "X");
/// assert_eq!(command.selection, Selection::On(KindSet::of(Kind::Frict)));
/// assert_eq!(parse_comp("X[INDP_ASYN G1 POS=5 FEED=100 SLOPE_TYPE=STEP]"), Ok(None));
/// assert_eq!(parse_comp("X[COMP ON FRIKT]").unwrap_err().code.as_str(), "FC202");
/// ```
///
/// # Errors
/// The first fault that keeps the control from accepting a COMP command, also one whose `COMP` is misspelt. The text is
/// more than one command or line, or has a skip mark, so that the machine decides whether it is executed.
pub fn parse_comp(text: &str) -> Result<Option<CompCommand>, Fault> {
    let mut block = Block::default();
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let _ = reader.next(&mut block);
    let mut rest = String::new();
    reader.append_rest(&mut rest);
    let faulty = |message: &str, help: &'static str| {
        let fault = Fault::new(Code::Fc207, Span::new(0, text.len()), message);
        Err(fault.with_help(help))
    };
    if !rest.trim().is_empty() {
        return if lines_of(text).any(opens_comp) {
            faulty(
                "these are several lines, and one command is read at a time",
                "give each line by itself",
            )
        } else {
            Ok(None)
        };
    }
    let refused = |fault: &Fault| fault.code.severity() == Severity::Error;
    if let Some(at) = block.faults.iter().position(refused) {
        let fault = block.faults.swap_remove(at);
        return if opens_comp(text) {
            Err(fault)
        } else {
            Ok(None)
        };
    }
    let is_alone = block.items.len() == 1 && block.words.is_empty();
    let is_comp = |item: &Item| matches!(item, Item::Comp(_));
    match block.items.into_iter().find(is_comp) {
        Some(Item::Comp(_)) if block.skip.is_some() => faulty(
            "a skip mark leaves it to the machine whether the command is executed",
            "decide that, and give the command without the mark",
        ),
        Some(Item::Comp(command)) if is_alone => Ok(Some(command)),
        None => Ok(None),
        Some(_) => faulty(
            "there is more here than one COMP command",
            "give the command by itself",
        ),
    }
}

/// Returns whether the first bracket of a text begins with `COMP`, or nearly so.
fn opens_comp(text: &str) -> bool {
    let Some((_, inside)) = text.split_once('[') else {
        return false;
    };
    let inside = inside.trim_start();
    let word = inside.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    word.take(1).any(|word| !nearest(word, ["COMP"]).is_empty())
}

/// Parses the first block of a text; an empty block where there is none.
pub fn parse_block(text: &str) -> Block {
    let mut block = Block::default();
    let _ = BlockReader::new(TextLines::new(text), 1, FastPath::On).next(&mut block);
    block
}

/// Returns whether a block is only an M word, `N90 M30 ; end`, `M 2`, `M=P1`, or only `#ERROR`, so that another block
/// can be put before it (R1.59). A jump label is more: a jump to it would skip the other block.
pub fn is_lone_end(text: &str) -> bool {
    let block = parse_block(text);
    let is_m = |word: &Word| word.address == Address::Letter(b'M');
    let is_label = block.number.is_some_and(|number| number.label);
    let is_refused = |fault: &Fault| fault.code.severity() == Severity::Error;
    let is_error = |item: &Item| matches!(item, Item::Hash(hash) if hash.command.action == HashAction::ReportError);
    let is_end = match (block.words.as_slice(), block.items.as_slice()) {
        ([word], []) => is_m(word),
        ([], [item]) => is_error(item),
        _ => false,
    };
    is_end && block.skip.is_none() && !is_label && !block.faults.iter().any(is_refused)
}

/// Parses a text that is one expression into an empty block; `None` where it is not, or
/// nests too deeply.
pub fn parse_expression(text: &str, block: &mut Block) -> Option<Operand> {
    lower_text(&brackets(text).ok()?.read, block)
}

/// A statement about the text of one block: a diagnostic whose span counts from the block's start.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Fault {
    /// The code of the message.
    pub code: Code,
    /// The bytes of the block's text that are meant.
    pub span: Span,
    /// The message: one sentence in lower case.
    pub message: String,
    /// Advice on the fault.
    pub advice: Vec<Advice>,
    /// Changes to the text of the block, each of which alone does what is advised.
    pub fixes: Vec<Fix<Span>>,
}

impl Fault {
    /// Returns a fault without advice.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            advice: Vec::new(),
            fixes: Vec::new(),
        }
    }

    /// Returns an error of the control, with the advice of its row (R2.114).
    #[allow(
        clippy::unnecessary_box_returns,
        reason = "it is the error of a result"
    )]
    pub(crate) fn refused(code: Code, span: Span, message: impl Into<String>) -> Box<Self> {
        let number = code.as_str().strip_prefix("P-ERR-");
        let number = number.and_then(|number| number.parse().ok());
        Box::new(Self::new(code, span, message).with_cure(number))
    }

    /// Adds the advice on an error of the control.
    pub(crate) fn with_cure(self, number: Option<u32>) -> Self {
        match number.and_then(ControlError::of) {
            Some(row) => self.with_help(row.cure),
            None => self,
        }
    }

    /// Adds a piece of advice.
    pub fn with_help(mut self, advice: impl Into<Advice>) -> Self {
        self.advice.push(advice.into());
        self
    }

    /// Adds a change that does what is advised.
    pub fn with_fix(mut self, fix: Fix<Span>) -> Self {
        self.fixes.push(fix);
        self
    }

    /// Adds the known words that may be meant in place of the one at `found`; only a single one is
    /// offered as a change (R1.60).
    pub(crate) fn with_near(self, found: Span, near: &[&str]) -> Self {
        if near.is_empty() {
            return self;
        }
        let said = self.with_help(Advice::did_you_mean(near));
        match near {
            [near] => said.with_fix(Fix::guess(found, *near)),
            _ => said,
        }
    }

    /// Returns its diagnostic at a place. `at` turns the spans of its changes into places; `None` where
    /// that text is not part of the program.
    pub(crate) fn into_diagnostic(
        self,
        place: Place,
        at: impl Fn(Span) -> Option<Place>,
    ) -> Diagnostic {
        let mut diagnostic = Diagnostic::new(self.code, place, self.message);
        diagnostic.advice = self.advice;
        for fix in self.fixes {
            if let Some(place) = at(fix.place) {
                diagnostic.fixes.push(fix.map(|_| place));
            }
        }
        diagnostic
    }
}

/// Returns FC313: a second word where the control accepts one in a block (TF5200 Diagnosis, errors 20105, 20170, 20175,
/// 20181, 20205, 20765).
pub(crate) fn repeated_word(text: &str, span: Span) -> Fault {
    let text = text.trim();
    let message =
        format!("`{text}` is the second such word in this block; the control accepts one");
    Fault::new(Code::Fc313, span, message)
        .with_help("remove one of them, or write it in another block")
}
